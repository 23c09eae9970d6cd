"""Teeth of cylindrical gears: basic rack, wheel and pair of wheels, geometry alone."""
