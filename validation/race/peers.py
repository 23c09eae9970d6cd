"""Against what a user would pick instead, on the same mesh and at equal error: CalculiX and sfepy
for the solid, ROSS for the beam.

The problem is the overhung pinion with torsion held by springs (free torsion makes the stiffness
matrix of a peer singular).  On one mesh of tetrahedra for two programs the seats are rigid: a tie
both can write down cheaply.  CalculiX's own distributing coupling passes on forces only; an
averaged seat as linear equations gives our numbers, but its springs couple all 5000 unknowns of a
seat with one another, and CalculiX was not done with that after 100 seconds of processor time.
Hexahedra have 160 nodes a seat; at equal error seats are averaged.

At equal error the clock runs from the scene in memory: of `solidgear.answer` over every mesh that it
tries and its error bars, of lanes called *mesh known* over build, statics and ten modes on one mesh
that was found before.  CalculiX is timed as a whole process with its deck given; ours within a
running Python, as a workbench is used, where imports are paid once a session.  Lanes called whole
process add imports and the scene's file.

Peers: CalculiX 2.20 or later (``apt-get install calculix-ccx``), sfepy, and ROSS 2.3 with plotly below
6 or ROSS 3.1 in a Python of 3.13 or later, here or in one that `PEERS` names.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.core.ladder.registry import LADDER
from validation.common import ROOT
from validation.race import calculix, ross_peer, sfepy_peer
from validation.race.answers import compliance_check, frequency_check, frequency_gap
from validation.race.heat import ERROR, Check, Clock, Heat, Lane, Sample
from validation.race.installed import missing, present
from validation.race.ours import Run, held, mine, solve, whole
from validation.race.problem import problem_of
from validation.race.process import PeerError
from validation.race.race import Race

SCENE = ROOT / "geometry" / "pinion_overhung.toml"
COUNTED = ("factor", "loads", "modes")
TETRAHEDRA = {"element": "tet10", "size": 0.022, "graded_size": 0.0038}
FEWER = {"element": "tet10", "size": 0.04, "graded_size": 0.012}
COARSE = {"element": "tet10", "size": 0.04, "graded_size": 0.03}
REFERENCE = {"order": 8, "layers": 4, "edge_layers": 2}
TARGET, COARSE_TARGET = 1e-3, 3e-2
#: the six numbers that the scene is judged by: entries of the compliance, and frequencies
ENTRIES = {"C_zz": (2, 2), "C_z,thx": (2, 3), "C_thx": (3, 3), "C_yy": (1, 1)}
NAMED = ("bending 1", "axial 1")
#: processor seconds after which a peer is not run again
ENOUGH = 60.0

#: tolerances of the automatic choice, over the target, whose last meshes are tried, coarse to fine
LOOSER = (10.0, 7.0, 5.0, 4.0, 3.0, 2.5, 2.0, 1.5, 1.0)
#: elements of our 3D solid, on the meshes that the program itself lists, coarse to fine
ELEMENTS = ("hex20", "hex27", "tet10")

# Allowed differences of answers, and why.
WHY = {
    "C3D10": (
        1e-4,
        "C3D10 takes 4 points for stiffness and mass (1.4e-5 at the tenth mode), ours are "
        "exact; seven digits are printed",
    ),
    "C3D20": (
        5e-5,
        "27 points against our 64: the same on straight elements, not quite on curved ones; seven "
        "digits are printed",
    ),
    "coarse": (2e-3, "quadrature of CalculiX on the coarse curved elements of a quick run"),
    "sfepy": (
        1e-6,
        "the same straight tetrahedra, integrated exactly by both: what is left is the "
        "eigensolvers' tolerance",
    ),
    "ross": (
        1e-3,
        "ROSS's elements average a tapered section and lack our internal unknowns: an error "
        "that falls with the square of the element length",
    ),
}


def same_mesh(heat: Heat) -> None:
    """TET10 with rigid seats: factor, six loads and ten modes against CalculiX."""
    scene, options = held(SCENE, "rigid"), COARSE if heat.quick else TETRAHEDRA
    fast = mine(heat, "solidgear", scene, "solid", options, counted=COUNTED)
    averaged = held(SCENE, "average")
    note = "the scene's own tie"
    mine(heat, "solidgear, averaged seats", averaged, "solid", options, counted=COUNTED, note=note)
    process = whole(heat, "solidgear, whole process", SCENE, "rigid", "solid", options)
    if not present("CalculiX"):
        heat.skip(missing("CalculiX"))
        return
    first = solve(scene, "solid", options)
    problem = problem_of(first.body, scene)
    allowed = WHY["coarse" if heat.quick else "C3D10"]
    checks = [frequency_check(first.modes, *allowed)]
    threads = cache(lambda: calculix.fastest_threads(heat, problem, "C3D10"))
    kind, more = "C3D10", {"enough": ENOUGH}
    modes = calculix.lane(heat, "CalculiX C3D10, ten modes", problem, kind, threads, checks, **more)
    loads = calculix.lane(
        heat,
        "CalculiX C3D10, ten modes + six loads",
        problem,
        kind,
        threads,
        [*checks, compliance_check(first.compliance, *allowed)],
        loads=True,
        **more,
    )
    heat.ratio("CalculiX's ten modes / our factor, six loads, ten modes", modes, fast, 4.0)
    heat.ratio("CalculiX's modes and six loads / ours", loads, fast, 15.0)
    heat.ratio("the same, with our assembly", loads, fast, None, ("assembly", *COUNTED))
    heat.ratio("the same, with our imports, mesh and assembly", loads, process)


def equal_error(heat: Heat) -> None:
    """Six numbers within the target of a harmonic reference of high order: the automatic choice with
    all that it tries, and every program on a mesh that is known to do.
    """
    scene, target = held(SCENE, "average"), COARSE_TARGET if heat.quick else TARGET
    error = Error(solve(scene, "harmonic", {"order": 4} if heat.quick else REFERENCE), target)

    def known(who: str, fidelity: str, mesh: Known) -> Lane:
        return mine(heat, who, scene, fidelity, mesh.options, facts={ERROR: mesh.error})

    flat, solids = of_answers(heat, error, scene), of_solids(heat, error, scene)
    note = "six numbers with error bars, every mesh that it tried"
    choice = heat.add(
        f"solidgear answer within {target:g}", lambda: answered(error, scene), note=note
    )
    fast = known("solidgear harmonic, mesh known", "harmonic", flat)
    last = mesh_of_answer(scene, target)
    if last != flat.options:
        finest = Known.measured(error, scene, "harmonic", last)
        known("solidgear harmonic, last mesh of the answer", "harmonic", finest)
    process = whole(
        heat, "solidgear harmonic, whole process", SCENE, "average", "harmonic", flat.options
    )
    element = min(solids, key=lambda name: solids[name].seconds)
    full = known(f"solidgear {element.upper()}, mesh known", "solid", solids[element])
    heat.ratio("our best 3D / our harmonic, meshes known", full, fast, 50.0)
    heat.ratio("our best 3D, mesh known / our answer with error bars", full, choice)
    if not present("CalculiX"):
        heat.skip(missing("CalculiX"))
        return
    problem = problem_of(solids["hex20"].run.body, scene)
    threads = cache(lambda: calculix.fastest_threads(heat, problem, "C3D20"))
    if "tet10" in solids:
        tetrahedra = entered(heat, error, scene, "C3D10", solids["tet10"], threads)
        heat.ratio("CalculiX C3D10 / our harmonic, meshes known", tetrahedra, fast)
    else:
        heat.skip(
            "CalculiX C3D10: the listed tetrahedra cost more than the best other mesh before they "
            f"are within {target:g}"
        )
    exact = entered(heat, error, scene, "C3D20", solids["hex20"], threads)
    levels = up_to(listed(scene, "hex20"), solids["hex20"].options)
    meshes = [Known.measured(error, scene, "solid", options) for options in levels]
    # reduced integration makes an element softer, which cancels part of the error of a mesh
    coarser = [entered(heat, error, scene, "C3D20R", mesh, threads) for mesh in meshes]
    heat.ratio("CalculiX C3D20 / our harmonic, meshes known", exact, fast, 500.0)
    heat.ratio("CalculiX C3D20, mesh known / our answer with error bars", exact, choice)
    heat.ratio("CalculiX C3D20R on the fastest mesh that will do / our harmonic", coarser, fast)
    heat.ratio("CalculiX C3D20 / our harmonic as a whole process", exact, process)


def entered(
    heat: Heat, error: Error, scene, kind: str, mesh: Known, threads: Callable[[], int]
) -> Lane:
    """Enter CalculiX on a mesh of ours; full integration has our numbers too."""
    problem = problem_of(mesh.run.body, scene)
    # rounding of printed digits does not throw out an element that has our error
    checks = [Check("error", error.of_peer, 1.02 * error.target, "the target")]
    if kind != "C3D20R":
        allowed = WHY["coarse" if heat.quick else kind]
        checks += [
            frequency_check(mesh.run.modes, *allowed),
            compliance_check(mesh.run.compliance, *allowed),
        ]
    who = f"CalculiX {kind}, {3 * len(problem.nodes):,} unknowns"
    more = {"loads": True, "error": error.of_peer, "enough": ENOUGH}
    return calculix.lane(heat, who, problem, kind, threads, checks, **more)


class Error:
    """Largest error of the six numbers that the scene is judged by against a reference, and what is
    allowed.
    """

    def __init__(self, reference: Run, target: float):
        self.target = target
        self.compliance = reference.compliance
        self.frequencies = {name: reference.modes.named(name).frequency_hz for name in NAMED}

    def of_numbers(self, numbers: dict[str, float]) -> float:
        """Of numbers by their names; of couplings relative to the diagonal."""
        gaps = []
        for name, value in numbers.items():
            if name in NAMED:
                gaps.append(abs(value / self.frequencies[name] - 1))
                continue
            i, j = ENTRIES[name]
            size = np.sqrt(self.compliance[i, i] * self.compliance[j, j])
            gaps.append(abs(value - self.compliance[i, j]) / size)
        return float(max(gaps))

    def of(self, compliance: np.ndarray, frequencies: dict[str, float]) -> float:
        """Of a 6x6 compliance and frequencies by their names."""
        return self.of_numbers({n: compliance[at] for n, at in ENTRIES.items()} | frequencies)

    def of_run(self, run: Run) -> float:
        """Of a model of ours."""
        named = {name: run.modes.named(name).frequency_hz for name in NAMED}
        return self.of(run.compliance, named)

    def of_peer(self, answer: calculix.Answer) -> float:
        """Of what CalculiX answers: the frequency nearest to that of the reference is the mode meant,
        for pairs do not split on these meshes.
        """
        nearest = {
            name: min(answer.frequency_hz, key=lambda f, hz=hz: abs(f - hz))
            for name, hz in self.frequencies.items()
        }
        return self.of(answer.compliance, nearest)


@dataclass(frozen=True, eq=False)
class Known:
    """A mesh that was tried: its options, the error it has, and the run."""

    options: dict[str, Any]
    error: float
    run: Run

    @classmethod
    def measured(cls, error: Error, scene, fidelity: str, options: Mapping[str, Any]) -> Known:
        """Solve a mesh and measure its error."""
        run = solve(scene, fidelity, dict(options))
        return cls(dict(options), error.of_run(run), run)

    @property
    def seconds(self) -> float:
        """Wall seconds from the scene to the answer."""
        return self.run.sample.seconds()


def answered(error: Error, scene) -> Sample:
    """The automatic choice: what a user who asks for a tolerance gets."""
    clock = Clock()
    found = clock.stage("answer", lambda: sg.answer(scene, error.target))
    meshes = [step for step in found.steps if step.valid]
    numbers = {str(v.quantity): v.value for v in found.values}
    facts = {"unknowns": meshes[-1].unknowns, "meshes": len(meshes), "error bar": found.bar}
    return clock.sample(found, **facts, **{ERROR: error.of_numbers(numbers)})


def mesh_of_answer(scene, tol: float) -> dict[str, Any]:
    """Options of the last mesh of the automatic choice."""
    found = sg.answer(scene, tol)
    return dict([step for step in found.steps if step.valid][-1].options)


def of_answers(heat: Heat, error: Error, scene) -> Known:
    """The coarsest last mesh of the automatic choice, by ever smaller tolerances, that is within the
    target.
    """
    for looser in LOOSER:
        mesh = Known.measured(
            error, scene, "harmonic", mesh_of_answer(scene, min(looser * error.target, 1.0))
        )
        say(heat, "harmonic", mesh)
        if mesh.error <= error.target:
            return mesh
    raise PeerError(f"no mesh of the automatic choice comes within {error.target:g}")


def listed(scene, element: str) -> list[dict[str, Any]]:
    """Meshes of the 3D solid that the program itself goes through, coarse to fine."""
    return [dict(level) for level in LADDER["solid"].meshes_of(scene, {"element": element}).levels]


def up_to(levels: list[dict[str, Any]], last: dict[str, Any]) -> list[dict[str, Any]]:
    """Levels of a list as far as one of them."""
    return levels[: levels.index(last) + 1]


def of_solids(heat: Heat, error: Error, scene) -> dict[str, Known]:
    """By element the coarsest listed mesh of the 3D solid that is within the target; without elements
    that cost more than the best of others before they are.
    """
    within: dict[str, Known] = {}
    for element in ELEMENTS:
        for options in listed(scene, element):
            mesh = Known.measured(error, scene, "solid", options)
            say(heat, element, mesh)
            if mesh.error <= error.target:
                within[element] = mesh
                break
            if any(mesh.seconds > other.seconds for other in within.values()):
                break
    if "hex20" not in within:
        raise PeerError(f"no listed mesh of HEX20 comes within {error.target:g}")
    return within


def say(heat: Heat, name: str, mesh: Known) -> None:
    """Say what a mesh was found to have."""
    unknowns = mesh.run.body.size
    heat.say(f"  {name}, {unknowns:,} unknowns: error {mesh.error:.1e}, {mesh.seconds:.2f} s")


def free_modes(heat: Heat) -> None:
    """Ten elastic modes of the free shaft on quadratic tetrahedra against sfepy, at a size its
    solver still likes.
    """
    if not present("sfepy"):
        heat.skip(missing("sfepy"))
        return
    scene, options = held(SCENE, "average"), COARSE if heat.quick else FEWER
    body = solve(scene, "solid", options, free=True).body
    expected = sg.modes(sfepy_peer.straightened(body, scene), (), n=10)

    def call() -> Sample:
        found = sfepy_peer.solve(body, scene, 10, limit=heat.limit)
        heat.versions["sfepy"] = found["version"]
        frequency = np.array(found["frequency_hz"])
        return Sample(found["stages"], found["cpu"], frequency, {"unknowns": found["unknowns"]})

    check = Check("frequencies", lambda f: frequency_gap(f, expected), *WHY["sfepy"])
    fast = mine(heat, "solidgear, TET10", scene, "solid", options, free=True)
    note = "without imports and mesh"
    slow = heat.add("sfepy, TET10 (eigsh on SuperLU)", call, checks=[check], note=note)
    heat.ratio("sfepy's assembly and ten modes / ours with mesh", slow, fast)


def beams(heat: Heat) -> None:
    """The Timoshenko beam against ROSS on the same nodes, with bearings at nodes, without tilt."""
    if not present("ROSS"):
        heat.skip(missing("ROSS"))
        return
    scene, options = ross_peer.on_nodes(held(SCENE, "section")), {"kappa": "cowper"}
    body = sg.build(scene, "timoshenko", **options)
    expected = sg.modes(body, scene, n=10)
    data = ross_peer.rotor(scene, body)

    def call() -> Sample:
        found = ross_peer.solve(data, limit=heat.limit)
        heat.versions["ROSS"] = found["version"]
        frequency = np.array(found["frequency_hz"])
        return Sample({"model and modes": found["seconds"]}, found["cpu"], frequency)

    check = Check("frequencies", lambda f: frequency_gap(f, expected), *WHY["ross"])
    counted = ("mesh", "assembly", "modes")
    fast = mine(heat, "solidgear, Timoshenko", scene, "timoshenko", options, counted=counted)
    note = "best of three, without imports"
    slow = heat.add("ROSS", call, checks=[check], note=note, enough=ENOUGH)
    heat.ratio("ROSS / ours, model and modes", slow, fast)


PEERS = Race(
    "CalculiX, sfepy and ROSS, on the same mesh and at equal error",
    {"mesh": same_mesh, "error": equal_error, "sfepy": free_modes, "ross": beams},
    needs=("CalculiX", "sfepy", "ROSS"),
)
