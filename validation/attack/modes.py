"""Random shafts against an independent dense solution: no mode may be missed, none wrong by more
than 1e-6 or than its own bound says.

    python -m validation.attack.modes [--runs 1000] [--seed 1]

Shafts are slender or short, solid or thin-walled, of one or several materials, on bearings that are
soft, stiff, coupled, partial or none; bodies are beams, and harmonic solids of low order, small
enough for a dense solution.  That is another way from beginning to end: matrices and springs put
together here, dense factors scaled to a unit diagonal, and values from Ritz steps whose residuals
are taken in extended precision.  Rigid motions are known exactly on both sides. Every run follows
from the seed and its number alone.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass, field

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp

from solidgear.errors import SceneError, SolidgearError
from solidgear.ladder import build
from solidgear.scene import STEEL, Bearing, Material, Port, Scene, Segment
from solidgear.solve.modes import modes
from validation.common import results_folder, show, write_rows

#: relative error of a frequency that is wrong, whatever its bound
WRONG = 1e-6
#: unknowns a dense solution is allowed
DENSE = 1500
EXACT = np.longdouble
MATERIALS = (
    STEEL,
    Material(E=3e9, nu=0.4, density=1400.0),
    Material(E=1.14e11, nu=0.34, density=4430.0),
    Material(E=7e10, nu=0.33, density=2700.0),
    Material(E=1.6e10, nu=0.44, density=11340.0),
)


# --------------------------------------------------------------------------- scenes
@dataclass(frozen=True)
class Case:
    """One run: what is built of what, and how its modes are asked for."""

    number: int
    scene: Scene
    fidelity: str
    options: dict
    ask: dict


def case(seed: int, number: int) -> Case:
    """The case of a number."""
    rng = np.random.default_rng([seed, number])
    while True:
        try:
            scene = _scene(rng)
            break
        except SceneError:
            continue
    fidelity = str(rng.choice(["euler", "timoshenko", "harmonic", "harmonic"]))
    options = (
        {"elements": int(rng.integers(4, 40))} if fidelity != "harmonic" else _light(scene, rng)
    )
    method = rng.choice([None, None, "lanczos", "arpack", "dense"])
    ask = {
        "n": int(rng.integers(1, 17)),
        "method": method,
        "count": bool(rng.random() < 0.5),
        "coupling_tolerance": float(rng.choice([0.0, 1e-6])),
    }
    return Case(number, scene, fidelity, options, ask)


def _log(rng, low, high) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _scene(rng) -> Scene:
    radius, slenderness = (
        _log(rng, 0.005, 0.2),
        _log(rng, 0.3, 80.0 if rng.random() < 0.8 else 300.0),
    )
    length = 2 * radius * slenderness
    count = int(rng.integers(1, 6))
    cuts = np.sort(rng.uniform(0.1, 0.9, count - 1))
    ends = length * np.concatenate([[0.0], cuts, [1.0]])
    wall = rng.choice([1.0, 1.0, _log(rng, 0.01, 0.6)])
    several = rng.random() < 0.35
    base = MATERIALS[rng.integers(len(MATERIALS))]
    parts, before = [], radius * rng.uniform(0.6, 1.0)
    even = rng.random() < 0.4
    for k, (a, b) in enumerate(zip(ends, ends[1:])):
        outer0 = before if even or rng.random() < 0.3 else radius * rng.uniform(0.6, 1.4)
        outer1 = radius * rng.uniform(0.6, 1.4) if rng.random() < 0.2 else outer0
        bore = 0.0 if wall == 1.0 else (1 - wall) * min(outer0, outer1, before)
        material = MATERIALS[rng.integers(len(MATERIALS))] if several else base
        parts.append(
            Segment(
                name=f"s{k}",
                y0=a,
                y1=b,
                outer0=outer0,
                outer1=outer1,
                inner0=bore,
                inner1=bore,
                material=material,
            )
        )
        before = outer1
    bearings = []
    for k in rng.permutation(count)[: rng.integers(0, 4)]:
        a, b = ends[k], ends[k + 1]
        width = (b - a) * rng.uniform(0.1, 0.6)
        y = rng.uniform(a + width / 2, b - width / 2)
        attachment = str(rng.choice(["average", "average", "rigid", "section"]))
        series = (_log(rng, 1e5, 1e10),) if rng.random() < 0.2 else ()
        bearings.append(
            Bearing(
                name=f"b{k}",
                y=y,
                seat_width=width,
                matrix=_springs(rng, radius),
                axial_series=series,
                attachment=attachment,
            )
        )
    k = int(rng.integers(count))
    port = Port(
        y=(ends[k] + ends[k + 1]) / 2,
        lo=ends[k],
        hi=ends[k + 1],
        attachment=str(rng.choice(["average", "section"])),
    )
    housing = _log(rng, 1e5, 1e10) if rng.random() < 0.15 else None
    return Scene.from_parts(parts, bearings=bearings, port=port, housing_axial=housing)


def _springs(rng, radius):
    """Six by six: soft to stiff, radial only, alike in both planes or not, or coupled without
    mercy.
    """
    size, lever = (
        _log(rng, *((1e3, 1e12) if rng.random() < 0.8 else (1.0, 1e16))),
        np.repeat([1.0, radius * rng.uniform(0.2, 2.0)], 3),
    )
    kind = rng.choice(["alike", "alike", "uneven", "radial", "coupled", "one"])
    if kind == "coupled":
        root = rng.standard_normal((6, int(rng.integers(2, 8)))) * lever[:, None]
        return size * root @ root.T
    d = np.exp(rng.uniform(-3, 1, 6))
    if kind == "alike":
        d[0], d[3] = d[2], d[5]
    if kind == "radial":
        d[[1, 3, 4, 5]] = 0.0
    if kind == "one":
        d[np.arange(6) != rng.integers(6)] = 0.0
    d[4] *= rng.random() < 0.3
    return np.diag(size * d * lever**2)


def _light(scene, rng) -> dict:
    """Options of a harmonic solid of few cells."""
    order = int(rng.integers(1, 4))
    thick = max(max(s.outer0, s.outer1) for s in scene.segments)
    return {
        "order": order,
        "layers": int(rng.integers(0, 2)),
        "edge_layers": 0,
        "size": max(scene.length / (14 // order), thick / 2),
    }


# --------------------------------------------------------------------------- dense reference
def springs_by_hand(scene) -> np.ndarray:
    """(6 m, 6 m) stiffness of all bearings, series springs and housing eliminated as unknowns of
    their own.
    """
    count = len(scene.bearings)
    out = np.zeros((6 * count, 6 * count))
    for i, bearing in enumerate(scene.bearings):
        k = np.array(bearing.matrix)
        if bearing.axial_series:
            spring = 1 / sum(1 / s for s in bearing.axial_series)
            k = k - np.outer(k[:, 1], k[1]) / (k[1, 1] + spring)
        out[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] = k
    if scene.housing_axial and count:
        e = np.tile([0.0, 1.0, 0, 0, 0, 0], count)
        out = out - np.outer(out @ e, out @ e) / (e @ out @ e + scene.housing_axial)
    return out


def springs_lost(scene) -> float:
    """What rounding leaves open of the stiffness of stiff bearings in series with soft springs:
    both sides take a difference there.
    """
    stiff = max((b.matrix[1][1] for b in scene.bearings), default=0.0)
    series = [s for b in scene.bearings for s in b.axial_series] + (
        [scene.housing_axial] if scene.housing_axial else []
    )
    return 4 * float(np.finfo(float).eps) * stiff / min(series) if series and stiff else 0.0


class Dense:
    """A body on its bearings as one dense problem, with residuals in extended precision.

    Parameters
    ----------
    body : Body
    scene : Scene
    """

    def __init__(self, body, scene):
        blocks = body.blocks
        k, m = (
            sp.block_diag([getattr(b, name) for b in blocks], format="csr")
            for name in ("stiffness", "mass")
        )
        count, size = len(body.ports), k.shape[0]
        ports, rigid = np.zeros((6 * count, size)), np.zeros((size, 6))
        start = 0
        for b in blocks:
            rows = b.ports.toarray()
            for i, c in enumerate(b.components):
                rigid[start : start + b.size, c] = b.rigid[:, i]
                for p in range(count):
                    ports[6 * p + c, start : start + b.size] = rows[p * len(b.components) + i]
            start += b.size
        springs = springs_by_hand(scene)
        at = ports[6 : 6 + len(springs)]
        # Ports come in the order of the stations, the lumped point first.
        self.k, self.m, self.rigid = k.astype(EXACT), m.astype(EXACT), rigid.astype(EXACT)
        self.ports, self.springs = at.astype(EXACT), springs.astype(EXACT)
        self.free = _unresisted(at, springs, rigid)
        heavy = self.m @ self.rigid
        self._project = heavy, np.linalg.inv((self.rigid.T @ heavy).astype(float)).astype(EXACT)
        self.shift = 0.1 * body.scale
        a = k.toarray() + at.T @ springs @ at + self.shift * m.toarray()
        self._d = 1 / np.sqrt(np.diag(a))
        self._chol = sla.cho_factor(a * np.outer(self._d, self._d))
        self._m = m

    def stiff(self, x):
        """``K x`` in extended precision; rigid motions, which K resists by rounding only, are taken
        out first.
        """
        elastic = x - self.rigid @ (self._project[1] @ (self._project[0].T @ x))
        elastic = elastic - self.rigid @ (self._project[1] @ (self._project[0].T @ elastic))
        force = self.k @ elastic
        force = force - self._project[0] @ (self._project[1] @ (self.rigid.T @ force))
        return force + self.ports.T @ (self.springs @ (self.ports @ x))

    def solve(self, load):
        """``(K + springs + shift M)^-1 load``, refined until the residual is one of extended
        precision.
        """
        x = np.zeros_like(load)
        left = load
        for _ in range(12):
            step = self._d[:, None] * sla.cho_solve(
                self._chol, self._d[:, None] * left.astype(float)
            )
            x = x + step
            if np.abs(step).max() < 1e-17 * np.abs(x).max():
                break
            left = load - self.stiff(x) - self.shift * (self.m @ x)
        return x

    def values(self, n: int, steps: int = 12) -> tuple[np.ndarray, np.ndarray]:
        """Lowest ``n`` eigenvalues, zeros of unresisted motions left out, and what the last step
        changed, relative.
        """
        size = len(self._d)
        skip = self.free
        wanted = min(n + skip + 6, size)
        chol = np.linalg.cholesky(self._m.toarray() * np.outer(self._d, self._d))
        half = sla.cho_solve(self._chol, chol)
        theta, v = sla.eigh(chol.T @ half, subset_by_index=[size - wanted, size - 1])
        x = (self._d[:, None] * (half @ v))[:, ::-1].astype(EXACT)
        last = None
        for _ in range(steps):
            x = self.solve(self.m @ x)
            x = x / np.sqrt(np.einsum("ij,ij->j", x, self.m @ x))
            for _ in range(2):
                gram, energy = x.T @ (self.m @ x), x.T @ self.stiff(x)
                low = np.linalg.cholesky(gram.astype(float)).astype(EXACT)
                inverse = sla.solve_triangular(
                    low.astype(float), np.eye(len(low)), lower=True
                ).astype(EXACT)
                small = (inverse @ energy @ inverse.T).astype(float)
                w, turn = np.linalg.eigh((small + small.T) / 2)
                x = x @ (inverse.T @ turn.astype(EXACT))
            value = np.sort(
                np.einsum("ij,ij->j", x, self.stiff(x)) / np.einsum("ij,ij->j", x, self.m @ x)
            )
            value = value[skip : skip + n]
            if last is not None:
                change = np.abs(value / last - 1).astype(float)
                if change.max(initial=0.0) < 1e-13:
                    break
            last = value
        return value.astype(float), change


def _unresisted(at, springs, rigid) -> int:
    """Number of rigid motions that no spring resists: of the springs' root on motions brought to
    unit size.
    """
    if not len(springs):
        return 6
    d = np.sqrt(np.abs(np.diag(springs)))
    on = d > 0
    w, v = np.linalg.eigh(springs[np.ix_(on, on)] / np.outer(d[on], d[on]))
    root = (v[:, w > 1e-12] * np.sqrt(w[w > 1e-12])).T * d[on]
    reach = root @ (at @ rigid)[on]
    reach = reach / np.maximum(np.linalg.norm(reach, axis=1, keepdims=True), 1e-300)
    reach = reach / np.maximum(np.linalg.norm(reach, axis=0, keepdims=True), 1e-300)
    s = np.linalg.svd(reach, compute_uv=False)
    return 6 - int((s > 1e-9).sum())


# --------------------------------------------------------------------------- judgement
@dataclass
class Verdict:
    """What came of one run."""

    number: int
    what: str = "right"
    worst: float = 0.0
    row: dict = field(default_factory=dict)


def judge(c: Case) -> Verdict:
    """Solve a case both ways."""
    start = time.perf_counter()
    try:
        body = build(c.scene, c.fidelity, **c.options)
    except SolidgearError as error:
        return Verdict(
            c.number, "not built", row={"number": c.number, "what": "not built", "why": str(error)}
        )
    row = {
        "number": c.number,
        "fidelity": c.fidelity,
        "unknowns": body.size,
        "L/D": c.scene.length / (2 * max(s.outer0 for s in c.scene.segments)),
        "bearings": len(c.scene.bearings),
    }
    if body.size > DENSE:
        return Verdict(c.number, "too large", row=row | {"what": "too large"})
    n = c.ask["n"]
    try:
        found = modes(body, c.scene, **c.ask, ovalising=False)
    except SolidgearError as error:
        return Verdict(c.number, "refused", row=row | {"what": "refused", "why": str(error)})
    told = [
        (m.frequency_hz, m.error, m.name)
        for m in found.modes
        if m.frequency_hz > 0
        for _ in range(m.multiplicity)
    ]
    rigid = sum(m.frequency_hz == 0 for m in found.modes)
    dense = Dense(body, c.scene)
    value, change = dense.values(max(n, len(told)))
    exact = np.sqrt(np.maximum(value, 0.0)) / (2 * np.pi)
    row |= {
        "n": n,
        "method": found.evidence["method"],
        "steps": found.evidence["steps"],
        "residual": found.evidence["residual"],
        "error": found.evidence["error"],
    }
    verdict = Verdict(c.number, row=row)
    if rigid != dense.free:
        verdict.what = f"rigid motions: {rigid} told, {dense.free} there"
    elif len(told) < min(n, len(exact)):
        verdict.what = f"{len(told)} shapes told of {n}"
    else:
        place = 0
        for mode in (m for m in found.modes if m.frequency_hz > 0):
            # A pair is told as the root mean square of its two.
            true = np.sqrt(np.mean(exact[place : place + mode.multiplicity] ** 2))
            own = float(change[place : place + mode.multiplicity].max())
            place += mode.multiplicity
            off = abs(mode.frequency_hz / true - 1)
            verdict.worst = max(verdict.worst, off)
            # what the reference itself does not know, and what couplings left out may do
            unknown = found.evidence["coupling_bound"] / 2 + own + springs_lost(c.scene) + 1e-11
            if off > mode.error + unknown or off > WRONG + unknown:
                verdict.what = f"{mode.name} told {mode.frequency_hz:.9g} Hz, is {true:.9g}: {off:.1e} off, {mode.error:.1e} allowed"
                break
    verdict.row |= {
        "what": verdict.what,
        "worst": verdict.worst,
        "seconds": time.perf_counter() - start,
    }
    return verdict


def attack(seed: int, numbers) -> list[Verdict]:
    """Judge the cases of a seed."""
    return [judge(case(seed, number)) for number in numbers]


def main() -> int:
    """Command line; exit code 1 if a mode was missed or wrong."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    found = []
    for number in range(options.first, options.first + options.runs):
        verdict = judge(case(options.seed, number))
        found.append(verdict)
        if verdict.what not in ("right", "too large"):
            print(f"{number}: {verdict.what} {verdict.row.get('why', '')}", flush=True)
    words = {}
    for v in found:
        kind = (
            v.what
            if v.what in ("right", "too large", "not built", "refused")
            else "missed or wrong"
        )
        words[kind] = words.get(kind, 0) + 1
    right = [v.worst for v in found if v.what == "right"]
    show(
        "Modes against a dense solution",
        [
            {
                "seed": options.seed,
                **words,
                "median error": float(np.median(right)),
                "largest error": float(np.max(right)),
            }
        ],
    )
    write_rows(
        results_folder("attack") / f"modes_{options.seed}_{options.first}.csv",
        [v.row for v in found],
    )
    return int("missed or wrong" in words)


if __name__ == "__main__":
    sys.exit(main())
