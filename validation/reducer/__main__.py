"""The reducer's page and its charts: ``python -m validation.reducer`` (ten minutes).

``--stored`` takes motions in time from ``validation/results``, as they were written last.
"""

from __future__ import annotations

import sys
from dataclasses import asdict

import numpy as np

from solidgear.show.panel import INK, Panel, Series
from solidgear.show.plot import Chart
from solidgear.show.scales import Axis
from validation.common import ROOT, kept, markdown, read_result, stamp
from validation.reducer import claims, spectra
from validation.reducer.checks import checked
from validation.reducer.design import Design
from validation.reducer.dynamics import RUNOUT, Seen, campaign
from validation.reducer.multibody import HALF_GAP, LOSS, Reducer
from validation.reducer.study import (
    CHOICES,
    MOST,
    RANGES,
    SEED,
    SETS,
    Outcome,
    drawn,
    outcomes,
    speeds,
)

PAGE = ROOT / "docs" / "validation" / "reducer.md"
FIGURES = ROOT / "validation" / "figures"
RESULTS = f"reducer_seed_{SEED}"
#: significant digits that are kept
DIGITS = 6
#: relative, of a modulation that a bearing does not change
UNMOVED = 1e-9
BEARINGS = {"two bearings": Series("#c2185b"), "three bearings": Series("#0072b2")}
MODELS = {"rigid": "rigid, on springs", "timoshenko": "beam", "harmonic": "harmonic solid"}

TEXT = """\
# A reducer whose bearings give way

The source (Applied Sciences 15, 2025, 9035): a bevel pair, its wheel on one shaft with the sun, held \
by two angular contact bearings; three planets, fixed ring. **Torque, sizes and most bearings are \
assumed**: {count} designs of seed {seed}. Pairs are {pairs}, the third bearing {thirds} with \
{clearance} µm of clearance; all ranges stand in `validation/reducer/study.py`. The pair is between \
wheel and sun, or both overhang. Written by `python -m validation.reducer`, numbers in time into \
`validation/results/{results}.json`.

{claims}

![Mesh forces over a turn of the carrier, on two and on three bearings](written/reducer.png)

## Does one more bearing pay?

Every mesh force varies at the carrier's frequency by

$$
k_e s, \\qquad s = \\frac{{e}}{{1 + N k_e c / 2}},
$$

and with a third bearing by

$$
k_e (s - c_{{s3}} F), \\qquad F = \\frac{{u - g}}{{c_{{33}} + 1 / q}} .
$$

- $k_e$: stiffness through one of $N$ planets; $e$, $c$: shift of the sun under the bevel force and its \
flexibility, without planets.
- With planets, on two bearings: $u$ motion at the third place, $c_{{33}}$, $c_{{s3}}$ flexibilities \
there and to the sun; $g$ clearance, $q$ stiffness of the third bearing.

**Clearance decides**: with $g < u / 2$ the modulation is halved in {near} designs, with more in {far}, \
and in {nothing} it is never taken up. The formula errs by at most {errs} % of the modulation in nine of ten, and gives {same} \
verdicts on claim 5 as the shaft on its bearings does.

The chart's design on two bearings, linear about its load, where the settled shaft has {settled} N:

{models}

## In time

The same designs as rigid bodies: teeth with the source's impact law, whose pairs come and go, bearings \
6x6 at their load or ideal joints, three turns of the carrier at 8000 r/min. Assumed beyond the above: \
{gap} µm of backlash, a loss factor of {loss} of bearings and pins, sizes of the input shaft.

- Checks: another integrator has the same envelope within {envelope} %; sidebands by harmonic balance \
with two base frequencies agree within {sidebands} % of the main line; of the energy that contacts pass \
back and forth {energy} % is lost sight of.
- While no teeth part ({held} of {count}), the modulation is the closed form less {less} to {more} % in \
nine of ten: it is quasi-static.
- **515 N inside and 540 N outside cannot be decided**: no torque is given. Drawn designs on three bearings \
reach {lowest} to {highest} N; 540 N would take {needed_low} to {needed_high} N m at the pinion. Outside \
over inside they have {ratio_low} to {ratio_high}, the source {source_ratio}.
- The source's damping of 1 % of K is a number in N, mm and s here; the same number in N, m and s would be \
32 times as much. Already so the damper of a mesh with the sun resists {times} times as much as its spring \
at the mesh frequency.

## Orders

![Waterfall of the force on the housing with measured lines, and lines by orders](written/reducer_spectra.png)

{lines}

Shaft lines at 8000 r/min are 3 % high while mesh lines are within 0.7 %: no one speed gives both. 876 Hz \
is no order of the reducer, and the source gives it no cause. With the other teeth the planets' lines are 1.8 and 0.2 % low. \
The line at order 0.3 is three planets passing. The runout is assumed, {runout} µm.

## Teeth

{teeth}

No teeth give the quoted 1120 Hz at 8000 and 850 Hz at 6000 r/min. The measured 2008 Hz is beyond half \
the sampling rate of 4000 Hz.
"""


