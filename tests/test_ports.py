"""Ports: rigid motions pass through them exactly, and the averaged seat is the least-squares fit it
says it is.
"""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.scene import Port, Scene, Segment
from tests.dense import rigid_at

GEOMETRY = Path(__file__).parent.parent / "geometry"
OPTIONS = {
    "euler": {},
    "timoshenko": {},
    "harmonic": {"order": 4, "layers": 1},
    "solid hex20": {"element": "hex20", "around": 8, "refinement": 0.5},
    "solid tet10": {"element": "tet10", "size": 0.04, "graded_size": 0.04},
}


@pytest.mark.parametrize("attachment", ["average", "rigid", "section"])
@pytest.mark.parametrize("model", OPTIONS)
def test_ports_follow_rigid_motions(model, attachment):
    scene = sg.load(GEOMETRY / "shaft_hollow.toml").with_attachment(attachment)
    body = sg.build(scene, model.split()[0], **OPTIONS[model])
    found = np.zeros((6 * len(body.ports), 6))
    for block in body.blocks:
        rows = block.ports @ block.rigid
        for p in range(len(body.ports)):
            for i, component in enumerate(block.components):
                found[6 * p + component, list(block.components)] = rows[
                    p * len(block.components) + i
                ]
    expected = np.vstack([rigid_at(s.y) for s in scene.stations])
    # partition of unity and weights that sum to one: rounding, with moment arms below 1 m
    assert np.abs(found - expected).max() < 1e-12


# --------------------------------------------------------------------------- the fit itself
WIDTH, RADIUS, MIDDLE = 0.06, 0.04, 0.1


def rod(attachment):
    rod = Segment.cylinder("rod", length=0.2, diameter=2 * RADIUS)
    return Scene.from_parts(
        [rod],
        port=Port(y=MIDDLE, lo=MIDDLE - WIDTH / 2, hi=MIDDLE + WIDTH / 2, attachment=attachment),
    )


# Least squares on a cylinder of width w and radius r: minimise the integral of |u - (d + th x r)|^2 over the surface.
#   u_z = s^2 (s = y - y0):       d_z = w^2 / 12, no tilt
#   u_y = -z, nothing else:       th_x = mean of z^2 / mean of (s^2 + z^2) = (r^2 / 2) / (w^2 / 12 + r^2 / 2)
BULGE = WIDTH**2 / 12
WARP = (RADIUS**2 / 2) / (WIDTH**2 / 12 + RADIUS**2 / 2)


def test_averaged_seat_of_the_harmonic_solid():
    body = sg.build(rod("average"), "harmonic", order=2, layers=1)
    block = body.blocks[0]
    # the unknowns' own places: lateral unknowns move with a translation, axial ones with -r under a
    # tilt
    lateral = block.rigid[:, 0]
    axial = np.where(lateral == 0.0, block.rigid[:, 1], 0.0)
    bulge = block.ports @ (lateral * (block.y - MIDDLE) ** 2)
    warp = block.ports @ axial
    # quadratic and linear fields, held exactly by order 2, integrated exactly: rounding
    assert bulge == pytest.approx([BULGE, 0.0], abs=1e-13)
    assert warp == pytest.approx([0.0, WARP], abs=1e-12)


@pytest.mark.parametrize("element", ["hex20", "hex27"])
def test_averaged_seat_of_the_solid(element):
    body = sg.build(rod("average"), "solid", element=element, around=8, layers=0, half=False)
    x, y, z = body.geometry.nodes
    ports = body.blocks[0].ports
    lift, stretch = np.zeros((2, len(y), 3))
    lift[:, 2] = (y - MIDDLE) ** 2
    stretch[:, 1] = -z
    bulge, warp = ports @ lift.ravel(), ports @ stretch.ravel()
    # eight quadratic arcs carry the circle's area; z^2 over its arc is right to a few 1e-4 of
    # itself
    assert bulge == pytest.approx([0, 0, BULGE, 0, 0, 0], abs=1e-12)
    assert warp == pytest.approx([0, 0, 0, WARP, 0, 0], abs=5e-4)
    assert abs(warp[3] - 1) > 0.1  # far from a rigid tilt, so the fit has something to decide


def test_section_is_the_mean_of_the_cross_section():
    # over a disc, u_y = -z is a tilt of the section by exactly one and u_z = z^2 is a mean of r^2 /
    # 4
    body = sg.build(rod("section"), "solid", element="hex27", around=8, layers=0, half=False)
    x, y, z = body.geometry.nodes
    ports = body.blocks[0].ports
    stretch, lift = np.zeros((2, len(y), 3))
    stretch[:, 1] = -z
    lift[:, 2] = z**2
    assert ports @ stretch.ravel() == pytest.approx(
        [0, 0, 0, 1, 0, 0], abs=1e-12
    )  # a rigid motion of the section
    assert (ports @ lift.ravel())[2] == pytest.approx(
        RADIUS**2 / 4, rel=1e-3
    )  # eight arcs, and z^2 by quadratics
