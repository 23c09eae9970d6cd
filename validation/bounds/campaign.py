"""Bodies through `sg.answer` and the references, a row for every number: resumable, and kept apart
by version of the product.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from solidgear.scene import Scene
from validation.attack.outcome import stamp
from validation.attack.reference import LEVELS, Reference
from validation.attack.worker import Worker
from validation.bounds import jobs
from validation.bounds.judging import KNOWN, SMALL, Answer, Row, judged, row_of
from validation.bounds.truths import (
    PRODUCT,
    SPECTRAL,
    TRIANGLES,
    Kept,
    Truth,
    name_of,
    read,
    truth_of,
    write,
)
from validation.common import results_folder

#: a reference is refined until its uncertainty is this share of the error, or this small; where a
#: bar seems not to hold until it is sure
SHARE, SURE, FINEST = 0.3, 0.03, 1e-6
#: unknowns of the bending block of a reference
LIMIT = 400_000
#: seconds that one answer or one reference may take
SECONDS = 180.0


@dataclass
class Campaign:
    """Answers and references of bodies.

    Attributes
    ----------
    tolerances : tuple of float
    seconds : float
        Longest that one job may take.
    limit : int
        Unknowns of a spectral reference.
    finest : float
        A reference is not refined to know errors better than this.
    triangles : bool
        Whether references of triangles are made too.
    folder : Path
        Where rows and references are kept.
    again : bool
        Whether bodies are asked again that have rows of this version.
    tell : callable
        Called with a line at every body.
    """

    tolerances: tuple[float, ...] = (1e-2, 1e-3)
    seconds: float = SECONDS
    limit: int = LIMIT
    finest: float = FINEST
    triangles: bool = False
    folder: Path = field(default_factory=lambda: results_folder("bounds"))
    again: bool = False
    tell: Callable[[str], None] = print

    def __post_init__(self) -> None:
        self.worker = Worker(jobs.run, self.seconds)
        self.problems: list[str] = []
        self.stamp = stamp()

    # --------------------------------------------------------------------------------------------
    # - all bodies
    def run(self, bodies: Iterable[str]) -> list[Row]:
        """Rows of all bodies at all tolerances; Ctrl-C gives what there is."""
        out: list[Row] = []
        try:
            for body in bodies:
                out += self._rows_of(body)
        except KeyboardInterrupt:
            self.tell("interrupted; what there is:")
        finally:
            self.worker.close()
        return out

    def costs(self, bodies: Iterable[str]) -> list[dict]:
        """What answers cost, without references."""
        out = []
        try:
            for body in bodies:
                for tolerance in self.tolerances:
                    found = self.worker.run("ask", body, tolerance)
                    if problem := _problem(found):
                        self._problem(f"{body} at {tolerance:g}: {problem}")
                        continue
                    told = {name: found[name] for name in ("seconds", "unknowns", "reached")}
                    out.append({"body": body, "tolerance": tolerance} | told)
                    self.tell(f"{body} at {tolerance:g}: {found['seconds']:.1f} s")
                    _append(self.folder / f"costs-{self.stamp}.jsonl", out[-1:])
        except KeyboardInterrupt:
            self.tell("interrupted; what there is:")
        finally:
            self.worker.close()
        return out

    def _rows_of(self, body: str) -> list[Row]:
        try:
            scene = jobs.scene_of(body)
            strange = jobs.strange(scene)
        except Exception as error:  # a scene file may hold anything
            strange = str(error)
        if strange:
            self._problem(f"{body}: {strange}")
            return []
        kept, done = name_of(scene), self._done()
        before = [] if self.again else [r for r in done if (r.body, r.scene) == (body, kept)]
        known = {row.tolerance for row in before}
        left = [t for t in self.tolerances if t not in known]
        fresh = self._fresh(body, scene, left) if left else []
        _append(self.path, [row.as_dict() for row in fresh])
        return [row for row in before if row.tolerance in self.tolerances] + fresh

    def _fresh(self, body: str, scene: Scene, tolerances: list[float]) -> list[Row]:
        start, answers = time.monotonic(), {}
        for tolerance in tolerances:
            found = self.worker.run("ask", body, tolerance)
            problem = _problem(found) or _not_harmonic(found)
            if problem:
                self._problem(f"{body} at {tolerance:g}: {problem}")
            else:
                answers[tolerance] = found
        rows = self._judged(body, scene, answers) if answers else []
        sure, missed = [r for r in rows if r.judged], [r for r in rows if r.held is False]
        self.tell(
            f"{body}: {len(sure)} of {len(rows)} judged, {len(missed)} missed, "
            f"{time.monotonic() - start:.0f} s"
        )
        return rows

    # --------------------------------------------------------------------------------------------
    # - one body
    def _judged(self, body: str, scene: Scene, answers: dict[float, dict]) -> list[Row]:
        """Rows of one body, with references refined as far as its errors ask for it."""
        kept, drawn = read(self.folder, scene), {}

        def rows() -> list[Row]:
            return [
                judged(
                    one,
                    self._truth(body, one, found["options"], kept, drawn),
                    body=body,
                    scene=name_of(scene),
                    tolerance=tolerance,
                    **{name: found[name] for name in ("seconds", "unknowns", "reached")},
                )
                for tolerance, found in answers.items()
                for one in (Answer(**value) for value in found["values"])
            ]

        if self.triangles:
            self._more(body, scene, kept, TRIANGLES)
        for level in range(len(LEVELS)):
            if not level or goals_of(rows(), self.finest):
                self._more(body, scene, kept, SPECTRAL, level, self.limit)
            if f"{SPECTRAL} {level}" not in kept.references:
                break
        if any(unsettled(row, self.finest) for row in rows()):
            self._more(body, scene, kept, PRODUCT)
        return rows()

    def _truth(
        self, body: str, answer: Answer, options: dict, kept: Kept, drawn: dict
    ) -> Truth | None:
        """The true value; shapes of a mesh are made once, and only if needed."""

        def shape() -> dict | None:
            key = json.dumps(options, sort_keys=True, default=str)
            if key not in drawn:
                drawn[key] = self.worker.run("shapes", body, options).get("modes", [])
            return jobs.shape_of(answer.quantity, answer.value, drawn[key])

        return truth_of(answer.quantity, answer.value, kept.references, shape)

    def _more(self, body: str, scene: Scene, kept: Kept, kind: str, *arguments: int) -> None:
        """Ask for a reference that is not there, unless it failed with as much effort before."""
        name = " ".join([kind, *map(str, arguments[:1])])
        effort = [self.seconds, float(self.limit)]
        before = kept.failed.get(name, [0.0, 0.0])
        if name in kept.references or all(a >= b for a, b in zip(before, effort)):
            return
        found = self.worker.run(kind, body, *arguments)
        problem = _problem(found) or ("" if found["found"] else "too many unknowns")
        if problem:
            kept.failed[name] = effort
            self._problem(f"{body}, {name} reference: {problem}")
        else:
            kept.references[name] = Reference(**found["found"])
        write(self.folder, scene, kept)

    # --------------------------------------------------------------------------------------------
    # - what is kept
    @property
    def path(self) -> Path:
        """Rows of this version of the product."""
        return self.folder / f"rows-{self.stamp}.jsonl"

    def _done(self) -> list[Row]:
        return list(rows_in(self.path))

    def _problem(self, text: str) -> None:
        self.problems.append(text)
        self.tell(text)


def unsettled(row: Row, finest: float = FINEST) -> bool:
    """Whether a better reference might show an error that is worth knowing."""
    if row.error is None:
        return True
    return not row.judged and not row.small and row.doubt > finest


def goals_of(rows: Iterable[Row], finest: float = FINEST) -> dict[str, float]:
    """Uncertainties that a reference should have, of the quantities where it has more."""
    goals: dict[str, float] = {}
    for row in rows:
        share = SURE if row.held is False or row.wrong_side else SHARE
        goal = max(share * row.size_of_error, finest)
        if row.error is not None and row.doubt > goal and row.doubt * KNOWN > SMALL:
            goals[row.quantity] = min(goal, goals.get(row.quantity, 1.0))
    return goals


def rows_in(path: Path) -> Iterator[Row]:
    """Rows of a file, of each number the last; without one that was cut off."""
    found: dict[tuple, Row] = {}
    for text in path.read_text().splitlines() if path.exists() else ():
        try:
            row = row_of(json.loads(text))
        except (json.JSONDecodeError, KeyError):
            continue
        found[row.body, row.scene, row.tolerance, row.quantity] = row
    yield from found.values()


def _append(path: Path, rows: list[dict]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a") as file:
        file.writelines(json.dumps(row) + "\n" for row in rows)


def _problem(found: dict) -> str:
    """Why a job gave nothing, in a line; empty where it gave something."""
    told = found.get("crash") or found.get("refused") or ""
    return told.strip().splitlines()[-1] if told else ""


def _not_harmonic(found: dict) -> str:
    return "" if found["rung"] == "harmonic" else f"answered by the {found['rung']} rung"
