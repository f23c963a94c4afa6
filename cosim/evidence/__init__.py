"""The campaign of all cases: what is claimed, run as a whole and put into one table."""
