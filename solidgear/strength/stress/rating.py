"""Rating of a fillet against fatigue and yielding by DIN 743, every factor with a source.

The notch is that of the shaft's solid: form factors and stress gradients are computed, beside the
formulas of the norm. Inputs of the norm that were not given are 1, and their source says *assumed*.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from solidgear.core import Model, PositiveLength
from solidgear.strength.stress import din743
from solidgear.strength.stress.din743 import LOADS, Load

if TYPE_CHECKING:
    from solidgear.core.scene.parts import Strength
    from solidgear.strength.stress.nominal import NominalStress
    from solidgear.strength.stress.notch import FilletFactors

#: m, Rz of no shaft is larger; a factor of strength by size or surface, a share of a mean
ROUGHEST = 1e-3
StrengthFactor = Annotated[float, Field(gt=0, le=10)]
Share = Annotated[float, Field(ge=0)]
ASSUMED = "assumed"
OWN = "solid of this shaft"
STILL = "section forces, loads at rest, shaft turning"
BY_GRADIENT = "DIN 743-2, 4.3: 1 + sqrt(G' mm) 10^-(0.33 + sigma_S/712 MPa)"
#: lines of a rating by their symbols: name, usual source, SI unit
LINES: dict[str, tuple[str, str, str]] = {
    "sigma_B": ("tensile strength", "material", "Pa"),
    "sigma_S": ("yield point", "material", "Pa"),
    "K_1 (sigma_B)": ("size, of strength", "", ""),
    "K_1 (sigma_S)": ("size, of yielding", "", ""),
    "alpha": ("form factor Kt", OWN, ""),
    "alpha (norm)": ("the same by formula", "DIN 743-2, table 2; not used", ""),
    "G'": ("relative stress gradient", OWN, "1/m"),
    "G' (norm)": ("the same by formula", "DIN 743-2, table 3; not used", "1/m"),
    "n": ("support number", BY_GRADIENT, ""),
    "beta": ("fatigue notch factor Kf", "DIN 743-2, 4.3: alpha / n, at least 1", ""),
    "beta (norm)": ("the same by formulas", "DIN 743-2; not used", ""),
    "K_2": ("size, of the gradient", "DIN 743-2, eq. 15 and 16", ""),
    "K_F": ("surface roughness", "", ""),
    "K_V": ("hardened surface", "", ""),
    "K_sigma, K_tau": ("total influence", "DIN 743-1: (beta/K_2 + 1/K_F - 1)/K_V", ""),
    "sigma_W": ("limit of a polished bar", "DIN 743-3: 0.4, 0.5, 0.3 sigma_B", "Pa"),
    "sigma_WK": ("limit of the part", "DIN 743-1: K_1 sigma_W / K_sigma", "Pa"),
    "K_2F": ("static support", "DIN 743-1, table 3", ""),
    "gamma_F": ("rise of yielding", "DIN 743-1, table 2", ""),
    "sigma_FK": ("yield limit of the part", "DIN 743-1: K_1 K_2F gamma_F sigma_S", "Pa"),
    "sigma_a": ("nominal amplitude", STILL, "Pa"),
    "sigma_m": ("nominal mean", STILL, "Pa"),
    "sigma_mv": ("equivalent mean", "DIN 743-1, of von Mises", "Pa"),
    "psi_sigmaK": (
        "influence of mean stress",
        "DIN 743-1: sigma_WK/(2 K_1 sigma_B - sigma_WK)",
        "",
    ),
    "sigma_ADK": ("amplitude borne", "", "Pa"),
}
#: those that are attributes of a :class:`FatigueFactor`
FACTORS = {
    "alpha": "form",
    "alpha (norm)": "norm_form",
    "G'": "gradient",
    "G' (norm)": "norm_gradient",
    "n": "support",
    "beta": "notch",
    "beta (norm)": "norm_notch",
}


class Conditions(Model):
    """Data that a rating by DIN 743 needs beyond the shaft, loads and strength; a factor that is
    not positive, or a share below zero, is refused.

    Examples
    --------
    >>> Conditions(roughness="6.3 um", torque_share=0.2).roughness
    6.3e-06
    """

    roughness: Annotated[PositiveLength, Field(le=ROUGHEST)] | None = None  #: rz of the fillet, m
    #: ultimate_at_size, yield_at_size: K_1: strength at the size of the part over the one given
    ultimate_at_size: StrengthFactor | None = None
    yield_at_size: StrengthFactor | None = None
    hardening: StrengthFactor | None = None  #: K_V of the surface
    #: force_share, torque_share: amplitudes of axial force and torque over their mean; the shaft
    #: turns, so that bending is all amplitude
    force_share: Share | None = None
    torque_share: Share | None = None
    #: whether mean stress stays as loads grow (case 1 of the norm) or grows with them (case 2)
    constant_mean: bool = False


@dataclass(frozen=True)
class FatigueFactor:
    """Fatigue notch factor of one load: form factor over support number."""

    #: form, gradient, support, notch: kt and G' (1/m) of the solid, n and Kf = beta
    form: float
    gradient: float
    support: float
    notch: float
    #: norm_form, norm_gradient, norm_notch: alpha and G' by the norm's formulas, and beta from them
    norm_form: float
    norm_gradient: float
    norm_notch: float


@dataclass(frozen=True)
class Entry:
    """A line of a rating: one value a load, or one for all."""

    symbol: str
    what: str
    values: tuple[float | None, ...]
    unit: str  #: of SI; empty for a factor
    source: str


@dataclass(frozen=True)
class Rating:
    """Rating of a fillet by DIN 743."""

    entries: tuple[Entry, ...]  #: all factors, in the order in which they are used
    #: fatigue, yielding: safeties S against fatigue and against yielding; infinite without load
    fatigue: float
    yielding: float
    fatigue_bar: float  #: loss of S if the form factors lie at the upper end of their error bars
    assumed: tuple[str, ...]  #: symbols of assumed factors


def fatigue_factors(
    fillet: FilletFactors, yield_point: float, large: float, bars: float = 0.0
) -> dict[Load, FatigueFactor]:
    """Return fatigue notch factors of a fillet, by the yield point at the size of the part, Pa, and
    the larger diameter of the shoulder, m; form factors are raised by so many error bars.
    """
    small, radius = 2 * fillet.corner.r, fillet.corner.radial
    out: dict[Load, FatigueFactor] = {}
    for load in LOADS:
        factor = fillet.factors[load]
        form = factor.value + bars * factor.bar
        support = din743.support(factor.gradient, yield_point)
        alpha = din743.form_factor(load, large, small, radius)
        slope = din743.gradient(load, large, small, radius)
        norm = max(alpha / din743.support(slope, yield_point), 1.0)
        notch = max(form / support, 1.0)
        out[load] = FatigueFactor(form, factor.gradient, support, notch, alpha, slope, norm)
    return out


def rated(
    fillet: FilletFactors,
    nominal: NominalStress,
    strength: Strength,
    conditions: Conditions,
    large: float,
) -> Rating:
    """Rate a fillet by the nominal stress where it meets the cylinder and the larger diameter of
    the shoulder, m.
    """
    sheet = _Sheet()
    fatigue, yielding = _safeties(sheet, fillet, nominal, strength, conditions, large)
    worst, _ = _safeties(_Sheet(), fillet, nominal, strength, conditions, large, bars=1.0)
    assumed = tuple(entry.symbol for entry in sheet.entries if ASSUMED in entry.source)
    lost = fatigue - worst if math.isfinite(fatigue) else 0.0
    return Rating(tuple(sheet.entries), fatigue, yielding, lost, assumed)


@dataclass(frozen=True)
class _Sheet:
    """Lines of a calculation, in the order in which they are written."""

    entries: list[Entry] = field(default_factory=list)

    def write(
        self, symbol: str, values: Mapping[Load, float] | float, source: str = ""
    ) -> Mapping[Load, float]:
        """Write a line, and return the values of every load in it."""
        by_load = values if isinstance(values, Mapping) else dict.fromkeys(LOADS, values)
        name, usual, unit = LINES[symbol]
        row = tuple(by_load.get(load) for load in LOADS)
        self.entries.append(Entry(symbol, name, row, unit, source or usual))
        return by_load

    def user_factor(self, symbol: str, value: float | None) -> float:
        """Return a factor that a user gives, or one."""
        self.write(symbol, 1.0 if value is None else value, ASSUMED if value is None else "given")
        return 1.0 if value is None else value


def _safeties(
    sheet: _Sheet,
    fillet: FilletFactors,
    nominal: NominalStress,
    strength: Strength,
    conditions: Conditions,
    large: float,
    bars: float = 0.0,
) -> tuple[float, float]:
    """Return safeties against fatigue and yielding, line by line in the order of the norm."""
    write, section = sheet.write, fillet.section
    write("sigma_B", strength.ultimate)
    write("sigma_S", strength.yield_point)
    k1 = sheet.user_factor("K_1 (sigma_B)", conditions.ultimate_at_size)
    ultimate = k1 * strength.ultimate
    yields = sheet.user_factor("K_1 (sigma_S)", conditions.yield_at_size) * strength.yield_point
    notch = _notches(sheet, fatigue_factors(fillet, yields, large, bars))
    size = write("K_2", {load: din743.size_factor(load, 2 * section.outer) for load in LOADS})
    surface = _surface(sheet, conditions.roughness, ultimate)
    hard = sheet.user_factor("K_V", conditions.hardening)
    total = {k: din743.total_factor(notch[k], size[k], surface[k], hard) for k in LOADS}
    write("K_sigma, K_tau", total)
    smooth = {load: din743.ALTERNATING[load] * strength.ultimate for load in LOADS}
    write("sigma_W", smooth)
    limit = write("sigma_WK", {load: k1 * smooth[load] / total[load] for load in LOADS})
    static = _yielding(sheet, notch, yields, hollow=section.inner > 0)
    amplitude, mean = _stress(sheet, nominal, conditions)
    together = math.hypot(mean["tension"], math.sqrt(3) * mean["torsion"])
    equivalent = dict.fromkeys(LOADS, together) | {"torsion": together / math.sqrt(3)}
    write("sigma_mv", equivalent)
    psi = write("psi_sigmaK", {k: din743.mean_sensitivity(limit[k], ultimate) for k in LOADS})
    borne = {}
    for load in LOADS:
        if amplitude[load] > 0:
            borne[load] = din743.amplitude_limit(
                limit=limit[load],
                psi=psi[load],
                static=static[load],
                mean=equivalent[load],
                amplitude=amplitude[load],
                constant_mean=conditions.constant_mean,
            )
    case = "case 1: mean stays" if conditions.constant_mean else "case 2: mean grows with loads"
    write("sigma_ADK", borne, f"DIN 743-1, {case}")
    used = {
        load: amplitude[load] / limit_amplitude if limit_amplitude > 0 else math.inf
        for load, limit_amplitude in borne.items()
    }
    most = {load: (abs(mean[load]) + amplitude[load]) / static[load] for load in LOADS}
    return _safety(used), _safety(most)


def _notches(sheet: _Sheet, notches: Mapping[Load, FatigueFactor]) -> Mapping[Load, float]:
    """Write notch factors with their parts, and return them."""
    for symbol, name in FACTORS.items():
        sheet.write(symbol, {load: getattr(factor, name) for load, factor in notches.items()})
    return {load: factor.notch for load, factor in notches.items()}


def _surface(sheet: _Sheet, roughness: float | None, ultimate: float) -> Mapping[Load, float]:
    """Write and return factors of surface roughness."""
    if roughness is None:
        return sheet.write("K_F", 1.0, f"{ASSUMED}: no roughness given")
    factors = {load: din743.surface_factor(load, roughness, ultimate) for load in LOADS}
    return sheet.write("K_F", factors, f"DIN 743-2, eq. 18 and 19, Rz {1e6 * roughness:g} um")


def _yielding(
    sheet: _Sheet, notch: Mapping[Load, float], yields: float, hollow: bool
) -> Mapping[Load, float]:
    """Write and return the yield limits of the part."""
    support = {load: din743.STATIC_SUPPORT[load][hollow] for load in LOADS}
    rise = {load: din743.yield_rise(load, notch[load]) for load in LOADS}
    point = dict.fromkeys(LOADS, yields) | {"torsion": yields / math.sqrt(3)}
    sheet.write("K_2F", support)
    sheet.write("gamma_F", rise)
    return sheet.write("sigma_FK", {k: support[k] * rise[k] * point[k] for k in LOADS})


def _stress(
    sheet: _Sheet, nominal: NominalStress, conditions: Conditions
) -> tuple[Mapping[Load, float], Mapping[Load, float]]:
    """Write and return nominal amplitudes and means."""
    mean: dict[Load, float]
    mean = {"tension": nominal.tension, "bending": 0.0, "torsion": nominal.torsion}
    amplitude: dict[Load, float] = {
        "tension": abs(nominal.tension) * (conditions.force_share or 0.0),
        "bending": nominal.bending,
        "torsion": abs(nominal.torsion) * (conditions.torque_share or 0.0),
    }
    shares = {"force": conditions.force_share, "torque": conditions.torque_share}
    bare = " and ".join(word for word, share in shares.items() if share is None)
    steady = f"; {ASSUMED} steady: {bare}" if bare else ""
    sheet.write("sigma_a", amplitude, LINES["sigma_a"][1] + steady)
    return amplitude, sheet.write("sigma_m", mean)


def _safety(shares: Mapping[Load, float]) -> float:
    """Return the safety from shares of the limits (DIN 743-1): normal stresses add, shear is
    perpendicular.
    """
    normal = shares.get("tension", 0.0) + shares.get("bending", 0.0)
    used = math.hypot(normal, shares.get("torsion", 0.0))
    return 1 / used if used > 0 else math.inf
