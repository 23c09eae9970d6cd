"""Name of a mode: its family by what the shape does around the axis, twins by symmetry, numbers by
frequency.

Families are ``axial``, ``breathing`` and ``torsion`` (nothing varies around the axis: n = 0),
``bending`` (n = 1) and ``ovalising n=2`` and so on. For a body in blocks n is that of the block,
whatever its sections do; a 3D mesh is asked by :mod:`solidgear.solve.circumference`.

Two modes are one pair only where symmetry makes them so: the same profile over the meridian, a
quarter of a wave further round, with bearings that a quarter turn leaves as they are, or with n >=
2, which bearings do not touch. However far a mesh splits twins, they are one pair: the split is an
error of the mesh, is a part of the error bar, and is reported where it is unusual.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse.csgraph import connected_components

from solidgear.body import Block, Body, Supports, component_rows
from solidgear.body.sections import signed
from solidgear.frames import rotation
from solidgear.solve.circumference import Circumference, Displacements, of_body
from solidgear.solve.families import FAMILIES, family_of, repeats, several, waves_of
from solidgear.solve.neighbours import shared_out
from solidgear.solve.quarter_turn import alike

#: Bearings that a quarter turn changes by no more than this, relative, split a pair by half of it
#: at most.
ALIKE = 1e-6
_QUARTER = rotation(1, np.pi / 2)
#: Distance, relative, that 3D meshes usually leave between eigenvalues of twins of two and more
#: waves.
OVAL_TOLERANCE = 1e-2


@dataclass
class Shape:
    """A shape before it has a name."""

    family: str
    waves: int  #: around the axis
    motion: np.ndarray  #: (stations, 6) section motions
    captured: float  #: share of the modal mass they describe
    profile: np.ndarray | dict[int, np.ndarray]  #: what :meth:`Names.overlap` compares
    #: whether it stands for its twin as well, as a block of two waves and more does for its cosine
    #: and its sine form
    double: bool = False
    #: ``z`` or ``x`` where bending stays in one plane of a part that has a mirror plane but is not
    #: round, else empty
    plane: str = ""

    @property
    def label(self) -> str:
        """Family and plane: what modes are numbered by."""
        return f"{self.family} {self.plane}" if self.plane else self.family


#: loads, Gram matrix and columns of the section motions of a block
_Loads = tuple[np.ndarray, np.ndarray, np.ndarray]


class Projection:
    """Mass-weighted projection of shapes onto section motions along the axis.

    Parameters
    ----------
    stations : (s,) ndarray
        Axial positions, ascending, m; the first and the last at the ends of the shaft.

    Attributes
    ----------
    gram : (6 s, 6 s) ndarray
        Mass matrix of section motions.
    """

    def __init__(self, body: Body, stations: np.ndarray):
        size = 6 * len(stations)
        self.count = len(stations)
        self.gram = np.zeros((size, size))
        self.parts = []
        found: list[_Loads] = []
        for block in body.blocks:
            loaded, gram, columns = _section_loads(block, stations, found)
            found.append((loaded, gram, columns))
            self.gram[np.ix_(columns, columns)] += gram
            self.parts.append((loaded, columns, np.linalg.pinv(gram, rcond=1e-12, hermitian=True)))

    def __call__(self, vectors: dict[int, np.ndarray]) -> np.ndarray:
        """(stations, 6) motions."""
        out = np.zeros(6 * self.count)
        for b, vector in vectors.items():
            if b < len(self.parts):
                loaded, columns, inverse = self.parts[b]
                out[columns] += inverse @ (loaded.T @ vector)
        return out.reshape(self.count, 6)


def shares(motion: np.ndarray, gram: np.ndarray) -> dict[str, float]:
    """Modal mass that each family of section motions (s, 6) describes, by the names of
    ``FAMILIES``; `gram` is their mass matrix.
    """
    return {family: _share(motion, gram, components) for family, components in FAMILIES.items()}


def _share(motion: np.ndarray, gram: np.ndarray, components: Sequence[int]) -> float:
    """Modal mass that some components of section motions describe."""
    at = component_rows(range(len(motion)), components)
    part = motion.ravel()[at]
    return float(part @ gram[np.ix_(at, at)] @ part)


def _section_loads(block: Block, stations: np.ndarray, found: list[_Loads]) -> _Loads:
    """Loads, Gram matrix and columns of a block; of a twin those of its original, turned."""
    if not block.components:
        return np.zeros((block.size, 0)), np.zeros((0, 0)), np.zeros(0, int)
    if block.mirror is None:
        return block.section_loads(stations)
    original, signs = block.mirror
    loaded, gram = signed(lambda _: found[original][:2], signs)(stations)
    return loaded, gram, component_rows(range(len(stations)), block.components)


def _waving(n: int) -> str:
    """Family of shapes of one wave around the axis, or more."""
    return "bending" if n == 1 else f"ovalising n={n}"


class Names:
    """Families, twins and numbers of the shapes of one body, whose blocks they refer to, on its
    bearings.
    """

    def __init__(self, body: Body, supports: Supports, project: Projection):
        self.body, self.project = body, project
        self._with_masses = supports.inertia is not None
        self.promised = alike(supports)
        # a part that is not round promises no twins, however near its frequencies lie
        self._split = not body.mesh.get("round", True)
        self._planes = self._split and len(body.blocks) > 1
        self.without_axis = not body.mesh.get("axis", True)
        self._mirrored = any(block.mirror is not None for block in body.blocks)
        self._round = of_body(body)
        self._moving_axially: dict[int, np.ndarray] = {}
        # momenta of shapes by the identity of their profile, which is kept alive beside them
        self._momenta: dict[int, tuple[dict, dict[int, np.ndarray]]] = {}
        # what shapes do around the axis, in the same way
        self._fitted: dict[int, tuple[dict, np.ndarray, np.ndarray]] = {}

    def describe(self, vectors: dict[int, np.ndarray]) -> Shape:
        """Family, waves around, section motions and profile of one shape, by block index."""
        motion = self.project(vectors)
        described = shares(motion, self.project.gram)
        profile: np.ndarray | dict[int, np.ndarray] = vectors
        if self._round is not None:
            energy, profile = self._around(*self._round, vectors)
        elif any(several(self.body.block(b)) for b in vectors):
            energy = {
                (1 if name == "bending" else 0, name): share for name, share in described.items()
            }
        else:
            energy = self._by_block(vectors)
        waves, family = max(energy, key=energy.__getitem__)
        if self.without_axis:
            family = "mode"
        if self._round is not None:
            profile = profile[waves]
        captured = sum(described.values())
        if self._with_masses:
            # shares are of the mass of the shaft, of which unit shapes have less than one
            moved = (v @ (self.body.block(b).mass @ v) for b, v in vectors.items())
            captured /= float(sum(moved))
        whole = self._round is None and all(repeats(self.body.block(b)) for b in vectors)
        return Shape(family, waves, motion, captured, profile, whole, self._plane(motion, family))

    def _plane(self, motion: np.ndarray, family: str) -> str:
        """The plane of bending of a part with a mirror plane, unless bearings couple both."""
        if not self._planes or family != "bending":
            return ""
        at = [_share(motion, self.project.gram, components) for components in ((2, 3), (0, 5))]
        share = at[0] / sum(at)
        return "z" if share > 0.99 else "x" if share < 0.01 else ""

    def _waves(
        self, fit: Circumference, displacements: Displacements, vectors: dict[int, np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Profile of a shape by waves around the axis, and its shares, once a shape."""
        if id(vectors) not in self._fitted:
            self._fitted[id(vectors)] = vectors, *fit(displacements(vectors))
        return self._fitted[id(vectors)][1:]

    def _around(
        self,
        fit: Circumference,
        displacements: Displacements,
        vectors: dict[int, np.ndarray],
    ) -> tuple[dict[tuple[int, str], float], np.ndarray]:
        profile, share = self._waves(fit, displacements, vectors)
        radial, tangential, axial = share[0]
        energy = {
            (0, "torsion"): tangential,
            (0, self._along_or_across(vectors)): axial + radial,
        }
        energy |= {(n, _waving(n)): share[n].sum() for n in range(1, fit.waves + 1)}
        return energy, profile

    def _along_or_across(self, vectors: dict[int, np.ndarray]) -> str:
        """Family of a shape of n = 0, weighed by all of the mass: bins lose what turns within them."""
        breathes = all(self._radial_share(b, v) > 0.5 for b, v in vectors.items())
        return "breathing" if breathes else "axial"

    def unmixed(
        self, shapes: list[Shape], vectors: list[dict[int, np.ndarray]], value: np.ndarray
    ) -> list[Shape]:
        """Shapes named by the families that they hold together with their neighbours (values ascending):
        a mesh that is not quite round mixes those that lie nearer than it splits twins, and any
        mixture of them is as good a solution.
        """
        if self._round is None or self.without_axis:
            return shapes
        out, tolerance = list(shapes), 2 * self.body.mesh.get("pair_tolerance", 0.0)
        for held in dict.fromkeys(frozenset(v) for v in vectors):
            alike = np.array([i for i, v in enumerate(vectors) if v.keys() == held])
            apart = np.flatnonzero(np.diff(value[alike]) > tolerance * value[alike][1:]) + 1
            for near in np.split(alike, apart):
                if len(near) > 1:
                    named = self._by_family([shapes[i] for i in near], [vectors[i] for i in near])
                    for i, shape in zip(near, named):
                        out[i] = shape
        return out

    def _by_family(self, shapes: list[Shape], vectors: list[dict[int, np.ndarray]]) -> list[Shape]:
        """Neighbours, each named by a family that their space holds, as often as it holds it."""
        assert self._round is not None
        fitted = [self._waves(*self._round, v) for v in vectors]
        around = np.array([profile for profile, _ in fitted])
        level = around[:, 0].reshape(len(shapes), -1, 3)
        rows = {(0, "torsion"): level[:, :, 1], (0, ""): level[:, :, ::2].reshape(len(shapes), -1)}
        rows |= {(n, _waving(n)): around[:, n] for n in range(1, around.shape[1])}
        out = list(shapes)
        for i, (waves, family), weight in shared_out(rows, [share.sum() for _, share in fitted]):
            if not family:
                family = self._along_or_across(
                    {b: sum(w * v[b] for w, v in zip(weight, vectors)) for b in vectors[i]}
                )
            out[i] = replace(
                shapes[i],
                family=family,
                waves=waves,
                profile=around[i, waves],
                plane=self._plane(shapes[i].motion, family),
            )
        return out

    def _by_block(self, vectors) -> dict[tuple[int, str], float]:
        energy: dict[tuple[int, str], float] = {}
        for b, v in vectors.items():
            block = self.body.block(b)
            family = family_of(block)
            if family == "axial" and self._radial_share(b, v) > 0.5:
                family = "breathing"
            key = (waves_of(block), family)
            energy[key] = energy.get(key, 0.0) + float(v @ (block.mass @ v))
        return energy

    def _radial_share(self, b, v) -> float:
        """Share of the modal mass of a shape of n = 0 that moves across the axis: the mass couples no
        two directions, so they fall apart by themselves.
        """
        block = self.body.block(b)
        known = self._moving_axially
        if b not in known:
            along = np.zeros(block.size, bool)
            if 1 in block.components:
                along = block.rigid[:, block.components.index(1)] != 0
            if self._round is None:  # unknowns inside elements that no rigid motion moves
                count, label = connected_components(block.mass, directed=False)
                along = np.isin(label, np.unique(label[along]))
            known[b] = along
        radial = np.where(known[b], 0.0, v)
        return float(radial @ (block.mass @ radial)) / float(v @ (block.mass @ v))

    def overlap(self, a: Shape, b: Shape) -> float:
        """MAC of one shape, turned by a quarter of a wave, with another: 1 for twins, 0 for modes
        of other profiles.
        """
        if (
            a.family != b.family
            or a.waves < 1
            or (self._round is None and len(self.body.blocks) == 1)
        ):
            return 0.0
        one, other = a.profile, b.profile
        if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
            size = np.vdot(one, one).real * np.vdot(other, other).real
            return float(np.vdot(1j * one, other).real ** 2 / size)
        if not self._mirrored:
            return self._sections_alike(a.motion, b.motion)
        return self._turned(one, other) ** 2 / (self._turned(one, None) * self._turned(other, None))

    def _sections_alike(self, a: np.ndarray, b: np.ndarray) -> float:
        """The same by section motions, for a block that holds both planes."""
        gram, turned = self.project.gram, (a @ _QUARTER.T).ravel()
        size = (a.ravel() @ gram @ a.ravel()) * (b.ravel() @ gram @ b.ravel())
        return float((turned @ gram @ b.ravel()) ** 2 / size) if size > 0 else 0.0

    def _turned(self, a, b) -> float:
        """Mass product of a shape in blocks that mirror each other, turned into the other plane,
        with another; with itself, not turned, for None.
        """
        out, heavy = 0.0, self._momentum(a if b is None else b)
        for index, block in enumerate(self.body.blocks):
            if block.mirror is None:
                continue
            planes = (block.mirror[0], index)
            for p, q, sign in ((planes[0], planes[1], 1.0), (planes[1], planes[0], -1.0)):
                if b is None:
                    if p in a:
                        out += float(a[p] @ heavy[p])
                elif p in a and q in b:
                    out += sign * float(a[p] @ heavy[q])
        return out

    def _momentum(self, shape: dict[int, np.ndarray]) -> dict[int, np.ndarray]:
        """``M u`` by block, once a shape: every shape is held against all others."""
        if id(shape) not in self._momenta:
            heavy = {b: self.body.block(b).mass @ v for b, v in shape.items()}
            self._momenta[id(shape)] = shape, heavy
        return self._momenta[id(shape)][1]

    def pairs(self, shapes: list[Shape], value: np.ndarray) -> list[tuple[int, ...]]:
        """Groups of shapes that belong together, by their eigenvalues (k,), ascending: pairs and single
        modes in ascending order of the first member.
        """
        partner: dict[int, int] = {}
        for i, shape in enumerate(shapes):
            if shape.double or i in partner or not self._promises_twins(shape):
                continue
            others = [
                j
                for j in range(i + 1, len(shapes))
                if j not in partner
                and shapes[j].waves == shape.waves
                and shapes[j].family == shape.family
            ]
            like = {j: self.overlap(shape, shapes[j]) for j in others}
            twin = max(like, key=like.__getitem__, default=None)
            if twin is None or like[twin] < 0.5:
                # Shapes of a cluster mix: then the nearest is as good as any.
                near = others and value[others[0]] - value[i] <= self.usual(shape) * abs(value[i])
                twin = others[0] if near else None
            if twin is not None:
                partner[i] = partner[twin] = twin
        groups: list[tuple[int, ...]] = [
            (i, partner[i]) if i in partner else (i,)
            for i in range(len(shapes))
            if partner.get(i) != i
        ]
        return groups

    def _promises_twins(self, shape: Shape) -> bool:
        """True where symmetry gives a shape a twin: around N equal sectors none of N/2 waves has one."""
        if self._split or shape.waves < 1:
            return False
        if shape.waves == 1:
            return self.promised <= ALIKE
        sectors = self.body.mesh.get("sectors")
        return not sectors or 2 * shape.waves % sectors != 0

    def usual(self, shape: Shape) -> float:
        """Relative distance of eigenvalues that meshes like this one leave between the twins of a shape."""
        own = self.body.mesh.get("pair_tolerance", 1e-7)
        return 2 * max(own, self.promised) if shape.waves == 1 else max(2 * own, OVAL_TOLERANCE)
