"""The error in one order more of a part of equal sectors: from one sector or half of one it is that of
all copies of the same mesh, and bars reach to a finer mesh.
"""

from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest
import scipy.sparse as sp

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.body.cache import Cache
from solidgear.core.bounds import solid as bounds_solid
from solidgear.core.bounds.solid import solid_bounds
from solidgear.core.judge.bounded import bounded
from solidgear.core.judge.quantities import size
from solidgear.core.judge.solving import Statics, numbers, search_modes
from solidgear.core.models.solid.block import seat_facets
from solidgear.core.models.solid.enriched import Seat, enrichment
from solidgear.core.models.solid.matrices import rigid_part, weighed
from solidgear.core.quantity import Quantity
from solidgear.cuts.features import Spline
from solidgear.cuts.sector import body as of_sector
from solidgear.cuts.sector.body import sector, whole
from solidgear.cuts.sector.meshing import joined

#: the same elements whatever the mesh
COARSE = 0.05
STRAIGHT = Spline(
    name="spline", segment="head", count=5, addendum=0.5, dedendum=0.5, angle=0.2, model="sector"
)
SPIRAL = STRAIGHT.with_changes(spiral_angle=0.4, hand="right")
NAMES = [Quantity(name) for name in ("C_zz", "C_thx", "C_yy", "bending 1", "axial 1", "torsion 1")]
STEEL = sg.Material(E=2.07e11, nu=0.3, density=7850.0)


def shaft(spline, tie="average"):
    """A splined head and a rod on two bearings."""
    segments = [
        sg.Segment.cylinder("head", length=0.03, diameter=0.06, material=STEEL),
        sg.Segment.cylinder("rod", y0=0.03, length=0.06, diameter=0.04, material=STEEL),
    ]
    firm = {"kxx": 1e9, "kyy": 1e8, "kzz": 1e9, "kthx": 1e6, "kthz": 1e6}
    bearings = [
        sg.Bearing(name=name, y=y, seat_width=0.015, stiffness=firm, attachment=tie)
        for name, y in (("a", 0.045), ("b", 0.08))
    ]
    port = sg.Port(name="gear", y=0.015, lo=0.0, hi=0.03)
    return sg.Scene.from_parts(segments, STEEL, bearings, port, features=(spline,))


def on_end(scene):
    """The shaft with its second bearing on its end face."""
    first, second = scene.bearings
    return scene.with_changes(bearings=(first, second.with_changes(face="end", y=scene.length)))


PARTS = {
    "straight": shaft(STRAIGHT),
    "spiral": shaft(SPIRAL),
    # ports feel waves of one period around at most, which four sectors have as five do
    "rigid": on_end(shaft(STRAIGHT.with_changes(count=4, dedendum=0.4), "rigid")),
}


@cache
def entire(name):
    """The part as all of its sectors."""
    scene = PARTS[name]
    return whole(scene, [(s, s.attachment) for s in scene.stations], refinement=COARSE)


def energies(scene, body, names=("axial 1", "bending 1", "torsion 1")):
    """Energies of errors: under unit loads, by cells in sum over that, and of modes."""
    modes = sg.modes(body, scene, n=6)
    bounds = solid_bounds(scene, body, statics=True, modes=modes, wanted=names)
    forces = np.cos(np.arange(len(bounds.reached)))
    by_cells = bounds.energy_by_cells(forces).sum() / (forces @ bounds.reached @ forces)
    return bounds.reached, by_cells, [bounds.of_modes[name].sum() for name in names]


def apart(one, other):
    """Largest difference over the diagonal entries."""
    scale = np.sqrt(np.diag(other))
    return (np.abs(one - other) / np.outer(scale, scale)).max()


@pytest.fixture
def small_residuals(monkeypatch):
    """Conjugate gradients that go on beyond some per cent."""
    monkeypatch.setattr(bounds_solid, "MISSING", 2e-4)


@pytest.mark.parametrize(
    ("name", "half"),
    [
        pytest.param("straight", True, marks=pytest.mark.slow),
        pytest.param("straight", False, marks=pytest.mark.slow),
        pytest.param("spiral", False, marks=pytest.mark.long),
        pytest.param("rigid", True, marks=pytest.mark.long),
        pytest.param("rigid", False, marks=pytest.mark.slow),
    ],
)
@pytest.mark.usefixtures("small_residuals")
def test_a_sector_errs_as_the_whole_does(name, half):
    """The same elements and functions: what is left is where conjugate gradients end."""
    scene = PARTS[name]
    reached, by_cells, modes = energies(scene, entire(name))
    body = sector(scene, refinement=COARSE, half=half)
    found, cells, found_modes = energies(scene, body)
    assert np.diag(found) == pytest.approx(np.diag(reached), rel=1e-3)
    assert apart(found, reached) < 1e-3
    assert cells == pytest.approx(1, rel=0.01) and by_cells == pytest.approx(1, rel=0.01)
    assert found_modes == pytest.approx(modes, rel=1e-3)


