"""Many runs: variants of a scenario side by side."""
