"""Kinds of loads on a shaft, and the words that each takes, asks for, or does not go with."""

from __future__ import annotations

from typing import Any

from solidgear.core.errors import SceneError

#: kinds of load with the words that make it one
KINDS: dict[str, tuple[str, ...]] = {
    "components": ("x", "y", "z", "thx", "thz"),
    "gear": (
        "pitch_diameter",
        "tangential_force",
        "pressure_angle",
        "helix_angle",
        "hand",
        "pitch_angle",
        "apex",
    ),
    "belt": ("diameter", "tight", "slack", "pull_ratio"),
    "weight": ("mass",),
    "force": ("radial", "axial"),
}
#: further words of every kind
FURTHER: dict[str, tuple[str, ...]] = {
    "components": ("torque", "power"),
    "gear": ("torque", "power", "towards", "sense"),
    "belt": ("torque", "power", "towards", "sense"),
    "weight": ("towards",),
    "force": ("towards",),
}
#: kinds with an article
A_KIND = {
    "components": "a load by components",
    "gear": "a gear",
    "belt": "a belt or chain",
    "weight": "a weight",
    "force": "a radial or axial force",
}
#: words that a kind needs one of: if a first word is given, or, where that is empty, in any case
NEEDED: dict[str, tuple[tuple[str, ...], ...]] = {
    "components": (),
    "gear": (
        ("", "pitch_diameter"),
        ("", "torque", "tangential_force", "power"),
        ("", "towards"),
        ("helix_angle", "hand"),
        ("hand", "helix_angle"),
        ("pitch_angle", "apex"),
        ("apex", "pitch_angle"),
    ),
    "belt": (("", "diameter"), ("", "towards")),
    "weight": (("", "towards"),),
    "force": (("radial", "towards"), ("towards", "radial")),
}


def kind_of(load: Any) -> str:
    """Return the kind of a load: that of which words are given."""
    for kind, words in KINDS.items():
        if any(getattr(load, word) is not None for word in words):
            return kind
    return "components"


def check_words(load: Any) -> None:
    """Refuse words of two kinds, words that the kind does not take, and missing ones."""
    first_words = {
        kind: next((word for word in words if getattr(load, word) is not None), None)
        for kind, words in KINDS.items()
    }
    kinds = [kind for kind, word in first_words.items() if word is not None]
    if len(kinds) > 1:
        first, second = kinds[:2]
        raise SceneError(
            f"says one load in two ways: {first_words[first]} makes it {A_KIND[first]}, "
            f"{first_words[second]} {A_KIND[second]}; keep one, or write two loads",
            path=(str(first_words[second]),),
        )
    if not kinds and load.torque is None and load.power is None:
        raise SceneError(
            "gives no force: write x, y, z, thx, thz, torque or power; torque with pitch_diameter (a gear) or "
            "diameter (a belt); mass; or radial and axial",
            path=(),
        )
    kind = kind_of(load)
    for word in ("torque", "power", "towards", "sense"):
        if word not in FURTHER[kind] and getattr(load, word) is not None:
            raise SceneError(f"does not belong to {A_KIND[kind]}", path=(word,))
    _ask_for_words(load, kind)
    turned_by = [w for w in ("torque", "tangential_force", "power") if getattr(load, w) is not None]
    if len(turned_by) > 1:
        first, second = turned_by[:2]
        raise SceneError(f"give either {first} or {second}, not both", path=(second,))


def _ask_for_words(load: Any, kind: str) -> None:
    """Refuse a load without a word that its kind, or another word, needs."""
    for first, *needed in NEEDED[kind]:
        if first and getattr(load, first) is None:
            continue
        if all(getattr(load, word) is None for word in needed):
            reason = f"this key is missing; {A_KIND[kind]} needs {' or '.join(needed)}"
            reason += f" with {first}" if first else ""
            raise SceneError(reason, path=(needed[0],))
