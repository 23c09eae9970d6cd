r"""Errors that meshes of solid shafts leave in the numbers of a train at rest.

A quantity a'q of the state at rest has an error bar where a shaft is a harmonic solid: the flexibility at
the ports lies between F and F + M (:mod:`solidgear.core.bounds.harmonic`), so that with the forces f on
the ports at rest, and those, g, which a unit load on the quantity would bring about on the bearings'
tangents,

    |error| <= sqrt(f'M f) sqrt(g'M g),      summed over the shafts and their axial, torsional and
                                             bending parts, which M does not couple

(Cauchy and Schwarz in the energy of the local problems; second order in M is left out).  Of other
solids the flexibility grows by what lies between two ends, whose middle and half the distance take the
place of M.  Beams are
exact in their theory and have no error bar; the harmonic solid shows what their theory leaves out.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from solidgear.core import LADDER, SolidgearError, System, as_supports, coned, pinned
from solidgear.core.bounds.harmonic import HarmonicBounds, harmonic_bounds, why_unbounded, with_tail
from solidgear.core.judge.bounded import bounds_of, geometry_share
from solidgear.core.safety import LOCAL
from solidgear.core.solve.statics import flexibility
from solidgear.core.system.system import port_forces
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.mesh_errors import MeshErrors
from solidgear.trains.assembly.shaft import JUDGE
from solidgear.trains.file.housing import HOUSING
from solidgear.trains.load.state import OperatingState, with_settled_bearings

#: components of motion that the meshes of gears feel: of places, and of axes
PLACES, TILTS = (0, 1, 2), (3, 5)
#: growth of a number in a motion that nothing resists, relative, below which it is rounding
ROUNDING = 1e-9
#: motion of a gear over the other one, with the length of the shaft as arm, that symmetry forbids
FORBIDDEN = 1e-6


class StaticErrors:
    """Errors that meshes of solid shafts leave in linear numbers of a state at rest."""

    def __init__(self, assembly: Assembly, state: OperatingState):
        self.assembly, self.state = assembly, state
        self.why_none = ""  #: reason why a solid has no bounds
        sides = [side for side, model in state.models.items() if _has_bounds(model)]
        if any(mesh.local_harmonics for mesh in assembly.train.meshes):
            sides = []
        self.bounds: dict[str, Any] = {}
        try:
            self.bounds = {side: self._bounds_of(side) for side in sides}
        except (SolidgearError, MemoryError) as error:  # bounds that find no room, or none at all
            self.why_none = str(error)

    def _bounds_of(self, side: str) -> Any:
        model = self.state.models[side]
        scene, body = (
            self.assembly.meshed_scene(side, model),
            self.assembly.shaft_model(side, model).body,
        )
        if model == JUDGE:
            if reason := why_unbounded(coned(scene), body):
                raise SolidgearError(reason)
            return pinned(harmonic_bounds)(coned(scene), body, statics=True)
        # the flexibility of a free body knows no bearings
        free = as_supports(())
        return pinned(bounds_of)(scene, body, free, True, None, ())

    @cached_property
    def tangent(self) -> System:
        """The train on the stiffness that bearings have at rest."""
        settled_train = with_settled_bearings(self.state.assembly.train, self.state)
        return self.assembly.with_train(settled_train).coupled(self.state.models)

    @cached_property
    def rest(self) -> dict[str, np.ndarray]:
        """Forces (6 p,) on the ports of every solid shaft at rest."""
        return self._ports(self.state.forces())

    def _ports(self, forces: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Return (6 p,) forces on the ports of every solid shaft."""
        out = {}
        for side, bounds in self.bounds.items():
            out[side] = np.zeros(6 * len(bounds.body.ports))
            for end, force in forces.items():
                part, _, port = end.partition(".")
                if part == side:
                    start = 6 * bounds.body.port_index(port)
                    out[side][start : start + 6] += force
        return out

    def of_gears(self) -> MeshErrors:
        """Return the errors of the motions of all gears, of places and of axes, relative to the
        length of both; of 3D meshes of places alone, since tilts as sure as these would take many
        times the unknowns.
        """
        of_revolution = {model for model in self.state.models.values() if _has_bounds(model)} <= {
            JUDGE
        }
        parts = (PLACES, TILTS) if of_revolution else (PLACES,)
        bars, shares = [], []
        for side, shaft in self.assembly.train.shafts.items():
            scene = self.assembly.scenes[side]
            for port in [*shaft.gears] or [scene.port.name]:
                rows = self.state.system.motion(f"{side}.{port}")
                moved = rows @ self.state.coordinates
                arms = {PLACES: 1.0, TILTS: scene.length}
                sizes = {part: float(np.linalg.norm(moved[[*part]])) for part in arms}
                least = FORBIDDEN * max(arms[part] * size for part, size in sizes.items())
                for components in parts:
                    size = sizes[components]
                    for row in rows[[*components]] if arms[components] * size > least else ():
                        if self._is_free(row):
                            continue
                        by_shaft = self._by_shaft(row)
                        bars.append(sum(bar for bar, _ in by_shaft.values()) / size)
                        shares.append(_shares(by_shaft))
        return MeshErrors(
            np.array(bars),
            np.array(bars),
            {side: np.array([share[side] for share in shares]).T for side in self.bounds if shares},
        )

    def error_bar(self, row: np.ndarray) -> float | None:
        """Return the error bar of ``row @ coordinates``; None without a solid shaft, and where
        the number grows in a motion that nothing resists.
        """
        if not self.bounds or self._is_free(row):
            return None
        return sum(bar for bar, _ in self._by_shaft(row).values())

    def _is_free(self, row: np.ndarray) -> bool:
        """Return whether a number grows as the train turns, or across a bearing on one element."""
        grows = np.abs(row @ self.tangent.free).max(initial=0.0)
        return bool(grows > ROUNDING * np.linalg.norm(row))

    def _by_shaft(self, row: np.ndarray) -> dict[str, tuple[float, np.ndarray]]:
        """Return the part of every shaft in the error bar of a number, and that of the cells (ne,)
        in this.
        """
        adjoint = port_forces(self.tangent, self.tangent.static(row))
        parts = [*self.assembly.scenes]
        if self.assembly.train.housing is not None:
            parts.append(HOUSING)
        unit_forces = self._ports(_add_unit_load(adjoint, self.tangent, row, parts))
        out = {}
        for side, bounds in self.bounds.items():
            f, g = self.rest[side], unit_forces[side]
            bar = (_of_harmonic if isinstance(bounds, HarmonicBounds) else _of_solid)(bounds, f, g)
            energies = [bounds.energy_by_cells(forces) for forces in (f, g)]
            out[side] = bar, np.sum([e / (e.sum() or 1.0) for e in energies], axis=0) / 2
        return out


