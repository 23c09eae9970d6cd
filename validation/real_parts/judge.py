"""Do the bars of models with features hold what is true, and is what they call valid within the
tolerance?
"""

from __future__ import annotations

import hashlib
import json
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np

import solidgear as sg
from solidgear.judge.quantities import JUDGED, size
from solidgear.judge.sequence_bars import sequence_bands
from solidgear.judge.solution import Solution
from solidgear.judge.study import study
from solidgear.judge.ties import SCENE
from solidgear.ladder.registry import LADDER
from solidgear.ladder.size import estimated_size
from validation.real_parts.truth import FOLDER, PAIR, Truth, numbers, truth

#: meshes of each model that are judged: one after the other, as a user would come to them
MESHES = {"corrected": 3, "sector": 3, "solid": 3}
#: unknowns of the last mesh of a model above which it is left out
HEAVY = {"corrected": 18_500, "sector": 170_000, "solid": 10_000}
#: what is asked for, so that no mesh is the last before its time
NEVER = 1e-7
#: tolerances at which a model is called valid
TOLERANCES = (1e-3, 3e-3, 1e-2, 3e-2)
#: errors below this are rounding
SMALL = 1e-7


@dataclass(frozen=True)
class Judged:
    """A bar of one quantity on one mesh against the truth; all relative to its size."""

    model: str
    mesh: int
    quantity: str
    error: float
    bar: float
    doubt: float

    @property
    def clear(self) -> bool:
        """Whether the truth is known well enough to tell."""
        return abs(self.error) > SMALL and abs(abs(self.error) - self.bar) > self.doubt

    @property
    def held(self) -> bool:
        """Whether the bar reaches the truth."""
        return abs(self.error) <= self.bar


@dataclass
class Part:
    """One part judged."""

    seed: int
    words: str
    truth: Truth
    bars: list[Judged] = field(default_factory=list)
    #: model and mesh -> largest error of what is judged, and whether each tolerance is said to hold
    verdicts: dict[tuple[str, int], dict[float, tuple[bool, bool | None]]] = field(
        default_factory=dict
    )
    partner: dict[tuple[str, int], float] = field(default_factory=dict)
    left_out: list[str] = field(default_factory=list)
    seconds: float = 0.0


def fit(scene: sg.Scene) -> list[str]:
    """Models of a part with features that have bars of their own."""
    out = [n for n in MESHES if not LADDER[n].unfit(scene) and n in LADDER.fit(scene)]
    # all copies of a sector are the same numbers as one of them
    return [n for n in out if n != "solid" or "sector" not in out]


def heavy(scene: sg.Scene, model: str) -> bool:
    """Whether the last mesh of a model takes more time than there is."""
    last = dict(LADDER[model].meshes(_options(model)).levels[MESHES[model] - 1])
    return estimated_size(scene, model, LADDER[model].given(scene, last)).unknowns > HEAVY[model]


def light(scene: sg.Scene) -> bool:
    """Whether a part has a model with bars for its features that is not too large."""
    return any(n != "solid" and not heavy(scene, n) for n in fit(scene))


def judge(
    text: str, seed: int, words: str, path: Path, folder: Path = FOLDER, *, again: bool = False
) -> Part:
    """Hold every model of one part against the truth.

    Parameters
    ----------
    text : str
        Of the scene file.
    seed : int
    words : str
        Its features.
    path : Path
        Where the file is written.
    folder : Path
        Where truths and what models said are kept.
    again : bool
        Believe what models said the last time: for bars of new factors.

    Returns
    -------
    Part

    Raises
    ------
    SolidgearError
        Where the file is no scene, or the truth cannot be solved.
    """
    start = time.process_time()
    path.write_text(text)
    scene = sg.load(path)
    part = Part(seed, words, truth(scene, text, folder))
    for model in fit(scene):
        if heavy(scene, model):
            part.left_out.append(f"{model}, too large")
            continue
        kept = folder / f"{hashlib.sha256((model + text).encode()).hexdigest()[:16]}_said.json"
        try:
            said = (
                [Said(**level) for level in json.loads(kept.read_text())]
                if again and kept.exists()
                else _said(scene, model)
            )
        except sg.SolidgearError as error:
            part.left_out.append(f"{model}: {error}")
            continue
        kept.write_text(json.dumps([asdict(level) for level in said]))
        for mesh in range(1, len(said) + 1):
            _judged(part, scene, model, said[:mesh])
    part.seconds = time.process_time() - start
    return part


@dataclass(frozen=True)
class Said:
    """What a model said on one mesh.

    Attributes
    ----------
    numbers : dict of str to float
        With the first bending pair by plane or by frequency.
    quantities, solver : dict of str to float
        As bands ask for them.
    split : bool
        Whether "bending 2" is the second of the first pair.
    mesh : dict
        Facts.
    """

    numbers: dict[str, float]
    quantities: dict[str, float]
    solver: dict[str, float]
    split: bool
    mesh: dict


