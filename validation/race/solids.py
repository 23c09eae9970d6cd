"""A large 3D solid, one by every way to factor it, and tetrahedra of ever more unknowns: memory, time
and the digits shared.

Every lane is a process of its own. Memory is the peak of the factor beyond what the process held
before it (of all ranks together for PETSc, libraries included). Asked for: 300,000 unknowns within
5 GB.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np

import solidgear as sg
from solidgear.core.solve.shifted import factors
from validation.race.heat import Check, Clock, Heat, Sample
from validation.race.process import ROOT, called
from validation.race.race import Race

WAYS = {
    "double": {},
    "single": {"precision": "single"},
    "out of core": {"out_of_core": True},
    "single, out of core": {"precision": "single", "out_of_core": True},
    "petsc, 1 rank": {"engine": "petsc", "ranks": 1},
    "petsc, 2 ranks": {"engine": "petsc", "ranks": 2},
    "gamg, 1 rank": {"engine": "petsc-gamg", "ranks": 1},
    "gamg, 2 ranks": {"engine": "petsc-gamg", "ranks": 2},
}
#: m, tetrahedra away from shoulders and at them: of the ways, of the large one, of a quick run
SIZES, LARGE, QUICK = (0.018, 0.0032), (0.0135, 0.0022), (0.04, 0.012)

#: refinements of tetrahedra of some 44, 100, 200, 400 and 800 thousand unknowns
REFINEMENTS = (0.9, 1.3, 1.75, 2.25, 2.9)
#: stages that count
SOLVED = ("factor", "statics", "modes")


def solved(way: str, size: float, graded: float, modes: int) -> dict:
    """Solve the overhung pinion one way: stages, memory and numbers, as plain data."""
    scene = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    clock = Clock()
    mesh = {"element": "tet10", "size": size, "graded_size": graded}
    body = clock.stage("mesh", lambda: sg.build(scene, "solid", **mesh, **WAYS[way]))
    meshing = _memory("VmHWM")
    # forget the peak of meshing
    Path("/proc/self/clear_refs").write_text("5")
    held = _memory("VmRSS")
    factor = clock.stage("factor", lambda: factors(body)[0])
    facts = {"unknowns": body.size, "backend": factor.backend, "estimate MB": factor.estimate_mb}
    facts["factor MB"] = _memory("VmHWM") - held
    rhs = body.blocks[0].mass @ np.random.default_rng(0).standard_normal((body.size, 8))
    clock.stage("eight solutions", lambda: factor.solve(rhs))
    port = clock.stage("statics", lambda: sg.condense(body, scene, scene.port.name))
    answer = {"C_zz": float(port.compliance[2, 2])}
    if "gamg" not in way:
        found = clock.stage("modes", lambda: sg.modes(body, scene, n=modes))
        answer["bending 1"] = found.named("bending 1").frequency_hz
    if "rank" in way:
        ranks = factor._solve.__self__
        facts |= {"factor MB": ranks.peak_mb, "iterations": ranks.steps}
    facts["peak of the process MB"] = max(meshing, _memory("VmHWM"))
    return {"stages": clock.stages, "cpu": clock.sample().cpu, "answer": answer, "facts": facts}


def scaled(refinement: float, modes: int) -> dict:
    """Solve statics and modes of the overhung pinion on tetrahedra, and factor the same matrix again by
    PARDISO alone: stages, seconds and bytes by the unknown, as plain data.
    """
    scene = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    clock = Clock()
    mesh = {"element": "tet10", "refinement": refinement}
    body = clock.stage("mesh", lambda: sg.build(scene, "solid", **mesh))
    # forget the peak of meshing
    Path("/proc/self/clear_refs").write_text("5")
    factor = clock.stage("factor", lambda: factors(body)[0])
    port = clock.stage("statics", lambda: sg.condense(body, scene, scene.port.name))
    found = clock.stage("modes", lambda: sg.modes(body, scene, n=modes))
    answer = {
        "C_zz": float(port.compliance[2, 2]),
        "bending 1": found.named("bending 1").frequency_hz,
    }
    sample, peak = clock.sample(), _memory("VmHWM")
    seconds = sample.seconds(SOLVED)
    facts = {"unknowns": body.size, "backend": factor.label, "peak MB": peak}
    facts |= {"us an unknown": 1e6 * seconds / body.size}
    facts |= {"bytes an unknown": 2**20 * peak / body.size}
    if factor.backend == "pardiso" and factor.refining is None:
        pardiso = factor._solve.__self__
        # its own report, kB: permanent memory of the analysis, and of factor and solution
        reported = sum(map(int, pardiso.iparm[15:17])) / 1024
        again = Clock()
        again.stage("factor", pardiso.factor)
        own = again.stages["factor"]
        facts |= {"PARDISO's factor s": own, "PARDISO's MB": reported}
        facts |= {"times its factor": seconds / own, "times its memory": peak / reported}
    return {"stages": sample.stages, "cpu": sample.cpu, "answer": answer, "facts": facts}


def by_sizes(heat: Heat) -> None:
    """One lane a mesh, once."""
    for refinement in REFINEMENTS[: 1 if heat.quick else None]:

        def once(refinement: float = refinement) -> Sample:
            call = partial(called, "validation.race.solids:scaled", limit=heat.limit)
            return Sample(**call(refinement=refinement, modes=10).answer)

        heat.add(f"TET10, refinement {refinement:g}", once, counted=SOLVED)


def _memory(name: str) -> float:
    """A line of the status of this process, MB."""
    text = Path("/proc/self/status").read_text()
    return int(text.split(f"{name}:")[1].split()[0]) / 1024


def by_ways(heat: Heat, ways: tuple[str, ...], sizes: tuple[float, float], modes: int) -> None:
    """One lane a way."""
    size, graded = QUICK if heat.quick else sizes
    given = {"size": heat.settings["size"] or size, "graded": heat.settings["graded"] or graded}

    def once(way: str) -> Sample:
        call = partial(called, "validation.race.solids:solved", limit=heat.limit)
        return Sample(**call(way=way, modes=modes, **given).answer)

    first = heat.add(ways[0], partial(once, ways[0]))

    def apart(answer: dict) -> float:
        return max(abs(answer[name] / first.answer[name] - 1) for name in answer)

    for way in ways[1:]:
        heat.add(way, partial(once, way), checks=[Check("numbers", apart)])


SOLIDS = Race(
    "a large 3D solid by every way to factor it, one of 300,000 unknowns, and ever larger ones",
    {
        "ways": partial(by_ways, ways=tuple(WAYS), sizes=SIZES, modes=6),
        "large": partial(by_ways, ways=("double",), sizes=LARGE, modes=10),
        "sizes": by_sizes,
    },
    rounds=1,
    settings={"size": 0.0, "graded": 0.0},
)
