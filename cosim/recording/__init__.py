"""Recordings: channels and their messages, the file written and read. The only room that knows MCAP."""
