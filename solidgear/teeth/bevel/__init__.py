"""Spiral bevel pairs: flanks from the blank's data, as a cutter leaves them."""
