"""Measurements in processes of their own, one thread each, and CalculiX on decks of the same mesh."""

from __future__ import annotations

import json
import statistics
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from validation.common import ROOT
from validation.peers import calculix
from validation.peers.process import PeerError, last_words, run
from validation.real_speed_accuracy.lines import CALCULIX, Job
from validation.real_speed_accuracy.measure import MODES

#: seconds that a measurement may take
LIMIT = 900.0
#: a measurement is repeated, up to so often, until so many processor seconds are spent
REPEATS, ENOUGH = 3, 5.0
#: relative difference of answers on the same mesh above which times mean nothing: CalculiX takes
#: fewer points of quadrature, and prints seven digits
SAME = 3e-4
ONE = dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
#: runs a command and tells its peak memory; small itself, for a child begins with its parent's peak
WATCH = (
    "import resource, subprocess, sys; code = subprocess.call(sys.argv[1:]); "
    "print('PEAK', resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss); sys.exit(code)"
)


def measured(job: Job) -> dict[str, Any]:
    """One row: medians of the repeats.

    Raises
    ------
    PeerError
        If a process fails, or answers of CalculiX are not ours.
    """
    rows = []
    while len(rows) < REPEATS and sum(r["cpu_s"] for r in rows) < ENOUGH:
        rows.append(_once(job))
    row = {"part": job.part, "line": job.line, "mesh": job.label, "runs": len(rows), **rows[0]}
    for name in ("cpu_s", "wall_s", "peak_MB"):
        row[name] = round(statistics.median(r[name] for r in rows), 3)
    return row


def _once(job: Job) -> dict[str, Any]:
    with tempfile.TemporaryDirectory(prefix="real-") as name:
        folder = Path(name)
        path = folder / "job.json"
        given = {"part": job.part, "line": job.line, "options": job.options, "folder": name}
        path.write_text(json.dumps(given))
        module = "validation.real_speed_accuracy.measure"
        extra = {**ONE, "PYTHONPATH": str(ROOT)}
        command = [sys.executable, "-m", module, str(path)]
        *_, out = run(command, ROOT, limit=LIMIT, threads=1, extra=extra)
        ours = json.loads(out.strip().splitlines()[-1])
        return _calculix(folder, ours) if job.line == CALCULIX else ours


def _calculix(folder: Path, ours: dict[str, Any]) -> dict[str, Any]:
    """The same numbers by CalculiX; seconds of modes and of loads added."""
    modes = _ccx(folder, "modes")
    loads = _ccx(folder, "loads")
    frequency = calculix.frequencies(modes["printed"])
    if len(frequency) < MODES:
        raise PeerError(f"CalculiX printed {len(frequency)} frequencies of {MODES}")
    wrench = np.load(folder / "wrench.npy")
    along_z = calculix.displacements(loads["printed"], wrench.shape[1])[2]
    c_zz = float(np.einsum("nc,nc->", wrench[2], along_z))
    bending = float(frequency[np.abs(frequency / ours["bending_1"] - 1).argmin()])
    gap = max(abs(c_zz / ours["C_zz"] - 1), abs(bending / ours["bending_1"] - 1))
    if gap > SAME:
        raise PeerError(f"CalculiX differs from ours on the same mesh by {gap:.1e}")
    return {
        "unknowns": ours["unknowns"],
        "cpu_s": modes["cpu"] + loads["cpu"],
        "wall_s": modes["wall"] + loads["wall"],
        "peak_MB": max(modes["peak"], loads["peak"]),
        "C_zz": c_zz,
        "bending_1": bending,
        "cpu_of_modes_s": round(modes["cpu"], 3),
        "from_ours": float(f"{gap:.1e}"),
    }


def _ccx(folder: Path, deck: str) -> dict[str, Any]:
    """One run of CalculiX: what it printed, wall and processor seconds, peak MB."""
    command = [sys.executable, "-S", "-c", WATCH, "ccx", "-i", deck]
    wall, cpu, out = run(command, folder, limit=LIMIT, threads=1, extra=ONE)
    if "*ERROR" in out:
        raise PeerError("CalculiX: " + last_words(out[out.index("*ERROR") :][:400]))
    peak = float(out.rsplit("PEAK", 1)[1]) / 1024
    printed = (folder / f"{deck}.dat").read_text()
    return {"printed": printed, "wall": wall, "cpu": cpu, "peak": peak}
