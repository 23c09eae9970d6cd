"""Problem: every shipped scene with one of the usual slips in units: millimetres read as metres and
the other way, MPa or GPa read as Pa, g/cm3 or t/mm3 read as kg/m3, N/mm or kN/mm read as N/m.
Reference: none is needed; a guard must fire on the slip and stay silent on the sound scene.

Models: criteria that cost nothing, each over all scenes and slips.
"""

from __future__ import annotations

import numpy as np

import solidgear as sg
from validation.common import ROOT
from validation.shipped import shipped_shafts
from validation.stability.frame import Finding

GEOMETRY = ROOT / "geometry"
#: slip -> factors on lengths, E, density, translational stiffness (its tilt stiffness follows its
#: own unit)
SLIPS = {
    "sound": {},
    "mm read as m": {"length": 1e3},
    "m read as mm": {"length": 1e-3},
    "inch read as mm": {"length": 1 / 25.4},
    "GPa read as Pa": {"E": 1e-9},
    "MPa read as Pa": {"E": 1e-6},
    "Pa read as MPa": {"E": 1e6},
    "psi read as Pa": {"E": 1 / 6894.76},
    "g/cm3 read as kg/m3": {"density": 1e-3},
    "t/mm3 read as kg/m3": {"density": 1e-12},
    "kg/m3 read as g/cm3": {"density": 1e3},
    "N/mm read as N/m": {"spring": 1e-3},
    "kN/mm read as N/m": {"spring": 1e-6},
    "N/um read as N/m": {"spring": 1e-6},
    "N/m read as N/mm": {"spring": 1e3},
    "N/mm read as N/m, axial only": {"axial": 1e-3},
    "N/m read as N/mm, axial only": {"axial": 1e3},
    "N mm/rad read as N m/rad": {"tilt": 1e3},
    "N m/rad read as N mm/rad": {"tilt": 1e-3},
}


def slipped(scene, length=1.0, E=1.0, density=1.0, spring=1.0, tilt=1.0, axial=1.0):
    """The scene as it would have been read."""
    segments = tuple(
        s.with_changes(
            y0=s.y0 * length,
            y1=s.y1 * length,
            outer0=s.outer0 * length,
            outer1=s.outer1 * length,
            inner0=s.inner0 * length,
            inner1=s.inner1 * length,
            material=s.material.with_changes(
                E=s.material.E * E, density=s.material.density * density
            ),
        )
        for s in scene.segments
    )
    # Couplings carry the geometric mean of the two, so that the matrix stays positive.
    scale = np.sqrt(np.repeat([spring, tilt], 3) * [1.0, axial, 1.0, 1.0, 1.0, 1.0])
    bearings = tuple(
        b.with_changes(
            y=b.y * length,
            seat_width=b.seat_width * length,
            matrix=np.array(b.matrix) * np.outer(scale, scale),
            axial_series=tuple(k * spring * axial for k in b.axial_series),
        )
        for b in scene.bearings
    )
    port = scene.port.with_changes(
        y=scene.port.y * length, lo=scene.port.lo * length, hi=scene.port.hi * length
    )
    housing = None if scene.housing_axial is None else scene.housing_axial * spring
    return scene.with_changes(
        segments=segments,
        bearings=bearings,
        port=port,
        housing_axial=housing,
        material=segments[0].material,
    )


def _springs(scene):
    """The bearings with a stiffness, which rigid holds have none of."""
    return [b for b in scene.bearings if not b.hold]


def ratios(scene) -> dict[str, float]:
    """Numbers that a slip moves by orders of magnitude; no solution is needed for any."""
    length = scene.length
    second = (
        sum(
            np.pi
            / 4
            * (((s.outer0 + s.outer1) / 2) ** 4 - ((s.inner0 + s.inner1) / 2) ** 4)
            * s.length
            for s in scene.segments
        )
        / length
    )
    area = (
        sum(
            np.pi * (((s.outer0 + s.outer1) / 2) ** 2 - ((s.inner0 + s.inner1) / 2) ** 2) * s.length
            for s in scene.segments
        )
        / length
    )
    e = np.array([s.material.E for s in scene.segments])
    rho = np.array([s.material.density for s in scene.segments])
    bend = e.mean() * second
    out = {
        "length m": length,
        "E Pa": e.min() if e.min() < 1e10 else e.max(),
        "density kg/m3": rho.min() if rho.min() < 2000 else rho.max(),
    }
    out["wave speed m/s"] = float(np.sqrt(e.mean() / rho.mean()))
    out["first bending, free, Hz"] = float(
        22.37 / (2 * np.pi) * np.sqrt(bend / (rho.mean() * area * length**4))
    )
    if springs := _springs(scene):
        k = [np.diag(b.matrix) for b in springs]
        radial = [v for row in k for v in row[[0, 2]] if v > 0]
        axial = [float(row[1]) for row in k if row[1] > 0]
        turn = [
            (row[3 + i], row[2 - i])
            for row in k
            for i in (0, 2)
            if row[3 + i] > 0 and row[2 - i] > 0
        ]
        local = e.mean() * np.mean([2 * s.outer0 for s in scene.segments])
        out["bearing radial / (E d)"] = float(np.exp(np.mean(np.log(radial))) / local)
        if axial:  # by the one farthest from what is usual
            out["bearing axial / (E d)"] = max((v / local for v in axial), key=_unusual)
        if turn:
            out["tilt arm over d"] = float(
                np.sqrt(np.mean([t / r for t, r in turn]))
                / np.mean([2 * s.outer0 for s in scene.segments])
            )
    return out


