"""What the numbers of a body really are: references of several kinds, and which of them to trust.

    spectral    `validation.attack.reference`: its own mesh and elements, on three levels
    product     the harmonic solid of the product, order 8 on six layers, beside order 7
    triangles   `validation.bounds.triangles`

The reference of least uncertainty gives the true value; where two contradict each other by more
than both admit, there is none.
"""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np

import solidgear as sg
from solidgear.body import as_supports
from solidgear.errors import SolidgearError
from solidgear.judge.quantities import described, measure, size
from solidgear.machine.whole_file import whole
from solidgear.scene import Ask, Scene
from validation.attack.corner_mesh import TooFine, corner_mesh
from validation.attack.judge import partner_of
from validation.attack.reference import LEVELS, RATIO, SIZE, Reference, _level

SPECTRAL, PRODUCT, TRIANGLES = "spectral", "product", "triangles"
#: orders of the harmonic solid of the product, and the rest of its mesh; the second where rounding
#: drowns the first
ORDERS = (7, 8)
FINEST = (
    {"layers": 6, "edge_layers": 6, "ratio": 0.15, "relative_size": 0.8},
    {"layers": 4, "edge_layers": 3, "ratio": 0.15, "relative_size": 1.0},
)
#: an edge of exponent a leaves 1 / ((8/7)^(4 a) - 1) of the last step: 3 at a shoulder, 5 at the
#: end of a rigid seat there
LEFT = 5.0
#: modes as near as this are told apart by shape
NEAR = 0.05
#: two references contradict where they differ by more than this many times both uncertainties
LENIENT, ROUNDING = 2.0, 1e-9
#: a finer level of a reference counts unless it is this many times less certain
DROWNED = 10.0
#: families that no number asked for belongs to
OTHERS = ("ovalising", "breathing", "rigid")


@dataclass(frozen=True)
class Truth:
    """A true value, its uncertainty relative to the size of the quantity, and where it is from."""

    value: float
    uncertainty: float
    size: float
    how: str

    def agrees(self, other: Truth) -> bool:
        """Whether both may be right; a little more than both admit is let pass."""
        gap = abs(self.value - other.value) / self.size
        return gap <= LENIENT * (self.uncertainty + other.uncertainty) + ROUNDING


# ------------------------------------------------------------------------------------------------
# - which value is true
def truth_of(
    name: str,
    answered: float,
    references: Mapping[str, Reference],
    shape: Callable[[], dict | None] = lambda: None,
) -> Truth | None:
    """The true value of a quantity, or None where no reference has it or two contradict.

    Parameters
    ----------
    name : str
    answered : float
        The value that was answered, by which the partner of a mode is looked for.
    references : mapping of str to Reference
    shape : callable
        Gives the answered mode with its ``motions``; called only where names do not tell.
    """
    levels: dict[str, list[Truth]] = {}
    for kind in sorted(references):
        one = _truth_in(name, answered, kind, references[kind], shape)
        if one is not None:
            levels.setdefault(kind.split()[0], []).append(one)
    known = [_finest(several) for several in levels.values()]
    if not known:
        return None
    best = min(known, key=lambda one: one.uncertainty)
    return best if all(best.agrees(other) for other in known) else None


def _finest(levels: list[Truth]) -> Truth:
    """Of several levels the finest, unless rounding has made it much less certain than another."""
    least = min(one.uncertainty for one in levels)
    return next(one for one in reversed(levels) if one.uncertainty <= DROWNED * least)


def _truth_in(name, answered, kind, reference, shape) -> Truth | None:
    if described(name)[0] != "frequency":
        if name not in reference.values:
            return None
        scale = size(reference.values, name)
        return Truth(reference.values[name], reference.uncertainty[name], scale, kind)
    mode, how = partner(name, answered, reference, shape)
    if mode is None:
        return None
    hz = mode["frequency_hz"]
    return Truth(hz, mode["uncertainty"], hz, f"{kind}, {how}")


def partner(
    name: str, hz: float, reference: Reference, shape: Callable[[], dict | None]
) -> tuple[dict | None, str]:
    """The reference's mode that an answered frequency belongs to, and how it was found.

    By name where that mode is the only one near; else by shape.
    """
    family = name.split()[0]
    like = [
        m
        for m in reference.modes
        # without shapes families cannot mix
        if (not m["name"].startswith(OTHERS) if reference.gram else m["name"].startswith(family))
    ]
    near = [m for m in like if abs(m["frequency_hz"] / hz - 1) < NEAR]
    if len(near) == 1 and near[0]["name"] == name:
        return near[0], "by name"
    if not reference.gram:
        return None, "no shapes to tell modes apart"
    mode = shape()
    if mode is None:
        return None, "no shape to tell modes apart"
    return partner_of(mode, reference)


