"""Exchange with other programs: schemas of files and results."""
