"""Deflection and stress of shafts at rest."""
