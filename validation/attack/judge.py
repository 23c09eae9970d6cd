"""Arithmetic of the judgements: pairs of modes by shape, errors against the reference, held or
missed, true or false.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.judge.correlation import subspace_mac
from solidgear.judge.quantities import size
from validation.attack.reference import Reference

#: errors below this are rounding and are not judged
SMALL = 1e-7
#: a partner has at least this MAC, and at least this share of the best; stations that a coarse
#: mesh does not know spoil a MAC
LEAST, NEAR_BEST = 0.3, 0.7
#: a frequency further off than this is not looked at as a partner
REACH = 0.5
JUDGED = ("C_zz", "C_thx", "C_yy", "C_z,thx", "bending 1", "axial 1")
FREQUENCIES = ("bending 1", "bending 2", "axial 1", "torsion 1")


@dataclass(frozen=True)
class Truth:
    """A true value, its uncertainty (absolute), and how it was found."""

    value: float
    uncertainty: float
    how: str = ""


def truth_of(name: str, model: dict, reference: Reference) -> Truth | None:
    """The true value of a quantity, or None where it has none or cannot be told.

    A frequency is that of the reference's mode of the same *shape*, whatever either is called.
    """
    if name not in FREQUENCIES:
        if name not in reference.values:
            return None
        return Truth(
            reference.values[name],
            reference.uncertainty[name] * size(reference.values, name),
        )
    mode = next((m for m in model["modes"] if m["name"] == name), None)
    if mode is None:
        return None
    partner, how = partner_of(mode, reference)
    if partner is None:
        return None
    return Truth(partner["frequency_hz"], partner["uncertainty"] * partner["frequency_hz"], how)


def partner_of(mode: dict, reference: Reference) -> tuple[dict | None, str]:
    """The reference's mode of the same shape: nearest in frequency of those alike; by name where
    there are no shapes.
    """
    elastic = [m for m in reference.modes if m["frequency_hz"] > 0]
    if "motions" not in mode:
        return next((m for m in elastic if m["name"] == mode["name"]), None), "by name"
    near = [m for m in elastic if abs(m["frequency_hz"] / mode["frequency_hz"] - 1) < REACH]
    gram = np.array(reference.gram)
    shape = _rows(mode)
    mac = [subspace_mac(shape, _rows(m), gram) for m in near]
    if max(mac, default=0.0) < LEAST:
        return None, "no mode of that shape"
    alike = [m for m, value in zip(near, mac) if value >= max(LEAST, NEAR_BEST * max(mac))]
    best = min(alike, key=lambda m: abs(np.log(m["frequency_hz"] / mode["frequency_hz"])))
    return best, "by shape" if best["name"] == mode[
        "name"
    ] else f"by shape, there called {best['name']}"


def _rows(mode: dict) -> np.ndarray:
    return np.array(mode["motions"]).reshape(len(mode["motions"]), -1)


@dataclass(frozen=True)
class Band:
    """A band held against the truth; error, band and doubt relative to the size of the quantity."""

    quantity: str
    error: float
    band: float
    doubt: float
    how: str
    judged: bool

    @property
    def held(self) -> bool:
        """Whether the band contains the true value."""
        return abs(self.error) <= self.band


def band_of(name: str, model: dict, reference: Reference) -> Band | None:
    """One quantity's band, or None where there is no band or no truth.

    Not judged are errors below `SMALL`, and those where the uncertainty of the truth could turn
    the answer.
    """
    if name not in model["bands"]:
        return None
    truth = truth_of(name, model, reference)
    if truth is None:
        return None
    scale = size(model["values"], name)
    error, band, doubt = (
        (model["values"][name] - truth.value) / scale,
        model["bands"][name] / scale,
        truth.uncertainty / scale,
    )
    clear = abs(abs(error) - band) > doubt
    return Band(name, error, band, doubt, truth.how, abs(error) > SMALL and clear)


def errors_of(model: dict, reference: Reference, names=JUDGED) -> dict[str, tuple[float, float]]:
    """Relative error and doubt of a model's quantities, relative to the true size; those without
    a truth are left out.
    """
    out = {}
    for name in names:
        if name not in model["values"]:
            continue
        truth = truth_of(name, model, reference)
        if truth is not None:
            scale = truth.value if name in FREQUENCIES else size(reference.values, name)
            out[name] = (model["values"][name] - truth.value) / scale, truth.uncertainty / scale
    return out


def within(errors: dict[str, tuple[float, float]], tolerance: float) -> bool | None:
    """Whether all errors are within the tolerance; None where the doubt of one decides."""
    if any(abs(e) - d > tolerance for e, d in errors.values()):
        return False
    return True if all(abs(e) + d <= tolerance for e, d in errors.values()) else None


def called(seed: int, traits: dict) -> str:
    """A scene in a few words."""
    kind, ties = traits["kind"], traits["ties"]
    return f"seed {seed} ({kind}, {ties}, L/D {traits['l_over_d']:.2f})"


def rate(hits: int, of: int) -> str:
    """Share in per cent, with both numbers."""
    return f"{100 * hits / of:.1f} % ({hits}/{of})" if of else "none judged"
