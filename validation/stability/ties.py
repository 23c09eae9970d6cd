"""Problem: the same shaft loaded in the middle through a point, a ring line, a patch, a rigid ring
or a whole section, on ever finer uniform meshes.

Reference: closed forms of how the first two diverge.  A line load on a half space sinks in by
``ln(1/h)``: a unit force spread over a ring of radius R gains ``ln 2 (1 + nu) (2 - nu) / (2 pi^2 R
E)`` at each halving (plane strain for its radial part, antiplane shear for its tangential part;
Johnson, Contact Mechanics, sec. 2.2).  A point load sinks in by 1/h (Boussinesq).
"""

from __future__ import annotations

import numpy as np

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.scene import STEEL, Port, Scene, Segment
from solidgear.core.solve.factor import factorise
from validation.manual.models import bearing
from validation.stability.frame import Finding, curve

RADIUS, LENGTH = 0.05, 0.3
SPRING = 1e9  # N/m
FLAT = {"order": 2, "layers": 0, "edge_layers": 0, "size": RADIUS / 2}
REFINEMENTS = (1, 2, 4, 8, 16)
REFINEMENTS_3D = (1, 2, 3)  # of 16 cells around: a corner of elements stays where the load is


def shaft() -> Scene:
    """Cylinder on two springs at sections near its ends; the load is in the middle."""
    bearings = [
        bearing(n, y, 0.02, [SPRING] * 3 + [0.0] * 3)
        for n, y in (("one", 0.03), ("two", LENGTH - 0.03))
    ]
    port = Port(y=LENGTH / 2, lo=LENGTH / 2 - 0.01, hi=LENGTH / 2 + 0.01)
    return Scene.from_parts(
        [Segment.cylinder("shaft", length=LENGTH, diameter=2 * RADIUS)],
        bearings=bearings,
        port=port,
    )


def compliance_of(block, held_rows, load) -> float:
    """Motion under a load, where the load is, with springs on some rows of the ports."""
    held = block.ports.tocsr()[held_rows]
    u = factorise((block.stiffness + SPRING * (held.T @ held)).tocsr(), planar=block.planar).solve(
        load
    )
    return float(load @ u)


def on_a_ring_line(body) -> float:
    """Deflection under a unit force on the ring of nodes in the middle (second-order nodal basis)."""
    block = body.blocks[0]
    # unknowns p, q, w of a node follow one another, and w is told by its part in a unit tilt, -r
    w = np.flatnonzero(
        (np.abs(block.y - LENGTH / 2) < 1e-9)
        & (np.abs(block.rigid[:, 1] + RADIUS) < 1e-9)
        & (block.rigid[:, 0] == 0)
    )
    load = np.zeros(block.size)
    load[w[0] - 2] = 1.0
    return compliance_of(block, [2 * body.port_index(n) for n in ("one", "two")], load)


def on_a_point(body) -> float:
    """Deflection under a unit force on one surface node of a 3D mesh, in the middle and in the
    plane of the force.
    """
    block, nodes = body.blocks[0], body.geometry.nodes
    middle = np.abs(nodes[1] - LENGTH / 2) < 1e-9
    node = np.flatnonzero(middle)[nodes[2, middle].argmax()]
    load = np.zeros(block.size)
    load[3 * node + 2] = 1.0
    # both sections are held by springs, and one against turning about the axis, which this load
    # does not do
    held = [6 * body.port_index(n) + c for n in ("one", "two") for c in range(3)] + [
        6 * body.port_index("one") + 4
    ]
    return compliance_of(block, held, load)


