"""Problem: dynamic stiffness at the lumped point of two pinions, (z, thx), over frequency up to
twice the first fixed-interface mode (lumped point held still). Reference: the exact dynamic
stiffness of the same beam, by a direct solution at each frequency.

Models: static condensation (stiffness alone), the same with the rigid mass of the body, and Guyan's
reduction (mass condensed on the static shapes).
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as sla

import solidgear as sg
from solidgear.core.body import as_supports
from solidgear.core.reduction.lumped_point import lumped_point
from validation.common import ROOT
from validation.stability.bearing_extremes import assembled, block_of
from validation.stability.frame import Finding, crossing, curve

SCENES = ("pinion_overhung", "pinion_straddle")
MODELS = ("static", "total mass", "Guyan")
LEVELS = (0.01, 0.1)


class Exact:
    """Dynamic stiffness of a supported beam at its lumped point, and the modes with that point free
    and held.
    """

    def __init__(self, scene):
        self.body = sg.build(scene, "timoshenko")
        supports = as_supports(scene)
        block = block_of(self.body)
        self.k, self.m = assembled(self.body, supports).toarray(), block.mass.tocsr().toarray()
        index = self.body.port_index(scene.port.name)
        self.pick = block.ports[2 * index : 2 * index + 2].toarray()
        free = sla.null_space(self.pick)
        value = sla.eigh(free.T @ self.k @ free, free.T @ self.m @ free, eigvals_only=True)
        self.fixed_interface, self.second_fixed = np.sqrt(value[:2])
        self.first, self.second = np.sqrt(sla.eigh(self.k, self.m, eigvals_only=True)[:2])

    def __call__(self, omega: float) -> np.ndarray:
        """(2, 2) on (z, thx)."""
        return np.linalg.inv(self.pick @ np.linalg.solve(self.k - omega**2 * self.m, self.pick.T))


def off(got, exact, static) -> float:
    """Largest difference of two dynamic stiffnesses, in units of the static one (its principal
    directions brought to 1).
    """
    root = np.linalg.inv(np.linalg.cholesky(static))
    return float(np.abs(np.linalg.eigvalsh(root @ (got - exact) @ root.T)).max())


def measure(quick: bool = False) -> Finding:
    """Distance from the exact dynamic stiffness over frequency."""
    rows, edges, first = [], {}, {}
    ratios = np.geomspace(0.03, 2.0, 30 if quick else 160)
    for name in SCENES:
        scene = sg.load(ROOT / "geometry" / f"{name}.toml").with_attachment("section")
        exact = Exact(scene)
        point, _ = lumped_point(exact.body, scene, scene.port.name)
        mass = {
            "static": np.zeros((2, 2)),
            "total mass": np.diag([point.total_mass, point.total_inertia]),
            "Guyan": point.guyan,
        }
        mine = []
        for ratio in ratios:
            omega = ratio * exact.fixed_interface
            here = exact(omega)
            row = {"scene": name, "w / w_fixed": float(ratio), "w / w1": float(omega / exact.first)}
            mine.append(
                row
                | {
                    model: off(point.stiffness - omega**2 * mass[model], here, point.stiffness)
                    for model in MODELS
                }
            )
        rows += mine
        before = [r for r in mine if r["w / w_fixed"] < 0.99]
        edges |= {
            (name, model, level): crossing(
                [r["w / w_fixed"] for r in before], [r[model] for r in before], level
            )
            for model in MODELS
            for level in LEVELS
        }
        guyan = np.sqrt(sla.eigh(point.stiffness, point.guyan, eigvals_only=True))
        first[name] = (
            exact.first / exact.fixed_interface,
            guyan[0] / exact.first - 1,
            guyan[1] / exact.second - 1,
        )

    def told(name):
        share, one, two = first[name]
        limits = ", ".join(
            f"{model} {edges[name, model, 0.01]:.2f} / {edges[name, model, 0.1]:.2f}"
            for model in ("static", "Guyan")
        )
        return (
            f"On {name} {limits}; first mode at {share:.2f}, which Guyan puts {100 * one:+.1f} % "
            f"off, the second {100 * two:+.0f} %"
        )

    return Finding(
        "guyan_in_frequency",
        "Guyan condensation over frequency",
        "Static condensation holds the rest of the shaft to its static shape, and knows "
        "nothing of the pole at the first mode with the lumped point held.",
        "In fractions of that fixed-interface frequency, 1 % and 10 % of the static "
        f"stiffness are passed as follows. {'. '.join(told(name) for name in SCENES)}.",
        "`solidgear compare` reports of every lumped model to which frequency its "
        "receptance stays within 5 % (`valid_to_hz`). `solidgear check` cautions where "
        "the range asked for passes 0.39 of the fixed-interface frequency.",
        "tests/test_check_guards.py::test_guard[lumped to 5 kHz]",
        rows,
    )


def draw(finding: Finding, axes) -> None:
    """Distances over frequency, by scene."""
    for name, line in zip(SCENES, ("-", "--")):
        rows = [r for r in finding.rows if r["scene"] == name]
        for model, colour in zip(MODELS, ("#c4541c", "#e0a030", "#0072b2")):
            words = f"{model}, {name}"
            curve(axes, rows, "w / w_fixed", model, line, colour, words, least=1e-6)
    for level in LEVELS:
        axes.axhline(level, color="#aa2222", lw=0.8, ls=":")
    axes.axvline(1.0, color="#888888", lw=0.8)
    axes.set_xticks(ticks := [0.03, 0.1, 0.3, 1, 2], [f"{t:g}" for t in ticks])
    axes.minorticks_off()
    axes.set(
        xlabel="frequency over first fixed-interface frequency",
        ylabel="error over static stiffness",
        title=finding.method,
        ylim=(1e-5, 1e3),
    )
    axes.legend(fontsize=7)
