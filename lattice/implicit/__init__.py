"""The implicit engine: long steps of the whole sheet with a direct solver that loses cells."""
