"""One state of a train at rest for all commands: where its teeth touch at an operating point decides loads,
lives, bearings and all that rests on them.
"""

from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.backlash.solver.stability import over_cycle
from solidgear.backlash.train import backlash_model, teeth_of
from solidgear.core import SolidgearError
from solidgear.datasheet.at_rest import lives_over_points
from solidgear.strength.acting import Acting
from solidgear.strength.deflection.at_rest import deflection
from solidgear.teeth.train_teeth import solved_mesh
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.tooth_stiffness import tooth_stiffness
from solidgear.trains.file.tables import ErrorTable
from solidgear.trains.load.lives import lives_in, train_lives
from solidgear.trains.load.operation import Operating
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.train_task import train_task

pytestmark = pytest.mark.usefixtures("coarse_teeth")

BOX = Path(__file__).parent / "found" / "people" / "my_box.toml"
AXLE = Path(__file__).parent.parent / "geometry" / "axle_overhung.toml"
BEAMS = {"pinion": "timoshenko", "gear": "timoshenko"}
#: the same equilibrium, whose iterations end at other digits
DIGITS = 1e-6


@pytest.fixture(scope="module")
def box():
    return sg.load_train(BOX)


@pytest.fixture(scope="module")
def deflected(box):
    """The state that deflection trusts."""
    return deflection(Assembly(box), box.point, "harmonic")


@pytest.fixture(scope="module")
def on_beams(box):
    return deflection(Assembly(box), box.point, "timoshenko")


def radial(bearing):
    return np.hypot(bearing.load[0], bearing.load[2])


def shaft_bearings(solution):
    return {f"{s.name}.{b.name}": b for s in solution.shafts for b in s.bearings}


def test_the_norm_takes_an_even_load_wherever_contact_has_it(box, on_beams):
    """Its face load factor moves the load along the face by its own formula: of teeth in contact, whose
    force is 6 mm off, f_sh is that of the force at the middle, but for how bearings stiffen meanwhile.
    """
    given = box.with_changes(mesh=box.mesh.with_changes(stiffness=9.5e8))
    (middle,) = deflection(Assembly(given), box.point, "timoshenko").face_loads
    (load,) = on_beams.face_loads
    assert load.skew == pytest.approx(middle.skew, rel=0.02)
    (resting,) = [m.value for m in on_beams.misalignment if m.name == "f_sh"]
    assert abs(resting) < 0.9 * abs(load.skew)


def test_lives_are_those_of_the_loads_that_deflect_shows(box, deflected):
    """An own calculation of statics with the force 6 mm off the middle of the face, towards B, has
    2528 N at A, where it has 2887 N with the force in the middle. It lets no bearing resist tilting,
    as the pair at B does with 27 N m over 150 mm. Lives are 523e6 revolutions there and 656e6.
    """
    at_rest = shaft_bearings(deflected)
    for lives in train_lives(box):
        (point,) = lives.points
        bearing = at_rest[lives.name]
        assert point.life.life.reference == pytest.approx(bearing.reference_life, rel=DIGITS)
    assert radial(at_rest["pinion.A"]) == pytest.approx(2528, rel=3e-2)
    assert at_rest["pinion.B"].reference_life == pytest.approx(523e6, rel=3e-2)


def test_a_row_has_the_lives_and_the_modes_of_the_file(box, on_beams):
    """Lives of the models of the row, modes on bearings as stiff as those of the file."""
    asked = ("bearing", "deflect", "system-modes")
    task = train_task(BOX, Design(("losses.mesh=0.05",)), ask=asked, n=3, **BEAMS)
    (row,) = task.rows([0])
    at_rest = shaft_bearings(on_beams)
    assert row["status"] == "ok"
    for name, bearing in at_rest.items():
        assert row[f"{name}.life"] == pytest.approx(bearing.reference_life, rel=DIGITS)
        assert row[f"{name}.radial"] == pytest.approx(radial(bearing), rel=DIGITS)
    skew = {measure.name: measure.value for measure in on_beams.misalignment}
    assert row["misalignment_in_plane"] == pytest.approx(skew["in plane"], rel=DIGITS)
    modes = sg.system_modes(box, BEAMS, max_frequency=4000.0).modes
    elastic = [mode.frequency_hz for mode in modes if mode.frequency_hz > 0][:3]
    assert [row[f"f{k}_hz"] for k in (1, 2, 3)] == pytest.approx(elastic, rel=DIGITS)


def test_bearings_are_as_stiff_as_at_the_loads_that_deflect_shows(box, deflected):
    """What modes, responses and matrices read of the file, on a mesh whose loads are within 1e-4 of
    those, as no beam is (8e-3).
    """
    for name, bearing in shaft_bearings(deflected).items():
        side, end = name.split(".")
        (settled,) = (b for b in box.shafts[side].scene.bearings if b.name == end)
        size = np.abs(bearing.stiffness).max()
        assert np.array(settled.matrix) == pytest.approx(
            np.array(bearing.stiffness), abs=2e-4 * size
        )


