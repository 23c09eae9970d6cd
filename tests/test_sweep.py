"""Sweeps from scene to file: rows against separate runs, refusals, resuming, interruption,
processes.
"""

import json
import sqlite3
from contextlib import closing

import numpy as np
import pytest

import solidgear as sg
from solidgear.core.errors import SolidgearError
from solidgear.core.scene.bearing_stiffness import STIFFNESS_NAMES
from solidgear.variants.sweep import bearing_task as runner
from solidgear.variants.sweep.bearing_task import ENTRIES, BearingTask, bearing_task
from solidgear.variants.sweep.bearing_variants import bearing_variants
from solidgear.variants.sweep.file_task import run
from solidgear.variants.sweep.rows import RowFile
from tests.command import command, numbers
from tests.counted import from_the_start

PATH = from_the_start("geometry/pinion_overhung.toml")
VARY = [
    "bearing.2.position=0.21,0.2246,0.9,0.246",
    "bearing.1.kzz=log:8e9:1e11:3",
    "bearing.2.scale=0.1,1,-1",
]
LIGHT = {"timoshenko": {"elements": 40}, "harmonic": {"order": 2, "layers": 1}}


def light(out, model="timoshenko", vary=VARY, sample=None, n=6, tolerance=1e-6, **rest):
    variants = bearing_variants(PATH, vary, sample)
    task = bearing_task(variants, model=model, options=LIGHT[model], n=n, tolerance=tolerance)
    return run(task, out, **rest)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    path = tmp_path_factory.mktemp("sweep") / "rows.csv"
    return path, light(path)


@pytest.mark.parametrize("fidelity", LIGHT)
def test_every_row_is_what_a_separate_run_on_the_same_mesh_gives(fidelity, tmp_path):
    summary = light(tmp_path / "rows.csv", fidelity)
    rows, variants = numbers(tmp_path / "rows.csv"), bearing_variants(PATH, VARY)
    assert len(rows) == summary.total == 36
    body = sg.build(variants.shaft(), fidelity, **LIGHT[fidelity])
    solved = [row for row in rows if row["status"] == "ok"]
    assert {row["how"] for row in solved} == {"reduced"} and summary.full == 0
    assert summary.refused == 36 - len(solved) == 9 + 9
    for row in solved[::3]:
        scene, supports = variants.supports(int(row["variant"]))
        static, modes = sg.condense(body, supports, "pinion"), sg.modes(body, supports, 6)
        for kind, matrix in (("K", static.stiffness), ("C", static.compliance)):
            for name, at in ENTRIES.items():
                got = row[f"{kind}_{name}"]
                assert (
                    got == ""
                    if np.isnan(matrix[at])
                    else got == pytest.approx(matrix[at], rel=1e-9)
                )
        direct = [
            (m.frequency_hz, m.name)
            for m in modes.modes
            if m.frequency_hz > 0
            for _ in range(m.multiplicity)
        ][:6]
        np.testing.assert_allclose(
            [row[f"f{k}_hz"] for k in range(1, 7)],
            [f for f, _ in direct],
            rtol=row["reduction_bound"] + modes.evidence["residual"] + 1e-9,
        )
        assert [row[f"mode{k}"] for k in range(1, 7)] == [name for _, name in direct]
        assert row["rigid_modes"] == modes.evidence["rigid_modes"] == 1
        assert row["K_z,thx"] == pytest.approx(static.stiffness[2, 3], rel=1e-9) and row[
            "C_thz"
        ] == pytest.approx(static.compliance[5, 5], rel=1e-9)
        # and the scene is the one the row names
        assert scene.bearings[1].y == row["bearing.2.position"]


def test_a_seat_meshed_for_others_changes_little(tmp_path):
    """A separate run on its own mesh differs by the mesh error alone, below 1e-3 for this light
    one.
    """
    light(tmp_path / "rows.csv", "harmonic", ["bearing.2.position=0.21,0.2246,0.246"])
    for row in numbers(tmp_path / "rows.csv"):
        scene = bearing_variants(
            PATH, [f"bearing.2.position={row['bearing.2.position']!r}"]
        ).variant(0)
        own = (
            sg.modes(sg.build(scene, "harmonic", order=2, layers=1), scene, 6)
            .named("bending 1")
            .frequency_hz
        )
        swept = next(row[f"f{k}_hz"] for k in range(1, 7) if row[f"mode{k}"] == "bending 1")
        assert swept == pytest.approx(own, rel=1e-3)


