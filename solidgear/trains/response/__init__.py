"""Forced response of a train."""
