"""One measurement in a process of its own.

    python -m validation.real_speed_accuracy.measure JOB.json

A job holds part, line, options and a folder for decks of CalculiX. What was found goes to standard
output as JSON: processor seconds from scene to 6x6 compliance and eight modes (imports not
counted, children counted), peak memory, and the numbers.
"""

from __future__ import annotations

import json
import resource
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import solidgear as sg
from solidgear.solve.statics import factors
from validation.common import ROOT
from validation.real_speed_accuracy import lines
from validation.real_speed_accuracy.lines import Job

#: modes asked of every model
MODES = 8
#: harmonic solid below differences of sectors: it errs by 3e-5 on the plain pinion
BASE = {"order": 4, "layers": 2, "edge_layers": 1, "relative_size": 4.0}
#: and below those of the reference: 1e-5
BEST = {"order": 5, "layers": 3, "edge_layers": 2, "relative_size": 4.0}


@dataclass(frozen=True)
class Found:
    """What one model says: unknowns, compliance along z at the lumped port in m/N, lowest bending
    in Hz, and what factored.
    """

    unknowns: int
    c_zz: float
    bending: float
    backend: str = ""

    def plus(self, more: Found, less: Found) -> Found:
        """This one, with what two others differ by."""
        c, f = more.c_zz - less.c_zz, more.bending - less.bending
        return Found(more.unknowns, self.c_zz + c, self.bending + f, more.backend)


def lowest_bending(modes) -> float:
    """Frequency of the lowest bending mode, in whatever plane, Hz."""
    return min(m.frequency_hz for m in modes.modes if m.name.startswith("bending"))


def solved(scene, rung: str, **options) -> Found:
    """One model of one scene, from the scene to its numbers."""
    return read(sg.build(scene, rung, **options), scene)


def read(body, scene) -> Found:
    """The numbers of a body."""
    compliance = sg.condense(body, scene, scene.port.name).compliance
    modes = sg.modes(body, scene, n=MODES, ovalising=False)
    size = int(body.mesh.get("solid_unknowns", body.size))
    return Found(size, float(compliance[2, 2]), lowest_bending(modes), factors(body)[0].backend)


def run(job: Job) -> Found:
    """Solve a job.

    Raises
    ------
    ValueError
        If the line is not one of ours.
    """
    scene, options = lines.scene_of(job.part), job.options
    if job.line in lines.RAW:
        return solved(scene, "solid", element="tet10", half=False, **options)
    if job.line == lines.SECTOR:
        return solved(scene, "sector", **options)
    if job.line == lines.PLAIN:
        return solved(scene.plain, "harmonic", **options)
    if job.line == lines.HEAVY:
        return _heavy(scene, options)
    if job.line == lines.DIFFERENCE:
        return _difference(scene, options, BASE)
    if (job.part, job.line) == ("toothed", lines.REFERENCE):
        return _difference(scene, options, BEST)
    if job.part == "step":
        scene = lines.as_features(scene)
    if job.line == lines.HALVES:
        return solved(scene, "solid", element="tet10", **options)
    if job.line in (lines.CORRECTED, lines.REFERENCE):
        return solved(scene, "corrected", **options)
    raise ValueError(f"no line {job.line!r}")


def _difference(scene, options, base) -> Found:
    """Harmonic solid of the pitch cone, and what teeth change by two sectors of like meshes."""
    from solidgear.models.sector.body import sector

    count = scene.features[0].count
    toothed, plain = (read(sector(s, count=count, **options), s) for s in (scene, scene.plain))
    return solved(scene.plain, "harmonic", **base).plus(toothed, plain)


def _heavy(scene, options) -> Found:
    """Harmonic solid of a cone at ``SHARE`` of the pitch cone, and the mass that it lacks."""
    from validation.teeth import cone, lacking

    toothed = sg.build(scene, "sector", refinement=0.2)
    small = cone(scene, lines.SHARE)
    body = sg.build(small, "harmonic", **options)
    lack = lacking(scene, toothed.mass_matrix() - body.mass_matrix())
    return read(body, small.with_changes(masses=(lack,)))


def decks(job: Job, folder: Path) -> Found:
    """Decks of CalculiX for the mesh of the graded whole model, one for modes and one for loads,
    and what our solid says on that mesh.
    """
    from validation.peers import calculix, problem

    scene = lines.scene_of(job.part)
    body = sg.build(scene, "solid", element="tet10", half=False, **job.options)
    found = problem.of(body, scene)
    (folder / "modes.inp").write_text(calculix.deck(found, "C3D10", modes=MODES))
    (folder / "loads.inp").write_text(calculix.deck(found, "C3D10", loads=True))
    np.save(folder / "wrench.npy", found.wrench)
    return read(body, scene)


def spent() -> float:
    """Processor seconds of this process and of its children that have ended."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def peak_mb() -> float:
    """Largest resident memory of this process or of a child, MB."""
    both = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    return max(resource.getrusage(who).ru_maxrss for who in both) / 1024


def _imported() -> None:
    """Everything imported that is imported at first use."""
    plain = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    solved(plain, "solid", element="tet10", refinement=0.2)
    solved(plain, "harmonic", order=2, layers=0, edge_layers=0)


def main() -> None:
    """Measure the job of a file."""
    given = json.loads(Path(sys.argv[1]).read_text())
    job = Job(given["part"], given["line"], given["options"])
    _imported()
    cpu, wall = spent(), time.perf_counter()
    found = decks(job, Path(given["folder"])) if job.line == lines.CALCULIX else run(job)
    row = {
        "unknowns": found.unknowns,
        "cpu_s": spent() - cpu,
        "wall_s": time.perf_counter() - wall,
        "peak_MB": peak_mb(),
        "C_zz": found.c_zz,
        "bending_1": found.bending,
        "backend": found.backend,
    }
    print(json.dumps(row))


if __name__ == "__main__":
    main()
