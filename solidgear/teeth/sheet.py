"""Sheet of the contact of teeth: tables, charts and sentences."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np

from solidgear.core import WITHIN
from solidgear.core.judge.deviations import BEYOND
from solidgear.show.command import caution
from solidgear.show.plot import Make
from solidgear.show.sheet import Sheet, Terminal
from solidgear.show.table import NUMBER, Cell, Column, Table, numbers, word
from solidgear.show.units import Units, in_ascii
from solidgear.teeth.bevel.train import BevelContact
from solidgear.teeth.charts import cycle_chart, face_chart, pattern_chart, torque_chart
from solidgear.teeth.ladder import ERROR, FACE, STIFFNESS, Ladder, Rung
from solidgear.teeth.mesh_contact import MeshContact, SolvedMesh
from solidgear.teeth.study import AtTorque, TeethStudy

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
    "from end to end of the face, f_sh of the norm."
)

BAR_NOTES = {
    "slices": (
        "Error bar: by cells, depth of readings, slices and their spread along the face; plane slices "
        "know no axial motion and are some 10 % too stiff for helical teeth, more for thin wheels "
        "(--teeth solid)."
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
        word(""),
        Column("value or mean", kind=NUMBER),
        Column("error bar", kind=NUMBER),
        Column("least", kind=NUMBER),
        Column("largest", kind=NUMBER),
    ]
    rows = [
        *_stiffnesses(mesh, bars, units),
        *_errors(mesh, bars, units),
        *_along_the_face(mesh, bars, units),
    ]
    return Table(f"Contact of teeth: {mesh.name}", columns, rows, note)


Row = list[str | None]


def _alone(head: str, value: str, bar: str = "") -> Row:
    return [head, value, bar, "", ""]


def _stiffnesses(mesh: SolvedMesh, bars: Mapping[str, float], units: Units) -> list[Row]:
    """Return rows of load and stiffness."""
    cycle, unit = mesh.cycle, units.unit("N/m")

    def spread(head: str, values: np.ndarray, name: str = "") -> Row:
        mean, low, high = (
            units.number(float(v), "N/m", 4) for v in (values.mean(), values.min(), values.max())
        )
        bar = units.number(bars[name], "N/m", 2) if name in bars else ""
        return [f"{head}, {unit}", mean, bar, low, high]

    torque, force = units.unit("N m"), units.unit("N")
    rows = [
        _alone(f"torque on the first wheel, {torque}", units.number(cycle.torque, "N m", 4)),
        _alone(f"force along the line of action, {force}", units.number(cycle.force, "N", 4)),
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
        rows += [
            _alone(f"{head}, {unit}", units.number(mesh.along_line(c), "N/m", 4))
            for head, c in norm.items()
        ]
        rows.insert(2, _alone("contact ratio, overlap", _ratios(mesh)))
    elif isinstance(mesh, BevelContact):
        rows.insert(2, _alone("contact ratio", f"{mesh.pair.flanks.contact_ratio:.3f}"))
    return rows


def _errors(mesh: SolvedMesh, bars: Mapping[str, float], units: Units) -> list[Row]:
    """Return rows of the transmission error."""
    cycle, unit = mesh.cycle, units.unit("m moved")

    def size(head: str, value: float, name: str = "") -> Row:
        bar = units.number(bars[name], "m moved", 2) if name in bars else ""
        return _alone(f"{head}, {unit}", _size(value, units), bar)

    orders = np.abs(cycle.orders(SHOWN_ORDERS))
    return [
        size("transmission error, peak to peak", cycle.peak_to_peak, "peak_to_peak"),
        *(size(f"its order {n}", float(a), f"order {n}") for n, a in enumerate(orders, start=1)),
        size("the same without load", float(np.ptp(cycle.free_error))),
    ]


def _along_the_face(mesh: SolvedMesh, bars: Mapping[str, float], units: Units) -> list[Row]:
    """Return rows of how load lies on the flank."""
    cycle, unit = mesh.cycle, units.unit("m moved")
    pressure = units.number(cycle.pressure, "Pa stressed", 4)
    bar, pressed = "", ""
    if bars:
        bar = f"{bars['face_load_factor']:.2g}"
        pressed = units.number(bars["pressure"], "Pa stressed", 2)
    rows = [
        _alone("face load factor KHb", f"{cycle.face_load_factor:.2f}", bar),
        _alone("largest line load over its mean", f"{cycle.line_load_factor:.2f}"),
        _alone(f"largest pressure, {units.unit('Pa stressed')}", pressure, pressed),
        _alone("lines that carry, mean", f"{cycle.mean_lines:.2f}"),
    ]
    if isinstance(mesh, MeshContact):
        rows[:1] = [
            _alone(f"misalignment by bending, {unit}", _size(mesh.skew.bending, units)),
            _alone(f"misalignment by wind-up, {unit}", _size(mesh.skew.turning, units)),
            *rows[:1],
            _alone("face load factor by ISO 6336-1", f"{mesh.norm_face_load_factor:.2f}"),
        ]
    return rows


def _size(value: float, units: Units) -> str:
    """Write a motion, nothing below what rounding leaves."""
    return units.number(value if abs(value) > ROUNDING else 0.0, "m moved", 3)


def _ratios(mesh: MeshContact) -> str:
    return f"{mesh.wheels.contact_ratio:.3f}, {mesh.wheels.overlap_ratio:.3f}"


def over_torque(curve: Sequence[AtTorque], units: Units, name: str, shaft: str) -> Table:
    """Return numbers of a mesh over the torque of a shaft."""

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
    note = "Error pp: transmission error, peak to peak; KHb: face load factor."
    title = f"Over the torque of the {shaft}{f': {name}' if name else ''}"
    return Table(title, columns, curve, note)


def of_models(ladder: Ladder, units: Units) -> Table:
    """Return models of the teeth side by side."""

    def off(name: str, rung: Rung) -> Cell | str | None:
        share = rung.off.get(name)
        if share is None:
            return None
        if rung is ladder.reference:
            return f"+- {100 * ladder.bars[name]:.2g} %"
        look = {WITHIN: "good", BEYOND: "bad"}.get(rung.verdict[name], "")
        return Cell(f"{100 * share:+.2g} %", look)

    rows = [
        [
            rung.model,
            units.number(rung.numbers.tangent, "N/m", 4),
            off(STIFFNESS, rung),
            None
            if rung.numbers.peak_to_peak is None
            else units.number(rung.numbers.peak_to_peak, "m moved", 3),
            off(ERROR, rung),
            f"{rung.numbers.face_load_factor:.3f}",
            off(FACE, rung),
            rung.seconds,
        ]
        for rung in ladder.rungs
    ]
    columns = [
        word("teeth by"),
        Column(f"tangent, {units.unit('N/m')}"),
        Column("frequency"),
        Column(f"error pp, {units.unit('m moved')}"),
        Column("off"),
        Column("KHb"),
        Column("off"),
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
        }
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
