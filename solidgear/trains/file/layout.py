"""Layout of a train: which shafts mesh, how fast they turn, and the way a torque takes."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from math import isclose

from solidgear.core import SceneError, listed, nearest
from solidgear.trains.file.gears import Member
from solidgear.trains.file.rules import stage_problems
from solidgear.trains.file.shafting import Joint, Shafting

#: names that mean something else in a file, in a result or in an order
RESERVED = (
    "caution cautions cause contact coordinates damping error facts faults files free ground kept "
    "load local losses mesh meshes mesh_force mesh_forces misalignment displacement mode model "
    "models modes name notes operation peaks planetary point points ratio reduction response rigid "
    "rotor rotors seconds shaft shafts source speed speeds statuses title train undriven unknowns "
    "unpublished verdict verdicts"
).split()


OTHER_FLANK = {"left": "right", "right": "left", "concave": "convex", "convex": "concave"}


class PerTurn(float):
    """Teeth that pass in one turn of the shaft `of`."""

    of: str

    def __new__(cls, value: float, of: str = "pinion") -> PerTurn:
        out = super().__new__(cls, value)
        out.of = of
        return out


def layout_problems(train: Shafting) -> Iterator[SceneError]:
    """Yield problems of names, of meshes between unknown shafts, and of shafts without a mesh."""
    for name in train.shafts:
        if name in RESERVED or name in train.rotors or "." in name or not name.strip():
            reason = f"a shaft cannot be called {name!r}; give it another name, without dots"
            yield SceneError(reason, path=("shaft", name))
    problems = [*_meshes(train), *_rotors(train), *stage_problems(train)]
    yield from problems
    if problems:
        return
    yield from _named_twice(train)
    meshed = {side for pair in _joined(train) for side in pair}
    for side in train.shafts:
        if side not in meshed:
            reason = "is in no mesh; write a [[mesh]] between it and another shaft, or leave it out"
            yield SceneError(reason, path=("shaft", side))
    first = next(iter(train.shafts), "")
    reached = {side for side, _ in _outward(train, first)} if train.shafts else set()
    separate = [side for side in train.shafts if side in meshed and side not in reached]
    for side in separate:
        reason = f"no mesh leads from the {first} to it; a train hangs together by its teeth"
        yield SceneError(reason, path=("shaft", side))
    if not separate and meshed == {*train.shafts}:
        yield from _loops(train)


def _meshes(train: Shafting) -> Iterator[SceneError]:
    if not train.meshes and not train.planetary:
        reason = "this table is missing; write [[mesh]] with between, stiffness and line of action"
        yield SceneError(reason, path=("mesh",))
    for k, mesh in enumerate(train.meshes):
        path = ("mesh", k, "between")
        for word in mesh.between:
            side, dot, port = word.partition(".")
            names = [*train.shafts]
            if side not in train.shafts:
                reason = (
                    f"names no shaft {side!r}{nearest(side, names)}; known here: {listed(names)}"
                )
                yield SceneError(reason, path=path)
                continue
            gears = [*train.shafts[side].gears]
            if not gears:
                reason = f"the {side} carries no gear; write teeth under [shaft.{side}]"
                yield SceneError(reason, path=path)
            elif dot and port not in gears:
                reason = f"the {side} carries no gear at {port!r}; it has {listed(gears)}"
                yield SceneError(reason, path=path)
            elif not dot and len(gears) > 1:
                choices = " or ".join(f'"{side}.{port}"' for port in gears)
                yield SceneError(f"the {side} carries several gears; write {choices}", path=path)
        first, second = (word.partition(".")[0] for word in mesh.between)
        if first == second:
            yield SceneError(
                f"both gears are on the {first}; teeth mesh with another shaft", path=path
            )


def _rotors(train: Shafting) -> Iterator[SceneError]:
    for name, rotor in train.rotors.items():
        path = train.rotor_path(name)
        if name != path[0] and (name in RESERVED or "." in name or not name.strip()):
            reason = f"what turns cannot be called {name!r}; give it another name, without dots"
            yield SceneError(reason, path=path)
        if rotor.shaft not in train.shafts:
            names = listed(train.shafts)
            problem = f"names no shaft{nearest(rotor.shaft, train.shafts)}"
            if not rotor.shaft:
                problem = "says which shaft it turns with"
            yield SceneError(f"{problem}; known here: {names}", path=(*path, "shaft"))


def _named_twice(train: Shafting) -> Iterator[SceneError]:
    names = [pair.name for pair in train.pairs]
    for k, name in enumerate(names):
        if name in names[:k]:
            reason = f"{name!r} is there twice; give the meshes names of their own"
            yield SceneError(reason, path=("mesh", k, "name"))


def ends_of(train: Shafting, k: int) -> tuple[tuple[str, str], tuple[str, str]]:
    """Return shaft and lumped point of both gears of mesh k."""
    out = []
    for word in train.meshes[k].between:
        side, _, port = word.partition(".")
        out.append((side, port or next(iter(train.shafts[side].gears))))
    return out[0], out[1]


def is_idler(train: Shafting, end: tuple[str, str]) -> bool:
    """Return True for a gear (shaft and lumped point) that is first in a mesh, and so drives another."""
    return end in [ends_of(train, k)[0] for k in range(len(train.meshes))]


def with_flanks(train: Shafting, k: int, pinion: Member, gear: Member) -> tuple[Member, Member]:
    """Return both gears of mesh k with their loaded flanks: those of the file, or on parallel shafts
    without an operating point the usual ones.
    """
    ends = ends_of(train, k)
    pinion, gear = flanks_from_file(train, ends, pinion, gear)
    if pinion.loaded_side is None and train.point is None and not train.meshes[k].shaft_angle:
        pinion = pinion.with_changes(loaded_side=_usual_flank(train, ends[0][0]))
    return pinion, gear


def _usual_flank(train: Shafting, side: str, passed: tuple[str, ...] = ()) -> str:
    """Return the flank that a shaft drives with where the file gives none: left on the first shaft;
    a shaft that is driven on one flank drives with the other.
    """
    for k in range(len(train.meshes)):
        (driver, port), (driven, _) = ends_of(train, k)
        if driven == side and driver not in passed:
            flank = train.shafts[driver].gears[port].flank
            return OTHER_FLANK[flank or _usual_flank(train, driver, (*passed, side))]
    return "left"


def flanks_from_file(
    train: Shafting, ends: tuple[tuple[str, str], ...], pinion: Member, gear: Member
) -> tuple[Member, Member]:
    """Return both gears of a mesh with the loaded flanks that follow from the file.

    An idler, second in one mesh and first in another, is driven on the flank behind the one that it
    drives with.  Its `loaded_side` is that of the mesh in which it is first, and follows from the
    driver where it is not given.
    """
    meshes = [ends_of(train, k) for k in range(len(train.meshes))]
    if gear.loaded_side and is_idler(train, ends[1]):
        gear = gear.with_changes(loaded_side=OTHER_FLANK[gear.loaded_side])
    if pinion.flank is None and gear.loaded_side in ("left", "right"):
        return pinion.with_changes(loaded_side=gear.loaded_side), gear  # they touch their own kind
    driver, end, passed = pinion, ends[0], 0
    while driver.flank is None and passed < len(meshes):
        before = next((first for first, second in meshes if second == end), None)
        if before is None:
            return pinion, gear
        driver, end, passed = train.shafts[before[0]].member(before[1]), before, passed + 1
    if passed and driver.flank:
        flank = driver.flank if passed % 2 == 0 else OTHER_FLANK[driver.flank]
        pinion = pinion.with_changes(loaded_side=flank)
    return pinion, gear


def _joined(train: Shafting) -> list[tuple[str, str]]:
    """Return the two shafts that each mesh joins, and each planetary stage."""
    words = [mesh.between for mesh in train.meshes]
    words += [(stage.sun, stage.carrier) for stage in train.planetary.values()]
    return [(first.partition(".")[0], second.partition(".")[0]) for first, second in words]


def _outward(train: Shafting, first: str, excluded: int = -1) -> Iterator[tuple[str, int]]:
    """Yield the shafts that joints lead to from the first, each with the joint that leads to it (-1 for
    the first); the joint `excluded` is not passed.
    """
    queue, reached = deque([(first, -1)]), {first}
    while queue:
        side, joint = queue.popleft()
        yield side, joint
        for k, pair in enumerate(_joined(train)):
            if side in pair and k != excluded:
                neighbour = pair[side == pair[0]]
                if neighbour not in reached:
                    reached.add(neighbour)
                    queue.append((neighbour, k))


def outward(
    train: Shafting, first: str, excluded: Joint | None = None
) -> Iterator[tuple[str, Joint | None]]:
    """Yield the shafts that meshes and stages lead to from the first, each with the joint that leads to
    it (None for the first); the joint `excluded` is not passed.
    """
    for side, joint in _outward(train, first, train.joints.index(excluded) if excluded else -1):
        yield side, None if joint < 0 else train.joints[joint]


def turns_of(train: Shafting) -> dict[str, float]:
    """Return the turns of every shaft in one turn of the engine's, by the teeth."""
    out: dict[str, float] = {}
    for side, pair in outward(train, train.reference):
        if pair is None:
            out[side] = 1.0
        elif side == pair.shafts[1]:
            out[side] = out[pair.shafts[0]] / pair.ratio
        else:
            out[side] = out[pair.shafts[1]] * pair.ratio
    return out


def _loops(train: Shafting) -> Iterator[SceneError]:
    """Yield problems of meshes that close a loop with another ratio than the rest of it."""
    turns = turns_of(train)
    for stage in train.stages:
        sun, carrier = stage.shafts
        if carrier in {side for side, _ in outward(train, sun, excluded=stage)}:
            reason = f"closes a loop: other teeth join the {sun} and the {carrier} as well; open it"
            yield SceneError(reason, path=("planetary", stage.called))
    for k, pair in enumerate(train.pairs):
        first, second = pair.shafts
        wanted = turns[first] / turns[second]
        if not isclose(pair.ratio, wanted, rel_tol=1e-12):
            yield SceneError(
                f"closes a loop in which the other meshes turn the {first} {wanted:.6g} times as fast "
                f"as the {second}, and its {pair.gear.teeth} over {pair.pinion.teeth} teeth "
                f"{pair.ratio:.6g} times: the loop cannot turn; correct the teeth",
                path=("mesh", k, "between"),
            )
