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


def pairs(found: Any) -> Table:
    """Every measured resonance and the mode it is."""
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
    if found.mac is not None:
        columns.insert(-1, Column("MAC", lambda p: p.mac, "{:.2f}".format))
    note = (
        "Off: computed over measured, less one. Band: two standard deviations of the measured "
        "frequency and the bar of the computed one. Sure: probability of the pair."
    )
    if found.measured.responses is not None:
        note += (
            f" A measured frequency deviates by {100 * found.measured.responses.repeats:.2g} % at least: so well do temperature, "
            "cords and sensor repeat."
        )
    if found.mac is not None:
        note += " MAC: share of the measured shape that is the mode's, on the measuring points."
    return Table("Measured and computed", columns, found.pairs, note, style="ruled")


def entries(found: Any) -> Table:
    """Entries that were identified."""
    columns = [
        text("entry", lambda e: e.path),
        Column("in the file", lambda e: e.before, "{:.6g}".format),
        Column("identified, SI", lambda e: e.value, "{:.6g}".format),
        Column("deviation", lambda e: e.deviation, _unsigned),
        Column("95 %\nfrom", lambda e: e.low, "{:.6g}".format),
        Column("to", lambda e: e.high, "{:.6g}".format),
    ]
    note = (
        "Deviation: one standard deviation, of the scatter of the data and the bars of the model."
    )
    return Table("Identified", columns, found.entries, note, style="ruled")


def fitted(found: Any) -> Table:
    """Resonances that were fitted."""
    columns = [
        text("mode", lambda f: f.name),
        Column("measured\nHz", lambda f: f.measured, hertz),
        Column("computed\nHz", lambda f: f.computed, hertz),
        Column("off", lambda f: f.computed / f.measured - 1, percent),
        Column("left out", lambda f: f.left_out and f.left_out / f.measured - 1, percent),
    ]
    note = "Left out: the same where this resonance is predicted from all others."
    return Table("Fitted", columns, found.fitted, note, style="ruled")


def predicted(found: Any) -> Table:
    """Modes beyond the measured ones."""
    columns = [
        text("mode", lambda p: p.name),
        Column("shapes", lambda p: p.multiplicity),
        Column("predicted\nHz", lambda p: p.frequency_hz, hertz),
        Column("deviation\nHz", lambda p: p.deviation_hz, "{:.2g}".format),
    ]
    note = "Deviation: one standard deviation, of the entries, the scatter of the fit and the mesh."
    return Table("Predicted, not measured", columns, found.predicted, note, style="ruled")


def _unsigned(value: float) -> str:
    return percent(value, signed=False)


def off_chart(found: Any, title: str, width: float = WIDE) -> Chart:
    """Differences of all pairs over frequency, each in its band."""
    told = [pair for pair in found.pairs if pair.relative is not None]
    khz = [pair.measured.frequency / 1e3 for pair in told]
    off = np.array([pair.relative for pair in told])
    ends = np.array([pair.band or 0.0 for pair in told])
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
    for pair, x, y in zip(told, khz, off.tolist()):
        facts = ("measured", hertz(pair.measured.frequency), "Hz"), ("off", percent(y), "")
        verdict = pair.verdict.partition(",")[0]
        rows.append(
            {"x": x, "y": y, "name": verdict, "readout": readout(pair.computed.name, *facts)}
        )
    panel.draw({"type": "point", "filled": True, "size": 50}, rows)
    return Chart([[panel]], width, title)


def mac_map(found: Any, width: float = WIDE) -> Chart:
    """MAC of every measured shape and every mode."""
    told = ~np.isnan(found.mac).any(axis=1)
    rows = [f"{hertz(p.measured.frequency)} Hz" for p, shown in zip(found.pairs, told) if shown]
    columns = [mode.name for mode in found.computed.barred]
    table = MacTable(rows=rows, columns=columns, values=found.mac[told].tolist())
    return Chart([[mac_panel(table, "measured", "computed")]], width)


def peaks(found: Any, overlay: Any = None) -> Table:
    """Resonances that were found in responses."""
    fit = found.measured.responses.fit
    columns = [
        Column("", lambda k: k + 1, kind=NUMBER),
        Column("frequency\nHz", lambda k: fit.frequencies[k], hertz),
        Column("deviation\nHz", lambda k: fit.deviations[0][k], "{:.2g}".format),
        Column("damping", lambda k: fit.damping[k], _unsigned),
        Column("deviation", lambda k: 100 * fit.deviations[1][k], "{:.2g} %".format),
    ]
    note = "Deviation: one standard deviation, of the noise of these responses alone. Damping: the ratio."
    if overlay is not None:
        constants = overlay.constants
        size = Column("size", lambda k: constants.get(k + 1), "{:.2f}".format)
        columns.append(size)
        note += " Size: computed modal constant over the measured one, of all responses."
    return Table("Resonances of the responses", columns, range(len(fit.poles)), note, style="ruled")


