"""Scenarios, runs, recordings, replay, comparison: the program around the physics."""
