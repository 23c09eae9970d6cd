"""What commands say beside numbers of one shaft: doubts about its part, and remarks that rooms of
features add."""

from __future__ import annotations

import sys
from collections.abc import Iterator

from solidgear.core import (
    Body,
    Document,
    OpenNumbers,
    Scene,
    Source,
    addition,
    explained,
)
from solidgear.core import load as read
from solidgear.core.loading import case_sentence, under_case
from solidgear.show.words import capital


def load(source: Source, case: str | int | None = None) -> Scene:
    """Read a scene, whose bearings settle under a case of its loads, by default the first of several,
    which is printed, and print doubts about the file of its part.
    """
    scene = read(source)
    if case is not None:
        with explained(source):
            scene = scene.with_case(case).settled
    else:
        _print_case(scene)
    for sentence in scene.body.doubts(scene.material) if scene.body is not None else ():
        print(f"caution: {sentence}", file=sys.stderr)
    return scene


def document_under(source: Source, case: str | int | None) -> Document:
    """Return the document of a scene with a case of its loads first, or as it is, and print the first
    of several where none is given.
    """
    document = under_case(source, case)
    if case is None and not document.describes_train and len(document.tables.get("case", ())) > 1:
        _print_case(document)
    return document


def load_case(scene: Scene) -> str:
    """Return the sentence of a report on the case of several under which bearings settled."""
    sentence = case_sentence(scene)
    return f"{capital(sentence)}." if sentence else ""


def _print_case(source: Source) -> None:
    if sentence := case_sentence(source):
        print(f"{sentence}; --case NAME takes another", file=sys.stderr)


def cautions(scene: Scene, body: Body) -> list[str]:
    """Return the cautions of all guards on a scene and the model that was solved."""
    remark = addition("remark", "cautions")
    return remark(scene, body) if remark else []


def open_ranges(scene: Scene, body: Body | None = None) -> OpenNumbers:
    """Return the ranges of numbers that inputs with an open value cause."""
    if not may_be_open(scene):
        return OpenNumbers()
    remark = addition("remark", "open ranges")
    return remark(scene, body) if remark else OpenNumbers()


def may_be_open(scene: Scene) -> bool:
    """Return True where inputs of a scene may have an open value."""
    return bool(scene.uncertain) or _has_catalogue(scene)


def _has_catalogue(scene: Scene) -> bool:
    return any(bearing.catalogue is not None for bearing in scene.bearings)


def bearing_cautions(scene: Scene) -> Iterator[str]:
    """Yield cautions on catalogue bearings that do not fit their seat, or hold the shaft one way
    only.
    """
    if not _has_catalogue(scene):
        return
    for name in ("directions", "seats"):
        remark = addition("remark", name)
        if remark:
            yield from remark(scene)
