"""Cells of a spiral bevel pair and loads on them, with teeth of a made-up compliance."""

from dataclasses import dataclass, replace
from math import cos, radians

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SceneError
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.teeth.bevel.band import setting_band
from solidgear.teeth.bevel.blank import BevelBlank
from solidgear.teeth.bevel.flank import BevelFlanks, Mismatch
from solidgear.teeth.bevel.misalignment import Misalignment
from solidgear.teeth.bevel.pair import BevelPair
from solidgear.teeth.bevel.reading import blank_of, mismatch_of
from solidgear.teeth.contact.cycle import mesh_cycle
from solidgear.teeth.contact.cylindrical import CylindricalPair
from solidgear.teeth.contact.frame import RigidSupports
from solidgear.teeth.contact.local import Elasticity, LineContact
from solidgear.teeth.contact.solver import loads
from validation.common import ROOT

BLANK = BevelBlank(
    (14, 45), 0.067, 0.063, 0.478, "left", "concave", radians(22.5), 0.1524, gear_share=0.27
)
CONJUGATE = Mismatch()
STEEL = Elasticity(2.07e11, 0.3)


@dataclass(frozen=True)
class MadeUp:
    """Teeth that give way by their height, and to their neighbours unlike before and behind."""

    root: float
    depth: float = 1.8e-3
    spread: float = 8e-3

    def matrix(self, tooth, r, z):
        soft = 2e-11 * (1 + 60 * (r - self.root))
        apart = tooth[:, None] - tooth[None]
        # reciprocal: the neighbour's side decides by both heights
        lower = np.minimum(r[:, None], r[None]) - self.root
        near = np.where(apart == 0, 1.0, np.where(np.abs(apart) == 1, 0.1 + 8 * lower, 0.0))
        lean = 1 + 20 * apart * (r[:, None] - r[None])
        along = np.exp(-np.abs(z[:, None] - z[None]) / self.spread) / (2 * self.spread)
        return np.sqrt(soft[:, None] * soft) * near * along * np.where(apart == 0, 1.0, lean)


@dataclass(frozen=True)
class Plain:
    """Teeth that give way by their height alone, in slices that do not know of each other."""

    root: float
    width: float
    depth: float = 5e-3

    def matrix(self, tooth, r, z):
        soft = 2e-11 * (1 + 20 * (r - self.root)) / self.width
        alike = np.abs(z[:, None] - z) < self.width / 2
        return np.sqrt(soft[:, None] * soft) * alike * (tooth[:, None] == tooth)


def pair(mismatch=CONJUGATE, slices=24, **changes):
    blank = replace(BLANK, **changes)
    wheels = blank.virtual_wheels(blank.face / cos(blank.spiral_angle))
    teeth = tuple(MadeUp(wheel.root) for wheel in wheels)
    law = LineContact((STEEL, STEEL), (teeth[0].depth, teeth[1].depth))
    return BevelPair(BevelFlanks(blank, mismatch), teeth, law, slices)


def test_the_made_up_compliance_is_reciprocal_and_tells_neighbours_apart():
    cells = pair().cells(0.2)
    bulk = pair().bulk(cells)
    assert bulk == pytest.approx(bulk.T, rel=1e-12)
    mirrored = pair().bulk(replace(cells, line=-cells.line))
    assert np.abs(mirrored - bulk).max() > 1e-3 * bulk.max()


@dataclass
class Recorded:
    """Teeth that keep what they are asked for."""

    depth: float = 1.8e-3
    tooth: np.ndarray | None = None
    r: np.ndarray | None = None

    def matrix(self, tooth, r, z):
        self.tooth, self.r = tooth, r
        return np.zeros((len(r), len(r)))


@pytest.mark.parametrize("hand", ["left", "right"])
@pytest.mark.parametrize("side", ["concave", "convex"])
def test_on_both_wheels_the_next_tooth_clockwise_touches_nearer_to_the_tip(hand, side):
    """The loaded flank is the right one of a wheel's frame, and its normal touches the base circle."""
    bevel = replace(pair(hand=hand, loaded_side=side), compliances=(Recorded(), Recorded()))
    several = 0
    for phase in (0.0, 0.3, 0.6):
        cells = bevel.cells(phase)
        bevel.bulk(cells)
        for piece in np.unique(cells.slice):
            here = np.flatnonzero(cells.slice == piece)
            for teeth in bevel.compliances:
                order = here[np.argsort(teeth.tooth[here])]
                assert np.all(np.diff(teeth.r[order]) > 0)
            several += len(here) > 1
    assert several > 10


