"""Benchmarks: figures in one run on the same cores, never asserted in tests."""
