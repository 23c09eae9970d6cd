"""Deflection of shafts and trains at rest."""
