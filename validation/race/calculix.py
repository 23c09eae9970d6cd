"""CalculiX (``ccx``) as a peer: the deck of a solid problem, the run, and what it printed.

Bearings are grounded springs on what their seats do, loads the nodal forces of unit wrenches.  A
rigid seat is one linear equation a node on two reference nodes (translation, rotation).  An
averaged seat is one equation a spring; such a spring couples all unknowns of the seat with one
another, a dense block that CalculiX has to store and factor.
"""

from __future__ import annotations

import re
import shutil
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from solidgear.core.elements import ELEMENTS
from solidgear.core.frames import cross_matrix
from solidgear.show.outputs import node_order
from validation.race.heat import Heat, Lane, Sample
from validation.race.problem import Problem
from validation.race.process import WATCH, Done, PeerError, cores, last_words, run

#: element type -> ours; VTK numbers the nodes of both as CalculiX does (user's manual, the sections
#: on C3D10 and C3D20)
KINDS = {"C3D10": "tet10", "C3D20": "hex20", "C3D20R": "hex20"}


@dataclass(frozen=True)
class Answer:
    """What one run of CalculiX gave.

    Attributes
    ----------
    seconds : float
        Wall time of the whole process.
    frequency_hz : (m,) ndarray
    compliance : (6, 6) ndarray or None
        At the lumped port, where unit loads were asked for.
    cpu : float
        Processor seconds of the process.
    version : str
    """

    seconds: float
    cpu: float
    frequency_hz: np.ndarray
    compliance: np.ndarray | None
    version: str


def present() -> str:
    """Empty if CalculiX can be run, else the reason why not."""
    missing = "no program ccx on the path (Debian: apt-get install calculix-ccx)"
    return "" if shutil.which("ccx") else missing


def solve(
    problem: Problem,
    kind: str,
    *,
    modes: int = 0,
    loads: bool = False,
    limit: float = 900.0,
    threads: int | None = None,
) -> Answer:
    """Run CalculiX in a folder of its own, which is gone afterwards.

    Parameters
    ----------
    kind : str
        Key of ``KINDS``.
    modes : int
        Number of natural frequencies wanted, 0 for none.
    loads : bool
        Whether to solve the six unit loads, one static step each.
    limit : float
        Seconds.
    threads : int, optional
        All cores by default; SPOOLES waits by spinning, so on a busy machine fewer can be faster.

    Raises
    ------
    PeerError
        If it fails, runs out of time or prints less than was asked for.
    """
    with tempfile.TemporaryDirectory(prefix="ccx-") as name:
        folder = Path(name)
        (folder / "race.inp").write_text(deck(problem, kind, modes=modes, loads=loads))
        done, printed = execute(folder, "race", limit=limit, threads=threads)
    compliance = None
    frequency = frequencies(printed, modes)
    if loads:
        steps = displacements(printed, len(problem.nodes))
        if len(steps) != 6:
            raise PeerError(f"CalculiX printed displacements for {len(steps)} loads of 6")
        compliance = np.array([np.einsum("inc,nc->i", problem.wrench, u) for u in steps]).T
    version = re.search(r"CalculiX Version ([\w.]+)", done.out)
    return Answer(done.wall, done.cpu, frequency, compliance, version[1] if version else "")


def execute(folder: Path, name: str, *, watch: bool = False, **more) -> tuple[Done, str]:
    """Run the deck of a name in a folder: the process, and what it printed into its ``.dat``.

    Parameters
    ----------
    watch : bool
        For the peak of its memory.
    **more
        As of `process.run`.

    Raises
    ------
    PeerError
        If it fails.
    """
    watched = [sys.executable, "-S", "-c", WATCH] if watch else []
    done = run([*watched, "ccx", "-i", name], folder, **more)
    # CalculiX returns 0 after some errors.
    if "*ERROR" in done.out:
        raise PeerError("CalculiX: " + last_words(done.out[done.out.index("*ERROR") :][:400]))
    path = folder / f"{name}.dat"
    return done, path.read_text() if path.exists() else ""


