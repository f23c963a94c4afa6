"""The program from Python: calls, runs with their tables and pictures. `import cosim` offers what is in here."""
