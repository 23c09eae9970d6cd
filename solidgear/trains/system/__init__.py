"""Parts and links of planetary stages, and equilibrium of a system."""