def test_refused_variants_are_rows_that_say_why(finished):
    rows = numbers(finished[0])
    for row in rows:
        outside, negative = row["bearing.2.position"] == 0.9, row["bearing.2.scale"] == -1
        if outside:
            assert row["status"].startswith('bearing[2] "2".')
            assert "inside the shaft" in row["status"]
        elif negative:
            assert 'bearing[2] "2".scale' in row["status"] and "greater than zero" in row["status"]
        else:
            assert row["status"] == "ok"
        assert (row["f1_hz"] == "") == (row["status"] != "ok")


def test_bearings_of_no_stiffness_leave_the_shaft_free(tmp_path):
    light(
        tmp_path / "rows.csv", vary=[f"bearing.{b}.{e}=0" for b in (1, 2) for e in STIFFNESS_NAMES]
    )
    (row,) = numbers(tmp_path / "rows.csv")
    assert row["status"] == "ok" and row["rigid_modes"] == 6
    assert [row[f"K_{name}"] for name in ENTRIES] == [0.0] * 8 and row["C_zz"] == ""
    free = sg.modes(sg.build(sg.load(PATH), "timoshenko", elements=40), (), 6)
    assert row["f1_hz"] == pytest.approx(free.frequency_hz[free.frequency_hz > 0][0], rel=1e-6)


@pytest.mark.long
def test_the_basis_grows_when_it_must_and_the_rest_is_solved_in_full(tmp_path, monkeypatch):
    vary = ["bearing.1.scale=1,2"]
    monkeypatch.setattr(runner, "LEVELS", runner.LEVELS[:1])
    strict = light(tmp_path / "strict.csv", "harmonic", vary, tolerance=1e-13)
    assert strict.full == 2
    rows, loose = numbers(tmp_path / "strict.csv"), light(tmp_path / "loose.csv", "harmonic", vary)
    assert loose.full == 0 and {row["how"] for row in rows} == {"full"}
    for a, b in zip(rows, numbers(tmp_path / "loose.csv")):
        assert [a[f"mode{k}"] for k in range(1, 7)] == [b[f"mode{k}"] for k in range(1, 7)]
        np.testing.assert_allclose(
            [a[f"f{k}_hz"] for k in range(1, 7)], [b[f"f{k}_hz"] for k in range(1, 7)], rtol=1e-7
        )
    monkeypatch.undo()
    bound = max(row["reduction_bound"] for row in numbers(tmp_path / "loose.csv"))
    grown = light(tmp_path / "grown.csv", "harmonic", vary, tolerance=bound / 10)
    assert grown.full == 0 and grown.basis > loose.basis
    assert max(row["reduction_bound"] for row in numbers(tmp_path / "grown.csv")) <= bound / 10
    # nor does it take probes for it: a weak row enlarges the basis on the way
    monkeypatch.setattr(BearingTask, "_enlarge_for", lambda self, probes: None)
    assert light(tmp_path / "late.csv", "harmonic", vary, tolerance=bound / 10).basis == grown.basis
    assert numbers(tmp_path / "late.csv") == numbers(tmp_path / "grown.csv")