def deck(problem: Problem, kind: str, *, modes: int = 0, loads: bool = False) -> str:
    """Input of CalculiX.

    Raises
    ------
    ValueError
        If ``kind`` does not fit the problem's element.
    """
    if KINDS.get(kind) != problem.element:
        raise ValueError(f"{kind} does not fit {problem.element}")
    cells = problem.cells[:, node_order(problem.doflocs, ELEMENTS[problem.element].vtk)] + 1
    out = ["*NODE, NSET=ALL", *_nodes(problem.nodes, 1)]
    element = 1
    for m, (young, poisson, density) in enumerate(problem.materials):
        out.append(f"*ELEMENT, TYPE={kind}, ELSET=PART{m}")
        for cell in cells[problem.material == m]:
            out += _wrapped([element, *cell])
            element += 1
        out += [
            f"*MATERIAL, NAME=M{m}",
            "*ELASTIC",
            f"{young:.10e}, {poisson:.10e}",
            "*DENSITY",
            f"{density:.10e}",
        ]
        out.append(f"*SOLID SECTION, ELSET=PART{m}, MATERIAL=M{m}")
    node = len(problem.nodes) + 1
    for seat in problem.seats:
        lines, node, element = _seat(problem, seat, node, element)
        out += lines
    if modes:
        out += ["*STEP", "*FREQUENCY", f"{modes}", "*END STEP"]
    if loads:
        at = problem.loaded
        out += ["*NSET, NSET=LOADED", *(f"{i + 1}" for i in at)]
        for force in problem.wrench:
            out += ["*STEP", "*STATIC", "*CLOAD, OP=NEW"]
            out += [
                f"{i + 1}, {c + 1}, {force[i, c]:.12e}" for i in at for c in range(3) if force[i, c]
            ]
            out += ["*NODE PRINT, NSET=LOADED", "U", "*END STEP"]
    return "\n".join(out) + "\n"


def frequencies(printed: str, count: int) -> np.ndarray:
    """Natural frequencies in the ``.dat`` file, Hz: mode number, eigenvalue, rad/s, Hz, imaginary
    part.

    Raises
    ------
    PeerError
        If there are fewer than asked for.
    """
    found = re.search(
        r"E I G E N V A L U E   O U T P U T(.*?)(?:P A R T I C I P A T I O N|\Z)", printed, re.S
    )
    row = r"^\s+\d+((?:\s+[-+]?\d\.\d+E[-+]\d+){4})\s*$"
    rows = re.findall(row, found[1], re.M) if found else []
    if len(rows) < count:
        raise PeerError(f"CalculiX printed {len(rows)} frequencies of {count}")
    return np.array([float(row.split()[2]) for row in rows[:count]])


def displacements(printed: str, count: int) -> list[np.ndarray]:
    """(count, 3) displacements of every static step in the ``.dat`` file; nodes that were not
    printed are zero.
    """
    steps = []
    for text in re.split(r"displacements \(vx,vy,vz\)[^\n]*\n", printed)[1:]:
        rows = re.findall(r"^\s+(\d+)\s+(\S+E\S+)\s+(\S+E\S+)\s+(\S+E\S+)\s*$", text, re.M)
        u = np.zeros((count, 3))
        table = np.array(rows, float).reshape(-1, 4)
        u[table[:, 0].astype(int) - 1] = table[:, 1:]
        steps.append(u)
    return steps


def _nodes(points, first: int) -> list[str]:
    # 19 characters a number: CalculiX reads no field beyond 20.
    return [f"{i}, {x:.12e}, {y:.12e}, {z:.12e}" for i, (x, y, z) in enumerate(points, first)]


def _wrapped(numbers, width: int = 12) -> list[str]:
    """Whole numbers over several lines; all but the last end in a comma, which tells CalculiX to
    read on.
    """
    rows = [numbers[i : i + width] for i in range(0, len(numbers), width)]
    return [
        ", ".join(str(x) for x in row) + ("," if k + 1 < len(rows) else "")
        for k, row in enumerate(rows)
    ]


