"""Rating of a fillet against fatigue and yielding by DIN 743, every factor with its source.

The notch is that of the shaft's own solid: form factors and stress gradients are computed, and the
norm's formulas stand beside them. What the norm asks and nobody gave is taken as 1, and its source
says *assumed*.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from solidgear.errors import SolidgearError
from solidgear.studies.stress import din743
from solidgear.studies.stress.din743 import LOADS, Load

if TYPE_CHECKING:
    from solidgear.scene.parts import Strength
    from solidgear.studies.stress.nominal import NominalStress
    from solidgear.studies.stress.notch import FilletFactors

ASSUMED = "assumed"
OWN = "solid of this shaft"


@dataclass(frozen=True)
class Conditions:
    """What a rating by DIN 743 needs beyond the shaft, its loads and its strength.

    Attributes
    ----------
    roughness : float or None
        Rz of the fillet, m.
    ultimate_at_size, yield_at_size : float or None
        K_1: strength at the size of the part over the one given.
    hardening : float or None
        K_V of the surface.
    force_share, torque_share : float or None
        Amplitudes of axial force and torque over their mean; the shaft turns, so that bending is
        all amplitude.
    constant_mean : bool
        Whether mean stress stays as loads grow (case 1 of the norm) or grows with them (case 2).

    Raises
    ------
    SolidgearError
        For a factor that is not positive, or a share below zero.
    """

    roughness: float | None = None
    ultimate_at_size: float | None = None
    yield_at_size: float | None = None
    hardening: float | None = None
    force_share: float | None = None
    torque_share: float | None = None
    constant_mean: bool = False

    def __post_init__(self) -> None:
        for name in ("roughness", "ultimate_at_size", "yield_at_size", "hardening"):
            value = getattr(self, name)
            if value is not None and not value > 0:
                raise SolidgearError(f"{name} = {value}: it must be greater than zero")
        for name in ("force_share", "torque_share"):
            value = getattr(self, name)
            if value is not None and not value >= 0:
                raise SolidgearError(f"{name} = {value}: it must not be negative")


@dataclass(frozen=True)
class FatigueFactor:
    """Fatigue notch factor of one load: form factor over support number.

    Attributes
    ----------
    form, gradient, support, notch : float
        Kt and G' (1/m) of the solid, n and Kf = beta.
    norm_form, norm_gradient, norm_notch : float
        alpha and G' by the norm's formulas, and what they make of beta.
    """

    form: float
    gradient: float
    support: float
    notch: float
    norm_form: float
    norm_gradient: float
    norm_notch: float


@dataclass(frozen=True)
class Entry:
    """A line of a rating: one value a load, or one for all.

    Attributes
    ----------
    symbol, what : str
    values : tuple of float or None
        Of tension, bending and torsion, SI.
    unit : str
        Of SI; empty for a factor.
    source : str
    """

    symbol: str
    what: str
    values: tuple[float | None, ...]
    unit: str
    source: str


@dataclass(frozen=True)
class Rating:
    """Rating of a fillet by DIN 743.

    Attributes
    ----------
    entries : tuple of Entry
        All factors, in the order in which they are used.
    fatigue, yielding : float
        Safeties S against fatigue and against yielding; infinite without load.
    fatigue_bar : float
        What S loses if the form factors lie at the upper end of their bars.
    assumed : tuple of str
        Symbols of what was assumed.
    """

    entries: tuple[Entry, ...]
    fatigue: float
    yielding: float
    fatigue_bar: float
    assumed: tuple[str, ...]


def fatigue_factors(
    found: FilletFactors, yield_point: float, large: float, bars: float = 0.0
) -> dict[Load, FatigueFactor]:
    """Fatigue notch factors of a fillet.

    Parameters
    ----------
    found : FilletFactors
    yield_point : float
        Of the part at its size, Pa.
    large : float
        Larger diameter of the shoulder, m.
    bars : float
        How many bars the form factors are raised by.

    Returns
    -------
    dict of str to FatigueFactor
    """
    small, radius = 2 * found.corner.r, found.corner.radial
    out: dict[Load, FatigueFactor] = {}
    for load in LOADS:
        factor = found.factors[load]
        form = factor.value + bars * factor.bar
        support = din743.support(factor.gradient, yield_point)
        alpha = din743.form_factor(load, large, small, radius)
        slope = din743.gradient(load, large, small, radius)
        norm = max(alpha / din743.support(slope, yield_point), 1.0)
        notch = max(form / support, 1.0)
        out[load] = FatigueFactor(form, factor.gradient, support, notch, alpha, slope, norm)
    return out


def rated(
    found: FilletFactors,
    nominal: NominalStress,
    strength: Strength,
    conditions: Conditions,
    large: float,
) -> Rating:
    """Rate a fillet.

    Parameters
    ----------
    found : FilletFactors
    nominal : NominalStress
        Where the fillet meets its cylinder.
    strength : Strength
    conditions : Conditions
    large : float
        Larger diameter of the shoulder, m.

    Returns
    -------
    Rating
    """
    usual, worst = (
        _Sheet(found, nominal, strength, conditions, large, bars) for bars in (0.0, 1.0)
    )
    entries = tuple(usual.entries)
    assumed = tuple(entry.symbol for entry in entries if ASSUMED in entry.source)
    lost = usual.fatigue - worst.fatigue if math.isfinite(usual.fatigue) else 0.0
    return Rating(entries, usual.fatigue, usual.yielding, lost, assumed)


class _Sheet:
    """The calculation, line by line in the order of the norm."""

    def __init__(self, found, nominal, strength, conditions, large, bars):
        self.entries: list[Entry] = []
        section, given = found.section, conditions
        ultimate, yields = strength.ultimate, strength.yield_point
        self._line("sigma_B", "tensile strength", (ultimate,) * 3, "material", "Pa")
        self._line("sigma_S", "yield point", (yields,) * 3, "material", "Pa")
        k1 = self._factor("K_1 (sigma_B)", "size, of strength", given.ultimate_at_size)
        k1_yield = self._factor("K_1 (sigma_S)", "size, of yielding", given.yield_at_size)
        ultimate, yields = k1 * ultimate, k1_yield * yields
        notches = fatigue_factors(found, yields, large, bars)
        self._notches(notches)
        size = {load: din743.size_factor(load, 2 * section.outer) for load in LOADS}
        self._line("K_2", "size, of the gradient", size, "DIN 743-2, eq. 15 and 16")
        surface = self._surface(given.roughness, ultimate)
        hardening = self._factor("K_V", "hardened surface", given.hardening)
        total = {
            load: din743.total_factor(notches[load].notch, size[load], surface[load], hardening)
            for load in LOADS
        }
        self._line(
            "K_sigma, K_tau", "total influence", total, "DIN 743-1: (beta/K_2 + 1/K_F - 1)/K_V"
        )
        smooth = {load: din743.ALTERNATING[load] * strength.ultimate for load in LOADS}
        self._line(
            "sigma_W", "limit of a polished bar", smooth, "DIN 743-3: 0.4, 0.5, 0.3 sigma_B", "Pa"
        )
        limit = {load: k1 * smooth[load] / total[load] for load in LOADS}
        self._line("sigma_WK", "limit of the part", limit, "DIN 743-1: K_1 sigma_W / K_sigma", "Pa")
        static = self._yielding(notches, yields, hollow=section.inner > 0)
        amplitude, mean = self._stress(nominal, given)
        together = math.sqrt(mean["tension"] ** 2 + 3 * mean["torsion"] ** 2)
        equivalent = {load: together for load in LOADS} | {"torsion": together / math.sqrt(3)}
        self._line("sigma_mv", "equivalent mean", equivalent, "DIN 743-1, of von Mises", "Pa")
        psi = {load: din743.mean_sensitivity(limit[load], ultimate) for load in LOADS}
        self._line(
            "psi_sigmaK",
            "influence of mean stress",
            psi,
            "DIN 743-1: sigma_WK/(2 K_1 sigma_B - sigma_WK)",
        )
        bears = {
            load: din743.amplitude_limit(
                limit[load],
                psi[load],
                static[load],
                equivalent[load],
                amplitude[load],
                given.constant_mean,
            )
            for load in LOADS
            if amplitude[load] > 0
        }
        case = "case 1: mean stays" if given.constant_mean else "case 2: mean grows with loads"
        self._line("sigma_ADK", "amplitude borne", bears, f"DIN 743-1, {case}", "Pa")
        self.fatigue = _safety({load: amplitude[load] / at for load, at in bears.items() if at > 0})
        if any(at <= 0 for at in bears.values()):
            self.fatigue = 0.0
        peak = {load: abs(mean[load]) + amplitude[load] for load in LOADS}
        self.yielding = _safety({load: peak[load] / static[load] for load in LOADS})

    def _line(self, symbol, what, values, source, unit=""):
        if isinstance(values, Mapping):
            values = tuple(values.get(load) for load in LOADS)
        self.entries.append(Entry(symbol, what, values, unit, source))

    def _factor(self, symbol: str, what: str, given: float | None) -> float:
        """A factor that is given, or one."""
        value = 1.0 if given is None else given
        self._line(symbol, what, (value,) * 3, ASSUMED if given is None else "given")
        return value

    def _notches(self, notches: Mapping[Load, FatigueFactor]) -> None:
        def of(name: str) -> dict[Load, float]:
            return {load: getattr(notches[load], name) for load in LOADS}

        self._line("alpha", "form factor Kt", of("form"), OWN)
        self._line(
            "alpha (norm)", "the same by formula", of("norm_form"), "DIN 743-2, table 2; not used"
        )
        self._line("G'", "relative stress gradient", of("gradient"), OWN, "1/m")
        self._line(
            "G' (norm)",
            "the same by formula",
            of("norm_gradient"),
            "DIN 743-2, table 3; not used",
            "1/m",
        )
        self._line(
            "n",
            "support number",
            of("support"),
            "DIN 743-2, 4.3: 1 + sqrt(G' mm) 10^-(0.33 + sigma_S/712 MPa)",
        )
        self._line(
            "beta", "fatigue notch factor Kf", of("notch"), "DIN 743-2, 4.3: alpha / n, at least 1"
        )
        self._line("beta (norm)", "the same by formulas", of("norm_notch"), "DIN 743-2; not used")

    def _surface(self, roughness: float | None, ultimate: float) -> dict[Load, float]:
        factors = dict.fromkeys(LOADS, 1.0)
        source = f"{ASSUMED}: no roughness given"
        if roughness is not None:
            factors = {load: din743.surface_factor(load, roughness, ultimate) for load in LOADS}
            source = f"DIN 743-2, eq. 18 and 19, Rz {1e6 * roughness:g} um"
        self._line("K_F", "surface roughness", factors, source)
        return factors

    def _yielding(self, notches, yields: float, hollow: bool) -> dict[Load, float]:
        """Yield limits of the part."""
        support = {load: din743.STATIC_SUPPORT[load][hollow] for load in LOADS}
        self._line("K_2F", "static support", support, "DIN 743-1, table 3")
        rise = {load: din743.yield_rise(load, notches[load].notch) for load in LOADS}
        self._line("gamma_F", "rise of yielding", rise, "DIN 743-1, table 2")
        point = dict.fromkeys(LOADS, yields) | {"torsion": yields / math.sqrt(3)}
        out = {load: support[load] * rise[load] * point[load] for load in LOADS}
        self._line(
            "sigma_FK", "yield limit of the part", out, "DIN 743-1: K_1 K_2F gamma_F sigma_S", "Pa"
        )
        return out

    def _stress(self, nominal, given) -> tuple[dict[Load, float], dict[Load, float]]:
        """Nominal amplitudes and means by load."""
        shares: dict[Load, float]
        shares = {"tension": given.force_share or 0.0, "torsion": given.torque_share or 0.0}
        mean: dict[Load, float]
        mean = {"tension": nominal.tension, "bending": 0.0, "torsion": nominal.torsion}
        amplitude: dict[Load, float]
        amplitude = {load: abs(mean[load]) * share for load, share in shares.items()}
        amplitude["bending"] = nominal.bending
        told = "section forces, loads at rest, shaft turning"
        bare = [
            w
            for w, v in (("force", given.force_share), ("torque", given.torque_share))
            if v is None
        ]
        steady = f"; {ASSUMED} steady: {' and '.join(bare)}" if bare else ""
        self._line("sigma_a", "nominal amplitude", amplitude, told + steady, "Pa")
        self._line("sigma_m", "nominal mean", mean, told, "Pa")
        return amplitude, mean


def _safety(shares: Mapping[Load, float]) -> float:
    """Safety from shares of what is borne (DIN 743-1): normal stresses add, shear stands across."""
    normal = shares.get("tension", 0.0) + shares.get("bending", 0.0)
    used = math.hypot(normal, shares.get("torsion", 0.0))
    return 1 / used if used > 0 else math.inf
