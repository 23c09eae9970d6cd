"""A path, its tables and an object are one thing: every study gives the same numbers for each."""

import copy
import inspect
import pickle
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.scene.document import Document, document_of, is_train
from solidgear.variants.sweep.design import Design
from solidgear.variants.sweep.train_task import train_task
from solidgear.variants.sweep.train_variants import train_variants

GEOMETRY = Path(__file__).parent.parent / "geometry"
SHAFT = GEOMETRY / "gearbox_catalogue.toml"
TRAIN = GEOMETRY / "gearbox_train.toml"
DIAMETER = "segment.3.diameter=40 mm,41 mm"
BEAMS = {"pinion": "timoshenko", "gear": "timoshenko"}
ROD = {
    "material": "steel",
    "port": {"attach_to": "rod", "at": "rod.middle"},
    "segment": [{"kind": "cylinder", "name": "rod", "length": 0.6, "diameter": 0.02}],
}


def sources(path):
    """The same shaft or train as a path, tables of a file, an object and tables of an object."""
    thing = sg.load_train(path) if is_train(path) else sg.load(path)
    tables = tomllib.loads(path.read_text(encoding="utf-8"))
    if is_train(path):  # names of files are relative to the folder of work
        for side in ("pinion", "gear"):
            tables[side]["scene"] = str(path.parent / tables[side]["scene"])
    return {"path": path, "tables": tables, "object": thing, "its tables": thing.to_dict()}


OF_SHAFT = {
    "answer": lambda s: sg.answer(s, "5 %", ["C_zz"])["C_zz"],
    "sweep": lambda s: sg.sweep(s, DIAMETER, model="timoshenko", n=1)["f1_hz"],
    "optimise": lambda s: (
        sg.optimise(
            s, ["segment.3.diameter=40 mm:41 mm"], "min C_zz", model="timoshenko"
        ).best.value
    ),
    "sensitivities": lambda s: [
        d.elasticity
        for d in sg.sensitivities(s, "timoshenko", ["bending 1"], ["material.E"]).of[0].derivatives
    ],
    "deflect": lambda s: sg.deflect(s, "timoshenko").judge.shafts[0].bearings[0].load,
    "stress": lambda s: sg.stress(s, "timoshenko").shafts[0].found.forces.largest_moment,
    "bearing": lambda s: [fact.life.life.basic for fact in sg.bearing(s).facts],
    "compare": lambda s: list(sg.compare(s, ("euler",)).solutions["euler"].quantities.values()),
}
OF_TRAIN = {
    "sweep": lambda s: sg.sweep(
        s, "mesh.stiffness=3e8,3.2e8", models=BEAMS, ask=["system-modes"], n=3, max_frequency=900.0
    )["f3_hz"],
    "a shaft of it": lambda s: sg.sweep(
        s,
        "pinion.material.E=200 GPa,210 GPa",
        models=BEAMS,
        ask=["system-modes"],
        n=1,
        max_frequency=300.0,
    )["f1_hz"],
    "system_modes": lambda s: sg.system_modes(s, "euler", max_frequency=900.0).frequency_hz,
    "response": lambda s: sg.response(s, "euler", max_frequency=300.0).responses[0].force,
    "receptance": lambda s: (
        sg.receptance(s, "gear.wheel:z", "pinion.pinion:z", "euler", max_frequency=300.0)
        .receptances[0]
        .value
    ),
    "deflect": lambda s: [m.value for m in sg.deflect(s, "euler").judge.misalignment],
    "bearing": lambda s: [life.name for life in sg.bearing(s).lives],
}


#: a second and more each
DEAR = {
    *("answer", "sweep", "stress", "response"),
    *("sweep of a train", "a shaft of it"),
}


#: many seconds: studies beside it guard the way of files, and other tests the study
DEAREST = {"compare", "optimise", "deflect", "receptance", "bearing of a train"}


def mark_of(names):
    """When a study of any of these names is run."""
    if names & DEAREST:
        return pytest.mark.slow
    return pytest.mark.long if names & DEAR else ()


def named(studies, kind=""):
    """Studies by name, the dear ones for whoever asks for them."""
    return [pytest.param(name, marks=mark_of({name, name + kind})) for name in studies]


