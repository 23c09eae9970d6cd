"""Quick solutions that the guards of a scene share: both beams, a light harmonic solid, lumped
models; each is solved once, when a guard first asks for it.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.linalg as sla
import scipy.sparse.linalg as spla

from solidgear.core import (
    BEAM,
    HARMONIC,
    LADDER,
    TOUCH,
    Body,
    Port,
    SolidgearError,
    Solution,
    Supports,
    as_supports,
    build,
    modes,
    synthesise,
)
from solidgear.core.judge.deviations import BEYOND, OPEN, Deviation, deviations
from solidgear.core.judge.quantities import Values, judged
from solidgear.core.judge.solving import ENOUGH, solve
from solidgear.core.judge.study import study
from solidgear.core.judge.ties import attached
from solidgear.core.ladder.model import SOLID
from solidgear.core.models.size import Size, size_of_body
from solidgear.core.quantity import FIRST_BENDING
from solidgear.core.reduction.effective_mass import Synthesis
from solidgear.core.reduction.lumped_point import LumpedPoint
from solidgear.guards.notice import LUMPED_ON

if TYPE_CHECKING:
    from solidgear.core import Scene

#: modes enough for the first bending pair, the first axial one and the rigid ones between them
FEW = 8
#: error bars of the light harmonic solid are wanted within the tolerance divided by this
SHARE = 4.0
#: its meshes where the first leaves open whether a beam is within the tolerance
LIGHT = 2
#: a clamp this much stiffer than the shaft on its bearings moves a frequency by about the inverse
CLAMP = 1e6

#: options of beams that guards have to know
SOFT = ("shoulder",)

#: components of the two bending planes, and the signs by which one matrix is the other
X, Z, SIGNS = [0, 5], [2, 3], np.array([[1.0, -1.0], [-1.0, 1.0]])


def _with_stand_in(scene: Scene) -> Scene:
    """Return a scene with the section at its start as a lumped point, where nothing is asked."""
    first = scene.segments[0]
    point = Port(name="(start)", y=0.0, lo=0.0, hi=first.y1, attachment="section")
    asked = scene.ask.with_changes(quantities=judged(scene))
    return scene.with_changes(port=point, ask=asked)


class Probe:
    """Quick solutions of one scene.

    `body` is the body the user asked for, read and not solved; `solutions` are there already; `whole`
    is the scene with the features that `scene` leaves out, by default none.
    """

    def __init__(
        self,
        scene: Scene,
        body: Body,
        solutions: dict[str, Solution] | None = None,
        whole: Scene | None = None,
    ):
        #: of a scene without a lumped point, which solutions have, with a stand-in for one
        self.scene = scene if scene.ports else _with_stand_in(scene)
        self.points, self.seats = scene.ports, scene.stations
        self.body, self.whole = body, whole or scene
        self.supports = as_supports(scene).on_stations(scene.stations)
        self.solutions = dict(solutions or {})
        self.meshes: dict[str, int] = {}  # number, of models solved here
        self._tied: dict[str, Values] = {}
        self._gaps: dict[str, list[Deviation]] = {}

    def instead(self, usual: str = "the harmonic solid", *models: str) -> str:
        """Return advice in place of a model that does not hold: `usual`, or, where features of the
        scene forbid the models it names (by default the harmonic solid), the models that hold them.
        """
        if all(LADDER[m].can_model(self.whole) for m in models or ("harmonic",)):
            return usual
        return " or ".join(LADDER.holding(self.whole)) or "a scene with fewer features"

    @property
    def beam_fits(self) -> bool:
        """True where a beam models the scene; else a lumped model rests on a solid."""
        return any(LADDER[m].can_model(self.whole) for m in LADDER.of(BEAM))

    @property
    def solids(self) -> tuple[str, ...]:
        """Solids that model the scene."""
        return tuple(m for m in LADDER.of(SOLID) if LADDER[m].can_model(self.whole))

    @property
    def main(self) -> str:
        """Name of the main lumped point where there are several, else empty: for sentences."""
        return self.scene.port.name if self.scene.further_ports else ""

    def diameter(self, y: float) -> float:
        """Return the outer diameter of the shaft at y, the larger one at a step, m."""
        return 2 * max(
            s.radius_at(y)[1] for s in self.scene.segments if s.y0 - TOUCH <= y <= s.y1 + TOUCH
        )

    @cached_property
    def parts(self) -> list[tuple[float, float, float]]:
        """Parts of the shaft between steps: (first y, last y, greatest outer diameter), m."""
        parts = []
        for a, b in pairwise((0.0, *self.scene.steps, self.scene.length)):
            segments = [s for s in self.scene.segments if s.y0 > a - TOUCH and s.y1 < b + TOUCH]
            parts.append((a, b, 2 * max(max(s.outer0, s.outer1) for s in segments)))
        return parts

    def solution(self, model: str, most: int = 1) -> Solution:
        """Return the solution of a beam, or of the harmonic solid on at most so many meshes."""
        solution = self.solutions.get(model)
        if solution is None or self.meshes.get(model, most) < most:
            options = {name: True for name in SOFT if self.asked(model).get(name)}
            self.solutions[model] = study(
                self.scene, model, options, share=SHARE, most=most, evidence=False
            )
            self.meshes[model] = most
        return self.solutions[model]

    def asked(self, model: str) -> Mapping[str, Any]:
        """Return facts of the mesh of a model, as far as the user has asked for it."""
        if self.body.fidelity == model:
            return self.body.mesh
        return self.solutions[model].body.mesh if model in self.solutions else {}

    def tied(self, attachment: str) -> Values:
        """Return the numbers of a harmonic solid, on one mesh for all, with one attachment
        (``rigid``: at the bearings).
        """
        if attachment not in self._tied:
            scene = attached(self.scene, attachment)
            n, upto = max(scene.ask.modes, ENOUGH), scene.ask.max_frequency
            solution = solve(scene, "harmonic", n, max_frequency=upto, **HARMONIC)
            self._tied[attachment] = solution.quantities
        return self._tied[attachment]

    def gaps(self, model: str) -> list[Deviation]:
        """Return deviations of a beam from the light solid in the judged quantities, the largest
        first.
        """
        if model not in self._gaps:
            self._gaps[model] = self._compared(model)
        return self._gaps[model]

    def _compared(self, model: str) -> list[Deviation]:
        for most in (1, LIGHT):
            pair = {model: self.solution(model), "harmonic": self.solution("harmonic", most)}
            names = judged(self.scene)
            gaps = [g for g in deviations(pair, "harmonic") if g.quantity in names]
            kinds = {g.standing(self.scene.ask.tolerance) for g in gaps}
            if BEYOND in kinds or OPEN not in kinds:
                break
        return sorted(gaps, key=lambda g: -g.size)

    @property
    def first_bending(self) -> float | None:
        """First bending of the Timoshenko beam on bearings, Hz."""
        return self.solution("timoshenko").quantities.get(FIRST_BENDING)

    @cached_property
    def lumped(self) -> tuple[LumpedPoint, dict[str, Synthesis]]:
        """Lumped point and lumped models of the Timoshenko beam; SolidgearError where there is
        nothing to lump.
        """
        beam = self.solution(LUMPED_ON)
        try:
            with np.errstate(divide="raise", invalid="raise"):
                return synthesise(beam.body, self.supports, self.scene.port.name, beam.modes)
        except FloatingPointError:
            raise SolidgearError(
                "first bending does not move the lumped point in the z plane, where masses are "
                "lumped; bearings differ between x and z"
            ) from None

    @cached_property
    def fixed_interface(self) -> float | None:
        """First bending of the Timoshenko beam on bearings with the lumped point held, Hz; None
        without a lumped model.
        """
        try:
            point, _ = self.lumped
        except SolidgearError:
            return None
        clamp = CLAMP * np.diag(
            [
                point.stiffness[0, 0],
                0.0,
                point.stiffness[0, 0],
                point.stiffness[1, 1],
                0.0,
                point.stiffness[1, 1],
            ]
        )
        clamped = Supports(
            (*self.supports.ports, self.scene.port.name),
            sla.block_diag(self.supports.stiffness, clamp),
        )
        return next(
            (
                m.frequency_hz
                for m in modes(self.solution(LUMPED_ON).body, clamped, FEW).modes
                if m.family == "bending" and m.frequency_hz > 0
            ),
            None,
        )

    @cached_property
    def ovalising(self) -> dict[int, float]:
        """Lowest frequency of families of two waves around and more that are solved, Hz; bearings
        do not enter.
        """
        harmonic = self.solutions.get("harmonic")
        families = harmonic.modes.evidence.get("families", []) if harmonic else []
        counted = [row for row in families if (row["n"] or 0) > 1 and row["counted"]]
        if counted:
            return {row["n"]: row["lowest_hz"] for row in counted if row["lowest_hz"]}
        blocks = build(self.scene, "harmonic", **HARMONIC, ovalising=(2, 3)).blocks[-2:]
        lowest = [
            spla.eigsh(
                b.stiffness.tocsc(),
                1,
                b.mass.tocsr().tocsc(),
                sigma=0.0,
                v0=np.ones(b.size),
                return_eigenvectors=False,
            )[0]
            for b in blocks
        ]
        return {n: float(np.sqrt(w2) / (2 * np.pi)) for n, w2 in zip((2, 3), lowest)}

    @cached_property
    def split(self) -> float:
        """Relative distance of the two first bending frequencies of the Timoshenko beam; 0 where
        all bearings, with their housings, are alike in x and z.
        """
        stiffness = self.supports.stiffness
        count = len(self.supports.ports)
        first = 6 * np.arange(count)[:, None]
        x, z = (first + X).ravel(), (first + Z).ravel()
        signs = np.tile(SIGNS, (count, count))
        uneven = np.abs(stiffness[np.ix_(x, x)] * signs - stiffness[np.ix_(z, z)]).max(initial=0.0)
        uneven = max(uneven, np.abs(stiffness[np.ix_(x, z)]).max(initial=0.0))
        if uneven == 0.0:
            return 0.0
        body = self.solution("timoshenko").body
        elastic = [m for m in modes(body, self.supports, FEW).modes if m.frequency_hz > 0]
        bent = [m for m in elastic if m.family == "bending"]
        if len(bent) > 1 and bent[0].multiplicity == 1:
            return bent[1].frequency_hz / bent[0].frequency_hz - 1
        return bent[0].split if bent else 0.0

    @cached_property
    def cells_around(self) -> int:
        """Cells around the axis of a 3D solid of hexahedra (of tetrahedra, an upper bound)."""
        volume = self.body.geometry.volume() if self.body.geometry else None
        assert volume is not None  # asked of 3D solids only
        corners = 8 if volume.element.startswith("hex") else 4
        x, _, z = volume.nodes[:, np.unique(volume.cells[:corners])]
        r = np.hypot(x, z)
        rim = r > (1 - 1e-6) * r.max()
        return len(np.unique(np.round(np.arctan2(x[rim], z[rim]) % (2 * np.pi), 6)))

    @cached_property
    def solid_size(self) -> Size:
        """Size of the 3D solid: that of the body if it is one, else of the default mesh of the
        scene with all cuts.
        """
        if self.body.fidelity == "solid":
            return size_of_body(self.body)
        return LADDER["solid"].size(self.meshed, {})

    @property
    def meshed(self) -> Scene:
        """Scene that the 3D solid models: all of it, or the plain part where no mesh holds all."""
        return self.whole if LADDER["solid"].can_model(self.whole) else self.scene
