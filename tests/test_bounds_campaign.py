"""The campaign that judges error bars: its arithmetic, its tables, its partners of modes and its
bodies.
"""

import json

import pytest

from solidgear.ladder import build
from solidgear.scene import Scene
from validation.attack.reference import Reference
from validation.bounds import __main__ as command
from validation.bounds import campaign, jobs, table
from validation.bounds.bodies import BODIES
from validation.bounds.campaign import Campaign, goals_of, rows_in
from validation.bounds.judging import COUPLING, MODE, STATIC, Answer, judged, kind_of, row_of
from validation.bounds.truths import Kept, Truth, name_of, read, truth_of, write


def _row(error=1e-3, bar=2e-3, doubt=1e-6, side="both", tolerance=1e-2, quantity="C_zz", **rest):
    value = 2.0
    truth = None if error is None else Truth(value - error * value, doubt, value, "made up")
    known = {"body": "bar", "scene": "s", "seconds": 1.5, "unknowns": 100, "reached": True} | rest
    return judged(Answer(quantity, value, bar, value, side), truth, tolerance=tolerance, **known)


def _mode(name, hz, turn=1.0):
    motions = [[[1.0, 0, 0, 0, 0, 0], [turn, 0, 0, 0, 0, 0]]]
    told = {"name": name, "family": name.split()[0], "frequency_hz": hz, "multiplicity": 1}
    return told | {"motions": motions, "uncertainty": 1e-6}


def _reference(**changes):
    values = {"C_zz": 1.0, "C_thx": 4.0, "C_z,thx": 0.1}
    modes = [_mode("bending 1", 100.0), _mode("bending 2", 102.0, -1.0), _mode("axial 1", 900.0)]
    gram = [[float(i == j) for j in range(12)] for i in range(12)]
    rest = {"setting": [5, 6], "unknowns": 1, "seconds": 0.0}
    given = {"values": values, "uncertainty": dict.fromkeys(values, 1e-6), "modes": modes}
    return Reference(**(given | {"gram": gram} | rest | changes))


# ------------------------------------------------------------------------------------------------
# - judgement
@pytest.mark.parametrize(
    "error, bar, doubt, held",
    [
        (1e-3, 2e-3, 1e-6, True),
        (-1e-3, 2e-3, 1e-6, True),
        (1e-3, 5e-4, 1e-6, False),
        (-1e-3, 5e-4, 1e-6, False),
        (1e-3, 9.9e-4, 2e-5, True),  # may be within: benefit of the doubt
        (5e-8, 1e-9, 0.0, None),  # rounding
        (1e-3, 1e-4, 5e-4, None),  # not known
        (None, 1e-3, 0.0, None),
    ],
)
def test_a_bar_holds_or_not(error, bar, doubt, held):
    row = _row(error, bar, doubt)
    assert row.held is held and row.judged is (held is not None)
    assert row.ratio == (pytest.approx(bar / abs(error)) if row.judged else None)


def test_a_number_is_beyond_the_tolerance_whatever_its_bar_says():
    told, honest = _row(2e-2, bar=5e-3), _row(2e-2, bar=3e-2)
    assert told.beyond and told.promised and not told.held
    assert honest.beyond and not honest.promised and honest.held
    assert not _row(1.01e-2, doubt=1e-3).beyond


def test_the_exact_answer_lies_on_the_side_that_was_told():
    # the value is too large: the exact answer lies below
    assert _row(1e-3, side="above").wrong_side
    assert not _row(1e-3, side="below").wrong_side and not _row(1e-3).wrong_side
    assert _row(-1e-3, side="below").wrong_side


def test_kinds_of_quantities():
    assert [kind_of(q) for q in ("C_zz", "K_thx", "C_thy", "C_zz@gear")] == [STATIC] * 4
    assert [kind_of(q) for q in ("C_z,thx", "C_zz@p@gear")] == [COUPLING] * 2
    assert kind_of("torsion 1") == MODE


def test_references_are_refined_for_what_is_not_known():
    rows = [_row(1e-4, doubt=1e-4), _row(1e-3, doubt=1e-4, quantity="C_yy"), _row(None)]
    assert goals_of(rows) == {"C_zz": pytest.approx(3e-5)}
    assert not goals_of([_row(1e-9, doubt=1e-9)])
    # one that seems to be missed is made sure of
    held, missed = _row(1e-3, doubt=1e-4), _row(1e-3, bar=1e-4, doubt=1e-4)
    assert not goals_of([held]) and goals_of([missed]) == {"C_zz": pytest.approx(3e-5)}


