"""Curves over a mesh cycle that verdicts on figures 3.11 to 3.22 rest on, by the name of the claim."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from solidgear.show.panel import Panel, Series, curve, lines_legend, readout
from solidgear.show.plot import Chart, in_columns
from solidgear.show.scales import Axis
from solidgear.show.shown import COLOURS
from solidgear.teeth.contact.cycle import MeshCycle
from validation.thesis import contact, contact_claims
from validation.thesis.contact import PILOT, THREE, TWO, WAYS, Mounting, by_pilot, by_span
from validation.thesis.pair import DATA

#: degrees of the pinion in a mesh cycle
PITCH = 360.0 / DATA["gears"]["teeth"][0]
#: positions of the pilot that are drawn
DRAWN = ("S = 0.002 in", "S = 2.36 in", "S = 5.36 in")
BEARINGS = {"A: 2-bearing": TWO, "B: 3-bearing": THREE}
#: curves of a panel by their names
Curves = Mapping[str, np.ndarray]


def chart(panels: Mapping[str, Curves], y: str, width: float) -> Chart:
    """Chart values over the mesh cycle, a panel a title."""
    names = list(next(iter(panels.values())))
    looks = {name: Series(COLOURS[k]) for k, name in enumerate(names)}
    drawn = []
    for k, (title, curves) in enumerate(panels.items()):
        values = np.concatenate(list(curves.values()))
        room = 0.1 * np.ptp(values) or 0.1 * abs(values[0])
        panel = Panel(
            Axis("pinion in degrees", (0.0, PITCH)),
            Axis(y, (float(values.min() - room), float(values.max() + room))),
            130.0,
            title,
            series=looks,
            legend=lines_legend(len(names)) if k == 0 else None,
        )
        for name, line in curves.items():
            angle = np.linspace(0.0, PITCH, len(line) + 1)
            rows = curve(angle, np.append(line, line[0]), name=name)
            panel.draw("line", rows)
            for row in rows:
                place, size = ("at", f"{row['x']:.1f}", "°"), (title, f"{row['y']:.5g}", "")
                row["readout"] = readout(name, place, size)
            panel.read(rows, looks[name].colour)
        drawn.append(panel)
    return Chart(in_columns(drawn, 1), width)


def components(rows_of: str, scale: float, y: str, width: float) -> Chart:
    """Chart the components of something by the pilot, and without one."""
    way = next(iter(WAYS))
    mountings = {DRAWN[0]: by_pilot()[DRAWN[0]], DRAWN[-1]: by_pilot()[DRAWN[-1]]}
    mountings["2-bearing"] = TWO
    cycles = {name: contact.contact(way, m) for name, m in mountings.items()}
    panels = {
        f"{axis}, {way}": {
            name: scale * getattr(cycle, rows_of)[:, k] for name, cycle in cycles.items()
        }
        for k, axis in enumerate("xyz")
    }
    return chart(panels, y, width)


def stiffnesses(mountings: Mapping[str, Mounting], width: float) -> Chart:
    """Chart k_m by mounting."""
    panels = {
        way: {
            name: contact.contact(way, mounting).supported_secant / 1e8
            for name, mounting in mountings.items()
        }
        for way in WAYS
    }
    return chart(panels, "k_m in 1e8 N/m", width)


def mesh_point_still(width: float) -> Chart:
    return components("points", 1e3, "mesh point in mm", width)


def line_of_action_still(width: float) -> Chart:
    return components("lines_of_action", 1.0, "line of action", width)


def stiffness_by_pilot(width: float) -> Chart:
    return stiffnesses({name: by_pilot()[name] for name in DRAWN}, width)


def close_pilot_counts_more(width: float) -> Chart:
    """Mean stiffness over the position of the pilot."""
    names = list(WAYS)
    looks = {name: Series(COLOURS[k]) for k, name in enumerate(names)}
    panel = Panel(
        Axis("S in inches", (0.0, contact.PILOTS[-1])),
        Axis("k_m over that of the closest pilot", (0.94, 1.01)),
        170.0,
        series=looks,
        legend=lines_legend(2),
    )
    for way in names:
        values = _means(contact_claims.cycles(way, by_pilot().values()))
        rows = curve(np.array(contact.PILOTS), values / values[0], name=way)
        panel.draw("line", rows)
        panel.draw("point", rows)
    return Chart([[panel]], width)


def _means(cycles: Sequence[MeshCycle]) -> np.ndarray:
    return np.array([contact_claims.stiffness(cycle) for cycle in cycles])


def span_with_pilot(width: float) -> Chart:
    return stiffnesses(by_span(PILOT), width)


def span_without_pilot(width: float) -> Chart:
    return stiffnesses(by_span(None), width)


def pilot_stiffens(width: float) -> Chart:
    return stiffnesses(BEARINGS, width)


def stiffness_without_shafts(width: float) -> Chart:
    panels = {}
    for way in WAYS:
        rigid, carried = contact.contact(way, None), contact.contact(way, THREE)
        panels[way] = {
            "k_m, 3-bearing": carried.supported_secant / 1e8,
            "teeth alone": rigid.secant / 1e8,
            "teeth about the load": rigid.tangent / 1e8,
        }
    return chart(panels, "stiffness in 1e8 N/m", width)


def stiffness_level(width: float) -> Chart:
    panels = {
        f"{torque:g} N m": {
            f"ease-off {1e6 * ease_off:.0f} um": contact_claims.level(
                torque, ease_off
            ).supported_secant
            / 1e8
            for ease_off in contact_claims.EASE_OFFS
        }
        for torque in contact_claims.TORQUES
    }
    return chart(panels, "k_m in 1e8 N/m", width)
