"""Natural frequencies and mode shapes of a body on its bearings.

Symmetric shift-invert (:mod:`solidgear.solve.eigen`) about a small negative shift, with the bearings added to the factor of
the free body by the Woodbury identity.  Rigid motions that no spring resists are
known exactly; they are projected out and reported as 0 Hz instead of as noise.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field

import numpy as np

from solidgear.body import Body, as_supports, component_rows
from solidgear.errors import SolidgearError
from solidgear.frames import rotation
from solidgear.solve.eigen import Raw, Solved, count_below, lowest
from solidgear.solve.statics import SHIFT, factors
from solidgear.solve.supported import Supported, decoupled, groups
from solidgear.threads import pinned

STATIONS = 13
FAMILIES = {"bending": (0, 2, 3, 5), "axial": (1,), "torsion": (4,)}


@dataclass(frozen=True)
class Mode:
    """One natural frequency with all its shapes.

    Attributes
    ----------
    name : str
        Such as ``bending 1``, ``axial 1``, ``rigid torsion``.
    family : str
    frequency_hz : float
    multiplicity : int
        2 for a degenerate pair.
    vectors : tuple of dict
        One per shape: block index -> (n,) vector, mass-normalised over all blocks.
    motions : (multiplicity, STATIONS, 6) ndarray
        Section motions along the axis (mass-weighted projection).
    captured : float
        Share of the modal mass that section motions describe; small for ovalising or local modes.
    """

    name: str
    family: str
    frequency_hz: float
    multiplicity: int
    vectors: tuple[dict[int, np.ndarray], ...]
    motions: np.ndarray
    captured: float


@dataclass(frozen=True)
class ModeSet:
    """Modes in ascending order of frequency, and the evidence for them.

    ``evidence`` holds ``residual`` (largest ``|A^-1 M u - theta u| / theta`` in the mass norm, brought back from the shifted to
    the true eigenvalue: a bound on its relative error), ``orthogonality`` (largest entry of ``U'MU - I``),
    ``rigid_modes``, ``shift_rad2``, ``coupling_bound``, ``backend``, ``method`` and, where
    asked for, ``count`` and ``count_seconds``; ``torn_pairs`` where the mesh has split twins too far apart to be taken for one pair.
    """

    fidelity: str
    modes: tuple[Mode, ...]
    stations: np.ndarray
    gram: np.ndarray
    evidence: dict = field(default_factory=dict)

    @property
    def frequency_hz(self) -> np.ndarray:
        """Distinct natural frequencies, Hz."""
        return np.array([m.frequency_hz for m in self.modes])

    @property
    def names(self) -> tuple[str, ...]:
        """Names in the order of ``frequency_hz``."""
        return tuple(m.name for m in self.modes)

    @property
    def multiplicity(self) -> tuple[int, ...]:
        """Number of shapes at each frequency."""
        return tuple(m.multiplicity for m in self.modes)

    def named(self, name: str) -> Mode | None:
        """The mode of that name, or None."""
        return next((m for m in self.modes if m.name == name), None)


@pinned
def modes(
    body: Body,
    supports=(),
    n: int = 10,
    *,
    max_frequency: float | None = None,
    coupling_tolerance: float = 1e-6,
    method: str | None = None,
    count: bool = False,
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
        Eigensolver; None takes the quickest for the size and the back end (see :func:`solidgear.solve.eigen.lowest`).
    count : bool
        Check by the inertia of another factor that no mode was missed (Sylvester's law); costs about one more factorisation.

    Returns
    -------
    ModeSet

    Raises
    ------
    SolidgearError
        If ``n`` is not positive, the method unknown, or a mode was missed and could not be found.
    """
    if n < 1:
        raise SolidgearError(f"modes: n = {n} is not a number of modes; ask for 1 or more")
    supports = as_supports(supports)
    spring, bound = decoupled(body, supports, coupling_tolerance)
    parts, reach = _solved_parts(body, supports, spring, n, method)
    counted, start = [], time.perf_counter()
    if count:
        for part in parts:
            part.solved, verdict = _complete(part, reach, method)
            counted.append(verdict)
    spent = time.perf_counter() - start
    raw = [r for part in parts for r in part.everywhere(part.solved.elastic)]
    rigid = [r for part in parts for r in part.everywhere(part.solved.free)]
    raw.sort(key=lambda r: r.value)
    stations = np.linspace(0.0, body.length, STATIONS)
    project = _Projection(body, stations)
    found = _named(body, project, raw, rigid, n, max_frequency)
    evidence = {
        "residual": max((r.residual for r in raw[: n + 2]), default=0.0),
        "orthogonality": max(part.solved.orthogonality for part in parts),
        "rigid_modes": len(rigid),
        "shift_rad2": -SHIFT * body.scale,
        "coupling_bound": bound,
        "backend": "+".join(sorted({f.backend for f in factors(body)})),
        "method": "+".join(dict.fromkeys(part.solved.method for part in parts)),
    }
    if count:
        evidence |= {"count": counted, "count_seconds": spent}
    torn = _torn_pairs(found, supports)
    if torn:
        evidence["torn_pairs"] = torn
    return ModeSet(body.fidelity, found, stations, project.gram, evidence)


@dataclass
class _Part:
    """Blocks that belong together, what was asked of them and found; ``twins`` are lone blocks that repeat it in the other plane."""

    supported: Supported
    ask: int
    solved: Solved | None = None
    twins: list[int] = field(default_factory=list)

    def everywhere(self, found: list[Raw]) -> list[Raw]:
        """Eigenpairs of the group and of its twins."""
        return found + [Raw(r.value, {twin: next(iter(r.vectors.values()))}, r.residual) for twin in self.twins for r in found]


def _solved_parts(body, supports, spring, n: int, method: str | None) -> tuple[list[_Part], float]:
    """Eigenpairs of all groups, each searched only as far as the ``n`` lowest of all reach, and the highest of those."""
    parts: list[_Part] = []
    for group in groups(body, supports, spring):
        original = next((p for p in parts if _is_twin(body, supports, spring, group, p.supported.group)), None)
        if original is not None:
            original.twins.append(group[0])
        else:
            parts.append(_Part(Supported(body, supports, spring, group), n))
    if len(parts) > 1:
        # Bending pairs make most of a spectrum; whoever is asked for too little is asked again.
        for part in parts:
            part.ask = n // 3 + 1 if part.twins else n // 4 + 1
    waiting = parts
    while waiting:
        for part in waiting:
            part.solved = lowest(part.supported, part.ask, method)
        values = sorted(r.value for part in parts for r in part.everywhere(part.solved.elastic))
        reach = values[n - 1] if len(values) >= n else np.inf
        waiting = [p for p in parts if p.ask < n and p.solved.elastic and p.solved.elastic[-1].value <= 1.01 * reach]
        for part in waiting:
            part.ask = min(2 * part.ask, n)
    return parts, min(reach, values[-1]) if values else 0.0


def _complete(part: _Part, reach: float, method: str | None) -> tuple[Solved, dict]:
    """A result with no mode missed, and what the count says; a second search with more vectors where one was."""
    supported, solved, n = part.supported, part.solved, part.ask
    seen = count_below(supported, solved, reach)
    if seen is not None and seen.counted != seen.found:
        missed = seen.counted - seen.found
        solved = lowest(supported, n + 4 + 2 * abs(missed), "arpack" if solved.method == "lanczos" else "lanczos")
        seen = count_below(supported, solved, reach)
        if seen is not None and seen.counted != seen.found:
            raise SolidgearError(
                f"modes: {seen.found} modes were found below {np.sqrt(seen.below) / (2 * np.pi):.6g} Hz but the factor counts {seen.counted}; ask for more modes (n = {n})"
            )
    if seen is None:
        return solved, {"checked": False, "why": f"no inertia from {supported.backend}"}
    return solved, {"checked": True, "below_hz": float(np.sqrt(seen.below) / (2 * np.pi)), "modes": seen.counted, "backend": seen.backend}


def _is_twin(body, supports, spring, group: list[int], other: list[int]) -> bool:
    """Whether a lone block mirrors another one, springs included."""
    block = body.blocks[group[0]]
    if len(group) != 1 or block.mirror is None or other != [block.mirror[0]]:
        return False
    index, signs = block.mirror
    m = len(supports.ports)
    mine, theirs = (component_rows(range(m), b.components) for b in (block, body.blocks[index]))
    sign = np.tile(signs, m)
    a, b = spring[np.ix_(mine, mine)], spring[np.ix_(theirs, theirs)] * np.outer(sign, sign)
    return bool(np.abs(a - b).max(initial=0.0) <= 1e-14 * np.abs(b).max(initial=0.0))


TORN = 0.01  # relative; coarse tetrahedra were seen to split pairs by 5e-3, equal bearings split none


def _torn_pairs(found: tuple[Mode, ...], supports: Supports) -> list[tuple[str, str, float]]:
    """Neighbouring bending modes that differ by more than the bearings differ in x and z, and by less than modes do: twins that the mesh has split."""
    turn = np.kron(np.eye(len(supports.ports)), rotation(1, np.pi / 2))
    size = np.sqrt(np.abs(np.diag(supports.stiffness)))
    change = np.abs(turn @ supports.stiffness @ turn.T - supports.stiffness)
    unequal = (change / np.where(size > 0, size, np.inf) / np.where(size > 0, size, np.inf)[:, None]).max(initial=0.0)
    bending = [m for m in found if m.family == "bending" and m.frequency_hz > 0]
    gaps = [(a, b, b.frequency_hz / a.frequency_hz - 1) for a, b in zip(bending, bending[1:]) if a.multiplicity == b.multiplicity == 1]
    return [(a.name, b.name, float(gap)) for a, b, gap in gaps if unequal < gap < TORN]


class _Projection:
    """Mass-weighted projection of shapes onto section motions along the axis."""

    def __init__(self, body: Body, stations: np.ndarray):
        size = 6 * len(stations)
        self.body, self.count = body, len(stations)
        self.gram = np.zeros((size, size))
        self.parts = []
        for block in body.blocks:
            fields, columns = block.station_fields(stations) if block.components else (np.zeros((block.size, 0)), [])
            loaded = block.mass @ fields
            columns = np.asarray(columns, int)
            gram = fields.T @ loaded
            self.gram[np.ix_(columns, columns)] += gram
            self.parts.append((loaded, columns, np.linalg.pinv(gram, rcond=1e-12, hermitian=True)))

    def __call__(self, vectors: dict[int, np.ndarray]) -> np.ndarray:
        """(stations, 6) motions."""
        out = np.zeros(6 * self.count)
        for b, vector in vectors.items():
            loaded, columns, inverse = self.parts[b]
            out[columns] += inverse @ (loaded.T @ vector)
        return out.reshape(self.count, 6)

    def shares(self, motion: np.ndarray) -> dict[str, float]:
        """Modal mass described by each family of section motions."""
        out = {}
        for family, components in FAMILIES.items():
            at = np.array([6 * s + c for s in range(self.count) for c in components])
            part = motion.ravel()[at]
            out[family] = float(part @ self.gram[np.ix_(at, at)] @ part)
        return out


def _named(body, project, raw, rigid, n, max_frequency):
    """Group twins, name families, and cut the list without tearing a pair apart."""
    pair_tolerance = body.mesh.get("pair_tolerance", 1e-7)
    out: list[Mode] = []
    for r in rigid:
        motion = project(r.vectors)
        shares = project.shares(motion)
        family = max(shares, key=shares.get)
        if sum(s > 0.01 for s in shares.values()) > 1:
            name = "rigid (combined)"
        else:
            name = f"rigid {family}"
        out.append(Mode(name, family, 0.0, 1, (r.vectors,), motion[None], sum(shares.values())))
    count: dict[str, int] = {}
    taken, i = 0, 0
    described = []
    for r in raw:
        motion = project(r.vectors)
        shares = project.shares(motion)
        captured = sum(shares.values())
        block_names = {body.blocks[b].name for b in r.vectors}
        own = next(iter(block_names)) if len(block_names) == 1 else ""
        if own.startswith("ovalising"):
            family = own.replace("_", " n=")
        else:
            family = max(shares, key=shares.get) if captured > 0.3 else "local"
        described.append((r, family, motion, captured))
    while i < len(described) and taken < n:
        r, family, motion, captured = described[i]
        frequency = np.sqrt(max(r.value, 0.0)) / (2 * np.pi)
        if max_frequency is not None and frequency > max_frequency:
            break
        pair = [i]
        if i + 1 < len(described) and (family in ("bending", "local") or family.startswith("ovalising")):
            other, other_family = described[i + 1][0], described[i + 1][1]
            if other_family == family and other.value - r.value <= 2 * pair_tolerance * abs(r.value):
                pair.append(i + 1)
        members = [described[j] for j in pair]
        count[family] = count.get(family, 0) + 1
        mean = np.sqrt(np.mean([max(x[0].value, 0.0) for x in members])) / (2 * np.pi)
        # An n >= 2 block stands for its cosine and its sine form.
        double = 2 if family.startswith("ovalising") and len(pair) == 1 else len(pair)
        out.append(
            Mode(
                f"{family} {count[family]}",
                family,
                float(mean),
                double,
                tuple(x[0].vectors for x in members),
                np.array([x[2] for x in members]),
                float(min(x[3] for x in members)),
            )
        )
        taken += double
        i += len(pair)
    return tuple(out)
