"""Reading a train: its catalogue bearings get their stiffness at its operating point."""

from __future__ import annotations

from pathlib import Path

from solidgear.core import Scene, Source, document_of, explained, load
from solidgear.core.loading import as_written
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.reading import train_of
from solidgear.trains.file.train import Train


def load_train(source: Source | Train, point: OperatingPoint | None = None) -> Train:
    """Read a train; the shafts it names lie relative to its file, and the stiffness of their
    catalogue bearings is worked out: at the first operating point of the train, or, without any, at
    the load of each shaft's own file.

    Parameters
    ----------
    source : str, path or dict
        A TOML file; ``geometry/axle_overhung.toml`` describes the format. Or the tables of one, as
        ``tomllib`` gives them, with names of files relative to the folder of work. A Train that
        has changed since it was read, or with a point, is settled anew.
    point : OperatingPoint, optional
        Operating point for the bearings, in place of those of the file.

    Returns
    -------
    Train

    Raises
    ------
    SceneError
        The file, the key, the value as written, what would be right: one line for each problem.

    Examples
    --------
    >>> import solidgear as sg
    >>> train = sg.load_train("geometry/axle_straddle.toml")
    >>> [bearing.name for bearing in train.pinion.scene.bearings]
    ['0', '1', '2']
    """

    def scene(side: str, file: Path, alone: bool) -> Scene:
        # one that is not settled by itself settles with its train
        return load(file) if alone and point is None else as_written(file)

    if isinstance(source, Train):
        changed = source.operation and not source.solved_meshes.with_bearings
        if point is None and not (changed and _has_catalogued(source)):
            return source
        return _settled(source, point, source)
    document = document_of(source)
    train = train_of(document.tables, document.path, scene).read_from(document)
    if point is not None:
        return _settled(train, point, source)
    return _settled(train, None, source).read_from(document) if train.operation else train


def _has_catalogued(train: Train) -> bool:
    """Return whether a bearing of a train has its stiffness at a load."""
    scenes = (shaft.scene for shaft in train.shafts.values())
    return any(bearing.catalogue is not None for scene in scenes for bearing in scene.bearings)


def _settled(train: Train, point: OperatingPoint | None, source: Source | Train) -> Train:
    """Return a train whose bearings have settled at a point, in place of those that it has."""
    from solidgear.trains.load.operation import at_point  # start-up: not every file needs it

    with explained(source):
        if point is not None:
            # alone it is no part of a duty table
            alone = train.told(point).with_changes(share=None, hours=None)
            train = train.with_changes(operation=(alone,))
        return at_point(train)
