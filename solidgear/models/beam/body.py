"""Free beam model of a shaft: Euler-Bernoulli or Timoshenko, four blocks and its ports.

A port is tied to the beam as the scene asks. ``section`` is the beam's own node. ``average`` is the
area-weighted least-squares rigid motion of the seat's surface, which a beam moves section by
section: with deflection w, turn th and radius r the port motion (d, ph) minimises, over the seat,
``int [2 pi (w - d - ph (y - y0))^2 + pi r^2 (th - ph)^2] r ds``. What a beam lacks against a solid
is then the distortion of sections and not the width of the seat. ``rigid`` lets the beam move as
one piece along the seat.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from solidgear.body import Block, Body, Port
from solidgear.errors import SolidgearError
from solidgear.kernel.attachment import tie_rigidly
from solidgear.models.beam.drawing import BeamLine
from solidgear.models.beam.element import Fields, Section, bending_matrices, rod_matrices
from solidgear.models.beam.shoulder import Hinge, hinges
from solidgear.models.options import BEAM_OPTIONS, checked
from solidgear.models.spectrum import elastic_scale
from solidgear.scene.attached import attached_stations

# Shortest Euler element over the length of the shaft.
SHORTEST = 3e-4


def beam(
    scene,
    *,
    shear: bool = True,
    rotary_inertia: bool = True,
    head: str = "cone",
    mass: str = "consistent",
    kappa: str = "hutchinson",
    elements: int | None = None,
    shoulder: bool = False,
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
    shoulder : bool
        Whether steps of the outer radius are as soft as in the solid
        (:mod:`solidgear.models.beam.shoulder`), where a plain beam fills the thick part with stress at
        once.
    attachments : tuple of str, optional
        Attachments to build for every station, the first being the default one; by default those of
        the scene.

    Returns
    -------
    Body
        Four blocks (axial, torsion and the two bending planes).

    Raises
    ------
    SolidgearError
        For an option out of its range, Cowper's coefficient on a hollow shaft, or Euler elements
        below ``SHORTEST`` of the shaft.

    Examples
    --------
    >>> from solidgear import Scene, Segment
    >>> rod = Scene.from_parts([Segment.cylinder("rod", length=0.6, diameter=0.02)])
    >>> body = beam(rod, elements=30)
    >>> body.mesh["elements"], [block.components for block in body.blocks]
    (30, [(2, 3), (0, 5), (1,), (4,)])
    """
    checked(
        "timoshenko" if shear else "euler",
        {
            "head": head,
            "mass": mass,
            "kappa": kappa,
            "elements": elements,
            "shoulder": shoulder,
            "attachments": attachments,
        },
        BEAM_OPTIONS,
    )
    if kappa == "cowper" and any(s.inner0 or s.inner1 for s in scene.segments):
        raise SolidgearError(
            "kappa: 'cowper' is given for solid sections only; use 'hutchinson' for a hollow shaft"
        )
    wanted = [*attached_stations(scene.stations, attachments)]
    nodes = mesh(scene, elements, wanted)
    return on_nodes(scene, nodes, wanted, shear, rotary_inertia, head, mass, kappa, shoulder)


