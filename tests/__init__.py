"""Tests of Isogyre."""
