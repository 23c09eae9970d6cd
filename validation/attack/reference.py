"""What a scene's compared numbers really are: a harmonic solid of its own, refined until it
stands still.

A body of revolution is solved exactly by harmonics, so that only the meridian mesh is left to
err, in two ways. *Layers*: the cells in a singular corner shrink geometrically and what the last
one misses shrinks by ``ratio^(2 lambda)`` per layer, lambda at least 1/2. *Order*: on a geometric
mesh the error falls exponentially with the polynomial order.

    value       = Aitken of three orders on the same mesh
    uncertainty = three times Aitken's own step (both steps where the three do not fall geometrically)
                  + what the layers beyond the last can add, from the step of the last two
                  + what the solver left

Mesh and elements are `corner_mesh` and `spectral`; from the product come the outline of the
coarsest mesh, the solvers and the definition of what is compared.
"""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from solidgear.body import as_supports
from solidgear.judge.quantities import QUANTITIES, measure, points_of, size
from solidgear.machine.whole_file import whole
from solidgear.scene import Ask, Scene
from solidgear.solve.modes import modes
from solidgear.solve.statics import condense
from validation.attack.corner_mesh import TooFine, corner_mesh
from validation.attack.spectral import spectral

FOLDER = Path(__file__).resolve().parent.parent / "results" / "attack" / "reference"
RATIO = 0.2
SIZE = 2.0  # least outer radii
#: (lowest of three orders, layers), from light to heavy
LEVELS = ((3, 6), (5, 8), (7, 11))
#: unknowns of the bending block above which a level is not tried: about 20 s on one core for all
#: its solutions
MOST_UNKNOWNS = 100_000
#: below this relative step the sequence has reached rounding and is not extrapolated
ROUNDING = 1e-10
EXTRA_MODES = 6
#: on Aitken's own step: of 135 figures on 18 scenes the next level moved 12 by more than it, and
#: one by more than three times it
SURE = 3.0


@dataclass(frozen=True)
class Reference:
    """Values and uncertainties (relative) of the compared quantities, and the modes behind the
    frequencies.

    Attributes
    ----------
    values, uncertainty : dict of str to float
    modes : list of dict
        ``name``, ``frequency_hz``, ``multiplicity``, ``family``, ``uncertainty`` and ``motions``
        (shapes, stations, 6).
    gram : list of list
        Weights of the stations, for correlation.
    setting : list of int
        Order and layers of the finest that was solved.
    unknowns : int
    seconds : float
        Of processor time, for all solutions.
    """

    values: dict
    uncertainty: dict
    modes: list
    gram: list
    setting: list
    unknowns: int
    seconds: float

    def meets(self, goal: float | Mapping[str, float]) -> bool:
        """Whether every quantity is known as well as asked."""
        wanted = goal if isinstance(goal, Mapping) else dict.fromkeys(self.uncertainty, goal)
        return all(self.uncertainty[q] <= g for q, g in wanted.items() if q in self.uncertainty)