def test_cells_touch_all_of_both_flanks_and_nothing_beyond():
    bevel = pair()
    cells = [bevel.cells(phase) for phase in np.linspace(0, 1, 41)]
    lift = np.hstack([c.lift for c in cells])
    for heights, addendum in zip(lift, BLANK.addenda):
        assert 0.98 * addendum < heights.max() < addendum + 1e-5
    along = np.concatenate([c.z for c in cells])
    assert 0.95 * BLANK.face / 2 < np.abs(along).max() < BLANK.face / 2


def test_the_mean_number_of_lines_is_the_contact_ratio():
    bevel = pair()
    count = [len(np.unique(bevel.cells(phase).line)) for phase in np.arange(80) / 80]
    assert np.mean(count) == pytest.approx(bevel.flanks.contact_ratio, abs=0.02)


def test_few_slices_cut_a_line_as_long_as_many_do():
    coarse, fine = (
        np.array([bevel.cells(phase).length.sum() for phase in np.arange(12) / 12])
        for bevel in (pair(slices=12), pair(slices=48))
    )
    assert coarse == pytest.approx(fine, rel=4e-3)


def test_the_torque_of_a_unit_force_on_the_gear_is_that_on_the_pinion_times_the_ratio():
    cells = pair().cells(0.7)
    torque = np.cross(cells.point, cells.normal)
    # the gear's axis in the pinion's frame at a right angle
    assert np.abs(torque[:, 1]) == pytest.approx(cells.lever, rel=1e-12)
    assert np.abs(torque[:, 0]) == pytest.approx(cells.lever * 45 / 14, rel=1e-12)


def test_conjugate_flanks_turn_evenly_without_load_and_balance_the_torque():
    bevel = pair()
    for phase in (0.0, 0.31, 0.77):
        state = loads(bevel, 1000.0, phase)
        assert abs(state.touch) * bevel.base < 1e-12
        assert state.force @ state.cells.lever == pytest.approx(1000.0, rel=1e-12)
        # the force on the gear turns it as hard as the ratio says
        moment = state.force @ np.cross(state.cells.point, state.cells.normal)
        assert abs(moment[0]) == pytest.approx(1000.0 * 45 / 14, rel=1e-12)


@pytest.mark.parametrize("side", ["concave", "convex"])
def test_a_mirrored_pair_carries_alike(side):
    mismatch = Mismatch(4e-3, 0.02, 1e-3)
    left, right = (pair(mismatch, hand=hand, loaded_side=side) for hand in ("left", "right"))
    for phase in (0.0, 0.4):
        first, second = loads(left, 200.0, phase), loads(right, 200.0, phase)
        assert second.secant == pytest.approx(first.secant, rel=1e-11)
        assert second.tangent == pytest.approx(first.tangent, rel=1e-11)
        assert second.point * [1, 1, -1] == pytest.approx(first.point, abs=1e-12)
        assert second.line_of_action * [1, 1, -1] == pytest.approx(first.line_of_action, abs=1e-11)


def test_a_misalignment_moves_the_contact_as_supports_do():
    """P of the pinion lifts its concave flank off: less so where a smaller gap opens."""
    bevel = pair(Mismatch(4e-3))
    still = loads(bevel, 200.0, 0.1)
    moved = {}
    for size in (-50e-6, 50e-6):
        motion = Misalignment(pinion_axial=size).motion(BLANK.shaft_angle)
        moved[size] = loads(bevel, 200.0, 0.1, RigidSupports(np.zeros((6, 6)), motion))
    # forces stay equal in sum, and the pinion turns by what the motion opens along the normals
    turned = (moved[50e-6].rotation - moved[-50e-6].rotation) / 100e-6
    assert turned == pytest.approx(float(still.force @ still.cells.normal[:, 1] / 200.0), rel=0.02)
    assert np.linalg.norm(moved[50e-6].point - still.point) > 1e-4


def test_straight_narrow_teeth_carry_as_their_virtual_spur_wheels_do():
    """Tredgold: the back cone unrolled; another path of contact, other radii and levers."""
    teeth = (36, 48)  # virtual wheels of 45 and 80
    blank = BevelBlank(teeth, 0.36, 20e-3, 0.0, "left", "concave", radians(20), 10.0, 0.5)
    wheels = blank.virtual_wheels(blank.face)
    assert [wheel.teeth for wheel in wheels] == [45, 80]
    # without a spread along the face, for a spur pair's load has none and ends of a line have
    made_up = tuple(Plain(wheel.root, blank.face / 8) for wheel in wheels)
    law = LineContact((STEEL, STEEL), (made_up[0].depth,) * 2)
    bevel = BevelPair(BevelFlanks(blank), made_up, law, 8)
    spur = CylindricalPair(WheelPair(wheels[0], wheels[1]), made_up, law, slices=8, beyond=0.0)
    assert bevel.flanks.contact_ratio == pytest.approx(spur.wheels.contact_ratio, rel=5e-3)
    force = 5e3
    secants = []
    for toothed, base in ((bevel, bevel.base), (spur, spur.wheels.first.base)):
        cycle = mesh_cycle(toothed, force * base, base, 8, positions=16)
        secants.append([cycle.secant.mean(), cycle.secant.min(), cycle.secant.max()])
    assert secants[0] == pytest.approx(secants[1], rel=5e-3)


