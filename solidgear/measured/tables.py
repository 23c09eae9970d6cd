"""Tables and the page of measured resonances beside computed ones."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core.judge.record import MacTable
from solidgear.show.mode_charts import mac_panel
from solidgear.show.panel import GREY, INK, PERCENT, Axis, Panel, Series, readout
from solidgear.show.plot import WIDE, Chart
from solidgear.show.sheet import Section
from solidgear.show.sheet_files import write_files
from solidgear.show.table import NUMBER, Column, Table, text
from solidgear.show.words import hertz, percent
from solidgear.trains.response.measured_chart import outline

#: looks of pairs by their verdict
BOTH = {"measured": Series(INK), "computed": Series("#00805e")}
LOOKS = {"agrees": Series("#00805e"), "differs": Series("#b3305c"), "no band": Series("#0072b2")}


def pairs(correlation: Any) -> Table:
    """Return every measured resonance and its mode."""
    columns = [
        Column("", lambda p: p.number, kind=NUMBER),
        Column("measured\nHz", lambda p: p.measured.frequency, hertz),
        text("mode", lambda p: p.computed and p.computed.name),
        Column("computed\nHz", lambda p: p.computed and p.computed.frequency_hz, hertz),
        Column("off", lambda p: p.relative, percent),
        Column("band", lambda p: p.band, _unsigned),
        Column("sure", lambda p: p.probability, "{:.0%}".format),
        text("", lambda p: p.verdict),
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


def entries(identification: Any) -> Table:
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


def fitted(identification: Any) -> Table:
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


def predicted(identification: Any) -> Table:
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


def _unsigned(value: float) -> str:
    return percent(value, signed=False)


def off_chart(correlation: Any, title: str, width: float = WIDE) -> Chart:
    """Chart differences of all pairs over frequency, each in its band."""
    paired = [pair for pair in correlation.pairs if pair.relative is not None]
    khz = [pair.measured.frequency / 1e3 for pair in paired]
    off = np.array([pair.relative for pair in paired])
    ends = np.array([pair.band or 0.0 for pair in paired])
    most = 1.15 * float(np.max(np.abs(off) + ends, initial=1e-6))
    panel = Panel(
        Axis("measured, kHz", (0.0, 1.05 * max(khz, default=1.0))),
        Axis("computed over measured, less one", (-most, most), label=PERCENT),
        280.0,
        series=LOOKS,
        legend={"orient": "top"},
    )
    panel.draw({"type": "rule", "color": GREY}, [{"x": 0.0, "x2": 1.05 * max(khz), "y": 0.0}])
    bands = [
        {"x": x, "y": float(y - e), "y2": float(y + e)} for x, y, e in zip(khz, off, ends) if e
    ]
    panel.draw({"type": "rule", "color": GREY, "strokeWidth": 2}, bands)
    rows = []
    for pair, x, y in zip(paired, khz, off.tolist()):
        facts = ("measured", hertz(pair.measured.frequency), "Hz"), ("off", percent(y), "")
        verdict = pair.verdict.partition(",")[0]
        rows.append(
            {"x": x, "y": y, "name": verdict, "readout": readout(pair.computed.name, *facts)}
        )
    panel.draw({"type": "point", "filled": True, "size": 50}, rows)
    return Chart([[panel]], width, title)


def mac_map(correlation: Any, width: float = WIDE) -> Chart:
    """Chart MAC of every measured shape and every mode."""
    with_shape = ~np.isnan(correlation.mac).any(axis=1)
    rows = [
        f"{hertz(p.measured.frequency)} Hz"
        for p, drawn in zip(correlation.pairs, with_shape)
        if drawn
    ]
    columns = [mode.name for mode in correlation.computed.barred]
    table = MacTable(rows=rows, columns=columns, values=correlation.mac[with_shape].tolist())
    return Chart([[mac_panel(table, "measured", "computed")]], width)


def peaks(correlation: Any, overlay: Any = None) -> Table:
    """Return resonances found in responses."""
    fit = correlation.measured.responses.fit
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
        size = Column("size", lambda k: constants.get(k + 1), "{:.2f}".format)
        columns.append(size)
        note += " Size: computed modal constant over the measured one, over all responses."
    return Table("Resonances of the responses", columns, range(len(fit.poles)), note, style="ruled")


def alone(correlation: Any) -> Table:
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


def overlay_chart(overlay: Any, correlation: Any, title: str, width: float = WIDE) -> Chart:
    """Chart a response, and the root mean square of all, measured and computed."""
    k = overlay.loudest
    amplitudes = [np.abs(overlay.measured), np.abs(overlay.computed)]
    if overlay.band is not None:
        amplitudes += [np.maximum(amplitudes[1] - overlay.band, 0.0), amplitudes[1] + overlay.band]
    parts = [(overlay.names[k], *(values[k] for values in amplitudes))]
    if len(overlay.names) > 1:
        means = [np.sqrt(np.mean(values**2, axis=0)) for values in amplitudes]
        parts.append((f"root mean square of all {len(overlay.names)}", *means))
    panels = [_responses(overlay, correlation, *part, last=part is parts[-1]) for part in parts]
    return Chart([[panel] for panel in panels], width, title)


def _responses(
    overlay: Any,
    correlation: Any,
    title: str,
    measured: np.ndarray,
    computed: np.ndarray,
    *band: np.ndarray,
    last: bool,
) -> Panel:
    khz = overlay.hertz / 1e3
    low, high = (float(end(measured[measured > 0])) for end in (np.min, np.max))
    panel = Panel(
        Axis("frequency, kHz" if last else "", (float(khz[0]), float(khz[-1]))),
        Axis(f"{overlay.kind}, {overlay.unit}", (max(low, 1e-6 * high) / 2, 3 * high), log=True),
        260.0,
        title=title,
        series=BOTH,
        legend={"orient": "top", "symbolType": "stroke"}
        if not last or title[:4] != "root"
        else None,
    )
    if band:
        outlined, floor = outline(khz, band[1] - band[0]), 1e-6 * high
        places = zip(
            khz[outlined].tolist(), *(values[outlined].clip(floor).tolist() for values in band)
        )
        ends = [{"x": x, "y": low, "y2": high} for x, low, high in places]
        panel.draw(
            {"type": "area", "opacity": 0.25, "color": BOTH["computed"].colour, "clip": True}, ends
        )
    for name, values in (("measured", measured), ("computed", computed)):
        outlined = outline(khz, values)
        rows = [
            {"x": x, "y": y, "name": name}
            for x, y in zip(khz[outlined].tolist(), values[outlined].tolist())
        ]
        panel.draw({"type": "line", "strokeWidth": 1.3, "clip": True}, rows)
    dots = []
    for pair in correlation.pairs:
        place = int(np.searchsorted(khz, pair.measured.frequency / 1e3).clip(0, len(khz) - 1))
        counterpart = pair.computed
        facts = (
            ("measured", hertz(pair.measured.frequency), "Hz"),
            ("computed", hertz(counterpart.frequency_hz) if counterpart else "", "Hz"),
        )
        words = readout(counterpart.name if counterpart else "no mode", *facts)
        dots.append({"x": float(khz[place]), "y": float(measured[place]), "readout": words})
    panel.draw({"type": "point", "filled": True, "size": 34, "color": INK}, dots)
    return panel


def write_correlation(
    folder: Path, correlation: Any, overlay: Any = None, viewer: str = ""
) -> list[Path]:
    """Write page, data, tables and charts of a correlation, with responses where there are any;
    `viewer` is HTML of shapes.
    """
    title = f"{correlation.scene}: measured and computed"
    lead = f"{correlation.title or 'Measured resonances'} beside {correlation.mesh}."
    lines = {"pairs": pairs(correlation)}
    sections = [
        Section(
            "pairs",
            "Pairs",
            charts={"off": partial(off_chart, correlation, title)} if correlation.worst else {},
            tables=[pairs(correlation), alone(correlation)],
        )
    ]
    if correlation.mac is not None:
        sections.append(Section("shapes", "Shapes", charts={"mac": partial(mac_map, correlation)}))
    if correlation.measured.responses is not None:
        lines["peaks"] = peaks(correlation, overlay)
        drawn = {"overlay": partial(overlay_chart, overlay, correlation, title)} if overlay else {}
        words = overlay.description if overlay else ""
        sections.append(Section("responses", "Responses", words, drawn, [lines["peaks"]]))
    return write_files(
        folder,
        "correlation",
        title,
        lead,
        [],
        correlation.results,
        lines=lines,
        charts={},
        verdict=correlation.sentences,
        viewer=viewer,
        sections=sections,
    )


def write_identification(folder: Path, identification: Any) -> list[Path]:
    """Write page, data and tables of an identification."""
    title = f"{identification.scene}: identified"
    lead = f"From {identification.title or 'measured resonances'}, by {identification.mesh}."
    lines = {"identified": entries(identification), "fitted": fitted(identification)}
    if identification.predicted:
        lines["predicted"] = predicted(identification)
    return write_files(
        folder,
        "identification",
        title,
        lead,
        list(lines.values()),
        identification.results,
        lines=lines,
        charts={},
        notes=identification.sentences,
    )
