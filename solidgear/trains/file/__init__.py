"""The language of train files."""
