"""Free beam model of a shaft: Euler-Bernoulli or Timoshenko, four blocks and ports.

A port is tied to the beam as the scene asks. ``section`` is the beam's own node. ``average`` is the
area-weighted least-squares rigid motion of the seat's surface, which a beam moves section by
section: with deflection w, turn th and radius r the port motion (d, ph) minimises, over the seat,
``int [2 pi (w - d - ph (y - y0))^2 + pi r^2 (th - ph)^2] r ds``. A beam then lacks against a solid
the distortion of sections and not the width of the seat. ``rigid`` lets the beam move as
one piece along the seat.

Drawing of a beam: the profile as a body of revolution.

A section of a beam is a rigid disc: the case U = V, W linear in r of
:mod:`solidgear.core.body.revolution`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from solidgear.core.body import Block, Body, Port
from solidgear.core.body.revolution import Rings, Wave, revolve, wave
from solidgear.core.body.surface import Surface
from solidgear.core.errors import SolidgearError
from solidgear.core.kernel.attachment import Attached, with_ports
from solidgear.core.models.beam.element import (
    Elements,
    Section,
    bending_matrices,
    rod_matrices,
    surface,
)
from solidgear.core.models.beam.shoulder import Hinge, hinges
from solidgear.core.models.spectrum import elastic_scale
from solidgear.core.scene.outline import SURFACES, Outline
from solidgear.core.scene.shaft import attached_stations

if TYPE_CHECKING:
    from solidgear.core.scene.shaft import Shaft


#: shortest Euler element over the length of the shaft
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
    """Build the free beam model of a scene, in four blocks (axial, torsion and the two bending planes);
    options as in :data:`~solidgear.core.models.options.BEAM_OPTIONS`.

    Cowper's shear coefficient is for comparison with older work, on solid sections only. There are
    eight elements to a diameter unless more are asked for. With ``shoulder`` steps of the outer radius
    are as soft as in the solid (:mod:`solidgear.core.models.beam.shoulder`), where a plain beam fills the
    thick part with stress at once. Euler elements below ``SHORTEST`` of the shaft are refused.

    Examples
    --------
    >>> from solidgear import Scene, Segment
    >>> rod = Scene.from_parts([Segment.cylinder("rod", length=0.6, diameter=0.02)])
    >>> body = beam(rod, elements=30)
    >>> body.mesh["elements"], [block.components for block in body.blocks]
    (30, [(2, 3), (0, 5), (1,), (4,)])
    """
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
    """Build the same with given nodes (m) and stations with their attachments."""
    n = len(nodes)
    if not shear:
        _long_enough(nodes)
    elements = Elements.of(scene.segments, nodes)
    section = Section(elements, head, kappa)
    if shoulder:
        section.soften(*softening(nodes, hinges(scene.segments)))
    by_family = matrices(section, shear, rotary_inertia, mass)
    dofs = unknowns(by_family, n)
    size = {name: int(places.max()) + 1 for name, places in dofs.items()}
    k, m = {}, {}
    for name, (stiff, heavy, _) in by_family.items():
        k[name], m[name] = (_sum(matrix, dofs[name], size[name]) for matrix in (stiff, heavy))
    ports = tuple(Port(s.name, s.y, a) for s, a in wanted)
    ones, zero = np.ones(n), np.zeros(n)
    lift = np.column_stack(
        [np.column_stack([ones, zero]).ravel(), np.column_stack([nodes, ones]).ravel()]
    )
    lift = np.vstack([lift, np.zeros((size["bending"] - 2 * n, 2))])
    y2 = np.concatenate([np.repeat(nodes, 2), np.full(size["bending"] - 2 * n, np.nan)])
    shape = {name: part[2] for name, part in by_family.items()}
    rows = [
        port_rows(station, attachment, elements, shape, dofs, size)
        for station, attachment in wanted
    ]

    turn = shape["bending"][:, 1]
    tilting = np.einsum("eqi,eq,eqj->eij", turn, section.w * section.rotary, turn)
    swirl = _sum(tilting, dofs["bending"], size["bending"])

    def block(
        name: str, components: tuple[int, ...], family: str, rigid, y, per_node: int
    ) -> Block:
        ports = []
        for (station, attachment), row in zip(wanted, rows):
            if attachment == "rigid":
                mask = _seat_mask(station, nodes, per_node, size[family])
                ports.append(Attached(station.y, held=mask))
            else:
                ports.append(Attached(station.y, row[family]))
        spun = swirl.__matmul__ if family == "bending" else None
        free = Block(name, components, k[family], m[family], rigid, y, swirl=spun)
        return with_ports(free, ports)

    bending = block("bending_z", (2, 3), "bending", lift, y2, 2)
    blocks = (
        bending,
        bending.mirrored("bending_x", (0, 5), 0, (1.0, -1.0)),
        block("axial", (1,), "axial", ones[:, None], nodes, 1),
        block("torsion", (4,), "torsion", ones[:, None], nodes, 1),
    )
    facts = {
        "element": "timoshenko" if shear else "euler",
        "elements": n - 1,
        "rotary_inertia": rotary_inertia,
        "head": head,
        "mass": mass,
        "kappa": kappa,
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


def _sum(matrices: np.ndarray, dofs: np.ndarray, size: int) -> sp.csr_matrix:
    """Assemble matrices (e, k, k) of elements by their unknowns (e, k)."""
    places = np.broadcast_to(dofs[:, :, None], matrices.shape)
    entries = (places.ravel(), places.transpose(0, 2, 1).ravel())
    return sp.csr_matrix((matrices.ravel(), entries), shape=(size, size))


def mesh(scene, elements: int | None, wanted=()):
    """Return nodes (n,) at segment ends, ports and ends of rigid seats, filled in evenly to at
    least so many elements (None is eight to a diameter), m.
    """
    places = (
        {s.y0 for s in scene.segments} | {scene.segments[-1].y1} | {s.y for s in scene.stations}
    )
    for station, attachment in wanted:
        if attachment == "rigid":
            places |= {max(station.lo, 0.0), min(station.hi, scene.length)}
    marks = np.array(sorted(places))
    # Marks that differ by rounding only would make an element of no length.
    marks = marks[np.concatenate([[True], np.diff(marks) > 1e-9 * scene.length])]
    diameter = 2 * min(max(s.outer0, s.outer1) for s in scene.segments)
    size = scene.length / elements if elements else min(diameter / 8, scene.length / 40)
    filled = [marks[:1]]
    for a, b in zip(marks[:-1], marks[1:]):
        filled.append(np.linspace(a, b, max(1, int(np.ceil((b - a) / size - 1e-9))) + 1)[1:])
    return np.concatenate(filled)


def matrices(section: Section, shear: bool, rotary_inertia: bool, mass: str):
    """Return stiffness, mass and fields of all elements, by family of motion."""
    return {
        "bending": bending_matrices(section, shear, rotary_inertia, mass),
        "axial": rod_matrices(section, section.stretch, section.mass, mass),
        "torsion": rod_matrices(section, section.twist, section.polar, mass),
    }


def unknowns(by_family, n: int) -> dict[str, np.ndarray]:
    """Return the unknowns (e, k) of every element of a beam of n nodes, by family; internal ones,
    that Timoshenko elements carry, after those of the nodes.
    """
    ends = np.arange(n - 1)[:, None] + np.arange(2)
    inner = by_family["bending"][0].shape[-1] - 4
    inside = 2 * n + np.arange((n - 1) * inner).reshape(n - 1, inner)
    bending = np.hstack([2 * ends[:, :1] + np.arange(4), inside])
    return {"bending": bending, "axial": ends, "torsion": ends}


def softening(nodes, steps: tuple[Hinge, ...]) -> np.ndarray:
    """Return the compliances (3, e) of shoulders in bending, stretch and twist, each on the element
    that it softens: the first one of the thick part.
    """
    out = np.zeros((3, len(nodes) - 1))
    for step in steps:
        out[:, softened(nodes, step)] += step.bend, step.stretch, step.twist
    return out


def softened(nodes, step: Hinge) -> int:
    """Return the element that a shoulder softens."""
    return int(np.argmin(abs(nodes - step.y))) - (not step.ahead)


def _long_enough(nodes):
    """Refuse Euler elements that would cost the digits: their stiffness grows with the inverse cube
    of their length, and the rest of the shaft keeps only the remainder of sixteen digits. Shear
    bounds that growth in a Timoshenko element.

    Measured on a uniform shaft with two marks this close: first bending is off by 2e-6 at 3e-4 of
    the length, 3e-4 at 3e-5.
    """
    gap = np.diff(nodes)
    shortest = int(np.argmin(gap))
    length = nodes[-1] - nodes[0]
    if gap[shortest] < SHORTEST * length:
        raise SolidgearError(
            f"euler: the element at y = {nodes[shortest]:.9g} m is {gap[shortest]:.3g} m long, below "
            f"{SHORTEST:g} of the shaft, and loses its digits; let segment ends, bearings and the "
            "port there coincide, give fewer elements, or use the timoshenko or harmonic model"
        )


def port_rows(
    station, attachment: str, e: Elements, shape, dofs, size: dict[str, int]
) -> dict[str, np.ndarray]:
    """Return the motions of a port as rows on the unknowns of bending (d, ph), axial and torsion;
    zeros where the tie is rigid.
    """
    out = {name: np.zeros((2 if name == "bending" else 1, n)) for name, n in size.items()}
    if attachment == "section":
        node = int(np.argmin(abs(np.append(e.left, e.right[-1]) - station.y)))
        out["bending"][[0, 1], [2 * node, 2 * node + 1]] = 1.0
        out["axial"][0, node] = out["torsion"][0, node] = 1.0
    if attachment == "average":
        under, lo, hi = pieces(e, station)
        seat_shape = {name: part[under] for name, part in shape.items()}
        for name, (gram, rows) in seat(e.only(under), seat_shape, lo, hi, station.y).items():
            for places, row in zip(dofs[name][under], rows):
                out[name][:, places] += row
            out[name] = np.linalg.solve(gram.sum(axis=0), out[name])
    return out


def pieces(e: Elements, station) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the elements (k,) under a seat, and the ends of the part of each under it, m."""
    lo, hi = np.maximum(e.left, station.lo), np.minimum(e.right, station.hi)
    under = np.flatnonzero(hi > lo)
    return under, lo[under], hi[under]


