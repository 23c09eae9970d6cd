"""Parts from STEP and mesh files."""
