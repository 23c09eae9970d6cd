"""Cuts in the full 3D solid."""
