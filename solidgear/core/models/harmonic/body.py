"""Axisymmetric-harmonic solid: exact 3D elasticity of a body of revolution on the meridian.

Here a scene is meshed and the blocks put together; unknowns and matrices of one harmonic are in
:mod:`solidgear.core.models.harmonic.blocks`.

Further circumferential families of a harmonic solid, n = 2 waves around and more, with their
lowest frequencies; blocks are built when they are needed.

The lowest frequency of a family is known at three prices.  In closed form: n waves of a wall of thickness h
at radius R bend it at least as a free ring or disc bends, ``w^2 = E h^2 / (12 rho R^4) n^2 (n^2 -
1)^2 / (n^2 + 1)`` (Love, Theory of Elasticity, sec. 293; the free disc lies above), in series with
shear, whose waves run no slower than Rayleigh's; that is taken over every part of the shaft, and
grows with n without end.  By a light mesh of order 2, from above. And by the block itself.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse.linalg as spla

from solidgear.core.body import Block, Body, Port
from solidgear.core.kernel.room import assemblable
from solidgear.core.meshing.grading import Grading
from solidgear.core.meshing.layout import layout
from solidgear.core.meshing.meridian import Cut, cut_meridian, drawn_across, meridian
from solidgear.core.models.harmonic.blocks import Work
from solidgear.core.models.harmonic.mesh import HarmonicMesh, harmonic_mesh
from solidgear.core.models.limits import countable
from solidgear.core.models.options import HARMONIC_OPTIONS, thick_enough
from solidgear.core.models.spectrum import elastic_scale, overhangs
from solidgear.core.scene.coned import coned
from solidgear.core.scene.shaft import attached_stations

if TYPE_CHECKING:
    from solidgear.core.scene.shaft import Shaft


def harmonic(
    scene,
    *,
    order: int = 5,
    layers: int = 3,
    edge_layers: int = 1,
    ratio: float = 0.2,
    relative_size: float = 1.0,
    size: float | None = None,
    refinement: float = 1.0,
    attachments: tuple[str, ...] | None = None,
    families: tuple[str, ...] | None = None,
    ovalising: tuple[int, ...] = (),
    cuts: tuple[Cut, ...] = (),
    across: tuple[tuple[float, float], ...] = (),
    plain: bool = False,
) -> Body:
    """Build the free harmonic solid of a scene; options as in
    :data:`~solidgear.core.models.options.HARMONIC_OPTIONS`.

    The defaults are the reference setting, good to 1e-4 on the overhung pinion; order 8 with 4 layers
    and 2 edge layers gives about 1e-6. Sizes of cells count in local outer radii, in a thin wall
    beside shoulders and seats in decay lengths of the shell. A body without one of the families
    bending, axial and torsion knows nothing of its motions, and must be given supports that do not
    couple it (:meth:`solidgear.core.body.Supports.on`). Ovalising harmonics carry no port motion; those
    that are not built at once are built when modes need them. Lines across are drawn before cells are
    cut. Layers thinner than digits, cells without end and cuts off the corners of the mesh are
    refused.
    """
    thick_enough("harmonic", {"layers": layers, "ratio": ratio})
    # chamfers in shoulders as cones, to whose ends layers lead
    scene = coned(scene)
    countable("harmonic", scene, size or relative_size * scene.outline.least_radius, refinement)
    grading = Grading(
        layers=layers,
        edge_layers=edge_layers,
        ratio=ratio,
        relative_size=relative_size,
        size=size,
        refinement=refinement,
        plain=plain,
    )
    plan = layout(scene, grading, attachments)
    assemblable(plan.cells, (order + 1) ** 2)
    uncut = flat = meridian(scene, plan)
    parent = np.arange(flat.cells.shape[1])
    if across:
        uncut = flat = drawn_across(flat, across)
    if cuts:
        flat, parent = cut_meridian(uncut, cuts)
    mesh = harmonic_mesh(flat, order, uncut, parent)
    facts = {
        "layers": layers,
        "edge_layers": edge_layers,
        "ratio": ratio,
        "relative_size": relative_size,
        "refinement": refinement,
        "cuts": len(cuts),
        "plain": plain,
    }
    return on_mesh(scene, mesh, attachments, families, ovalising, facts)


def on_mesh(
    scene: Any,
    mesh: HarmonicMesh,
    attachments: tuple[str, ...] | None = None,
    families: tuple[str, ...] | None = None,
    ovalising: tuple[int, ...] = (),
    facts: Mapping[str, Any] = MappingProxyType({}),
) -> Body:
    """Build the harmonic solid of a shaft on a mesh of its meridian; other parameters are as of
    :func:`harmonic`, and `facts` are those of its mesh.
    """
    work = Work(scene, mesh)
    wanted = [*attached_stations(scene.stations, attachments)]
    ports = [Port(station.name, station.y, attachment) for station, attachment in wanted]
    chosen = families or HARMONIC_OPTIONS["families"].choices
    blocks = []
    if "bending" in chosen:
        bending = work.block("bending_z", (2, 3), wanted)
        blocks += [bending, bending.mirrored("bending_x", (0, 5), 0, (1.0, -1.0))]
    if "axial" in chosen:
        blocks.append(work.block("axial", (1,), wanted))
    if "torsion" in chosen:
        blocks.append(work.block("torsion", (4,), wanted))
    blocks += [work.block(f"ovalising_{n}", (), wanted) for n in ovalising]
    cells = mesh.meridian.cells.shape[1]
    all_facts = {
        "element": f"Q{mesh.order}",
        "order": mesh.order,
        "cells": cells,
        **facts,
        "representative_size": float(np.sqrt(work.area / cells)),
        "pair_tolerance": 1e-9,
    }
    further = Families(scene, lambda n: Work(scene, mesh).block(f"ovalising_{n}", (), wanted))
    return Body(
        "harmonic",
        tuple(blocks),
        tuple(ports),
        elastic_scale(scene),
        scene.length,
        all_facts,
        mesh,
        further,
    )


logging.getLogger("skfem").setLevel(logging.ERROR)


#: share of the stiffness of a clamped strip that a disc gets, whose support is no clamp.  On 72
#: random shafts the closed form reached 1.27 of the truth with a clamp (flanges on hollow shafts),
#: 0.92 with this; on cones it reaches 1.17 for another reason.
HELD = 0.25
#: vectors that the lowest frequency of a light mesh takes, to its three digits
VECTORS = 8


class Families:
    """Motions of n >= 2 waves around the axis; ``block(n)`` is their block on the mesh of the body."""

    def __init__(self, scene: Shaft, build: Callable[[int], Block]):
        self._scene, self.block = scene, build
        self._parts = _parts(scene.segments)
        self._lowest: dict[int, float] = {}
        self._work: Work | None = None

    def bound(self, n: int) -> float:
        """Return the frequency (Hz) above which all motions of n waves should lie, in closed form;
        it grows with n.
        """
        return float(_rings(self._parts, n).min() / (2 * np.pi))

    def light(self, n: int) -> float:
        """Compute the lowest frequency (Hz) of n waves on a light mesh, somewhat too high."""
        if n not in self._lowest:
            block = self._light_work().block(f"ovalising_{n}", (), ())
            value = spla.eigsh(
                block.stiffness.tocsc(),
                1,
                block.mass.tocsc(),
                sigma=0.0,
                v0=np.ones(block.size),
                ncv=min(VECTORS, block.size),
                return_eigenvectors=False,
                tol=1e-3,
            )
            self._lowest[n] = float(np.sqrt(value[0]) / (2 * np.pi))
        return self._lowest[n]

    def _light_work(self):
        if self._work is None:
            s = self._scene
            thick = s.outline.largest_radius
            grading = Grading(layers=0, edge_layers=0, size=max(s.length / 12, thick / 3))
            self._work = Work(s, harmonic_mesh(meridian(s, layout(s, grading)), 2))
        return self._work


def _parts(segments) -> np.ndarray:
    """Return walls that may ovalise: rows of (largest radius, thickness, overhang over the support or
    infinity, E / rho).

    A segment is a wall as thick as it is radially.  Neighbours that together stick out over a
    radius, or into the bore of others, are a disc as thick as they are long.
    """
    rows = [
        (
            max(s.outer0, s.outer1),
            min(s.outer0 - s.inner0, s.outer1 - s.inner1),
            np.inf,
            s.material.E / s.material.density,
        )
        for s in segments
    ]
    for base, run in overhangs(
        [(max(s.outer0, s.outer1), s.length, s.material.E / s.material.density) for s in segments],
        0.0,
    ):
        height = max(r for r, _, _ in run)
        rows.append(
            (
                height,
                sum(length for _, length, _ in run),
                height - base if base else np.inf,
                min(c for _, _, c in run),
            )
        )
    # inwards: the same with radii counted from a bore to the axis
    for base, run in overhangs(
        [(-min(s.inner0, s.inner1), s.length, s.material.E / s.material.density) for s in segments]
    ):
        depth = max(r for r, _, _ in run)
        rows.append(
            (-base, sum(length for _, length, _ in run), depth - base, min(c for _, _, c in run))
        )
    return np.array(rows)


def _rings(parts, n: int) -> np.ndarray:
    """Return the least circular frequency (k,) of each part, rad/s."""
    radius, thickness, overhang, speed2 = parts.T
    ring = speed2 * thickness**2 / 12 * (n * (n * n - 1)) ** 2 / (n * n + 1) / radius**4
    strip = HELD * speed2 * thickness**2 * 12.4 / 12 / overhang**4
    # Rayleigh waves run at 0.57 of sqrt(E / rho) and more, whatever Poisson's ratio below 1/2.
    shear = speed2 * (0.53 * n / radius) ** 2
    return 1 / np.sqrt(1 / (ring + strip) + 1 / shear)
