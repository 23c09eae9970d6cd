"""Families of motion, and those that a block moves in."""

from __future__ import annotations

from solidgear.core.body import Block

FAMILIES = {"bending": (0, 2, 3, 5), "axial": (1,), "torsion": (4,)}


def waves_of(block: Block) -> int:
    """Return the waves around the axis of the motions of a block."""
    for kind in ("ovalising_", "cyclic_"):
        if block.name.startswith(kind):
            return int(block.name.removeprefix(kind))
    return 1 if set(block.components) & set(FAMILIES["bending"]) else 0


def repeats(block: Block) -> bool:
    """Return whether every shape of a block stands for a twin as well, a quarter of a wave further
    round.
    """
    return block.name.startswith("ovalising_")


def has_several_families(block: Block) -> bool:
    """Return whether section motions separate the families of a block, and not the block alone."""
    families = [
        name for name, components in FAMILIES.items() if set(block.components) & set(components)
    ]
    return len(families) > 1


def family_of(block: Block) -> str:
    """Return the family of the motions of a block; ``all`` for one that holds every motion."""
    if len(block.components) == 6:
        return "all"
    if waves_of(block) > 1:
        return f"ovalising n={waves_of(block)}"
    families = [
        name for name, components in FAMILIES.items() if set(block.components) & set(components)
    ]
    # a block of a part with a mirror plane holds several
    return " and ".join(families)
