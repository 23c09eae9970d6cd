"""Axisymmetric-harmonic solid: exact 3D elasticity of a body of revolution on the meridian.

Here a scene is meshed and the blocks put together; unknowns and matrices of one harmonic are in
:mod:`solidgear.core.models.harmonic.blocks`.
"""

from __future__ import annotations

import logging

import numpy as np

from solidgear.core.body import Body, Port
from solidgear.core.kernel.room import assemblable
from solidgear.core.meshing.grading import Grading
from solidgear.core.meshing.layout import layout
from solidgear.core.meshing.meridian import Cut, cut_meridian, drawn_across, meridian
from solidgear.core.models.harmonic.blocks import Work
from solidgear.core.models.harmonic.circumferential import Families
from solidgear.core.models.harmonic.mesh import harmonic_mesh
from solidgear.core.models.limits import countable
from solidgear.core.models.options import HARMONIC_OPTIONS, thick_enough
from solidgear.core.models.spectrum import elastic_scale
from solidgear.core.scene.attached import attached_stations
from solidgear.core.scene.coned import coned


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
    further = Families(scene, lambda n: Work(scene, mesh).block(f"ovalising_{n}", (), wanted))
    return Body(
        "harmonic",
        tuple(blocks),
        tuple(ports),
        elastic_scale(scene),
        scene.length,
        facts,
        mesh,
        further,
    )


logging.getLogger("skfem").setLevel(logging.ERROR)
