"""The commands correlate and identify: measured resonances beside a scene, their tables and the page."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial import distance_matrix

from solidgear.core.judge.record import MacTable
from solidgear.core.plain import plain
from solidgear.measured.correlate import Correlation
from solidgear.measured.correlate import correlate as correlated
from solidgear.measured.data import load_measured
from solidgear.measured.identify import Identification
from solidgear.measured.identify import identify as identified
from solidgear.measured.modal_fit import ModalFit
from solidgear.measured.overlay import Overlay, overlay
from solidgear.measured.shapes import SurfacePoints
from solidgear.show.command import Progress, command
from solidgear.show.mode_charts import mac_panel
from solidgear.show.options import Run, relative
from solidgear.show.packing import Mesh
from solidgear.show.panel import GREY, INK, Panel, Series, readout
from solidgear.show.plot import WIDE, Chart
from solidgear.show.remarks import load
from solidgear.show.scales import Axis, in_percent
from solidgear.show.sheet import Section, Sheet, Terminal, present
from solidgear.show.table import NUMBER, Column, Table, text
from solidgear.show.turning import Member, Turned, together
from solidgear.show.units import ENGINEERING, Units
from solidgear.show.viewer import viewer_fragment
from solidgear.show.words import hertz, percent
from solidgear.trains.response.measured_chart import outline

SceneFile = Annotated[Path, typer.Argument(help="Scene file (TOML).")]
MeasuredFile = Annotated[
    Path,
    typer.Argument(
        help="Measured resonances: .csv with a head such as frequency [Hz], or .toml with a list mode, "
        "or .unv, .uff with mode shapes or frequency responses."
    ),
]
Tolerance = Annotated[
    float,
    relative("--tol", "Error bar allowed for computed frequencies."),
]
Out = Annotated[
    Path | None, typer.Option("--out", "-o", help="Folder for a page, data and tables.")
]
#: relative; below the scatter of careful measurements
TOLERANCE = 2e-4


@command
def correlate(
    scene: SceneFile,
    measured: MeasuredFile,
    *,
    tol: Tolerance = TOLERANCE,
    out: Out = None,
    run: Run,
) -> None:
    data = load_measured(measured)
    loaded = load(scene)

    def study(progress: Progress) -> Sheet:
        correlation = correlated(loaded, data, tol, progress)
        if out is None:
            return correlation.sheet()
        progress("responses and shapes at the measuring points")
        return overlaid_sheet(correlation, ENGINEERING, out)

    present(study, run, out)


@command
def identify(
    scene: SceneFile,
    measured: MeasuredFile,
    *,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            help='Entry to find, such as bearing.A.stiffness.kxx; with bounds, "material.E=180 GPa '
            ': 220 GPa", or a standard deviation, "material.E=206 GPa ± 3 %"; repeatable.',
        ),
    ] = None,
    predict: Annotated[
        int, typer.Option("--predict", help="Number of modes above the measured ones to predict.")
    ] = 0,
    priors: Annotated[
        bool, typer.Option("--priors", help="Use the ranges of the scene's [uncertain] as well.")
    ] = False,
    tol: Tolerance = TOLERANCE,
    out: Out = None,
    run: Run,
) -> None:
    data = load_measured(measured)
    present(
        lambda progress: identified(
            scene,
            data,
            vary or (),
            tol=tol,
            predict=predict,
            progress=progress,
            priors=priors,
        ).sheet(),
        run,
        out,
    )


def overlaid_sheet(correlation: Correlation, units: Units, folder: Path) -> Sheet:
    """Return the sheet of a correlation with responses and shapes at the measuring points."""
    bodies = turned_beside(correlation)
    viewer = viewer_fragment(bodies) if bodies else ""
    return correlation_sheet(correlation, units, overlay(correlation), viewer)


def correlation_sheet(
    correlation: Correlation,
    units: Units = ENGINEERING,
    overlay: Overlay | None = None,
    viewer: str = "",
) -> Sheet:
    """Return the sheet of a correlation, with responses where there are any; `viewer` is HTML of
    shapes.
    """
    title = f"{correlation.scene}: measured and computed"
    table, responses = pairs(correlation), correlation.measured.responses
    lines = {"pairs": table}
    off = {"off": partial(off_chart, correlation, title)} if correlation.worst else {}
    sections = [Section("pairs", "Pairs", charts=off, tables=[table, alone(correlation)])]
    if correlation.mac is not None:
        mac = partial(mac_map, correlation, correlation.mac)
        sections.append(Section("shapes", "Shapes", charts={"mac": mac}))
    tables = [table]
    if responses is not None:
        tables.insert(0, peaks(responses.fit))
        lines["peaks"] = peaks(responses.fit, overlay)
        both = {"overlay": partial(overlay_chart, overlay, correlation, title)} if overlay else {}
        about = overlay.description if overlay else ""
        sections.append(Section("responses", "Responses", about, both, [lines["peaks"]]))
    return Sheet(
        name="correlation",
        title=title,
        lead=f"{correlation.title or 'Measured resonances'} beside {correlation.mesh}.",
        tables=[],
        data=correlation.results,
        lines=lines,
        verdict=correlation.sentences,
        cautions=correlation.cautions,
        sections=sections,
        viewer=viewer,
        terminal=Terminal([f"{correlation.scene}: {correlation.mesh}"], tables),
        words={
            "off": "Difference of each computed frequency from the measured one; grey: two standard "
            "deviations of the measured and the error bar of the computed one.",
            "mac": "MAC, the likeness of every measured shape (rows) and every computed mode at the "
            "measuring points.",
            "overlay": "Measured (dark) and computed (green, with its band) responses at the same "
            "points; dots: resonances found.",
        },
    )


def identification_sheet(identification: Identification, units: Units = ENGINEERING) -> Sheet:
    """Return the sheet of an identification."""
    lines = {
        "identified": entries(identification),
        "fitted": fitted(identification),
        "predicted": predicted(identification),
    }
    lines = {name: table for name, table in lines.items() if table}
    return Sheet(
        name="identification",
        title=f"{identification.scene}: identified",
        lead=f"From {identification.title or 'measured resonances'}, by {identification.mesh}.",
        tables=list(lines.values()),
        data=plain(identification),
        lines=lines,
        notes=identification.sentences,
        cautions=identification.cautions,
        terminal=Terminal([f"{identification.scene}: {identification.mesh}"]),
    )


#: looks of both responses, and of pairs by their verdict
BOTH = {"measured": Series(INK), "computed": Series("#00805e")}
LOOKS = {"agrees": Series("#00805e"), "differs": Series("#b3305c"), "no band": Series("#0072b2")}
_unsigned = partial(percent, signed=False)


def pairs(correlation: Correlation) -> Table:
    """Return every measured resonance and its mode."""
    columns = [
        Column("", lambda p: p.number, kind=NUMBER, name="number"),
        Column("measured\nHz", lambda p: p.measured.frequency, hertz),
        text("mode", lambda p: p.computed and p.computed.name),
        Column("computed\nHz", lambda p: p.computed and p.computed.frequency_hz, hertz),
        Column("off", lambda p: p.relative, percent),
        Column("band", lambda p: p.band, _unsigned),
        Column("sure", lambda p: p.probability, "{:.0%}".format),
        replace(text("", lambda p: p.verdict), name="verdict"),
    ]
    if correlation.mac is not None:
        columns.insert(-1, Column("MAC", lambda p: p.mac, "{:.2f}".format))
    note = (
        "Off: computed over measured, less one. Band: two standard deviations of the measured "
        "frequency and the error bar of the computed one. Sure: probability of the pair."
    )
    if correlation.measured.responses is not None:
        note += (
            f" A measured frequency deviates by {100 * correlation.measured.responses.repeats:.2g} % at "
            "least, by temperature, cords and sensor."
        )
    if correlation.mac is not None:
        note += " MAC: likeness of the measured and the computed shape at the measuring points."
    return Table("Measured and computed", columns, correlation.pairs, note, style="ruled")


def entries(identification: Identification) -> Table:
    """Return the identified entries."""
    columns = [
        text("entry", lambda e: e.path),
        Column("in the file", lambda e: e.before, "{:.6g}".format),
        Column("identified, SI", lambda e: e.value, "{:.6g}".format),
        Column("deviation", lambda e: e.deviation, _unsigned),
        Column("95 %\nfrom", lambda e: e.low, "{:.6g}".format),
        Column("to", lambda e: e.high, "{:.6g}".format),
    ]
    note = (
        "Deviation: one standard deviation, from the scatter of the data and the error bars of "
        "the model."
    )
    return Table("Identified", columns, identification.entries, note, style="ruled")


def fitted(identification: Identification) -> Table:
    """Return the fitted resonances."""
    columns = [
        text("mode", lambda f: f.name),
        Column("measured\nHz", lambda f: f.measured, hertz),
        Column("computed\nHz", lambda f: f.computed, hertz),
        Column("off", lambda f: f.computed / f.measured - 1, percent),
        Column("left out", lambda f: f.left_out and f.left_out / f.measured - 1, percent),
    ]
    note = "Left out: the same when this resonance is predicted from all others."
    return Table("Fitted", columns, identification.fitted, note, style="ruled")


def predicted(identification: Identification) -> Table:
    """Return modes beyond the measured ones."""
    columns = [
        text("mode", lambda p: p.name),
        Column("shapes", lambda p: p.multiplicity),
        Column("predicted\nHz", lambda p: p.frequency_hz, hertz),
        Column("deviation\nHz", lambda p: p.deviation_hz, "{:.2g}".format),
    ]
    note = (
        "Deviation: one standard deviation, from the entries, the scatter of the fit and the mesh."
    )
    return Table("Predicted, not measured", columns, identification.predicted, note, style="ruled")


def off_chart(correlation: Correlation, title: str, width: float = WIDE) -> Chart:
    """Chart differences of all pairs over frequency, each in its band."""
    bands, points = [], []
    for pair in correlation.pairs:
        if pair.computed is None or pair.relative is None:
            continue
        khz, off, band = pair.measured.frequency / 1e3, pair.relative, pair.band or 0.0
        bands.append({"x": khz, "y": off - band, "y2": off + band})
        facts = ("measured", hertz(pair.measured.frequency), "Hz"), ("off", percent(off), "")
        words = readout(pair.computed.name, *facts)
        points.append(
            {"x": khz, "y": off, "name": pair.verdict.partition(",")[0], "readout": words}
        )
    end = 1.05 * max(band["x"] for band in bands)
    most = 1.15 * max(1e-6, *(max(-band["y"], band["y2"]) for band in bands))
    panel = Panel(
        Axis("measured, kHz", (0.0, end)),
        Axis("computed over measured, less one", (-most, most), label=in_percent),
        280.0,
        series=LOOKS,
        legend={"orient": "top"},
    )
    panel.draw({"type": "rule", "color": GREY}, [{"x": 0.0, "x2": end, "y": 0.0}])
    bands = [band for band in bands if band["y"] < band["y2"]]
    panel.draw({"type": "rule", "color": GREY, "strokeWidth": 2}, bands)
    panel.draw({"type": "point", "filled": True, "size": 50}, points)
    return Chart([[panel]], width, title)


def mac_map(correlation: Correlation, mac: np.ndarray, width: float = WIDE) -> Chart:
    """Chart MAC (n, m) of every measured shape and every mode."""
    with_shape = ~np.isnan(mac).any(axis=1)
    table = MacTable(
        rows=[
            f"{hertz(pair.measured.frequency)} Hz"
            for pair, drawn in zip(correlation.pairs, with_shape)
            if drawn
        ],
        columns=[mode.name for mode in correlation.computed.barred],
        values=mac[with_shape].tolist(),
    )
    return Chart([[mac_panel(table, "measured", "computed")]], width)


def peaks(fit: ModalFit, overlay: Overlay | None = None) -> Table:
    """Return resonances found in responses."""
    columns = [
        Column("", lambda k: k + 1, kind=NUMBER),
        Column("frequency\nHz", lambda k: fit.frequencies[k], hertz),
        Column("deviation\nHz", lambda k: fit.deviations[0][k], "{:.2g}".format),
        Column("damping", lambda k: fit.damping[k], _unsigned),
        Column("deviation", lambda k: 100 * fit.deviations[1][k], "{:.2g} %".format),
    ]
    note = (
        "Deviation: one standard deviation, from the noise of these responses alone. Damping: the "
        "ratio."
    )
    if overlay is not None:
        constants = overlay.constants
        columns.append(Column("size", lambda k: constants.get(k + 1), "{:.2f}".format))
        note += " Size: computed modal constant over the measured one, over all responses."
    return Table("Resonances of the responses", columns, range(len(fit.poles)), note, style="ruled")


def alone(correlation: Correlation) -> Table:
    """Return resonances measured and not computed, and the reverse."""
    rows = [("measured", "", p.measured.frequency, p.probability) for p in correlation.pairs]
    rows = [row for row, pair in zip(rows, correlation.pairs) if pair.computed is None]
    rows += [
        ("computed", mode.name, mode.frequency_hz, share) for mode, share in correlation.missed
    ]
    columns = [
        text("only", lambda row: row[0]),
        text("mode", lambda row: row[1]),
        Column("Hz", lambda row: row[2], hertz),
        Column("sure", lambda row: row[3], "{:.0%}".format),
    ]
    note = "Sure: probability that it has no partner."
    return Table("Without a partner", columns, rows, note, style="ruled")


def overlay_chart(
    overlay: Overlay, correlation: Correlation, title: str, width: float = WIDE
) -> Chart:
    """Chart a response, and the root mean square of all, measured and computed."""
    amplitudes = [np.abs(overlay.measured), np.abs(overlay.computed)]
    if overlay.band is not None:
        amplitudes += [np.maximum(amplitudes[1] - overlay.band, 0.0), amplitudes[1] + overlay.band]
    k, count = overlay.loudest, len(overlay.names)
    parts = {overlay.names[k]: [values[k] for values in amplitudes]}
    if count > 1:
        means = [np.sqrt(np.mean(values**2, axis=0)) for values in amplitudes]
        parts[f"root mean square of all {count}"] = means
    panels = [
        [_responses(overlay, correlation, name, part, k == 0, k == len(parts) - 1)]
        for k, (name, part) in enumerate(parts.items())
    ]
    return Chart(panels, width, title)


def _responses(
    overlay: Overlay,
    correlation: Correlation,
    title: str,
    amplitudes: list[np.ndarray],
    first: bool,
    last: bool,
) -> Panel:
    """Return a panel of amplitudes: measured, computed, and the ends of the band where there is one."""
    khz, measured = overlay.hertz / 1e3, amplitudes[0]
    low, high = float(measured[measured > 0].min()), float(measured.max())
    panel = Panel(
        Axis("frequency, kHz" if last else "", (float(khz[0]), float(khz[-1]))),
        Axis(f"{overlay.kind}, {overlay.unit}", (max(low, 1e-6 * high) / 2, 3 * high), log=True),
        260.0,
        title=title,
        series=BOTH,
        legend={"orient": "top", "symbolType": "stroke"} if first else None,
    )
    if len(amplitudes) > 2:
        outlined = outline(khz, amplitudes[3] - amplitudes[2])
        ends = [part[outlined].clip(1e-6 * high).tolist() for part in amplitudes[2:]]
        band = {"type": "area", "opacity": 0.25, "color": BOTH["computed"].colour, "clip": True}
        rows = zip(khz[outlined].tolist(), *ends)
        panel.draw(band, [{"x": x, "y": bottom, "y2": top} for x, bottom, top in rows])
    for name, values in zip(BOTH, amplitudes):
        outlined = outline(khz, values)
        points = zip(khz[outlined].tolist(), values[outlined].tolist())
        line = {"type": "line", "strokeWidth": 1.3, "clip": True}
        panel.draw(line, [{"x": x, "y": y, "name": name} for x, y in points])
    dots = []
    for pair in correlation.pairs:
        place = int(np.searchsorted(khz, pair.measured.frequency / 1e3).clip(0, len(khz) - 1))
        mode = pair.computed
        facts = (
            ("measured", hertz(pair.measured.frequency), "Hz"),
            ("computed", hertz(mode.frequency_hz) if mode else "", "Hz"),
        )
        words = readout(mode.name if mode else "no mode", *facts)
        dots.append({"x": float(khz[place]), "y": float(measured[place]), "readout": words})
    panel.draw({"type": "point", "filled": True, "size": 34, "color": INK}, dots)
    return panel


#: modes that a page has room for
MOST = 16
#: size of a point, as a share of the longest side of all
SIZE = 0.015
#: corners of an octahedron and its middle, and its faces
CORNERS = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1], [0, 0, 0]])
FACES = np.array(
    [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
)
#: thickness of a rod over that of a point; places around it, and its sides
ROD, RING = 0.45, np.exp(2j * np.pi * np.arange(3) / 3)
SIDES = np.array([[0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4], [2, 0, 5], [0, 3, 5]])


def turned_beside(correlation: Correlation) -> tuple[Turned, ...]:
    """Return measured points and the computed surface in all modes that have a partner, in one
    scale and of one sign; of a pair of shapes the combination that was measured. Empty without
    measured shapes.
    """
    measured, computed = correlation.measured.on_points, correlation.computed
    if measured is None:
        return ()
    # of two resonances that are one mode the first; not every resonance has a shape
    numbers = {
        pair.computed.name: pair.number - 1
        for pair in correlation.pairs[::-1]
        if pair.computed is not None and measured.values[pair.number - 1].any()
    }
    modes = [mode for mode in computed.modes if str(mode.name) in numbers][:MOST]
    if not modes:
        return ()
    places = SurfacePoints(computed.body, measured.numbers.tolist(), measured.points)
    measured_points = np.any(measured.values != 0, axis=0)
    shapes_measured = [measured.values[numbers[str(mode.name)]] for mode in modes]
    # in the phase in which each is largest
    phases = [np.exp(-0.5j * np.angle(np.sum(shape**2))) for shape in shapes_measured]
    moved = [np.real(shape * phase) for shape, phase in zip(shapes_measured, phases)]
    vectors = []
    for mode, shape in zip(modes, moved):
        span = np.column_stack([places.motion(vector)[measured_points] for vector in mode.vectors])
        parts = np.linalg.lstsq(span, shape[measured_points], rcond=1e-6)[0]
        blocks = mode.vectors[0].keys() | mode.vectors[-1].keys()
        vectors.append(
            {k: sum(c * v[k] for c, v in zip(parts, mode.vectors) if k in v) for k in blocks}
        )
    names = [(str(mode.name), mode.frequency_hz) for mode in modes]
    member = Member(computed.body, np.eye(3), np.zeros(3), [[v] for v in vectors])
    turned = together(computed.mesh, names, [member])
    mesh, shapes = _mesh(measured.points), []
    for turned_shape, vector, shape in zip(turned.shapes, vectors, moved):
        raw = computed.body.surface(vector).displacement[turned.mesh.source]
        factor = np.vdot(raw, turned_shape.displacement) / np.vdot(raw, raw)
        displacement = factor * shape[mesh.source]
        hertz = correlation.measured.modes[numbers[turned_shape.name]].frequency
        shapes.append(replace(turned_shape, frequency_hz=hertz, displacement=displacement))
    return Turned("measured", mesh, tuple(shapes)), turned


def _mesh(points: np.ndarray) -> Mesh:
    """Return points as octahedra, joined by rods along the shortest tree."""
    size = SIZE * float(np.ptp(points, axis=0).max())
    tree = minimum_spanning_tree(distance_matrix(points, points)).tocoo()
    first = len(CORNERS) * np.arange(len(points))
    corners, faces = [points[:, None] + size * CORNERS], [first[:, None, None] + FACES]
    source = [np.repeat(np.arange(len(points)), len(CORNERS))]
    for k, (a, b) in enumerate(zip(tree.row, tree.col)):
        along = points[b] - points[a]
        across = np.cross(along, np.eye(3)[np.abs(along).argmin()])
        sides = np.array([across, np.cross(along, across) / np.linalg.norm(along)])
        ring = ROD * size / np.linalg.norm(across) * np.column_stack([RING.real, RING.imag]) @ sides
        corners.append(np.array([points[a] + ring, points[b] + ring]))
        faces.append(len(CORNERS) * len(points) + 2 * len(RING) * k + SIDES)
        source.append(np.repeat([a, b], len(RING)))
    lines = np.column_stack([first[tree.row], first[tree.col]]) + len(CORNERS) - 1
    return Mesh(
        np.concatenate([part.reshape(-1, 3) for part in corners]),
        np.concatenate([part.reshape(-1, 3) for part in faces]),
        lines,
        np.concatenate(source),
    )
