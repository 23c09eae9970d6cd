"""Models of a train beside each other."""
