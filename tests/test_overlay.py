"""Measured responses beside those of a scene, and what is shown of them."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from command import command
from universal_files import nodes, response, units, written

import solidgear as sg
from solidgear.core.scene.file import load
from solidgear.measured.command import turned_beside
from solidgear.measured.correlate import correlate
from solidgear.measured.data import load_measured
from solidgear.measured.overlay import overlay, stiffer_motions
from solidgear.measured.shapes import SurfacePoints

pytest.importorskip("pyuff")

#: a free slender rod of steel, m, kg, m/s
LENGTH, RADIUS, E, DENSITY = 0.6, 0.004, 200e9, 7850.0
MASS = DENSITY * math.pi * RADIUS**2 * LENGTH
ROD = f"""
material = {{ E = {E:g}, nu = 0.3, density = {DENSITY} }}
segment = [{{ kind = "cylinder", name = "rod", length = {LENGTH}, diameter = {2 * RADIUS} }}]
port = {{ at = "rod.middle", attach_to = "rod" }}
"""
#: measured across at so many places, driven at the first
ALONG = np.linspace(0.0, LENGTH, 9)
HERTZ = np.linspace(1.0, 1100.0, 1100)
DAMPING = 0.01


def bending(n):
    """Shape and frequency of a free rod in bending (Blevins, Formulas, table 8-1), of unit mass."""
    k = (4.73004, 7.85320, 10.99561, 14.13717, 17.27876, 20.42035)[n - 1]
    sigma = (np.cosh(k) - np.cos(k)) / (np.sinh(k) - np.sin(k))
    x = k * ALONG / LENGTH
    shape = np.cosh(x) + np.cos(x) - sigma * (np.sinh(x) + np.sin(x))
    speed = math.sqrt(E / DENSITY) * RADIUS / 2
    return shape / math.sqrt(MASS), k**2 * speed / (2 * math.pi * LENGTH**2)


def responses(noise=1e-3):
    """Accelerances of the rod: rigid motions and six modes."""
    omega = 2 * np.pi * HERTZ
    tilt = (ALONG - LENGTH / 2) / math.sqrt(MASS * LENGTH**2 / 12)
    rigid = 1 / MASS + tilt * tilt[0]
    out = rigid[:, None] * np.ones_like(omega, complex)
    for n in range(1, 7):
        shape, hertz = bending(n)
        own = 2 * np.pi * hertz
        below = own**2 - omega**2 + 2j * DAMPING * own * omega
        out += (shape * shape[0])[:, None] * -(omega**2) / below
    drawn = np.random.default_rng(3).standard_normal((*out.shape, 2)) @ [1, 1j]
    return out + noise * np.sqrt(np.mean(np.abs(out) ** 2)) * drawn


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("rod")
    places = np.column_stack([np.full_like(ALONG, RADIUS), ALONG, np.zeros_like(ALONG)])
    sets = [response(k, HERTZ, row) for k, row in enumerate(responses(), start=1)]
    written(folder / "rod.unv", units(1, 1.0, 1.0), nodes(places), *sets)
    (folder / "rod.toml").write_text(ROD)
    return folder


@pytest.fixture(scope="module")
def found(files):
    return correlate(load(files / "rod.toml"), load_measured(files / "rod.unv"), 1e-3)


@pytest.mark.long
def test_a_rod_answers_as_the_theory_of_rods_says(found):
    """Shapes of unit mass of a free rod are 2 / sqrt(m) at its ends, and it follows a slow force there
    as 4 / m.
    """
    names = [pair.computed.name for pair in found.pairs]
    assert names == [f"bending {n}" for n in range(1, 5)]
    assert all(pair.mac > 0.995 for pair in found.pairs)
    both = overlay(found)
    # rotation and shear of sections of a rod 75 diameters long take 0.4 % of bending 4; noise 0.1 %
    assert all(size == pytest.approx(1.0, abs=0.01) for size in both.constants.values())
    assert both.names[both.loudest] == "1x for 1x"
    # at the foot of bending 2, which is 0.2 % off the closed form; noise there is 1 %
    low = HERTZ < 230.0
    assert np.median(np.abs(both.computed[:, low] / both.measured[:, low] - 1)) < 0.03
    # damping is the measured one: peaks of bending 4, 18 lines wide, are as high
    tops = [np.abs(part[0, HERTZ > 800.0]).max() for part in (both.computed, both.measured)]
    assert tops[0] == pytest.approx(tops[1], rel=0.02)
    slow = both.computed[0, np.searchsorted(HERTZ, 5.0)]
    assert abs(slow) == pytest.approx(4 / MASS, rel=0.01)


def test_measured_points_move_as_the_surface_beside_them(found):
    points, surface = turned_beside(found)
    assert [one.name for one in points.shapes] == [one.name for one in surface.shapes]
    for one, its in zip(points.shapes, surface.shapes):
        # at the end where it was driven both move across, and alike
        near = np.abs(surface.mesh.points[:, 1]) < 1e-9
        across = its.displacement[near, 0].mean()
        assert one.displacement[0, 0] == pytest.approx(across, rel=0.05)
    assert abs(points.shapes[0].frequency_hz - bending(1)[1]) < 0.1


@pytest.mark.long
def test_the_page_shows_what_was_found(files, tmp_path):
    out = tmp_path / "out"
    told = command("correlate", files / "rod.toml", files / "rod.unv", "-o", out)
    assert told.exit_code == 0, told.output
    assert "Resonances of the responses" in told.output
    page = (out / "correlation.html").read_text()
    for words in ("1x for 1x", "Resonances of the responses", "MAC", "sg-turn"):
        assert words in page
    assert {"overlay.png", "mac.png", "off.png", "peaks.csv"} <= {p.name for p in out.iterdir()}
    data = json.loads((out / "correlation.json").read_text())
    assert data["pairs"][1]["damping"] == pytest.approx(DAMPING, rel=0.01)


@pytest.mark.long
def test_what_a_list_of_modes_lacks_is_what_a_direct_solution_has_beside_it():
    """``(K + springs - omega^2 M) u = f`` of a 3D mesh that turns and slides freely, against its modes up
    to 20 kHz: at 4 kHz the rest acts all but statically, by (4 / 20)^2 at most.
    """
    rod = sg.Segment.cylinder("rod", length=0.2, diameter=0.03)
    spring = np.diag([1e7, 0.0, 2e7, 1e3, 0.0, 2e3])
    bearing = sg.Bearing(name="A", y=0.05, seat_width=0.01, stiffness=spring.tolist())
    scene = sg.Scene.from_parts([rod], bearings=(bearing,))
    body = sg.build(scene, "solid", element="tet10", size=0.016, graded_size=0.016)
    places = SurfacePoints(body, [1, 2], np.array([[0.0, 0.02, 0.015], [0.015, 0.19, 0.0]]))
    ends = [(0, 3), (1, 1), (1, -3), (0, 2)]
    modes = sg.modes(body, scene, n=40, max_frequency=20e3).modes
    rest = stiffer_motions(scene, places, ends, modes).remaining
    block = body.blocks[0]
    port = body.port_index("A")
    seat = block.ports[6 * port : 6 * port + 6]
    stiff = block.stiffness + seat.T @ sp.csr_matrix(spring) @ seat
    corners = places.corners[[at for at, _ in ends]]
    force = np.zeros((block.size, len(ends)))
    for e, (at, way) in enumerate(ends):
        rows = body.geometry.rows("full", corners[e]).reshape(3, 3, -1)[:, abs(way) - 1]
        force[:, e] = np.sign(way) * places.weights[at] @ rows
    omega = 2 * np.pi * 4e3
    direct = force.T @ spla.splu((stiff - omega**2 * block.mass).tocsc()).solve(force)
    along = [(force.T @ vector[0], mode) for mode in modes for vector in mode.vectors]
    summed = sum(
        np.outer(u, u) / ((2 * np.pi * mode.frequency_hz) ** 2 - omega**2) for u, mode in along
    )
    lacks, left = np.abs(direct - summed), np.abs(direct - summed - rest)
    assert left.max() < 0.04 * lacks.max()