def _options(model: str) -> dict:
    return {"element": "tet10"} if model == "solid" else {}


def _said(scene: sg.Scene, model: str) -> list[Said]:
    asked = scene.with_changes(ask=scene.ask.with_changes(tolerance=NEVER))
    out: list[Said] = []

    def keep(one: Solution) -> None:
        found, mesh = one.ties[SCENE], one.body.mesh
        given = found.numbers
        split = "bending z 1" not in {m.name for m in one.modes.modes}
        facts = {k: v for k, v in mesh.items() if isinstance(v, (int, float, str))}
        out.append(Said(numbers(found), given.quantities, given.solver, split, facts))

    more = {"most": MESHES[model], "evidence": False, "counted": False, "keep": keep}
    study(asked, model, _options(model), **more)
    return out


def _judged(part: Part, scene: sg.Scene, model: str, said: list[Said]) -> None:
    rung, mesh, last, true = LADDER[model], len(said), said[-1], part.truth
    bands = sequence_bands(
        scene,
        rung.meshes(_options(model)),
        rung,
        [s.quantities for s in said],
        last.solver,
        [s.mesh.get("representative_size") for s in said],
    )
    own = last.numbers
    errors = {q: (own[q] - v) / size(true.values, q) for q, v in true.values.items() if q in own}
    split = "bending 2" in bands and last.split
    called = {"pair 1": "bending 1", **({"pair 2": "bending 2"} if split else {})}
    for q, error in errors.items():
        band = bands.get(called.get(q, q))
        if band is not None and q != PAIR[1]:
            part.bars.append(Judged(model, mesh, q, error, band.gci, true.doubt[q]))
    if PAIR[1] in errors:
        part.partner[model, mesh] = errors[PAIR[1]]
    names = [("pair 1" if q == "bending 1" else q) for q in JUDGED]
    asked = [(errors[n], true.doubt[n], bands.get(q)) for n, q in zip(names, JUDGED) if n in errors]
    if not asked or any(b is None for *_, b in asked):
        return
    part.verdicts[model, mesh] = {
        t: (
            all(b.gci <= t for *_, b in asked if b is not None),
            False
            if any(abs(e) - d > t for e, d, _ in asked)
            else True
            if all(abs(e) + d <= t for e, d, _ in asked)
            else None,
        )
        for t in TOLERANCES
    }


def told(part: Part) -> list[str]:
    """Lines of a table: one a model and mesh; and every miss."""
    out = []
    keys = dict.fromkeys((b.model, b.mesh) for b in part.bars)
    effect = max(map(abs, part.truth.effect.values()))
    for model, mesh in keys:
        own = [b for b in part.bars if (b.model, b.mesh) == (model, mesh)]
        clear = [b for b in own if b.clear]
        held = sum(b.held for b in clear)
        worst, bar = max(abs(b.error) for b in own), max(b.bar for b in own)
        ratio = min((b.bar / abs(b.error) for b in clear), default=np.nan)
        out.append(
            f"| {part.seed} | {part.words} | {effect:.1%} | {model} {mesh} | {held}/{len(clear)} of "
            f"{len(own)} | {worst:.1e} | {bar:.1e} | {ratio:.2g} | "
            f"{part.partner.get((model, mesh), np.nan):+.1e} |"
        )
        out += [
            f"    MISS {b.model} {b.mesh} {b.quantity}: error {b.error:+.2e}, bar {b.bar:.2e}, "
            f"doubt {b.doubt:.0e}"
            for b in clear
            if not b.held
        ]
    for (model, mesh), verdict in part.verdicts.items():
        out += [
            f"    FALSE VALID {model} {mesh} at {t:g}"
            for t, (said, is_so) in verdict.items()
            if said and is_so is False
        ]
    out += [f"    left out: {why}" for why in part.left_out]
    return out


HEAD = (
    "| seed | features | effect | model, mesh | bars held, clear, of all | largest error | largest bar "
    "| least bar / error | partner of bending 1 |",
    "| --- " * 9 + "|",
)


def summary(parts: list[Part]) -> list[str]:
    """Share of bars that held, by model and mesh, and verdicts."""
    out = [
        "| model, mesh | bars held | median bar / error | false valid, of valid |",
        "| --- " * 4 + "|",
    ]
    every = [b for p in parts for b in p.bars]
    for key in sorted({(b.model, b.mesh) for b in every}):
        clear = [b for b in every if (b.model, b.mesh) == key and b.clear]
        ratio = np.median([b.bar / abs(b.error) for b in clear]) if clear else np.nan
        said = [v for p in parts for v in p.verdicts.get(key, {}).values() if v[0]]
        wrong = sum(is_so is False for _, is_so in said)
        held = sum(b.held for b in clear)
        out.append(
            f"| {key[0]} {key[1]} | {held}/{len(clear)} | {ratio:.2g} | {wrong} of {len(said)} |"
        )
    return out