def seat(e: Elements, shape, lo, hi, y) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Return the contribution of each piece of a seat to the Gram matrix of its port, a point at y,
    and to the port's rows before they are divided by it, by family.
    """
    place, r, ds, lagrange = surface(e, lo, hi)
    h, w = place - y, 2 * np.pi * r * ds
    deflection, turn = (lagrange @ shape["bending"][:, k] for k in (0, 1))
    rows = [w[:, None] @ deflection]
    rows.append((w * h)[:, None] @ deflection + (w * r**2 / 2)[:, None] @ turn)
    area, first, second = ((w * f).sum(axis=1) for f in (1.0, h, h * h + r**2 / 2))
    gram = np.stack([np.stack([area, first], -1), np.stack([first, second], -1)], axis=1)
    out = {"bending": (gram, np.concatenate(rows, axis=1))}
    for name, weight in (("axial", w), ("torsion", w * r**2)):
        total = weight.sum(axis=1)[:, None, None]
        out[name] = (total, weight[:, None] @ (lagrange @ shape[name]))
    return out


def _seat_mask(station, nodes, per_node: int, size: int) -> np.ndarray:
    """Return the unknowns that a rigid seat takes along: those of its nodes, and the internal ones
    of the elements.
    """
    tol = 1e-9 * nodes[-1]
    inside = (nodes > station.lo - tol) & (nodes < station.hi + tol)
    whole_elements = inside[1:] & inside[:-1]
    internal = (size - per_node * len(nodes)) // len(whole_elements)
    return np.concatenate([np.repeat(inside, per_node), np.repeat(whole_elements, internal)])


@dataclass(frozen=True, eq=False)
class BeamLine:
    """Nodes of a beam along the profile of the shaft."""

    shaft: Shaft
    nodes: np.ndarray  #: (n,) axial positions, m

    def surface(self, moved: Mapping[str, np.ndarray]) -> Surface:
        """Return the profile of the shaft, each section of it a rigid disc."""
        return revolve(self.rings, _waves(self.rings, self.nodes, moved))

    @cached_property
    def rings(self) -> Rings:
        """The profile of the shaft, for all its shapes."""
        return _profile(self.shaft, self.nodes)

    def volume(self) -> None:
        """Return None: a beam has no mesh of the volume."""
        return None


def _waves(rings: Rings, nodes: np.ndarray, moved: Mapping[str, np.ndarray]) -> list[Wave]:
    waves = []
    for name, start in (("bending_z", 0.0), ("bending_x", np.pi / 2)):
        if name in moved:
            # In the x plane the second unknown is -thz, which turns z into x as thx turns y into z.
            lift, tilt = (
                np.interp(rings.y, nodes, moved[name][k : 2 * len(nodes) : 2]) for k in (0, 1)
            )
            waves.append(wave(1, start, lift, lift, -rings.r * tilt))
    if "axial" in moved:
        waves.append(wave(0, 0.0, 0.0, 0.0, np.interp(rings.y, nodes, moved["axial"])))
    if "torsion" in moved:
        turn = np.interp(rings.y, nodes, moved["torsion"])
        waves.append(wave(0, 0.0, 0.0, 0.0, 0.0 * rings.r, rings.r * turn))
    return waves


def _profile(scene: Shaft, nodes: np.ndarray) -> Rings:
    """Return the closed outline of the meridian: up the outer surface, down the bore,
    counter-clockwise in (r, y).
    """
    tol = 1e-9 * scene.length
    along: dict[str, list[tuple[float, float]]] = {surface: [] for surface in SURFACES}
    for piece in Outline(scene.segments).pieces:  # sharp: a beam knows no fillets
        inside = nodes[(nodes > piece.y0 + tol) & (nodes < piece.y1 - tol)]
        y = np.concatenate([[piece.y0], inside, [piece.y1]])
        share = (y - piece.y0) / (piece.y1 - piece.y0)
        along[piece.surface] += zip(piece.r0 + share * (piece.r1 - piece.r0), y)
    loop = np.array(along["outer"] + along["bore"][::-1])
    loop = loop[np.linalg.norm(loop - np.roll(loop, 1, axis=0), axis=1) > tol]
    # Faces across the axis are divided, so that their colours follow the displacement.
    parts, drawn, size = [], [], 0
    for p, q in zip(loop, np.roll(loop, -1, axis=0)):
        n = 1
        if abs(q[1] - p[1]) < tol:
            n = max(1, int(np.ceil(abs(q[0] - p[0]) / (0.03 * scene.length))))
        parts.append(p + np.arange(n)[:, None] / n * (q - p))
        drawn.append(size)
        size += n
    r, y = np.concatenate(parts).T
    ring = np.arange(size)
    return Rings(r, y, np.column_stack([ring, (ring + 1) % size]), np.array(drawn))
