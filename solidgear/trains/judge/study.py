"""A train judged by every mix of models, from a path, tables or an object."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Unpack

from solidgear.core import Source
from solidgear.trains.file.train import Train
from solidgear.trains.judge.comparison import TrainComparison, compare_train
from solidgear.trains.options import Reduced, Reducing, mix


def judge(
    train: Source | Train,
    against: str | Iterable[str | Sequence[str]] = (),
    *,
    progress: Callable[[str], None] = lambda text: None,
    **reduced: Unpack[Reducing],
) -> TrainComparison:
    """Compare a train by harmonic solids with mixes of cheaper models, and with cheaper reductions.

    Parameters
    ----------
    train : path, dict or Train
        A train: its file (TOML), the tables of one, or an object.
    against : str or iterable of str
        Further mixes to judge, a model for each shaft, such as ``"euler+euler"``.
    progress : callable
        Called with a sentence at every step.
    **reduced
        As of :func:`solidgear.system_modes`.

    Returns
    -------
    TrainComparison
        ``verdict`` with its ``mixes`` and ``sentences()``; ``write(folder)`` makes the report.

    Raises
    ------
    SolidgearError
        For a train without teeth in mesh, and unknown models.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = sg.judge("geometry/axle_overhung.toml", max_frequency=300.0)
    >>> found.verdict.sentences()[-1]
    'Cheapest within 2 % and 3 dB up to 300 Hz: pinion euler, gear euler.'
    """
    more = [*map(mix, [against] if isinstance(against, str) else against)]
    assembly = Reduced(**reduced).assembly(train)
    return compare_train(assembly, reduced.get("max_frequency"), more, progress)
