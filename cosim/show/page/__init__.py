"""Parts of the page of a run: tables and series ready for its template."""
