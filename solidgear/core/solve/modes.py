"""Natural frequencies and mode shapes of a body on bearings.

Symmetric shift-invert (:mod:`solidgear.core.solve.eigen`) about a small negative shift, with the
bearings added to the factor of the free body by the Woodbury identity, and values from the
stiffness itself (:mod:`solidgear.core.solve.refine`). Rigid motions that no spring resists are known
exactly; they are projected out and reported as 0 Hz instead of as noise.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from solidgear.core.body import FURTHER, Body, as_supports
from solidgear.core.body.cache import LastTwo
from solidgear.core.body.mode_names import BENDING, ModeName, meant, numbered
from solidgear.core.body.supports import Holding
from solidgear.core.display import Displayed
from solidgear.core.errors import SolidgearError
from solidgear.core.machine.threads import pinned
from solidgear.core.named import NamedModes
from solidgear.core.registry import addition
from solidgear.core.scene import Scene
from solidgear.core.solve.coupling import decoupled
from solidgear.core.solve.eigen import Raw
from solidgear.core.solve.groups import (
    Part,
    Uncounted,
    complete,
    completeness_limits,
    family_rows,
    further_parts,
    reach_of,
    solved_parts,
)
from solidgear.core.solve.naming import Names, Projection
from solidgear.core.solve.shifted import SHIFT, factors

STATIONS = 13
#: relative error of a frequency above which it is not reported
WRONG = 1e-3


@dataclass(frozen=True)
class Mode:
    """One natural frequency with all shapes."""

    name: ModeName  #: such as ``bending 1``, ``axial 1``, ``rigid torsion``
    family: str
    frequency_hz: float
    multiplicity: int  #: 2 for a degenerate pair
    #: one per shape: block index -> (n,) vector, mass-normalised over all blocks
    vectors: tuple[dict[int, np.ndarray], ...]
    #: (multiplicity, s, 6) section motions along the axis (mass-weighted projection)
    motions: np.ndarray
    #: share of the modal mass that section motions describe; small for ovalising modes and for
    #: discs that bend
    captured: float
    #: waves around the axis: 0 for axial, breathing and torsion, 1 for bending, 2 and more for
    #: ovalising
    waves: int = 0
    #: bound on the relative error of the frequency that the solution of the eigenproblem leaves
    #: (not that of the mesh)
    error: float = 0.0
    #: relative distance of the frequencies of a pair that the mesh, or unequal bearings, have
    #: split; `frequency_hz` is between them
    split: float = 0.0

    @property
    def left(self) -> float:
        """Relative error that the solution leaves: that of the eigenproblem, and half the split of
        twins.
        """
        return self.error + self.split / 2


@dataclass(frozen=True, repr=False)
class ModeSet(NamedModes[Mode], Displayed):
    """Modes in ascending order of frequency, and the evidence for them."""

    shown: ClassVar[str] = "mode_set"

    fidelity: str
    modes: tuple[Mode, ...]
    stations: np.ndarray  #: (s,) places of section motions, m
    gram: np.ndarray  #: (6 s, 6 s) their mass matrix
    #: ``residual`` (largest ``|A^-1 r|_A / |u|_A`` of a mode and its residual force, brought back
    #: from the shifted to the true eigenvalue), ``error`` (largest :attr:`Mode.error`), ``steps``
    #: (corrections that were needed), ``orthogonality`` (largest entry of ``U'MU - I``),
    #: ``rigid_modes``, ``shift_rad2``, ``coupling_bound``, ``backend``, ``method``; ``families``, a
    #: list of ``{family, n, counted, modes_below, lowest_hz}`` with ``n`` None for a body that
    #: holds all motions in one and ``above`` where a row stands for all of more waves, which begin
    #: at ``lowest_hz`` at the earliest; ``split_pairs``, names and splits where the mesh has split
    #: twins further than meshes like it do. Where asked for, ``count``, ``count_seconds`` and
    #: ``counted_below_hz``, below which the body as meshed has no further mode of any family
    #: listed.
    evidence: dict = field(default_factory=dict)
    #: further modes of the body's own blocks that were solved and lie above the end of the list,
    #: because ovalising ones took their places
    beyond: tuple[Mode, ...] = ()
    #: all others that were solved to know that the list is whole, as far as none of their family is
    #: missing between: neighbours of modes of the list
    above: tuple[Mode, ...] = ()
    #: that the bearings are of, where a whole scene was given
    scene: Scene | None = field(default=None, repr=False)

    @cached_property
    def cautions(self) -> tuple[str, ...]:
        """Sentences on what the frequencies of a scene leave out, such as the speed that it states;
        none of a body on bearings of no scene.
        """
        number_cautions = addition("remark", "numbers")  # which solves modes itself
        if self.scene is None or number_cautions is None:
            return ()
        names = [str(mode.name) for mode in self.modes if mode.frequency_hz > 0]
        return tuple(number_cautions(self.scene, dict.fromkeys(names), self.fidelity))

    @property
    def listed_modes(self) -> tuple[Mode, ...]:
        """Modes of the list."""
        return self.modes

    @property
    def solved(self) -> tuple[Mode, ...]:
        """The list and all others that were solved."""
        return (*self.modes, *self.beyond, *self.above)

    @property
    def whole(self) -> ModeSet:
        """The list with all others that were solved in it."""
        ascending = sorted(self.solved, key=lambda mode: mode.frequency_hz)
        return replace(self, modes=tuple(ascending), beyond=(), above=())

    @property
    def frequency_hz(self) -> np.ndarray:
        """(k,) distinct natural frequencies, Hz."""
        return np.array([m.frequency_hz for m in self.modes])

    @property
    def names(self) -> tuple[ModeName, ...]:
        """Names in the order of ``frequency_hz``."""
        return tuple(m.name for m in self.modes)

    @property
    def multiplicity(self) -> tuple[int, ...]:
        """Number of shapes at each frequency."""
        return tuple(m.multiplicity for m in self.modes)

    def named(self, name: str) -> Mode | None:
        """Return the mode of a name, also among those beyond the end of the list.

        Parameters
        ----------
        name : str
            Such as ``bending 1``. Where bending is named by its plane, ``bending 1`` and ``bending
            2`` are the first and the second of both planes in order of frequency, as they are of a
            part without a mirror plane: which way a keyway looks does not matter.
        """
        ascending = sorted((*self.modes, *self.beyond), key=lambda mode: mode.frequency_hz)
        place = meant(name, [mode.name for mode in ascending])
        return None if place is None else ascending[place]


@pinned
def modes(
    body: Body,
    supports: Holding = (),
    n: int = 10,
    *,
    max_frequency: float | None = None,
    coupling_tolerance: float = 1e-6,
    method: str | None = None,
    count: bool = False,
    ovalising: bool = True,
    room: float = 0.0,
    stations: int = STATIONS,
) -> ModeSet:
    """Lowest modes of a supported body.

    Parameters
    ----------
    body : Body
    supports : Scene, Supports or iterable of bearings
    n : int
        Number of elastic shapes wanted; twins count twice and are never torn apart.
        Rigid motions come on top, at 0 Hz.
    max_frequency : float, optional
        Leave out modes above this frequency, Hz.
    coupling_tolerance : float
        Bearing terms that couple bending planes, axial motion and torsion are left out
        when they provably change no eigenvalue by more than this, relative; the bound is reported.
    method : {None, 'lanczos', 'arpack', 'dense'}
        Eigensolver; None takes the quickest for the size and the back end (see
        :func:`solidgear.core.solve.eigen.lowest`).
    count : bool
        Check by a second factorisation that no mode was missed (Sylvester's law of inertia); costs
        about one more factorisation.
    ovalising : bool
        Solve the families of two waves around and more that begin below the highest mode reported,
        for a body that can build them (a harmonic solid).
    room : float
        Solve every family on, from its first mode above the list to one whose eigenvalue leaves that
        one so much room, relative to the higher: error bars rest on it. By default none.
    stations : int
        Number of sections along the shaft whose motions are given for every mode.

    Returns
    -------
    ModeSet

    Raises
    ------
    SolidgearError
        If ``n`` is not positive, the method unknown, a mode was missed and could not be found, or
        rounding leaves a frequency too few digits.

    Examples
    --------
    A slender free rod, whose first bending is ``(4.73 / L)^2 sqrt(E I / rho A) / 2 pi``:

    >>> import numpy as np
    >>> import solidgear as sg
    >>> rod = sg.Segment.cylinder("rod", length=0.6, diameter=0.02)
    >>> scene = sg.Scene.from_parts([rod])
    >>> found = sg.modes(sg.build(scene, "euler"), scene, n=2)
    >>> found.names[-1], found.multiplicity[-1]
    ('bending 1', 2)
    >>> wave = np.sqrt(sg.STEEL.E / sg.STEEL.density) * 0.02 / 4
    >>> formula = (4.730041 / 0.6) ** 2 * wave / (2 * np.pi)
    >>> bool(np.isclose(found.named("bending 1").frequency_hz, formula, rtol=1e-6))
    True
    """
    if n < 1:
        raise SolidgearError(f"modes: n = {n} is not a number of modes; ask for 1 or more")
    if body.mesh.get("modes_kept") == 0:
        raise SolidgearError(
            f"{body.fidelity}: a body of modes = 0 is for statics and has no natural frequencies; keep "
            "some of its free modes"
        )
    if body.factoring.engine == "petsc-gamg":
        raise SolidgearError(
            "modes: engine = petsc-gamg solves statics only; use engine = petsc, whose factor finds modes"
        )
    scene = supports if isinstance(supports, Scene) else None
    supports = as_supports(supports)
    spring, bound = decoupled(body, supports, coupling_tolerance)
    own_parts = solved_parts(body, supports, spring, n, method, room)
    highest = np.inf if max_frequency is None else (2 * np.pi * max_frequency) ** 2
    parts, uncounted = own_parts, list[Uncounted]()
    if ovalising and body.further is not None:
        more, uncounted = further_parts(body, own_parts, n, highest, method, room)
        parts = own_parts + more
    start = time.perf_counter()
    verdicts: list[dict] = []
    if count:
        reach = reach_of(parts, n, highest)
        verdicts = [complete(part, reach, method) for part in parts]
    spent = time.perf_counter() - start
    kept = body.cache.get(_Projections, _Projections)
    if stations not in kept:
        kept[stations] = Projection(body, np.linspace(0.0, body.length, stations))
    project = kept[stations]
    names = body.cache.get(_NamesOnBody, _NamesOnBody).on(
        (*supports.key, stations), lambda: Names(body, supports, project)
    )
    rigid = [r for part in parts for r in part.with_twins(part.solved.free)]
    listed, further, above, split_pairs, family_frequencies = _named(
        body, names, parts, n, max_frequency
    )
    evidence = {
        "residual": max((r.residual for r in _lowest(parts, n + 2)), default=0.0),
        "error": max((m.error for m in listed), default=0.0),
        "steps": max(part.solved.steps for part in parts),
        "orthogonality": max(part.solved.orthogonality for part in parts),
        "rigid_modes": len(rigid),
        "shift_rad2": -SHIFT * body.scale,
        "coupling_bound": bound,
        "backend": "+".join(sorted({f.label for f in factors(body)})),
        "method": "+".join(dict.fromkeys(part.solved.method for part in parts)),
        "families": family_rows(parts, uncounted, family_frequencies),
    }
    if count:
        evidence |= {"count": verdicts, "count_seconds": spent}
        if all(verdict["checked"] for verdict in verdicts):
            evidence["counted_below_hz"] = min(
                [verdict["below_hz"] for verdict in verdicts] + [u.begins_hz for u in uncounted]
            )
    if split_pairs:
        evidence["split_pairs"] = split_pairs
    return ModeSet(
        body.fidelity,
        (*_rigid(names, rigid), *listed),
        np.linspace(0.0, body.length, stations),
        project.gram,
        evidence,
        further,
        above,
        scene,
    )


class _Projections(dict[int, Projection]):
    """Projections of shapes onto section motions by the number of stations; springs do not matter."""


class _NamesOnBody(LastTwo[Names]):
    """Names of the shapes of a body on some springs: who asks for more modes, or for their count,
    goes on from those that have one.
    """


def _lowest(parts: list[Part], count: int) -> list[Raw]:
    raw = [r for part in parts for r in part.with_twins(part.solved.elastic)]
    return sorted(raw, key=lambda r: r.value)[:count]


def _rigid(names: Names, raw: list[Raw]):
    """Yield modes at 0 Hz."""
    for r in raw:
        motion = names.project(r.vectors)
        described = names.project.shares.by_family(motion)
        family = max(described, key=described.__getitem__)
        several = sum(share > 0.01 for share in described.values()) > 1
        name = "rigid (combined)" if several else f"rigid {family}"
        if names.without_axis:
            name, family = "rigid motion", "mode"
        yield Mode(
            ModeName(name),
            family,
            0.0,
            1,
            (r.vectors,),
            motion[None],
            sum(described.values()),
            int(family == BENDING),
        )


def _named(body, names: Names, parts: list[Part], n: int, max_frequency: float | None):
    """Number and name all modes: return the list, modes of the body's own blocks beyond the end of
    the list and modes above those, names and splits of pairs that are unusually far apart, and
    (family, frequency, shapes) of all modes found; no pair is cut in two.
    """
    complete_to = completeness_limits(parts)
    raw = _lowest(parts, sum(len(part.with_twins(part.solved.elastic)) for part in parts))
    shapes = names.describe([r.vectors for r in raw])
    value = np.array([r.value for r in raw])
    shapes = names.unmixed(shapes, [r.vectors for r in raw], value)
    groups = names.pairs(shapes, value)
    labels = numbered([shapes[group[0]].label for group in groups])
    listed: list[Mode] = []
    beyond_list: list[Mode] = []
    above: list[Mode] = []
    family_frequencies: list[tuple[str, float, int]] = []
    split_pairs: list[tuple[ModeName, float]] = []
    room = room_of_own_blocks = n
    for group, label in zip(groups, labels):
        members, first = [raw[i] for i in group], shapes[group[0]]
        frequency = float(np.sqrt(np.mean([max(r.value, 0.0) for r in members])) / (2 * np.pi))
        double = 2 if first.double else len(group)
        family_frequencies.append((first.family, frequency, double))
        too_high = max_frequency is not None and frequency > max_frequency
        mode = Mode(
            name=label,
            family=first.family,
            frequency_hz=frequency,
            multiplicity=double,
            vectors=tuple(r.vectors for r in members),
            motions=np.array([shapes[i].motion for i in group]),
            captured=float(min(shapes[i].captured for i in group)),
            waves=first.waves,
            error=float(max(r.error for r in members) / 2),
            split=float(np.sqrt(members[-1].value / members[0].value) - 1) if group[1:] else 0.0,
        )
        of_own_blocks = all(b < FURTHER for r in members for b in r.vectors)
        if room > 0 and not too_high:
            listed.append(_sound(body, mode, parts))
            if value[group[-1]] > (1 + names.usual(first)) * value[group[0]]:
                split_pairs.append((mode.name, mode.split))
        elif of_own_blocks and room_of_own_blocks > 0 and not too_high:
            beyond_list.append(mode)
        elif all(r.value <= complete_to[b] for r in members for b in r.vectors):
            above.append(mode)
        room -= mode.multiplicity
        room_of_own_blocks -= mode.multiplicity if of_own_blocks else 0
    return tuple(listed), tuple(beyond_list), tuple(above), split_pairs, family_frequencies


def _sound(body: Body, mode: Mode, parts: list[Part]) -> Mode:
    """Return the mode unless rounding may move the frequency by more than ``WRONG``, else raise a
    SolidgearError that names the cause; `parts` are those that the mode was found in.
    """
    if mode.error > WRONG:
        doubt = (
            f"modes: rounding may move {mode.name} ({mode.frequency_hz:.6g} Hz) "
            f"by {100 * mode.error:.2g} %"
        )
        if _by_springs(mode, parts) > mode.error / 2:
            raise SolidgearError(
                f"{doubt}: bearings resist it by a small difference of large coupled stiffnesses; "
                "give the bearing a stiffness that is clearly positive in every direction, or zero"
            )
        highest = (
            max(part.supported.highest for part in parts) / (2 * np.pi * mode.frequency_hz) ** 2
        )
        raise SolidgearError(
            f"{doubt}: the smallest cell of the {body.fidelity} body is so stiff that eigenvalues "
            f"span {np.log10(highest):.0f} of 16 digits; use a coarser mesh (lower order, fewer "
            "layers), or a beam for so slender a shaft"
        )
    return mode


def _by_springs(mode: Mode, parts: list[Part]) -> float:
    """Return the share of the relative error of a frequency that comes from the rounding of the
    bearings' stiffness.
    """
    value, lost = (2 * np.pi * mode.frequency_hz) ** 2, 0.0
    for part in parts:
        supported = part.supported
        for vectors in mode.vectors:
            if not set(vectors) & set(supported.group):
                continue
            pieces = [
                vectors.get(b, np.zeros(k.size)) for b, k in zip(supported.group, supported.blocks)
            ]
            u = np.concatenate(pieces)
            lost = max(lost, float(supported.spring_rounding(u[:, None])[0]))
    return lost / (2 * value)
