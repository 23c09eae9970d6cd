"""Tables of the page about a train, from its plain results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import degrees
from typing import Any

from solidgear.report.cells import DASH, pct, whole_number
from solidgear.report.table import Table
from solidgear.report.units import ENGINEERING, GROUP, Units
from solidgear.report.words import hertz, seconds

SIDES = ("pinion", "gear")
#: relative; no frequency is shown with a smaller bound, whatever the proof says
ROUNDING = 1e-12


def facts(train: Mapping[str, Any], units: Units = ENGINEERING) -> Table:
    """The train in a few lines, each value with where it comes from."""
    status = train["statuses"]
    pinion, gear = (train[side] for side in SIDES)
    line = next((k for k in status if k.startswith("mesh.") and k not in _MESH), "")
    rows = [
        ["teeth", f"{pinion['teeth']} and {gear['teeth']}, ratio {train['ratio']:.4f}", ""],
        ["shaft angle", f"{degrees(train['shaft_angle']):g}°", ""],
        ["mesh stiffness", units.text(train["mesh_stiffness"], "N/m", 4), "mesh.stiffness"],
        ["line of action on the pinion", _vector(pinion["line_of_action"], 4), line],
        ["mesh point from the lumped points", _points(train, units), ""],
        ["lever arms", _levers(train, units), ""],
        [
            "transmission error",
            _error(train["transmission_error"], units),
            "mesh.transmission_error",
        ],
    ]
    for name in ("engine", "load"):
        own = train[name]
        rows.append([f"{name} inertia", units.text(own["inertia"], "kg m²", 4), f"{name}.inertia"])
        spring = f"{units.text(own['spring'], 'N m/rad', 4)} at {own['at']}"
        rows.append([f"{name} spring", spring, f"{name}.spring.stiffness"])
    losses = ", ".join(f"{name} {value:g}" for name, value in train["losses"].items())
    rows.append(["loss factors", losses, "losses"])
    return Table(
        "Train",
        ["item", "value", "status"],
        [[item, (text, "text"), _mark(status.get(key, ""))] for item, text, key in rows],
        css="facts",
        note="Status says where a value comes from: published, measured, identified or assumed.",
    )


_MESH = ("mesh.stiffness", "mesh.transmission_error")


def _mark(status: str) -> tuple[str, str]:
    return status, f"word text mark {status}".rstrip()


def _vector(values, digits: int) -> str:
    return f"({', '.join(f'{v:.{digits}f}' for v in values)})"


def _points(train: Mapping[str, Any], units: Units) -> str:
    unit = units.unit("m")
    digits = 2 if unit == "mm" else 4
    points = (_vector([units.value(v, "m") for v in train[s]["point"]], digits) for s in SIDES)
    return " and ".join(f"{text} {unit}" for text in points)


def _levers(train: Mapping[str, Any], units: Units) -> str:
    arms = (units.given(abs(train[s]["lever"]), "m") for s in SIDES)
    return " and ".join(f"{arm} {units.unit('m')}" for arm in arms)


def _error(table: Mapping[str, Any], units: Units) -> str:
    unit = units.unit("m moved")
    if table["orders"]:
        sizes = ", ".join(units.given(v, "m moved") for v in table["orders"])
        return f"{sizes} {unit}" + (" by order of the mesh" if len(table["orders"]) > 1 else "")
    low, high = table["frequency"][0], table["frequency"][-1]
    most = units.given(max(table["amplitude"]), "m moved")
    return f"a table from {low:g} to {high:g} Hz, up to {most} {unit}"


def verdict(found: Mapping[str, Any]) -> Table:
    """Every mix of models: up to where it holds, why no further, and its cost."""
    rows = []
    for mix in found["mixes"]:
        ends = [_end(mix[k], found) for k in ("modes_to_hz", "force_to_hz", "close_to_hz")]
        same = mix["pinion"] == mix["gear"]
        name = f"both {mix['gear']}" if same else f"{mix['pinion']} + {mix['gear']}"
        off = DASH
        if mix["mode"]:
            by = "no counterpart" if mix["error"] is None else pct(mix["error"]).replace(" ", GROUP)
            off = f"{mix['mode']}: {by}"
        best = {"pinion": mix["pinion"], "gear": mix["gear"]} == found["cheapest"]
        rows.append(
            [
                f"{name}, cheapest" if best else name,
                *ends,
                (off, "text"),
                (mix["cause"] or DASH, "text"),
                whole_number(mix["unknowns"]),
                seconds(mix["seconds"]),
            ]
        )
    tolerance = 100 * found["tolerance"]
    head = [
        "pinion + gear",
        f"modes within {tolerance:g} %, Hz",
        f"mesh force within {found['decibels']:g} dB, Hz",
        f"mesh force within {tolerance:g} %, Hz",
        "first mode off",
        "because of",
        "unknowns",
        "build and reduce, s",
    ]
    return Table(
        "Up to where every mix of models holds against both shafts solid, cheapest first",
        head,
        rows,
        note=(
            "The cause is the shaft whose model, put back to the solid alone, carries the mix "
            "furthest; of a lumped model, the assumption. The force within the tolerance is left "
            "by any peak or dip that moves a little."
        ),
    )


def _end(hz: float | None, found: Mapping[str, Any]) -> str:
    return f"{found['highest_hz']:.0f}+" if hz is None else f"{hz:.0f}"


def modes(
    found: Mapping[str, Any], caption: str = "Natural frequencies, both shafts solid"
) -> Table:
    """Natural frequencies of a train."""
    rows = []
    for mode in found["modes"]:
        hz = mode["frequency_hz"]
        rows.append(
            [
                mode["name"],
                f"{hz:.2f}",
                f"{mode['rpm']:.0f}",
                (mode["strained"] or DASH, "text"),
                "exact" if hz == 0 else f"{max(mode['bound'], ROUNDING):.0e}",
                DASH if mode["mesh"] is None else f"{mode['mesh']:.0e}",
            ]
        )
    return Table(
        caption,
        ["mode", "Hz", "pinion rpm", "most strain energy", "bound", "mesh"],
        rows,
        note="Pinion rpm: the speed at which its teeth mesh at this frequency. Bound: what the "
        "reduction leaves at most. Mesh: what meshes of harmonic solids leave at most.",
    )


def peaks(
    found: Sequence[tuple[float, float, str]],
    what: str,
    si: str,
    teeth: int,
    units: Units = ENGINEERING,
    of: str = "",
) -> Table:
    """Peaks of what a train does over frequency, for pages and for terminals.

    Parameters
    ----------
    found : sequence of (float, float, str)
        Frequency, Hz, size and mode.
    what : str
        What has them, such as ``mesh force``.
    si : str
        Unit of their sizes.
    teeth : int
        Of the pinion.
    units : Units, optional
        To show them in.
    of : str, optional
        The model.
    """
    units = units.fitting([size for _, size, _ in found], si)
    rows = [
        [mode, hertz(hz), f"{60 * hz / teeth:.0f}", units.number(size, si, 4)]
        for hz, size, mode in found
    ]
    head = ["mode that makes it", "Hz", "pinion rpm", f"{what}, {units.unit(si)}"]
    return Table(f"Peaks of the {what}{', ' + of if of else ''}", head, rows)


def crossings(found: list[Mapping[str, Any]], units: Units = ENGINEERING) -> Table:
    """Where orders meet natural frequencies."""
    rows = []
    for c in found:
        force = units.number(c["force"], "N", 4, DASH)
        rows.append([c["line"], (c["mode"], "text"), hertz(c["frequency_hz"])])
        rows[-1] += [f"{c['rpm']:.0f}", force]
    head = ["order", "mode", "Hz", "pinion rpm", f"mesh force, {units.unit('N')}"]
    return Table(
        "Where orders meet natural frequencies",
        head,
        rows,
        note="A dash: the transmission error has no such order.",
    )
