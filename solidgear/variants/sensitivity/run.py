"""Sensitivities: derivatives of compliances, stiffnesses and natural frequencies by every number of
a scene file, from one solution (:mod:`solidgear.variants.sensitivity.adjoint`).

The file is read with each number a little smaller and larger; the changes of shaft, seats, materials,
bearings and masses are multiplied by the sensitivities of the numbers to them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from solidgear.core import (
    Body,
    ByName,
    Quantity,
    Scene,
    SceneError,
    Sheeted,
    SolidgearError,
    Source,
    as_supports,
    build,
    document_of,
    listed,
    load,
    modes,
    nearest,
    number_cautions,
    pinned,
)
from solidgear.core.errors import names_in
from solidgear.core.loading import part_of
from solidgear.core.plain import plain
from solidgear.core.scene.bearing_stiffness import STIFFNESS_NAMES
from solidgear.core.scene.file import scene_of
from solidgear.core.scene.paths import Keys, Tables, entries, entry, label_of, replace_entry
from solidgear.variants.sensitivity.adjoint import Form, entry_form, mode_form
from solidgear.variants.sensitivity.derivatives import Derivatives
from solidgear.variants.sweep.entries import amount, in_si

#: numbers by default
USUAL = ("bending 1", "C_zz")
#: models that have derivatives
MODELS = ("harmonic", "timoshenko", "euler", "solid")
#: of the strongest elasticity: smaller ones are symmetry and rounding, and given as zero
NOTHING = 1e-9
#: words on error bars of values and derivatives
BARS = (
    "from_coarser_mesh is the distance from a coarser mesh where there is one, and no proven bound"
)


@dataclass(frozen=True)
class Derivative:
    """Derivative of one number by one entry of the file."""

    plain_names = (
        "path",
        "written",
        "at",
        ("derivative", "by"),
        "elasticity",
        ("from_coarser_mesh", "apart"),
        ("one_sided", "side"),
    )

    path: str  #: as in :mod:`solidgear.core.scene.paths`
    written: str  #: the entry as the file has it
    at: float  #: the entry in SI
    unit: str  #: of the entry in the file; empty for SI
    by: float  #: derivative, SI over SI
    elasticity: float  #: relative change of the number over that of the entry
    apart: float | None = None  #: distance of the elasticity from that on a coarser mesh
    side: str = ""  #: ``larger`` or ``smaller`` if the file allows no other side

    @property
    def by_unit(self) -> float:
        """Derivative by one unit of the file."""
        if not self.unit:
            return self.by
        return self.by * (in_si(f"1 {self.unit}") or 1.0)


@dataclass(frozen=True)
class OfNumber(ByName[Derivative]):
    """Derivatives of one number, the strongest first."""

    plain_names = (
        ("quantity", "name"),
        "value",
        "unit",
        ("from_coarser_mesh", "apart"),
        ("mean_of_pair", "pair"),
        "derivatives",
    )

    name: str
    value: float  #: SI
    unit: str
    pair: bool  #: whether it is the mean of a pair of equal frequencies
    apart: float | None  #: distance of the value from that on a coarser mesh
    derivatives: tuple[Derivative, ...]

    @property
    def by_name(self) -> dict[str, Derivative]:
        """Derivatives by the paths of entries."""
        return {derivative.path: derivative for derivative in self.derivatives}


@dataclass(frozen=True, repr=False)
class Sensitivities(ByName[OfNumber], Sheeted):
    """Derivatives of some numbers by entries of a scene file."""

    sheeted: ClassVar[str] = "variants.sensitivity.command:sensitivities_sheet"

    plain_names = (
        *("title", "model", ("numbers", "of"), "without", ("about_bars", "bars"), "notes"),
        "cautions",
    )
    bars = BARS

    title: str
    model: str
    of: tuple[OfNumber, ...]
    without: dict[str, str]  #: entries without a derivative, and why
    notes: tuple[str, ...]  #: sentences on bearings held fixed, and on errors of derivatives
    cautions: tuple[str, ...] = ()  #: sentences on what the numbers leave out

    @property
    def by_name(self) -> dict[str, OfNumber]:
        """Derivatives of each number by its name."""
        return {number.name: number for number in self.of}

    def as_dict(self) -> dict[str, Any]:
        """Plain data in SI."""
        return plain(self)


@pinned
def sensitivities(
    source: Source,
    model: str = "harmonic",
    of: str | Sequence[str] | None = None,
    by: str | Sequence[str] | None = None,
    *,
    coarser: bool = True,
    progress: Callable[[str], None] = lambda _: None,
    **options: Any,
) -> Sensitivities:
    """Derivatives of compliances, stiffnesses and natural frequencies by the numbers of a scene.

    Exact derivatives of the discrete numbers on a mesh that moves with the shaft, by adjoints: the
    problem is self-adjoint, so nothing is solved again (Haug, Choi and Komkov, Design Sensitivity
    Analysis of Structural Systems, 1986). A pair of equal frequencies has the derivative of its mean.
    The stiffness of catalogue bearings is held constant.

    Parameters
    ----------
    source : path, dict or Scene
        A scene: its file (TOML), the tables of one, or an object.
    model : {'harmonic', 'timoshenko', 'euler', 'solid'}
        The solid has derivatives of modes by springs, masses and materials alone.
    of : str or sequence of str, optional
        Numbers such as ``"C_zz"``, ``"K_thx@pinion"`` or ``"bending 1"``; by default first bending
        and the compliance ``C_zz``.
    by : str or sequence of str, optional
        Paths of entries, or their beginnings, such as ``"bearing.A"``; by default all numbers of
        materials, segments, bearings, masses, housing and ports.
    coarser : bool
        Whether to derive on a coarser mesh as well, which shows the effect of the mesh.
    progress : callable
        Called with a sentence at every step.
    **options
        Of the model, such as ``order=7``.

    Returns
    -------
    Sensitivities

    Raises
    ------
    SceneError
        As :func:`solidgear.load`.
    SolidgearError
        A model or a feature without derivatives, a number that there is not, a path of no number.

    Examples
    --------
    First bending of a beam goes with the root of its modulus and of the stiffness of its bearings:

    >>> import solidgear as sg
    >>> found = sg.sensitivities("geometry/shaft_stepped.toml", "timoshenko", of=["bending 1"])
    >>> bending = found["bending 1"]
    >>> springs = [d.elasticity for d in bending.derivatives if ".stiffness." in d.path]
    >>> round(bending["material.E"].elasticity + sum(springs), 6)
    0.5
    """
    document = document_of(source)
    where, tables = document.path, document.tables
    scene = load(document).settled
    _supported(scene, model)
    usual = USUAL[: 1 if model == "solid" else 2]
    quantities = [Quantity(name) for name in names_in(of or usual)]
    if model == "solid" and not all(quantity.is_frequency for quantity in quantities):
        static = next(quantity for quantity in quantities if not quantity.is_frequency)
        raise SolidgearError(f"derivatives of {static} are for bodies of revolution; ask for modes")
    moves = [*numbers(tables, names_in(by or ()))]
    levels: list[dict[str, Any]] = [{}]
    if coarser and model != "solid":
        levels.append(_coarser(scene, model, options))
    by_path: dict[str, Around] = {}
    without: dict[str, str] = {}
    for keys in moves:
        path = label_of(keys, tables)
        try:
            by_path[path] = around(scene, tables, keys, where)
        except SolidgearError as error:
            without[path] = _reason(error)
    meshes = []
    for level in levels:
        mesh = f" ({_mesh_words(level)})" if level else ""
        progress(f"{scene.name}: {model}{mesh}")
        solved = SolvedMesh(scene, model, quantities, {**options, **level})
        meshes.append(solved.along(by_path, without))
        del solved  # before the next one takes as much
    rows: list[list[Derivative]] = [[] for _ in quantities]
    for path, sides in by_path.items():
        if path in without:
            continue
        fine, *coarse = [mesh.by[path] for mesh in meshes]
        for k, value in enumerate(meshes[0].values):
            scale = sides.at / value
            rows[k].append(
                Derivative(
                    path,
                    written=sides.written,
                    at=sides.at,
                    unit=sides.unit,
                    by=fine[k],
                    elasticity=fine[k] * scale,
                    apart=abs(coarse[0][k] - fine[k]) * abs(scale) if coarse else None,
                    side=sides.side,
                )
            )
    first, last = meshes[0], meshes[-1]
    of_numbers = tuple(
        OfNumber(
            str(quantity),
            value=first.values[k],
            unit=quantity.unit,
            pair=first.pairs[k],
            apart=abs(first.values[k] - last.values[k]) if len(meshes) > 1 else None,
            derivatives=_ranked(rows[k]),
        )
        for k, quantity in enumerate(quantities)
    )
    notes = tuple(_notes(scene, levels, of_numbers))
    cautions = tuple(number_cautions(scene, dict.fromkeys(map(str, quantities)), model))
    return Sensitivities(scene.title or scene.name, model, of_numbers, without, notes, cautions)


def _ranked(rows: list[Derivative]) -> tuple[Derivative, ...]:
    """Return the strongest first, equal ones as in the file; negligible ones, unless by a length of
    zero, as zero.
    """
    least = NOTHING * max((abs(d.elasticity) for d in rows), default=0.0)
    cleaned = [
        replace(d, by=0.0, elasticity=0.0) if d.at and abs(d.elasticity) <= least else d
        for d in rows
    ]
    # rounding does not rank: springs of a round shaft along x and along z are equal
    return tuple(sorted(cleaned, key=lambda d: -float(f"{abs(d.elasticity):.6g}")))


def _supported(scene: Scene, model: str) -> None:
    if model not in MODELS:
        raise SolidgearError(
            f"the {model} model has no derivatives; use {', '.join(MODELS[:-1])} or {MODELS[-1]}"
        )
    features = [feature for feature in scene.features if not feature.smeared]
    if model != "solid" and (scene.body is not None or features):
        part = "a part from a file" if scene.body is not None else features[0].name
        raise SolidgearError(
            f"{part}: the {model} model has derivatives for shafts of segments only; the solid "
            "model has those by springs, masses and materials"
        )


def _coarser(scene: Scene, model: str, options: dict[str, Any]) -> dict[str, Any]:
    if model == "harmonic":
        return {"order": max(3, options.get("order", 5) - 1)}
    return {"elements": max(1, build(scene, model, **options).mesh["elements"] // 2)}


def _mesh_words(level: dict[str, Any]) -> str:
    return ", ".join(f"{key} {value}" for key, value in level.items())


def _reason(error: SolidgearError) -> str:
    """Return the reason alone, of an error that may name file and key."""
    return str(getattr(error, "reason", "") or error).splitlines()[0]


class SolvedMesh:
    """Numbers of a scene on one mesh, with their derivatives."""

    def __init__(self, scene: Scene, model: str, numbers: Sequence[Quantity], options: dict):
        self.scene, self.model = scene, model
        self.body: Body = build(scene, model, **options)
        self.supports = as_supports(scene)
        self.values: list[float] = []
        self.pairs: list[bool] = []
        self.forms: list[Form] = []
        shapes = None
        if any(q.is_frequency for q in numbers):
            shapes = modes(self.body, scene, n=scene.ask.modes)
        for number in numbers:
            if number.is_frequency:
                assert shapes is not None
                mode = shapes.named(str(number))
                if mode is None:
                    names = listed(list(map(str, shapes.names)))
                    raise SolidgearError(f"{number}: no such mode was found; there are {names}")
                self.values.append(mode.frequency_hz)
                self.forms.append(mode_form(self.body, self.supports, mode))
                self.pairs.append(mode.multiplicity > 1)
                continue
            points = number.points_among([port.name for port in scene.ports])
            if len(points) > 1:
                raise SolidgearError(f"{number}: entries between points have no derivatives")
            value, form = entry_form(
                self.body, self.supports, number, (*points, scene.port.name)[0]
            )
            self.values.append(value)
            self.forms.append(form)
            self.pairs.append(False)
        self.by = Derivatives(scene, self.body, self.forms, model, options).by

    def along(self, by_path: Mapping[str, Around], without: dict[str, str]) -> OnMesh:
        """Return the numbers and their derivatives by entries without the mesh; what has none goes to
        `without`, with the reason.
        """
        by = {}
        for path, sides in by_path.items():
            try:
                by[path] = self.by(sides.low, sides.high, sides.step).tolist()
            except SolidgearError as error:
                without[path] = _reason(error)
        return OnMesh(self.values, self.pairs, by)


@dataclass(frozen=True)
class OnMesh:
    """Numbers of a scene on one mesh, and their derivatives by the paths of entries."""

    values: list[float]
    pairs: list[bool]  #: whether each is of a pair of modes
    by: dict[str, list[float]]  #: SI over SI


def _notes(scene: Scene, levels: list[dict], of: Sequence[OfNumber]) -> Iterator[str]:
    fixed = [b.name for b in scene.bearings if b.catalogue is not None]
    if fixed:
        yield f"The stiffness of catalogue bearings ({listed(fixed)}) is held constant."
    pairs = [number.name for number in of if number.pair]
    if pairs:
        yield f"{listed(pairs)}: derivative of the mean of the pair."
    for side in ("larger", "smaller"):
        paths = sorted(d.path for d in of[0].derivatives if d.side == side)
        if paths:
            yield f"One-sided, for {side} entries, since the file allows no others: {listed(paths)}."
    if len(levels) > 1:
        mesh = _mesh_words(levels[1])
        yield f"Mesh: distance from the derivative on a coarser mesh ({mesh}); no proven bound."


#: relative step of a number in the file, and that of a place, in lengths of the shaft: nodes and
#: matrices are linear in it but for angles, materials and springs in series
STEP, OF_PLACES = 1e-4, 1e-5
#: tables of a file whose numbers describe the shaft
SHAFT_TABLES = ("material", "segment", "feature", "bearing", "mass", "housing", "port")
#: words in them that may look like numbers
WORDS = ("name", "note", "status", "kind", "from", "at", "attach_to", "source", "title")
#: keys of lengths that may be zero
PLACES = {"position", "span"}


def numbers(tables: Tables, by: Sequence[str] | None) -> Iterator[Keys]:
    """Yield the entries that are numbers, at or below one of the paths `by` if there are any."""
    keys_of_numbers = [keys for keys in entries(tables) if _is_number(keys, tables)]
    labels = [label_of(keys, tables) for keys in keys_of_numbers]
    for path in by or ():
        if not any(_within(label, path) for label in labels):
            raise SolidgearError(f"`by` {path}: the file has no such number{nearest(path, labels)}")
    for keys, label in zip(keys_of_numbers, labels):
        if not by or any(_within(label, path) for path in by):
            yield keys


def _within(label: str, path: str) -> bool:
    return label == path or label.startswith(f"{path}.")


def _is_number(keys: Keys, tables: Tables) -> bool:
    value = entry(keys, tables)
    if keys[0] not in SHAFT_TABLES or "catalogue" in keys or isinstance(value, bool):
        return False
    if keys[-1] in WORDS or (isinstance(value, str) and not amount(value)):
        return False
    if len(keys) > 2 and keys[-3] == "matrix" and int(keys[-2]) > int(keys[-1]):
        return False  # the mirrored entry moves with the other
    # a place may be counted from zero; a term that is zero is none
    if in_si(value) == 0.0:
        return bool(PLACES.intersection(keys[-2:]))
    return bool(in_si(value))


@dataclass(frozen=True)
class Around:
    """Scene with an entry a little smaller and a little larger."""

    #: low, high: one of them the scene itself where the file allows no number on that side
    low: Scene
    high: Scene
    step: float  #: between them, SI
    written: str  #: the entry as the file has it
    unit: str  #: that the file gives it in; empty for SI
    at: float  #: the entry, SI
    side: str = ""  #: ``larger`` or ``smaller`` if the file allows no other side


def around(scene: Scene, tables: Tables, keys: Keys, where: str) -> Around:
    """Return the scene on both sides of an entry; SceneError if the file allows no other number."""
    written = str(entry(keys, tables))
    number, unit = amount(written).groups()  # type: ignore[union-attr]
    factor = 1.0
    if unit:
        factor = in_si(f"1 {unit}") or 1.0
    at = in_si(entry(keys, tables)) or 0.0
    step = OF_PLACES * scene.length if PLACES.intersection(keys[-2:]) else STEP * abs(at)
    sides: list[Scene | None] = []
    for sign in (-1, 1):
        try:
            changed = _changed_directly(scene, tables, keys, at + sign * step)
            value = float(number) + sign * step / factor
            text = f"{value!r} {unit}" if unit else value
            sides.append(changed or _read_again(replace_entry(tables, keys, text), scene, where))
        except SceneError as error:
            sides.append(None)
            refusal = error
    low, high = sides
    if low is None and high is None:
        raise refusal
    if low is not None and high is not None:
        return Around(low, high, 2 * step, written, unit, at)
    side = "larger" if low is None else "smaller"
    return Around(low or scene, high or scene, step, written, unit, at, side)


def _changed_directly(scene: Scene, tables: Tables, keys: Keys, value: float) -> Scene | None:
    """Return a scene with an entry of a stiffness matrix or of the material changed, which no place
    depends on; None for other entries.
    """
    first, *within = keys
    if first == "material" and not any("material" in table for table in tables["segment"]):
        material = scene.material.with_changes(**{str(keys[1]): value})
        segments = tuple(segment.with_changes(material=material) for segment in scene.segments)
        return scene.unjudged(material=material, segments=segments)
    if first == "housing" and scene.housing is not None:
        housing = _stiffened(scene.housing, within, value)
        return housing and scene.unjudged(housing=housing)
    if first != "bearing":
        return None
    index, *within = within
    bearings = list(scene.bearings)
    bearing = bearings[int(index)]
    if within[0] == "housing":
        housing = _stiffened(bearing.housing, within[1:], value)
        changed = housing and bearing.with_changes(housing=housing)
    else:
        changed = _stiffened(bearing, within, value)
    if changed is None:
        return None
    bearings[int(index)] = changed
    return scene.unjudged(bearings=tuple(bearings))


def _stiffened(thing: Any, keys: Sequence[str | int], value: float) -> Any:
    """Return a bearing or housing with an entry of its matrix, and the mirrored one, changed; None
    for other entries.
    """
    if keys[0] == "stiffness":
        row, column, _ = STIFFNESS_NAMES[str(keys[1])]
    elif keys[0] == "matrix":
        row, column = map(int, keys[1:])
    else:
        return None
    matrix = np.array(thing.matrix)
    matrix[row, column] = matrix[column, row] = value
    return thing.with_changes(matrix=matrix)


def _read_again(tables: Tables, scene: Scene, where: str) -> Scene:
    """Return the scene of tables, with catalogue bearings as stiff as in another scene."""
    changed = scene_of(dict(tables), where, part_of)
    if all(bearing.catalogue is None for bearing in scene.bearings):
        return changed
    bearings = tuple(
        new if new.catalogue is None else new.with_changes(matrix=old.matrix)
        for new, old in zip(changed.bearings, scene.bearings)
    )
    return changed.with_changes(bearings=bearings)
