"""When a cell fails: one function per criterion, the table of their names, crack tips, and the judge that a run asks."""
