"""Teeth of a wheel in 3D: the ring of one pitch, its port, what is near a load, and limits."""

from dataclasses import replace
from functools import lru_cache
from math import log, pi, radians

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.integrate import dblquad

from solidgear.core import SolidgearError
from solidgear.core.frames import rotation
from solidgear.core.gears.wheel import Wheel
from solidgear.core.machine.memory import NoRoom
from solidgear.core.models.solid.block import rigid_motions
from solidgear.core.solve.factor import factorise
from solidgear.teeth.compliance.half_space import between_pieces
from solidgear.teeth.compliance.mesh import Fineness
from solidgear.teeth.compliance.plane import PlaneTeeth
from solidgear.teeth.compliance.solid import SolidTeeth
from solidgear.teeth.compliance.solid_mesh import turned
from solidgear.teeth.contact.local import Elasticity
from validation.common import read_result
from validation.tooth_contact import condensed_contact, pair_of

WHEEL = Wheel(23, 4e-3, face_width=20e-3)
HELICAL = replace(WHEEL, helix_angle=radians(20))
RING = Wheel(-60, 2e-3, face_width=10e-3)
COARSE = {"slices": 4, "fineness": Fineness(2, 4, 4), "layer": 1.25, "hold": 25e-3}


@lru_cache
def coarse(wheel=WHEEL, **options):
    return SolidTeeth(wheel, **(COARSE | options))


def places(teeth, r, tooth=0):
    return np.full(teeth.slices, tooth), np.full(teeth.slices, r), teeth.middles


def evenly_loaded(teeth, r):
    """Motion of the mean of the face under an even load at a radius, m per N/m."""
    return teeth.matrix(*places(teeth, r)).mean() * teeth.wheel.face_width


@pytest.mark.slow
def test_the_ring_of_all_pitches_solved_at_once_moves_as_the_waves_of_one():
    teeth = coarse(replace(HELICAL, teeth=12, shift=0.4), hold=12e-3)
    count, mesh, inner = teeth.wheel.count, teeth.mesh, teeth.mesh.inner(True)
    sides = mesh.side_motions(teeth.wheel.pitch_angle, mesh.layers, True)
    n, q, full = len(inner), sides.shape[1] // 2, sides.shape[0]
    inside = sp.csr_matrix((np.ones(n), (inner, np.arange(n))), shape=(full, n))
    stiffness = teeth._stiffness
    total = sp.csr_matrix((count * (n + q),) * 2)
    moved = []
    for k in range(count):
        after = (k + 1) % count
        columns = np.concatenate(
            [
                k * (n + q) + np.arange(n + q),
                after * (n + q) + n + np.arange(q),
            ]
        )
        pick = sp.csr_matrix(
            (np.ones(len(columns)), (np.arange(len(columns)), columns)),
            shape=(len(columns), total.shape[0]),
        )
        moved.append(sp.hstack([inside, sides]) @ pick)
        total += moved[-1].T @ stiffness @ moved[-1]
    loads = (teeth._forces @ moved[0]).T.toarray()
    solved = factorise(total.tocsr())
    motion = solved.solve(loads)
    for tooth in (0, 1, 5, -1):
        direct = teeth._readings @ (moved[tooth] @ motion)
        assert np.allclose(teeth.with_rim(tooth), direct, rtol=0, atol=1e-9 * direct.max())

    port = teeth.port_part
    turns = [rotation(2, -k * teeth.wheel.pitch_angle) for k in range(count)]
    gram = sum(turn @ port.gram @ turn.T for turn in turns)
    spread = sum((port.loads.T @ part).T @ turn.T for part, turn in zip(moved, turns))
    by_loads = np.linalg.solve(gram, spread.T).T
    direct = by_loads.T @ solved.solve(by_loads)
    scale = np.sqrt(np.outer(np.diag(direct), np.diag(direct)))
    assert np.abs((teeth.port_compliance - direct) / scale).max() < 1e-9


@pytest.mark.slow
def test_sides_of_a_pitch_move_smoothly_enough():
    usual, free = (coarse(layer=0.5, slices=10, power=power) for power in (0.5, 2.0))
    for tooth in (0, 1):
        difference = np.abs(usual.without_rim(tooth) - free.without_rim(tooth)).max()
        assert 0 < difference < 1e-4 * usual.without_rim(0).max()


def test_nodes_of_the_right_side_are_those_of_the_left_one_turned_by_a_pitch():
    mesh = coarse(HELICAL).mesh
    before, after = (mesh.solid.nodes[:, mesh.nodes_of(side)[0]].T for side in mesh.plane.sides)
    before[:, :2] = turned(before[:, :2], HELICAL.pitch_angle)
    assert np.abs(before - after).max() < 1e-12


def test_flanks_are_curved_along_the_involute_and_the_helix():
    mesh = coarse(HELICAL).mesh
    x, y, z = mesh.solid.nodes[:, mesh.nodes_of(mesh.plane.flank)[0]]
    angle = np.arctan2(x, y) - mesh.twist * z
    assert np.abs(angle - HELICAL.half_angle(np.hypot(x, y))).max() < 1e-12


