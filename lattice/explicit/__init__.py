"""The explicit engine: sub-steps below the critical one in compiled loops, for waves and running cracks."""
