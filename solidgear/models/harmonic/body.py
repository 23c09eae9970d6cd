"""Axisymmetric-harmonic solid: exact 3D elasticity of a body of revolution on its meridian.

The unknowns and the matrices of one harmonic are in
:mod:`solidgear.models.harmonic.blocks`; here a scene is meshed and its blocks put together.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from skfem import ElementQuad1, ElementQuad2, MeshQuad1
from skfem.element import ElementQuadP

from solidgear.body import Body, Port
from solidgear.body.surface import Surface
from solidgear.kernel.assembly import unknowns
from solidgear.kernel.room import assemblable
from solidgear.meshing.grading import Grading
from solidgear.meshing.layout import layout
from solidgear.meshing.meridian import Cut, Meridian, cut_meridian, drawn_across, meridian
from solidgear.models.harmonic.blocks import _Work
from solidgear.models.harmonic.circumferential import Families
from solidgear.models.harmonic.drawing import surface
from solidgear.models.limits import countable
from solidgear.models.options import HARMONIC_OPTIONS, thick_enough
from solidgear.models.spectrum import elastic_scale
from solidgear.scene.attached import attached_stations
from solidgear.scene.coned import coned


@dataclass(frozen=True)
class HarmonicMesh:
    """The mesh of a meridian, with the unknowns of one component of the displacement; the same before
    cells were cut towards corners, and the cell there of every cell.
    """

    mesh: MeshQuad1
    element: object
    dofs: np.ndarray
    meridian: Meridian
    uncut: Meridian
    parent: np.ndarray

    def surface(self, moved: Mapping[str, np.ndarray]) -> Surface:
        """The outline of the meridian turned around the axis."""
        return surface(self, moved)

    def rows(self, name: str, chosen: np.ndarray) -> np.ndarray:
        """(3 k, n) displacements of some points of the surface by the unknowns of a block."""
        from solidgear.models.harmonic.drawing import rows  # start-up: of responses alone

        return rows(self, name, chosen)

    def volume(self) -> None:
        """None: the mesh is that of a meridian."""
        return None


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
    """Free harmonic solid of a scene.

    Parameters
    ----------
    scene : Scene
    order : int
        Polynomial order of the quadrilaterals, 1 to 12.  The defaults are the reference setting, good to 1e-4 on the
        overhung pinion; order 8 with 4 layers and 2 edge layers gives about 1e-6.
    layers, edge_layers, ratio : int, int, float
        Geometric layers towards shoulders (also the ends of rigid seats) and towards the ends of
        averaged seats, and the size of each relative to the last.
    relative_size : float
        Cell size away from them in local outer radii (in a thin wall beside them, in decay lengths
        of the shell).
    size : float, optional
        The same for the whole shaft, m.
    refinement : float
        Multiplies the number of cells for convergence studies.
    attachments : tuple of str, optional
        Attachments to build for every station, the first being the default one; by
        default what the scene says.
    families : tuple of str, optional
        Which of bending, axial and torsion to build; all by default. A body without one of them
        knows nothing of its motions, and must be given supports that do not couple it
        (:meth:`solidgear.body.Supports.on`).
    ovalising : tuple of int
        Further harmonics n >= 2 to build at once; they carry no port motion.  Others are built when modes need them.
    cuts : tuple of (float, float, int)
        y and r of corners of the mesh, m, and how often all cells around each are cut towards it.
    across : tuple of (float, float)
        y and r of points on sides of cells, m, through which lines are drawn before that.
    plain : bool
        Whether the mesh to be cut has one cell a band and strip, however narrow seats and discs are.

    Raises
    ------
    SolidgearError
        For layers thinner than digits, cells without end, or a cut where the mesh has no corner.
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
    mesh = MeshQuad1(flat.points, flat.cells, sort_t=False)
    element = _element(order)
    dofs = unknowns(mesh, element)
    work = _Work(scene, mesh, element, dofs, flat, order)
    wanted = [*attached_stations(scene.stations, attachments)]
    ports = [Port(station.name, station.y, attachment) for station, attachment in wanted]
    chosen = families or HARMONIC_OPTIONS["families"].choices
    blocks = []
    if "bending" in chosen:
        bending = work.bending_block("bending_z", (2, 3), 1, wanted)
        blocks += [bending, bending.mirrored("bending_x", (0, 5), 0, (1.0, -1.0))]
    if "axial" in chosen:
        blocks.append(work.bending_block("axial", (1,), 0, wanted))
    if "torsion" in chosen:
        blocks.append(work.torsion_block(wanted))
    blocks += [work.bending_block(f"ovalising_{n}", (), n, wanted) for n in ovalising]
    facts = {
        "element": f"Q{order}",
        "order": order,
        "cells": flat.cells.shape[1],
        "layers": layers,
        "edge_layers": edge_layers,
        "ratio": ratio,
        "relative_size": relative_size,
        "refinement": refinement,
        "cuts": len(cuts),
        "plain": plain,
        "representative_size": float(np.sqrt(work.area / flat.cells.shape[1])),
        "pair_tolerance": 1e-9,
    }
    further = Families(
        scene,
        lambda n: _Work(scene, mesh, element, dofs, flat, order).bending_block(
            f"ovalising_{n}", (), n, wanted
        ),
    )
    return Body(
        "harmonic",
        tuple(blocks),
        tuple(ports),
        elastic_scale(scene),
        scene.length,
        facts,
        HarmonicMesh(mesh, element, dofs, flat, uncut, parent),
        further,
    )


def _element(order):
    if order == 1:
        return ElementQuad1()
    if order == 2:
        return ElementQuad2()
    return ElementQuadP(order)


logging.getLogger("skfem").setLevel(logging.ERROR)