def main() -> None:
    """Solve, draw, write."""
    designs = drawn()
    found, refused = outcomes(designs, lambda done: _say(str(done)))
    in_time, checks = stored() if "--stored" in sys.argv[1:] else moved(designs)
    print(file=sys.stderr)
    for sentence in refused:
        print(sentence)
    chart().write(FIGURES / "reducer.png")
    spectra.chart().write(FIGURES / "reducer_spectra.png")
    PAGE.write_text(page(found, in_time, checks), encoding="utf-8")
    print(PAGE.relative_to(ROOT))


def _say(done: str) -> None:
    print(f"\r{done}   ", end="", file=sys.stderr)


def moved(designs: list[Design]) -> tuple[dict[str, Seen], dict[str, float]]:
    """Motions in time and their checks, kept."""
    found = campaign(designs, lambda name, done: _say(f"{name}: {100 * done:.0f} %"))
    checks = checked(found)
    told = {
        name: {key: _short(value) for key, value in asdict(one).items()}
        for name, one in found.items()
    }
    kept(RESULTS, {**told, "checks": checks, "made": stamp()})
    return stored()


def stored() -> tuple[dict[str, Seen], dict[str, float]]:
    """The same as they were kept."""
    told = read_result(RESULTS)
    told.pop("made")
    checks = told.pop("checks")
    found = {
        name: Seen(**{key: np.array(value) for key, value in one.items()})
        for name, one in told.items()
    }
    return found, checks


def _short(values: np.ndarray) -> list:
    """Numbers with the digits that are kept."""
    if values.ndim > 1:
        return [_short(one) for one in values]
    return [float(f"{float(value):.{DIGITS}g}") for value in values]


def page(found: list[Outcome], in_time: dict[str, Seen], checks: dict[str, float]) -> str:
    """The page of outcomes."""
    two, three, told = (
        np.array([getattr(o, name) for o in found]) for name in ("two", "three", "foretold")
    )
    near = np.array([o.reached < 0.5 for o in found])
    halved = three < MOST * two
    same = halved == (told < MOST * two)
    low, high, held = claims.departure(in_time["two"])
    torques = np.array([o.design.torque for o in found])
    return TEXT.format(
        count=len(found),
        seed=SEED,
        results=RESULTS,
        pairs=" to ".join(CHOICES["pair"][:: len(CHOICES["pair"]) - 1]),
        thirds=" to ".join(CHOICES["third"][:: len(CHOICES["third"]) - 1]),
        clearance=" to ".join(f"{1e6 * end:g}" for end in RANGES["clearance"]),
        claims="\n".join(claims.table(found, in_time)),
        nothing=int((abs(three - two) < UNMOVED * two).sum()),
        near=claims.share(halved[near]),
        far=claims.share(halved[~near]),
        errs=f"{100 * np.quantile(abs(told - three) / two, 0.9):.0f}",
        same=claims.share(same),
        settled=f"{Design().modulation(False):.1f}",
        models="\n".join(models()),
        gap=f"{2e6 * HALF_GAP:.0f}",
        loss=f"{LOSS:g}",
        **{name: f"{100 * checks[name]:.1g}" for name in ("envelope", "sidebands", "energy")},
        held=held,
        less=high.lstrip("−"),
        more=low.lstrip("−"),
        **claims.source_forces(in_time["three"], torques),
        times=f"{damper_over_spring():.0f}",
        runout=f"{1e6 * RUNOUT:.0f}",
        lines="\n".join(lines()),
        teeth="\n".join(teeth()),
    )


