"""Races whose results are kept: what is read from commands, what pages show, what memory is counted."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from validation import common
from validation.race import checkouts, page, peers
from validation.race.checkouts import Number, numbers_in
from validation.race.heat import ERROR, Heat
from validation.race.process import Done, run

PRINTED = {
    "values": [{"quantity": "C_zz", "value": 2.0, "bar": 0.01, "size": 2.0}],
    "modes": [{"name": "bending 1", "frequency_hz": 50.0, "error": 1e-9}],
    "models": {"harmonic": {"compliance": (2 * np.eye(6)).tolist(), "seconds": {"value": None}}},
    "seconds": 3.0,
}
RECORD = {
    "date": "2026-11-27 05:00 UTC",
    "commit": "abc1234",
    "load before": 0.04,
    "machine": {
        "cpu": "A processor",
        "cores": 2,
        "memory_gb": 25.3,
        "system": "Debian",
        "mkl": "1",
    },
    "versions": {"CalculiX": "2.20"},
    "answers": [],
    "skipped": ["theirs: no licence"],
}


def lane(name, seconds=2.0, **more):
    row = {"lane": name, "median s": seconds, "min s": seconds / 2, "max s": 2 * seconds}
    return row | {"cpu s": 3.0, "note": "", "error": ""} | more


@pytest.fixture
def kept(tmp_path, monkeypatch):
    monkeypatch.setattr(common, "RESULTS", tmp_path)

    def keep(race, heat, **more):
        common.kept(race, {heat: RECORD | {"lanes": [], "ratios": []} | more})

    return keep


def test_numbers_of_a_command_are_named_by_what_they_belong_to():
    found = dict(numbers_in(PRINTED, in_units=False))
    assert found["/values/C_zz/value"] == Number(2.0, 0.02)
    assert found["/modes/bending 1/frequency_hz"] == Number(50.0)
    assert found["/models/harmonic/compliance/5"] == Number(2.0)
    # neither times nor evidence
    assert len(found) == 8
    # a bar of 0.01 of the unit of a number of 2
    of_deflections = dict(numbers_in(PRINTED, in_units=True))
    assert of_deflections["/values/C_zz/value"] == Number(2.0, 0.01)


def raced(monkeypatch, tmp_path, new):
    """Race a command whose numbers in another checkout are those of `PRINTED`."""
    told = []

    def ran(command, folder, *, extra, **more):
        told.append(extra["PYTHONPATH"])
        printed = PRINTED if extra["PYTHONPATH"] == str(tmp_path) else new
        return Done(4.0 if printed is PRINTED else 2.0, 3.0, json.dumps(printed), tree_mb=70.0)

    monkeypatch.setattr(checkouts, "run", ran)
    heat = Heat(against=tmp_path)
    checkouts.enter(heat, "answer shaft", ["answer", "shaft.toml", "--json"])
    heat.run(2)
    return told, heat.record()


def test_a_command_without_numbers_is_a_lane_that_failed(monkeypatch, tmp_path):
    monkeypatch.setattr(checkouts, "run", lambda *_, **__: Done(1.0, 1.0, "no such shaft"))
    heat = Heat()
    checkouts.enter(heat, "answer shaft", ["answer", "shaft.toml", "--json"])
    heat.run(1)
    assert heat.lanes[0].error == "answer printed no JSON: no such shaft"


def test_further_files_go_to_the_heats_that_take_them():
    shaft, train = checkouts.COMPARED[0], checkouts.GEOMETRY / "axle_straddle.toml"
    heat = Heat(scenes=(shaft, train))
    assert checkouts.further(heat, trains=False) == [shaft]
    assert checkouts.further(heat, trains=True) == [train]


def with_value(value):
    return PRINTED | {"values": [PRINTED["values"][0] | {"value": value}]}


def test_two_checkouts_run_in_turn_and_numbers_are_compared_first(monkeypatch, tmp_path):
    told, record = raced(monkeypatch, tmp_path, with_value(2.03))
    assert told == [str(tmp_path), str(checkouts.ROOT)] * 2
    (ratio,) = record["ratios"]
    assert ratio["measured"] == 2.0
    over, apart = record["answers"]
    # 1.5 % apart, both bars are 1 %
    assert over["largest difference"] == pytest.approx(0.75)
    assert apart["largest difference"] == pytest.approx(0.015)
    assert [row["peak_MB"] for row in record["lanes"]] == [70.0, 70.0]


def test_checkouts_whose_bars_do_not_meet_are_not_timed(monkeypatch, tmp_path):
    _, record = raced(monkeypatch, tmp_path, with_value(2.05))
    assert record["ratios"][0]["measured"] is None and "differ" in record["ratios"][0]["met"]


def test_memory_is_that_of_a_process_and_of_what_it_starts(tmp_path):
    hold = "import time; x = bytearray(60_000_000); time.sleep(0.4)"
    code = f"import subprocess, sys; subprocess.call([sys.executable, '-c', {hold!r}])"
    found = run([sys.executable, "-c", code], tmp_path, limit=60, tree=True)
    assert 60 < found.tree_mb < 120
    assert run([sys.executable, "-c", ""], tmp_path, limit=60).tree_mb == 0.0


def test_ratios_of_all_races_stand_with_what_they_were_run_with(kept):
    assert page.ratios() == page.NOTHING
    row = {"ratio": "theirs / ours", "measured": 12.345, "over rounds": "12 to 13"}
    row |= {"of processor seconds": 11.04}
    kept("peers", "mesh", ratios=[row, row | {"ratio": "missing", "measured": None}])
    text = page.ratios()
    assert (
        "| peers, mesh | theirs / ours | 12.3 | 12 to 13 | 11 |" in text and "missing" not in text
    )
    # two checkouts have a table of their own
    kept("commands", "answer", ratios=[row])
    assert page.ratios() == text
    assert (
        "- peers, mesh: 2026-11-27 05:00 UTC, commit abc1234, A processor, 2 cores, 25.3 GB, "
        "Debian, load 0.0 before, mkl 1, CalculiX 2.20" in text
    )


def test_lanes_stand_with_their_error_and_those_that_failed_with_the_reason(kept):
    lanes = [
        lane("ours", unknowns=4468.0, **{ERROR: 4.76e-4}),
        {"lane": "theirs", "note": "", "error": "error differ from ours by 2e-3"},
    ]
    kept("peers", "error", lanes=lanes)
    text = page.lanes("peers", "error")
    assert "| ours | 4,468 | 4.8e-04 | 2 | 1 to 4 | 3 |" in text
    assert "| theirs |  |  | error differ from ours by 2e-3 |" in text
    assert text.endswith("- not raced: theirs: no licence\n")


def test_large_solids_stand_beside_the_factor_alone(kept):
    facts = {"unknowns": 43998.0, "us an unknown": 180.7, "bytes an unknown": 12110.0}
    facts |= {"PARDISO's factor s": 0.9526, "times its factor": 8.344, "times its memory": 2.746}
    kept("solids", "sizes", lanes=[lane("TET10", **facts), {"lane": "more", "error": "no room"}])
    assert "| 43,998 | 2 | 181 | 12,100 | 0.953 | 8.34 | 2.75 |" in page.sizes()


def test_checkouts_stand_side_by_side(kept):
    lanes = [
        lane("compare a, other checkout", 4.0, peak_MB=500.0),
        lane("compare a", peak_MB=250.0),
    ]
    kept("commands", "compare", lanes=lanes)
    kept("commands", "main", lanes=[lane("import numpy")])
    text = page.checkouts()
    assert "| compare a | 4 | 2 | 3 | 3 | 500 | 250 |" in text and "numpy" not in text


@pytest.mark.parametrize("race", ["peers", "assembly", "sweep", "commands", "solids"])
def test_results_that_are_kept_name_no_place_and_no_computer(race):
    path = Path(common.__file__).parent / "results" / f"{race}.json"
    text = path.read_text() if path.exists() else ""
    assert not any(word in text for word in ("/work", "/home", "/tmp", "/root"))


def reference():
    compliance = np.diag([1.0, 2.0, 4.0, 9.0, 1.0, 1.0])
    compliance[2, 3] = compliance[3, 2] = 3.0
    error = object.__new__(peers.Error)
    error.target, error.compliance = 1e-3, compliance
    error.frequencies = {"bending 1": 100.0, "axial 1": 50.0}
    return error


def test_the_error_of_a_lane_is_the_largest_of_six_numbers():
    error = reference()
    numbers = {"C_zz": 4.0, "C_z,thx": 3.006, "C_thx": 9.0, "C_yy": 2.0}
    frequencies = {"bending 1": 100.0, "axial 1": 50.0}
    # a coupling over the root of both diagonal entries
    assert error.of_numbers(numbers | frequencies) == pytest.approx(1e-3)
    assert error.of_numbers(numbers | frequencies | {"axial 1": 50.1}) == pytest.approx(2e-3)
    assert error.of(error.compliance, frequencies | {"bending 1": 99.0}) == pytest.approx(0.01)


def test_the_mesh_that_is_known_to_do_is_the_coarsest_of_the_automatic_choice(monkeypatch):
    tried = []

    class Mesh:
        def __init__(self, options):
            tried.append(options)
            self.options, self.error = options, options / 10

    monkeypatch.setattr(peers, "mesh_of_answer", lambda scene, tol: tol)
    monkeypatch.setattr(peers.Known, "measured", lambda error, scene, model, options: Mesh(options))
    monkeypatch.setattr(peers, "say", lambda *_: None)
    assert peers.of_answers(Heat(), reference(), None).options == pytest.approx(1e-2)
    assert len(tried) == 1
    reference_of_less = reference()
    reference_of_less.target = 2e-4
    monkeypatch.setattr(
        peers.Known, "measured", lambda error, scene, model, options: Mesh(options + 1.52e-3)
    )
    assert peers.of_answers(Heat(), reference_of_less, None).options == pytest.approx(1.92e-3)
