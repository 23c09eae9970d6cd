"""Section motions of shapes: exact for motions of sections, and the same on every mesh."""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg

STATIONS = 13
GEOMETRY = Path(__file__).parent.parent / "geometry"


def shipped(name):
    return sg.load(GEOMETRY / f"{name}.toml")


def motions(body):
    """Section motions of the six rigid motions of a body: (6 motions, stations, 6)."""
    stations = np.linspace(0.0, body.length, STATIONS)
    out = np.zeros((6, STATIONS * 6))
    for block in body.blocks:
        loads, gram, columns = block.section_loads(stations)
        out[np.ix_(block.components, columns)] = np.linalg.solve(gram, loads.T @ block.rigid).T
    return out.reshape(6, STATIONS, 6)


@pytest.mark.parametrize(
    "fidelity, options, attachment",
    [
        ("euler", {}, "average"),
        ("timoshenko", {}, "rigid"),
        ("harmonic", {"order": 2}, "rigid"),
        # cells of four radii: fewer along the shaft than stations
        ("harmonic", {"order": 6, "relative_size": 4.0, "layers": 0, "edge_layers": 0}, "average"),
        ("solid", {"refinement": 0.5}, "rigid"),
        ("solid", {"element": "tet10", "refinement": 0.7}, "average"),
    ],
)
def test_a_rigid_motion_moves_every_section_as_it_should(fidelity, options, attachment):
    """Signs, tilts about a section's own centre and hats that sum to one.  Of the quadrature it says
    nothing: loads and Gram matrix share their points, so a rigid motion comes out whatever they are.
    """
    scene = shipped("pinion_overhung").with_attachment(attachment)
    body = sg.build(scene, fidelity, **options)
    y = np.linspace(0.0, body.length, STATIONS)
    expected = np.zeros((6, STATIONS, 6))
    for c in range(6):
        expected[c, :, c] = 1.0
    expected[3, :, 2], expected[5, :, 0] = y, -y
    assert (
        np.abs(motions(body) - expected).max() < 1e-6
    )  # a mean over tetrahedra is off the axis by 1e-7 or so; the rest is rounding


@pytest.mark.parametrize(
    "component, section",
    [(0, np.pi * 1e-4), (1, np.pi * 1e-4), (3, np.pi / 4 * 1e-8), (4, np.pi / 2 * 1e-8)],
    ids=["across", "axial", "tilt", "twist"],
)
def test_long_cells_weigh_sections_as_a_bar_does(component, section):
    """On a uniform bar the Gram matrix is the consistent mass matrix of two-node bars from station to
    station, rho A l / 6 [2 1; 1 2], with I or J for A: a closed form that no mesh enters.
    """
    bar = sg.Scene.from_parts([sg.Segment.cylinder("bar", length=0.1, diameter=0.02)])
    body = sg.build(bar, "harmonic", order=6, relative_size=4.0, layers=0, edge_layers=0)
    exact = np.zeros((STATIONS, STATIONS))
    piece = 0.1 / (STATIONS - 1)
    for k in range(STATIONS - 1):
        exact[k : k + 2, k : k + 2] += piece / 6 * np.array([[2.0, 1.0], [1.0, 2.0]])
    exact *= bar.segments[0].material.density * section
    block = next(b for b in body.blocks if component in b.components)
    gram = block.section_loads(np.linspace(0.0, 0.1, STATIONS))[1]
    count, at = len(block.components), block.components.index(component)
    # A kink of a hat inside a piece of eight points leaves 9e-4.  Two points a piece leave 2e-2, three
    # 1.7e-2, and cells that are not cut from station to station 1.3e-2.
    assert np.abs(gram[at::count, at::count] - exact).max() < 4e-3 * exact.max()


@pytest.mark.slow
def test_one_mode_is_the_same_on_long_cells_and_on_short_ones():
    scene = shipped("shaft_stepped")
    found = [
        sg.modes(sg.build(scene, "harmonic", **o), scene, n=12)
        for o in (
            {"order": 8, "relative_size": 6.0, "layers": 1, "edge_layers": 0},
            {"order": 4, "layers": 1},
        )
    ]
    gram = found[1].gram
    for a, b in zip(*(f.modes for f in found)):
        assert a.name == b.name
        x, y = a.motions[0].ravel(), b.motions[0].ravel()
        # a shape at these settings is good to 1e-3, and a MAC is off by its square
        assert (x @ gram @ y) ** 2 / (x @ gram @ x) / (y @ gram @ y) > 1 - 1e-4
