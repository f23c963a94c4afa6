"""When a cell fails: a function for each criterion, the table of names, crack tips, and the judge of a run."""
