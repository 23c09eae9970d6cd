"""Cuts into a shaft: keyways, holes, flats, teeth."""
