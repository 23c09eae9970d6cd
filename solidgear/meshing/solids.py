"""The solids of a STEP file: read, turned into the scene, and joined where they touch.

What is in here runs in a process of its own, as :mod:`solidgear.meshing.step` says.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import acos
from typing import Any

import numpy as np

from solidgear.errors import listed, show
from solidgear.meshing.placing import Placing
from solidgear.meshing.quality import MeshError

#: solids that a sentence names
TOLD = 8


def read_solids(gmsh: Any, path: str, place: Placing, *, several: bool) -> list[int]:
    """The solids of a file in its order, turned and shifted, in metres; MeshError where it cannot
    be read, or has no solid, or several where one is wanted.
    """
    gmsh.option.setString("Geometry.OCCTargetUnit", "M")
    occ = gmsh.model.occ
    try:
        occ.importShapes(path, highestDimOnly=False)
        occ.synchronize()
    except Exception as error:
        raise MeshError("cannot be read as STEP: it is broken or cut off") from error
    solids = [tag for _, tag in gmsh.model.getEntities(3)]
    if not solids or (len(solids) > 1 and not several):
        raise MeshError(_no_solid(gmsh, solids))
    for tag in solids:
        # measured before anything is meshed: without a size, nothing below makes sense
        volume, which = occ.getMass(3, tag), (f" {tag}" if len(solids) > 1 else "")
        if not np.isfinite(volume) or abs(volume) < 1e-18:
            raise MeshError(f"its solid{which} has a volume of {volume:.3g} m^3")
        if volume < 0:
            raise MeshError(f"its solid{which} is turned inside out, with a volume below zero")
    every = [(3, tag) for tag in solids]
    x, y, z = (-v for v in place.foot)
    occ.translate(every, x, y, z)
    axis, angle = axis_angle(np.array(place.turn))
    if angle:
        occ.rotate(every, 0.0, 0.0, 0.0, *axis, angle)
    occ.synchronize()
    return solids


def axis_angle(turn: np.ndarray) -> tuple[tuple[float, float, float], float]:
    """Axis and angle (rad, 0 to pi) of a (3, 3) rotation.

    Examples
    --------
    >>> from math import pi
    >>> from solidgear.meshing.placing import TURNS
    >>> axis_angle(np.array(TURNS["x"]))[1] == pi / 2
    True
    """
    angle = acos(float(np.clip((np.trace(turn) - 1) / 2, -1.0, 1.0)))
    w, v = np.linalg.eigh((turn + turn.T) / 2)
    axis = v[:, int(np.argmax(w))]
    skew = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    if skew @ axis < 0:
        axis = -axis
    x, y, z = (float(v) for v in axis)
    return (x, y, z), angle


def solid_owners(
    gmsh: Any, solids: list[int], named: Sequence[str]
) -> tuple[list[int], tuple[str, ...]]:
    """Place of each solid among the numbers (from 1, in the order of the file) of those with
    materials of their own, one more than the last place for the rest; and the numbers of the rest.
    MeshError for a number that is not there, or twice.
    """
    numbers = [str(k) for k in range(1, len(solids) + 1)]
    for name in named:
        if name not in numbers:
            there = [f"{n} {_size(gmsh, tag)}" for n, tag in zip(numbers, solids)]
            raise MeshError(f"has no solid {show(name)}; there are {listed(there, TOLD)}")
    owner = [named.index(n) if n in named else len(named) for n in numbers]
    return owner, tuple(n for n in numbers if n not in named)


def _size(gmsh, tag: int) -> str:
    """Volume and place of a solid."""
    occ = gmsh.model.occ
    return f"of {1e6 * occ.getMass(3, tag):.4g} cm^3 at {mm(occ.getCenterOfMass(3, tag))}"


def fragmented(gmsh: Any, solids: list[int], tools: list[tuple[int, int]]) -> list[list[int]]:
    """Pieces of each solid, cut by circles and discs (dimension and tag) and by each other, so that
    they share the faces where they touch; MeshError where they cannot be cut, overlap or do not
    touch.
    """
    occ = gmsh.model.occ
    if len(solids) == 1 and not tools:
        return [solids]
    others = [(3, tag) for tag in solids[1:]]
    try:
        _, made = occ.fragment([(3, solids[0])], [*others, *tools])
    except Exception as error:
        what = "its solids cannot be joined" if others else "the ends of seats cannot be cut"
        raise MeshError(f"{what}{' into the surface' if not others else ''} ({error})") from error
    occ.synchronize()
    for dimension in (2, 1):
        loose = [
            (dimension, tag)
            for _, tag in gmsh.model.getEntities(dimension)
            if not len(gmsh.model.getAdjacencies(dimension, tag)[0])
        ]
        occ.remove(loose, recursive=True)
        occ.synchronize()
    pieces = [[tag for d, tag in own if d == 3] for own in made[: len(solids)]]
    _apart(gmsh, pieces)
    _touching(gmsh, pieces)
    return pieces


def _apart(gmsh, pieces: list[list[int]]) -> None:
    """Refuse solids that share a piece."""
    for j, own in enumerate(pieces):
        for i, other in enumerate(pieces[:j]):
            both = sum(gmsh.model.occ.getMass(3, tag) for tag in set(own) & set(other))
            if both > 0:
                raise MeshError(
                    f"its solids {i + 1} and {j + 1} overlap in {1e9 * both:.4g} mm^3: draw them "
                    "with faces that touch, an interference fit too"
                )


def _touching(gmsh, pieces: list[list[int]]) -> None:
    """Refuse solids that hang together by no face."""
    of = {tag: k for k, own in enumerate(pieces) for tag in own}
    group = list(range(len(pieces)))
    for _, face in gmsh.model.getEntities(2):
        around = [of[int(tag)] for tag in gmsh.model.getAdjacencies(2, face)[0]]
        if len(around) == 2:
            a, b = (group[k] for k in around)
            group = [a if g == b else g for g in group]
    loose = [k + 1 for k, g in enumerate(group) if g != group[0]]
    if loose:
        tag = pieces[loose[0] - 1][0]
        raise MeshError(
            f"its solid {loose[0]} {_size(gmsh, tag)} touches no face of solid 1 or of what holds "
            "on to it: move them together in the CAD program, or leave one out"
        )


def _no_solid(gmsh, solids: list[int]) -> str:
    """Reason why a file does not hold one solid."""
    if solids:
        each = [gmsh.model.occ.getCenterOfMass(3, tag) for tag in solids[:4]]
        places = "; ".join(f"at {mm(at)}" for at in each)
        return (
            f"holds {len(solids)} separate solids ({places}) where one is wanted: join them in the "
            "CAD program, or name the material of each that touches another under materials, by "
            "its number"
        )
    faces = [tag for _, tag in gmsh.model.getEntities(2)]
    if not faces:
        return "holds no solid, and no faces either"
    loose = [
        int(gmsh.model.getAdjacencies(1, edge)[0][0])
        for _, edge in gmsh.model.getEntities(1)
        if len(gmsh.model.getAdjacencies(1, edge)[0]) == 1
    ]
    at = loose[0] if loose else faces[0]
    return (
        f"holds {len(faces)} faces that enclose no solid; the shell is open at face {at} at "
        f"{mm(gmsh.model.occ.getCenterOfMass(2, at))}"
    )


def mm(at) -> str:
    return "({:.4g}, {:.4g}, {:.4g}) mm".format(*(round(1e3 * float(v), 6) + 0.0 for v in at))
