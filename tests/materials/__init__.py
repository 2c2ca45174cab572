"""Tests of what joins the minerals and the optics."""
