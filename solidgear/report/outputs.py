"""Files for other programs that a comparison leaves of every model it has solved."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from solidgear.report.export import write_vtu

if TYPE_CHECKING:
    from solidgear.judge.solution import Solution


@dataclass(frozen=True)
class Output:
    """A kind of file.

    Attributes
    ----------
    what : str
        Named where it is left out: one that fails costs a sentence, and no number.
    stem, ending : str
        Of its name, before and after the model.
    write : callable
        Given a solution and the path.
    """

    what: str
    stem: str
    ending: str
    write: Callable[[Solution, Path], object]

    def name(self, model: str) -> str:
        """Of the file of a model."""
        return f"{self.stem}_{model}{self.ending}"

    @property
    def pattern(self) -> str:
        """Regular expression of all such names."""
        return rf"{self.stem}_\w+{re.escape(self.ending)}"


def _mode_shapes(solution: Solution, path: Path) -> None:
    write_vtu(solution.body, solution.modes, path)


OUTPUTS = (Output("vtu", "modes", ".vtu", _mode_shapes),)
