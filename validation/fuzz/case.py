"""One fuzzer for all kinds of input: cases made by dice, used within limits, and judged.

A *finding* is what must not happen: an exception that is not raised on purpose (a user would see a
traceback), a warning, a message that is not fit for a terminal or does not name the file, more time
or memory than allowed, and whatever the use of a case calls one. Everything else is refused or
accepted.
"""

from __future__ import annotations

import contextlib
import os
import random
import re
import tempfile
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from unittest import mock

from solidgear.core.errors import MOST_PROBLEMS, SceneError, SolidgearError
from solidgear.core.loading import load
from validation.fuzz.limits import Limits, Overrun
from validation.shipped import GEOMETRY

#: letters of a line on a terminal
LONGEST = 1000


class Refused(Exception):
    """A refusal in sentences that one can act on: the first of them, and its sort."""

    def __init__(self, sentence: str, sort: str):
        super().__init__(sentence)
        self.sort = sort


class Finding(Exception):
    """Something that must not happen."""


@dataclass(frozen=True)
class Case:
    """One broken input and what is done with it.

    Attributes
    ----------
    what : str
        How it was made.
    files : mapping of str to bytes
    use : callable
        Given the folder of the files: yields the name of each stage before it begins; raises
        `Refused` or `Finding`.
    """

    what: str
    files: Mapping[str, bytes]
    use: Callable[[Path], Iterator[str]]


@dataclass(frozen=True)
class Fuzz:
    """A kind of input.

    Attributes
    ----------
    name : str
    make : callable
        A case by dice.
    share : float
        Of the cases of a run of all kinds.
    limits : Limits
    environment : mapping of str to str
        Set while a case is used.
    """

    name: str
    make: Callable[[random.Random], Case]
    share: float = 0.0
    limits: Limits = Limits()
    environment: Mapping[str, str] = field(default_factory=dict)

    def case(self, seed: int, number: int) -> Case:
        """A case: it follows from seed and number alone, so that a finding can be made again."""
        return self.make(random.Random(f"{self.name} {seed}:{number}"))


@dataclass(frozen=True)
class Outcome:
    """What became of a case.

    Attributes
    ----------
    number : int
    what : str
        How the case was made.
    kind : {'accepted', 'refused', 'finding'}
    stage : str
        The last one that was reached.
    sentence : str
        Of a refusal or a finding.
    detail : str
        Sort of a refusal, or a traceback.
    """

    number: int
    what: str
    kind: str
    stage: str
    sentence: str = ""
    detail: str = ""

    def told(self) -> str:
        """One line that any terminal can show."""
        text = f"case {self.number}: {self.what}: {self.stage}: {self.sentence}"
        return text.encode("unicode_escape").decode()


def run(
    fuzz: Fuzz, cases: int, seed: int, progress: Callable[[Outcome], None] | None = None
) -> list[Outcome]:
    """Outcomes of some cases; those so far if interrupted.

    Parameters
    ----------
    progress : callable, optional
        Given every outcome as it comes.
    """
    # the first text with a unit imports pint, which is not the case's fault
    load(GEOMETRY / "pinion_overhung.toml")
    found: list[Outcome] = []
    with contextlib.suppress(KeyboardInterrupt):
        for number in range(cases):
            found.append(one(fuzz, fuzz.case(seed, number), number))
            if progress:
                progress(found[-1])
    return found


def one(fuzz: Fuzz, case: Case, number: int = 0) -> Outcome:
    """Use a case in a folder of its own and judge what came of it."""
    stage = ""
    with tempfile.TemporaryDirectory() as name, mock.patch.dict(os.environ, fuzz.environment):
        folder = Path(name)
        put(case, folder)
        try:
            with fuzz.limits.watched():
                for reached in case.use(folder):
                    stage = reached
        except Refused as refusal:
            return Outcome(number, case.what, "refused", stage, str(refusal), refusal.sort)
        except (Finding, Overrun) as found:
            return Outcome(number, case.what, "finding", stage, str(found)[:400])
        except Exception as error:
            sentence = f"{type(error).__name__}: {error}"[:300]
            return Outcome(number, case.what, "finding", stage, sentence, traceback.format_exc())
    return Outcome(number, case.what, "accepted", stage)


def put(case: Case, folder: Path) -> None:
    """Write the files of a case."""
    for name, text in case.files.items():
        (folder / name).write_bytes(text)


@contextlib.contextmanager
def refusing(names: Sequence[str], *, reading: bool = False) -> Iterator[None]:
    """What the library refuses inside is `Refused` if it is said in clear sentences, and a
    `Finding` if not.

    Parameters
    ----------
    names : sequence of str
        Of the files, one of which a sentence must name.
    reading : bool
        A file is read: one sentence for each problem, `MOST_PROBLEMS` at most, each with the file.
    """
    try:
        yield
    except SolidgearError as error:
        for fault, true in _faults(error, names, reading).items():
            if true:
                raise Finding(f"the message {fault}: {str(error)!r}") from error
        first = str(error).splitlines()[0]
        raise Refused(first, sort_of(getattr(error, "reason", first))) from error


def _faults(error: SolidgearError, names: Sequence[str], reading: bool) -> dict[str, bool]:
    lines = str(error).splitlines()
    count = len(error.problems) if isinstance(error, SceneError) and reading else 1
    wanted = 1 if count == 1 else 1 + min(count, MOST_PROBLEMS) + (count > MOST_PROBLEMS)
    named = all(any(name in line for name in names) for line in lines[: 1 + MOST_PROBLEMS])
    return {
        "is not one line for each problem": len(lines) != wanted,
        "does not name the file": reading and not named,
        "is not fit for a terminal": not all(map(fit, lines)),
        "speaks of the program's own parts": any(
            word in str(error) for word in ("pydantic", "Value error", "Traceback")
        ),
    }


def fit(line: str) -> bool:
    """A line that a terminal shows as it is, and that one reads to its end."""
    return line.isprintable() and len(line) < LONGEST


def sort_of(sentence: str) -> str:
    """A sentence without its names and numbers."""
    return re.sub(r'"[^"]*"|\([^)]*\)|[-+]?\d[\d.e+-]*', "_", sentence.split(";")[0])[:60].strip()
