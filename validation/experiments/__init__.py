"""Measured resonances of simple bodies, and what the program says of them."""