@pytest.mark.long
def test_teeth_of_the_other_hand_are_mirrored():
    usual, turned_back = coarse(HELICAL), coarse(HELICAL, hand=-1)
    slices, radii = usual.slices, len(usual.radii)
    for tooth in (0, 1, -2):
        mirrored = turned_back.table(tooth).reshape(radii, slices, radii, slices)[:, ::-1, :, ::-1]
        table = usual.table(tooth)
        assert np.abs(mirrored.reshape(table.shape) - table).max() < 1e-10 * np.abs(table).max()
    # and without the mirror they differ
    assert np.abs(turned_back.table(1) - usual.table(1)).max() > 1e-3 * np.abs(usual.table(1)).max()


@pytest.mark.long
def test_half_as_many_slices_have_the_means_of_pairs():
    few, many = coarse(HELICAL), coarse(HELICAL, slices=8)
    means = many.with_rim(1).reshape(len(few.radii), 4, 2, len(few.radii), 4, 2).mean(axis=(2, 5))
    assert np.allclose(means.reshape(few.with_rim(1).shape), few.with_rim(1), rtol=1e-7, atol=0)
    r = np.full(8, 46e-3)
    near = many._near(r, many.middles, 1e-3).reshape(4, 2, 4, 2).mean(axis=(1, 3))
    assert np.allclose(near, few._near(r[:4], few.middles, 1e-3), rtol=1e-3, atol=0)


def test_between_pieces_is_the_mean_of_a_force_on_a_half_space():
    steel, depth, length, along, across = Elasticity(), 1e-3, 0.8e-3, 1.1e-3, 0.3e-3

    def point(x, y):
        far = np.sqrt((along + x - y) ** 2 + across**2 + depth**2)
        shape = depth**2 / far**3 + 2 * (1 - steel.poisson) / far
        return (1 + steel.poisson) / (2 * pi * steel.youngs) * shape

    half = length / 2
    mean = dblquad(point, -half, half, -half, half, epsabs=0, epsrel=1e-10)[0] / length**2
    pieces = between_pieces(np.array(along), np.array(across**2), depth, length, steel)
    assert float(pieces) / mean == pytest.approx(1.0, rel=1e-9)


def test_the_table_is_smooth_along_the_flank():
    """Another mesh has its table at other radii: there the usual one is interpolated."""
    usual, fine = (coarse(layer=2.5, fineness=Fineness(4, flank, 6)) for flank in (8, 10))
    for r in fine.radii[2:-2:2]:
        assert evenly_loaded(usual, r) / evenly_loaded(fine, r) == pytest.approx(1.0, rel=5e-3)


@pytest.mark.parametrize("wheel, hold", [(WHEEL, 25e-3), (RING, None)])
def test_without_lateral_strain_an_even_load_is_that_of_the_plane_section(wheel, hold):
    """Poisson's ratio zero: a section of the plane solution moves as every section in 3D."""
    soft = Elasticity(2.06e11, 0.0)
    in_3d = SolidTeeth(
        wheel, hold=hold, elasticity=soft, slices=2, fineness=Fineness(4, 8, 6), layer=2.5
    )
    in_plane = PlaneTeeth(wheel, hold=hold, elasticity=soft)
    for share in (0.5, 0.75):
        r = wheel.form + share * (wheel.tip - wheel.form)
        plane = in_plane.matrix(np.zeros(1, int), np.array([r]), in_3d.depth).item()
        assert evenly_loaded(in_3d, r) / plane == pytest.approx(1.0, rel=0.005)


@pytest.mark.parametrize("hand", [1, -1])
def test_readings_of_rigid_motions_are_those_of_the_rows_of_the_rim(hand):
    teeth = coarse(HELICAL, hand=hand, offset=1e-3, width=16e-3)
    moved = teeth._readings @ rigid_motions(teeth.mesh.solid.nodes)
    size = np.array([1, 1, 1, WHEEL.tip, WHEEL.tip, WHEEL.tip])
    # means of a slice are not quite what its middle does: the normal turns along the helix
    assert np.abs((moved - teeth._rigid(0)) / size).max() < 1e-3


def test_the_port_turns_as_a_disc_in_shear_and_moves_with_rigid_bodies():
    """A torque spread over a cylinder turns it by T / (4 pi G b) (1 / a^2 - 1 / r^2)."""
    teeth = coarse()
    loads, gram = teeth.port_part.loads, teeth.port_part.gram
    motions = rigid_motions(teeth.mesh.solid.nodes)
    assert np.allclose(loads.T @ motions, gram, rtol=1e-9, atol=1e-9 * np.abs(gram).max())
    area = 2 * pi * teeth.port_radius * WHEEL.face_width / WHEEL.count
    assert gram[0, 0] / area == pytest.approx(1.0, rel=1e-9)
    assert gram[5, 5] / (area * teeth.port_radius**2) == pytest.approx(1.0, rel=1e-9)
    shear = teeth.elasticity.youngs / (2 * (1 + teeth.elasticity.poisson))
    reach = 1 / teeth.hold_radius**2 - 1 / teeth.port_radius**2
    turn = reach / (4 * pi * shear * WHEEL.face_width)
    compliance = teeth.port_compliance
    assert compliance[5, 5] / turn == pytest.approx(1.0, rel=5e-3)
    assert np.abs(compliance - compliance.T).max() < 1e-10 * compliance.max()
    assert compliance[0, 0] / compliance[1, 1] == pytest.approx(1.0, rel=1e-9)