def alone(found: Any) -> Table:
    """Resonances measured and not computed, and the reverse."""
    rows = [("measured", "", p.measured.frequency, p.probability) for p in found.pairs]
    rows = [row for row, pair in zip(rows, found.pairs) if pair.computed is None]
    rows += [("computed", mode.name, mode.frequency_hz, share) for mode, share in found.missed]
    columns = [
        text("only", lambda row: row[0]),
        text("mode", lambda row: row[1]),
        Column("Hz", lambda row: row[2], hertz),
        Column("sure", lambda row: row[3], "{:.0%}".format),
    ]
    note = "Sure: probability that it has no partner."
    return Table("Without a partner", columns, rows, note, style="ruled")


def overlay_chart(overlay: Any, found: Any, title: str, width: float = WIDE) -> Chart:
    """A response, and the root mean square of all, measured and computed."""
    k = overlay.loudest
    every = [np.abs(overlay.measured), np.abs(overlay.computed)]
    if overlay.band is not None:
        every += [np.maximum(every[1] - overlay.band, 0.0), every[1] + overlay.band]
    parts = [(overlay.names[k], *(values[k] for values in every))]
    if len(overlay.names) > 1:
        both = [np.sqrt(np.mean(values**2, axis=0)) for values in every]
        parts.append((f"root mean square of all {len(overlay.names)}", *both))
    panels = [_responses(overlay, found, *part, last=part is parts[-1]) for part in parts]
    return Chart([[panel] for panel in panels], width, title)


def _responses(
    overlay: Any,
    found: Any,
    what: str,
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
        title=what,
        series=BOTH,
        legend={"orient": "top", "symbolType": "stroke"}
        if not last or what[:4] != "root"
        else None,
    )
    if band:
        kept, floor = outline(khz, band[1] - band[0]), 1e-6 * high
        places = zip(khz[kept].tolist(), *(values[kept].clip(floor).tolist() for values in band))
        ends = [{"x": x, "y": low, "y2": high} for x, low, high in places]
        panel.draw(
            {"type": "area", "opacity": 0.25, "color": BOTH["computed"].colour, "clip": True}, ends
        )
    for name, values in (("measured", measured), ("computed", computed)):
        kept = outline(khz, values)
        rows = [
            {"x": x, "y": y, "name": name}
            for x, y in zip(khz[kept].tolist(), values[kept].tolist())
        ]
        panel.draw({"type": "line", "strokeWidth": 1.3, "clip": True}, rows)
    dots = []
    for pair in found.pairs:
        at = int(np.searchsorted(khz, pair.measured.frequency / 1e3).clip(0, len(khz) - 1))
        its = pair.computed
        facts = (
            ("measured", hertz(pair.measured.frequency), "Hz"),
            ("computed", hertz(its.frequency_hz) if its else "", "Hz"),
        )
        words = readout(its.name if its else "no mode", *facts)
        dots.append({"x": float(khz[at]), "y": float(measured[at]), "readout": words})
    panel.draw({"type": "point", "filled": True, "size": 34, "color": INK}, dots)
    return panel


def write_correlation(
    folder: Path, found: Any, overlay: Any = None, viewer: str = ""
) -> list[Path]:
    """Page, data, tables and charts of a correlation, with measured and computed responses where
    there are any; `viewer` is HTML of shapes beside each other.
    """
    title = f"{found.scene}: measured and computed"
    lead = f"{found.title or 'Measured resonances'} beside {found.mesh}."
    lines = {"pairs": pairs(found)}
    sections = [
        Section(
            "pairs",
            "Pairs",
            charts={"off": partial(off_chart, found, title)} if found.worst else {},
            tables=[pairs(found), alone(found)],
        )
    ]
    if found.mac is not None:
        sections.append(Section("shapes", "Shapes", charts={"mac": partial(mac_map, found)}))
    if found.measured.responses is not None:
        lines["peaks"] = peaks(found, overlay)
        drawn = {"overlay": partial(overlay_chart, overlay, found, title)} if overlay else {}
        words = overlay.description if overlay else ""
        sections.append(Section("responses", "Responses", words, drawn, [lines["peaks"]]))
    return write_files(
        folder,
        "correlation",
        title,
        lead,
        [],
        found.results,
        lines=lines,
        charts={},
        verdict=found.sentences,
        viewer=viewer,
        sections=sections,
    )


def write_identification(folder: Path, found: Any) -> list[Path]:
    """Page, data and tables of an identification."""
    title = f"{found.scene}: identified"
    lead = f"From {found.title or 'measured resonances'}, by {found.mesh}."
    lines = {"identified": entries(found), "fitted": fitted(found)}
    if found.predicted:
        lines["predicted"] = predicted(found)
    return write_files(
        folder,
        "identification",
        title,
        lead,
        list(lines.values()),
        found.results,
        lines=lines,
        charts={},
        notes=found.sentences,
    )
