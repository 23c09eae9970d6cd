"""All models of a scene side by side, and which to trust."""
