"""Bodies are freed as soon as nobody has them: what a body keeps holds it in no circle.

A circle is freed when the collector of Python comes by, which counts objects; a body of 40 MB has few.
Counted are bodies that live while the collector stands still: that is the same on every machine.
"""

import gc
from pathlib import Path

import pytest

import solidgear as sg
from solidgear.core.body import Body
from solidgear.core.judge.study import study
from solidgear.guards import probe
from solidgear.trains.assembly.assembly import Assembly
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.scene_task import scene_task

GEOMETRY = Path(__file__).parents[1] / "geometry"
STEPPED = GEOMETRY / "shaft_stepped.toml"
CATALOGUE, TRAIN = GEOMETRY / "gearbox_catalogue.toml", GEOMETRY / "axle_straddle.toml"
#: beams and coarse meshes: circles do not depend on the size of a body
COARSE = {"harmonic": {"order": 2}, "solid": {"refinement": 0.4}}


@pytest.fixture(autouse=True)
def no_collector(monkeypatch):
    # other tests share the light solids of guards, which are solved here
    monkeypatch.setattr(probe, "study", study)
    gc.collect()
    gc.disable()
    yield
    gc.enable()


def living(kind=Body):
    """Number of bodies, or of things of another kind, that live."""
    return sum(isinstance(thing, kind) for thing in gc.get_objects())


@pytest.mark.parametrize("model", ["euler", "timoshenko", "harmonic", "solid"])
def test_a_body_is_freed_with_its_last_user(model):
    before = living()
    scene = sg.load(STEPPED)
    body = sg.build(scene, model, **COARSE.get(model, {}))
    sg.condense(body, scene, port="port")
    modes = sg.modes(body, scene, n=4, count=True)
    assert living() > before and modes
    del body, modes
    assert living() == before


STUDIES = {
    "answer": lambda: sg.answer(STEPPED, 0.05, ["C_zz", "bending"]),
    "check": lambda: sg.check(STEPPED),
    "modes": lambda: sg.modes(STEPPED, n=4),
    "sensitivities": lambda: sg.sensitivities(STEPPED, "timoshenko", by="material.E"),
    "budget": lambda: sg.budget(CATALOGUE),
    "optimise": lambda: sg.optimise(
        STEPPED, "segment.left.diameter=45 mm,50 mm", "max f1", model="timoshenko"
    ),
    "correlate": lambda: sg.correlate(STEPPED, [654.0, 783.0], "5 %"),
    "deflect": lambda: sg.deflect(STEPPED, "timoshenko", load="z=1 kN"),
    "bearing": lambda: sg.bearing(CATALOGUE),
    "sweep of a train": lambda: sg.sweep(
        TRAIN, "pinion.material.E=200 GPa,210 GPa", pinion="timoshenko", gear="timoshenko"
    ),
    "modes of a train": lambda: sg.system_modes(TRAIN, "timoshenko"),
}


@pytest.mark.parametrize("name", STUDIES)
def test_a_study_leaves_no_body(name):
    before = living(), living(Assembly)
    STUDIES[name]()
    assert (living(), living(Assembly)) == before


@pytest.mark.parametrize("model", [None, "timoshenko"])
def test_rows_of_a_sweep_keep_no_body_of_others(model):
    """Twenty rows take what five take: the last mesh is where the next row begins, and no more."""
    design = Design(("segment.left.diameter=45 mm:55 mm:20",))
    task = scene_task(STEPPED, design, model=model, tolerance=0.05, n=2)
    before, counts = living(), []
    for index in range(4 if model is None else 20):
        (row,) = task.rows([index])
        assert row["status"] == "ok"
        counts.append(living() - before)
    assert {*counts} == {counts[0]}
    del task
    assert living() == before
