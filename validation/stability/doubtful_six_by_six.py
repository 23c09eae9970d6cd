"""Problem: bearing matrices that are singular, indefinite, unsymmetric or not numbers, and an x-z
coupling up to and past the bound of a positive matrix. Reference: the same bearing turned to its
principal directions, where it has no coupling; a turn about the axis changes no frequency.

Models: the program's scene and its Timoshenko beam of the overhung pinion.
"""

from __future__ import annotations

import numpy as np

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.frames import DOF_NAMES
from validation.common import ROOT
from validation.stability.frame import Finding, curve

K = 1e9
GAPS = (*10.0 ** -np.arange(0.5, 16), 0.0)


def turned(gap: float) -> tuple[np.ndarray, np.ndarray]:
    """A radial spring with k_xz = (1 - gap) k, and the same in its principal directions."""
    diagonal = np.diag([K, K, K, 1e6, 0.0, 1e6])
    coupled, principal = diagonal.copy(), diagonal.copy()
    coupled[0, 2] = coupled[2, 0] = K - gap * K
    principal[0, 0], principal[2, 2] = K + (K - gap * K), gap * K
    return coupled, principal


def held(scene, matrix):
    """The scene with that matrix for both bearings."""
    return scene.with_changes(
        bearings=[b.with_changes(matrix=matrix, axial_series=()) for b in scene.bearings]
    )


def sample(edit) -> np.ndarray:
    """A sound diagonal matrix after one edit."""
    matrix = np.diag([K, K, K, 1e6, 0.0, 1e6])
    edit(matrix)
    return matrix


def _set(*places):
    def edit(m):
        for i, j, value in places:
            m[i, j] = value

    return edit


CASES = {
    "sound, free to turn": _set(),
    "no axial stiffness": _set((1, 1, 0)),
    "no tilt stiffness": _set((3, 3, 0), (5, 5, 0)),
    "one direction only (rank one)": _set((0, 0, 0), (1, 1, 0), (3, 3, 0), (5, 5, 0)),
    "nothing at all": _set(*[(i, i, 0) for i in range(6)]),
    "oblique null direction": _set((0, 0, K / 2), (2, 2, K / 2), (0, 2, K / 2), (2, 0, K / 2)),
    "negative diagonal": _set((3, 3, -1.0)),
    "barely negative diagonal, -1e-6 of 1e6": _set((3, 3, -1e-6)),
    "coupling without diagonal": _set((4, 3, 1.0), (3, 4, 1.0)),
    "radial-tilt coupling too strong": _set((2, 3, 4e7), (3, 2, 4e7)),
    "radial-tilt coupling at its bound": _set((2, 3, (K * 1e6) ** 0.5), (3, 2, (K * 1e6) ** 0.5)),
    "x-z coupling 1e-8 past its bound": _set((0, 2, K * (1 + 1e-8)), (2, 0, K * (1 + 1e-8))),
    "x-z coupling 1e-10 past its bound": _set((0, 2, K * (1 + 1e-10)), (2, 0, K * (1 + 1e-10))),
    "unsymmetric by 1e-3": _set((0, 2, 1e-3 * K)),
    "unsymmetric by 1e-8": _set((0, 2, 1e-8 * K)),
    "unsymmetric by 1e-10": _set((0, 2, 1e-10 * K)),
    "NaN": _set((2, 3, np.nan)),
    "infinite": _set((1, 1, np.inf)),
}


def bending(body, scene) -> np.ndarray:
    """The first frequencies, twins repeated, Hz."""
    found = sg.modes(body, as_supports(scene), n=6)
    return np.repeat(found.frequency_hz, found.multiplicity)[:6]


