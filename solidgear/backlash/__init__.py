"""Teeth with backlash."""
