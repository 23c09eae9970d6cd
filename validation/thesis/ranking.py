"""What moves the mesh force of the geared rotor most: one thing at a time, against both shafts solid.

The measure is the rms over frequency, from 100 to 4000 Hz in equal steps, of the change of the mesh
force in decibels at the same frequency; below and above 1 kHz as well.

    python -m validation.thesis.ranking
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

import solidgear as sg
from solidgear.core.scene import Scene
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.local_give import local_give
from solidgear.trains.assembly.shaft import JUDGE
from solidgear.trains.file.train import SIDES, Train
from solidgear.trains.response.drive import Drive
from validation.common import ROOT, results_folder, show, write_rows

LOWEST, MIDDLE, HIGHEST = 100.0, 1000.0, 4000.0
POINTS = 3901
BEAM, LUMPED = "timoshenko", "lumped"


def with_scenes(train: Train, change) -> Train:
    """The same train, both shafts changed."""
    members = {}
    for side in SIDES:
        member = train.member(side)
        members[side] = member.with_changes(scene=change(member.scene))
    return train.with_changes(**members)


def with_bearings(scene: Scene, factor: float) -> Scene:
    """A shaft with all bearings stiffer or softer by a factor."""
    housing = scene.housing_axial
    softer = None if housing is None else factor * housing
    return scene.with_bearing_scale(factor).with_changes(housing_axial=softer)


def with_engine_at_the_end(train: Train) -> Train:
    """The engine's spring on the far end of the pinion's shaft and not on its lumped point."""
    length = train.pinion.scene.length
    table = train.engine.spring.model_dump(by_alias=True) | {
        "at": None,
        "position": length - 0.004,
        "from": "start",
        "seat_width": 0.008,
    }
    spring = type(train.engine.spring)(**table)
    return train.with_changes(engine=train.engine.with_changes(spring=spring))


def with_local(train: Train, *harmonics: int) -> Train:
    """Harmonics of two and more nodal diameters driven at the mesh point."""
    return train.with_changes(mesh=train.mesh.with_changes(local_harmonics=harmonics))


def with_local_held(train: Train, *harmonics: int) -> Train:
    """The same, the teeth as much stiffer as those harmonics give way: the modes alone."""
    local = with_local(train, *harmonics)
    assembly = Assembly(local)
    give = sum(local_give(assembly, assembly.system(JUDGE, JUDGE)).values())
    stiffness = 1 / (1 / assembly.contact.stiffness - give)
    return local.with_changes(mesh=local.mesh.with_changes(stiffness=stiffness))


def variants(train: Train) -> dict[str, tuple[Train, str, str]]:
    """Train, model of the pinion's shaft and of the gear's, by what is changed."""
    mesh = train.mesh
    stiff = mesh.with_changes(stiffness=2 * mesh.stiffness)
    return {
        "teeth push where they touch, n = 2": (with_local(train, 2), JUDGE, JUDGE),
        "teeth push where they touch, n = 2, 3": (with_local(train, 2, 3), JUDGE, JUDGE),
        "the same, compliance of the mesh held": (with_local_held(train, 2, 3), JUDGE, JUDGE),
        "mesh stiffness x2": (train.with_changes(mesh=stiff), JUDGE, JUDGE),
        "bearings x0.1": (with_scenes(train, lambda s: with_bearings(s, 0.1)), JUDGE, JUDGE),
        "rigid instead of averaged seats": (
            with_scenes(train, lambda s: s.with_attachment("rigid")),
            JUDGE,
            JUDGE,
        ),
        "gear as a beam": (train, JUDGE, BEAM),
        "pinion as a beam": (train, BEAM, JUDGE),
        "both lumped, six motions": (train, LUMPED, LUMPED),
        "both lumped, axial mass total": (train, f"{LUMPED}-bending", f"{LUMPED}-bending"),
        "engine spring at the shaft's end": (with_engine_at_the_end(train), JUDGE, JUDGE),
    }


def ranking(
    train: Train, settings: Mapping[str, Mapping] | None = None, highest: float = HIGHEST
) -> list[dict]:
    """Rows of the table, the largest change first.

    Parameters
    ----------
    settings : mapping, optional
        Builder options, for coarser meshes.
    highest : float
        Hz.
    """
    hz = np.linspace(LOWEST, highest, POINTS)
    usual = Assembly(train, settings=settings or {})
    base = np.abs(Drive(usual, JUDGE, JUDGE).mesh(hz)[1])
    rows = []
    for name, (changed, pinion, gear) in variants(train).items():
        assembly = usual if changed is train else Assembly(changed, settings=settings or {})
        size = np.abs(Drive(assembly, pinion, gear).mesh(hz)[1])
        decibels = 20 * np.log10(size / base)
        low = hz <= MIDDLE
        rows.append(
            {
                "what is changed": name,
                "rms dB": _rms(decibels),
                "most dB": float(np.abs(decibels).max()),
                "below 1 kHz": _rms(decibels[low]),
                "above 1 kHz": _rms(decibels[~low]),
            }
        )
    return sorted(rows, key=lambda row: -row["rms dB"])


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def main() -> None:
    """Measure, and show the table."""
    rows = ranking(sg.load_train(ROOT / "geometry" / "axle_overhung.toml"))
    shown = [{k: v if isinstance(v, str) else round(v, 2) for k, v in r.items()} for r in rows]
    write_rows(results_folder("axle_ranking") / "ranking.csv", shown)
    show(f"What moves the mesh force, rms dB from {LOWEST:g} to {HIGHEST:g} Hz", shown)


if __name__ == "__main__":
    main()