def on_nodes(
    scene,
    nodes: np.ndarray,
    wanted,
    shear: bool,
    rotary_inertia: bool,
    head: str,
    mass: str,
    kappa: str,
    shoulder: bool,
) -> Body:
    """The same with given nodes (m) and stations with their attachments."""
    n, owner = len(nodes), owners(scene, nodes)
    if not shear:
        _long_enough(nodes)
    # Timoshenko elements carry internal unknowns, after the nodal ones; only rotary inertia drives
    # the second.
    inner = 1 + rotary_inertia if shear and mass == "consistent" else 0
    size = {"bending": 2 * n + inner * (n - 1), "axial": n, "torsion": n}
    entries: dict[str, tuple[list, list, list, list]] = {name: ([], [], [], []) for name in size}
    fields: list[Fields] = []
    soft = _softened(nodes, hinges(scene.segments)) if shoulder else {}
    made: dict[tuple[float, ...], tuple] = {}
    for e, segment in enumerate(owner):
        left, right = nodes[e], nodes[e + 1]
        # pieces of a cylinder that are as long as each other but for rounding are one
        alike: tuple[float, ...] = (id(segment), round((right - left) / scene.length, 12))
        if e in soft or segment.outer0 != segment.outer1 or segment.inner0 != segment.inner1:
            alike = (*alike, e)
        if alike not in made:
            section = Section(segment, left, right, head, kappa)
            for step in soft.get(e, ()):
                section.soften(step.bend, step.stretch, step.twist)
            made[alike] = (
                bending_matrices(section, shear, rotary_inertia, mass),
                rod_matrices(section, section.stretch, section.mass, mass),
                rod_matrices(section, section.twist, section.polar, mass),
            )
        bend, stretch, twist = made[alike]
        ends = np.array([e, e + 1])
        both = np.concatenate([np.arange(2 * e, 2 * e + 4), 2 * n + inner * e + np.arange(inner)])
        fields.append(
            Fields(segment, left, right, (both, bend[2]), (ends, stretch[2]), (ends, twist[2]))
        )
        parts = {
            "bending": (*bend[:2], both),
            "axial": (*stretch[:2], ends),
            "torsion": (*twist[:2], ends),
        }
        for name, (ke, me, at) in parts.items():
            row, column = np.repeat(at, len(at)), np.tile(at, len(at))
            for store, values in zip(entries[name], (row, column, ke.ravel(), me.ravel())):
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
    stacked = {}
    for name in size:
        stacked[name] = sp.csr_matrix(np.vstack([r[name] for r in rows]))
    rigid = [(i, s) for i, (s, a) in enumerate(wanted) if a == "rigid"]

    def tied(block: Block, per_node: int) -> Block:
        masks = [_seat_mask(s, nodes, per_node, block.size) for _, s in rigid]
        return tie_rigidly(block, [(i, s.y, mask) for (i, s), mask in zip(rigid, masks)])

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
        "mass": mass,
        "shoulder": shoulder,
    }
    return Body(
        "timoshenko" if shear else "euler",
        blocks,
        ports,
        elastic_scale(scene),
        scene.length,
        facts,
        geometry=BeamLine(scene, nodes),
    )


def mesh(scene, elements: int | None, wanted=()):
    """Nodes (n,) at segment ends, ports and ends of rigid seats, filled in evenly to at least so
    many elements (None is eight to a diameter), m.
    """
    found = {s.y0 for s in scene.segments} | {scene.segments[-1].y1} | {s.y for s in scene.stations}
    for station, attachment in wanted:
        if attachment == "rigid":
            found |= {max(station.lo, 0.0), min(station.hi, scene.length)}
    marks = np.array(sorted(found))
    # Marks that differ by rounding only would make an element of no length.
    marks = marks[np.concatenate([[True], np.diff(marks) > 1e-9 * scene.length])]
    diameter = 2 * min(max(s.outer0, s.outer1) for s in scene.segments)
    size = scene.length / elements if elements else min(diameter / 8, scene.length / 40)
    filled = [marks[:1]]
    for a, b in zip(marks[:-1], marks[1:]):
        filled.append(np.linspace(a, b, max(1, int(np.ceil((b - a) / size - 1e-9))) + 1)[1:])
    return np.concatenate(filled)


def owners(scene, nodes) -> list:
    """The segment of every element."""
    middle = (nodes[1:] + nodes[:-1]) / 2
    ends = np.array([s.y1 for s in scene.segments])
    return [scene.segments[i] for i in np.minimum(np.searchsorted(ends, middle), len(ends) - 1)]


def _softened(nodes, steps: tuple[Hinge, ...]) -> dict[int, list[Hinge]]:
    """Shoulders by the element that they soften: the first one of the thick part."""
    out: dict[int, list[Hinge]] = {}
    for step in steps:
        at = int(np.argmin(abs(nodes - step.y)))
        out.setdefault(at if step.ahead else at - 1, []).append(step)
    return out


def _long_enough(nodes):
    """Refuse Euler elements that would cost the digits: their stiffness grows with the inverse cube
    of their length, and the rest of the shaft with it only by what is left of sixteen digits. Shear
    bounds that growth in a Timoshenko element.

    Measured on a uniform shaft with two marks this close: first bending is off by 2e-6 at 3e-4 of
    the length, 3e-4 at 3e-5.
    """
    gap = np.diff(nodes)
    at = int(np.argmin(gap))
    length = nodes[-1] - nodes[0]
    if gap[at] < SHORTEST * length:
        raise SolidgearError(
            f"euler: the element at y = {nodes[at]:.9g} m is {gap[at]:.3g} m long, below "
            f"{SHORTEST:g} of the shaft, and loses its digits; let marks (segment ends, bearings, "
            "the port) that close coincide, ask for fewer elements, or use the timoshenko or "
            "harmonic model"
        )


def _port_rows(
    station, attachment: str, nodes, fields: list[Fields], size: dict[str, int]
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