def test_the_force_acts_where_contact_has_it(box):
    """Mesh point and stiffness of the train are those of the study of its contact."""
    study = sg.contact(box, factors=())
    (mesh,) = study.meshes
    assembly = Assembly(box)
    assert assembly.train.mesh.stiffness == pytest.approx(mesh.cycle.tangent.mean(), rel=DIGITS)
    along = float(np.mean(mesh.cycle.points[:, 2]))
    middle = box.with_changes(mesh=box.mesh.with_changes(stiffness=1e9))
    aside = assembly.contact.pinion.point[1] - Assembly(middle).contact.pinion.point[1]
    assert abs(aside) == pytest.approx(abs(along), rel=1e-3) and abs(along) > 5e-3


def test_every_operating_point_has_its_own_teeth(box):
    """At a tenth of the torque, and on the other flank, as in a train that has this point alone."""
    light = box.point.with_changes(name="light", torque=18.0, share=0.6)
    coast = box.point.with_changes(name="coast", torque=-90.0, share=0.4)
    table = box.with_changes(operation=(light, coast))
    assembly = Assembly(table)
    operating = Operating(assembly, "timoshenko")
    lives = lives_in(table, [[operating.at(point) for point in (light, coast)]])
    (stiffness,) = tooth_stiffness(assembly)
    aside = []
    for k, point in enumerate((light, coast)):
        alone = Assembly(box.with_changes(operation=(point.with_changes(share=None),)))
        single = shaft_bearings(deflection(alone, alone.train.point, "timoshenko"))
        together = shaft_bearings(deflection(assembly, point, "timoshenko"))
        for bearing in lives:
            own = single[bearing.name]
            life = bearing.points[k].life.life.reference
            assert life == pytest.approx(own.reference_life, rel=DIGITS)
            assert together[bearing.name].load == pytest.approx(own.load, rel=1e-5, abs=1e-3)
        assert stiffness.stiffness[k] == pytest.approx(alone.contact.stiffness, rel=DIGITS)
        aside.append(abs(assembly.at(point).contact.pinion.point[1]))
    full = abs(Assembly(box).contact.pinion.point[1])
    assert min(abs(place - full) for place in aside) > 1e-3


def test_the_contact_is_solved_once_for_a_file(box, monkeypatch):
    from solidgear.teeth import train_teeth

    solved = []

    def counted(carried, mesh, model=None):
        solved.append(carried.point.torque)
        return solved_mesh(carried, mesh, model)

    monkeypatch.setattr(train_teeth, "solved_mesh", counted)
    train = sg.load_train(BOX)
    assert solved == [180.0]
    assembly, point = Acting().read(train)
    deflection(assembly, point, "timoshenko")
    sg.system_modes(train, BEAMS, max_frequency=1000.0)
    assert solved == [180.0]
    # a train that is another one forgets what its teeth gave
    wide = train.with_changes(pinion=replace_face(train, "36 mm"))
    Assembly(wide)
    assert len(solved) == 2


def replace_face(train, width):
    shaft = train.shafts["pinion"]
    (name,) = shaft.gears
    gear = shaft.gears[name].with_changes(face_width=width)
    return shaft.with_changes(gears={name: gear})


def test_a_point_without_torque_settles_and_has_no_modes(box):
    """Teeth that carry nothing need no contact; their stiffness would be that of no load."""
    idle = box.point.with_changes(torque=0.0, weight="-z")
    train = box.with_changes(operation=(idle,))
    assembly = Assembly(train)
    assert Operating(assembly).at(idle).mesh_force == 0.0
    with pytest.raises(SolidgearError, match="0 N m presses no teeth together"):
        assembly.system("timoshenko")


def test_a_sheet_shows_lives_and_modes_of_its_own_point(box):
    """Coast is the second point of the file; without a duty table each has its own life."""
    coast = box.point.with_changes(name="coast", torque=-90.0)
    train = box.with_changes(mesh=box.mesh.with_changes(stiffness=9.5e8))
    train = train.with_changes(operation=(box.point, coast))
    alone = sg.load_train(train, coast)
    state = Operating(Assembly(alone)).at(coast)
    expected = {
        lives.name: lives.points[0].life.life.reference for lives in lives_in(alone, [[state]])
    }
    shown = lives_over_points(Assembly(train), coast)
    # the first state decides the mesh, which is that of another point here
    assert {name: fact.life for name, fact in shown.items()} == pytest.approx(expected, rel=2e-4)
    assert not any(fact.over_table for fact in shown.values())


