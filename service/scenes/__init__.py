"""Scenes as people and programs are told of them."""
