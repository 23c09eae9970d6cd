"""Measured resonances paired with modes of a scene: which is which, how sure that is, and how much
they differ.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from solidgear.core import (
    BarredMode,
    ModeName,
    Sheeted,
    Source,
    load,
    pinned,
    read_tolerance,
    without_axis,
)
from solidgear.core.plain import plain
from solidgear.measured.alignment import Peak
from solidgear.measured.computed import Computed, computed_up_to
from solidgear.measured.data import Measured, MeasuredMode, MeasuredSource, load_measured
from solidgear.measured.same_part import FAR_SHIFTS, Common, Likeness, alignment_of
from solidgear.measured.shapes import OnPoints

#: a pair is sure from this probability on; below the second it is not listed as a possibility
SURE, POSSIBLE = 0.95, 0.05
#: standard deviations of a measured frequency that count as its bar
DEVIATIONS = 2.0
#: standard deviation of the logarithm of a measured frequency of which nothing is said, in the pairing
UNTOLD = 1e-4
#: of a bearing's stiffness of which [uncertain] of the scene says nothing: what a catalogue leaves open of
#: the inside is +- 9 to 11 % of it, a class of clearance as much, and rigid rings and seats the rest
SPRINGS = 0.2


@dataclass(frozen=True)
class Pair:
    """Measured resonance and mode."""

    number: int  #: of the resonance in its file, from one
    measured: MeasuredMode
    computed: BarredMode | None  #: the likeliest mode; None where it is likelier that there is none
    probability: float  #: of that
    #: further modes that it may be, or be as well, with their probabilities
    others: tuple[tuple[BarredMode, float], ...] = ()
    #: of the measured shape and the mode; None where no shape was measured
    mac: float | None = None

    @property
    def sure(self) -> bool:
        """Return whether no other mode is possible."""
        return self.computed is not None and self.probability >= SURE and not self.others

    @property
    def relative(self) -> float | None:
        """Computed over measured, less one."""
        if self.computed is None:
            return None
        return self.computed.frequency_hz / self.measured.frequency - 1

    @property
    def band(self) -> float | None:
        """Two standard deviations of the measured frequency and the bar of the computed one,
        relative to the measured; None where one of them is not known.
        """
        width = self.measured.width_hz
        if self.computed is None or width is None or self.computed.width is None:
            return None
        return (DEVIATIONS * width + self.computed.width) / self.measured.frequency

    @property
    def verdict(self) -> str:
        """Relation of both, in words."""
        if self.computed is None:
            return "no mode"
        doubt = "" if self.sure else ", pair not sure"
        if self.band is None or self.relative is None:
            return f"no band{doubt}"
        return ("agrees" if abs(self.relative) <= self.band else "differs") + doubt


@dataclass(frozen=True, repr=False, eq=False)
class Correlation(Sheeted):
    """Measured resonances paired with computed modes."""

    shown: ClassVar[str] = "measured.command:pairs"
    sheeted: ClassVar[str] = "measured.command:correlation_sheet"
    filed: ClassVar[str] = "measured.command:overlaid_sheet"

    #: scene, title: of the scene and of the measurement
    scene: str
    title: str
    pairs: tuple[Pair, ...]  #: one for every measured resonance
    #: modes below the highest resonance that were not measured, with the probability of that
    missed: tuple[tuple[BarredMode, float], ...]
    mesh: str  #: model and mesh
    #: (n, m) of every measured shape and every mode; None where no shapes were measured
    mac: np.ndarray | None
    measured: Measured
    computed: Computed  #: modes that were paired
    likeness: Likeness  #: whether the resonances can be those of this part
    #: sentences on modes that look alike on the measuring points
    of_points: tuple[str, ...] = ()
    cautions: tuple[str, ...] = ()  #: sentences on what the computed frequencies leave out

    @property
    def rms(self) -> float:
        """Root mean square of the differences of all that have a mode, relative."""
        differences = [pair.relative for pair in self.pairs if pair.relative is not None]
        return float(np.sqrt(np.mean(np.square(differences)))) if differences else math.nan

    @property
    def common(self) -> Common | None:
        """Shift and scatter of the pairs that are sure; None of too few."""
        return Common.of([pair.relative for pair in self.pairs if pair.sure and pair.relative])

    @property
    def worst(self) -> Pair | None:
        """Pair with the largest difference."""
        paired = [pair for pair in self.pairs if pair.relative is not None]
        return max(paired, key=lambda pair: abs(pair.relative or 0.0), default=None)

    @property
    def sentences(self) -> list[str]:
        """Conclusions."""
        return list(_sentences(self))

    @property
    def results(self) -> dict[str, Any]:
        """Plain data that JSON can hold, Hz."""
        damping = {}
        if self.measured.responses is not None:
            fit = self.measured.responses.fit
            damping = {"damping": fit.damping, "damping_deviation": fit.deviations[1]}
        return {
            "kind": "correlation",
            "scene": self.scene,
            "measurement": self.title,
            "mesh": self.mesh,
            "rms": None if self.worst is None else self.rms,
            "common": plain(self.common),
            "other_part": plain(self.likeness),
            "pairs": [
                {key: float(values[pair.number - 1]) for key, values in damping.items()}
                | {
                    "number": pair.number,
                    "measured_hz": pair.measured.frequency,
                    "measured_deviation_hz": pair.measured.width_hz,
                    "mode": pair.computed and pair.computed.name,
                    "computed_hz": pair.computed and pair.computed.frequency_hz,
                    "bar_hz": pair.computed and pair.computed.width,
                    "relative": pair.relative,
                    "probability": pair.probability,
                    "mac": pair.mac,
                    "others": [[mode.name, share] for mode, share in pair.others],
                    "verdict": pair.verdict,
                }
                for pair in self.pairs
            ],
            "mac": None
            if self.mac is None
            else [None if np.isnan(row).any() else row.tolist() for row in self.mac],
            "modes": [mode.name for mode in self.computed.barred],
            "not_measured": [
                {"mode": mode.name, "computed_hz": mode.frequency_hz, "probability": share}
                for mode, share in self.missed
            ],
            "sentences": self.sentences,
            "cautions": list(self.cautions),
        }


@pinned
def correlate(
    scene: Source,
    measured: MeasuredSource,
    tol: float | str | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Correlation:
    """Pair measured resonances with the modes of a scene.

    Parameters
    ----------
    scene : path, dict or Scene
        A scene: its file (TOML), the tables of one, or an object.
    measured : path, dict, Measured or sequence of float
        Resonances: a ``.toml``, ``.csv``, ``.unv`` or ``.uff`` file, the tables of a TOML file, or
        frequencies alone, in ascending order, Hz.
    tol : float, optional
        Relative error bar that modes are brought to; a tenth of the tolerance of the scene by
        default.
    progress : callable
        Called with a sentence at every step.

    Returns
    -------
    Correlation
        ``pairs`` of a resonance and a mode each, with their probability, and ``sentences``.

    Raises
    ------
    SceneError
        The file, the key, the value as written, what would be right.

    Examples
    --------
    A free rod with two resonances, half a per cent below those of its scene:

    >>> import solidgear as sg
    >>> rod = sg.Scene.from_parts([sg.Segment.cylinder("rod", length=0.6, diameter=0.02)])
    >>> tap = {"uncertainty": "0.1 %", "mode": [{"frequency": 251.95}, {"frequency": 690.85}]}
    >>> [pair.computed.name for pair in sg.correlate(rod, tap).pairs]
    ['bending 1', 'bending 2']
    """
    scene, measured = load(scene), load_measured(measured)
    tol = scene.ask.tolerance / 10 if tol is None else read_tolerance(tol)
    highest = measured.modes[-1].frequency
    correlation = _paired(measured, computed_up_to(scene, highest, tol, progress))
    if correlation.likeness.sentence or correlation.likeness.condition:
        # of a part that is much softer than the scene more modes lie below
        highest *= math.exp(max(FAR_SHIFTS))
        before = correlation.computed
        wider = _paired(measured, computed_up_to(scene, highest, tol, progress, before))
        if wider.likeness.believed:
            return wider
    return correlation


def placed_in(measured: Measured, computed: Computed) -> Measured:
    """Return measured resonances with their points in the frame of the scene."""
    return measured.placed(computed.body.surface({}), not without_axis(computed.scene))


def on_points_of(measured: Measured, computed: Computed) -> OnPoints | None:
    """Return modes on the measuring points; None without measured shapes."""
    shapes = measured.on_points
    return None if shapes is None else OnPoints(shapes, measured.noise[0], computed)


def peaks_of(
    measured: Measured, computed: Computed, springs: float = 0.0
) -> tuple[list[Peak], list[Peak]]:
    """Return both lists as the pairing takes them; `springs` is the standard deviation of the
    logarithm of a bearing's stiffness.
    """
    of_measured = [
        Peak(
            math.log(mode.frequency),
            UNTOLD if mode.width_hz is None else mode.width_hz / mode.frequency,
            mode.multiplicity,
            ModeName(mode.name).family if mode.name else "",
        )
        for mode in measured.modes
    ]
    of_computed = [
        Peak(
            math.log(m.frequency_hz),
            math.hypot(min(bar, 0.1), width),
            min(m.multiplicity, 2),
            m.name.family,
            2 * measured.damping[0],
        )
        for m, bar, width in zip(computed.modes, computed.bars, computed.widths(springs).tolist())
    ]
    return of_measured, of_computed


def _paired(measured: Measured, computed: Computed) -> Correlation:
    """Pair measured resonances with computed modes."""
    measured = placed_in(measured, computed)
    on_points = on_points_of(measured, computed)
    peaks = peaks_of(measured, computed, SPRINGS)
    alignment = alignment_of(*peaks, on_points.likeness if on_points else None)
    barred = computed.barred
    mac = None if on_points is None else on_points.likeness.mac
    pairs = []
    for k, resonance in enumerate(measured.modes):
        likely = [
            int(j) for j in np.argsort(-alignment.pairs[k]) if alignment.pairs[k, j] > POSSIBLE
        ]
        mode, share, like = None, float(alignment.spurious[k]), None
        if likely and alignment.pairs[k, likely[0]] >= alignment.spurious[k]:
            first, *likely = likely
            mode, share = barred[first], float(alignment.pairs[k, first])
            like = None if mac is None or np.isnan(mac[k, first]) else float(mac[k, first])
        alternatives = tuple((barred[j], float(alignment.pairs[k, j])) for j in likely)
        pairs.append(Pair(k + 1, resonance, mode, share, alternatives, like))
    highest = measured.modes[-1].frequency * math.exp(-alignment.shift)
    below = [mode for mode in computed.modes if mode.frequency_hz <= highest]
    missed = tuple(
        (mode, float(share))
        for mode, share in zip(barred, alignment.missed)
        if share > POSSIBLE and mode.frequency_hz <= highest
    )
    return Correlation(
        scene=computed.scene.title or computed.scene.name,
        title=measured.title,
        pairs=tuple(pairs),
        missed=missed,
        mesh=computed.mesh,
        mac=mac,
        measured=measured,
        computed=computed,
        likeness=Likeness.of(alignment),
        of_points=() if on_points is None else on_points.sentences(below),
        cautions=computed.cautions,
    )


def _sentences(correlation: Correlation) -> Iterator[str]:
    paired = [pair for pair in correlation.pairs if pair.computed is not None]
    sure = [pair for pair in paired if pair.sure]
    doubt = correlation.likeness.sentence
    if doubt:
        yield doubt
    yield (
        f"{len(paired)} of {len(correlation.pairs)} measured resonances have a mode, {len(sure)} of "
        f"them surely (probability {100 * SURE:.0f} %, no "
        f"rival){', if they are of this part' if doubt else ''}."
    )
    worst = correlation.worst
    if worst is not None and worst.computed is not None and worst.relative is not None:
        yield (
            f"Computed frequencies are {100 * correlation.rms:.2g} % rms from the measured ones, at most "
            f"{100 * worst.relative:+.2g} %, of {worst.computed.name}."
        )
    if correlation.common is not None and not doubt:
        yield correlation.common.sentence
    if correlation.likeness.condition:
        yield correlation.likeness.condition
    if worst is not None and all(pair.measured.width_hz is None for pair in paired):
        yield (
            "No resonance has an uncertainty, so that none has a band: write for example "
            'uncertainty = "0.1 %".'
        )
    for pair in correlation.pairs:
        if pair.computed is None:
            yield (
                f"{pair.measured.frequency:.6g} Hz was measured and not computed: it is no "
                "resonance of this part, or of something missing in the scene."
            )
        elif not pair.sure:
            names = ", ".join(f"{mode.name} ({100 * share:.0f} %)" for mode, share in pair.others)
            likeliest = f"{pair.computed.name} ({100 * pair.probability:.0f} %)"
            yield f"{pair.measured.frequency:.6g} Hz is {likeliest}" + (
                f", or with it {names}." if names else "."
            )
    yield from correlation.measured.remarks
    yield from correlation.of_points
    missed, perhaps = [], []
    for mode, share in correlation.missed:
        place = f"{mode.name} at {mode.frequency_hz:.6g} Hz"
        if share >= SURE:
            missed.append(place)
        else:  # it may be the partner of a pair that is not sure
            perhaps.append(f"{place} ({100 * share:.0f} %)")
    if missed:
        yield f"Computed and not measured: {', '.join(missed)}."
    if perhaps:
        yield f"Perhaps not measured: {', '.join(perhaps)}."
