"""Rating of a notch against fatigue, yielding and a first crack by DIN 743, every factor with a
source.

A notch hands out its factors (:class:`~solidgear.strength.stress.rated_notch.RatedNotch`): a fillet
those of the shaft's solid, other notches those of the norm. Inputs of the norm that were not given
are 1, and their source says *assumed*.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal, NamedTuple

from solidgear.strength.stress import din743
from solidgear.strength.stress.din743 import LOADS, Load
from solidgear.strength.stress.norm import steels
from solidgear.strength.stress.norm.life import (
    DAMAGE_SUM,
    EXPONENTS,
    elementary_repetitions,
    equivalent_share,
)
from solidgear.strength.stress.rated_notch import ByLoad, RatedNotch, Steel
from solidgear.strength.stress.rating_lines import ASSUMED, LINES, Entry

if TYPE_CHECKING:
    from solidgear.core.scene.parts import Strength
    from solidgear.strength.stress.conditions import Conditions, LoadLevel
    from solidgear.strength.stress.nominal import NominalStress


Kind = Literal["fatigue", "yielding", "crack"]
KINDS: tuple[Kind, ...] = ("fatigue", "yielding", "crack")


@dataclass(frozen=True)
class Rating:
    """Rating of a notch by DIN 743."""

    entries: tuple[Entry, ...]  #: all factors, in the order in which they are used
    #: fatigue, yielding: safeties S against fatigue and against yielding; infinite without load
    fatigue: float
    yielding: float
    #: against a first crack in a hard surface; none without one, or without its strength
    crack: float | None
    fatigue_bar: float  #: loss of S if the form factors lie at the upper end of their error bars
    assumed: tuple[str, ...]  #: symbols of assumed factors
    #: safeties against fatigue and yielding with K_1 of the group of steels that falls most; none
    #: where K_1 is known
    least: tuple[float, float] | None
    #: safety against fatigue of a spectrum by the elementary rule; none without one
    elementary: float | None

    @property
    def worst(self) -> float:
        """Least of all safeties."""
        return min(self.safeties.values())

    @property
    def safeties(self) -> dict[Kind, float]:
        """Safeties that are known, by kind."""
        known = zip(KINDS, (self.fatigue, self.yielding, self.crack))
        return {kind: value for kind, value in known if value is not None}

    def with_least_of(self, ratings: Sequence[Rating]) -> Rating:
        """Return this rating with the least safety of every kind among several of the same notch."""
        least = [each.least for each in ratings if each.least is not None]
        cracks = [each.crack for each in ratings if each.crack is not None]
        elementary = [each.elementary for each in ratings if each.elementary is not None]
        return replace(
            self,
            fatigue=min(each.fatigue for each in ratings),
            yielding=min(each.yielding for each in ratings),
            crack=min(cracks, default=None),
            least=(min(a for a, _ in least), min(b for _, b in least)) if least else None,
            elementary=min(elementary, default=None),
        )


def severity(rating: Rating | None, stress: float) -> tuple[float, float, float]:
    """Return the rank of a notch, the worst least: the safety against fatigue, then the least of all,
    then minus its stress, Pa; without a rating the stress alone.
    """
    if rating is None:
        return math.inf, math.inf, -stress
    return rating.fatigue, rating.worst, -stress


def rated(
    notch: RatedNotch,
    levels: Sequence[LoadLevel],
    strength: Strength,
    conditions: Conditions,
    largest: float,
    source: str,
    raised: RatedNotch | None = None,
) -> Rating:
    """Rate a notch under levels of nominal stress, by a strength and its source, the largest diameter
    of the shaft, m, and the same notch with form factors at the upper end of their error bars.
    """
    sheet = _Sheet()
    sheet.write("sigma_B", strength.ultimate, source)
    sheet.write("sigma_S", strength.yield_point, source)
    sizes = _sizes(sheet, strength, conditions, largest)
    result = _safeties(sheet, notch, levels, strength, conditions, sizes)
    other = result
    if raised is not None:
        other = _safeties(_Sheet(), raised, levels, strength, conditions, sizes)
    assumed = tuple(entry.symbol for entry in sheet.entries if ASSUMED in entry.source)
    least = None
    if {"K_1 (sigma_B)", "K_1 (sigma_S)"} & {*assumed}:
        diameter = min(conditions.treated_diameter or largest, steels.LARGEST)
        worst = steels.least_size_factors(diameter)
        small = _safeties(_Sheet(), notch, levels, strength, conditions, worst)
        least = small.fatigue, small.yielding
    lost = result.fatigue - other.fatigue if math.isfinite(result.fatigue) else 0.0
    return Rating(
        entries=tuple(sheet.entries),
        fatigue=result.fatigue,
        yielding=result.yielding,
        crack=result.crack,
        fatigue_bar=lost,
        assumed=assumed,
        least=least,
        elementary=result.elementary,
    )


class _Safeties(NamedTuple):
    """Safeties of one calculation."""

    fatigue: float
    yielding: float
    crack: float | None
    elementary: float | None


@dataclass(frozen=True)
class _Sheet:
    """Lines of a calculation, in the order in which they are written."""

    entries: list[Entry] = field(default_factory=list)

    def write(self, symbol: str, values: ByLoad | float, source: str = "") -> ByLoad:
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


def _sizes(
    sheet: _Sheet, strength: Strength, conditions: Conditions, largest: float
) -> tuple[float, float]:
    """Write and return K_1 of tensile strength and of the yield point."""
    by_group: tuple[float | None, float | None] = (None, None)
    diameter = conditions.treated_diameter or largest
    source = ""
    if strength.group is not None and diameter <= steels.LARGEST:
        by_group = steels.size_factors(strength.group, diameter)
        of_whom = "given" if conditions.treated_diameter else "largest of the shaft"
        group = strength.group.replace("_", " ")
        source = f"DIN 743-2, eq. 10 to 14: {group}, d_eff {1e3 * diameter:g} mm ({of_whom})"
    elif strength.group is not None:
        source = f"{ASSUMED}: the norm ends at d_eff {1e3 * steels.LARGEST:g} mm"
        by_group = (1.0, 1.0)
    factors = []
    given = (conditions.ultimate_at_size, conditions.yield_at_size)
    for symbol, user, group_factor in zip(("K_1 (sigma_B)", "K_1 (sigma_S)"), given, by_group):
        if user is None and group_factor is not None:
            sheet.write(symbol, group_factor, source)
            factors.append(group_factor)
        else:
            factors.append(sheet.user_factor(symbol, user))
    return factors[0], factors[1]


def _safeties(
    sheet: _Sheet,
    notch: RatedNotch,
    levels: Sequence[LoadLevel],
    strength: Strength,
    conditions: Conditions,
    sizes: tuple[float, float],
) -> _Safeties:
    """Return the safeties, line by line in the order of the norm."""
    write, k1 = sheet.write, sizes[0]
    ultimate, yields = k1 * strength.ultimate, sizes[1] * strength.yield_point
    factors = notch.factors(Steel(ultimate, yields, conditions.hard_surface))
    for line in factors.lines:
        write(line.symbol, line.values, line.source)
    beta = factors.notch
    size = write("K_2", {load: din743.size_factor(load, notch.diameter) for load in LOADS})
    surface = _surface(sheet, conditions.roughness, ultimate, notch.tested_roughness)
    hard = sheet.user_factor("K_V", conditions.hardening)
    total = {k: din743.total_factor(beta[k], size[k], surface[k], hard) for k in LOADS}
    write("K_sigma, K_tau", total)
    smooth = {load: din743.ALTERNATING[load] * strength.ultimate for load in LOADS}
    write("sigma_W", smooth)
    limit = write("sigma_WK", {load: k1 * smooth[load] / total[load] for load in LOADS})
    rise = factors.rise if notch.revolved and not conditions.hard_surface else {}
    static = _yielding(sheet, rise, yields, notch.hollow, conditions.hard_surface)
    psi = {k: din743.mean_sensitivity(limit[k], ultimate) for k in LOADS}
    worst = max(levels, key=lambda level: _size(level.nominal))
    stress = _Stress.of(worst.nominal, conditions)
    stress.write(sheet, conditions)
    write("psi_sigmaK", psi)
    stresses = [_Stress.of(level.nominal, conditions) for level in levels]
    borne = [each.borne(limit, psi, static, conditions.constant_mean) for each in stresses]
    case = "case 1: mean stays" if conditions.constant_mean else "case 2: mean grows with loads"
    write("sigma_ADK", borne[levels.index(worst)], f"DIN 743-1, {case}")
    shares = [each.shares(amplitudes) for each, amplitudes in zip(stresses, borne)]
    used, elementary = _used(sheet, levels, shares, conditions.damage_sum)
    overload = sheet.user_factor("overload", conditions.overload)
    yielding = min(
        _safety({load: overload * each.largest(load) / static[load] for load in LOADS})
        for each in stresses
    )
    crack = _crack(sheet, factors.peak, stress, overload, conditions.surface_strength)
    return _Safeties(_safety(used), yielding, crack, elementary)


def _size(nominal: NominalStress) -> float:
    return math.hypot(nominal.bending + abs(nominal.tension), math.sqrt(3) * nominal.torsion)


@dataclass(frozen=True)
class _Stress:
    """Nominal amplitudes and means, Pa."""

    amplitude: ByLoad
    mean: ByLoad

    @classmethod
    def of(cls, nominal: NominalStress, conditions: Conditions) -> _Stress:
        """Return those of a turning shaft, whose bending is all amplitude, or of one that stands."""
        share = conditions.bending_share
        amplitude: dict[Load, float] = {
            "tension": abs(nominal.tension) * (conditions.force_share or 0.0),
            "bending": nominal.bending * (1.0 if share is None else share),
            "torsion": abs(nominal.torsion) * (conditions.torque_share or 0.0),
        }
        mean: dict[Load, float] = {
            "tension": nominal.tension,
            "bending": 0.0 if share is None else nominal.bending,
            "torsion": nominal.torsion,
        }
        return cls(amplitude, mean)

    @property
    def equivalent(self) -> ByLoad:
        """Equivalent means of von Mises, on the side where bending adds to tension."""
        normal = abs(self.mean["tension"]) + self.mean["bending"]
        together = math.hypot(normal, math.sqrt(3) * self.mean["torsion"])
        out: dict[Load, float] = dict.fromkeys(LOADS, together)
        return out | {"torsion": together / math.sqrt(3)}

    def write(self, sheet: _Sheet, conditions: Conditions) -> None:
        """Write amplitudes and means."""
        shares = {"force": conditions.force_share, "torque": conditions.torque_share}
        bare = " and ".join(word for word, share in shares.items() if share is None)
        steady = f"; {ASSUMED} steady: {bare}" if bare else ""
        sheet.write("sigma_a", self.amplitude, LINES["sigma_a"][1] + steady)
        sheet.write("sigma_m", self.mean)
        sheet.write("sigma_mv", self.equivalent)

    def borne(
        self, limit: ByLoad, psi: ByLoad, static: ByLoad, constant_mean: bool
    ) -> dict[Load, float]:
        """Return the amplitudes that the part bears, of loads that have one."""
        equivalent = self.equivalent
        return {
            load: din743.amplitude_limit(
                limit=limit[load],
                psi=psi[load],
                static=static[load],
                mean=equivalent[load],
                amplitude=self.amplitude[load],
                constant_mean=constant_mean,
            )
            for load in LOADS
            if self.amplitude[load] > 0
        }

    def shares(self, borne: ByLoad) -> dict[Load, float]:
        """Return the amplitudes over those borne."""
        return {
            load: self.amplitude[load] / most if most > 0 else math.inf
            for load, most in borne.items()
        }

    def largest(self, load: Load) -> float:
        """Return the largest nominal stress of a load, Pa."""
        return abs(self.mean[load]) + self.amplitude[load]


def _surface(
    sheet: _Sheet, roughness: float | None, ultimate: float, tested: float | None
) -> ByLoad:
    """Write and return factors of surface roughness, of factors from tests over that of the tests."""
    if tested == 0:
        return sheet.write("K_F", 1.0, "DIN 743-2, table 1: in the factors of the tests")
    if roughness is None:
        return sheet.write("K_F", 1.0, f"{ASSUMED}: no roughness given")
    factors = {load: din743.surface_factor(load, roughness, ultimate) for load in LOADS}
    source = f"DIN 743-2, eq. 18 and 19, Rz {1e6 * roughness:g} um"
    if tested is not None:
        of_tests = {load: din743.surface_factor(load, tested, ultimate) for load in LOADS}
        factors = {load: min(factors[load] / of_tests[load], 1.0) for load in LOADS}
        source = (
            f"DIN 743-2, eq. 20 and 21, Rz {1e6 * roughness:g} um over {1e6 * tested:g} um of "
            "the tests, at most 1"
        )
    return sheet.write("K_F", factors, source)


def _yielding(sheet: _Sheet, rises: ByLoad, yields: float, hollow: bool, hard: bool) -> ByLoad:
    """Write and return the yield limits of the part."""
    support = {load: 1.0 if hard else din743.STATIC_SUPPORT[load][hollow] for load in LOADS}
    rise = {load: din743.yield_rise(load, rises.get(load, 1.0)) for load in LOADS}
    point = dict.fromkeys(LOADS, yields) | {"torsion": yields / math.sqrt(3)}
    sheet.write("K_2F", support)
    sheet.write("gamma_F", rise, "" if rises else "DIN 743-1, table 2: no notch around the shaft")
    return sheet.write("sigma_FK", {k: support[k] * rise[k] * point[k] for k in LOADS})


def _used(
    sheet: _Sheet,
    levels: Sequence[LoadLevel],
    shares: Sequence[ByLoad],
    damage_sum: float | None,
) -> tuple[dict[Load, float], float | None]:
    """Return the shares of the limits that levels use, and the safety of a spectrum by the elementary
    rule.
    """
    cycles = [level.cycles for level in levels]
    counts = [count for count in cycles if count is not None]
    if not counts:
        hardest: ByLoad = max(shares, key=_use)
        return dict(hardest), None
    several = len(levels) > 1
    borne = (damage_sum or DAMAGE_SUM) if several else 1.0
    used: dict[Load, float] = {}
    elementary: dict[Load, float] = {}
    for load in LOADS:
        of_levels = [share.get(load, 0.0) for share in shares]
        if max(of_levels) <= 0:
            continue
        if math.isinf(max(of_levels)):  # a mean beyond yielding leaves no amplitude
            used[load] = elementary[load] = math.inf
            continue
        exponent = EXPONENTS[load]
        used[load] = equivalent_share(of_levels, counts, exponent, borne)
        repeated = borne * elementary_repetitions(of_levels, counts, exponent)
        elementary[load] = repeated ** (-1 / exponent)
    if several:
        given = "given" if damage_sum is not None else f"{ASSUMED}: FKM guideline, of steel"
        sheet.write("D_M", borne, given)
    most = "DIN 743-4: knee 1e6 cycles, slopes 5, 5, 8"
    rule = f"{most}; consequent Miner" if several else most
    sheet.write("u", used, rule)
    return used, _safety(elementary) if several else None


def _crack(
    sheet: _Sheet, peak: ByLoad | None, stress: _Stress, overload: float, strength: float | None
) -> float | None:
    """Return the safety of a hard surface against a first crack: its strength over the largest
    principal stress in the notch; none where that is not known.
    """
    if strength is None or peak is None:
        return None
    local = {load: overload * peak[load] * stress.largest(load) for load in LOADS}
    normal, shear = (local["tension"] + local["bending"]) / 2, local["torsion"]
    principal = normal + math.hypot(normal, shear)
    sheet.write("sigma_B, surface", strength, "given")
    sheet.write("sigma_1", principal)
    return strength / principal if principal > 0 else math.inf


def _use(shares: ByLoad) -> float:
    """Return the share of all limits together (DIN 743-1): normal stresses add, shear is
    perpendicular.
    """
    normal = shares.get("tension", 0.0) + shares.get("bending", 0.0)
    return math.hypot(normal, shares.get("torsion", 0.0))


def _safety(shares: ByLoad) -> float:
    """Return the safety from shares of the limits."""
    used = _use(shares)
    return 1 / used if used > 0 else math.inf
