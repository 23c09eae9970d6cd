"""Options of commands on a train: its file, how its shafts are reduced, and their models."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias, TypedDict

import typer

from solidgear.core import LADDER, SceneError, SolidgearError, Source, document_of, listed, show
from solidgear.show.command import Group
from solidgear.show.options import MODEL, OF_BODIES, Named, options_by_name, relative
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.shaft import checked_model, usual_models
from solidgear.trains.file.reading import as_written
from solidgear.trains.file.tables import FIRST_HARMONIC, LAST_HARMONIC
from solidgear.trains.file.train import Train
from solidgear.trains.load.operation import at_point
from solidgear.trains.loading import load_train

TrainFile = Annotated[
    Path, typer.Argument(help="Train file (TOML), such as geometry/axle_overhung.toml.")
]
MODELS = (
    f"{', '.join(LADDER.bodies)}, matrices (those of the file), rigid, lumped, lumped-bending, lumped-matched, "
    "lumped-old; a lumped one may name its body, lumped/euler."
)
USUAL = "By default harmonic, or the cheapest solid that models cuts of the shaft."
MOST_KEPT = 200
#: a model of all shafts, or models by shaft; the usual ones where nothing is said
Models: TypeAlias = str | Mapping[str, str] | None
#: builder options by shaft, or texts such as ``pinion.order=3``
Settings: TypeAlias = Mapping[str, Mapping[str, Any]] | Iterable[str] | None
#: harmonics of solids that teeth drive, or a text such as ``2,3``
Waves: TypeAlias = str | Sequence[int] | None
if TYPE_CHECKING:
    Harmonics: TypeAlias = Waves
    #: of a command a number, of Python also a text
    Tolerance: TypeAlias = float | str | None
else:
    Harmonics = str | None
    Tolerance = float | None


class Reducing(TypedDict, total=False):
    """Words of every study of a train: how its shafts are reduced, and up to which frequency."""

    max_frequency: float | None
    reduction: str
    kept: int
    local_harmonics: Waves
    point: str | int | None
    tol: float | str | None


@dataclass(frozen=True)
class Reduction(Group):
    """How the shafts of a train are reduced, and up to which frequency."""

    max_frequency: Annotated[
        float | None, typer.Option(help="Hz; by default max_frequency of the file.")
    ] = None
    reduction: Annotated[
        str,
        typer.Option("--reduction", help="rubin (free modes and residuals) or craig_bampton."),
    ] = "rubin"
    kept: Annotated[
        int, typer.Option("--kept", help="Modes of each shaft kept in its reduction.")
    ] = 24
    local_harmonics: Annotated[
        Harmonics,
        typer.Option(
            "--local-harmonics",
            help="Harmonics n >= 2 of harmonic solids that teeth drive where they touch, such as "
            "2,3; by default local_harmonics of each mesh in the file.",
        ),
    ] = None
    point: Annotated[
        Named,
        typer.Option(
            "--point",
            help="Operating point, by its name or number in the file; the first by default.",
        ),
    ] = None

    @property
    def given(self) -> dict[str, bool]:
        """Options, and whether they are other than usual."""
        usual = vars(type(self)())
        return {f"--{k.replace('_', '-')}": v != usual[k] for k, v in vars(self).items()}

    def checked(self) -> Reduction:
        """Return these options once they are sound."""
        if not 1 <= self.kept <= MOST_KEPT:
            raise SolidgearError(f"--kept {show(self.kept)}: give 1 to {MOST_KEPT} modes")
        if self.max_frequency is not None and not self.max_frequency > 0:
            raise SolidgearError(
                f"--max-frequency {self.max_frequency:g}: must be greater than zero, in Hz"
            )
        return self

    @property
    def harmonics(self) -> tuple[int, ...]:
        """Harmonics of ``--local-harmonics``; none where the file decides."""
        asked = self.local_harmonics
        text = asked if isinstance(asked, str) or asked is None else ",".join(map(str, asked))
        return () if text is None else _harmonics(text)


@dataclass(frozen=True)
class Reduced(Reduction):
    """Options of every command on a train: how its shafts are reduced and meshed."""

    tol: Annotated[
        Tolerance,
        relative(
            "--tol",
            "Relative error that meshes of harmonic shafts may leave; by default a tenth of the "
            "file's tolerance.",
        ),
    ] = None

    @property
    def words(self) -> Reducing:
        """These options as the words of a study."""
        return Reducing(
            max_frequency=self.max_frequency,
            reduction=self.reduction,
            kept=self.kept,
            local_harmonics=self.local_harmonics,
            point=self.point,
            tol=self.tol,
        )

    def assembly(
        self,
        source: Source | Train,
        settings: Mapping[str | tuple[str, str], Mapping] | None = None,
    ) -> Assembly:
        """Return the assembly of a train, once these options are sound, with builder options by
        side and model.
        """
        self.checked()
        loaded = load_train(source)
        if self.point is not None:
            loaded = at_point(loaded, self.point)
        if self.harmonics:
            extra = {"local_harmonics": self.harmonics}
            solved = loaded.solved_meshes
            loaded = loaded.with_changes(
                meshes=tuple(m.with_changes(**extra) for m in loaded.meshes)
            ).with_solved_meshes(solved)
        try:
            return Assembly(
                loaded,
                self.reduction,
                self.kept,
                settings or {},
                tol=self.tol,
                highest_hz=self.max_frequency,
            )
        except SceneError as error:  # what the mesh of a sound file cannot be
            document = document_of(source)
            raw = document.tables
            raise as_written(error, raw).located(raw, where=document.path) from None


@dataclass(frozen=True)
class Pair(Group):
    """Models of the shafts."""

    pinion: Annotated[
        str | None, typer.Option("--pinion", help=f"Model of the pinion's shaft: {MODELS} {USUAL}")
    ] = None
    gear: Annotated[
        str | None, typer.Option("--gear", help="Model of the gear's shaft, as --pinion.")
    ] = None
    shafts: Annotated[
        list[str] | None,
        typer.Option(
            "--shaft", help="Model of a shaft with another name, such as input=euler; repeatable."
        ),
    ] = None

    @property
    def models(self) -> dict[str, str]:
        """Models that are given, by shaft."""
        models = {s: m for s, m in (("pinion", self.pinion), ("gear", self.gear)) if m is not None}
        for text in self.shafts or []:
            side, equals, model = text.partition("=")
            if not equals:
                raise SolidgearError(f"--shaft {show(text, 40)}: write SHAFT=MODEL, input=euler")
            models[side] = model
        return models


@dataclass(frozen=True)
class Mix(Pair):
    """Models of the shafts with their builder options."""

    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            help="Builder option of the model of one shaft as SIDE.key=value, repeatable: "
            "pinion.order=3, gear.elements=40; solidgear options lists them.",
        ),
    ] = None


@dataclass(frozen=True)
class Driven(Mix):
    """Options of every command on steady motion: losses, and models to draw as well."""

    against: Annotated[
        list[str] | None,
        typer.Option(
            "--against",
            help="Further model to draw, as PINION+GEAR, such as euler+euler; repeatable.",
        ),
    ] = None
    damping: Annotated[
        str,
        typer.Option(
            help="hysteretic, viscous (with --matched-at), modal, or literal (C = zeta K)."
        ),
    ] = "hysteretic"
    matched_at: Annotated[
        float | None,
        typer.Option("--matched-at", help="Frequency in Hz at which viscous losses match."),
    ] = None

    mesh: Annotated[
        str | None,
        typer.Option(
            "--mesh", help="Mesh whose transmission error drives the train; by default the first."
        ),
    ] = None

    @property
    def words(self) -> dict[str, Any]:
        """Return these options as the words of a study."""
        words = {key: getattr(self, key) for key in ("damping", "matched_at", "mesh", "settings")}
        return words | {"models": self.models, "against": self.against or ()}


def models_of(shafts: Collection[str], name: str, models: Models) -> dict[str, str]:
    """Return models of shafts by the name of each, the usual ones where none is given; refuse a shaft
    that the train of that name does not have.
    """
    if isinstance(models, str):
        return dict.fromkeys(shafts, models)
    for side in models or ():
        if side not in shafts:
            names = listed(shafts)
            raise SolidgearError(f"{name} has no shaft {show(side, 40)}; it has {names}")
    # names without shafts are those of a file that is not read yet
    usual = usual_models(shafts) if isinstance(shafts, Mapping) else dict.fromkeys(shafts, MODEL)
    return usual | dict(models or {})


def assembled(
    source: Source | Train, models: Models, settings: Settings, reduced: Reducing
) -> tuple[Assembly, tuple[str, ...]]:
    """Return the assembly of a train with builder options, and the model of each shaft."""
    assembly = Reduced(**reduced).assembly(source)
    by_shaft = models_of(assembly.train.shafts, assembly.train.name, models)
    assembly.settings = of_shafts(settings, by_shaft)
    return assembly, tuple(by_shaft.values())


def of_shafts(
    given: Settings, models: Mapping[str, str]
) -> dict[str | tuple[str, str], dict[str, Any]]:
    """Return builder options by (side, model); a lumped or rigid shaft has its body's."""
    out: dict[str | tuple[str, str], dict[str, Any]] = {}
    if not isinstance(given, Mapping):
        given = options_by_name([*(given or ())], models, "side", "pinion.order=3")
    for side, options in given.items():
        if side not in models:
            raise SolidgearError(f"settings: no shaft {show(side, 40)}; there are {listed(models)}")
        kind, base = checked_model(models[side])
        model = LADDER[base or kind]
        try:
            out[side, base or kind] = model.checked(dict(options))
        except SolidgearError as error:
            beside = "" if {*options} <= {*model.options} else f"; {OF_BODIES}"
            raise SolidgearError(f"{side}: {error}{beside}") from None
    return out


def _harmonics(text: str) -> tuple[int, ...]:
    """Read numbers of waves from a text such as ``2,3``."""
    try:
        numbers = tuple(int(word) for word in text.split(",") if word.strip())
    except ValueError:
        numbers = ()
    sound = all(FIRST_HARMONIC <= n <= LAST_HARMONIC for n in numbers)
    if not numbers or not sound or len(set(numbers)) < len(numbers):
        raise SolidgearError(
            f"--local-harmonics {show(text, 40)}: write whole numbers from {FIRST_HARMONIC} to "
            f"{LAST_HARMONIC}, each once, such as 2,3"
        )
    return numbers


def mix(text: str | Sequence[str]) -> tuple[str, ...]:
    """Return models of all shafts in the sequence of the file."""
    if not isinstance(text, str):
        return tuple(text)
    if "+" not in text:
        raise SolidgearError(f"--against {show(text, 40)}: write PINION+GEAR, such as euler+euler")
    return tuple(word.strip() for word in text.split("+"))
