"""Bevel meshes of trains that take their stiffness from the teeth."""

import numpy as np
import pytest

import solidgear as sg
from solidgear.show.units import ENGINEERING
from solidgear.teeth.bevel.flank import Mismatch
from solidgear.teeth.bevel.train import bevel_contact, toothed_bevel
from solidgear.teeth.charts import pattern
from solidgear.teeth.contact.cycle import mesh_cycle
from solidgear.teeth.contact.local import Elasticity
from solidgear.teeth.sheet import contact_sheet
from solidgear.teeth.supports import Carried, with_sections
from solidgear.teeth.train_teeth import TeethModel
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
    return bevel_contact(carried, carried.train.pairs[0], (STEEL, STEEL), 16, 8)


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
    ]
    assert 1.5 < solved.band.factor < 1.9


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
    assert done.status == "calculated" and done.band is None
    assert done.pair.flanks.mismatch == Mismatch(pytest.approx(3.6e-3))
    assert not any("cutter" in text or "ease-off" in text for text in done.assumed)


def test_a_train_that_coasts_carries_on_the_other_flanks(axle):
    """The force turns the pinion the other way and pulls it in, by the train's line of action."""
    point = POINT.with_changes(torque=-200.0)
    assert point.coast
    carried = Carried.at_rest(with_sections(axle), point)
    pair = carried.train.pairs[0]
    done = bevel_contact(carried, pair, (STEEL, STEEL), slices=12, positions=2)
    assert done.pair.flanks.blank.loaded_side == "convex"
    line = done.cycle.lines_of_action.mean(axis=0)
    assert line @ carried.assembly.contacts[pair.name].pinion.normal > 0.98


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


@pytest.mark.long
def test_the_sheet_of_an_axle_has_its_band_and_pattern(axle):
    study = sg.contact(axle, model=TeethModel(slices=12, positions=4), factors=(0.5, 1.0))
    (mesh,) = study.meshes
    sheet = contact_sheet(study, ENGINEERING)
    assert {*sheet.charts} == {"cycle", "pattern", "face", "torque"}
    low, high = (ENGINEERING.number(value, "N/m", 3) for value in mesh.band.stiffness)
    assert any(f"{low} to {high}" in note and "a factor of 1." in note for note in sheet.notes)
    # the face is dark in its middle, and its ends stay white
    loads, heights, faces = pattern(mesh)
    assert loads.shape == (len(heights) - 1, len(faces) - 1)
    carried = np.nan_to_num(loads).max(axis=0)
    assert carried[[0, -1]].max() == 0 and carried.argmax() in (5, 6)
    band = study.as_dict()["meshes"]["mesh"]["band"]
    assert band[0]["ease_off"] == pytest.approx(50e-6, rel=0.01)
    stiffness = [at.contact.cycle.tangent.mean() for at in study.curves["mesh"]]
    assert stiffness[1] > 1.1 * stiffness[0]
