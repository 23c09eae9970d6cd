"""What scenes, bodies and results tell of themselves in a line, a table or a picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.frames import DOF_NAMES
from solidgear.quantity import BLOCK_UNITS
from solidgear.report.reading import mode_of
from solidgear.report.table import Table
from solidgear.report.words import bar_of, percent

if TYPE_CHECKING:
    from solidgear.body import Body

#: shapes that a picture shows unless told otherwise
MOST_SHAPES = 6
#: a motion this small beside the largest of its mode is not drawn
SMALL = 0.05


def scene(told: Any) -> Table:
    """Parts of a shaft along its axis."""
    rows: list[tuple[Any, ...]] = []
    for s in told.segments:
        rows.append((s.name, "segment", 1e3 * s.y0, 1e3 * s.y1, _diameters(s)))
    for f in told.features:
        lo, hi = f.span(told.segments)
        rows.append((f.name, f.what, 1e3 * lo, 1e3 * hi, f"on {f.segment}"))
    for b in told.bearings:
        rows.append((b.name, "bearing", 1e3 * b.lo, 1e3 * b.hi, b.attachment))
    seats = {s.name: s for s in told.stations}
    for m in told.masses:
        seat = seats[m.station]
        rows.append((m.name, "mass", 1e3 * seat.lo, 1e3 * seat.hi, f"{m.mass:.6g} kg"))
    for c in told.corners:
        rows.append(
            (c.name, c.kind, *(1e3 * y for y in c.span), f"on {told.segments[c.owner].name}")
        )
    if told.body is not None:
        rows.append(
            (told.body.name, told.body.what, 0.0, 1e3 * told.length, "segments are its round part")
        )
    for port in told.ports:
        rows.append((port.name, "port", 1e3 * port.lo, 1e3 * port.hi, port.attachment))
    title = told.title or told.name
    return Table(
        f"Scene {told.name}: {title}, {1e3 * told.length:.6g} mm long",
        ("part", "kind", "from mm", "to mm", "what"),
        rows,
    )


def _diameters(segment: Any) -> str:
    outer = (segment.outer0, segment.outer1)
    inner = (segment.inner0, segment.inner1)

    def ends(pair: tuple[float, float]) -> str:
        return " to ".join(f"{2e3 * r:.6g}" for r in dict.fromkeys(pair))

    bore = f", bore {ends(inner)} mm" if any(inner) else ""
    return f"diameter {ends(outer)} mm{bore}"


def scene_figure(told: Any) -> Any:
    """The dimensioned section of the report."""
    from solidgear.report.sketch import draw

    return draw(told.as_dict())


def body(told: Body) -> Table:
    """Blocks of a body."""
    rows = [
        (b.name, " ".join(DOF_NAMES[c] for c in b.components), b.size, b.mirror is not None)
        for b in told.blocks
    ]
    ports = ", ".join(f"{p.name} ({p.attachment})" for p in told.ports)
    return Table(
        f"Body {told.fidelity}: {told.size} unknowns, ports {ports}",
        ("block", "moves", "unknowns", "twin"),
        rows,
    )


def mode_set(told: Any) -> Table:
    """Natural frequencies."""
    rows = [(m.name, m.frequency_hz, m.multiplicity, m.waves, m.error) for m in told.modes]
    return Table(
        f"Modes of the {told.fidelity} body",
        ("mode", "Hz", "shapes", "waves around", "solver's error"),
        rows,
    )


def mode_set_figure(told: Any, names: Sequence[str] = ()) -> Any:
    """Section motions of elastic modes along the shaft: translations, of torsion the turns.

    Parameters
    ----------
    told : ModeSet
    names : sequence of str
        Modes to draw, by name; the first few elastic ones by default.
    """
    from matplotlib.figure import Figure

    elastic = [m for m in told.modes if m.frequency_hz > 0]
    drawn = [told.named(name) for name in names] if names else elastic[:MOST_SHAPES]
    if not drawn or None in drawn:
        raise ValueError(f"no such mode; there are {', '.join(told.names)}")
    figure = Figure(figsize=(7.0, 0.6 + 1.15 * len(drawn)), layout="constrained")
    axes = figure.subplots(len(drawn), 1, sharex=True, squeeze=False)[:, 0]
    y = 1e3 * told.stations
    for ax, mode in zip(axes, drawn):
        moves, turns = np.abs(mode.motions[0]).max(axis=0).reshape(2, 3)
        # turns of a bent line say what the line says; where it stays, as in torsion, they are all
        bent = moves.max() > SMALL * turns.max() * np.ptp(told.stations)
        shown = range(3) if bent else range(3, 6)
        largest = (moves if bent else turns).max() or 1.0
        for k in shown:
            if np.abs(mode.motions[0, :, k]).max() > SMALL * largest:
                drawn_line = mode.motions[0, :, k] / largest
                ax.plot(y, drawn_line, ".-", label=DOF_NAMES[k], markersize=4)
        ax.axhline(0, color="#999999", lw=0.6)
        ax.set(ylim=(-1.15, 1.15), yticks=[])
        ax.set_title(f"{mode.name}, {mode.frequency_hz:.1f} Hz", loc="left", fontsize=9)
        ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    axes[-1].set_xlabel("y, mm")
    return figure


def condensed(told: Any, kind: str = "stiffness") -> Table:
    """The 6x6 at a port.

    Parameters
    ----------
    told : Condensed
    kind : {'stiffness', 'compliance'}
    """
    if kind not in BLOCK_UNITS:
        raise ValueError(f"kind {kind!r}: use stiffness or compliance")
    matrix = getattr(told, kind)
    rows = [
        (name, *(float(v) if np.isfinite(v) else None for v in row))
        for name, row in zip(DOF_NAMES, matrix)
    ]
    units = ", ".join(BLOCK_UNITS[kind])
    free = f"; free: {', '.join(told.free_names)}" if told.free_names else ""
    return Table(
        f"{kind} at {told.port} ({told.attachment}), {units}{free}", ("", *DOF_NAMES), rows
    )


def coupled(told: Any, kind: str = "compliance") -> Table:
    """The matrix between several ports.

    Parameters
    ----------
    told : Coupled
    kind : {'stiffness', 'compliance'}
    """
    if kind not in BLOCK_UNITS:
        raise ValueError(f"kind {kind!r}: use stiffness or compliance")
    heads = [f"{port} {name}" for port in told.ports for name in DOF_NAMES]
    rows = [
        (name, *(float(v) if np.isfinite(v) else None for v in row))
        for name, row in zip(heads, getattr(told, kind))
    ]
    free = f"; free together: {', '.join(told.free_names)}" if told.free_names else ""
    return Table(
        f"{kind} between {' and '.join(told.ports)}, {', '.join(BLOCK_UNITS[kind])}{free}",
        ("", *heads),
        rows,
    )


def comparison(told: Any) -> Table:
    """Verdict and first numbers of every model."""
    record, rows = told.record, []
    for name, model in record.models.items():
        first = mode_of(model, "bending 1")
        c_zz = model.compliance[2][2] if model.compliance else None
        spent = round(sum(v for v in model.seconds.values() if v is not None), 3)
        rows.append(
            (name, c_zz, first.frequency_hz if first else None, model.valid, model.dofs, spent)
        )
    trust = record.verdict.trust
    tolerance = percent(record.verdict.tolerance, signed=False)
    title = f"trust {trust}" if trust else "not judged"
    return Table(
        f"Comparison of {told.scene.name}: {title}; within {tolerance}: {record.verdict.cheapest or 'none'}",
        ("model", "C_zz m/N", "bending 1 Hz", "valid", "unknowns", "s"),
        rows,
    )


def answered(told: Any) -> Table:
    """Numbers with their bars."""
    rows = [(v.quantity, v.value, v.unit, bar_of(v)) for v in told.values]
    words = "within" if told.reached else "not within"
    return Table(
        f"Answer for {told.scene}: {told.rung}, {words} {percent(told.tolerance, signed=False)}",
        ("quantity", "value", "unit", "bar"),
        rows,
    )