def test_a_train_that_has_changed_settles_anew(box):
    """In Python as from its file: modes at another torque are on bearings at that torque."""
    light = box.with_changes(operation=(box.point.with_changes(torque=18.0),))
    again = sg.load_train(light, light.point)
    changed, settled = (
        [mode.frequency_hz for mode in sg.system_modes(train, BEAMS, max_frequency=1500.0).modes]
        for train in (light, again)
    )
    assert changed == pytest.approx(settled, rel=DIGITS, abs=1e-3)
    before = sg.system_modes(box, BEAMS, max_frequency=1500.0).modes[2].frequency_hz
    assert changed[2] != pytest.approx(before, rel=1e-3)
    assert sg.load_train(again) is again


def test_a_point_of_a_duty_table_can_be_loaded_for_itself():
    train = sg.load_train(AXLE.parent / "gearbox_train.toml")
    coast = train.operation[1]
    assert coast.share
    alone = sg.load_train(train, coast)
    assert alone.point.torque == coast.torque and alone.point.share is None


# ------------------------------------------------------------------------------------ backlash
def test_solved_teeth_vary_over_their_cycle_with_backlash(box):
    """The stiffness at every place of the cycle of contact, about its mean, by orders."""
    train = box.with_changes(mesh=box.mesh.with_changes(backlash="100 um"))
    how = {"against": (), "apart": 0, "min_frequency": 290.0, "max_frequency": 300.0}
    solved = sg.nonlinear(train, "lumped/timoshenko", **how)
    tangent = solved_mesh_of(train).cycle.tangent
    orders = 2 * np.fft.rfft(tangent)[1:3] / tangent.sum()
    cycle = [complex(c, -s) for c, s in solved.study.teeth.cycle[:2]]
    assert solved.study.teeth.varies
    # a course that is linear between the places has less of each order
    assert np.abs(cycle) == pytest.approx(np.abs(orders), rel=0.1)


def solved_mesh_of(train):
    (mesh,) = sg.contact(train, factors=()).meshes
    return mesh


def driven_at(order, highest):
    """The axle driven at a multiple of its mesh frequency alone, asked up to a frequency."""
    train = sg.load_train(AXLE)
    error = ErrorTable(orders=(*[0.0] * (order - 1), 2e-6))
    mesh = train.mesh.with_changes(backlash="1 mm", transmission_error=error)
    return train.with_changes(mesh=mesh, ask=train.ask.with_changes(max_frequency=highest))


def test_modes_that_higher_orders_meet_move_as_well():
    """The third order reaches 2.1 kHz; modes there give the force that a train asked up to 4 kHz has, but
    for the mass of modes between, which are springs: 3 %.
    """
    near, far = (
        sg.nonlinear(
            driven_at(3, highest),
            BEAMS,
            against=(),
            apart=0,
            mean_force="20 kN",
            min_frequency=550.0,
            max_frequency=700.0,
        ).judge
        for highest in (700.0, 4000.0)
    )
    assert near.remainder.omega[-1] > 2 * np.pi * 2000.0
    assert near.worst.loudest.force == pytest.approx(far.worst.loudest.force, rel=5e-2)
    assert near.loudest.force == pytest.approx(near.linear_loudest.force, rel=1e-2)
    assert near.unmet_hz is None


def test_orders_beyond_what_the_shafts_resolve_are_named():
    """With one mode of each shaft the reduction promises 3764 Hz."""
    how = {"against": (), "apart": 0, "mean_force": "20 kN", "kept": 1}
    solved = sg.nonlinear(
        driven_at(6, 700.0), BEAMS, min_frequency=690.0, max_frequency=700.0, **how
    )
    (sentence,) = (text for text in solved.sentences if "Orders of the mesh reach" in text)
    assert "reach 4200 Hz" in sentence and "up to 3764 Hz only" in sentence


def test_motions_grow_over_a_cycle_as_by_each_instant():
    """Steps among the poles are those of the whole state, by the midpoint rule."""
    assembly = Assembly(driven_at(3, 700.0))
    model = backlash_model(assembly, ["timoshenko"], teeth_of(assembly, 2e4), 4000.0)
    angle = 2 * np.pi * np.arange(24) / 24
    more = (0.3 * np.cos(angle))[:, None, None] * model.stiffness
    drag = (0.2 * np.sin(angle))[:, None, None] * np.full_like(model.stiffness, 1e3)
    half = np.pi / 900.0 / 24 * model.generator(more, drag)
    eye = np.eye(half.shape[-1])
    expected = eye
    for step in np.linalg.solve(eye - half, eye + half):
        expected = step @ expected
    steps = over_cycle(model, 900.0, more, drag)
    assert steps == pytest.approx(expected, abs=1e-8 * np.abs(expected).max())
