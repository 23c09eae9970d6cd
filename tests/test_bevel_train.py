"""Bevel meshes of trains that take their stiffness from the teeth."""

import numpy as np
import pytest

import solidgear as sg
from solidgear.teeth.bevel.flank import Mismatch
from solidgear.teeth.bevel.train import bevel_contact, toothed_bevel
from solidgear.teeth.contact.cycle import mesh_cycle
from solidgear.teeth.contact.local import Elasticity
from solidgear.teeth.supports import Carried, with_sections
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.load.contact import contact
from validation.common import ROOT
from validation.thesis.contact import blank

STEEL = Elasticity(2.07e11, 0.3)
POINT = OperatingPoint(name="drive", torque=200.0, speed=100.0)


@pytest.fixture(scope="module")
def axle():
    train = sg.load_train(ROOT / "geometry" / "axle_overhung.toml")
    return train.with_changes(operation=(POINT,))


@pytest.fixture(scope="module")
def solved(axle):
    carried = Carried.at_rest(with_sections(axle), POINT)
    return bevel_contact(carried, carried.train.pairs[0], (STEEL, STEEL))


def test_the_contact_of_an_axle(solved):
    cycle, aligned = solved.cycle, solved.aligned
    assert cycle.torque == pytest.approx(200.0)
    # shafts give way, teeth do not feel it
    assert cycle.supported_secant.mean() < 0.85 * cycle.secant.mean()
    assert cycle.tangent.mean() == pytest.approx(aligned.tangent.mean(), rel=0.01)
    assert solved.status == "estimated"
    assert [text.split()[0] for text in solved.assumed] == [
        "cutter",
        "addendum",
        "working",
        "ease-off",
        "The",
    ]
    least, most = solved.band.stiffness
    assert 1.5 < most / least < 1.9


def test_a_train_takes_stiffness_line_and_point_from_bevel_teeth(axle, solved):
    mesh = axle.meshes[0].with_changes(stiffness="teeth")
    train = Assembly(axle.with_changes(meshes=(mesh,))).train
    filled = train.meshes[0]
    assert filled.stiffness == pytest.approx(solved.cycle.tangent.mean(), rel=0.01)
    assert filled.status == "estimated"
    line = solved.cycle.lines_of_action.mean(axis=0)
    assert filled.line_of_action == pytest.approx(line / np.linalg.norm(line), abs=1e-3)
    # the published pitch angle is not that of the teeth, and levers are in their ratio all the same
    vectors = contact(train.pairs[0])
    assert vectors.gear.lever / vectors.pinion.lever == pytest.approx(-45 / 14, rel=5e-3)
    assert not any("lever arms" in caution for caution in vectors.cautions)


def test_a_train_with_cutters_is_calculated(axle):
    (pair,) = axle.pairs
    shafts = {
        side: shaft.with_changes(
            gears={
                name: gear.with_changes(cutter_radius=radius) for name, gear in shaft.gears.items()
            }
        )
        for (side, shaft), radius in zip(axle.shafts.items(), (0.156, 0.1524))
    }
    carried = Carried.at_rest(with_sections(axle.with_changes(shafts=shafts)), POINT)
    done = bevel_contact(carried, carried.train.pairs[0], (STEEL, STEEL), slices=12, positions=2)
    assert done.status == "calculated"
    assert done.pair.flanks.mismatch == Mismatch(pytest.approx(3.6e-3))
    assert not any("cutter" in text or "ease-off" in text for text in done.assumed)


def test_conjugate_teeth_of_table_1_and_mismatched_ones():
    """Orders of magnitude of the thesis's plots, and what a mismatch does: 1.8e8 to 3.2e8 N/m stand
    there, with supports.
    """
    secants = {}
    for excess, torque in ((0.0, 1000.0), (12e-3, 200.0)):
        bevel = toothed_bevel(blank(), (STEEL, STEEL), Mismatch(excess))
        cycle = mesh_cycle(bevel, torque, bevel.base, bevel.slices, positions=8)
        secants[excess] = cycle.secant.mean()
        for state in cycle.positions:
            assert state.force @ state.cells.lever == pytest.approx(torque, rel=1e-12)
    assert secants[0.0] > 4 * secants[12e-3] > 1e9
