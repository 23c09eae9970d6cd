"""Sheet of the contact of teeth: tables, charts and sentences."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from solidgear.show.command import caution
from solidgear.show.plot import Make
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.table import NUMBER, Column, Table, numbers, word
from solidgear.show.units import Units, in_ascii
from solidgear.teeth.bevel.train import BevelContact
from solidgear.teeth.charts import (
    bevel_pattern_chart,
    cycle_chart,
    face_chart,
    pattern_chart,
    torque_chart,
)
from solidgear.teeth.mesh_contact import MeshContact
from solidgear.teeth.study import AtTorque, TeethStudy

#: motion that rounding leaves, m
ROUNDING = 1e-13
#: orders of the error in the table
SHOWN_ORDERS = 3
CYCLE_SHOWN = (
    "Transmission error and stiffness over a mesh cycle; the error without load is that of the "
    "flanks and of shafts under all other loads."
)
PATTERN_SHOWN = "Contact pattern: the largest line load that every place of the flank carries over a mesh cycle."
FACE_SHOWN = "Load by face width, mean over a mesh cycle; aligned: with wheels held as they lie."
TORQUE_SHOWN = "Transmission error, its first orders and stiffness over the torque."


def contact_sheet(study: TeethStudy, units: Units) -> Sheet:
    """Return the sheet of the contact of all meshes."""
    meshes, bevels = study.meshes, study.bevels
    several = len(meshes) + len(bevels) > 1
    tables = [of_mesh(mesh, units, NOTE if mesh is meshes[-1] else "") for mesh in meshes]
    tables += [of_bevel(mesh, units) for mesh in bevels]
    charts: dict[str, Make] = {}
    words: dict[str, str] = {}
    for number, mesh in enumerate(meshes, start=1):
        end = f"_{number}" if several else ""
        name = mesh.name if several else ""
        for stem, chart, shown in (
            ("cycle", cycle_chart, CYCLE_SHOWN),
            ("pattern", pattern_chart, PATTERN_SHOWN),
            ("face", face_chart, FACE_SHOWN),
        ):
            charts[stem + end] = partial(chart, mesh, units, name)
            words[stem + end] = shown
        if curve := study.curves.get(mesh.name):
            tables.append(over_torque(curve, units, name))
            charts["torque" + end] = partial(torque_chart, curve, units, name)
            words["torque" + end] = TORQUE_SHOWN
    for number, bevel in enumerate(bevels, start=len(meshes) + 1):
        end = f"_{number}" if several else ""
        name = bevel.name if several else ""
        charts["cycle" + end] = partial(cycle_chart, bevel, units, name)
        charts["pattern" + end] = partial(bevel_pattern_chart, bevel, units, name)
        words |= {"cycle" + end: CYCLE_SHOWN, "pattern" + end: PATTERN_SHOWN}
    all_meshes: tuple[MeshContact | BevelContact, ...] = (*meshes, *bevels)
    notes = [line for mesh in all_meshes for line in sentences(mesh, study, units)]
    return Sheet(
        name="contact",
        title=f"{study.title}: contact of teeth",
        lead=f"At {study.point.label}; teeth by plane slices, shafts as Timoshenko beams.",
        tables=tables,
        data=study.as_dict(),
        charts=charts,
        lines={
            f"cycle_{number}" if several else "cycle": cycle_lines(mesh)
            for number, mesh in enumerate(all_meshes, start=1)
        },
        notes=notes,
        cautions=study.cautions,
        words=words,
        terminal=Terminal(
            heading=[f"{study.title} at {study.point.label}: contact of teeth"],
            tables=tables,
            closing=[*map(in_ascii, notes), *map(caution, study.cautions)],
        ),
    )


NOTE = (
    "Tangent: about the load, what vibrates; secant: from first touch to the load. ISO 6336-1: with "
    "CM = 0.8, along the line of action. Askew: how far flanks open from end to end of the face."
)


BEVEL_NOTE = (
    "Tangent: about the load, what vibrates; secant: from first touch to the load. Flanks follow from "
    "the blank's data, as a face-mill cutter leaves them."
)


def of_mesh(mesh: MeshContact, units: Units, note: str) -> Table:
    """Return the numbers of a mesh, with their range over the cycle."""
    columns = [
        word(""),
        Column("mean or all", kind=NUMBER),
        Column("least", kind=NUMBER),
        Column("largest", kind=NUMBER),
    ]
    rows = [*_stiffnesses(mesh, units), *_errors(mesh, units), *_along_the_face(mesh, units)]
    return Table(f"Contact of teeth: {mesh.name}", columns, rows, note)


Row = list[str | None]


def _alone(head: str, value: str) -> Row:
    return [head, value, "", ""]


def of_bevel(mesh: BevelContact, units: Units) -> Table:
    """Return the numbers of a bevel mesh, with their range over the cycle."""
    columns = [
        word(""),
        Column("mean or all", kind=NUMBER),
        Column("least", kind=NUMBER),
        Column("largest", kind=NUMBER),
    ]
    cycle, flanks = mesh.cycle, mesh.pair.flanks
    band: list[Row] = []
    if mesh.band is not None:
        ends = (units.number(value, "N/m", 4) for value in mesh.band.stiffness)
        band = [[f"tangent by usual cutters, ease-offs, {units.unit('N/m')}", "", *ends]]
    rows = [
        *_loads(mesh, f"{flanks.contact_ratio:.2f}", units),
        *band,
        *_errors(mesh, units),
        _alone(
            f"largest pressure, {units.unit('Pa stressed')}",
            units.number(cycle.pressure, "Pa stressed", 4),
        ),
        _alone("load on tips and ends of the face", f"{100 * cycle.corner_share:.0f} %"),
        _alone("lines that carry, mean", f"{cycle.mean_lines:.2f}"),
    ]
    return Table(f"Contact of bevel teeth: {mesh.name}", columns, rows, BEVEL_NOTE)


def _loads(mesh: MeshContact | BevelContact, ratio: str, units: Units) -> list[Row]:
    """Return rows of load, contact ratio and stiffness by contact."""
    cycle, unit = mesh.cycle, units.unit("N/m")

    def spread(head: str, values: np.ndarray) -> Row:
        shown = values.mean(), values.min(), values.max()
        return [f"{head}, {unit}", *(units.number(float(v), "N/m", 4) for v in shown)]

    torque, force = units.unit("N m"), units.unit("N")
    return [
        _alone(f"torque on the first wheel, {torque}", units.number(cycle.torque, "N m", 4)),
        _alone(f"force along the line of action, {force}", units.number(cycle.force, "N", 4)),
        _alone(
            "contact ratio" if isinstance(mesh, BevelContact) else "contact ratio, overlap", ratio
        ),
        spread("teeth, tangent", cycle.tangent),
        spread("teeth, secant", cycle.secant),
        spread("if aligned, tangent", mesh.aligned.tangent),
        spread("teeth and supports, tangent", cycle.supported_tangent),
    ]


def _stiffnesses(mesh: MeshContact, units: Units) -> list[Row]:
    """Return rows of load and stiffness."""

    def norm(head: str, specific: float) -> Row:
        value = units.number(mesh.along_line(specific), "N/m", 4)
        return _alone(f"{head}, {units.unit('N/m')}", value)

    return [
        *_loads(mesh, _ratios(mesh), units),
        norm("ISO 6336-1, one pair of teeth", mesh.norm.single),
        norm("ISO 6336-1, mesh", mesh.norm.mesh),
    ]


def _errors(mesh: MeshContact | BevelContact, units: Units) -> list[Row]:
    """Return rows of the transmission error."""
    cycle, unit = mesh.cycle, units.unit("m moved")

    def size(head: str, value: float) -> Row:
        return _alone(f"{head}, {unit}", _size(value, units))

    orders = np.abs(cycle.orders(SHOWN_ORDERS))
    return [
        size("loaded error, peak to peak", cycle.peak_to_peak),
        *(size(f"its order {n}", float(a)) for n, a in enumerate(orders, start=1)),
        size("error without load, peak to peak", float(np.ptp(cycle.free_error))),
    ]


def _along_the_face(mesh: MeshContact, units: Units) -> list[Row]:
    """Return rows of how load lies on the flank."""
    cycle, unit = mesh.cycle, units.unit("m moved")
    pressure = units.number(cycle.pressure, "Pa stressed", 4)
    return [
        _alone(f"askew by bending, {unit}", _size(mesh.skew.bending, units)),
        _alone(f"askew by wind-up, {unit}", _size(mesh.skew.turning, units)),
        _alone("face load factor", f"{cycle.face_load_factor:.2f}"),
        _alone("face load factor, ISO 6336-1", f"{mesh.norm_face_load_factor:.2f}"),
        _alone("largest line load over its mean", f"{cycle.line_load_factor:.2f}"),
        _alone(f"largest pressure, {units.unit('Pa stressed')}", pressure),
        _alone("lines that carry, mean", f"{cycle.mean_lines:.2f}"),
    ]


def _size(value: float, units: Units) -> str:
    """Write a motion, nothing below what rounding leaves."""
    return units.number(value if abs(value) > ROUNDING else 0.0, "m moved", 3)


def _ratios(mesh: MeshContact) -> str:
    return f"{mesh.wheels.contact_ratio:.3f}, {mesh.wheels.overlap_ratio:.3f}"


def over_torque(curve: Sequence[AtTorque], units: Units, name: str) -> Table:
    """Return numbers of a mesh over the torque."""

    def size(head: str, si: str, of: Callable[[AtTorque], float], digits: int = 4) -> Column:
        return Column(
            f"{head}, {units.unit(si)}", lambda at: units.number(of(at), si, digits), kind=NUMBER
        )

    columns = [
        size("torque", "N m", lambda at: at.torque),
        size("error pp", "m moved", lambda at: at.contact.cycle.peak_to_peak, 3),
        size("order 1", "m moved", lambda at: float(abs(at.contact.cycle.orders(1)[0])), 3),
        size("order 2", "m moved", lambda at: float(abs(at.contact.cycle.orders(2)[1])), 3),
        size("tangent", "N/m", lambda at: float(at.contact.cycle.tangent.mean())),
        Column("KHb", lambda at: f"{at.contact.cycle.face_load_factor:.2f}", kind=NUMBER),
        size("pressure", "Pa stressed", lambda at: at.contact.cycle.pressure),
    ]
    return Table(f"Over the torque{f': {name}' if name else ''}", columns, curve)


def cycle_lines(mesh: MeshContact | BevelContact) -> Table:
    """Return a mesh cycle in SI, for other programs."""
    cycle = mesh.cycle
    return numbers(
        {
            "phase [pitches]": cycle.phases,
            "loaded error [m]": cycle.error,
            "unloaded error [m]": cycle.free_error,
            "secant [N/m]": cycle.secant,
            "tangent [N/m]": cycle.tangent,
            "secant with supports [N/m]": cycle.supported_secant,
            "tangent with supports [N/m]": cycle.supported_tangent,
        }
    )


def sentences(mesh: MeshContact | BevelContact, study: TeethStudy, units: Units) -> list[str]:
    """Return what is to be said of a mesh."""
    several = len(study.meshes) + len(study.bevels) > 1
    head = f"{mesh.name}: " if several else ""
    lines = []
    tangent, stated = float(mesh.cycle.tangent.mean()), study.stiffness[mesh.name]
    if stated is not None:
        lines.append(
            f"{head}the file has a mesh stiffness of {units.text(stated, 'N/m', 4)}; its teeth give "
            f'{units.text(tangent, "N/m", 4)} about this load: write stiffness = "teeth" to take it.'
        )
    if mesh.edge:
        lines.append(f"{head}{mesh.edge}.")
    if mesh.assumed:
        lines.append(f"{head}assumed: {'; '.join(mesh.assumed)}.")
    if isinstance(mesh, BevelContact) and mesh.band is not None:
        least, most = (units.text(value, "N/m", 3) for value in mesh.band.stiffness)
        lines.append(
            f"{head}over usual cutters and ease-offs the mesh stiffness is {least} to {most}, a "
            f"factor of {mesh.band.factor:.1f}: give cutter_radius and ease_off."
        )
    return lines