def _unusual(share: float) -> float:
    """How far a share is from the middle of its limits, in powers of ten."""
    low, high = LIMITS["bearing axial / (E d)"]
    return abs(np.log10(share / np.sqrt(low * high)))


#: criterion -> least and greatest value of a sound scene
LIMITS = {
    "length m": (5e-3, 20.0),
    "E Pa": (1e8, 1.5e12),
    "density kg/m3": (500.0, 25000.0),
    "wave speed m/s": (300.0, 20000.0),
    "first bending, free, Hz": (1.0, 2e5),
    "bearing radial / (E d)": (2e-5, 10.0),
    "bearing axial / (E d)": (5e-6, 5.0),
    "tilt arm over d": (0.03, 2.0),
}


def measure(quick: bool = False) -> Finding:
    """Which criterion fires on which slip of which scene."""
    rows = []
    paths = shipped_shafts()
    for path in paths[:3] if quick else paths:
        scene = sg.load(path)
        for slip, factors in SLIPS.items():
            moved = set(factors) & {"spring", "tilt", "axial"}
            if (
                moved
                and not _springs(scene)
                or "tilt" in moved
                and not any(b.matrix[3][3] for b in _springs(scene))
            ):
                continue
            row = {"scene": path.stem, "slip": slip}
            try:
                here = slipped(scene, **factors)
            except sg.SceneError as error:
                rows.append(row | {"refused": error.reason})
                continue
            values = ratios(here)
            rows.append(row | values | {"refused": "", "fires": ", ".join(_fired(values))})
    false = [r for r in rows if r["slip"] == "sound" and (r["refused"] or r["fires"])]
    caught = {
        slip: (
            sum(bool(r["refused"] or r.get("fires")) for r in own),
            sum(bool(r["refused"]) for r in own),
            len(own),
        )
        for slip in SLIPS
        if slip != "sound" and (own := [r for r in rows if r["slip"] == slip])
    }
    refused = [slip for slip, (_, no, all_) in caught.items() if no == all_]
    only = [slip for slip, (yes, no, all_) in caught.items() if yes == all_ and no < all_]
    part = [f"{slip} ({yes} of {all_})" for slip, (yes, _, all_) in caught.items() if yes < all_]
    return Finding(
        "wrong_units",
        "A scene in wrong units",
        "A slip of a factor 1000 in units gives a shaft that solves without complaint: "
        "a scene of consistent numbers has no size of its own.",
        f"Of {len(caught)} slips over {len({r['scene'] for r in rows})} shipped scenes {len(refused)} are "
        f"refused in every scene and {len(only)} cautioned in every one; only in some: "
        f"{', '.join(part) or 'none'}. False alarms on sound scenes: {len(false)}.",
        "Every command refuses a scene longer than 20 m, shorter than 1 mm or thicker "
        "than 10 m in radius. `solidgear check` cautions on sizes, speeds and stiffness "
        "ratios out of range.",
        "tests/test_check_guards.py::test_guard[E in GPa read as Pa]",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """A square for each slip and criterion: the share of scenes in which it fires."""
    slips = list(dict.fromkeys(r["slip"] for r in finding.rows))
    names = ["refused as scene", *LIMITS]
    share = np.zeros((len(slips), len(names)))
    for i, slip in enumerate(slips):
        own = [r for r in finding.rows if r["slip"] == slip]
        share[i, 0] = np.mean([bool(r["refused"]) for r in own])
        for j, name in enumerate(LIMITS, start=1):
            share[i, j] = np.mean([name in _fired(r) for r in own])
    axes.imshow(share, cmap="Blues", vmin=0, vmax=1, aspect="auto")
    axes.set_yticks(range(len(slips)), slips, fontsize=7)
    axes.set_xticks(range(len(names)), names, fontsize=6, rotation=20, ha="right")
    for i, j in np.ndindex(*share.shape):
        if share[i, j]:
            axes.text(
                j,
                i,
                f"{100 * share[i, j]:.0f} %",
                ha="center",
                va="center",
                fontsize=6,
                color="white" if share[i, j] > 0.5 else "black",
            )
    axes.set_title(finding.method)
    axes.grid(False)


def _fired(row) -> list[str]:
    return [
        name for name, (low, high) in LIMITS.items() if name in row and not low <= row[name] <= high
    ]
