"""The same shaft described otherwise: what must not change its numbers, or changes them by a known
factor.

Scenes are rewritten as tables in SI (:meth:`solidgear.Scene.to_dict`), in which all places count
from the start of the shaft.  A rewriting that does not know an entry of a scene leaves that scene
out.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import solidgear as sg
from solidgear.core.quantity import Quantity
from validation.agree.commands import Numbers
from validation.agree.relation import Number, Relation

KIND = "described otherwise"
#: a factor that is exact in binary, so that no digit of a length is lost
TWO = 2.0
Tables = dict[str, Any]
#: entries of a table of the file beside the shaft itself, which no rewriting changes
WORDS = {"title", "name", "source", "ask", "attachment", "uncertain"}
SHAFT = {"material", "segment", "bearing", "port", "mass"}


class NotKnown(Exception):
    """A scene has an entry that a rewriting does not know."""


@dataclass(frozen=True)
class Rewriting:
    """A way to describe a shaft otherwise."""

    name: str
    #: changes tables where they stand; raises `NotKnown`
    change: Callable[[Tables], None]
    #: expected factor of a number that is named
    factor: Callable[[Quantity], float] = lambda _: 1.0
    #: name under which a number appears afterwards
    renamed: Callable[[str], str] = lambda name: name
    #: the mesh stays the same, so that numbers are equal to rounding
    same_mesh: bool = True
    keys: frozenset[str] = frozenset(WORDS | SHAFT)


def _turn(rotation: np.ndarray) -> Callable[[Tables], None]:
    """Return the change that turns all springs by a (3, 3) rotation or reflection."""
    determinant = round(float(np.linalg.det(rotation)))
    six = np.zeros((6, 6))
    six[:3, :3], six[3:, 3:] = rotation, determinant * rotation

    def change(tables: Tables) -> None:
        for bearing in tables.get("bearing", []):
            _give(bearing, six @ _matrix(bearing) @ six.T)
        for mass in tables.get("mass", []):
            mass["offset"] = (rotation @ np.array(mass.get("offset", [0.0] * 3))).tolist()
            if "inertia" in mass:
                if np.ndim(mass["inertia"]) != 1:
                    raise NotKnown("products of inertia")
                mass["inertia"] = (np.abs(rotation) @ np.array(mass["inertia"])).tolist()

    return change


def _give(bearing: Tables, matrix: np.ndarray) -> None:
    """Write the 6x6 of a bearing, with all that acts in series with it."""
    if "hold" in bearing:
        return  # ground, whatever the axes and the size
    bearing.pop("axial_series", None)
    bearing.pop("stiffness", None)
    bearing["matrix"] = ((matrix + matrix.T) / 2.0).tolist()


def _matrix(bearing: Tables) -> np.ndarray:
    """6x6 of a bearing as the scene has it."""
    if not {"matrix6"} <= bearing.keys():
        raise NotKnown("bearing without a 6x6")
    return np.array(bearing["matrix6"])


def _reversed(tables: Tables) -> None:
    """Turn the shaft half round x: what was its start is its end."""
    _turn(np.diag([1.0, -1.0, -1.0]))(tables)
    length = sum(segment["length"] for segment in tables["segment"])
    for segment in tables["segment"]:
        swap(segment, "start_diameter", "end_diameter")
        swap(segment, "start_bore", "end_bore")
    tables["segment"].reverse()
    for key in ("bearing", "mass", "port"):
        for table in tables.get(key, []):
            if "position" in table:
                table["position"] = length - table["position"]
            if "span" in table:
                table["span"] = [length - y for y in reversed(table["span"])]
            if "face" in table:
                table["face"] = {"start": "end", "end": "start"}[table["face"]]


def swap(table: Tables, first: str, second: str) -> None:
    """Exchange two entries of a table, either of which may be absent."""
    a, b = table.pop(first, None), table.pop(second, None)
    if a is not None:
        table[second] = a
    if b is not None:
        table[first] = b


LENGTHS = (
    *("length", "diameter", "start_diameter", "end_diameter", "bore", "start_bore", "end_bore"),
    *("position", "seat_width", "span", "offset"),
)


def _longer(tables: Tables) -> None:
    """Scale all lengths; moduli and densities stay."""
    for key in ("segment", "bearing", "mass", "port"):
        for table in tables.get(key, []):
            for name in set(LENGTHS) & table.keys():
                table[name] = (TWO * np.array(table[name])).tolist()
    lengths = np.repeat([1.0, TWO], 3)
    for bearing in tables.get("bearing", []):
        _give(bearing, TWO * np.outer(lengths, lengths) * _matrix(bearing))
    for mass in tables.get("mass", []):
        mass["mass"] *= TWO**3
        mass["inertia"] = (TWO**5 * np.array(mass.get("inertia", [0.0] * 3))).tolist()


def _scaled_length(quantity: Quantity) -> float:
    """Factor of a number of a shaft that is `TWO` times as large."""
    if quantity.is_frequency:
        return 1.0 / TWO
    return float(TWO ** -(1 + sum(k > 2 for k in quantity.place)))


def _stiffer(tables: Tables) -> None:
    """Scale moduli and springs by four."""
    for material in _materials(tables):
        material["E"] *= 4.0
    for bearing in tables.get("bearing", []):
        _give(bearing, 4.0 * _matrix(bearing))


def _heavier(tables: Tables) -> None:
    """Scale densities and masses by four."""
    for material in _materials(tables):
        material["density"] *= 4.0
    for mass in tables.get("mass", []):
        mass["mass"] *= 4.0
        mass["inertia"] = (4.0 * np.array(mass.get("inertia", [0.0] * 3))).tolist()


def _materials(tables: Tables) -> list[Tables]:
    """Tables of all materials of a shaft."""
    places = [tables, *tables["segment"]]
    materials = [place["material"] for place in places if "material" in place]
    if any(isinstance(material, str) for material in materials):
        raise NotKnown("material by name")
    return materials


def _split(tables: Tables) -> None:
    """Cut the longest cylinder in two that are the same body."""
    cylinders = [s for s in tables["segment"] if s["kind"] == "cylinder"]
    if not cylinders:
        raise NotKnown("no cylinder")
    longest = max(cylinders, key=lambda segment: segment["length"])
    longest["length"] /= 2.0
    place = next(k for k, segment in enumerate(tables["segment"]) if segment is longest)
    tables["segment"].insert(place, longest | {"name": f"{longest['name']} one"})


def _in_inches(tables: Tables) -> None:
    """Write lengths in inches."""
    for segment in tables["segment"]:
        for name in ("length", "diameter"):
            if name in segment:
                segment[name] = f"{segment[name] / 0.0254!r} in"


def _shuffled(tables: Tables) -> None:
    """Write bearings and masses in another order, and keys of the file too."""
    for key in ("bearing", "mass"):
        if key in tables:
            tables[key].reverse()
    keys = list(tables)
    for key in reversed(keys):
        tables[key] = tables.pop(key)


def _unused(tables: Tables) -> None:
    """Name a material that no segment is made of."""
    tables["materials"] = {"spare": {"E": 1e9, "nu": 0.4, "density": 1000.0}}


#: turned by a quarter about the axis, z goes where x was
QUARTER = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
TURNED = {"C_xx": "C_zz", "C_zz": "C_xx", "C_thx": "C_thz", "C_thz": "C_thx"}
REWRITINGS = (
    Rewriting("mirrored in x", _turn(np.diag([-1.0, 1.0, 1.0]))),
    Rewriting("turned by 90 degrees", _turn(QUARTER), renamed=lambda name: TURNED.get(name, name)),
    Rewriting("from the other end", _reversed, same_mesh=False),
    Rewriting("twice as large", _longer, _scaled_length),
    Rewriting("four times as stiff", _stiffer, lambda q: TWO if q.is_frequency else 0.25),
    Rewriting("four times as heavy", _heavier, lambda q: 0.5 if q.is_frequency else 1.0),
    Rewriting("a segment in two", _split, same_mesh=False),
    Rewriting("in inches", _in_inches),
    Rewriting("in another order", _shuffled),
)
#: couplings change sign with the axes, which other relations hold; frequencies are in no direction
ASKED = ("C_xx", "C_yy", "C_zz", "C_thx", "C_thz", "f1", "f2", "f3")


def of_scene(scene: Path, tol: float | None = None) -> Iterator[Relation]:
    """Numbers of a shaft and of every other description of it."""
    loaded = sg.load(scene)
    tables = loaded.to_dict()
    if any(bearing.catalogue is not None for bearing in loaded.bearings):
        return
    for table, bearing in zip(tables.get("bearing", []), loaded.bearings):
        table["matrix6"] = np.asarray(bearing.stiffness).tolist()
    as_it_is = _answers(_clean(tables), tol)
    yield from _load_in_two(scene)
    for rewriting in REWRITINGS:
        if not tables.keys() <= rewriting.keys:
            continue
        changed = copy.deepcopy(tables)
        try:
            rewriting.change(changed)
        except NotKnown:
            continue
        numbers = _answers(_clean(changed), tol)
        for name, number in as_it_is.items():
            other = numbers.get(rewriting.renamed(name))
            expected = number.times(rewriting.factor(Quantity(name)))
            yield _relation(scene, rewriting, name, expected, other)


def _load_in_two(scene: Path) -> Iterator[Relation]:
    """Motions of the main point under a load, and under its halves at the same place."""
    loaded = sg.load(scene)
    if loaded.is_loaded or loaded.features or loaded.body is not None:
        return
    if not (loaded.bearings and loaded.ports):
        return
    tables = loaded.to_dict()
    half = {"on": loaded.port.name, "z": 500.0, "x": 250.0}
    whole = tables | {"load": {"z": 1000.0, "x": 500.0}}
    halves = tables | {"load": [{"name": name} | half for name in ("first", "second")]}
    a, b = (
        sg.deflect(sg.Scene.from_dict(case), models=["timoshenko"])
        .solutions[0]
        .shafts[0]
        .ports[loaded.port.name]
        for case in (whole, halves)
    )
    close = bool(np.allclose(a, b, rtol=1e-9, atol=1e-9 * np.abs(a).max()))
    yield Relation(scene.name, KIND, "a load in two", close, f"{a} and {b}")


def _relation(
    scene: Path, rewriting: Rewriting, name: str, expected: Number, other: Number | None
) -> Relation:
    what = f"{name}: {rewriting.name}"
    if other is None:
        return Relation(scene.name, KIND, what, False, f"{expected} and nothing")
    if rewriting.same_mesh:
        claimed = Number.within(expected.value, None, expected.size)
        holds = claimed.meets(Number.within(other.value, None, other.size))
    else:
        holds = expected.meets(other)
    return Relation(scene.name, KIND, what, holds, f"{expected} expected, {other}")


def of_train(train: Path) -> Iterator[Relation]:
    """Natural frequencies of two cylindrical gears, of which either is written first.

    Bearings of catalogue data are left out: their elements stand at given angles, and seen from the
    other gear the load comes from the other side.
    """
    loaded = sg.load_train(train)
    tables = loaded.to_dict()
    bearings = [b for shaft in loaded.shafts.values() for b in shaft.scene.bearings]
    if (
        len(tables["shaft"]) != 2
        or tables["mesh"][0].get("shaft_angle") != 0.0
        or any(bearing.catalogue is not None for bearing in bearings)
    ):
        return
    turned = copy.deepcopy(tables)
    first, second = tables["mesh"][0].get("between", list(tables["shaft"]))
    turned["mesh"][0]["between"] = [second, first]
    turned["shaft"] = dict(reversed(turned["shaft"].items()))
    before, after = turned["shaft"][first], turned["shaft"][second]
    # left flanks touch left ones; a gear whose flank is named keeps that
    flank = before.pop("loaded_side")
    after |= {"loaded_side": after.get("loaded_side", flank), "pitch_angle": 0.0}
    after.setdefault("face_width", before["face_width"])
    a, b = (
        [mode.frequency_hz for mode in sg.system_modes(sg.Train.from_dict(t), "timoshenko").modes]
        for t in (tables, turned)
    )
    for k, (hz, other) in enumerate(zip(a, b, strict=True)):
        close = bool(np.isclose(hz, other, rtol=1e-6, atol=1e-3))
        yield Relation(train.name, KIND, f"f{k}: the other gear first", close, f"{hz} and {other}")


def _clean(tables: Tables) -> Tables:
    """The tables without what helped to rewrite them."""
    tables = copy.deepcopy(tables)
    for bearing in tables.get("bearing", []):
        bearing.pop("matrix6", None)
    return tables


def _answers(tables: Tables, tol: float | None) -> Numbers:
    """Answers of a scene; of what is free there is none."""
    scene = sg.Scene.from_dict(tables)
    asked = ASKED if scene.ports else [name for name in ASKED if Quantity(name).is_frequency]
    answered = sg.answer(scene, tol, asked)
    return {
        row.quantity: Number.within(row.value, row.bar * row.size, row.size, row.side)
        for row in answered.values
    }
