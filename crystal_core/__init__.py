"""Exact crystal optics and a spectral, polarized renderer built on it."""

__version__ = "0.1.0"
