"""Reading of scenes, from a file, a dict or an object: catalogue bearings get their stiffness at
their load.

:mod:`solidgear.core.scene` reads a file as data; here the catalogue data of bearings become a 6x6 once,
as for any other bearing.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from solidgear.core.errors import SceneError, SolidgearError
from solidgear.core.registry import addition
from solidgear.core.scene import file
from solidgear.core.scene.document import Document, Source, document_of, name_of_source
from solidgear.core.scene.load_rules import named_case
from solidgear.core.scene.model import Scene
from solidgear.core.scene.tables import parts

if TYPE_CHECKING:
    from solidgear.core.body import Body

#: model and mesh on which bearings find the stiffness that motion about rest sees: loads and
#: stiffness within 1e-4 of those on finer meshes, in some 0.1 s, where a Timoshenko beam, stiffer at
#: shoulders, leaves 8e-3 of a load, 3e-2 of a stiffness and 5e-3 of a first frequency
SHAFT = "harmonic"
MESH = {"order": 3, "layers": 1, "edge_layers": 0}


def load(source: Source) -> Scene:
    """Read and resolve a scene, and work out the stiffness of catalogue bearings.

    Parameters
    ----------
    source : str, path or dict
        A TOML file; ``geometry/pinion_overhung.toml`` describes the format, and
        ``geometry/gearbox_catalogue.toml`` that of catalogue bearings. Or the tables of one, as
        ``tomllib`` gives them, with names of files relative to the folder of work. A Scene is
        returned with its catalogue bearings settled. A train is refused: read it with
        :func:`solidgear.load_train`.

    Returns
    -------
    Scene
        Every bearing with a 6x6. Where it came from catalogue data these are kept as its
        `catalogue`.

    Raises
    ------
    SceneError
        The file, the key (``bearing[2] "2".seat_width``, counted from one), the value as written,
        what would be right: one line for each problem, in the order of the file.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/pinion_overhung.toml")
    >>> [bearing.name for bearing in scene.bearings], scene.port.name
    (['1', '2'], 'pinion')
    """
    if isinstance(source, Scene):
        return source.settled
    document = document_of(source)
    return scene_of(document.tables, document.path).read_from(document)


def as_written(source: Source) -> Scene:
    """Read a scene as it is written: catalogue bearings without their stiffness, the part of a
    [body] read; errors as of :func:`load`.
    """
    if isinstance(source, Scene):
        return source
    document = document_of(source)
    return scene_of(document.tables, document.path, alone=False).read_from(document)


def under_case(source: Source, case: str | int | None) -> Document:
    """Return the document of a scene with the case of a name or number first, under which catalogue
    bearings settle; unchanged without a name. Refused for a train.
    """
    document = document_of(source)
    if case is None:
        return document
    if document.describes_train:
        raise SolidgearError(
            f"`case` is for a shaft, and {name_of_source(source)} is a train: give `point`"
        )
    with explained(document.path, document.tables):
        scene = file.scene_of(dict(document.tables), document.path, part_of)
        first = [c.name for c in scene.cases].index(named_case(scene.cases, case).name)
    tables = list(document.tables["case"])
    tables.insert(0, tables.pop(first))
    return Document(dict(document.tables) | {"case": tables}, document.path)


def case_sentence(source: Source) -> str:
    """Return the sentence on which case of several catalogue bearings settle under; empty where there
    is no choice.
    """
    scene = as_written(source)
    if len(scene.cases) < 2 or not any(b.catalogue is not None for b in scene.bearings):
        return ""
    return (
        f'catalogue bearings settle under the load case "{scene.cases[0].name}", one of '
        f"{len(scene.cases)}"
    )


def scene_of(tables: Mapping[str, Any], path: str | os.PathLike, alone: bool = True) -> Scene:
    """Return the scene that tables of a file describe, with names of files relative to its path;
    errors as of :func:`load`. Catalogue bearings settle at the load of the scene where it is
    `alone`, and not with a train.
    """
    scene = file.scene_of(dict(tables), os.fspath(path), part_of)
    if not alone or not is_unsettled(scene) or file.says_unsettled(tables):
        return scene
    with explained(path, tables):
        return settled(scene)


def is_unsettled(scene: Scene) -> bool:
    """Return True where a catalogue bearing waits for its stiffness."""
    return any(bearing.matrix is None for bearing in scene.bearings)


def settled(scene: Scene) -> Scene:
    """Return a scene with a stiffness for every bearing: that of catalogue data at their load."""
    if not is_unsettled(scene):
        return scene
    return addition("settling", "solved")(scene, shaft(scene)).scene


def part_of(table: Any, folder: Path) -> Any:
    """Read the part that a scene file names; kept from scenes that have none."""
    return parts().recognise(table, folder)


@contextmanager
def explained(source: Source, tables: Mapping[str, Any] | None = None) -> Iterator[None]:
    """Raise errors anew with the file, the key and the value they come from; tables are those of
    the file where some of them have been changed.
    """
    try:
        yield
    except SceneError as error:
        written = document_of(source).tables if tables is None else tables
        raise SceneError.of(
            problem.located(
                written,
                where=name_of_source(source),
                # a scene has bearings, its file [[bearing]] tables
                path=("bearing", *problem.path[1:])
                if problem.path[:1] == ("bearings",) and "bearing" in written
                else problem.path,
            )
            for problem in error.problems
        ) from None
    except SolidgearError as error:
        raise SceneError(str(error), where=name_of_source(source)) from None


def shaft(scene: Scene) -> Body | None:
    """Return the body on which bearings settle, or None where no bearing waits for the load of the
    shaft.
    """
    if not addition("settling", "wants equilibrium")(scene):
        return None
    from solidgear.core.ladder import build  # start-up: not every file needs it

    # what is cut out moves the load of a bearing by a small part of a small part
    return build(scene.plain, SHAFT, **MESH)
