"""Speed against accuracy on real parts: a keyed one, a toothed one and one from a STEP file.

Raw tetrahedra uniform and graded, halves, a sector, defect correction, the plain part and CalculiX
on the same mesh, each in a process of its own on one thread, from the scene to its 6x6 compliance
and eight modes: processor seconds (imports not counted, children counted) and peak memory. CalculiX
is timed with its deck given.
"""

from __future__ import annotations

import resource
import tempfile
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.core.solve.shifted import factors
from validation.common import ROOT
from validation.race import calculix
from validation.race import real_lines as lines
from validation.race.heat import Check, Clock, Heat, Sample
from validation.race.installed import missing, present
from validation.race.problem import problem_of
from validation.race.process import ALONE, called
from validation.race.race import Race
from validation.race.real_costs import read
from validation.race.real_lines import Job

#: modes asked of every model
MODES = 8
#: a measurement is repeated until so many processor seconds are spent
ENOUGH = 5.0
#: relative difference of answers on the same mesh above which times mean nothing
SAME = 3e-4
WHY = "CalculiX takes fewer points of quadrature, and prints seven digits"
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
    C_zz: float
    bending_1: float
    backend: str = ""

    def plus(self, more: Found, less: Found) -> Found:
        """This one, with what two others differ by."""
        c, f = more.C_zz - less.C_zz, more.bending_1 - less.bending_1
        return Found(more.unknowns, self.C_zz + c, self.bending_1 + f, more.backend)


def lowest_bending(modes) -> float:
    """Frequency of the lowest bending mode, in whatever plane, Hz."""
    return min(m.frequency_hz for m in modes.modes if m.name.startswith("bending"))


def solved(scene, rung: str, **options) -> Found:
    """One model of one scene, from the scene to its numbers."""
    return numbers_of(sg.build(scene, rung, **options), scene)


def numbers_of(body, scene) -> Found:
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
    from solidgear.cuts.sector.body import sector

    count = scene.features[0].count
    toothed, plain = (
        numbers_of(sector(s, count=count, **options), s) for s in (scene, scene.plain)
    )
    return solved(scene.plain, "harmonic", **base).plus(toothed, plain)


def _heavy(scene, options) -> Found:
    """Harmonic solid of a cone at ``SHARE`` of the pitch cone, and the mass that it lacks."""
    from validation.teeth import cone, lacking

    toothed = sg.build(scene, "sector", refinement=0.2)
    small = cone(scene, lines.SHARE)
    body = sg.build(small, "harmonic", **options)
    lack = lacking(scene, toothed.mass_matrix() - body.mass_matrix())
    return numbers_of(body, small.with_changes(masses=(lack,)))


def decks(job: Job, folder: Path) -> Found:
    """Decks of CalculiX for the mesh of the graded whole model, one for modes and one for loads,
    and what our solid says on that mesh.
    """
    scene = lines.scene_of(job.part)
    body = sg.build(scene, "solid", element="tet10", half=False, **job.options)
    found = problem_of(body, scene)
    (folder / "modes.inp").write_text(calculix.deck(found, "C3D10", modes=MODES))
    (folder / "loads.inp").write_text(calculix.deck(found, "C3D10", loads=True))
    np.save(folder / "wrench.npy", found.wrench)
    return numbers_of(body, scene)


def peak_mb() -> float:
    """Largest resident memory of this process or of a child, MB."""
    both = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    return max(resource.getrusage(who).ru_maxrss for who in both) / 1024


def _imported() -> None:
    """Everything imported that is imported at first use."""
    plain = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    solved(plain, "solid", element="tet10", refinement=0.2)
    solved(plain, "harmonic", order=2, layers=0, edge_layers=0)


def measured(part: str, line: str, options: dict[str, Any], folder: str = "") -> dict[str, Any]:
    """Solve a job in this process, or write the decks of CalculiX; plain data."""
    job = Job(part, line, options)
    _imported()
    clock = Clock()
    found = clock.stage("all", lambda: decks(job, Path(folder)) if folder else run(job))
    sample = clock.sample(asdict(found), peak_MB=peak_mb())
    return asdict(sample)


def once(job: Job, limit: float) -> Sample:
    """One measurement in a process of its own."""
    call = partial(called, "validation.race.real_parts:measured", threads=1, extra=ALONE)
    if job.line != lines.CALCULIX:
        sample = Sample(**call(limit=limit, **asdict(job)).answer)
        sample.facts |= sample.answer
        return sample
    with tempfile.TemporaryDirectory(prefix="real-") as name:
        ours = call(limit=limit, folder=name, **asdict(job)).answer["answer"]
        return _calculix(Path(name), ours, limit)


def _calculix(folder: Path, ours: dict[str, Any], limit: float) -> Sample:
    """The same by CalculiX; modes and loads are runs of their own."""
    execute = partial(calculix.execute, folder, watch=True, limit=limit, threads=1, extra=ALONE)
    (modes, frequency), (loads, moved) = execute("modes"), execute("loads")
    wrench = np.load(folder / "wrench.npy")
    along_z = calculix.displacements(moved, wrench.shape[1])[2]
    c_zz = float(np.einsum("nc,nc->", wrench[2], along_z))
    hz = calculix.frequencies(frequency, MODES)
    bending = float(hz[np.abs(hz / ours["bending_1"] - 1).argmin()])
    gap = max(abs(c_zz / ours["C_zz"] - 1), abs(bending / ours["bending_1"] - 1))
    facts = {"unknowns": ours["unknowns"], "C_zz": c_zz, "bending_1": bending}
    facts |= {"peak_MB": max(modes.peak_mb, loads.peak_mb), "from_ours": gap}
    stages = {"modes": modes.wall, "loads": loads.wall}
    facts |= {"cpu_of_modes_s": modes.cpu}
    return Sample(stages, modes.cpu + loads.cpu, facts, facts)


def part(heat: Heat, name: str) -> None:
    """All lines of a part, one lane a mesh."""
    same = Check("C_zz and first bending", lambda facts: facts["from_ours"], SAME, WHY)
    jobs = lines.jobs(name)
    if heat.quick:
        coarsest = {job.line: job for job in reversed(jobs) if job.line != lines.REFERENCE}
        jobs = list(coarsest.values())
    for job in jobs:
        peer = job.line == lines.CALCULIX
        if peer and not present("CalculiX"):
            heat.skip(f"{job.line}: {missing('CalculiX')}")
            continue
        heat.add(
            job.name,
            partial(once, job, heat.limit),
            facts={"line": job.line},
            checks=[same] if peer else [],
            enough=ENOUGH,
        )


REAL_PARTS = Race(
    "keyed, toothed and STEP part: speed against accuracy, CalculiX on the same mesh",
    {name: partial(part, name=name) for name in lines.PARTS},
    settings={"target": 1e-3},
    resumes=True,
    needs=("CalculiX",),
    read=read,
)
