"""Beam finite elements for stepped, tapered and hollow shafts: Euler-Bernoulli and Timoshenko.

One element serves both theories and any taper.  Its stiffness is the inverse of the tip
flexibility of the element clamped at one end, integrated over the true section; its mass
is consistent with the displacement field of that static problem.  A uniform element is
the textbook one.  Nothing here is shared with the solid builders: that
independence is what makes a comparison worth having.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp

from solidgear.body import Block, Body, Port
from solidgear.errors import SolidgearError
from solidgear.fidelity.options import checked
from solidgear.fidelity.scale import elastic_scale

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

    Returns
    -------
    Body
        Four blocks (axial, torsion and the two bending planes); ports are nodes.
    """
    checked("timoshenko" if shear else "euler", {"head": head, "mass": mass, "kappa": kappa, "elements": elements})
    if kappa == "cowper" and any(s.inner0 or s.inner1 for s in scene.segments):
        raise SolidgearError("kappa: 'cowper' is given for solid sections only; use 'hutchinson' for a hollow shaft")
    nodes, owner = mesh(scene, elements)
    n = len(nodes)
    if not shear:
        _long_enough(nodes)
    # Timoshenko elements carry internal unknowns, after the nodal ones; only rotary inertia drives the second.
    inner = 1 + rotary_inertia if shear and mass == "consistent" else 0
    size = {"bending": 2 * n + inner * (n - 1), "axial": n, "torsion": n}
    entries = {name: ([], [], [], []) for name in size}
    for e, segment in enumerate(owner):
        left, right = nodes[e], nodes[e + 1]
        section = _Section(segment, left, right, head, kappa)
        parts = {
            "bending": (
                *_bending(section, shear, rotary_inertia, mass),
                np.concatenate([np.arange(2 * e, 2 * e + 4), 2 * n + inner * e + np.arange(inner)]),
            ),
            "axial": (*_rod(section, section.stretch, section.mass, mass), np.array([e, e + 1])),
            "torsion": (*_rod(section, section.twist, section.polar, mass), np.array([e, e + 1])),
        }
        for name, (ke, me, at) in parts.items():
            for store, values in zip(entries[name], (np.repeat(at, len(at)), np.tile(at, len(at)), ke.ravel(), me.ravel())):
                store.append(values)
    k, m = {}, {}
    for name, parts in entries.items():
        row, col, stiff, heavy = (np.concatenate(p) for p in parts)
        k[name] = sp.csr_matrix((stiff, (row, col)), shape=(size[name],) * 2)
        m[name] = sp.csr_matrix((heavy, (row, col)), shape=(size[name],) * 2)
    places = [int(np.argmin(abs(nodes - s.y))) for s in scene.stations]
    ports = tuple(Port(s.name, s.y, "node") for s in scene.stations)
    one, zero = np.ones(n), np.zeros(n)
    lift = np.column_stack([np.column_stack([one, zero]).ravel(), np.column_stack([nodes, one]).ravel()])
    pick2 = _pick([2 * p + c for p in places for c in (0, 1)], size["bending"])
    pick1 = _pick(places, n)
    lift = np.vstack([lift, np.zeros((size["bending"] - 2 * n, 2))])
    y2 = np.concatenate([np.repeat(nodes, 2), np.full(size["bending"] - 2 * n, np.nan)])
    bending = Block("bending_z", (2, 3), k["bending"], m["bending"], lift, y2, pick2)
    blocks = (
        bending,
        bending.mirrored("bending_x", (0, 5), 0, (1.0, -1.0)),
        Block("axial", (1,), k["axial"], m["axial"], one[:, None], nodes, pick1),
        Block("torsion", (4,), k["torsion"], m["torsion"], one[:, None], nodes, pick1),
    )
    facts = {"element": "timoshenko" if shear else "euler", "elements": n - 1, "rotary_inertia": rotary_inertia, "head": head}
    facts["mass"] = mass
    return Body(
        "timoshenko" if shear else "euler", blocks, ports, elastic_scale(scene), scene.length, facts, geometry=nodes
    )


