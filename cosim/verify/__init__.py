"""Verification: the parts against closed forms and the tables and figures of their sources. `cases` lists them."""
