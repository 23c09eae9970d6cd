"""The harmonic solid corrected by a coarse 3D difference."""
