"""Modes of a train."""