def test_a_row_does_not_depend_on_those_solved_before_it(tmp_path, monkeypatch):
    """One variant needs a larger basis; those after it are the same if the sweep stopped there."""
    monkeypatch.setattr(runner, "PROBES", 2)  # variants 0 and 4 of 8
    vary = ["bearing.1.scale=0.01,0.011,0.012,100,0.013,0.014,0.015,0.016"]
    light(tmp_path / "loose.csv", vary=vary)
    bounds = [row["reduction_bound"] for row in numbers(tmp_path / "loose.csv")]
    stiff = bounds.pop(3)
    tolerance = (max(bounds) * stiff) ** 0.5
    assert max(bounds) < tolerance / 3 < tolerance < stiff / 3  # clear of rounding
    whole = light(tmp_path / "whole.csv", vary=vary, tolerance=tolerance)
    with pytest.raises(KeyboardInterrupt):
        light(tmp_path / "stopped.csv", vary=vary, tolerance=tolerance, progress=stop_after(4))
    rest = light(tmp_path / "stopped.csv", vary=vary, tolerance=tolerance)
    assert 4 <= rest.skipped < 8 and rest.basis < whole.basis and whole.full == 0
    assert (tmp_path / "stopped.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()


# ------------------------------------------------------------------------------------------------- the file
def stop_after(rows):
    def progress(done, total, text):
        if done >= rows:
            raise KeyboardInterrupt

    return progress


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_an_interrupted_sweep_goes_on_where_it_stopped(suffix, tmp_path, finished, monkeypatch):
    if suffix == "parquet":
        pytest.importorskip("pyarrow")
    out = tmp_path / f"rows.{suffix}"
    with pytest.raises(KeyboardInterrupt):
        light(out, progress=stop_after(9))
    kept = numbers_in_store(out)
    assert 9 <= len(kept) < 36
    # a CSV file has them as well, a Parquet file is made when all are there
    if suffix == "csv":
        assert [int(row["variant"]) for row in numbers(out)] == kept
    else:
        assert not out.exists()
    solved = []
    monkeypatch.setattr(BearingTask, "rows", _counting(BearingTask.rows, solved))
    summary = light(out)
    assert summary.skipped == len(kept) and not set(kept) & set(solved)
    if suffix == "csv":
        assert numbers(out) == numbers(finished[0])
    else:
        import pyarrow.parquet as pq

        table = pq.read_table(out)
        assert table.num_rows == 36
        for got, row in zip(table.to_pylist(), numbers(finished[0])):
            assert {k: "" if v is None else v for k, v in got.items()} == row
    # there is nothing left to do, and nothing is built for it
    monkeypatch.setattr(runner, "reduce", None)
    assert light(out).skipped == 36


def numbers_in_store(out):
    with closing(sqlite3.connect(f"{out}.sqlite")) as db:
        return [number for (number,) in db.execute("SELECT variant FROM rows ORDER BY variant")]


def _counting(rows, solved):
    def counted(self, indices):
        solved.extend(indices)
        return rows(self, indices)

    return counted


def test_rows_of_another_sweep_are_never_mixed(finished, tmp_path):
    out = tmp_path / "rows.csv"
    light(out, vary=["bearing.1.scale=1,2"])
    before = out.read_text()
    for other, word in (
        ({"vary": ["bearing.1.scale=1,3"]}, "vary"),
        ({"vary": ["bearing.1.scale=1,2"], "n": 5}, "n"),
        ({"vary": ["bearing.1.scale=1,2"], "model": "harmonic"}, "fidelity, set"),
        ({"vary": ["bearing.1.scale=1,2"], "sample": 2}, "sample"),
    ):
        with pytest.raises(
            SolidgearError, match=rf"another sweep \(it differs in: {word}\).*`overwrite`"
        ):
            light(out, **other)
        assert out.read_text() == before
    moved = tmp_path / "moved.toml"
    first = repr(sg.load(PATH).bearings[0].y)
    moved.write_text(PATH.read_text().replace(f"position = {first}", "position = 0.1"))
    with pytest.raises(SolidgearError, match="differs in: scene"):
        variants = bearing_variants(moved, ["bearing.1.scale=1,2"])
        run(bearing_task(variants, model="timoshenko", options=LIGHT["timoshenko"], n=6), out)
    light(out, vary=["bearing.1.scale=1,3,4"], overwrite=True)
    assert len(numbers(out)) == 3
    (tmp_path / "rows.csv.sqlite").unlink()
    with pytest.raises(SolidgearError, match="not from this sweep"):
        light(out, vary=["bearing.1.scale=1,3,4"])


def test_a_file_that_cannot_be_is_refused_before_anything_is_solved(tmp_path, monkeypatch):
    monkeypatch.setattr(runner, "reduce", None)
    with pytest.raises(SolidgearError, match=r"must end in .csv or .parquet"):
        light(tmp_path / "rows.xlsx")
    (tmp_path / "file").write_text("")
    with pytest.raises(SolidgearError, match="cannot be written"):
        light(tmp_path / "file" / "rows.csv")


def test_too_many_seats_are_refused_with_the_number(tmp_path):
    with pytest.raises(SolidgearError, match="different seats are more than the"):
        light(tmp_path / "rows.csv", vary=["bearing.2.position=0.2:0.246:400"])
    with pytest.raises(SolidgearError, match="cannot be rigid"):
        options = {"attachments": ("rigid", "average")}
        variants = bearing_variants(PATH, VARY)
        run(bearing_task(variants, model="timoshenko", options=options), tmp_path / "r.csv")


# ------------------------------------------------------------------------------------------------- who works
def test_two_processes_give_the_rows_of_one(finished, tmp_path):
    pytest.importorskip("joblib")
    light(tmp_path / "rows.csv", jobs=2)
    assert (tmp_path / "rows.csv").read_text() == finished[0].read_text()


@pytest.mark.long
def test_workers_get_the_small_operators_only(monkeypatch):
    import pickle

    from solidgear.core.reduction.moments import reduce

    variants = bearing_variants(PATH, VARY)
    body = sg.build(variants.shaft(), "harmonic", order=4, layers=2)
    task = bearing_task(variants, model="harmonic", n=6)
    task.body, task.bases = body, (reduce(body, 6),)
    mesh = sum(b.stiffness.data.nbytes for b in body.blocks[:1])
    assert len(pickle.dumps(task)) < 150_000 < mesh / 10


@pytest.mark.slow
def test_a_dask_cluster_gives_the_rows_of_one_process(finished, tmp_path):
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster:
        light(tmp_path / "rows.csv", dask=cluster.scheduler_address)
    assert (tmp_path / "rows.csv").read_text() == finished[0].read_text()


def test_missing_packages_are_named(tmp_path, monkeypatch):
    import sys

    for name, rest, word in (
        ("joblib", {"jobs": 2}, "joblib"),
        ("distributed", {"dask": "tcp://127.0.0.1:1"}, "Dask"),
        ("pyarrow", {}, "pyarrow"),
    ):
        monkeypatch.setitem(sys.modules, name, None)
        with pytest.raises(SolidgearError, match=f"{word}.*pip install 'solidgear"):
            light(tmp_path / "rows.parquet", **rest)
    assert not list(tmp_path.iterdir())


# ------------------------------------------------------------------------------------------------- the command
def call(*arguments):
    light = "-f timoshenko --set elements=40 -n 6".split()
    return command("sweep", PATH, *light, *arguments)


def test_the_command(finished, tmp_path):
    vary = [part for text in VARY for part in ("--vary", text)]
    done = call(*vary, "--out", str(tmp_path / "rows.csv"), "--json")
    assert done.exit_code == 0, done.output
    assert json.loads(done.stdout)["refused"] == 18
    assert (tmp_path / "rows.csv").read_text() == finished[0].read_text()
    again = call(*vary, "--out", str(tmp_path / "rows.csv"))
    assert "all 36 rows were there already" in " ".join(again.stdout.split())


@pytest.mark.long
def test_the_command_keeps_what_is_done_when_interrupted(tmp_path, monkeypatch):
    appended = RowFile.append

    def once(self, rows):
        if self.done:
            raise KeyboardInterrupt
        appended(self, rows)

    monkeypatch.setattr(RowFile, "append", once)
    stopped = call("--vary", "bearing.1.scale=1:2:40", "--out", str(tmp_path / "rows.csv"))
    kept = len(numbers(tmp_path / "rows.csv"))
    assert stopped.exit_code == 130 and 0 < kept < 40
    assert f"{kept} of 40 rows are kept" in stopped.stderr
    monkeypatch.undo()
    assert (
        call("--vary", "bearing.1.scale=1:2:40", "--out", str(tmp_path / "rows.csv")).exit_code == 0
    )
    assert [row["variant"] for row in numbers(tmp_path / "rows.csv")] == list(range(40))


def test_bad_options_of_the_command_end_in_a_sentence(tmp_path):
    for arguments in (
        ("--set", "colour=red"),
        ("--set", "attachments=5"),
        ("--sample", "0"),
        ("--tolerance", "2"),
        ("--jobs", "0"),
        ("--jobs", "1000000"),
        ("-n", "0"),
        ("-n", "1000000000"),
    ):
        failed = call(
            "--vary", "bearing.1.scale=1,2", "--out", str(tmp_path / "rows.csv"), *arguments
        )
        assert failed.exit_code == 1 and isinstance(failed.exception, SolidgearError), arguments
    # nothing is left that would be in the way of the right command
    assert not list(tmp_path.iterdir())
