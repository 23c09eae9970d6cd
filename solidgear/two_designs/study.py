"""Two scenes or two trains beside each other, each a path, tables or an object."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from solidgear.core import Scene, SolidgearError, Source, is_train, load, name_of_source
from solidgear.trains.assembly.shaft import checked_model
from solidgear.trains.file.train import Train
from solidgear.trains.options import Models, Reduced, models_of
from solidgear.two_designs.differences import differences
from solidgear.two_designs.two_shafts import TwoShafts, two_shafts
from solidgear.two_designs.two_trains import TwoTrains, two_trains


def beside(
    first: Source | Train,
    second: Source | Train,
    models: Models = None,
    *,
    mesh: str | None = None,
    tol: float | None = None,
    progress: Callable[[str], None] = lambda text: None,
    read: Callable[[Source], Scene] = load,
) -> TwoTrains | TwoShafts:
    """Compare two trains, by models of their shafts, on meshes within a tolerance and driven by a
    mesh, or two shafts, which are read by `read`.
    """
    names = _names(name_of_source(first), name_of_source(second))
    if not are_trains(first, second):
        scenes = [read(source) for source in (first, second)]
        # fields of objects have their names in Python
        in_files = not (isinstance(first, Scene) and isinstance(second, Scene))
        inputs = differences(first, second) if in_files else None
        return two_shafts(scenes, names, inputs, progress)
    assemblies = [Reduced(tol=tol).assembly(source) for source in (first, second)]
    train = assemblies[0].train
    mix = models_of(train.shafts, train.name, models).values()
    for model in mix:
        checked_model(model)
    inputs = differences(first, second)
    return two_trains(assemblies, names, inputs, *mix, mesh=mesh, progress=progress)


def are_trains(first: Source | Train, second: Source | Train) -> bool:
    """True for two trains, false for two shafts; refuse one of each."""
    sources = first, second
    trains = [isinstance(source, Train) or is_train(source) for source in sources]
    if trains[0] != trains[1]:
        names = [name_of_source(source) for source in sources]
        train, shaft = names if trains[0] else reversed(names)
        raise SolidgearError(
            f"{train} is a train and {shaft} one shaft: compare two trains, two shafts, or either "
            "file alone"
        )
    return trains[0]


def _names(a: str, b: str) -> tuple[str, str]:
    """Return names of two files: those without folder and ending, unless they are the same."""
    short = Path(a).stem, Path(b).stem
    return short if short[0] != short[1] else (a, b)
