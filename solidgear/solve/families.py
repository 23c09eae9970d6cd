"""Families of motion, and those that a block moves in."""

from __future__ import annotations

from solidgear.body import Block

FAMILIES = {"bending": (0, 2, 3, 5), "axial": (1,), "torsion": (4,)}


def waves_of(block: Block) -> int:
    """Waves around the axis of the motions of a block."""
    for kind in ("ovalising_", "cyclic_"):
        if block.name.startswith(kind):
            return int(block.name.removeprefix(kind))
    return 1 if set(block.components) & set(FAMILIES["bending"]) else 0


def repeats(block: Block) -> bool:
    """True where every shape of a block stands for its twin as well, a quarter of a wave further
    round.
    """
    return block.name.startswith("ovalising_")


def several(block: Block) -> bool:
    """True where section motions tell the families of a block apart, and not the block alone."""
    own = [name for name, known in FAMILIES.items() if set(block.components) & set(known)]
    return len(own) > 1


def family_of(block: Block) -> str:
    """Family of the motions of a block; ``all`` for one that holds every motion."""
    if len(block.components) == 6:
        return "all"
    if waves_of(block) > 1:
        return f"ovalising n={waves_of(block)}"
    own = [name for name, known in FAMILIES.items() if set(block.components) & set(known)]
    # a block of a part with a mirror plane holds several
    return " and ".join(own)
