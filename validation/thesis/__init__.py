"""What comes of the published numbers of the thesis."""
