"""True values of a shaft of revolution: references of several kinds, made as they are asked
for and kept under what the scene is.

    spectral    `truths.reference`: its own mesh and elements, on three levels
    product     the harmonic solid of the product, order 8 on six layers, beside order 7
    triangles   `truths.triangles`

The reference of least uncertainty gives the true value; where two contradict each other by more
than both admit, there is none.
"""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core.judge.correlation import subspace_mac
from solidgear.core.judge.quantities import size
from solidgear.core.machine.whole_file import whole
from solidgear.core.quantity import Quantity
from solidgear.core.scene import Ask, Scene
from validation.campaign.rows import Truth
from validation.campaign.truths.product import product_reference
from validation.campaign.truths.reference import LEVELS, Reference, spectral_reference

SPECTRAL, PRODUCT, TRIANGLES = "spectral", "product", "triangles"
#: modes as near as this are told apart by shape
NEAR = 0.05
#: a finer level of a reference counts unless it is this many times less certain
DROWNED = 10.0
#: families that no number asked for belongs to
OTHERS = ("ovalising", "breathing", "rigid")
#: a partner has at least this MAC, and at least this share of the best; stations that a coarse
#: mesh does not know spoil a MAC
LEAST, NEAR_BEST = 0.3, 0.7
#: a frequency further off than this is not looked at as a partner
REACH = 0.5
#: a shaft longer than this many diameters bends in many modes below its first axial one
SLENDER, MANY = 20.0, 40
#: gives an answered mode with its motions, if that can be had
Shape = Callable[[], "dict | None"]


# ------------------------------------------------------------------------------------------------
# - which value is true
def truth_of(
    name: str,
    answered: float,
    references: Mapping[str, Reference],
    shape: Shape = lambda: None,
) -> Truth | None:
    """The true value of a quantity, or None where no reference has it or two contradict.

    The value that was answered leads to the partner of a mode; its shape is asked for only where
    names do not tell.
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


def _truth_in(
    name: str, answered: float, kind: str, reference: Reference, shape: Shape
) -> Truth | None:
    if not Quantity(name).is_frequency:
        if name not in reference.values:
            return None
        scale = size(reference.values, name)
        return Truth(reference.values[name], reference.uncertainty[name], scale, kind)
    mode, how = partner(name, answered, reference, shape)
    if mode is None:
        return None
    hz = mode["frequency_hz"]
    return Truth(hz, mode["uncertainty"], hz, f"{kind}, {how}")


def partner(name: str, hz: float, reference: Reference, shape: Shape) -> tuple[dict | None, str]:
    """The reference's mode that an answered frequency belongs to, and how it was found: by name
    where that mode is the only one near, else by shape.
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


def partner_of(mode: dict, reference: Reference) -> tuple[dict | None, str]:
    """The reference's mode of the same shape, nearest in frequency of those alike; by name where
    the mode has no shape.
    """
    elastic = [m for m in reference.modes if m["frequency_hz"] > 0]
    if "motions" not in mode:
        return next((m for m in elastic if m["name"] == mode["name"]), None), "by name"
    near = [m for m in elastic if abs(m["frequency_hz"] / mode["frequency_hz"] - 1) < REACH]
    gram, shape = np.array(reference.gram), _flat(mode)
    mac = [subspace_mac(shape, _flat(m), gram) for m in near]
    if max(mac, default=0.0) < LEAST:
        return None, "no mode of that shape"
    alike = [m for m, value in zip(near, mac) if value >= max(LEAST, NEAR_BEST * max(mac))]
    best = min(alike, key=lambda m: abs(np.log(m["frequency_hz"] / mode["frequency_hz"])))
    same = best["name"] == mode["name"]
    return best, "by shape" if same else f"by shape, there called {best['name']}"


def _flat(mode: dict) -> np.ndarray:
    return np.array(mode["motions"]).reshape(len(mode["motions"]), -1)


