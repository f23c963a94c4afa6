"""Measured series beside runs: read from files in the wild, scaled, aligned and measured by the same functions."""
