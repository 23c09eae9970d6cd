"""A reference of another kind for shafts of revolution: triangles and plain cylindrical components.

    found = triangle_reference(scene)
    found["C_zz"].value, found["C_zz"].uncertainty

The mesh, the elements, the axis, springs and attachments are its own
(:mod:`validation.campaign.truths.triangle_mesh`, :mod:`validation.campaign.truths.triangle_solid`). Every number
comes from two meshes, its uncertainty from their difference.

What rounding does to a stiffness matrix is the larger the less a motion strains the body, and would
show in slender shafts and on soft bearings. So all numbers are taken where they are stationary:
frequencies as quotients of energies, compliances of the body as ``f'u + u'f - a(u, u)``, with
energies from strains; a wrong digit of a shape enters squared. Statics adds the bearings to the
compliance S of the free body, held at as many unknowns as it has rigid motions D:

    s = D a + S (f - k s),   D'(f - k s) = 0,   s the motions of stations under loads f.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, SuperLU, eigsh, splu

from solidgear.core.errors import SolidgearError, listed
from solidgear.core.judge.quantities import size
from solidgear.core.scene import Scene
from validation.campaign.truths.triangle_mesh import triangle_mesh
from validation.campaign.truths.triangle_solid import FAMILIES, Family, Solid

#: of the geometric mean of two springs: what couples them by less does not, for the numbers here
#: feel its square
UNCOUPLED = 1e-6
#: of the modulus times the largest radius: springs beyond drown the body in rounding
HELD = 1e4
#: sizes of the mesh that each result is compared with, over those of its own
COARSER = {"finest": 100.0, "growth": 2.0, "bulk": 1.5}
#: share of the difference between both meshes that the finer one can still be wrong by. Twice the
#: size at large is ten to fifty times the error; a hundred times that at a corner fifteen times
#: and more, fifteen at the end of a rigid seat in a right-angled shoulder
LEFT = 0.15
#: relative: what rounding does
ROUNDING = 1e-9


@dataclass(frozen=True)
class Number:
    """A number in SI and what it may be wrong by, relative; of a coupling to the geometric mean of
    its diagonal entries.
    """

    value: float
    uncertainty: float


#: components of bending in the other plane, and what they are where the first plane has its own
OTHER_PLANE, MIRRORED = (0, 5), np.diag([1.0, -1.0])
#: names of entries of the compliance (C) and its inverse (K), by family and place
ENTRIES = {
    "bending": {"zz": (0, 0), "z,thx": (0, 1), "thx": (1, 1)},
    "axial": {"yy": (0, 0)},
    "torsion": {"thy": (0, 0)},
    "n=2": {},
}


def triangle_reference(
    scene: Scene,
    *,
    families: Iterable[str] = ("bending", "axial", "torsion"),
    modes: int = 3,
    order: int = 4,
    finest: float = 1e-10,
    growth: float = 0.4,
    bulk: float = 0.6,
) -> dict[str, Number]:
    """Compliances, stiffnesses and frequencies of a shaft on its bearings, by name.

    The scene is a plain body of revolution whose bearings couple neither planes nor bending with the
    rest; others are refused. Names are those of quantities, and C_thy, K_thy, "n=2 1". Compliances
    of motions that nothing resists are left out, and so are free motions among the `modes` of each
    family. Sizes are as of `triangle_mesh`.
    """
    families = tuple(families)
    _refuse(scene, families)
    sizes = {"finest": finest, "growth": growth, "bulk": bulk}
    coarse_sizes = {name: factor * sizes[name] for name, factor in COARSER.items()}
    coarse, fine = (
        _measured(Solid(scene, triangle_mesh(scene, **one), order), families, modes)
        for one in (coarse_sizes, sizes)
    )
    out = {}
    for name, value in fine.items():
        if name in coarse:
            change = abs(value - coarse[name]) / size(fine, name)
            out[name] = Number(value, ROUNDING + LEFT * change)
    return out


def _refuse(scene: Scene, families: Sequence[str]) -> None:
    """Say what of a scene is not for this reference."""
    unknown = sorted(set(families) - set(FAMILIES))
    if unknown:
        raise SolidgearError(f"no family {listed(unknown)}; there are {listed(list(FAMILIES))}")
    kinds = ("features", "blends", "masses", "body", "housing", "housing_axial")
    more = [kind for kind in kinds if getattr(scene, kind)]
    if more:
        raise SolidgearError(f"triangles know nothing of {listed(more)}")
    apart = np.zeros((6, 6), bool)
    for components in ((0, 5), (2, 3), (1,), (4,)):
        apart[np.ix_(components, components)] = True
    for bearing in scene.bearings:
        k = bearing.stiffness
        mean = np.sqrt(np.outer(np.diag(k), np.diag(k)))
        if (np.abs(k[~apart]) > UNCOUPLED * mean[~apart]).any():
            raise SolidgearError(
                f'bearing "{bearing.name}" couples planes, or bending with axial motion or torsion'
            )


def _measured(solid: Solid, families: Sequence[str], modes: int) -> dict[str, float]:
    """All numbers on one mesh."""
    out: dict[str, float] = {}
    for name in families:
        family = FAMILIES[name]
        block = Block(solid, family)
        springs = [_part(b.stiffness, family.components) for b in solid.scene.bearings]
        compliance = block.compliance(springs)
        if compliance is not None:
            inverse = np.linalg.inv(compliance)
            for entry, place in ENTRIES[name].items():
                out[f"C_{entry}"] = float(compliance[place])
                out[f"K_{entry}"] = float(inverse[place])
        if modes:
            found = block.frequencies(springs, modes)
            if name == "bending":
                other = [
                    MIRRORED @ _part(b.stiffness, OTHER_PLANE) @ MIRRORED
                    for b in solid.scene.bearings
                ]
                if not np.allclose(other, springs, rtol=1e-9):
                    found = np.sort([*found, *block.frequencies(other, modes)])[:modes]
            out |= {f"{name} {k}": float(f) for k, f in enumerate(found, start=1)}
    return out


def _part(matrix: np.ndarray, components: Sequence[int]) -> np.ndarray:
    return matrix[np.ix_(components, components)]


class Block:
    """One family of motions of a solid on its bearings."""

    def __init__(self, solid: Solid, family: Family):
        self.solid, self.family = solid, family
        self.ties = solid.ties(family)
        stiffness, self.heavy = solid.matrices(family)
        self.stiffness, self.mass = (self.ties.T @ m @ self.ties for m in (stiffness, self.heavy))
        self.stations = [*solid.scene.bearings, solid.scene.port]
        rows = [solid.mean(family, station) @ self.ties for station in self.stations]
        self.rows = sp.csr_matrix(np.vstack(rows))
        # of motions of a station: lengths and angles
        unit = np.array([solid.radius if c < 3 else 1.0 for c in family.components])
        self.unit = np.outer(unit, unit) / (solid.modulus * solid.radius**3)
        slender = solid.radius / solid.scene.length
        self.shift = -(slender**4) if family.waves == 1 else -(slender**2)

    def springs(self, given: Sequence[np.ndarray]) -> np.ndarray:
        """Stiffness on the motions of all stations, of which the port has none."""
        for bearing, one in zip(self.stations, given):
            if (one * self.unit).max(initial=0.0) > HELD:
                raise SolidgearError(f'bearing "{bearing.name}" is too stiff to be a spring')
        return sla.block_diag(*(one * self.unit for one in given), np.zeros_like(self.unit))

    @cached_property
    def carried(self) -> np.ndarray:
        """Motions of all stations under rigid motions about the start of the shaft."""
        out = np.tile(np.eye(len(self.unit)), (len(self.stations), 1))
        if len(self.unit) == 2:
            out[::2, 1] = [station.y / self.solid.radius for station in self.stations]
        return out

    def free(self, springs: np.ndarray) -> int:
        """Number of rigid motions that no bearing resists."""
        resisted = self.carried.T @ springs @ self.carried
        return len(resisted) - int(np.linalg.matrix_rank(resisted, hermitian=True))

    @cached_property
    def flexible(self) -> np.ndarray:
        """Motions of all stations under loads at them, with a few unknowns held."""
        ties = sp.csc_matrix(self.ties)
        start = [self.solid.rigid(c, 0.0)[list(self.family.parts)] for c in self.family.components]
        rigid = splu(sp.csc_matrix(ties.T @ ties)).solve(
            ties.T @ np.reshape(start, (len(start), -1)).T
        )
        # unknowns that tell the rigid motions apart best
        held = sla.qr(rigid.T, mode="r", pivoting=True)[1][: len(start)]
        left = np.setdiff1d(np.arange(len(rigid)), held)
        loads = self.rows.T.toarray()
        moved = np.zeros_like(loads)
        moved[left] = _factored(self.stiffness[left][:, left]).solve(loads[left])
        work = loads.T @ moved
        return work + work.T - self.solid.energy(self.family, ties @ moved)

    def compliance(self, given: Sequence[np.ndarray]) -> np.ndarray | None:
        """(k, k) of the main port, SI; None where a motion is free."""
        springs, k = self.springs(given), len(self.unit)
        if not k or self.free(springs):
            return None
        load = np.zeros((len(springs), k))
        load[-k:] = np.eye(k)
        give, carried = self.flexible, self.carried
        system = np.block(
            [
                [np.eye(len(springs)) + give @ springs, -carried],
                [carried.T @ springs, np.zeros((k, k))],
            ]
        )
        moved = np.linalg.solve(system, np.vstack([give @ load, carried.T @ load]))
        return moved[len(springs) - k : len(springs)] * self.unit

    def frequencies(self, given: Sequence[np.ndarray], count: int) -> np.ndarray:
        """(count,) of the first elastic modes, Hz."""
        springs = self.springs(given)
        held = sp.csr_matrix(self.rows.T @ sp.csr_matrix(springs) @ self.rows)
        matrix, free = self.stiffness + held, self.free(springs)
        factors = _factored(matrix - self.shift * self.mass)
        inverse = LinearOperator(matrix.shape, factors.solve, dtype=float)
        start = np.random.default_rng(1).standard_normal(matrix.shape[0])
        _, shapes = eigsh(
            matrix, count + free + 3, self.mass, self.shift, v0=start, OPinv=inverse, tol=1e-12
        )
        whole, stations = self.ties @ shapes, self.rows @ shapes
        mass = _along(whole, self.heavy)
        strained = np.diag(self.solid.energy(self.family, whole))
        values = (strained + _along(stations, springs)) / mass
        order = np.argsort(values)[free:]
        if self.family == FAMILIES["axial"]:  # others breathe
            whole[: self.solid.count] = 0.0
            order = order[(_along(whole, self.heavy) > 0.5 * mass)[order]]
        unit = self.solid.modulus / self.solid.density / self.solid.radius**2
        return np.sqrt(values[order][:count] * unit) / (2 * np.pi)


def _along(shapes: np.ndarray, matrix: sp.csr_matrix) -> np.ndarray:
    """Quadratic form of every column."""
    return np.einsum("ij,ij->j", shapes, matrix @ shapes)


def _factored(matrix: sp.csr_matrix) -> SuperLU:
    """Factors of a definite matrix: no pivoting, in an order for symmetric ones."""
    return splu(
        sp.csc_matrix(matrix),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