# ------------------------------------------------------------------------------------------------
# - truth
def test_couplings_are_related_to_their_diagonals():
    assert truth_of("C_z,thx", 0.1, {"spectral": _reference()}).size == pytest.approx(2.0)
    assert truth_of("C_thy", 0.1, {"spectral": _reference()}) is None


def test_references_that_contradict_each_other_are_not_believed():
    better = _reference(uncertainty=dict.fromkeys(("C_zz", "C_thx", "C_z,thx"), 1e-9))
    near = {"spectral": _reference(), "product": better}
    assert truth_of("C_zz", 1.0, near).how == "product"
    far = _reference(values={"C_zz": 1.1, "C_thx": 4.0, "C_z,thx": 0.1})
    assert truth_of("C_zz", 1.0, {"spectral": far, "product": better}) is None
    assert truth_of("C_thx", 4.0, {"spectral": far, "product": better}) is not None


def test_a_finer_level_counts_unless_it_drowns_in_rounding():
    def level(value, doubt):
        return _reference(values={"C_thx": value}, uncertainty={"C_thx": doubt})

    coarse, fine, drowned = level(1.1, 1e-7), level(1.0, 5e-7), level(2.0, 0.3)
    both = {"spectral 1": fine, "spectral 0": coarse}
    assert truth_of("C_thx", 1.0, both).value == 1.0
    assert truth_of("C_thx", 1.0, both | {"spectral 2": drowned}).value == 1.0


def test_modes_near_each_other_are_paired_by_shape():
    found = {"spectral": _reference()}
    # alone: by name, without a shape
    assert truth_of("axial 1", 901.0, found, shape=pytest.fail).how == "spectral, by name"
    swapped = truth_of("bending 1", 101.0, found, lambda: _mode("bending 1", 101.0, -1.0))
    assert swapped.value == 102.0 and "there called bending 2" in swapped.how
    assert truth_of("bending 1", 101.0, found, lambda: None) is None
    # one reference has no shapes, and no other mode is near
    apart = [_mode("bending 1", 100.0), _mode("axial 1", 101.0)]
    plain = {"triangles": _reference(modes=apart, gram=[])}
    assert truth_of("bending 1", 100.2, plain).value == 100.0
    assert truth_of("bending 1", 101.0, {"triangles": _reference(gram=[])}) is None


def test_the_answered_mode_is_the_nearest_of_its_family():
    modes = [_mode("bending 1", 100.0), _mode("bending 2", 104.0), _mode("axial 1", 103.0)]
    assert jobs.shape_of("bending 1", 103.0, modes)["frequency_hz"] == 104.0
    assert jobs.shape_of("bending 1", 300.0, modes) is None


def test_references_are_kept_under_what_a_scene_is(tmp_path):
    scene = BODIES["shoulder 3"].make()
    write(tmp_path, scene, Kept({"spectral 0": _reference()}, {"product": [180.0, 1e5]}))
    again = read(tmp_path, scene.with_changes(title="another"))
    assert again.references["spectral 0"] == _reference() and "product" in again.failed
    assert not read(tmp_path, BODIES["shoulder 1.2"].make()).references


# ------------------------------------------------------------------------------------------------
# - tables
def test_a_table_counts_what_was_judged():
    rows = [
        _row(1e-3, 2e-3),
        _row(1e-3, 4e-3, quantity="bending 1", tolerance=1e-3),
        _row(1e-3, 5e-4, tolerance=1e-4),
        _row(1e-9, 1e-3, 0.0),
        _row(None),
    ]
    lines = {line.split(" | ")[0].strip("| "): line for line in table.table(rows)}
    assert "| 5 | 3 | 1 | 1 | 66.7 % (2) | 0.5 |" in lines["all"]
    assert lines["all"].endswith("| 1 | 0 | 0 |")
    assert "100.0 % (1) | 4 |" in lines["mode"] and "0.0 % (0) | 0.5 |" in lines["at 0.0001"]
    assert table.misses(rows)[0].startswith("bar at 0.0001, C_zz: not held; bar 5.0e-04")
    assert table.unknown(rows) == ["bar: 1 (0 surely held, 1 without a true value)"]
    # an answer is counted once, whatever it has numbers
    assert "| 0.01 | 1 | 1.5 | 1.50 | 1.5 | 1 |" in table.seconds(rows)


