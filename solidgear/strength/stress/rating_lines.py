"""Lines of a rating by DIN 743: what each symbol is, its usual source, and its unit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from solidgear.strength.stress.din743 import Load

ASSUMED = "assumed"
OWN = "solid of this shaft"
STILL = "section forces, loads at rest, shaft turning"
BY_GRADIENT = "DIN 743-2, 4.3: 1 + sqrt(G' mm) 10^-(0.33 + sigma_S/712 MPa)"
BY_GRADIENT_HARD = "DIN 743-2, 4.3: 1 + sqrt(G' mm) 10^-0.7, of a hard surface"
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
    "beta (d_BK)": ("factor of the tests", "", ""),
    "K_3 (d_BK)": ("size of the tests", "DIN 743-2, eq. 17", ""),
    "K_3 (d)": ("size of the notch", "DIN 743-2, eq. 17", ""),
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
    "overload": ("largest load over the load", "", ""),
    "D_M": ("sum of damage borne", "", ""),
    "u": ("share of the limit by all cycles", "", ""),
    "sigma_B, surface": ("strength of the hard surface", "", "Pa"),
    "sigma_1": (
        "largest principal stress there",
        "alpha times nominal stress, elastic; DIN 743-1 asks for this check",
        "Pa",
    ),
}


class Line(NamedTuple):
    """A line that a notch writes: the usual source where its own is empty."""

    symbol: str
    values: Mapping[Load, float]
    source: str = ""


@dataclass(frozen=True)
class Entry:
    """A line of a rating: one value a load, or one for all."""

    symbol: str
    what: str
    values: tuple[float | None, ...]
    unit: str  #: of SI; empty for a factor
    source: str
