"""Measured resonances beside computed ones."""