def shuffled(meshed):
    """The same sector with its vertices in another order."""
    used = np.unique(meshed.mesh.t)
    number = np.zeros(meshed.mesh.p.shape[1], int)
    number[used] = np.random.default_rng(5).permutation(len(used))
    mesh = joined(meshed.mesh, [np.eye(3)], number[None], len(used))
    straight = np.zeros((3, len(used)))
    straight[:, number[used]] = meshed.straight[:, used]
    return replace(meshed, mesh=mesh, straight=straight)


def test_no_number_of_a_vertex_matters(monkeypatch):
    """Edges run from the lesser to the larger one: gmsh numbers slaves in the order of their masters,
    so that hardly any runs the other way round.
    """
    scene = PARTS["spiral"]
    loaded = []
    for change in (lambda meshed: meshed, shuffled):
        monkeypatch.setattr(of_sector, "mirrored", change)
        turned = sector(scene, refinement=COARSE, half=False)
        loaded.append(np.diag(solid_bounds(scene, turned, statics=True).reached))
    assert loaded[1] == pytest.approx(loaded[0], rel=1e-3)


@pytest.mark.usefixtures("small_residuals")
@pytest.mark.slow
def test_waves_around_err_as_in_the_whole():
    """Blocks without ports, whose phase on the cut face is another one."""
    scene, name = PARTS["straight"], "ovalising n=2 1"
    parts = [sector(scene, refinement=COARSE, half=half, ovalising=(2,)) for half in (True, False)]
    found = []
    for body in (entire("straight"), *parts):
        modes = sg.modes(body, scene, n=14)
        bounds = solid_bounds(scene, body, statics=False, modes=modes, wanted=[name])
        found.append(bounds.of_modes[name].sum())
    assert found == pytest.approx([found[0]] * 3, rel=1e-3)


@pytest.mark.usefixtures("small_residuals")
@pytest.mark.slow
def test_a_port_follows_the_material_in_one_order_more_too():
    scene = PARTS["straight"]
    body = entire("straight")
    block, m = body.blocks[0], body.geometry
    y = m.mesh.p[1, m.mesh.t]
    cells = np.flatnonzero(((y > -1e-9) & (y < scene.port.hi + 1e-9)).all(axis=0))
    seats, ports = [], []
    for station in scene.stations:
        seat = Seat(station.y, seat_facets(m, scene.segments, 1e-9)(station, "average"))
        seat = replace(seat, cells=cells) if station is scene.port else seat
        gram, loads = weighed(seat.pieces(m), station.y, m.nodes.shape[1])
        seats.append(seat)
        ports.append(rigid_part(gram, loads, tuple(range(6))))
    materials = [s.material for s in scene.segments]
    enrich = partial(enrichment, m, materials, seats)
    block = replace(block, ports=sp.vstack(ports).tocsr(), enrich=enrich)
    body = replace(body, blocks=(block,), cache=Cache())
    reached = solid_bounds(scene, body, statics=True).reached
    for half in (True, False):
        follows = sector(scene, refinement=COARSE, half=half, material_port=True)
        found = solid_bounds(scene, follows, statics=True).reached
        assert np.diag(found) == pytest.approx(np.diag(reached), rel=1e-3)


def judged(scene, refinement):
    """Numbers with their error bars."""
    body, supports = sector(scene, refinement=refinement), as_supports(scene)
    statics = Statics.for_quantities(scene, body, supports, NAMES)
    modes = search_modes(body, supports, 10, [q for q in NAMES if q.is_frequency], spare=True)
    values = numbers(statics, modes)
    bars = bounded(scene, body, supports, statics, modes, NAMES, values.solver).error_bars
    return {q: (values.quantities[q], bars[q], size(values.quantities, q)) for q in NAMES}


@pytest.mark.long
def test_bars_reach_beyond_a_finer_mesh():
    scene = PARTS["straight"]
    coarse, fine = (judged(scene, refinement) for refinement in (0.1, 0.7))
    for name, (value, bar, scale) in coarse.items():
        finer, rest, _ = fine[name]
        change = abs(value - finer) / scale
        # the finer mesh leaves an error of its own
        assert change < bar.width < 2.5 * (change + rest.width)
        assert rest.width < 0.7 * bar.width


@pytest.mark.usefixtures("small_residuals")
def test_modes_that_move_in_several_blocks_have_the_energy_of_all():
    """A bearing that couples axial motion and bending in one plane."""
    springs = np.diag([6e8, 2e8, 1e9, 1e6, 0.0, 1e6])
    springs[1, 2] = springs[2, 1] = 3e8
    coupling = sg.Bearing(name="a", y=0.045, seat_width=0.015, matrix=springs.tolist())
    plain = PARTS["straight"]
    scene = plain.with_changes(bearings=(coupling, plain.bearings[1]))
    of_modes = []
    for body in (entire("straight"), sector(scene, refinement=COARSE)):
        modes = sg.modes(body, scene, n=4)
        bounds = solid_bounds(scene, body, statics=False, modes=modes, wanted=["axial 1"])
        of_modes.append(bounds.of_modes["axial 1"].sum())
    assert len(modes.named("axial 1").vectors[0]) == 2
    assert of_modes[1] == pytest.approx(of_modes[0], rel=1e-3)
