"""Reading a train: its catalogue bearings get their stiffness at its operating point."""

from __future__ import annotations

import os
from pathlib import Path

from solidgear.core import Scene, as_written, explained, load
from solidgear.trains.file import reading
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import Train


def load_train(path: str | os.PathLike, point: OperatingPoint | None = None) -> Train:
    """Read a train file; the shafts it names lie relative to it, and the stiffness of their
    catalogue bearings is worked out: at the first operating point of the train, or, without any, at
    the load of each shaft's own file.

    Parameters
    ----------
    path : str or path
        A TOML file; ``geometry/axle_overhung.toml`` describes the format.
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

    train = reading.load_train(path, scene)
    if point is None and not train.operation:
        return train
    from solidgear.trains.load.operation import at_point  # start-up: not every file needs it

    with explained(path):
        return at_point(train if point is None else train.with_changes(operation=(point,)))