def _has_bounds(model: str) -> bool:
    """Return whether a model of a shaft is a solid with bounds of its mesh."""
    return model in LADDER and bool(LADDER[model].bars_by)


def _of_harmonic(bounds: HarmonicBounds, f: np.ndarray, g: np.ndarray) -> float:
    """Return the error bar of a product of forces (6 p,) by a harmonic solid."""
    bar = 0.0
    for rows in (bounds.body.rows(block) for block in bounds.body.blocks):
        place = np.ix_(rows, rows)
        double, single = (_product(m[place], f[rows], g[rows]) for m in (bounds.more, bounds.less))
        bar += LOCAL * with_tail(double, single)
    return bar


def _of_solid(bounds: Any, f: np.ndarray, g: np.ndarray) -> float:
    """Return the error bar of a product of forces (6 p,) by a solid whose flexibility grows by what lies
    between two ends, as quadratic forms, and is off by the shape of its mesh.
    """
    far = bounds.more if bounds.two_sided else LOCAL * bounds.more
    middle, half = (bounds.least + far) / 2, (far - bounds.least) / 2
    misshapen = geometry_share(bounds.body)
    bar = abs(float(f @ middle @ g)) + _product(half, f, g)
    return bar + misshapen * _product(flexibility(bounds.body).matrix, f, g)


def _product(matrix: np.ndarray, f: np.ndarray, g: np.ndarray) -> float:
    """Return the most that two forces may have as product of energy (Cauchy and Schwarz)."""
    return float(np.sqrt(max(f @ matrix @ f, 0.0) * max(g @ matrix @ g, 0.0)))


def _shares(by_shaft: Mapping[str, tuple[float, np.ndarray]]) -> dict[str, np.ndarray]:
    """Return the shares of cells in an error bar by shaft, of all shafts in sum one."""
    total = sum(bar for bar, _ in by_shaft.values()) or 1.0
    return {side: bar / total * cells for side, (bar, cells) in by_shaft.items()}


def _add_unit_load(
    forces: dict[str, np.ndarray], system: System, row: np.ndarray, parts: list[str]
) -> dict[str, np.ndarray]:
    """Add to forces of links the unit load that a row of coordinates stands for, on the ports that
    it is made of.
    """
    total = dict(forces)
    ends = [f"{side}.{port}" for side in parts for port in system.parts[side].ports]
    rows = np.vstack([system.motion(end) for end in ends])
    loads, *_ = np.linalg.lstsq(rows.T, row, rcond=1e-12)
    for end, force in zip(ends, loads.reshape(-1, 6)):
        total[end] = total.get(end, np.zeros(6)) + force
    return total
