"""Beam finite elements for stepped, tapered and hollow shafts: Euler-Bernoulli and Timoshenko.

One element serves both theories and any taper.  Its stiffness is the inverse of the tip
flexibility of the element clamped at one end, integrated over the true section; its mass
is consistent with the displacement field of that static problem.  A uniform element is
the textbook one.  Nothing here is shared with the solid builders: that
independence is what makes a comparison worth having.

A port is tied to the beam as the scene says.  ``section`` is the beam's own node.  ``average`` is the
area-weighted least-squares rigid motion of the seat's surface, which a beam moves section by section: with
deflection w, turn th and radius r the port motion (d, ph) minimises, over the seat,
``int [2 pi (w - d - ph (y - y0))^2 + pi r^2 (th - ph)^2] r ds``.  What a beam lacks against a solid is then the
distortion of sections and not the width of the seat.  ``rigid`` lets the beam move as one piece along the seat.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp

from solidgear.body import Block, Body, Port
from solidgear.errors import SolidgearError
from solidgear.fidelity.attachment import tie_rigidly
from solidgear.fidelity.options import checked
from solidgear.fidelity.scale import elastic_scale

if TYPE_CHECKING:
    from solidgear.scene import Segment

# Shortest Euler element over the length of the shaft.
SHORTEST = 3e-4
_GAUSS = np.polynomial.legendre.leggauss(8)


def shear_coefficient(nu: float, outer, inner):
    """Timoshenko shear coefficient of a circular tube (Hutchinson 2001, J. Appl. Mech. 68, eq. 49).

    For a solid circle it is ``6 (1+nu)^2 / (7 + 12 nu + 4 nu^2)``.

    Parameters
    ----------
    nu : float
    outer, inner : float or ndarray
        Radii, m.
    """
    a, b = np.asarray(outer, float), np.asarray(inner, float)
    a2, b2 = a * a, b * b
    top = 6 * (1 + nu) ** 2 * (a2 + b2) ** 2
    bottom = (
        7 * a2**2
        + 34 * a2 * b2
        + 7 * b2**2
        + nu * (12 * a2**2 + 48 * a2 * b2 + 12 * b2**2)
        + nu**2 * (4 * a2**2 + 16 * a2 * b2 + 4 * b2**2)
    )
    return top / bottom


def beam(
    scene,
    *,
    shear: bool = True,
    rotary_inertia: bool = True,
    head: str = "cone",
    mass: str = "consistent",
    kappa: str = "hutchinson",
    elements: int | None = None,
    attachments: tuple[str, ...] | None = None,
) -> Body:
    """Free beam model of a scene.

    Parameters
    ----------
    scene : Scene
    shear : bool
        Timoshenko if True, Euler-Bernoulli if False.
    rotary_inertia : bool
        Whether sections carry rotary inertia in bending.
    head : {'cone', 'mean'}
        Follow the taper of conical segments, or replace each by the cylinder of its mean radii.
    mass : {'consistent', 'lumped'}
    kappa : {'hutchinson', 'cowper'}
        Shear coefficient; Cowper's for comparison with older work, solid sections only.
    elements : int, optional
        Least number of elements along the shaft; by default eight to a diameter.
    attachments : tuple of str, optional
        Attachments to build for every station, the first being the default one; by default what the
        scene says.

    Returns
    -------
    Body
        Four blocks (axial, torsion and the two bending planes).
    """
    checked(
        "timoshenko" if shear else "euler",
        {
            "head": head,
            "mass": mass,
            "kappa": kappa,
            "elements": elements,
            "attachments": attachments,
        },
    )
    if kappa == "cowper" and any(s.inner0 or s.inner1 for s in scene.segments):
        raise SolidgearError(
            "kappa: 'cowper' is given for solid sections only; use 'hutchinson' for a hollow shaft"
        )
    wanted = [(s, a) for s in scene.stations for a in (attachments or (s.attachment,))]
    nodes, owner = mesh(scene, elements, wanted)
    n = len(nodes)
    if not shear:
        _long_enough(nodes)
    # Timoshenko elements carry internal unknowns, after the nodal ones; only rotary inertia drives
    # the second.
    inner = 1 + rotary_inertia if shear and mass == "consistent" else 0
    size = {"bending": 2 * n + inner * (n - 1), "axial": n, "torsion": n}
    entries: dict[str, tuple[list, list, list, list]] = {name: ([], [], [], []) for name in size}
    fields: list[_Fields] = []
    for e, segment in enumerate(owner):
        left, right = nodes[e], nodes[e + 1]
        section = _Section(segment, left, right, head, kappa)
        bend, stretch, twist = (
            _bending(section, shear, rotary_inertia, mass),
            _rod(section, section.stretch, section.mass, mass),
            _rod(section, section.twist, section.polar, mass),
        )
        ends = np.array([e, e + 1])
        both = np.concatenate([np.arange(2 * e, 2 * e + 4), 2 * n + inner * e + np.arange(inner)])
        fields.append(
            _Fields(segment, left, right, (both, bend[2]), (ends, stretch[2]), (ends, twist[2]))
        )
        parts = {
            "bending": (*bend[:2], both),
            "axial": (*stretch[:2], ends),
            "torsion": (*twist[:2], ends),
        }
        for name, (ke, me, at) in parts.items():
            for store, values in zip(
                entries[name],
                (np.repeat(at, len(at)), np.tile(at, len(at)), ke.ravel(), me.ravel()),
            ):
                store.append(values)
    k, m = {}, {}
    for name, lists in entries.items():
        row, col, stiff, heavy = (np.concatenate(p) for p in lists)
        k[name] = sp.csr_matrix((stiff, (row, col)), shape=(size[name],) * 2)
        m[name] = sp.csr_matrix((heavy, (row, col)), shape=(size[name],) * 2)
    ports = tuple(Port(s.name, s.y, a) for s, a in wanted)
    one, zero = np.ones(n), np.zeros(n)
    lift = np.column_stack(
        [np.column_stack([one, zero]).ravel(), np.column_stack([nodes, one]).ravel()]
    )
    lift = np.vstack([lift, np.zeros((size["bending"] - 2 * n, 2))])
    y2 = np.concatenate([np.repeat(nodes, 2), np.full(size["bending"] - 2 * n, np.nan)])
    rows = [_port_rows(station, attachment, nodes, fields, size) for station, attachment in wanted]
    stacked = {name: sp.csr_matrix(np.vstack([r[name] for r in rows])) for name in size}
    rigid = [(i, s) for i, (s, a) in enumerate(wanted) if a == "rigid"]

    def tied(block: Block, per_node: int) -> Block:
        return tie_rigidly(
            block, [(i, s.y, _seat_mask(s, nodes, per_node, block.size)) for i, s in rigid]
        )

    bending = tied(
        Block("bending_z", (2, 3), k["bending"], m["bending"], lift, y2, stacked["bending"]), 2
    )
    blocks = (
        bending,
        bending.mirrored("bending_x", (0, 5), 0, (1.0, -1.0)),
        tied(
            Block("axial", (1,), k["axial"], m["axial"], one[:, None], nodes, stacked["axial"]), 1
        ),
        tied(
            Block(
                "torsion", (4,), k["torsion"], m["torsion"], one[:, None], nodes, stacked["torsion"]
            ),
            1,
        ),
    )
    facts = {
        "element": "timoshenko" if shear else "euler",
        "elements": n - 1,
        "rotary_inertia": rotary_inertia,
        "head": head,
    }
    facts["mass"] = mass
    return Body(
        "timoshenko" if shear else "euler",
        blocks,
        ports,
        elastic_scale(scene),
        scene.length,
        facts,
        geometry=nodes,
    )


def mesh(scene, elements: int | None, wanted=()):
    """Nodes at segment ends, ports and ends of rigid seats, filled in evenly; and the segment of
    every element.

    ``wanted`` lists stations with their attachments.
    """
    found = {s.y0 for s in scene.segments} | {scene.segments[-1].y1} | {s.y for s in scene.stations}
    found |= {
        y for s, a in wanted if a == "rigid" for y in (max(s.lo, 0.0), min(s.hi, scene.length))
    }
    marks = np.array(sorted(found))
    # Marks that differ by rounding only would make an element of no length.
    marks = marks[np.concatenate([[True], np.diff(marks) > 1e-9 * scene.length])]
    diameter = 2 * min(max(s.outer0, s.outer1) for s in scene.segments)
    size = scene.length / elements if elements else min(diameter / 8, scene.length / 40)
    filled = [marks[:1]]
    for a, b in zip(marks[:-1], marks[1:]):
        filled.append(np.linspace(a, b, max(1, int(np.ceil((b - a) / size - 1e-9))) + 1)[1:])
    nodes = np.concatenate(filled)
    middle = (nodes[1:] + nodes[:-1]) / 2
    ends = np.array([s.y1 for s in scene.segments])
    owner = [scene.segments[i] for i in np.minimum(np.searchsorted(ends, middle), len(ends) - 1)]
    return nodes, owner


def _long_enough(nodes):
    """Refuse Euler elements that would eat the digits: their stiffness grows with the inverse cube of their length, and the rest of the
    shaft with it only by what is left of sixteen digits.  Shear bounds that growth in a Timoshenko element.

    Measured on a uniform shaft with two marks this close: first bending is off by 2e-6 at 3e-4 of
    the length, 3e-4 at 3e-5.
    """
    gap = np.diff(nodes)
    at = int(np.argmin(gap))
    length = nodes[-1] - nodes[0]
    if gap[at] < SHORTEST * length:
        raise SolidgearError(
            f"euler: the element at y = {nodes[at]:.9g} m is {gap[at]:.3g} m long, below {SHORTEST:g} of the shaft, and loses its digits; let marks (segment ends, "
            "bearings, the port) that close coincide, ask for fewer elements, or use the timoshenko or harmonic model"
        )


class _Section:
    """Section properties of one element at its Gauss points (distances s from the left end)."""

    def __init__(self, segment, left, right, head, kappa):
        x, w = _GAUSS
        self.length = right - left
        self.s = self.length * (x + 1) / 2
        self.w = self.length * w / 2
        if head == "mean":
            a = np.full_like(self.s, (segment.outer0 + segment.outer1) / 2)
            b = np.full_like(self.s, (segment.inner0 + segment.inner1) / 2)
        else:
            t = (left + self.s - segment.y0) / segment.length
            a = segment.outer0 + t * (segment.outer1 - segment.outer0)
            b = segment.inner0 + t * (segment.inner1 - segment.inner0)
        mat = segment.material
        area = np.pi * (a**2 - b**2)
        second = np.pi / 4 * (a**4 - b**4)
        g = mat.E / (2 * (1 + mat.nu))
        self.bend = mat.E * second
        # Cowper (1966), J. Appl. Mech. 33, 335: 6 (1 + nu) / (7 + 6 nu)
        factor = (
            shear_coefficient(mat.nu, a, b)
            if kappa == "hutchinson"
            else 6 * (1 + mat.nu) / (7 + 6 * mat.nu)
        )
        self.shear = factor * g * area
        self.stretch = mat.E * area
        self.twist = 2 * g * second
        self.mass = mat.density * area
        self.rotary = mat.density * second
        self.polar = 2 * self.rotary
        # Integration from 0 to s at the Gauss points, exact for the polynomial through them.
        lagrange = np.linalg.inv(np.vander(x, increasing=True))
        powers = np.array(
            [[(xi ** (j + 1) - (-1.0) ** (j + 1)) / (j + 1) for j in range(len(x))] for xi in x]
        )
        self.integral = self.length / 2 * powers @ lagrange


def _bending(c: _Section, shear: bool, rotary: bool, mass: str):
    """Stiffness, mass and fields of one bending element on ``(z, thx)`` at both ends, then internal
    unknowns.

    With shear the static field has constant shear in an element, which alone converges with the square of its
    length.  Two internal fields, those of a clamped element under a uniform force and a uniform moment, lift
    that to the fourth power; they store no energy together with the nodal fields.
    """
    L, s, w = c.length, c.s, c.w
    soft = np.stack([1 / c.bend, 1 / c.shear if shear else np.zeros_like(s)])
    # Clamped at the left.  With dz/dy = thx a tip force bends by L - s, a tip moment by 1, a
    # uniform force by (L - s)^2 / 2 and a uniform moment by L - s.  First row moments, second row
    # shear forces.
    tip = np.stack(
        [
            np.column_stack([L - s, np.ones_like(s)]),
            np.column_stack([np.ones_like(s), np.zeros_like(s)]),
        ]
    )
    spread = np.stack(
        [np.column_stack([(L - s) ** 2 / 2, L - s]), np.column_stack([L - s, np.zeros_like(s)])]
    )

    def energy(a, b):
        return np.einsum("kqi,kq,kqj->ij", a, w * soft, b)

    def field(inner):
        """Deflection and turn along the cantilever for internal moments and forces."""
        turn = c.integral @ (inner[0] * soft[0][:, None])
        return np.stack([c.integral @ (turn + inner[1] * soft[1][:, None]), turn])

    resist = np.linalg.inv(energy(tip, tip))
    carry = np.array([[1.0, L], [0.0, 1.0]])  # rigid motion of the right end under that of the left
    difference = np.hstack([-carry, np.eye(2)])
    k = difference.T @ resist @ difference
    rigid = np.zeros((2, len(s), 4))
    rigid[0, :, 0] = rigid[1, :, 1] = 1.0
    rigid[0, :, 1] = s
    shape = field(tip) @ resist @ difference + rigid
    inertia = np.stack([c.mass, c.rotary if rotary else np.zeros_like(s)])
    if mass == "lumped":
        left = s < L / 2
        ends = [(w * i)[part].sum() for part in (left, ~left) for i in inertia]
        return k, np.diag(ends), shape
    if shear:
        spread = spread[:, :, : 1 + rotary]
        clamped = spread - tip @ (resist @ energy(tip, spread))
        stiff = energy(clamped, clamped)
        # Brought to the size of the nodal stiffness, for a well-scaled matrix.
        clamped = clamped * np.sqrt(k[0, 0] / np.diag(stiff))
        k = sla.block_diag(k, energy(clamped, clamped))
        shape = np.concatenate([shape, field(clamped)], axis=2)
    m = np.einsum("kqi,kq,kqj->ij", shape, w * inertia, shape)
    return k, m, shape


def _rod(c: _Section, rigidity, inertia, mass: str):
    """Stiffness and mass (2, 2) of a tapered bar in stretch or twist, and its field (q, 2)."""
    compliance = (c.w / rigidity).sum()
    k = np.array([[1.0, -1.0], [-1.0, 1.0]]) / compliance
    right = c.integral @ (1 / rigidity) / compliance
    shape = np.column_stack([1 - right, right])
    m = shape.T @ ((c.w * inertia)[:, None] * shape)
    if mass == "lumped":
        m = np.diag(m.sum(axis=1))
    return k, m, shape


@dataclass(frozen=True)
class _Fields:
    """Displacement fields of one element: unknowns and their shapes at the Gauss points of the
    element.

    ``bend`` has deflection and turn, (2, q, unknowns); ``stretch`` and ``twist`` one field each,
    (q, unknowns).
    """

    segment: Segment
    left: float
    right: float
    bend: tuple[np.ndarray, np.ndarray]
    stretch: tuple[np.ndarray, np.ndarray]
    twist: tuple[np.ndarray, np.ndarray]

    def part(self, lo: float, hi: float):
        """Places y, radii, length weights on the surface from lo to hi, and the interpolation (q,
        q) from the Gauss points.
        """
        x, w = _GAUSS
        middle, half = (lo + hi) / 2, (hi - lo) / 2
        y = middle + half * x
        local = (2 * y - self.left - self.right) / (self.right - self.left)
        lagrange = np.vander(local, len(x), increasing=True) @ np.linalg.inv(
            np.vander(x, increasing=True)
        )
        segment = self.segment
        slope = (segment.outer1 - segment.outer0) / segment.length
        r = segment.outer0 + slope * (y - segment.y0)
        return y, r, w * half * np.hypot(1.0, slope), lagrange


def _port_rows(
    station, attachment: str, nodes, fields: list[_Fields], size: dict[str, int]
) -> dict[str, np.ndarray]:
    """Motions of a port as rows on the unknowns of bending (d, ph), axial and torsion; zeros where
    the tie is rigid.
    """
    out: dict[str, np.ndarray] = {
        name: np.zeros((2 if name == "bending" else 1, n)) for name, n in size.items()
    }
    if attachment == "section":
        at = int(np.argmin(abs(nodes - station.y)))
        out["bending"][[0, 1], [2 * at, 2 * at + 1]] = 1.0
        out["axial"][0, at] = out["torsion"][0, at] = 1.0
    if attachment != "average":
        return out
    gram, area, polar = np.zeros((2, 2)), 0.0, 0.0
    for field in fields:
        lo, hi = max(field.left, station.lo), min(field.right, station.hi)
        if hi <= lo:
            continue
        y, r, ds, lagrange = field.part(lo, hi)
        h, w = y - station.y, 2 * np.pi * r * ds
        unknowns, shape = field.bend
        deflection, turn = (lagrange @ part for part in shape)
        out["bending"][0, unknowns] += w @ deflection
        out["bending"][1, unknowns] += (w * h) @ deflection + (w * r**2 / 2) @ turn
        gram += np.array([[w.sum(), w @ h], [w @ h, w @ (h * h + r**2 / 2)]])
        for name, (held, along), weight in (
            ("axial", field.stretch, w),
            ("torsion", field.twist, w * r**2),
        ):
            out[name][0, held] += weight @ lagrange @ along
        area, polar = area + w.sum(), polar + (w * r**2).sum()
    out["bending"] = np.linalg.solve(gram, out["bending"])
    out["axial"] /= area
    out["torsion"] /= polar
    return out


def _seat_mask(station, nodes, per_node: int, size: int) -> np.ndarray:
    """Unknowns that a rigid seat takes along: those of its nodes, and the internal ones of its
    elements.
    """
    tol = 1e-9 * nodes[-1]
    inside = (nodes > station.lo - tol) & (nodes < station.hi + tol)
    within = inside[1:] & inside[:-1]
    internal = (size - per_node * len(nodes)) // len(within)
    return np.concatenate([np.repeat(inside, per_node), np.repeat(within, internal)])
