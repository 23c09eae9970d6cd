"""Tables of kept results for a page: what was raced, with what, and how many times one lane takes
another.
"""

from __future__ import annotations

from typing import Any

from validation.common import markdown, read_result
from validation.race.heat import ERROR

Record = dict[str, Any]
#: races whose ratios stand in one table, in order
RATIOS = ("assembly", "peers", "sweep", "commands")
#: heats of `commands` that stand there; others run beside another checkout
OURS = ("main",)
NOTHING = "Not run yet.\n"


def ratios() -> str:
    """Make the table of ratios of all races that are on file, a line for what each was run with."""
    rows, sources = [], []
    for race in RATIOS:
        for heat, record in heats(race).items():
            if race == "commands" and heat not in OURS:
                continue
            found = [row for row in record["ratios"] if row["measured"] is not None]
            rows += [[f"{race}, {heat}", row["ratio"], *_measured(row)] for row in found]
            if found:
                sources.append((f"{race}, {heat}", record))
    head = ["race", "what takes how many times as long", "ratio", "over rounds", "by processor s"]
    return table(head, rows, sources)


def lanes(race: str, heat: str) -> str:
    """Make the table of the lanes of one heat: unknowns, error, seconds."""
    record = heats(race).get(heat)
    if record is None:
        return NOTHING
    rows = [_lane(row) for row in record["lanes"]]
    head = ["lane", "unknowns", "error", "s, median", "least to most", "processor s"]
    return table(head, rows, [(f"{race}, {heat}", record)])


def sizes() -> str:
    """Make the table of tetrahedra of ever more unknowns beside PARDISO's own factor."""
    record = heats("solids").get("sizes")
    if record is None:
        return NOTHING
    head = ["unknowns", "s", "µs an unknown", "bytes an unknown", "PARDISO's factor, s"]
    head += ["times its factor", "times its memory"]
    keys = ["us an unknown", "bytes an unknown", "PARDISO's factor s"]
    keys += ["times its factor", "times its memory"]
    rows = [
        [f"{row['unknowns']:,.0f}", number(row["median s"]), *(number(row.get(k)) for k in keys)]
        for row in record["lanes"]
        if not row["error"]
    ]
    return table(head, rows, [("solids, sizes", record)])


def checkouts() -> str:
    """Make the table of whole commands by two checkouts in turn."""
    rows, sources = [], []
    for heat, record in heats("commands").items():
        if heat in OURS:
            continue
        by_name = {row["lane"]: row for row in record["lanes"] if not row["error"]}
        before = {name: by_name.get(f"{name}, other checkout") for name in by_name}
        pairs = [(by_name[name], old) for name, old in before.items() if old is not None]
        rows += [_pair(new, old) for new, old in pairs]
        if pairs:
            sources.append((f"commands, {heat}", record))
    head = ["command", "s before", "s", "processor s before", "processor s"]
    return table([*head, "MB before", "MB"], rows, sources)


def heats(race: str) -> dict[str, Record]:
    """Return the records of a race by heat; empty where none is on file."""
    return read_result(race)


def table(head: list[str], rows: list[list[str]], sources: list[tuple[str, Record]]) -> str:
    """Make a table, and below it what it was run with; a sentence where nothing is on file."""
    if not rows:
        return NOTHING
    left_out = [f"- not raced: {text}" for _, record in sources for text in record["skipped"]]
    return "\n".join([*markdown(head, rows), "", *map(source, sources), *left_out]) + "\n"


def source(named: tuple[str, Record]) -> str:
    """Return one item of a list on when, with what and on which machine a heat was run."""
    name, record = named
    machine = record["machine"]
    facts = [record["date"], f"commit {record['commit']}", machine["cpu"]]
    facts += [f"{machine['cores']} cores"]
    facts += [f"{machine['memory_gb']:g} GB"] if "memory_gb" in machine else []
    facts += [machine["system"]] if "system" in machine else []
    facts += [f"load {record['load before']:.1f} before"] if "load before" in record else []
    packages = {k: machine.get(k) for k in ("numpy", "scipy", "mkl")} | record["versions"]
    facts += [f"{program} {found}" for program, found in packages.items() if found]
    return f"- {name}: {', '.join(facts)}"


def number(value: float | None) -> str:
    """Return a number in three digits."""
    if value is None:
        return ""
    return f"{float(f'{value:.3g}'):,g}"


def _measured(row: Record) -> list[str]:
    return [
        number(row["measured"]),
        row.get("over rounds", ""),
        number(row.get("of processor seconds")),
    ]


def _lane(row: Record) -> list[str]:
    if row["error"]:
        return [row["lane"], "", "", row["error"], "", ""]
    unknowns = row.get("unknowns")
    error = row.get(ERROR)
    return [
        row["lane"],
        "" if unknowns is None else f"{unknowns:,.0f}",
        "" if error is None else f"{error:.1e}",
        number(row["median s"]),
        f"{number(row['min s'])} to {number(row['max s'])}",
        number(row["cpu s"]),
    ]


def _pair(new: Record, old: Record) -> list[str]:
    keys = ("median s", "cpu s", "peak_MB")
    return [new["lane"], *(number(row.get(key)) for key in keys for row in (old, new))]