def _equation(terms) -> list[str]:
    """A linear equation whose left side is zero; the first term is the dependent one."""
    rows = [
        ", ".join(f"{node}, {c + 1}, {a:.12e}" for node, c, a in terms[i : i + 4])
        for i in range(0, len(terms), 4)
    ]
    return ["*EQUATION", f"{len(terms)}", *rows]


def _seat(problem: Problem, seat, node: int, element: int):
    """Lines for one seat; returns the next free node and element numbers too."""
    at = np.array([0.0, seat.y, 0.0])
    out = []
    if seat.mean is None:
        move, turn = node, node + 1
        node += 2
        out += ["*NODE", *_nodes([at, at], move)]
        for i in seat.nodes:
            lever = cross_matrix(problem.nodes[i] - at)
            for c in range(3):
                # u = d + th x r = d - [r] th
                out += _equation(
                    [(i + 1, c, -1.0), (move, c, 1.0)]
                    + [(turn, k, -lever[c, k]) for k in range(3) if lever[c, k]]
                )
    # The 6x6 as single springs: K = sum k_j l_j l_j', each on the motion q_j = l_j . d of a node of
    # its own.
    for k, direction in _springs(seat.stiffness):
        if seat.mean is None:
            parts = [(move if c < 3 else turn, c % 3, a) for c, a in enumerate(direction) if a]
        else:
            share = np.einsum("i,inc->nc", direction, seat.mean)
            parts = [(i + 1, c, share[i, c]) for i, c in np.argwhere(share)]
        out += [
            "*NODE",
            *_nodes([at], node),
            *_equation([(node, 0, -1.0), *parts]),
            "*BOUNDARY",
            f"{node}, 2, 3",
        ]
        out += [f"*ELEMENT, TYPE=SPRING1, ELSET=SPRING{element}", f"{element}, {node}"]
        out += [f"*SPRING, ELSET=SPRING{element}", "1", f"{k:.12e}"]
        node, element = node + 1, element + 1
    return out, node, element


def _springs(stiffness: np.ndarray):
    """(k, unit direction) of single springs that make up a 6x6; scaled first, for N/m and N m/rad
    differ by powers of ten.
    """
    scale = np.sqrt(np.diag(stiffness).clip(min=0.0))
    scale[scale == 0.0] = 1.0
    value, vector = np.linalg.eigh(stiffness / np.outer(scale, scale))
    for k, direction in zip(value, (scale[:, None] * vector).T):
        if k > 1e-12:
            size = np.linalg.norm(direction)
            yield k * size**2, direction / size


def lane(heat: Heat, who: str, problem, kind, threads: int, checks, *, loads=False) -> Lane:
    """A lane of CalculiX: a whole process, its deck given, and ten modes."""

    def call() -> Sample:
        found = solve(problem, kind, modes=10, loads=loads, limit=heat.limit, threads=threads)
        heat.versions["CalculiX"] = found.version
        unknowns = 3 * len(problem.nodes)
        return Sample({"whole process": found.seconds}, found.cpu, found, {"unknowns": unknowns})

    return heat.add(who, call, checks=checks, note=f"threads: {threads}")


def fastest_threads(heat: Heat, problem: Problem, kind: str) -> int:
    """The number of threads CalculiX is fastest with here: its solver waits by spinning, so more
    are not always better.
    """
    seconds = {}
    for threads in sorted({1, cores()}):
        try:
            found = solve(problem, kind, modes=10, limit=heat.limit, threads=threads)
        except PeerError as error:
            heat.say(f"CalculiX with {threads} threads: {error}")
            continue
        seconds[threads] = found.seconds
        heat.say(f"CalculiX with {threads} threads, ten modes: {found.seconds:.1f} s")
    return min(seconds, key=seconds.__getitem__, default=1)
