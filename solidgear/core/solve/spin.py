r"""Natural frequencies under spin, from modes at rest.

A shape u of a body of revolution that turns at :math:`\Omega`, seen from outside, moves particles
at :math:`\partial u/\partial t + \Omega\,\partial u/\partial\theta`, components taken along fixed
axes. Of the kinetic energy the term linear in the speed couples two shapes a and b of unit mass by

.. math:: G_{ab} = \int \rho\, a \cdot \partial b/\partial\theta,

which is antisymmetric. With n turns in a second the shapes x of frequencies F at rest, Hz, whirl at f,

.. math:: (F^2 - f^2 + 2 i f n G)\, x = 0,

the eigenvalues of a Hermitian matrix (:func:`whirled`); a few modes above the one in question are
enough for three digits. To first order twins part to :math:`F \pm |G|\,n`, and two modes that lie 2 D
apart to :math:`\pm\sqrt{D^2 + (G n)^2}` about their mean. What grows with the square of the speed is
left out: centrifugal terms and stress stiffening, which only belong together. Sections that move as
one have none of the former. Two waves around and more are mainly carried round, which is all of first
order: there the linear term must not be followed any further by itself.

With p, q and w of :mod:`solidgear.core.models.harmonic.blocks` a shape of n waves and its twin, a quarter
of a wave further round, have :math:`G = (n - 1) M_p + (n + 1) M_q + n M_w`; of a beam, whose sections
tilt as one, that is the rotary inertia (Genta 2005, Dynamics of Rotating Systems, ch. 4). Bodies whose
model gives no such matrix are taken as beams: their sections tilt as one too.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from solidgear.core.body import FURTHER, Body, Supports
from solidgear.core.body.model import SINE
from solidgear.core.solve.circumference import Circumference, circumference_of
from solidgear.core.solve.families import FAMILIES
from solidgear.core.solve.modes import Mode

#: stations along a body whose sections are taken as rigid discs
STATIONS = 60
#: unknowns of one shape by block
Vectors = Mapping[int, np.ndarray]


class Whirl(NamedTuple):
    """What spin does to the frequency of a mode."""

    #: of the shapes of the mode that spin moves down, and up, the most: by how much of the frequency
    down: float
    up: float
    first_order: bool  #: whether it is known to first order alone


def couplings(body: Body, supports: Supports, shapes: Sequence[Vectors]) -> np.ndarray:
    """Compute the antisymmetric (k, k) couplings G between shapes of unit mass, masses on ports
    included, of a body that turns about its axis.
    """
    fit_and_motion = circumference_of(body)
    if fit_and_motion is not None:
        fit, displacements = fit_and_motion
        profiles = [fit(displacements(shape))[0] for shape in shapes]
        heavy = [sum(v @ (body.block(b).mass @ v) for b, v in s.items()) for s in shapes]
        out = _around(fit, profiles, np.array(heavy))
    elif any(block.swirl is not None for block in body.blocks):
        out = np.zeros((len(shapes), len(shapes)))
        for cosine, sine in _twins(body, shapes):
            swirl = body.block(cosine).swirl
            if swirl is not None:
                out += _antisymmetric(_columns(shapes, cosine), _columns(shapes, sine), swirl)
    else:
        out = _of_sections(body, shapes)
    return out + _of_masses(body, supports, shapes)


def opened(frequency: np.ndarray, coupling: np.ndarray, turns: float) -> np.ndarray:
    """Return (k,) frequencies, Hz, by which spin of so many turns a second parts each shape from
    the one that it is coupled with most, by the frequencies at rest, Hz, and the :func:`couplings`.

    Examples
    --------
    >>> opened(np.array([100.0, 100.0]), np.array([[0.0, 0.5], [-0.5, 0.0]]), turns=20.0)
    array([10., 10.])
    """
    half = np.abs(frequency[:, None] - frequency) / 2
    return (np.hypot(half, coupling * turns) - half).max(axis=1, initial=0.0)


def whirled(frequency: np.ndarray, coupling: np.ndarray, turns: float) -> np.ndarray:
    """Return (k,) frequencies, Hz, at which shapes whirl at so many turns a second, each in the place
    of the shape that it comes from, by the frequencies at rest, Hz, and the :func:`couplings`.

    With the velocities and F times the displacements the motion has a skew matrix, whose eigenvalues
    are all imaginary.

    Examples
    --------
    >>> pair = np.array([[0.0, 0.5], [-0.5, 0.0]])
    >>> [round(float(f), 2) for f in sorted(whirled(np.array([100.0, 100.0]), pair, turns=20.0))]
    [90.5, 110.5]
    """
    from scipy.optimize import linear_sum_assignment  # start-up: of files with a speed alone

    count, at_rest = len(frequency), np.diag(frequency)
    skew = np.block([[-2 * turns * coupling, -at_rest], [at_rest, np.zeros((count, count))]])
    values, vectors = np.linalg.eigh(1j * skew)
    values, vectors = values[count:], vectors[:, count:]  # the others are the same with other signs
    share = np.abs(vectors[:count]) ** 2 + np.abs(vectors[count:]) ** 2
    # two shapes may share two whirls equally: the nearer one is its own
    ratio = np.maximum(values, 0.0)[None, :] / frequency[:, None]
    near = np.minimum(ratio, 1 / np.maximum(ratio, 1e-300))
    shapes, whirls = linear_sum_assignment(-share * near)
    out = np.empty(count)
    out[shapes] = values[whirls]
    return out


def spin_moves(
    body: Body, supports: Supports, modes: Sequence[Mode], turns: float
) -> dict[str, Whirl]:
    """Return what so many turns a second do to each of some elastic modes, by name."""
    shapes = [
        (mode, shape) for mode in modes if mode.frequency_hz > 0 for shape in whole_shapes(mode)
    ]
    frequency = np.array([mode.frequency_hz for mode, _ in shapes])
    coupling = couplings(body, supports, [shape for _, shape in shapes])
    opening = opened(frequency, coupling, turns)
    beamlike = np.array([mode.family in FAMILIES for mode, _ in shapes], bool)
    moved = np.zeros(len(shapes))
    inside = np.ix_(beamlike, beamlike)
    moved[beamlike] = whirled(frequency[beamlike], coupling[inside], turns) - frequency[beamlike]
    out: dict[str, Whirl] = {}
    for k, (mode, _) in enumerate(shapes):
        name, f = str(mode.name), mode.frequency_hz
        down, up = (moved[k], moved[k]) if beamlike[k] else (-opening[k], opening[k])
        before = out.get(name, Whirl(np.inf, -np.inf, False))
        out[name] = Whirl(
            min(before.down, float(down / f)), max(before.up, float(up / f)), not beamlike[k]
        )
    return out


def whole_shapes(mode: Mode) -> list[Vectors]:
    """Return the shapes of a mode, with the twin where one shape stands for both."""
    shapes: list[Vectors] = list(mode.vectors)
    if len(shapes) < mode.multiplicity:
        shapes += [{b - FURTHER + SINE: v for b, v in shape.items()} for shape in mode.vectors]
    return shapes


def _twins(body: Body, shapes: Sequence[Vectors]) -> Iterator[tuple[int, int]]:
    """Yield blocks and those a quarter of a wave further round."""
    yield from ((b.mirror[0], k) for k, b in enumerate(body.blocks) if b.mirror is not None)
    further = {b for shape in shapes for b in shape if FURTHER <= b < SINE}
    yield from ((b, b - FURTHER + SINE) for b in sorted(further))


def _columns(shapes: Sequence[Vectors], block: int) -> list[np.ndarray | None]:
    return [shape.get(block) for shape in shapes]


def _antisymmetric(cosine: list, sine: list, swirl) -> np.ndarray:
    """Return G of shapes by their unknowns on a block and on the twin block; None where there are
    none.
    """
    out = np.zeros((len(cosine), len(cosine)))
    cosine_shapes = [k for k, vector in enumerate(cosine) if vector is not None]
    sine_shapes = [k for k, vector in enumerate(sine) if vector is not None]
    if cosine_shapes and sine_shapes:
        moved = swirl(np.column_stack([sine[k] for k in sine_shapes]))
        out[np.ix_(cosine_shapes, sine_shapes)] = (
            np.column_stack([cosine[k] for k in cosine_shapes]).T @ moved
        )
    return out - out.T


def _around(fit: Circumference, profiles: Sequence[np.ndarray], heavy: np.ndarray) -> np.ndarray:
    """Return G of shapes of a 3D mesh by their amplitudes around the axis, and the modal mass of
    each.

    ``u_z + i u_x`` holds ``(R + i T) / 2`` of n + 1 turns and ``(R* + i T*) / 2`` of 1 - n for
    radial and tangential amplitudes R and T of n waves. Each shape is taken as the waves that it
    has most of: cells around the axis see a little of others in it.
    """
    count = len(profiles)
    amplitudes = np.array(profiles).reshape(count, fit.waves + 1, -1, 3)
    share = (np.abs(amplitudes) ** 2).sum(axis=(2, 3))
    largest = share.argmax(axis=1)
    out = np.zeros((count, count))
    for n in set(largest) - {0}:
        members = np.flatnonzero(largest == n)
        radial, tangential, axial = np.moveaxis(amplitudes[members, n], 2, 0)
        forward, backward = radial + 1j * tangential, (radial - 1j * tangential).conj()
        parts = ((n + 1) / 2, forward), ((1 - n) / 2, backward), (n, axial)
        coupled = -sum(turns * (part.conj() @ part.T).imag for turns, part in parts)
        size = np.sqrt(heavy[members] / share[members, n])
        out[np.ix_(members, members)] = np.outer(size, size) * (coupled - coupled.T) / 2
    return out


def _of_sections(body: Body, shapes: Sequence[Vectors]) -> np.ndarray:
    """Return G of a body whose sections tilt as one, each with half its polar inertia."""
    stations = np.linspace(0.0, body.length, STATIONS)
    tilt = np.zeros((2, STATIONS, len(shapes)))
    diametral = np.zeros((2, STATIONS, STATIONS))
    for k, block in enumerate(body.blocks):
        held = [(place, c) for place, c in enumerate((3, 5)) if c in block.components]
        columns = [(i, s[k]) for i, s in enumerate(shapes) if k in s]
        if not held or not columns:
            continue
        loads, gram, index = block.section_loads(stations)
        vectors = np.column_stack([vector for _, vector in columns])
        motion = np.linalg.lstsq(gram, loads.T @ vectors, rcond=None)[0]
        for place, component in held:
            rows = np.flatnonzero(index % 6 == component)
            tilt[place][:, [i for i, _ in columns]] += motion[rows]
            diametral[place] = gram[np.ix_(rows, rows)]
    half = tilt[1].T @ (diametral.sum(axis=0) / 2) @ tilt[0]
    return half - half.T


def _of_masses(body: Body, supports: Supports, shapes: Sequence[Vectors]) -> np.ndarray:
    """Return G of rigid masses on ports, which tilt as one: half their polar inertia."""
    if supports.inertia is None:
        return np.zeros((len(shapes), len(shapes)))
    rows = supports.rows(body)
    motion = np.zeros((6 * len(body.ports), len(shapes)))
    for k, shape in enumerate(shapes):
        for b, vector in shape.items():
            if b < len(body.blocks):
                motion[body.rows(body.blocks[b]), k] += body.blocks[b].ports @ vector
    about_x, about_z = (motion[rows][place::6] for place in (3, 5))
    polar = np.diag(supports.inertia)[4::6, None]
    half = about_z.T @ (polar / 2 * about_x)
    return half - half.T
