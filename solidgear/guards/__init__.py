"""Guards: checks of whether models hold for a scene, reported before its numbers are used."""
