"""Broken ice: rigid blocks in vertical x-z sections (rotating and sliding phases)."""