@pytest.mark.long
def test_random_positions_settle():
    rng = np.random.default_rng(1)
    for _ in range(20):
        mismatch = Mismatch(
            10 ** rng.uniform(-3, -1.7), rng.uniform(-0.1, 0.1), rng.uniform(-3e-3, 3e-3)
        )
        side = rng.choice(["concave", "convex"])
        torque = 10 ** rng.uniform(-1, 4)
        state = loads(pair(mismatch, slices=12, loaded_side=str(side)), torque, rng.uniform())
        assert state.force @ state.cells.lever == pytest.approx(torque, rel=1e-11)
        assert np.all(state.force >= 0)


# ---------------------------------------------------------------- estimates
def test_flanks_that_stand_apart_are_softer_and_the_cutter_hardly_counts():
    estimated = pair(slices=12, estimated=("cutter_radius",))
    band = setting_band(
        estimated, 200.0, cutters=(0.8, 1.3), ease_offs=(50e-6, 300e-6), positions=4
    )
    tangents = [setting.cycle.tangent.mean() for setting in band.settings]
    assert [round(1e6 * setting.ease_off, -1) for setting in band.settings] == [50, 300, 50, 300]
    assert tangents[1] < 0.7 * tangents[0] and tangents[3] < 0.7 * tangents[2]
    assert tangents[2] == pytest.approx(tangents[0], rel=0.05)
    assert band.stiffness == (min(tangents), max(tangents))
    assert band.factor == max(tangents) / min(tangents)


def test_a_known_cutter_is_not_varied_and_one_that_makes_no_flank_is_named():
    known = setting_band(pair(slices=12), 200.0, ease_offs=(100e-6,), positions=1)
    assert [setting.cutter_radius for setting in known.settings] == [BLANK.cutter_radius]
    band = setting_band(
        pair(slices=12), 200.0, cutters=(0.23, 1.0), ease_offs=(100e-6,), positions=1
    )
    assert len(band.settings) == 1
    (reason,) = band.refused
    assert "does not reach across the face" in reason


def axle():
    """The mesh of the thesis's axle."""
    (mesh,) = sg.load_train(ROOT / "geometry" / "axle_thesis.toml").pairs
    return mesh


def with_keys(mesh, pinion=None, gear=None, **keys):
    """A mesh with further keys of its tables."""
    return replace(
        mesh,
        pinion=mesh.pinion.with_changes(**pinion or {}),
        gear=mesh.gear.with_changes(**gear or {}),
        mesh=mesh.mesh.with_changes(**keys),
    )


def test_a_train_gives_the_blank():
    blank = blank_of(with_keys(axle(), gear={"cutter_radius": 0.1524}, gear_share=0.27))
    assert (blank.hand, blank.loaded_side) == ("left", "concave")
    assert blank.pressure_angle == pytest.approx(radians(25))
    assert (blank.cutter_radius, blank.gear_share) == (0.1524, 0.27)
    assert blank.estimated == ("working_depth",)
    assert "0.391 rad of the pinion (0.3016)" in blank.notes[0]


def test_a_train_gives_the_mismatch():
    """By both cutters, or by what they leave open at the corners."""
    mesh = with_keys(
        axle(), {"cutter_radius": 0.156, "blade_curvature": 0.02}, {"cutter_radius": 0.15}
    )
    mismatch = mismatch_of(mesh, blank_of(mesh))
    assert mismatch == Mismatch(pytest.approx(6e-3), 0.02)
    turned = with_keys(mesh, {"loaded_side": "convex"}, {"loaded_side": "concave"})
    assert mismatch_of(turned, blank_of(turned)).cutter_radius == pytest.approx(-6e-3)
    eased = with_keys(axle(), ease_off=100e-6)
    flanks = BevelFlanks(blank_of(eased), mismatch_of(eased, blank_of(eased)))
    assert flanks.ease_off() == pytest.approx(100e-6, rel=0.01)


def test_a_train_without_what_flanks_need_is_refused():
    with pytest.raises(SceneError, match="face_width: is needed for the flanks"):
        blank_of(with_keys(axle(), {"face_width": None, "hand": None}))
    assert blank_of(with_keys(axle(), {"hand": None})).hand == "left"
    (parallel,) = sg.load_train(ROOT / "geometry" / "gearbox_train.toml").pairs
    with pytest.raises(SceneError, match="that of a cylindrical pair"):
        blank_of(parallel)
