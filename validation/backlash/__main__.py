"""The page of backlash and its chart: ``python -m validation.backlash [gears pairs models ...]``.

What is named is run anew and kept in ``validation/results/backlash.json``; the page is written from
there.  ROSS and pyHarm are looked for in this Python and in those that `PEERS` names.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterable
from typing import Any

from solidgear.show.panel import GREY, Panel, Series
from solidgear.show.plot import Chart
from solidgear.show.scales import Axis
from solidgear.show.words import capital
from validation.backlash import axle, gears, pairs
from validation.common import ROOT, kept, markdown, read_result, stamp
from validation.race.installed import missing

PAGE = ROOT / "docs" / "validation" / "backlash.md"
PICTURE = ROOT / "validation" / "figures" / "backlash.png"
TITLES = {
    "axle_overhung": "overhung axle",
    "axle_thesis": "axle with the thesis's pinion",
    "axle_straddle": "straddled axle",
}
SAID, TRUE = "linear force above the mean", "teeth part"
LOOKS = {SAID: Series(GREY), TRUE: Series("#0072b2")}
#: program that a study needs
NEEDED = {"gears": "ROSS", "pairs": "pyHarm"}
#: pinion's teeth
TEETH = 14
#: axles and mean forces at which branches apart are told, N
APART = (
    ("axle_overhung", 5000.0),
    ("axle_overhung", 5500.0),
    ("axle_thesis", 5000.0),
    ("axle_straddle", 5000.0),
)

TEXT = """\
# Teeth with backlash against others

Written by `python -m validation.backlash` from `validation/results/backlash.json`; `python -m \
validation.race backlash` compares times. Backlash on the axles is {backlash}, transmission error {error}.

## Two spur gears: ROSS

ROSS integrates the pair of its own tests in time (20 teeth, module 10 mm, 300 N m, half gap 50 µm). *As it \
stands*: 1000 r/min, stiffness two-valued, torque swinging once a turn; contact is kept in the end. \
*Parting*: constant stiffness, mesh damping ratio 0.07, a tenth of the transmission error, so that \
teeth part near the mesh's own frequency.

{gears}

With its separating force our harmonic balance agrees with ROSS in the swing within {swing} %, where \
ROSS's last two turns differ by up to {changing} %. That force is **twice what statics gives**: ROSS has the centre distance in the approach of the \
flanks and in the gap as well, so flanks under $F$ push the gears apart by $2 F \\sin\\alpha$. Its centre \
distance grows by {grown} µm, where $F \\sin\\alpha$ on both bearings makes {right}.

## One pair: pyHarm

$x'' + 2 \\zeta x' + f(x) = F_m + F_a w^2 \\cos w t$, $\\zeta$ 0.05, $F_m$ 0.1; pyHarm with 13 harmonics, \
4096 instants and steps of 0.002.

{pairs}

## The axle: which model is enough?

At 5 kN. *Parts*: where teeth part on the branch from low to high speed; contact: least share of a \
cycle. {flanks} *Enough*: jumps within 2 %, largest force within 3 dB of \
both harmonic.

{models}

{verdict}

## Branches that hang together with no other

Sweeps never meet them; a blow can. Starts at {speeds} speeds found these; there may be others.

{apart}

## Over torque: where the linear criterion fails

Teeth part where the linear force exceeds the mean; that is exact on the branch from low speed, \
and never a false alarm. But a motion that parts lives on at lower speeds:

![Ranges over mesh frequency and torque in which teeth part, and in which the linear force exceeds the mean](written/backlash.png)

{torque}

{fails}

## Times

Seconds of the processor; answers agree within 1e-3 (sweeps) and a step (pyHarm). Sweeps have as many \
motions as the branch has points, and place a jump to within a step of the speed.

