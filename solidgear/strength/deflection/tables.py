"""Tables of a shaft or a train at rest under load, from its record."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import degrees, isfinite
from typing import Any

from solidgear.core import listed
from solidgear.show.table import Cell, Column, Table, numbers, quantity, text, word
from solidgear.show.units import ENGINEERING, Units

DOFS = ("x", "y", "z", "thx", "thy", "thz")
SI_OF = ("m moved",) * 3 + ("rad moved",) * 3
#: per cent; no smaller error bar is shown
LEAST = 0.01
#: of the largest of a motion's translations or rotations; less is rounding
ROUNDING = 1e-9
LOAD_OF = ("N",) * 3 + ("N m",) * 3


def misalignment(deflected: Any, units: Units = ENGINEERING) -> Table:
    """Return misalignment by every model, with error bar and range by bearing data."""
    judge = deflected.judge
    columns = [word("of the axes", lambda m: f"{m.name}, {units.unit(m.unit)}")]
    columns += [Column(model.model, partial(_of, model, units)) for model in deflected.solutions]
    columns.append(Column("error bar", _bar))
    if any(m.open is not None for m in judge.misalignment):
        columns.append(Column("range", lambda m: _range(m, units)))
    note = (
        f"{meanings(judge.misalignment, units)}. Error bar: of the last model's mesh, "
        "by local problems; models differ by what their theory leaves out."
    )
    if any(m.open is not None for m in judge.misalignment):
        note += " Range: by estimated insides and classes of clearance of the bearings."
    return Table("Misalignment", columns, judge.misalignment, note)


def meanings(measures: Sequence[Any], units: Units) -> str:
    """Return the meanings of all numbers, each once for all meshes, with their faces."""
    meanings = {m.name.removesuffix(m.mesh): m.meaning for m in measures}
    faces: dict[str, list[str]] = {}
    for m in measures:
        if m.face is not None:
            faces.setdefault(units.given(m.face, "m"), []).append(m.mesh.strip())
    unit = units.unit("m")
    parts = ", ".join(f"{face} {unit} {listed(meshes)}" for face, meshes in faces.items())
    width = (
        f"the face ({parts})" if len(faces) > 1 else "".join(f"{f} {unit} of face" for f in faces)
    )
    each = (f"{name}: {meaning}" for name, meaning in meanings.items())
    return "; ".join(each).replace("the face", width)


def over_a_turn(turns: Sequence[Any], units: Units = ENGINEERING) -> list[Table]:
    """Return the mesh forces of planets over a turn of their carrier, a table for each stage."""

    def column(title: str, key: str) -> Column:
        return quantity(title, "N", units, lambda planet: getattr(planet, key), 4)

    note = (
        "Force of each planet with the sun, and with the ring alike, since it spins freely; "
        "bearings have their stiffness at this position. Here: at the file's position; once a "
        "turn: amplitude at the carrier's frequency."
    )
    return [
        Table(
            f"Mesh forces over a turn of the carrier ({turn.stage})",
            [
                Column("planet", lambda planet: planet.planet),
                column("here", "at"),
                column("mean", "mean"),
                column("least", "least"),
                column("largest", "most"),
                column("once a turn", "once"),
            ],
            turn.planets,
            note,
        )
        for turn in turns
    ]


def turn_lines(turn: Any) -> Table:
    """Return the mesh force of every planet over the angle of the carrier in SI, for other
    programs.
    """
    forces = {f"planet {k} [N]": force for k, force in enumerate(turn.force.T, start=1)}
    return numbers({"carrier [rad]": turn.angle, **forces})


def over_points(points: Sequence[Any], units: Units = ENGINEERING) -> list[Table]:
    """Return misalignment and radial bearing loads over several operating points; none for one
    point.
    """
    if not points:
        return []
    first = points[0]
    label = text("at", lambda deflected: deflected.point.label)
    forces = [
        quantity("mesh force" + name.removeprefix("mesh"), "N", units, partial(_force, name), 4)
        for name in first.mesh_forces
    ]
    lie = [
        quantity(m.name, m.unit, units, partial(_lies, k), 3)
        for k, m in enumerate(first.misalignment)
    ]
    widest = [_widest(points, k) for k in range(len(first.misalignment))]
    bars = [f"{m.name} {bar}" for m, bar in zip(first.misalignment, widest) if bar]
    note = f"By {first.model}; error bars {', '.join(bars)} at most." if bars else ""
    ends = [
        (s, f"{shaft.name}.{b.name}")
        for s, shaft in enumerate(first.shafts)
        for b in shaft.bearings
    ]
    carried = [quantity(end, "N", units, partial(_radial, s, end), 4) for s, end in ends]
    return [
        Table("Misalignment over the operating points", [label, *forces, *lie], points, note),
        Table("Radial bearing loads over the operating points", [label, *carried], points),
    ]


def _force(name: str, deflected: Any) -> float:
    return deflected.mesh_forces[name]


def _lies(k: int, deflected: Any) -> float:
    return deflected.misalignment[k].value


def _radial(side: int, end: str, deflected: Any) -> float:
    shaft = deflected.shafts[side]
    return next(b.radial for b in shaft.bearings if f"{shaft.name}.{b.name}" == end)


def _widest(points: Sequence[Any], k: int) -> str | None:
    """Return the widest error bar of a number over all points, in per cent of its largest value."""
    measures = [deflected.misalignment[k] for deflected in points]
    largest = max(abs(m.value) for m in measures)
    bars = [m.bar for m in measures if m.bar is not None]
    return f"± {max(100 * max(bars) / largest, LEAST):.2g} %" if bars and largest else None


def _of(deflected: Any, units: Units, measured: Any) -> str:
    value = next(m.value for m in deflected.misalignment if m.name == measured.name)
    return units.number(value, measured.unit, 3)


def _bar(measured: Any) -> str | None:
    if measured.bar is None or not measured.value:
        return None
    share = 100 * measured.bar / abs(measured.value)
    return f"± {max(share, LEAST):.2g} %"


def _range(measured: Any, units: Units) -> str | None:
    if measured.open is None:
        return None
    low, high = (units.number(v, measured.unit, 3) for v in measured.open)
    return f"{low} to {high}"


def displacements(shafts: Sequence[Any], units: Units = ENGINEERING) -> Table:
    """Return the motion of every lumped point and bearing."""
    rows = [(f"{s.name}.{name}", six) for s in shafts for name, six in s.ports.items()]
    columns = [word("place", lambda row: row[0]), *_six(units, lambda row: row[1])]
    note = "Relative to the unloaded state, in the axes of each shaft's scene, y along it."
    return Table("Displacements", columns, rows, note)


def housing(deflected: Any, units: Units = ENGINEERING) -> list[Table]:
    """Return loads on the mounts of a housing and its motion; none without one."""
    if not deflected.mounts:
        return []

    most = [max(abs(six[k].value) for six in deflected.mounts.values()) for k in range(6)]

    def one(k: int, row: tuple[str, Sequence[Any]]) -> float:
        return _of_weight(row[1][k].value, most[3 * (k // 3) :][:3])

    name, six = word("mount", lambda row: row[0]), enumerate(zip(DOFS, LOAD_OF))
    carried = [quantity(dof, si, units, partial(one, k), 4) for k, (dof, si) in six]
    note = "Load of the housing on each mount, in the axes of the first shaft's scene."
    moved = [("centre of mass", [m.value for m in deflected.displacement["housing"]])]
    place = word("place", lambda row: row[0])
    return [
        Table("Mount loads", [name, *carried], [*deflected.mounts.items()], note),
        Table("Motion of the housing", [place, *_six(units, lambda row: row[1])], moved),
    ]


def _of_weight(value: float, column: Sequence[float]) -> float:
    """Return a value, or zero if it is rounding beside the largest of its column."""
    return float(value) if abs(value) > ROUNDING * max(map(abs, column)) else 0.0


def models(shafts: Sequence[Any], port: str, note: str, units: Units = ENGINEERING) -> Table:
    """Return the motion of one place by every model."""
    columns = [word("model", lambda s: s.model), *_six(units, lambda s: s.ports[port])]
    return Table(f"Motion of {port}", columns, shafts, note)


def _six(units: Units, motion: Callable[[Any], Any]) -> list[Column]:
    """Return columns of the six components of a motion."""

    def one(k: int, item: Any) -> float:
        six = motion(item)
        return _of_weight(six[k], six[:3] if k < 3 else six[3:])

    return [
        quantity(dof, si, units, partial(one, k), 4) for k, (dof, si) in enumerate(zip(DOFS, SI_OF))
    ]


def bearings(shafts: Sequence[Any], units: Units = ENGINEERING) -> list[Table]:
    """Return loads of every bearing, and the elements that carry them in catalogue bearings."""
    rows = [(f"{s.name}.{b.name}", b) for s in shafts for b in s.bearings]
    inside = [row for row in rows if row[1].rows]
    name = word("bearing", lambda row: row[0])
    loads = [
        name,
        quantity("radial", "N", units, lambda row: row[1].radial, 4),
        Column("at, deg", lambda row: f"{degrees(row[1].azimuth):.0f}"),
        quantity("axial", "N", units, lambda row: float(row[1].load[1]), 4),
        quantity("moment", "N m", units, lambda row: row[1].moment, 4),
    ]
    note = "Load of the shaft on the bearing; it acts at an angle from x towards z."
    if inside:
        loads += [
            Column("C0/P0", lambda row: _life(row[1], "static_safety", 1.0)),
            Column("L10r, 1e6", lambda row: _life(row[1], "reference", 1e6)),
        ]
        note += (
            " C0/P0: static safety (ISO 76); L10r: basic reference life (ISO/TS 16281) in 1e6 "
            "revolutions; solidgear bearing shows their ranges and duty tables."
        )
    out = [Table("Bearing loads", loads, rows, note)]
    if inside:
        carried = [
            name,
            word("loaded", lambda row: _elements(row[1])),
            quantity("largest", "N", units, lambda row: _largest(row[1]), 4),
            quantity("pressure", "Pa", units, lambda row: row[1].pressure, 4),
            quantity("clearance", "m moved", units, lambda row: row[1].clearance, 3),
        ]
        note = (
            "Number of loaded elements of all, row by row; largest load of an element; largest "
            "pressure at both rings, by Hertz or in slices; radial clearance once mounted and "
            "warm."
        )
        out.append(Table("Inside the bearings", carried, inside, note))
    return out


def _life(bearing: Any, name: str, unit: float) -> str | None:
    if bearing.life is None:
        return None
    value = getattr(bearing.life, name) / unit
    return f"{value:.3g}" if isfinite(value) else "endless"


def _elements(bearing: Any) -> str | Cell | None:
    if not bearing.rows:
        return None
    counts = ", ".join(f"{n}/{len(row.load)}" for n, row in zip(bearing.loaded, bearing.rows))
    return counts if any(bearing.loaded) else Cell("none", "bad")


def _largest(bearing: Any) -> float | None:
    return max((float(row.load.max()) for row in bearing.rows), default=None)


def line(shaft: Any) -> Table:
    """Return the deflection line of a shaft in SI, for other programs."""
    heads = [f"{dof} [{si.split()[0]}]" for dof, si in zip(DOFS, SI_OF)]
    return numbers({"y [m]": shaft.stations, **dict(zip(heads, shaft.line.T))})
