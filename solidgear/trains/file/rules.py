"""Rules for planetary stages and the housing of a train, one sentence for each problem."""

from __future__ import annotations

from collections.abc import Iterator

from solidgear.core import SceneError, listed, nearest
from solidgear.trains.file.flank_rules import stage_flank_problems
from solidgear.trains.file.housing import HOUSING
from solidgear.trains.file.planetary import Planetary, stage_of
from solidgear.trains.file.shafting import Shafting


def stage_problems(train: Shafting) -> Iterator[SceneError]:
    """Yield problems of planetary stages: unknown shafts or gears, names, teeth that do not fit."""
    for name, table in train.planetary.items():
        path = ("planetary", name)
        if "." in name or not name.strip() or name in train.shafts or name in train.rotors:
            reason = f"a stage cannot be called {name!r}; give it a name of its own, without dots"
            yield SceneError(reason, path=path)
            continue
        problems = [*_ends(train, table)]
        yield from (problem.located(None, prefix=path) for problem in problems)
        if not problems:
            yield from (_in_file(train, name, problem) for problem in _teeth(train, name))


def _in_file(train: Shafting, name: str, problem: SceneError) -> SceneError:
    """Return a problem of a stage where the file has it: that of a key of the sun with its gear."""
    table, (first, *keys) = train.planetary[name], problem.path
    if first != "sun" or not keys:
        return problem.located(None, prefix=("planetary", name))
    side, _, port = table.sun.partition(".")
    gears = train.shafts[side].gears
    gear = ("gears", port) if len(gears) > 1 else ()
    return problem.located(None, path=(*train.shaft_path(side), *gear, *keys))


def _ends(train: Shafting, table: Planetary) -> Iterator[SceneError]:
    """Yield problems of the gear that is the sun, and of the shaft that is the carrier."""
    for key, word in (("sun", table.sun), ("carrier", table.carrier)):
        side, dot, port = word.partition(".")
        if side not in train.shafts:
            names = listed(train.shafts)
            hint = nearest(side, train.shafts)
            yield SceneError(f"names no shaft {side!r}{hint}; known here: {names}", path=(key,))
            continue
        shaft = train.shafts[side]
        places = [*shaft.gears] if key == "sun" else [p.name for p in shaft.scene.ports]
        kind = "gear" if key == "sun" else "lumped point"
        if not places:
            reason = f"the {side} carries no gear; write teeth and module under [shaft.{side}]"
            yield SceneError(reason, path=(key,))
        elif dot and port not in places:
            reason = f"the {side} has no {kind} at {port!r}; it has {listed(places)}"
            yield SceneError(reason, path=(key,))
        elif not dot and key == "sun" and len(places) > 1:
            choices = " or ".join(f'"{side}.{port}"' for port in places)
            yield SceneError(f"the {side} carries several gears; write {choices}", path=(key,))
    if table.sun.partition(".")[0] == table.carrier.partition(".")[0]:
        reason = "sun and carrier are one shaft; name two"
        yield SceneError(reason, path=("carrier",))


def _teeth(train: Shafting, name: str) -> Iterator[SceneError]:
    """Yield problems of teeth that are sound each by itself."""
    stage = stage_of(name, train.planetary[name], train.shafts)
    gear, (side, _), (port, _) = stage.sun, stage.shafts, stage.ports
    gear_label = f"the gear {side}.{port}, the sun,"
    if gear.module is None:
        yield SceneError(f"{gear_label} needs its module", path=("sun",))
    elif gear.helix_angle and gear.hand is None:
        yield SceneError(f"{gear_label} has helical teeth; give their hand", path=("sun",))
    elif gear.profile_shift:
        reason = f"{gear_label} has a profile_shift, which stages cannot have; leave it out"
        yield SceneError(reason, path=("sun",))
    else:
        try:
            _ = stage.teeth
            yield from stage_flank_problems(stage)
        except SceneError as error:
            keys = {"ring": "ring_teeth", "planets": "angles" if stage.table.angles else "planets"}
            for problem in error.problems:
                yield problem.located(
                    None, path=tuple(keys.get(str(key), key) for key in problem.path)
                )


def housing_problems(train: Shafting) -> Iterator[SceneError]:
    """Yield problems of the housing of a train: unknown or doubly housed shafts, and names."""
    if train.housing is None:
        return
    for kind, names in (("shaft", train.shafts), ("rotor", train.rotors)):
        if HOUSING in names:
            reason = f"a {kind} beside a housing cannot be called {HOUSING!r}; give it another name"
            yield SceneError(reason, path=(kind, HOUSING))
    for k, side in enumerate(train.housing.carries or ()):
        if side not in train.shafts:
            choices = [*train.shafts]
            reason = (
                f"names no shaft {side!r}{nearest(side, choices)}; known here: {listed(choices)}"
            )
            yield SceneError(reason, path=(HOUSING, "carries", k))
    if (matrices := train.housing.matrices) is not None:
        scenes = {side: train.shafts[side].scene for side in train.housed}
        needed = {f"{side}.{b.name}": "bearing" for side in scenes for b in scenes[side].bearings}
        needed |= {s.ring_point: "ring" for s in train.stages if {*s.shafts} & {*train.housed}}
        for name, kind_of_point in needed.items():
            if name not in (choices := [*matrices.positions]):
                reason = f"has no point {name!r}{nearest(name, choices)}, where that {kind_of_point} stands"
                yield SceneError(
                    f"{reason}; there are {listed(choices)}", path=(HOUSING, "matrices")
                )
    for side in train.housed:
        scene = train.shafts[side].scene
        if scene.housing is not None or scene.housing_axial is not None:
            reason = (
                f"has a [housing] of its own, and that of the train carries the bearings of the {side}; "
                "leave one out, or the shaft out of carries"
            )
            yield SceneError(reason, path=(*train.shaft_path(side), "scene"))