def mesh(scene, elements: int | None):
    """Nodes at segment ends and ports, filled in evenly; and the segment of every element."""
    marks = {s.y0 for s in scene.segments} | {scene.segments[-1].y1} | {s.y for s in scene.stations}
    marks = np.array(sorted(marks))
    # Marks that differ by rounding only would make an element of no length.
    marks = marks[np.concatenate([[True], np.diff(marks) > 1e-9 * scene.length])]
    diameter = 2 * min(max(s.outer0, s.outer1) for s in scene.segments)
    size = scene.length / elements if elements else min(diameter / 8, scene.length / 40)
    nodes = [marks[:1]]
    for a, b in zip(marks[:-1], marks[1:]):
        nodes.append(np.linspace(a, b, max(1, int(np.ceil((b - a) / size - 1e-9))) + 1)[1:])
    nodes = np.concatenate(nodes)
    middle = (nodes[1:] + nodes[:-1]) / 2
    ends = np.array([s.y1 for s in scene.segments])
    owner = [scene.segments[i] for i in np.minimum(np.searchsorted(ends, middle), len(ends) - 1)]
    return nodes, owner


def _long_enough(nodes):
    """Refuse Euler elements that would eat the digits: their stiffness grows with the inverse cube of their length, and the rest of the
    shaft with it only by what is left of sixteen digits.  Shear bounds that growth in a Timoshenko element.

    Measured on a uniform shaft with two marks this close: first bending is off by 2e-6 at 3e-4 of the length, 3e-4 at 3e-5.
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
        factor = shear_coefficient(mat.nu, a, b) if kappa == "hutchinson" else 6 * (1 + mat.nu) / (7 + 6 * mat.nu)
        self.shear = factor * g * area
        self.stretch = mat.E * area
        self.twist = 2 * g * second
        self.mass = mat.density * area
        self.rotary = mat.density * second
        self.polar = 2 * self.rotary
        # Integration from 0 to s at the Gauss points, exact for the polynomial through them.
        lagrange = np.linalg.inv(np.vander(x, increasing=True))
        powers = np.array([[(xi ** (j + 1) - (-1.0) ** (j + 1)) / (j + 1) for j in range(len(x))] for xi in x])
        self.integral = self.length / 2 * powers @ lagrange


def _bending(c: _Section, shear: bool, rotary: bool, mass: str):
    """Stiffness and mass of one bending element on ``(z, thx)`` at both ends, then internal unknowns.

    With shear the static field has constant shear in an element, which alone converges with the square of its
    length.  Two internal fields, those of a clamped element under a uniform force and a uniform moment, lift
    that to the fourth power; they store no energy together with the nodal fields.
    """
    L, s, w = c.length, c.s, c.w
    soft = np.stack([1 / c.bend, 1 / c.shear if shear else np.zeros_like(s)])
    # Clamped at the left.  With dz/dy = thx a tip force bends by L - s, a tip moment by 1, a uniform
    # force by (L - s)^2 / 2 and a uniform moment by L - s.  First row moments, second row shear forces.
    tip = np.stack([np.column_stack([L - s, np.ones_like(s)]), np.column_stack([np.ones_like(s), np.zeros_like(s)])])
    spread = np.stack([np.column_stack([(L - s) ** 2 / 2, L - s]), np.column_stack([L - s, np.zeros_like(s)])])

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
        return k, np.diag(ends)
    if shear:
        spread = spread[:, :, : 1 + rotary]
        clamped = spread - tip @ (resist @ energy(tip, spread))
        stiff = energy(clamped, clamped)
        # Brought to the size of the nodal stiffness, for a well-scaled matrix.
        clamped = clamped * np.sqrt(k[0, 0] / np.diag(stiff))
        k = sla.block_diag(k, energy(clamped, clamped))
        shape = np.concatenate([shape, field(clamped)], axis=2)
    m = np.einsum("kqi,kq,kqj->ij", shape, w * inertia, shape)
    return k, m


def _rod(c: _Section, rigidity, inertia, mass: str):
    """Stiffness and mass (2, 2) of a tapered bar in stretch or twist."""
    compliance = (c.w / rigidity).sum()
    k = np.array([[1.0, -1.0], [-1.0, 1.0]]) / compliance
    right = c.integral @ (1 / rigidity) / compliance
    shape = np.column_stack([1 - right, right])
    m = shape.T @ ((c.w * inertia)[:, None] * shape)
    if mass == "lumped":
        m = np.diag(m.sum(axis=1))
    return k, m


def _pick(at, n):
    return sp.csr_matrix((np.ones(len(at)), (np.arange(len(at)), at)), shape=(len(at), n))