def reference(
    scene: Scene,
    goal: float | Mapping[str, float] = 1e-6,
    limit: int = MOST_UNKNOWNS,
    folder: Path | None = FOLDER,
) -> Reference | None:
    """The compared numbers of a scene, to a relative uncertainty of `goal` where the limit on
    unknowns allows.

    Parameters
    ----------
    scene : Scene
    goal : float, or mapping of quantities to floats
        Relative uncertainty asked for; quantities that are not named may have any.
    limit : int
        Unknowns of the bending block at the lightest level; half of it at the others.
    folder : Path or None
        Where results are kept; None keeps none.

    Returns
    -------
    Reference or None
        None where not even the lightest level is within the limit.
    """
    kept = _read(folder, scene)
    found = Reference(**kept["found"]) if kept and kept["found"] else None
    first = kept["level"] + 1 if kept else 0
    if found is not None and found.meets(goal):
        return found
    start = time.process_time()
    for level in range(first, len(LEVELS)):
        order, layers = LEVELS[level]
        try:
            mesh = corner_mesh(scene, layers, SIZE, RATIO, limit // (3 * (order + 2) ** 2))
        except TooFine:
            break
        # without the lightest level there is nothing to judge by; the others are worth less
        if 3 * len(mesh.cells) * (order + 2) ** 2 > (limit if level == 0 else limit // 2):
            break
        found = replace(_level(scene, mesh, order, layers), seconds=time.process_time() - start)
        _write(folder, scene, {"level": level, "found": asdict(found)})
        if found.meets(goal):
            break
    return found


# ------------------------------------------------------------------------------------------------
# - one level
def _level(scene: Scene, mesh, order: int, layers: int) -> Reference:
    runs = [_solve(scene, mesh, p) for p in (order, order + 1, order + 2)]
    shallow = _solve(scene, corner_mesh(scene, layers - 2, SIZE, RATIO), order)
    noise = max(r["noise"] for r in runs)
    inverted = max(r["inverted"] for r in runs)
    values, uncertainty = {}, {}
    for name in dict.fromkeys((*QUANTITIES, *runs[-1]["values"])):
        if all(name in r["values"] for r in (*runs, shallow)):
            four = [r["values"][name] for r in (*runs, shallow)]
            left = inverted if points_of(name) and name.startswith("K_") else noise
            values[name], uncertainty[name] = settle(*four, size(runs[-1]["values"], name), left)
    return Reference(
        values,
        uncertainty,
        _spectrum(runs, shallow, noise),
        runs[-1]["gram"],
        [order + 2, layers],
        runs[-1]["unknowns"],
        0.0,
    )


def settle(
    a: float, b: float, c: float, shallow: float, scale: float, noise: float = 0.0
) -> tuple[float, float]:
    """Value and relative uncertainty from three orders, and the lowest of them with two layers
    less.

    Parameters
    ----------
    a, b, c : float
        Of three orders, ascending.
    shallow : float
        As ``a`` with two layers less.
    scale : float
        What uncertainties are relative to.
    noise : float
        Relative error that the solver may have left.
    """
    first, second = b - a, c - b
    # two layers more take away at least 1 - ratio^2 of what is missing
    deeper = abs(a - shallow) * RATIO**2 / (1 - RATIO**2)
    factor = second / first if first else 0.0
    # steps far below the others are rounding, whose ratio says nothing
    if abs(second) <= ROUNDING * scale:
        tail, doubt = 0.0, abs(second)
    elif 0 < factor < 0.7:
        tail = second * factor / (1 - factor)
        doubt = abs(tail)
    else:
        tail, doubt = 0.0, abs(first) + abs(second)
    return c + tail, (SURE * doubt + deeper) / scale + noise


def _spectrum(runs: list[dict], shallow: dict, noise: float) -> list[dict]:
    """Modes of the finest run with extrapolated frequencies, as far as all runs have as many
    shapes at each place of the spectrum.
    """
    out = []
    for i, mode in enumerate(runs[-1]["modes"]):
        same = [r["modes"][i] if i < len(r["modes"]) else None for r in (*runs, shallow)]
        if any(m is None or m["multiplicity"] != mode["multiplicity"] for m in same):
            break
        hz, doubt = mode["frequency_hz"], 0.0
        if hz > 0:
            hz, doubt = settle(*(m["frequency_hz"] for m in same), hz, noise)
        out.append(mode | {"frequency_hz": hz, "uncertainty": doubt})
    return out


def _solve(scene: Scene, mesh, order: int) -> dict:
    body = spectral(scene, mesh, order)
    supports = as_supports(scene)
    condensed = condense(body, supports, scene.port.name)
    further = {p.name: condense(body, supports, p.name) for p in scene.further_ports}
    names = tuple(port.name for port in scene.ports)
    coupled = condense(body, supports, names) if further else None
    found = modes(body, supports, max(scene.ask.modes, 10) + EXTRA_MODES)
    shapes = [
        {
            "name": m.name,
            "family": m.family,
            "frequency_hz": float(m.frequency_hz),
            "multiplicity": m.multiplicity,
            "captured": float(m.captured),
            "motions": np.round(m.motions / max(np.abs(m.motions).max(), 1e-300), 9).tolist(),
        }
        for m in found.modes
    ]
    return {
        "values": measure(condensed, found, further, coupled),
        "modes": shapes,
        "gram": found.gram.tolist(),
        # eigenvalues err by the square of the shapes' error, of which the residual is the size
        "noise": float(max(condensed.evidence["residual"], found.evidence["residual"] ** 2)),
        # what the inverse of several points makes of it
        "inverted": coupled.evidence["stiffness_error"] if coupled else 0.0,
        "unknowns": body.size,
    }


# ------------------------------------------------------------------------------------------------
# - kept results
def _file(folder: Path, scene: Scene) -> Path:
    # title and questions do not change what is true
    told = json.dumps(
        [
            scene.with_changes(name="", title="", ask=Ask(modes=scene.ask.modes)).as_dict(),
            LEVELS,
            RATIO,
            SIZE,
            4,
        ],
        sort_keys=True,
        default=str,
    )
    return folder / f"{hashlib.sha256(told.encode()).hexdigest()[:24]}.json"


def _read(folder: Path | None, scene: Scene) -> dict | None:
    if folder is None or not _file(folder, scene).exists():
        return None
    return json.loads(_file(folder, scene).read_text())


def _write(folder: Path | None, scene: Scene, content: dict) -> None:
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
        with whole(_file(folder, scene)) as partial:
            partial.write_text(json.dumps(content))


def section_ties(scene: Scene) -> Scene:
    """The fair partner of a beam: section ties at the port and at every bearing."""
    return scene.with_attachment("section")