def measure(quick: bool = False) -> Finding:
    """Compliance under each load over refinement."""
    scene = shaft()
    rows = []
    for refinement in REFINEMENTS[:4] if quick else REFINEMENTS:
        mesh = FLAT | {"refinement": refinement}
        body = sg.build(scene, "harmonic", attachments=("average", "section"), **mesh)
        held = sg.build(scene.with_port(attachment="rigid"), "harmonic", **mesh)
        springs = as_supports(scene).with_attachment("section")
        row = {"h / R": 0.5 / refinement, "ring line": on_a_ring_line(body)}
        row |= {
            words: sg.condense(body, springs, port="port", attachment=tie).compliance[2, 2]
            for words, tie in (("patch", "average"), ("section", "section"))
        }
        rows.append(row | {"rigid ring": sg.condense(held, scene, port="port").compliance[2, 2]})
    points = []
    wide = scene.with_port(
        lo=LENGTH / 2 - RADIUS / 2, hi=LENGTH / 2 + RADIUS / 2, attachment="section"
    )  # whole cells on either side of the load
    for refinement in REFINEMENTS_3D[:2] if quick else REFINEMENTS_3D:
        body = sg.build(
            wide,
            "solid",
            element="hex8",
            half=False,  # one block, in the unknowns of the mesh
            layers=0,
            edge_layers=0,
            radial_layers=0,
            size=RADIUS / 2,
            around=16,
            refinement=refinement,
        )
        points.append(
            {
                "h / R": 0.5 / refinement,
                "point": on_a_point(body),
                "section, same mesh": sg.condense(body, wide, port="port").compliance[2, 2],
            }
        )
    base = rows[-1]["section"]
    gain = rows[-1]["ring line"] - rows[-2]["ring line"]
    closed = np.log(2) * (1 + STEEL.nu) * (2 - STEEL.nu) / (2 * np.pi**2 * RADIUS * STEEL.E)
    # on top of what the shaft does as a whole, a point compliance is proportional to 1 / h
    extra = [p["point"] - p["section, same mesh"] for p in points]
    power = np.log(extra[-1] / extra[-2]) / np.log(points[-2]["h / R"] / points[-1]["h / R"])
    last = {n: abs(rows[-1][n] / rows[-2][n] - 1) for n in ("patch", "rigid ring", "section")}
    return Finding(
        "ties",
        "Point and ring-line ties",
        "The compliance of a spring or load on one node, or on one ring of nodes, grows "
        "as long as the mesh is refined.",
        f"A ring line gains {gain:.2e} m/N at each halving (closed form {closed:.2e}), "
        f"{gain / base:.1%} of the compliance of the shaft; a point grows like h^-{power:.2f}. "
        f"The last halving moves the patch by {last['patch']:.0e}, the rigid ring by "
        f"{last['rigid ring']:.0e}, the section by {last['section']:.0e}.",
        "Attachments are `average`, `rigid` or `section`; a scene that asks for another "
        "is refused.",
        "tests/test_bad_scenes.py::test_refused_in_one_line[unknown attachment]",
        [
            r | {"ring line gains": b["ring line"] - a["ring line"] if a else None}
            for a, r, b in zip([None, *rows], rows, rows)
        ]
        + points,
    )


def draw(finding: Finding, axes) -> None:
    """Compliance over mesh size."""
    base = next(r["section"] for r in finding.rows[::-1] if "section" in r)
    for name, line, colour in (
        ("point", "o-", "#c4541c"),
        ("ring line", "v-", "#c98a00"),
        ("patch", "s-", "#00805e"),
        ("rigid ring", "D-", "#5a3e8c"),
        ("section", "^-", "#0072b2"),
    ):
        rows = [r | {name: r[name] / base} for r in finding.rows if name in r]
        curve(axes, rows, "h / R", name, line, colour, name)
    axes.invert_xaxis()
    ticks = [r["h / R"] for r in finding.rows if "section" in r]
    axes.set_xticks(ticks, [f"R/{1 / t:.0f}" for t in ticks])
    axes.set_yticks([1, 1.2, 1.5, 2, 3, 4], ["1", "1.2", "1.5", "2", "3", "4"])
    axes.minorticks_off()
    axes.set(
        xlabel="mesh size", ylabel="compliance over that of a section tie", title=finding.method
    )
    axes.legend()
