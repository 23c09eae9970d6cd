"""Operating points of a train: loads, contact, lives."""
