"""Tests of the mineral database."""
