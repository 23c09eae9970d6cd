"""Teeth in contact: mesh stiffness, transmission error and load along the face from the flanks."""