def test_teeth_alone_hardly_know_where_their_rim_is_held():
    deep, shallow = coarse(), coarse(hold=33e-3)
    radii = len(deep.radii)
    with_rim, alone = (
        [motion(teeth).reshape(radii, 4, radii, 4)[2, :, 2].mean() for teeth in (deep, shallow)]
        for motion in (lambda teeth: teeth.with_rim(0), lambda teeth: teeth.without_rim(0))
    )
    # in plane strain 27.2 over 22.7, and 24.5 over 21.8
    assert with_rim[0] / with_rim[1] == pytest.approx(1.20, abs=0.03)
    assert alone[0] / alone[1] == pytest.approx(1.13, abs=0.03)


@pytest.mark.slow
def test_a_free_rim_is_softer_where_it_is_thin_and_not_where_it_is_thick():
    fixed, free = coarse(), coarse(free=True)
    assert np.array_equal(fixed.port_compliance, free.port_compliance)
    assert evenly_loaded(free, 46e-3) > 1.08 * evenly_loaded(fixed, 46e-3)
    thick = [evenly_loaded(coarse(hold=8e-3, free=value), 46e-3) for value in (False, True)]
    # waves from 2 on die away towards the axis
    assert thick[1] / thick[0] == pytest.approx(1.0, rel=5e-3)


def test_matrices_are_symmetric_and_positive_definite():
    teeth = coarse(HELICAL)
    tooth = np.repeat([-1, 0, 1], teeth.slices)
    r, z = np.repeat([48.5e-3, 46e-3, 44.4e-3], teeth.slices), np.tile(teeth.middles, 3)
    matrix = teeth.matrix(tooth, r, z)
    assert np.allclose(matrix, matrix.T, rtol=1e-12, atol=0)
    assert np.linalg.eigvalsh(matrix).min() > 0.01 * np.diag(matrix).min()
    # a turn of the wheel by a pitch changes nothing, and neither does the order of the places
    order = np.arange(len(r))[::-1]
    reordered = teeth.matrix(tooth[order] + 7, r[order], z[order])[np.ix_(order, order)]
    assert np.allclose(reordered, matrix, rtol=1e-9, atol=0)


@pytest.mark.long
def test_an_offset_to_the_other_side_is_the_mirror_of_a_spur_wheel():
    ahead, behind = (coarse(width=10e-3, offset=offset) for offset in (4e-3, -4e-3))
    forward = ahead.matrix(*places(ahead, 46e-3))
    back = behind.matrix(*places(behind, 46e-3))
    assert np.allclose(forward, back[::-1, ::-1], rtol=1e-9, atol=0)
    # the end of the face is nearer on one side
    assert forward[3, 3] > 1.05 * forward[0, 0]


def test_compliances_at_two_depths_differ_by_the_closed_form_between():
    shallow, deep = coarse(), coarse(reading_depth=2e-3)
    difference = evenly_loaded(shallow, 46e-3) - evenly_loaded(deep, 46e-3)
    # of an even load with its images as in plane strain: 2 (1 - nu^2) / (pi E) ln 2
    between = 2 / (pi * shallow.elasticity.plane) * log(2)
    assert difference / between == pytest.approx(1.0, rel=0.02)


def test_depths_that_are_read_do_not_matter():
    """A single reading, not continued to the surface, would change by 0.6 %."""
    usual, deeper = (
        evenly_loaded(coarse(slices=2, layer=2.5, fineness=Fineness(4, 8, 6), deepest=d), 46.7e-3)
        for d in (0.5, 0.8)
    )
    assert 0 < abs(deeper / usual - 1) < 2e-3


@pytest.mark.slow
@pytest.mark.parametrize("helix", [0, 15])
def test_contact_turns_a_pinion_as_in_calculix(helix):
    """Its flanks are flat between nodes, and its elements are of reduced order: 1 %."""
    row = read_result("tooth_contact")[f"helix {helix}"]
    torque = condensed_contact(pair_of(radians(helix))).torque
    assert row["torque_calculix"] / torque == pytest.approx(1.0, rel=0.01)


def test_wrong_teeth_and_no_memory_are_refused(monkeypatch):
    with pytest.raises(SolidgearError, match="outside the mesh"):
        coarse(port=20e-3).without_rim(0)
    with pytest.raises(SolidgearError, match="rim has no thickness"):
        coarse(hold=60e-3).without_rim(0)
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", "30")
    with pytest.raises(NoRoom):
        SolidTeeth(WHEEL, hold=25e-3).without_rim(0)