{times}
"""


def main() -> None:
    """Run what is named, draw, write."""
    studies: dict[str, Callable[[], Any]] = {
        "gears": gears.rows,
        "pairs": pairs.rows,
        "models": lambda: {name: axle.models(name, _told) for name in axle.AXLES},
        "torque": lambda: {name: axle.over_torque(name, _told) for name in axle.AXLES},
        "apart": _apart,
    }
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("anew", nargs="*", choices=[*studies, []], help="run again")
    anew = parser.parse_args().anew
    if absent := missing(*(NEEDED[name] for name in anew if name in NEEDED)):
        parser.error(absent)
    for name in anew:
        kept("backlash", {name: {**stamp(), "rows": studies[name]()}})
    found = read_result("backlash")
    chart(found["torque"]["rows"]["axle_overhung"]).write(PICTURE)
    PAGE.write_text(page(found), encoding="utf-8")
    print(f"{PAGE.relative_to(ROOT)}, {PICTURE.relative_to(ROOT)}")


def _told(text: str) -> None:
    print(text, file=sys.stderr)


def _apart() -> list[dict[str, Any]]:
    some = [(name, m, f) for name, f in APART for m in ("harmonic", "lumped")]
    return [row for one in some for row in axle.apart(*one)]


def page(found: dict[str, Any]) -> str:
    """The page of what was found."""
    rows = {name: found[name]["rows"] for name in ("gears", "pairs", "models", "torque", "apart")}
    ross = [r for r in rows["gears"] if r["by"].startswith("ROSS")]
    off = [abs(r["swing"] / _beside(rows["gears"], r)["swing"] - 1) for r in ross]
    return TEXT.format(
        backlash=axle.BACKLASH.replace("um", "µm"),
        error=axle.ERROR.replace("um", "µm"),
        gears=_table(gears_rows(rows["gears"])),
        swing=f"{100 * max(off):.1f}",
        changing=f"{100 * max(r['still changing'] for r in ross):.1f}",
        grown=f"{1e6 * ross[0]['distance']:.1f}",
        right=f"{1e6 * ross[0]['distance'] / 2:.1f}",
        pairs=_table(pairs_rows(rows["pairs"])),
        models="\n\n".join(
            f"{capital(TITLES[name])}:\n\n{_table(models_rows(own))}"
            for name, own in rows["models"].items()
        ),
        flanks=flanks(rows["models"], rows["torque"]),
        verdict=verdict(rows["models"]),
        speeds=axle.SPEEDS,
        apart=_table(apart_rows(rows["apart"])),
        torque=_table(torque_rows(rows["torque"]["axle_overhung"])),
        fails=fails(rows["torque"]),
        times=_table(times_rows(found)),
    )


def _table(rows: Iterable[tuple]) -> str:
    head, *rest = rows
    return "\n".join(markdown(head, rest))


def _beside(rows: list[dict], ross: dict) -> dict:
    """Our harmonic balance with the separating force of ROSS at the speed of a row of ROSS."""
    return next(
        r
        for r in rows
        if r["by"] == "ours, 2 sin alpha, balance"
        and (r["case"], r["hz"]) == (ross["case"], ross["hz"])
    )


def gears_rows(rows: list[dict]) -> Iterable[tuple]:
    """Head and rows of two gears."""
    yield (
        "case",
        "mesh, Hz",
        "by",
        "mean stretch, µm",
        "swing, µm",
        "largest force, N",
        "in contact, %",
    )
    names = {"example": "as it stands", "parting": "parting"}
    for r in rows:
        if r["by"] == "ours, 1 sin alpha, time":
            continue
        yield (
            names[r["case"]],
            f"{r['hz']:.0f}",
            r["by"].replace("sin alpha", "sin α"),
            f"{1e6 * r['mean']:.3f}",
            f"{1e6 * r['swing']:.3f}",
            f"{r['most']:.0f}",
            f"{100 * r['touching']:.0f}",
        )


def pairs_rows(rows: list[dict]) -> Iterable[tuple]:
    """Head and rows of the single pair."""
    yield "$F_a$", "by", "turns at $w$", "rms of three motions"
    for r in rows:
        turns = ", ".join(f"{w:.5f}" for w in sorted(r["turning"]))
        rms = ", ".join(f"{x:.5f}" for x in r["rms"])
        yield f"{r['amplitude']:g}", r["by"], turns, f"{rms} at {r['at']:.4f}"


def models_rows(rows: list[dict]) -> Iterable[tuple]:
    """Head and rows of models of one axle."""
    yield (
        "shafts",
        "unknowns",
        "jumps up, down, Hz (r/min)",
        "parts, Hz",
        "contact, %",
        "largest, N at Hz",
        "apart",
        "linear",
        "enough",
    )
    for r in rows:
        ways = {True: "↑", False: "↓"}
        jumps = (f"{ways[up]} {hz:.1f} ({60 * hz / TEETH:.0f})" for hz, up in r["jumps"])
        yield (
            r["by"],
            r["unknowns"],
            ", ".join(jumps),
            _ranges(r["parts"]),
            f"{100 * r['least contact']:.0f}",
            f"{r['largest'][1]:.0f} at {r['largest'][0]:.0f}",
            ", ".join(f"{size:.0f} at {hz:.0f}" for _, hz, size in r["apart"]),
            f"{r['linear'][1]:.0f} at {r['linear'][0]:.0f}",
            {None: "", True: "yes", False: "no"}[r["enough"]],
        )


def _ranges(parts: list) -> str:
    return ", ".join(f"{low:.0f} to {high:.0f}" for low, high in parts)


def verdict(models: dict[str, list[dict]]) -> str:
    """A sentence an axle."""
    lines = []
    for name, rows in models.items():
        judge = rows[0]
        words = []
        for good, says in ((True, "enough"), (False, "not")):
            who = ", ".join(r["by"].removeprefix("both ") for r in rows[1:] if r["enough"] is good)
            words += [f"{says}: {who}"] if who else []
        lumped = next(r for r in rows if r["by"] == "both lumped")
        off = [
            abs(a[0] / b[0] - 1) for a, b in zip(sorted(lumped["jumps"]), sorted(judge["jumps"]))
        ]
        contact = 100 * abs(lumped["least contact"] - judge["least contact"])
        lines.append(
            f"- **{capital(TITLES[name])}**: {'; '.join(words)}. The lumped shafts of "
            f"14 unknowns put jumps {100 * max(off):.1f} % off at most, and contact {contact:.0f} points "
            "of the cycle."
        )
    return "\n".join(lines)


def flanks(*studies: dict[str, list[dict]]) -> str:
    """A sentence on two-sided contact, at any model and torque."""
    hit = [r for s in studies for rows in s.values() for r in rows if r.get("other flank")]
    if not hit:
        return "Contact is one-sided: at no torque below does the other flank touch."
    least = max(r.get("force", axle.FORCE) for r in hit)
    return f"Up to a mean force of {least:.0f} N the other flank touches as well."


def apart_rows(rows: list[dict]) -> Iterable[tuple]:
    """Head and rows of branches apart."""
    yield (
        "axle",
        "both shafts",
        "mean, N",
        "mesh periods",
        "lives, Hz",
        "stable, Hz",
        "largest, N at Hz",
        "in time, N",
    )
    for r in rows:
        stable = r["stable"] is not None
        yield (
            TITLES[r["axle"]],
            r["by"],
            f"{r['force']:.0f}",
            r["periods"],
            _ranges([r["lives"]]),
            "{:.1f} to {:.1f}".format(*r["stable"]) if stable else "nowhere",
            f"{r['largest'][1]:.0f} at {r['largest'][0]:.1f}" if stable else "",
            f"{r['in time'][1]:.0f}" if stable else "",
        )


def torque_rows(rows: list[dict]) -> Iterable[tuple]:
    """Head and rows of the solid axle over torque."""
    yield (
        "torque, N m",
        "mean, N",
        "linear force above it, Hz",
        "teeth part, Hz",
        "missed, Hz",
        "jumps, Hz",
        "largest, N",
        "linear, N",
    )
    ways = {True: "↑", False: "↓"}
    for r in rows:
        if r["by"] != "harmonic":
            continue
        yield (
            f"{r['torque']:.0f}",
            f"{r['force']:.0f}",
            _ranges(r["said"]),
            _ranges(r["parts"]),
            f"{r['only true']:.0f}",
            ", ".join(f"{ways[up]} {hz:.1f}" for hz, up in r["jumps"]),
            f"{r['largest'][1]:.0f}",
            f"{r['linear'][1]:.0f}",
        )


def fails(torque: dict[str, list[dict]]) -> str:
    """Where the criterion fails, a sentence an axle."""
    lines = []
    for name, every in torque.items():
        rows = [r for r in every if r["by"] == "harmonic" and "error" not in r]
        worst = max(rows, key=lambda r: r["only true"])
        calm = [r for r in rows if not r["jumps"]]
        over = max(rows, key=lambda r: r["linear"][1] / r["largest"][1])
        says = (
            f"- **{capital(TITLES[name])}**: at {worst['torque']:.0f} N m it misses "
            f"{worst['only true']:.0f} Hz of speeds at which teeth can part"
        )
        if calm:
            says += f"; from {calm[0]['torque']:.0f} N m on teeth part and no motion jumps"
        lines.append(
            f"{says}. At {over['torque']:.0f} N m the linear force is "
            f"{over['linear'][1] / over['largest'][1]:.1f} times the true one."
        )
    return "\n".join(lines)


def times_rows(found: dict[str, Any]) -> Iterable[tuple]:
    """Head and rows of the race."""
    yield "what", "lane", "seconds", "asked", "points or motions"
    names = {"pair": "single pair", "axle": "axle, both lumped", "solid": "axle, both solid"}
    for key, name in names.items():
        for lane in found.get(key, {}).get("lanes", []):
            count = lane.get("points", lane.get("motions"))
            yield (
                name,
                lane["lane"],
                f"{lane['median s']:.3g}" if "median s" in lane else lane["error"],
                f"{lane['asked s']:g}" if "asked s" in lane else "",
                "" if count is None else f"{count:.0f}",
            )
        for ratio in found.get(key, {}).get("ratios", []):
            measured = "" if ratio["measured"] is None else f"{ratio['measured']:.0f} times"
            asked = "" if ratio["asked"] is None else f"{ratio['asked']:.0f}"
            yield name, f"**{ratio['ratio']}**", measured, asked, ""


def chart(rows: list[dict]) -> Chart:
    """Ranges of the solid axle over frequency and torque, with its jumps."""
    rows = [r for r in rows if r["by"] == "harmonic" and "error" not in r]
    panel = Panel(
        Axis("mesh frequency, Hz", (axle.LOWEST, 1200.0)),
        Axis("torque on the pinion, N m", (0.0, 1.05 * rows[-1]["torque"])),
        300.0,
        "Triangles: jumps as the speed rises (up) and falls (down)",
        series=LOOKS,
        legend={"orient": "top"},
    )
    for name, key, width in ((SAID, "said", 9.0), (TRUE, "parts", 2.5)):
        parts = [(r["torque"], *part) for r in rows for part in r[key]]
        for k, (torque, low, high) in enumerate(parts):
            ends = [{"x": x, "y": torque, "name": name, "detail": k} for x in (low, high)]
            panel.draw({"type": "line", "strokeWidth": width, "clip": True}, ends)
    for rising, shape in ((True, "triangle-up"), (False, "triangle-down")):
        at = [{"x": hz, "y": r["torque"]} for r in rows for hz, up in r["jumps"] if up is rising]
        panel.draw({"type": "point", "shape": shape, "filled": True, "color": "#222222"}, at)
    return Chart([[panel]], width=800.0, title="Where teeth part, both shafts solid")


if __name__ == "__main__":
    main()
