"""A caution that one command gives, all give whose numbers rest on the same; none ends in a traceback."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from validation.agree.commands import Printed, run
from validation.agree.relation import Relation
from validation.agree.same_number import unchanged

KIND = "cautions"
#: a word of every sentence on natural frequencies, and those of sentences on seats and teeth, on
#: which static numbers rest as well
ON_FREQUENCIES = re.compile(r"frequenc", re.IGNORECASE)
ON_STATICS = re.compile(r"decides numbers|softens the teeth|lasting dents")
#: commands without frequencies
STATIC = ("answer C_zz", "stiffness", "deflect", "export")
#: a load for a shaft at rest
LOAD = "z=1 kN"
#: numbers, which commands round and list differently
FIGURES = re.compile(r"[-+]?\d[\d.,e+-]*")
#: words that begin a caution and end before its numbers
BEGINNING = 60


def of_scene(scene: Path) -> Iterator[Relation]:
    """Cautions on numbers by all commands that print some, and no traceback by any."""
    with tempfile.TemporaryDirectory() as folder:
        rows = Path(folder) / "rows.csv"
        printed = {
            "answer C_zz": run("answer", scene, "--ask", "C_zz"),
            "stiffness": run("stiffness", scene),
            "deflect": run("deflect", scene, "--load", LOAD),
            "answer": run("answer", scene, "--ask", "f1,f2"),
            "modes": run("modes", scene),
            "compare": run("compare", scene, "--out", Path(folder) / "compared"),
            "sensitivities": run("sensitivities", scene),
            "sweep": run("sweep", scene, "--vary", unchanged(scene), "--out", rows),
        }
    yield from alike(scene.name, printed)
    yield from without_crash(scene.name, printed)


def of_train(train: Path) -> Iterator[Relation]:
    """The same of shafts in mesh."""
    with tempfile.TemporaryDirectory() as folder:
        rows = Path(folder) / "rows.csv"
        printed = {
            "deflect": run("deflect", train),
            "export": run("export", train, "--out", Path(folder) / "matrices.npz"),
            "system-modes": run("system-modes", train),
            "response": run("response", train),
            "sweep": run("sweep", train, "--vary", unchanged(train), "--out", rows),
        }
    yield from alike(train.name, printed)
    yield from without_crash(train.name, printed)


def alike(subject: str, printed: Mapping[str, Printed]) -> Iterator[Relation]:
    """Yield a relation for every caution on numbers and every command that prints such numbers."""
    answered = {name: output for name, output in printed.items() if output.answered}
    moving = {name: output for name, output in answered.items() if name not in STATIC}
    yield from _alike(subject, {name: _on(ON_STATICS, out) for name, out in answered.items()})
    yield from _alike(subject, {name: _on(ON_FREQUENCIES, out) for name, out in moving.items()})


def _alike(subject: str, said: Mapping[str, set[str]]) -> Iterator[Relation]:
    for sentence in sorted(set[str]().union(*said.values())):
        for name, sentences in said.items():
            by = next(other for other, all_of_it in said.items() if sentence in all_of_it)
            what = f"{name} cautions as {by}: {sentence}"
            yield Relation(subject, KIND, what, sentence in sentences, "it says nothing")


def without_crash(subject: str, printed: Mapping[str, Printed]) -> Iterator[Relation]:
    """Yield a relation for every command: it ends in numbers or in a sentence."""
    for name, output in printed.items():
        yield Relation(subject, KIND, f"{name} does not crash", not output.crash, output.crash)


def _on(words: re.Pattern[str], printed: Printed) -> set[str]:
    """Beginnings of cautions with some words, without figures."""
    lines = [
        line.partition("caution: ")[2]
        for line in printed.stderr.splitlines()
        if "caution: " in line
    ]
    sentences = [*lines, *map(str, printed.data.get("cautions", []))]
    return {
        FIGURES.sub("#", sentence)[:BEGINNING] for sentence in sentences if words.search(sentence)
    }
