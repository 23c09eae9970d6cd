"""Models of a shaft: from a scene to a free elastic body with ports."""
