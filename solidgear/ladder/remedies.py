"""Models that do not fit into memory: the sentence that refuses one, and for a 3D solid the ways
out, other models and other factors of the same scene, each with the memory it would take.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from solidgear.errors import SolidgearError
from solidgear.ladder.registry import LADDER
from solidgear.ladder.size import Size, estimated_size
from solidgear.machine.memory import available_mb, expect

if TYPE_CHECKING:
    from solidgear.scene.shaft import Shaft

#: entries that 32-bit indices can number, less some for what is numbered beside them
MOST_ENTRIES = 2_000_000_000
#: what is not refused for want of memory, MB: a beam, or a coarse solid
SMALL_MB = 25.0
#: models whose memory goes into the factor of a 3D mesh
LARGE = ("solid", "sector")
#: a mesh with less of this refinement answers for nothing
COARSEST = 0.1
#: share of the memory that a coarser mesh is made to fill
FILLED = 0.9
#: halvings of the interval in which refinement is sought: to a thousandth
STEPS = 10


@dataclass(frozen=True)
class Way:
    """One way out.

    Attributes
    ----------
    words : str
        What to ask for.
    mb : float
        What it is estimated to take.
    note : str
        What there is to be known of it.
    """

    words: str
    mb: float
    note: str = ""

    @property
    def told(self) -> str:
        """In a list."""
        return f"{self.words} (about {self.mb:.0f} MB{', ' if self.note else ''}{self.note})"


def ways_out(scene: Shaft, model: str, options: Mapping[str, Any], free: float) -> list[Way]:
    """Ways to solve a scene whose model does not fit, those first that cost least accuracy and work.

    Parameters
    ----------
    scene : Scene
    model : str
        A rung.
    options : mapping
        Of its builder, as asked for.
    free : float
        MB there are.

    Returns
    -------
    list of Way
        Whether they fit or not; none for a model whose memory does not go into the factor of a 3D
        mesh.
    """
    if model not in LARGE:
        return []
    return list(_ways(scene, model, LADDER[model].given(scene, options), free))


def _ways(scene, model: str, options: dict, free: float) -> Iterator[Way]:
    yield from _halves(scene, model, options)
    for other in ("sector", "corrected", "harmonic"):
        yield from _other(scene, model, other)
    yield from _coarser(scene, model, options, free)
    single, files = {"precision": "single"}, {"out_of_core": True}
    now = _sized(scene, model, options)
    for words, more, note in (
        ("--set precision=single", single, "same digits, solutions refined in double"),
        ("--set out_of_core=true", files, "the factor in files, several times slower"),
        ("--set precision=single --set out_of_core=true", {**single, **files}, ""),
    ):
        if any(options.get(name) != value for name, value in more.items()):
            size = _sized(scene, model, {**options, **more})
            # a factor in double precision may fall into pieces by mirror planes, others do not
            if size is not None and (now is None or size.peak_mb < now.peak_mb):
                yield Way(words, size.peak_mb, note)
    if options.get("engine", "own") == "own":
        size = _sized(scene, model, {**options, "engine": "petsc"})
        if size is not None:
            note = "MUMPS in PETSc on two ranks of this machine; SOLIDGEAR_MPIRUN names others"
            yield Way("--engine petsc", size.peak_mb, note)


def _halves(scene, model: str, options: dict) -> Iterator[Way]:
    """Half models, or half a sector, where there is a mirror plane that was not used."""
    from solidgear.ladder.size_laws import has_mirror_plane
    from solidgear.models.sector.body import halved, sectors_around

    if options.get("half", True):
        return
    sector = model == "sector"
    if halved(scene, sectors_around(scene, options)) if sector else has_mirror_plane(scene):
        size = _sized(scene, model, {**options, "half": True})
        if size is not None:
            yield Way(
                "--set half=true", size.peak_mb, "half a sector" if sector else "two half models"
            )


def _other(scene, model: str, other: str) -> Iterator[Way]:
    rung = LADDER[other]
    if other == model or rung.unfit(scene):
        return
    size = _sized(scene, other, rung.given(scene, {}))
    if size is not None:
        yield Way(f"-f {other}", size.peak_mb, f"the {rung.title}, {size.unknowns} unknowns")


def _coarser(scene, model: str, options: dict, free: float) -> Iterator[Way]:
    """The finest mesh of the same kind that fits."""
    body = getattr(scene, "body", None)
    if body is not None and body.counts is not None:
        return  # a mesh that is given
    least, most = COARSEST, float(options.get("refinement", 1.0))
    found: Size | None = None
    for _ in range(STEPS):
        middle = (least * most) ** 0.5
        size = _sized(scene, model, {**options, "refinement": middle})
        if size is not None and size.peak_mb < FILLED * free:
            least, found = middle, size
        else:
            most = middle
    if found is not None:
        # to two digits, downwards
        refinement = int(100 * least) / 100 if least < 1 else int(10 * least) / 10
        found = _sized(scene, model, {**options, "refinement": refinement}) or found
        note = f"{found.unknowns} unknowns, with a wider band"
        yield Way(f"--set refinement={refinement:g}", found.peak_mb, note)


def _sized(scene, model: str, options: dict) -> Size | None:
    try:
        return estimated_size(scene, model, options)
    except SolidgearError:
        return None


def offered(ways: list[Way], free: float) -> str:
    """Those that fit in a list, and those that do not."""
    fit = [way.told for way in ways if way.mb <= free]
    large = [way.told for way in ways if way.mb > free]
    text = ""
    if fit:
        text = "; ways that fit: " + "; ".join(f"{k}. {one}" for k, one in enumerate(fit, 1))
    if large:
        text += f"; too large as well: {'; '.join(large)}"
    return text


def refuse_too_large(scene: Shaft, model: str, options: dict | None = None) -> Size:
    """The estimated size, if the machine can take it; it is noted as expected in the run
    (:func:`solidgear.machine.memory.one_run`).

    Raises
    ------
    SolidgearError
        With the number of unknowns, the memory needed, the memory free and what to lower.
    """
    size = estimated_size(scene, model, options)
    what = f"{model}: about {size.unknowns} unknowns"
    if size.largest > MOST_ENTRIES:
        raise SolidgearError(
            f"{what} make {size.largest:.2g} matrix entries, more than the {MOST_ENTRIES:.0e} "
            f"that can be numbered; {size.lower}"
        )
    free = available_mb()
    if free is not None and size.peak_mb > max(free, SMALL_MB):
        raise SolidgearError(
            f"{what} need about {size.peak_mb:.0f} MB for mesh, matrices and factor, {free:.0f} "
            f"MB are free; {size.lower}{_offers(scene, model, options or {}, free)}"
        )
    expect(size.peak_mb)
    return size


def _offers(scene, model: str, options: Mapping[str, Any], free: float) -> str:
    """Ways out in a list; nothing where not even their sizes can be worked out any more."""
    try:
        return offered(ways_out(scene, model, options, free), free)
    except (MemoryError, ImportError):
        return ""
