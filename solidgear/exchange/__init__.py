"""Files of other programs, in and out; schemas of files and results."""
