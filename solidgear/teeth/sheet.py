"""Sheet of the contact of teeth: tables, charts and sentences."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from solidgear.show.command import caution
from solidgear.show.plot import Make
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.table import NUMBER, Column, Table, numbers, word
from solidgear.show.units import Units
from solidgear.teeth.charts import cycle_chart, face_chart, pattern_chart, torque_chart
from solidgear.teeth.mesh_contact import ORDERS, MeshContact
from solidgear.teeth.study import AtTorque, TeethStudy

CYCLE_SHOWN = (
    "Transmission error and stiffness over a mesh cycle; the error without load is that of the "
    "flanks and of shafts under all other loads."
)
PATTERN_SHOWN = "Contact pattern: the largest line load that every place of the flank carries over a mesh cycle."
FACE_SHOWN = "Load by face width, mean over a mesh cycle; aligned: with wheels held as they lie."
TORQUE_SHOWN = "Transmission error, its first orders and stiffness over the torque."


def contact_sheet(study: TeethStudy, units: Units) -> Sheet:
    """Return the sheet of the contact of all meshes."""
    meshes, several = study.meshes, len(study.meshes) > 1
    tables = [of_meshes(study, units)]
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
    notes = [line for mesh in meshes for line in sentences(mesh, study, units)]
    return Sheet(
        name="contact",
        title=f"{study.title}: contact of teeth",
        lead=f"At {study.point.label}; teeth by plane slices, shafts as Timoshenko beams.",
        tables=tables,
        data=study.as_dict(),
        charts=charts,
        lines={
            f"cycle_{number}" if several else "cycle": cycle_lines(mesh)
            for number, mesh in enumerate(meshes, start=1)
        },
        notes=notes,
        cautions=study.cautions,
        words=words,
        terminal=Terminal(
            heading=[f"{study.title} at {study.point.label}: contact of teeth"],
            tables=tables,
            closing=[*notes, *map(caution, study.cautions)],
        ),
    )


Row = tuple[str, Callable[[MeshContact], str | None]]


def of_meshes(study: TeethStudy, units: Units) -> Table:
    """Return the numbers of all meshes, one below the other."""
    rows = [[head, *map(write, study.meshes)] for head, write in _rows(units)]
    columns = [word("")]
    columns += [Column(mesh.name, kind=NUMBER) for mesh in study.meshes]
    note = (
        "Tangent: about the load, what vibrates; secant: from first touch to the load. ISO 6336-1: "
        "its single and mesh stiffness with CM = 0.8, along the line of action. Askew: how far flanks "
        "open from end to end of the face."
    )
    return Table("Contact of teeth", columns, rows, note)


def _rows(units: Units) -> list[Row]:
    """Return what is shown of every mesh, and how it is written."""

    def size(si: str, of: Callable[[MeshContact], float], digits: int = 4):
        return lambda mesh: units.number(of(mesh), si, digits)

    def spread(si: str, of: Callable[[MeshContact], np.ndarray]):
        def write(mesh: MeshContact) -> str:
            values = of(mesh)
            mean, low, high = (
                units.number(float(v), si, 4) for v in (values.mean(), values.min(), values.max())
            )
            return f"{mean} ({low} to {high})"

        return write

    stiff, moved = units.unit("N/m"), units.unit("m moved")
    rows: list[Row] = [
        (f"torque on the first wheel, {units.unit('N m')}", size("N m", lambda m: m.cycle.torque)),
        (f"force along the line of action, {units.unit('N')}", size("N", lambda m: m.cycle.force)),
        ("contact ratio, overlap", lambda m: _ratios(m)),
        (f"stiffness of teeth, tangent, {stiff}", spread("N/m", lambda m: m.cycle.tangent)),
        (f"stiffness of teeth, secant, {stiff}", spread("N/m", lambda m: m.cycle.secant)),
        (f"tangent if aligned, {stiff}", spread("N/m", lambda m: m.aligned.tangent)),
        (
            f"with supports, tangent, {stiff}",
            spread("N/m", lambda m: m.cycle.supported_tangent),
        ),
        (
            f"ISO 6336-1: single, mesh, {stiff}",
            lambda m: ", ".join(
                units.number(m.along_line(c), "N/m", 4) for c in (m.norm.single, m.norm.mesh)
            ),
        ),
        (
            f"loaded transmission error, peak to peak, {moved}",
            size("m moved", lambda m: m.cycle.peak_to_peak, 3),
        ),
        (
            f"its orders 1 to {ORDERS}, {moved}",
            lambda m: ", ".join(
                units.number(float(abs(a)), "m moved", 3) for a in m.cycle.orders(ORDERS)
            ),
        ),
        (
            f"without load, peak to peak, {moved}",
            size("m moved", lambda m: float(np.ptp(m.cycle.free_error)), 3),
        ),
        (
            f"askew by bending, wind-up, {moved}",
            lambda m: ", ".join(
                units.number(v, "m moved", 3) for v in (m.skew.bending, m.skew.turning)
            ),
        ),
        (
            "face load factor; ISO 6336-1",
            lambda m: f"{m.cycle.face_load_factor:.2f}; {m.norm_face_load_factor:.2f}",
        ),
        ("largest line load over its mean", lambda m: f"{m.cycle.line_load_factor:.2f}"),
        (f"largest pressure, {units.unit('Pa stressed')}", size("Pa stressed", lambda m: m.cycle.pressure)),
        ("lines that carry, mean", lambda m: f"{m.cycle.mean_lines:.2f}"),
    ]  # fmt: skip
    return rows


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


def cycle_lines(mesh: MeshContact) -> Table:
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


def sentences(mesh: MeshContact, study: TeethStudy, units: Units) -> list[str]:
    """Return what is to be said of a mesh."""
    several = len(study.meshes) > 1
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
    return lines
