"""Scenario files: read strictly, checked, units converted to SI; here and nowhere else."""
