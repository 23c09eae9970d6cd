"""Sweeps that cost nothing, to do harm to: synthetic rows, and a dozen of a light beam."""

import os
import tempfile
from pathlib import Path

import pytest

from solidgear.variants.sweep.bearing_task import bearing_task
from solidgear.variants.sweep.bearing_variants import bearing_variants
from solidgear.variants.sweep.file_task import run
from solidgear.variants.sweep.rows import RowFile
from tests.command import command

SCENE = "geometry/pinion_overhung.toml"
VARY = "bearing.1.scale=log:0.1:10:12"
COLUMNS = {"variant": int, "status": str, "f1_hz": float, "mode1": str}
PLAN = {"vary": "synthetic", "n": 1}
TOTAL = 120


def row(number):
    """A row that costs nothing: long enough for the rows to fill several pages of a database."""
    return {
        "variant": number,
        "status": "ok" if number % 7 else f"bearing {number}: " + "refused, " * 40,
        "f1_hz": 1000 / (number + 3) if number % 7 else None,
        "mode1": f"bending {number % 5}",
    }


def write(out, upto=TOTAL, batch=30, plan=PLAN, **rest):
    """Run a synthetic sweep; the numbers it solved."""
    solved = []
    with RowFile(out, COLUMNS, plan, TOTAL, **rest) as file:
        todo = [i for i in range(TOTAL) if i not in file.done]
        for k in range(0, len(todo), batch):
            if todo[k] >= upto:
                raise KeyboardInterrupt
            file.append(map(row, todo[k : k + batch]))
            solved += todo[k : k + batch]
        file.finish()
    return solved


def stop(out, upto):
    with pytest.raises(KeyboardInterrupt):
        write(out, upto)


def one_sentence(error):
    text = str(error)
    return "\n" not in text and len(text) > 20 and "Error(" not in text and "Traceback" not in text


@pytest.fixture
def tmp_path():
    """Folder in memory where there is one: hundreds of small files are synced to the disk here."""
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(dir=memory) as folder:
        yield Path(folder)


@pytest.fixture(scope="module")
def right(tmp_path_factory):
    """Bytes of the file of an undisturbed run."""
    out = tmp_path_factory.mktemp("right") / "rows.csv"
    write(out)
    return out.read_bytes()


def light(out, **rest):
    variants = bearing_variants(SCENE, [VARY])
    task = bearing_task(variants, model="timoshenko", options={"elements": 40}, n=4)
    return run(task, out, **rest)


def call(out, *more):
    light = "-f timoshenko --set elements=40 -n 4".split()
    return command("sweep", SCENE, *light, "--vary", VARY, "--out", out, *more)
