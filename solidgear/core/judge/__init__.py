"""Evidence: how far models are apart, why, and how sure each is of itself."""
