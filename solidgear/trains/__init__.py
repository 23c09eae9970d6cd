"""Trains of geared shafts."""