def damper_over_spring() -> float:
    """Of a mesh with the sun under its mean force, at the mesh frequency."""
    own = Reducer(Design())
    law, force = own.laws[1], own.design.mean_force / own.ratios[1]
    mesh = own.orders["planetary"] * own.speed
    return law.damping(force) * mesh / law.stiffness(force)


def lines() -> list[str]:
    """Table of measured lines."""
    rows = [
        (
            line.rpm,
            line.hertz,
            f"{line.order:.2f}",
            line.name,
            "" if line.name in ("bench", "none") else f"{100 * line.off:+.1f} %".replace("-", "−"),
        )
        for line in spectra.measured(Design())
    ]
    return markdown(("r/min", "measured Hz", "order", "of", "off"), rows)


def models() -> list[str]:
    """Table of one cantilever by three models, its closed form beside the whole turn."""
    rows = []
    for model, words in MODELS.items():
        design = Design()
        shift, give = design.flexibility(False, model)
        turn = design.turn(shift, give)
        rows.append(
            (
                words,
                f"{1e6 * np.linalg.norm(shift):.3f}",
                f"{2 / np.trace(give) / 1e6:.3f}",
                f"{design.closed_form(shift, give):.3f}",
                f"{turn.amplitude(1)[0]:.3f}",
            )
        )
    return markdown(("shaft", "e, µm", "1 / c, N/µm", "closed form, N", "turn, N"), rows)


def teeth() -> list[str]:
    """Table of both tooth sets."""
    rows = []
    for one in SETS:
        fast, slow = speeds(one, 8000), speeds(one, 6000)
        rows.append(
            (
                ", ".join(map(str, one)),
                f"{fast['bevel mesh']:.0f} / {fast['planetary mesh']:.0f} Hz",
                f"{slow['bevel mesh']:.0f} / {slow['planetary mesh']:.0f} Hz",
                f"{fast['carrier']:.2f} Hz",
            )
        )
    return markdown(("z1 to z5", "meshes at 8000 r/min", "at 6000", "carrier at 8000"), rows)


def chart() -> Chart:
    """Mesh forces of all planets over a turn of the carrier."""
    design = Design()
    turns = {name: design.settled_turn(third) for name, third in zip(BEARINGS, (False, True))}
    highest = max(turn.sun_mesh.max() for turn in turns.values())
    lowest = min(turn.sun_mesh.min() for turn in turns.values())
    room = 0.15 * (highest - lowest)
    panel = Panel(
        Axis("angle of the carrier, degrees", (0.0, 360.0)),
        Axis("force of each planet on the sun, N", (lowest - room, highest + room)),
        260.0,
        series=BEARINGS,
        legend={"orient": "top"},
    )
    panel.draw({"type": "rule", "color": INK, "strokeDash": [5, 3]}, [{"y": design.mean_force}])
    for name, turn in turns.items():
        angle = np.degrees([*turn.angle, 2 * np.pi])
        for force in turn.sun_mesh.T:
            places = zip(angle, [*force, force[0]])
            rows = [{"x": float(x), "y": float(y), "name": name} for x, y in places]
            panel.draw({"type": "line", "strokeWidth": 1.6}, rows)
    return Chart([[panel]], width=800.0, title="Each planet once a turn; dashed: ideal bearings")


if __name__ == "__main__":
    main()
