"""All relations of one file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from validation.agree import cautions, described, nested, same_number
from validation.agree.relation import Relation
from validation.agree.subjects import is_shaft_with_axis

KINDS = {module.KIND: module for module in (same_number, nested, described, cautions)}


def relations(file: Path, kinds: list[str]) -> list[Relation]:
    """Return all relations of a file; a kind that stops in an exception is one that does not hold."""
    seen: list[Relation] = []
    for kind in kinds:
        try:
            seen += _of_kind(kind, file)
        except Exception as error:
            seen.append(Relation(file.name, kind, "ends", False, repr(error)[:300]))
    return seen


def _of_kind(kind: str, file: Path) -> Iterator[Relation]:
    module = KINDS[kind]
    if same_number.is_train(file):
        if hasattr(module, "of_train"):
            yield from module.of_train(file)
    elif is_shaft_with_axis(file):
        yield from module.of_scene(file)
    elif module is nested:
        yield from nested.of_body(file)
