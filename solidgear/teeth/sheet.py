"""Sheet of the contact of teeth: tables, charts and sentences."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from solidgear.core import WITHIN
from solidgear.core.judge.deviations import BEYOND
from solidgear.show.command import caution
from solidgear.show.plot import Make
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.table import NUMBER, Cell, Column, Table, in_units, numbers, quantity, word
from solidgear.show.units import SI, Units, in_ascii, plain_unit
from solidgear.teeth.bevel.train import BevelContact
from solidgear.teeth.charts import cycle_chart, face_chart, pattern_chart, torque_chart
from solidgear.teeth.ladder import ERROR, FACE, STIFFNESS, Ladder, Rung
from solidgear.teeth.mesh_contact import MeshContact, SolvedMesh
from solidgear.teeth.study import AtTorque, TeethStudy

#: an empty cell
NOTHING = Cell(None, "", "")
#: motion that rounding leaves, m
ROUNDING = 1e-13
#: orders of the error in the table
SHOWN_ORDERS = 3
CYCLE_SHOWN = (
    "Transmission error and stiffness of the teeth over two mesh cycles. Without load: by the shapes "
    "of the flanks, on shafts that all other loads bend. Aligned: shafts held as they lie."
)
PATTERN_SHOWN = (
    "Contact pattern on the first wheel's flank: the largest line load of each place over a mesh "
    "cycle."
)
CORNERS_SHOWN = " Beyond the dashed lines corners of tips touch."
FACE_SHOWN = (
    "Load per face width, mean over a mesh cycle. Aligned: with both shafts held as they lie."
)
TORQUE_SHOWN = "Transmission error, its first orders and stiffness of the teeth over the torque."
#: what teeth are made of, by the name of the model
TEETH_BY = {"slices": "plane slices", "solid": "3D finite elements"}


def contact_sheet(study: TeethStudy, units: Units) -> Sheet:
    """Return the sheet of the contact of all meshes."""
    meshes, several = study.meshes, len(study.meshes) > 1
    tables = [
        of_mesh(
            mesh,
            study.bars.get(mesh.name, {}),
            units,
            legend(study) if mesh is meshes[-1] else "",
        )
        for mesh in meshes
    ]
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
        if mesh.path_ends:
            words["pattern" + end] += CORNERS_SHOWN
        if curve := study.curves.get(mesh.name):
            tables.append(over_torque(curve, units, name, study.point.of))
            charts["torque" + end] = partial(torque_chart, curve, units, name)
            words["torque" + end] = TORQUE_SHOWN
    tables += [of_models(ladder, units) for ladder in study.ladders]
    tables += [assumptions(mesh) for mesh in meshes]
    modelled = f"Teeth by {_teeth_by(study)}, shafts as Timoshenko beams."
    notes = [line for mesh in meshes for line in sentences(mesh, study, units)]
    return Sheet(
        name="contact",
        title=f"{study.title}: contact of teeth",
        lead=f"At {study.point.label}. {modelled}",
        tables=tables,
        data=study.as_dict(),
        charts=charts,
        lines={
            f"cycle_{number}" if several else "cycle": cycle_lines(mesh)
            for number, mesh in enumerate(meshes, start=1)
        },
        verdict=[line for ladder in study.ladders for line in ladder.sentences()],
        notes=notes,
        cautions=study.cautions,
        words=words,
        terminal=Terminal(
            heading=[f"{study.title} at {study.point.label}: contact of teeth", modelled],
            tables=tables,
            closing=[*map(in_ascii, notes), *map(caution, study.cautions)],
        ),
    )


NOTE = (
    "Tangent: slope at this load, for vibration; secant: from first touch to the load; aligned: with "
    "shafts held as they lie. Order n: amplitude at n times the tooth frequency."
)
NORM_NOTE = (
    "ISO 6336-1: method B with CM = 0.8, along the line of action. Misalignment: how far flanks open "
    "from end to end of the face under an even load, f_sh of the norm with bending within the face."
)

BAR_NOTES = {
    "slices": (
        "Error bar: by cells, depth of readings, slices, their spread along the face, what stands beside "
        "it, and how far slices were off teeth in 3D: 4 % too stiff for straight teeth, up to 13 % at 30 "
        "degrees of helix."
    ),
    "solid": "Error bar: by cells, depth of readings and slices.",
}


def legend(study: TeethStudy) -> str:
    """Return what the words of the tables mean."""
    if not study.bars:
        return NOTE
    return f"{NOTE} {NORM_NOTE} {BAR_NOTES[study.model.name]}"


def _teeth_by(study: TeethStudy) -> str:
    """Return what the teeth are modelled by, in words; bevel teeth are always of slices."""
    kinds = {
        "slices" if isinstance(mesh, BevelContact) else study.model.name for mesh in study.meshes
    }
    if len(kinds) > 1:
        return f"{TEETH_BY[study.model.name]}, of bevel gears by {TEETH_BY['slices']}"
    return TEETH_BY[kinds.pop()]


def of_mesh(mesh: SolvedMesh, bars: Mapping[str, float], units: Units, note: str) -> Table:
    """Return the numbers of a mesh with their error bars, and their range over the cycle."""
    columns = [
        Column("", kind="word", name="quantity"),
        Column("value or mean", kind=NUMBER),
        Column("error bar", kind=NUMBER),
        Column("least", kind=NUMBER),
        Column("largest", kind=NUMBER),
        Column("unit", hidden=True),
    ]
    rows = [
        *_stiffnesses(mesh, bars, units),
        *_errors(mesh, bars, units),
        *_along_the_face(mesh, bars, units),
    ]
    return Table(f"Contact of teeth: {mesh.name}", columns, rows, note)


Row = list[Cell]


def _row(head: str, si: str, units: Units, value: Cell, *others: Cell) -> Row:
    """Return a row in an SI unit: the mean, and what is known of error bar, least and largest."""
    unit = units.unit(si)
    name = Cell(head, "", f"{head}, {unit}" if unit else head)
    more = [*others, *(Cell(None, "", "") for _ in range(3 - len(others)))]
    return [name, value, *more, Cell(plain_unit(si))]


def _plain(head: str, value: float, write: str, bar: Cell = NOTHING) -> Row:
    """Return a row of a number without a unit."""
    return _row(head, "", SI, Cell(value, "", format(value, write)), bar)


def _stiffnesses(mesh: SolvedMesh, bars: Mapping[str, float], units: Units) -> list[Row]:
    """Return rows of load and stiffness."""
    cycle = mesh.cycle

    def spread(head: str, values: np.ndarray, name: str = "") -> Row:
        mean, low, high = (
            in_units(float(v), "N/m", units, 4) for v in (values.mean(), values.min(), values.max())
        )
        bar = in_units(bars[name], "N/m", units, 2) if name in bars else NOTHING
        return _row(head, "N/m", units, mean, bar, low, high)

    def alone(head: str, value: float, si: str) -> Row:
        return _row(head, si, units, in_units(value, si, units, 4))

    rows = [
        alone("torque on the first wheel", cycle.torque, "N m"),
        alone("force along the line of action", cycle.force, "N"),
        spread("stiffness, tangent", cycle.tangent, "tangent"),
        spread("stiffness, secant", cycle.secant, "secant"),
        spread("stiffness, tangent, aligned", mesh.aligned.tangent),
        spread("stiffness with supports, tangent", cycle.supported_tangent),
    ]
    if isinstance(mesh, MeshContact):
        norm = {
            "stiffness by ISO 6336-1, one pair": mesh.norm.single,
            "stiffness by ISO 6336-1, mesh": mesh.norm.mesh,
        }
        rows += [alone(head, mesh.along_line(c), "N/m") for head, c in norm.items()]
        ratios = Cell(mesh.wheels.contact_ratio, "", _ratios(mesh))
        rows.insert(2, _row("contact ratio, overlap", "", units, ratios))
    elif isinstance(mesh, BevelContact):
        rows.insert(2, _plain("contact ratio", mesh.pair.flanks.contact_ratio, ".3f"))
    return rows


def _errors(mesh: SolvedMesh, bars: Mapping[str, float], units: Units) -> list[Row]:
    """Return rows of the transmission error."""
    cycle = mesh.cycle

    def size(head: str, value: float, name: str = "") -> Row:
        bar = in_units(bars[name], "m moved", units, 2) if name in bars else NOTHING
        return _row(head, "m moved", units, _size(value, units), bar)

    orders = np.abs(cycle.orders(SHOWN_ORDERS))
    return [
        size("transmission error, peak to peak", cycle.peak_to_peak, "peak_to_peak"),
        *(size(f"its order {n}", float(a), f"order {n}") for n, a in enumerate(orders, start=1)),
        size("the same without load", float(np.ptp(cycle.free_error))),
    ]


def _along_the_face(mesh: SolvedMesh, bars: Mapping[str, float], units: Units) -> list[Row]:
    """Return rows of how load lies on the flank."""
    cycle, bar, pressed = mesh.cycle, NOTHING, NOTHING
    pressure = in_units(cycle.pressure, "Pa stressed", units, 4)
    if bars:
        factor = bars["face_load_factor"]
        bar = Cell(factor, "", f"{factor:.2g}")
        pressed = in_units(bars["pressure"], "Pa stressed", units, 2)
    rows = [
        _plain("face load factor KHb", cycle.face_load_factor, ".2f", bar),
        _plain("largest line load over its mean", cycle.line_load_factor, ".2f"),
        _row("largest pressure", "Pa stressed", units, pressure, pressed),
        _plain("lines that carry, mean", cycle.mean_lines, ".2f"),
    ]
    if isinstance(mesh, MeshContact):
        skews = {"bending": mesh.skew.bending, "wind-up": mesh.skew.turning}
        rows[:1] = [
            *(
                _row(f"misalignment by {cause}", "m moved", units, _size(skew, units))
                for cause, skew in skews.items()
            ),
            *rows[:1],
        ]
    return rows


def _size(value: float, units: Units) -> Cell:
    """Return a motion, nothing below what rounding leaves."""
    return in_units(float(value) if abs(value) > ROUNDING else 0.0, "m moved", units, 3)


def _ratios(mesh: MeshContact) -> str:
    return f"{mesh.wheels.contact_ratio:.3f}, {mesh.wheels.overlap_ratio:.3f}"


def over_torque(curve: Sequence[AtTorque], units: Units, name: str, shaft: str) -> Table:
    """Return numbers of a mesh over the torque of a shaft."""

    def size(head: str, si: str, of: Callable[[AtTorque], float], digits: int = 4) -> Column:
        column = quantity(head, si, units, lambda at: float(of(at)), digits)
        return replace(column, kind=NUMBER, axis=head == "torque")

    columns = [
        size("torque", "N m", lambda at: at.torque),
        size("error pp", "m moved", lambda at: at.contact.cycle.peak_to_peak, 3),
        size("order 1", "m moved", lambda at: float(abs(at.contact.cycle.orders(1)[0])), 3),
        size("order 2", "m moved", lambda at: float(abs(at.contact.cycle.orders(2)[1])), 3),
        size("tangent", "N/m", lambda at: float(at.contact.cycle.tangent.mean())),
        Column("KHb", lambda at: at.contact.cycle.face_load_factor, "{:.2f}".format, kind=NUMBER),
        size("pressure", "Pa stressed", lambda at: at.contact.cycle.pressure),
    ]
    note = "Error pp: transmission error, peak to peak; KHb: face load factor."
    title = f"Over the torque of the {shaft}{f': {name}' if name else ''}"
    return Table(title, columns, curve, note)


def of_models(ladder: Ladder, units: Units) -> Table:
    """Return models of the teeth side by side."""

    def off(name: str, rung: Rung) -> Cell | None:
        share = rung.off.get(name)
        if share is None:
            return None
        if rung is ladder.reference:
            return Cell(0.0, "", f"+- {100 * ladder.bars[name]:.2g} %")
        look = {WITHIN: "good", BEYOND: "bad"}.get(rung.verdict[name], "")
        return Cell(share, look, f"{100 * share:+.2g} %")

    rows = [
        [
            rung.model,
            rung.numbers.tangent,
            off(STIFFNESS, rung),
            rung.numbers.peak_to_peak,
            off(ERROR, rung),
            rung.numbers.face_load_factor,
            off(FACE, rung),
            rung.seconds,
        ]
        for rung in ladder.rungs
    ]
    columns = [
        word("teeth by"),
        quantity("tangent", "N/m", units, digits=4),
        Column("frequency", name="frequency off"),
        quantity("error pp", "m moved", units, digits=3),
        Column("off", name="error pp off"),
        Column("KHb", write="{:.3f}".format),
        Column("off", name="KHb off"),
        Column("s", write=lambda seconds: f"{seconds:.1f}"),
    ]
    note = (
        "Off: against the last, whose own error bars stand there; frequency: what the stiffness does to "
        f"the mode with most strain energy in these teeth, {100 * ladder.share:.0f} %."
    )
    return Table(f"Models of the teeth: {ladder.mesh}", columns, rows, note)


def assumptions(mesh: SolvedMesh) -> Table:
    """Return what the file leaves open of a mesh."""
    rows = [[text] for text in mesh.assumed]
    return Table(f"Assumed: {mesh.name}", [word("what the file does not say")], rows)


def cycle_lines(mesh: SolvedMesh) -> Table:
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
        },
        axes=1,
    )


def sentences(mesh: SolvedMesh, study: TeethStudy, units: Units) -> list[str]:
    """Return what is to be said of a mesh."""
    several = len(study.meshes) > 1
    head = f"{mesh.name}: " if several else ""
    lines = []
    tangent, stated = float(mesh.cycle.tangent.mean()), study.stiffness[mesh.name]
    if stated is not None:
        lines.append(
            f"{head}the file has a mesh stiffness of {units.text(stated, 'N/m', 4)}, the teeth give "
            f'{units.text(tangent, "N/m", 4)} at this load. To take it, write stiffness = "teeth".'
        )
    if isinstance(mesh, BevelContact) and mesh.band is not None:
        low, high = mesh.band.stiffness
        lines.append(
            f"{head}cutter and mismatch are estimated. Over usual ones the mesh stiffness is "
            f"{units.number(low, 'N/m', 3)} to {units.text(high, 'N/m', 3)}, a factor of "
            f"{high / low:.1f}."
        )
        lines += [f"{head}{reason}" for reason in mesh.band.refused]
    if mesh.edge:
        lines.append(f"{head}{mesh.edge}.")
    lines += [f"{head}{note}." for note in mesh.notes]
    return lines if several else [line[0].upper() + line[1:] for line in lines]
