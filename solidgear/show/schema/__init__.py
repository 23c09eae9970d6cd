"""Schemas of files and of results, from the types that read and hold them."""