def test_rows_are_read_as_they_were_written(tmp_path):
    path, row = tmp_path / "rows.jsonl", _row()
    lines = [json.dumps(one.as_dict()) for one in (_row(bar=1.0), row)]
    path.write_text("\n".join([*lines, '{"body": "cut off']))
    # asked again: the last counts
    assert list(rows_in(path)) == [row] and row_of(row.as_dict()) == row
    assert {"held", "ratio", "beyond"} <= row.as_dict().keys()


# ------------------------------------------------------------------------------------------------
# - the whole
class _Told:
    """A worker that knows its answers."""

    def __init__(self, call, seconds):
        self.asked = []

    def run(self, job, *arguments):
        self.asked.append((job, arguments[0]))
        if job == "ask":
            if arguments[0] == "groove 1 mm":
                return {"crash": "timeout after 1 s"}
            value = {"quantity": "C_zz", "value": 1.001, "bar": 2e-3, "size": 1.0, "side": "both"}
            told = {"options": {}, "unknowns": 7, "seconds": 0.5, "reached": True}
            return {"values": [value], "rung": "harmonic"} | told
        return {"found": _reference().__dict__}

    def close(self):
        pass


def test_a_campaign_goes_on_after_a_hang_and_where_it_was(tmp_path, monkeypatch):
    monkeypatch.setattr(campaign, "Worker", _Told)
    names, told = ["shoulder 3", "groove 1 mm", "nowhere.toml", "shoulder 1.2"], []
    first = Campaign(folder=tmp_path, tell=told.append)
    rows = first.run(names)
    assert [row.body for row in rows] == ["shoulder 3"] * 2 + ["shoulder 1.2"] * 2
    assert all(row.held and row.error == pytest.approx(1e-3) for row in rows)
    assert len(first.problems) == 3 and "timeout" in first.problems[0]
    second = Campaign(folder=tmp_path, tell=told.append)
    assert second.run(["shoulder 3"]) == rows[:2] and not second.worker.asked
    # references are kept apart from rows
    third = Campaign(folder=tmp_path, tell=told.append, again=True)
    third.run(["shoulder 3"])
    assert {job for job, _ in third.worker.asked} == {"ask"}


def test_the_command_writes_its_page(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(campaign, "Worker", _Told)
    page = tmp_path / "table.md"
    given = ["--words", "shoulder 3", "--folder", str(tmp_path), "--write", "--page", str(page)]
    assert command.main(given) == 0
    assert "1 drawn bodies; tolerances 0.01, 0.001." in page.read_text()
    assert "100.0 % (2)" in page.read_text() and "Slowest" in capsys.readouterr().out
    costs = ["--costs", "--seeds", "1", "3", "--tolerance", "1e-4", "--folder", str(tmp_path)]
    assert command.main(costs) == 0
    assert "| 0.0001 | 3 | 1.5 |" in capsys.readouterr().out


@pytest.mark.parametrize("name", BODIES)
def test_every_drawn_body_is_a_scene_that_can_be_meshed(name):
    scene = BODIES[name].make()
    assert isinstance(scene, Scene) and BODIES[name].reason
    assert not jobs.strange(scene) and len(name_of(scene)) == 20
    body = build(scene, "harmonic", order=1, layers=0, edge_layers=0, families=("torsion",))
    assert body.size > 0


def test_a_coarse_answer_of_a_drawn_body(tmp_path):
    found = jobs.run("ask", "free shaft", 0.1)
    assert {v["quantity"] for v in found["values"]} >= {"bending 1", "axial 1", "torsion 1"}
    assert "C_zz" in found["missing"] and found["rung"] == "harmonic"
    modes = jobs.run("shapes", "free shaft", found["options"])["modes"]
    hz = next(v["value"] for v in found["values"] if v["quantity"] == "bending 1")
    assert jobs.shape_of("bending 1", hz, modes)["frequency_hz"] == pytest.approx(hz, rel=1e-9)
    assert "refused" in jobs.run("ask", "free shaft", 2.0)
