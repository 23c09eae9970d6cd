"""A race: lanes in turns, answers compared, rows kept as they come, and what is said at the end."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from validation.peers.lanes import Figure, Lane
from validation.peers.process import PeerError


@dataclass
class Race:
    """Lanes and what was found on the way.

    Attributes
    ----------
    folder : Path
        Of the results.
    quick : bool
    limit : float
        Seconds a peer may take.
    threads : int
        Of CalculiX; 0 until they are chosen.
    """

    folder: Path
    quick: bool
    limit: float
    threads: int = 0
    lanes: list[Lane] = field(default_factory=list)
    figures: list[Figure] = field(default_factory=list)
    checks: dict[str, dict] = field(default_factory=dict)
    skipped: list[str] = field(default_factory=list)
    versions: dict[str, str] = field(default_factory=dict)

    def add(self, lane: Lane) -> Lane:
        """Enter a lane."""
        self.lanes.append(lane)
        return lane

    def say(self, text: str) -> None:
        """A line for whoever watches."""
        print(text, flush=True)

    def skip(self, text: str) -> None:
        """Note what is not raced, and say so."""
        self.skipped.append(text)
        self.say(f"not raced: {text}")

    def check(self, what: str, gap: float, allowed: float, why: str) -> None:
        """Note a comparison of answers.

        Raises
        ------
        PeerError
            If they differ by more than allowed: then times mean nothing.
        """
        good = bool(gap <= allowed)
        self.checks[what] = {
            "answers compared": what,
            "largest difference": gap,
            "allowed": allowed,
            "agree": "yes" if good else "NO",
            "because": why,
        }
        if not good:
            raise PeerError(f"{what} differ from ours by {gap:.1e}, allowed is {allowed:g}")

    def run(self, rounds: int) -> None:
        """Every lane once a round."""
        from validation.common import write_rows

        for k in range(rounds):
            for lane in self.lanes:
                lane.run()
                if lane.samples or lane.error:
                    self.say(
                        f"round {k + 1}: {lane.heat}, {lane.who}: "
                        + (lane.error or f"{lane.times()[-1]:.3g} s")
                    )
                write_rows(
                    self.folder / "rows.csv", [x.row() for x in self.lanes if x.samples or x.error]
                )

    def finish(self, machine: dict, show, write_rows) -> None:
        """Tables, chart and sentences."""
        rows = [x.row() for x in self.lanes if x.samples or x.error]
        ratios = [f.row() for f in self.figures]
        for row in ratios:
            if self.quick and row["measured"] is not None:
                row["met"] = "quick run"
        self.say("\n".join(f"{k}: {v}" for k, v in machine.items()))
        narrow = ("heat", "lane", "unknowns", "median s", "min s", "max s", "runs", "cpu s", "note")
        for name, table in (
            ("answers", list(self.checks.values())),
            ("rows", rows),
            ("ratios", ratios),
        ):
            if table:
                show(
                    name,
                    [
                        {k: v for k, v in row.items() if name != "rows" or k in narrow}
                        for row in table
                    ],
                )
                write_rows(self.folder / f"{name}.csv", table)
        text = self.sentences(ratios, machine)
        self.say("\n" + text)
        (self.folder / "summary.txt").write_text(text + "\n")
        if any(x.samples for x in self.lanes):
            chart(
                [x for x in self.lanes if x.samples],
                self.folder / "seconds.png",
                machine,
                self.quick,
            )

    def sentences(self, ratios: list[dict], machine: dict) -> str:
        """What a reader should take home."""
        out = [
            f"Measured in one interleaved run on {machine.get('cpu')}, {machine.get('cores')} "
            f"cores, {machine.get('date')}."
        ]
        if self.quick:
            out.append("This was a quick run on small meshes: its ratios say nothing about speed.")
        for check in self.checks.values():
            out.append(
                f"{check['answers compared']}: {check['largest difference']:.1e} from ours, allowed "
                f"{check['allowed']:g} ({check['because']})."
            )
        for figure, row in zip(self.figures, ratios):
            if row["measured"] is None:
                out.append(f"{row['ratio']}: {row['met']}.")
                continue
            asked = (
                ""
                if row["asked"] is None or self.quick
                else f"; asked {row['asked']:g}: {'met' if row['met'] == 'yes' else 'missed'}"
            )
            out.append(
                f"{row['ratio']}: {row['measured']:.3g} times, {row['over rounds']} over the rounds{asked}."
            )
            if row["met"] == "NO":
                out += [
                    f"  why: {lane.who} spends {profile(lane)}."
                    for lane in (figure.fast, figure.fastest())
                ]
        out += [f"Not raced: {text}." for text in self.skipped]
        out.append(
            "CalculiX is timed as a whole process with its deck given; ours within a running "
            "Python, as a workbench is used, where imports are "
            "paid once a session.  The rows called whole process add imports, scene, mesh and assembly."
        )
        return "\n".join(out)


def profile(lane: Lane) -> str:
    """Stage seconds of the median run of a lane."""
    middle = sorted(lane.samples, key=lambda s: s.seconds(lane.counted))[len(lane.samples) // 2]
    return ", ".join(f"{v:.3g} s in {k}" for k, v in middle.stages.items() if v)


def chart(lanes: list[Lane], path: Path, machine: dict, quick: bool) -> None:
    """Median seconds as bars on a log axis, whiskers from the fastest to the slowest run."""
    import statistics

    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    colour = {heat: f"C{k}" for k, heat in enumerate(dict.fromkeys(x.heat for x in lanes))}
    figure, axes = plt.subplots(figsize=(11, 1.2 + 0.36 * len(lanes)), layout="constrained")
    for k, lane in enumerate(lanes):
        times = lane.times()
        middle = statistics.median(times)
        ours = "solidgear" in lane.who
        axes.barh(
            k,
            middle,
            color=colour[lane.heat],
            alpha=1.0 if ours else 0.45,
            xerr=[[middle - min(times)], [max(times) - middle]],
            capsize=3,
        )
        axes.annotate(
            f"{middle:.3g} s",
            (max(times), k),
            (6, 0),
            textcoords="offset points",
            va="center",
            fontsize=8,
        )
    axes.set_yticks(range(len(lanes)), [f"{x.heat}: {x.who}" for x in lanes], fontsize=8)
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.margins(x=0.15)
    axes.grid(axis="x", alpha=0.3)
    axes.set_xlabel(
        f"wall seconds, median of {len(lanes[0].samples)} interleaved runs, fastest to slowest"
        + (" (quick run)" if quick else "")
    )
    axes.set_title(
        f"Full bars solidgear, pale bars peers; {machine.get('cpu')}, {machine.get('cores')} cores",
        fontsize=9,
    )
    figure.savefig(path, dpi=130)
    plt.close(figure)
