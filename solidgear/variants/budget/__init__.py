"""Which unknown is worth measuring."""
