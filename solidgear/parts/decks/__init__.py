"""Mesh files as lists of nodes, elements and groups: one reader a format."""

from solidgear.parts.decks.deck import FORMATS, Deck, Group, read

__all__ = ["FORMATS", "Deck", "Group", "read"]