# ------------------------------------------------------------------------------------------------
# - references of one scene
def triangle_truth(scene: Scene) -> Reference:
    """Numbers of triangles, as a reference without shapes."""
    from validation.campaign.truths.triangles import triangle_reference  # gmsh and scikit-fem

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


MADE = {SPECTRAL: spectral_reference, PRODUCT: product_reference, TRIANGLES: triangle_truth}


class Truths:
    """References of a scene, made as far as they are asked for.

    Parameters
    ----------
    scene : Scene
    folder : Path
        Where references are kept.
    call : callable
        Of a function and its arguments: what it gave, and why it gave nothing.
    limits : sequence of int
        Unknowns of the bending block of every level of the spectral reference.
    seconds : float
        That one reference may take: one that failed with as much is not tried again.
    tell : callable
        Takes a sentence on every reference that could not be had.

    Attributes
    ----------
    references : dict of str to Reference
        By kind; of a kind in levels each by kind and level.
    failed : dict of str to list of float
        Those that could not be had, with the seconds and unknowns that they were allowed.
    """

    def __init__(
        self,
        scene: Scene,
        folder: Path,
        call: Callable[..., tuple[Any, str]],
        limits: Sequence[int],
        seconds: float,
        tell: Callable[[str], None] = print,
    ):
        self.scene, self.call, self.tell = with_modes(scene), call, tell
        self.limits, self.seconds = limits, seconds
        self.path = folder / f"{name_of(scene)}.json"
        content = json.loads(self.path.read_text()) if self.path.exists() else {}
        found = content.get("references", {})
        self.references = {kind: Reference(**one) for kind, one in found.items()}
        self.failed: dict[str, list[float]] = content.get("failed", {})

    def refine(self, wanted: Callable[[], bool]) -> None:
        """Go up the levels of the spectral reference while more is wanted."""
        for level, limit in enumerate(self.limits):
            if not level or wanted():
                self.more(SPECTRAL, level, limit)
            if f"{SPECTRAL} {level}" not in self.references:
                break

    def meet(self, goal: Mapping[str, float]) -> None:
        """Go up the levels until the finest is as certain as asked."""
        self.refine(lambda: self.finest is not None and not self.finest.meets(goal))

    @property
    def finest(self) -> Reference | None:
        """Of the spectral levels the last."""
        there = [self.references.get(f"{SPECTRAL} {level}") for level in range(len(LEVELS))]
        return next((one for one in reversed(there) if one is not None), None)

    def more(self, kind: str, *arguments: int) -> None:
        """Make a reference that is not there, unless it failed with as much effort before."""
        name = " ".join([kind, *map(str, arguments[:1])])
        effort = [self.seconds, float(max(arguments[1:], default=0))]
        before = self.failed.get(name, [-1.0, -1.0])
        if name in self.references or all(a >= b for a, b in zip(before, effort)):
            return
        found, problem = self.call(MADE[kind], self.scene, *arguments)
        if found is None:
            self.failed[name] = effort
            self.tell(f"{name} reference: {problem or 'too many unknowns'}")
        else:
            self.references[name] = found
        self._write()

    def of(self, name: str, answered: float, shape: Shape = lambda: None) -> Truth | None:
        """As `truth_of`."""
        return truth_of(name, answered, self.references, shape)

    def _write(self) -> None:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        found = {kind: asdict(one) for kind, one in self.references.items()}
        with whole(self.path) as partial:
            partial.write_text(json.dumps({"references": found, "failed": self.failed}))


def name_of(scene: Scene) -> str:
    """Name under which references are kept: title and questions do not change what is true."""
    plain = scene.with_changes(name="", title="", source="", ask=Ask(modes=scene.ask.modes))
    text = json.dumps(plain.as_dict(), sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:20]


def with_modes(scene: Scene) -> Scene:
    """With as many modes asked for as a reference needs to have the first axial one among them."""
    thick = 2 * max(max(s.outer0, s.outer1) for s in scene.segments)
    count = MANY if scene.length > SLENDER * thick else scene.ask.modes
    return scene.with_changes(ask=scene.ask.with_changes(modes=max(count, scene.ask.modes)))
