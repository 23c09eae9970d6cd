"""Results as pictures, and as files for other programs."""
