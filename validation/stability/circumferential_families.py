"""Problem: free shafts drawn at random (stepped, hollow, flanged, of two materials) whose walls
ovalise with n = 2, 3, ... waves.  Reference: each family's own block.

Models: the closed form and the light mesh by which the program decides which families to solve.
The closed form must never lie above a family's lowest frequency by more than its margin, the light
mesh never above by more than its own; a rule that only waits for the lowest frequencies to rise is
run beside them.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse.linalg as spla

from solidgear.core.meshing.grading import Grading
from solidgear.core.meshing.layout import layout
from solidgear.core.meshing.meridian import meridian
from solidgear.core.models.harmonic.blocks import Work
from solidgear.core.models.harmonic.body import Families
from solidgear.core.models.harmonic.mesh import harmonic_mesh
from solidgear.core.scene import STEEL, Material, Scene, Segment
from solidgear.core.solve.groups import LIGHT, MARGIN
from validation.stability.frame import Finding, columns

MATERIALS = (
    STEEL,
    STEEL,
    Material(E=3e9, nu=0.4, density=1400.0),
    Material(E=1.14e11, nu=0.34, density=4430.0),
    Material(E=1.6e10, nu=0.44, density=11340.0),
)
KINDS = ("stepped", "tube", "flanged tube", "flange on a shaft", "web and rim", "cones")
WAVES = range(2, 13)


def random_shaft(rng: np.random.Generator, kind: str) -> Scene:
    """A shaft of a kind; lengths go with its radius of 50 mm or so."""
    rows = {
        "stepped": _stepped,
        "tube": _tube,
        "flanged tube": _flanged_tube,
        "flange on a shaft": _flange_on_a_shaft,
        "web and rim": _web_and_rim,
        "cones": _cones,
    }[kind](rng)
    two = rng.random() < 0.3
    parts, y = [], 0.0
    base = MATERIALS[rng.integers(len(MATERIALS))]
    for k, (length, outer0, outer1, inner) in enumerate(rows):
        material = MATERIALS[rng.integers(len(MATERIALS))] if two else base
        parts.append(
            Segment(
                name=f"s{k}",
                y0=y,
                y1=y + length,
                outer0=outer0,
                outer1=outer1,
                inner0=inner,
                inner1=inner,
                material=material,
            )
        )
        y = parts[-1].y1
    return Scene.from_parts(parts)


def _log(rng, low, high) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _stepped(rng):
    bore = rng.choice([0.0, 0.0, 0.3, 0.6]) * 0.02
    return [
        (_log(rng, 0.01, 0.15), r, r, bore) for r in rng.uniform(0.02, 0.07, rng.integers(1, 7))
    ]


def _tube(rng):
    return [
        (_log(rng, 0.03, 1.0), r, r, r * (1 - _log(rng, 0.01, 0.5)))
        for r in np.full(rng.integers(1, 4), 0.05)
    ]


def _flanged_tube(rng):
    """A thin tube between flanges or diaphragms, thick or thin."""
    wall = _log(rng, 0.01, 0.2)
    middle = (_log(rng, 0.03, 0.5), 0.05, 0.05, 0.05 * (1 - wall))
    ends = []
    for _ in range(2):
        outer = 0.05 * rng.uniform(1.0, 2.0)
        ends.append(
            (
                _log(rng, 0.002, 0.04),
                outer,
                outer,
                float(rng.choice([0.0, 0.02, 0.05 * (1 - wall)])),
            )
        )
    return [ends[0], middle, ends[1]][: rng.integers(2, 4)]


def _flange_on_a_shaft(rng):
    r = rng.uniform(0.015, 0.04)
    wide = r * rng.uniform(1.5, 5.0)
    bore = r * float(rng.choice([0.0, 0.5, 0.9]))
    return [
        (_log(rng, 0.02, 0.3), r, r, bore),
        (_log(rng, 0.002, 0.04), wide, wide, bore),
        (_log(rng, 0.02, 0.3), r, r, bore),
    ][: rng.integers(2, 4)]


def _web_and_rim(rng):
    """A thin disc in the middle of a rim that is a tube of its own."""
    outer, half = 0.1, _log(rng, 0.005, 0.05)
    inner = outer * (1 - _log(rng, 0.03, 0.3))
    return [
        (half, outer, outer, inner),
        (_log(rng, 0.002, 0.02), outer, outer, 0.0),
        (half * rng.uniform(0.3, 1.0), outer, outer, inner),
    ]


def _cones(rng):
    ends = rng.uniform(0.02, 0.08, 5)
    bore = 0.02 * float(rng.choice([0.0, 0.5, 0.9]))
    return [(_log(rng, 0.02, 0.2), ends[k], ends[k + 1], bore) for k in range(rng.integers(1, 5))]


def lowest(scene: Scene, waves, order: int = 4) -> np.ndarray:
    """Lowest frequency (Hz) of each family by its own block, on a mesh fine enough for a per cent."""
    thick = max(max(s.outer0, s.outer1) for s in scene.segments)
    flat = meridian(
        scene,
        layout(scene, Grading(layers=1, edge_layers=0, size=max(scene.length / 30, thick / 6))),
    )
    work = Work(scene, harmonic_mesh(flat, order))
    out = []
    for n in waves:
        block = work.block(f"ovalising_{n}", (), ())
        value = spla.eigsh(
            block.stiffness.tocsc(),
            1,
            block.mass.tocsc(),
            sigma=0.0,
            v0=np.ones(block.size),
            return_eigenvectors=False,
            tol=1e-4,
        )
        out.append(np.sqrt(value[0]) / (2 * np.pi))
    return np.array(out)


def shaft(seed: int, kind: str, waves=WAVES, order: int = 4) -> dict:
    """One shaft: how the closed form and the light mesh compare, whether the lowest frequencies
    fall again after a rise, and what rules would miss.
    """
    scene = random_shaft(np.random.default_rng([seed, KINDS.index(kind)]), kind)
    found = Families(scene, None)
    exact = lowest(scene, waves, order)
    bound, light = (
        np.array([found.bound(n) for n in waves]),
        np.array([found.light(n) for n in waves]),
    )
    rising = np.flatnonzero(np.diff(exact) > 0)
    first_rise = int(rising[0]) if len(rising) else len(exact) - 1
    again = (
        exact[first_rise + 1 :].min(initial=np.inf) / exact[first_rise + 1] - 1
        if len(rising)
        else 0.0
    )
    least = int(exact.argmin())
    return {
        "kind": kind,
        "seed": seed,
        "materials": len({s.material for s in scene.segments}),
        "n of the least": waves[least],
        "least Hz": float(exact[least]),
        "closed form / lowest": float((bound / exact).max()),
        "light / lowest": float((light / exact).max()),
        "falls again by": float(min(again, 0.0)),
        "missed, rising alone": _missed_rising(exact),
        "missed, program": _missed(exact, bound, light),
    }


def _limits(exact) -> np.ndarray:
    """Frequencies up to which modes might be asked for: just above every family's lowest, and
    between.
    """
    return np.unique(np.concatenate([1.001 * exact, np.sqrt(exact[1:] * exact[:-1])]))


def _missed_rising(exact) -> int:
    """Limits at which 'stop when the lowest lies above and has begun to rise' leaves a family out
    that lies below.
    """
    missed = 0
    for limit in _limits(exact):
        stop = next(
            (k for k in range(1, len(exact)) if exact[k] > limit and exact[k] > exact[k - 1]),
            len(exact) - 1,
        )
        missed += bool((exact[stop + 1 :] < limit).any())
    return missed


def _missed(exact, bound, light) -> int:
    """The same for the program's rule: families up to the first whose closed form lies above by its
    margin, less those whose light mesh does by its own.
    """
    missed = 0
    for limit in _limits(exact):
        above = np.flatnonzero(bound > MARGIN * limit)
        stop = int(above[0]) if len(above) else len(exact)
        solved = (np.arange(len(exact)) < stop) & (light <= 1.01 * LIGHT * limit)
        missed += bool((exact[~solved] < limit).any())
    return missed


def measure(quick: bool = False) -> Finding:
    """Families of a few hundred shafts."""
    count = 3 if quick else 50
    waves = range(2, 8) if quick else WAVES
    rows = [shaft(seed, kind, waves, 3 if quick else 4) for kind in KINDS for seed in range(count)]
    alone, program = (
        sum(r[f"missed, {rule}"] > 0 for r in rows) for rule in ("rising alone", "program")
    )
    return Finding(
        "circumferential_families",
        "Ovalising families",
        "The lowest frequency over n = 2, 3, ... waves falls to a minimum and rises, "
        "but a shaft of several walls has several minima.",
        f"On {len(rows)} shafts, to stop at the first rise above the limit misses a family on {alone}, "
        f"the program's rule on {program}. Its closed form lies at most "
        f"{max(r['closed form / lowest'] for r in rows):.2f} times above a family's lowest "
        f"(margin {MARGIN:g}), its light mesh {max(r['light / lowest'] for r in rows):.2f} times (margin {LIGHT:g}).",
        "`modes` on a harmonic solid solves every family that may begin below the "
        "highest mode told, and names those that were counted.",
        "tests/test_families.py::test_rule_misses_no_family",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """Both estimates over the wave number of the least."""
    for kind, marker in zip(KINDS, "os^vDP"):
        rows = [r for r in finding.rows if r["kind"] == kind]
        estimates = columns(rows, "closed form / lowest", "light / lowest")
        axes.plot(*estimates, marker, label=kind, alpha=0.7)
    axes.axvline(MARGIN, color="#555555", ls=":")
    axes.axhline(LIGHT, color="#555555", ls=":")
    axes.set(
        xlabel="closed form over lowest frequency, largest of all n",
        ylabel="light mesh over lowest frequency",
        title=finding.method,
    )
    axes.legend()