# ------------------------------------------------------------------------------------------------
# - spectral elements
def spectral_reference(scene: Scene, level: int, limit: int) -> Reference | None:
    """One level of the spectral reference, or None if it takes more unknowns than the limit.

    Parameters
    ----------
    scene : Scene
    level : int
        Of `validation.attack.reference.LEVELS`.
    limit : int
        Unknowns of the bending block.
    """
    start = time.process_time()
    order, layers = LEVELS[level]
    each = 3 * (order + 2) ** 2
    try:
        mesh = corner_mesh(scene, layers, SIZE, RATIO, limit // each)
    except TooFine:
        return None
    if len(mesh.cells) * each > limit:
        return None
    found = _level(scene, mesh, order, layers)
    return replace(found, seconds=time.process_time() - start)


# ------------------------------------------------------------------------------------------------
# - the harmonic solid of the product
def product_reference(scene: Scene) -> Reference:
    """Numbers of the harmonic solid of the product on a mesh far finer than answers take."""
    try:
        return _product(scene, FINEST[0])
    except SolidgearError:
        return _product(scene, FINEST[1])


def _product(scene: Scene, mesh: dict) -> Reference:
    start = time.process_time()
    low, high = (_solved(scene, mesh, order) for order in ORDERS)
    values, uncertainty = {}, {}
    for name, value in high["values"].items():
        if name in low["values"]:
            step = abs(value - low["values"][name]) / size(high["values"], name)
            values[name], uncertainty[name] = value, LEFT * step + high["noise"]
    return Reference(
        values,
        uncertainty,
        _spectrum(low, high),
        high["gram"],
        [ORDERS[-1], mesh["layers"]],
        high["unknowns"],
        time.process_time() - start,
    )


def _solved(scene: Scene, mesh: dict, order: int) -> dict:
    body, supports = sg.build(scene, "harmonic", order=order, **mesh), as_supports(scene)
    names = tuple(port.name for port in scene.ports)
    condensed = sg.condense(body, supports, names[0])
    further = {name: sg.condense(body, supports, name) for name in names[1:]}
    coupled = sg.condense(body, supports, names) if further else None
    found = sg.modes(body, supports, max(scene.ask.modes, 10) + 6, ovalising=False)
    return {
        "values": measure(condensed, found, further, coupled),
        "modes": [told(mode) for mode in found.modes],
        "gram": found.gram.tolist(),
        "noise": float(max(condensed.evidence["residual"], found.evidence["residual"] ** 2)),
        "unknowns": body.size,
    }


def told(mode) -> dict:
    """A mode as plain data."""
    scale = max(np.abs(mode.motions).max(), 1e-300)
    return {
        "name": mode.name,
        "family": mode.family,
        "frequency_hz": float(mode.frequency_hz),
        "multiplicity": mode.multiplicity,
        "captured": float(mode.captured),
        "motions": np.round(mode.motions / scale, 9).tolist(),
    }


def _spectrum(low: dict, high: dict) -> list[dict]:
    """Modes of the higher order, as far as the lower one has the same at each place."""
    out = []
    for one, other in zip(low["modes"], high["modes"]):
        if one["name"] != other["name"] or one["multiplicity"] != other["multiplicity"]:
            break
        hz = other["frequency_hz"]
        step = abs(hz - one["frequency_hz"]) / hz if hz else 0.0
        out.append(other | {"uncertainty": LEFT * step + high["noise"]})
    return out


# ------------------------------------------------------------------------------------------------
# - triangles
def triangle_truth(scene: Scene) -> Reference:
    """Numbers of triangles, as a reference without shapes."""
    from validation.bounds.triangles import triangle_reference

    start = time.process_time()
    found = triangle_reference(scene)
    modes = [
        {"name": name, "frequency_hz": float(one.value), "uncertainty": float(one.uncertainty)}
        for name, one in found.items()
        if not name.startswith(("C_", "K_", "n="))
    ]
    values = {name: float(one.value) for name, one in found.items()}
    doubts = {name: float(one.uncertainty) for name, one in found.items()}
    return Reference(values, doubts, modes, [], [], 0, time.process_time() - start)


# ------------------------------------------------------------------------------------------------
# - kept references
@dataclass
class Kept:
    """References of a body.

    Attributes
    ----------
    references : dict of str to Reference
        By kind; of a kind in levels each by kind and level.
    failed : dict of str to list of float
        Those that could not be had, with the seconds and unknowns that they were allowed.
    """

    references: dict[str, Reference] = field(default_factory=dict)
    failed: dict[str, list[float]] = field(default_factory=dict)


def name_of(scene: Scene) -> str:
    """What a scene's references are kept under: title and questions do not change what is true."""
    plain = scene.with_changes(name="", title="", source="", ask=Ask(modes=scene.ask.modes))
    text = json.dumps(plain.as_dict(), sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:20]


def read(folder: Path, scene: Scene) -> Kept:
    """What is kept of a scene."""
    path = folder / "references" / f"{name_of(scene)}.json"
    if not path.exists():
        return Kept()
    content = json.loads(path.read_text())
    found = {kind: Reference(**one) for kind, one in content["references"].items()}
    return Kept(found, content.get("failed", {}))


def write(folder: Path, scene: Scene, kept: Kept) -> None:
    """Keep what is known of a scene."""
    path = folder / "references" / f"{name_of(scene)}.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    found = {kind: asdict(one) for kind, one in kept.references.items()}
    with whole(path) as partial:
        partial.write_text(json.dumps({"references": found, "failed": kept.failed}))