@pytest.mark.parametrize("study", named(OF_SHAFT))
def test_a_study_of_a_shaft_takes_a_path_tables_or_a_scene(study):
    path, *others = [OF_SHAFT[study](source) for source in sources(SHAFT).values()]
    assert np.size(path) and np.all(np.isfinite(path))
    for other in others:
        np.testing.assert_allclose(other, path, rtol=1e-9)


@pytest.mark.parametrize("study", named(OF_TRAIN, " of a train"))
def test_a_study_of_a_train_takes_a_path_tables_or_a_train(study):
    path, *others = [OF_TRAIN[study](source) for source in sources(TRAIN).values()]
    assert len(path)
    for other in others:
        if isinstance(path[0], str):
            assert other == path
        else:
            np.testing.assert_allclose(other, path, rtol=1e-7)


def test_an_object_that_was_read_has_the_places_of_its_file_until_it_changes():
    scene, longer = sg.load(SHAFT), "segment.pinion.length=52 mm"
    of_file, as_read, changed = (
        sg.sweep(source, longer, model="timoshenko", n=1)["C_zz"][0]
        for source in (SHAFT, scene, scene.with_changes(title="changed"))
    )
    # the port stays in the middle of its segment, or where it is
    assert as_read == of_file and abs(changed / of_file - 1) > 1e-3


def test_studies_leave_tables_as_they_are():
    tables = sg.load_train(GEOMETRY / "gearbox_two_stage.toml").to_dict()
    before = copy.deepcopy(tables)
    train_variants(tables, Design(("input.material.E=200 GPa,210 GPa",)))
    sg.compare(ROD, {**ROD, "title": "another"})
    assert tables == before


def test_rows_are_solved_in_another_process():
    tables = sg.load_train(TRAIN).to_dict()
    design = Design(("gear.material.E=200 GPa,210 GPa",))
    how = {"models": BEAMS, "ask": ["system-modes"], "n": 2, "max_frequency": 300.0}
    task = train_task(tables, design, **how)
    there = pickle.loads(pickle.dumps(task)).rows([0, 1])
    assert there == task.rows([0, 1]) and there[0]["status"] == "ok"
    # a database of rows tells one sweep from another by the tables
    others = copy.deepcopy(tables)
    others["shaft"]["gear"]["scene"]["material"]["nu"] = 0.25
    assert train_task(others, design, **how).plan != task.plan


def test_what_is_no_document_is_refused_in_a_sentence():
    with pytest.raises(sg.SolidgearError, match="3: give the path of a TOML file, its tables"):
        sg.answer(3)
    with pytest.raises(sg.SceneError, match='^scene: segment.1. "rod".length'):
        sg.answer({**ROD, "segment": [{**ROD["segment"][0], "length": "-3 mm"}]})
    with pytest.raises(sg.SceneError, match="read it with solidgear.load_train"):
        sg.load(sg.load_train(TRAIN).to_dict())
    assert document_of(Document({}, "here")).path == "here"


def test_results_print_and_write_what_their_commands_do(tmp_path):
    found = sg.deflect(SHAFT, ["euler", "timoshenko"])
    assert "timoshenko" in repr(found) and "<table" in found._repr_html_()
    written = {path.name for path in found.write(tmp_path / "out")}
    assert {"deflection.html", "deflection.json"} <= written
    with pytest.raises(sg.SolidgearError, match="units 'metric' are unknown"):
        found.write(tmp_path / "other", units="metric")
    assert not (tmp_path / "other").exists()


def test_every_study_says_that_it_takes_a_path_a_dict_or_an_object():
    studies = {
        *OF_SHAFT,
        *OF_TRAIN,
        "correlate",
        "identify",
        "check",
        "judge",
        "nonlinear",
        "contact",
    }
    for name in (studies & {*sg.__all__}) - {"receptance", "response", "nonlinear"}:
        first = inspect.getdoc(getattr(sg, name)).partition("Parameters\n----------\n")[2]
        assert re.match(r"\w+(, [\w*]+)* : path, dict( or|,) |train, models", first), name