def measure(quick: bool = False) -> list[Finding]:
    """What is refused, what comes out of the rest; the x-z coupling against its turned twin."""
    scene = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    body = sg.build(scene, "timoshenko")
    verdicts = []
    for name, edit in CASES.items():
        try:
            here = held(scene, sample(edit))
        except sg.SceneError as error:
            verdicts.append({"matrix": name, "scene": "refused", "sentence": error.reason})
            continue
        supports = as_supports(here)
        found = sg.condense(body, supports, port=scene.port.name)
        count = supports.unresisted(body).shape[1]
        finite = bool(np.isfinite(found.stiffness).all())
        still = tuple(n for n, row in zip(DOF_NAMES, found.stiffness) if not row.any())
        verdicts.append(
            {
                "matrix": name,
                "scene": "accepted",
                "free motions": count,
                "said to be free": " ".join(found.free_names),
                "of stiffness zero": " ".join(still),
                "stiffness": "finite" if finite else "not finite",
                "modes": len(sg.modes(body, supports, n=6).modes),
            }
        )
    rows = []
    for gap in GAPS[::5] if quick else GAPS:
        coupled, principal = turned(float(gap))
        a, b = held(scene, coupled), held(scene, principal)
        one, two = bending(body, a), bending(body, b)
        free = as_supports(a).unresisted(body).shape[1], as_supports(b).unresisted(body).shape[1]
        error = float(np.abs(one / np.where(two > 0, two, 1.0) - (two > 0)).max())
        rows.append(
            {
                "1 - k_xz / k": float(gap),
                "frequency error": error,
                "free motions, coupled": free[0],
                "free motions, turned": free[1],
            }
        )
    wrong = [
        r["1 - k_xz / k"] for r in rows if r["free motions, coupled"] != r["free motions, turned"]
    ]
    same = [r for r in rows if r["free motions, coupled"] == r["free motions, turned"]]
    worst = max(same, key=lambda r: r["frequency error"])
    refused, accepted = (
        [v["matrix"] for v in verdicts if v["scene"] == word] for word in ("refused", "accepted")
    )
    misnamed = [
        v["matrix"]
        for v in verdicts
        if v["scene"] == "accepted" and v["said to be free"] != v["of stiffness zero"]
    ]
    names = (
        f"A free direction oblique to the axes ({'; '.join(misnamed)}) is said to leave every "
        "component free, though their stiffness is not zero"
        if misnamed
        else "Every component said to be free has stiffness 0"
    )
    return [
        Finding(
            "doubtful_six_by_six",
            "Bearing matrices that cannot be",
            "A bearing matrix that is not symmetric, indefinite or not a number gives "
            "energy back, or has no solution; a singular one leaves motions free.",
            f"Of {len(verdicts)} matrices {len(refused)} are refused and {len(accepted)} accepted; the "
            f"border is 1e-9 of the diagonal. {names}.",
            "Every command refuses such a scene with the pair of components and their "
            "entries. `solidgear check` counts the motions left free, and `stiffness` names "
            "them.",
            "tests/test_bad_scenes.py::test_bad_matrix",
            verdicts,
        ),
        Finding(
            "strong_coupling",
            "Strong x-z coupling of a bearing",
            "As the coupling nears its bound the bearing loses its stiffness in one oblique "
            "direction, and below rounding it is taken as free there.",
            "The same bearing turned to its principal directions has the same frequencies within "
            f"{worst['frequency error']:.0e} (worst at 1 - k_xz / k = {worst['1 - k_xz / k']:.0e}). "
            f"From {max(wrong, default=float('nan')):.0e} down the coupled form counts another "
            "number of free motions.",
            "`solidgear modes` and `stiffness` treat eigenvalues below 1e-12 of the "
            "diagonal as no stiffness; the scene is refused from 1e-9 past the bound.",
            "tests/test_bad_scenes.py::test_refused_in_one_line",
            rows,
        ),
    ]


def draw(finding: Finding, axes) -> None:
    """Errors over the coupling; for the verdicts, what became of each."""
    axes.set_title(finding.method)
    if finding.name == "strong_coupling":
        rows, gap = finding.rows, "1 - k_xz / k"
        words = "coupled against turned bearing, worst frequency"
        least = {"least_x": 1e-17, "least": 1e-17}
        curve(axes, rows, gap, "frequency error", "o-", "#0072b2", words, **least)
        other = [r for r in rows if r["free motions, coupled"] != r["free motions, turned"]]
        words = "another number of free motions"
        curve(axes, other, gap, lambda r: 3.0, "x", "#aa2222", words, **least)
        axes.set(xlabel=gap, ylabel="relative error", ylim=(1e-17, 30))
        axes.legend(fontsize=8)
        return
    rows = finding.rows[::-1]
    for i, r in enumerate(rows):
        refused = r["scene"] == "refused"
        reach = 6.5 if refused else max(r["free motions"], 0.1)
        axes.barh(i, reach, color="#c4541c" if refused else "#0072b2")
    axes.set_yticks(range(len(rows)), [r["matrix"] for r in rows], fontsize=6)
    axes.set(xlabel="rigid motions left free (orange: refused)")
