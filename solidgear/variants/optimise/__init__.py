"""The best design within ranges."""
