"""Independent truth: slow, plain solvers written apart from the code they judge."""
