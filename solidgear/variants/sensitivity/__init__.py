"""Derivatives of numbers by the entries of a scene file."""
