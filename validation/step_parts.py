"""Writes shafts as STEP files: `geometry/shaft_step.step` when run, others for tests.

python -m validation.step_parts
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core.machine.isolated import isolated
from solidgear.core.meshing.gmsh_session import Session, import_gmsh
from solidgear.core.meshing.revolved import draw_revolved
from solidgear.core.scene import Segment
from solidgear.core.scene.corner import Corner
from solidgear.core.scene.outline import Frustum, Outline
from solidgear.cuts.features import Keyway
from solidgear.cuts.solid.cuts import tool
from solidgear.parts.body_file import UNITS
from solidgear.parts.step import axis_angle
from validation.shipped import GEOMETRY

#: how a STEP file says its unit; the kernel writes millimetres whatever was drawn
MILLIMETRE = "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) )"
SAID = {
    "mm": MILLIMETRE,
    "m": "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT($,.METRE.) )",
}
#: lengths of features, which are drawn in the unit of the file
LENGTHS = ("y", "length", "width", "depth", "diameter", "offset")


def write_step(
    path: Path,
    segments: Sequence[Segment],
    features: Sequence[Any] = (),
    *,
    corners: Sequence[Corner] = (),
    unit: str = "mm",
    turn: np.ndarray | None = None,
    shift: Sequence[float] = (0.0, 0.0, 0.0),
    splines: bool = False,
) -> float:
    """Write a shaft as STEP.

    Parameters
    ----------
    corners : sequence of Corner
        Of fillets and chamfers.
    unit : {'mm', 'inch', 'm'}
        Of the numbers in the file.
    turn : (3, 3) ndarray, optional
        Rotation from the axes of the shaft to those of the file.
    shift : (float, float, float)
        And then where it is put, m.
    splines : bool
        Faces and edges are B-splines, whatever they are.

    Returns
    -------
    float
        Its volume as the kernel has it, m^3.
    """
    parts = tuple(segments), tuple(features), tuple(corners)
    return isolated(_write, path, *parts, unit, turn, shift, splines, seconds=120)


def _write(path, segments, features, corners, unit, turn, shift, splines) -> float:
    gmsh, scale = import_gmsh(), 1 / UNITS[unit]
    shapes = [Frustum(*(scale * v for v in Frustum.of_segment(s))) for s in segments]
    with Session(gmsh):
        occ = gmsh.model.occ
        lengths = ("y", "r", "axial", "radial")
        edges = [replace(c, **{k: scale * getattr(c, k) for k in lengths}) for c in corners]
        draw_revolved(gmsh, Outline(shapes, edges), [], [])
        solids = occ.getEntities(3)
        if len(solids) > 1:
            solids, _ = occ.fuse(solids[:1], solids[1:])
        for feature in features:
            sizes = {k: scale * getattr(feature, k) for k in LENGTHS if hasattr(feature, k)}
            radius = next(s.outer0 for s in segments if s.name == feature.segment)
            cutter = tool(occ, feature.with_changes(**sizes), scale * radius)
            solids, _ = occ.cut(solids, [(3, cutter)])
        if turn is not None:
            axis, angle = axis_angle(np.asarray(turn))
            occ.rotate(solids, 0.0, 0.0, 0.0, *axis, angle)
        occ.translate(solids, *(scale * v for v in shift))
        if splines:
            occ.convertToNURBS(solids)
        occ.synchronize()
        volume = occ.getMass(3, solids[0][1]) / scale**3
        gmsh.write(str(path))
    text = Path(path).read_text()
    text = re.sub(r"'\d{4}-\d\d-\d\dT[^']*'", "'2000-01-01T00:00:00'", text)
    Path(path).write_text(with_unit(text, unit))
    return float(volume)


def with_unit(text: str, unit: str) -> str:
    """A STEP file in millimetres that says another unit of the same numbers.

    Parameters
    ----------
    unit : {'mm', 'inch', 'm'}
    """
    assert MILLIMETRE in text
    if unit != "inch":
        return text.replace(MILLIMETRE, SAID[unit])
    last = max(int(n) for n in re.findall(r"^#(\d+)", text, re.M))
    inch = f"( CONVERSION_BASED_UNIT('INCH',#{last + 2}) LENGTH_UNIT() NAMED_UNIT(#{last + 1}) )"
    more = (
        f"#{last + 1} = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n"
        f"#{last + 2} = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#{last + 3});\n"
        f"#{last + 3} = {MILLIMETRE};\n"
    )
    head, tail = text.replace(MILLIMETRE, inch).rsplit("ENDSEC;", 1)
    return f"{head}{more}ENDSEC;{tail}"


def shaft_step() -> tuple[list[Segment], list[Any]]:
    """Segments and features of `geometry/shaft_step.step`."""
    sizes = (("left", 45, 40, 0), ("collar", 12, 56, 0), ("right", 90, 40, 0), ("tip", 33, 30, 0))
    segments, y = [], 0.0
    for name, length, diameter, bore in sizes:
        made = Segment.cylinder(name, length=length / 1e3, diameter=diameter / 1e3, bore=bore, y0=y)
        segments.append(made)
        y = made.y1
    key = Keyway(
        name="key", segment="right", y="85 mm", length="36 mm", width="12 mm", depth="5 mm"
    )
    return segments, [key]


def write_two(path: str) -> None:
    """Write two cylinders that do not touch."""
    gmsh = import_gmsh()
    with Session(gmsh):
        for y in (0.0, 200.0):
            gmsh.model.occ.addCylinder(0, y, 0, 0, 100, 0, 20)
        gmsh.model.occ.synchronize()
        gmsh.write(path)


def write_solids(path: str, solids: Sequence[tuple[float, float, float, float]]) -> None:
    """Write several cylinders and tubes along y, each a solid of its own.

    Parameters
    ----------
    solids : sequence of (y0, y1, radius, bore)
        mm; radii, and a bore of 0 is none.
    """
    gmsh = import_gmsh()
    with Session(gmsh):
        occ = gmsh.model.occ
        for y0, y1, radius, bore in solids:
            whole = occ.addCylinder(0, y0, 0, 0, y1 - y0, 0, radius)
            if bore:
                hole = occ.addCylinder(0, y0, 0, 0, y1 - y0, 0, bore)
                occ.cut([(3, whole)], [(3, hole)])
        occ.synchronize()
        gmsh.write(path)


def write_open(path: str) -> None:
    """Write the lateral face of a cylinder and one of its ends."""
    gmsh = import_gmsh()
    with Session(gmsh):
        occ = gmsh.model.occ
        solid = occ.addCylinder(0, 0, 0, 0, 100, 0, 20)
        occ.remove([(3, solid)])
        occ.synchronize()
        occ.remove([occ.getEntities(2)[-1]])
        occ.synchronize()
        gmsh.write(path)


def main() -> None:
    """Write `geometry/shaft_step.step`."""
    path = GEOMETRY / "shaft_step.step"
    volume = write_step(path, *shaft_step())
    print(f"{path.name}: {path.stat().st_size} bytes, {1e6 * volume:.4f} cm^3")


if __name__ == "__main__":
    main()
