"""A race: a question, the heats that answer it, and its result on file."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from validation.common import kept, read_result, show, stamp
from validation.race.heat import Heat
from validation.race.process import PeerError

Record = dict[str, Any]
#: what every lane has in its row
OF_ALL = ("lane", "median s", "min s", "max s", "runs", "cpu s", "asked s", "met", "note", "error")


@dataclass(frozen=True)
class Race:
    """A question.

    Attributes
    ----------
    question : str
    heats : dict of str to callable
        Each enters its lanes and the ratios that are asked for.
    rounds : int
    settings : dict of str to float
        What `--set` may change.
    resumes : bool
        Lanes that the result has already are not run again.
    read : callable, optional
        Shows more of the records of all heats, with the settings.
    needs : tuple of str
        Programs of :data:`validation.race.installed.PROGRAMS` that lanes are run by.
    """

    question: str
    heats: dict[str, Callable[[Heat], None]]
    rounds: int = 3
    settings: dict[str, float] = field(default_factory=dict)
    resumes: bool = False
    read: Callable[[dict[str, Record], dict[str, float]], None] | None = None
    needs: tuple[str, ...] = ()

    def run(
        self, name: str, heats: Collection[str], rounds: int, given: Heat, only: str = ""
    ) -> dict[str, Record]:
        """Run some heats, one after another; keep each in the result of a name as it goes on.

        Parameters
        ----------
        given : Heat
            Whose limits and settings all have.
        only : str
            In the names of the lanes that are run.
        """
        out = {}
        for key in heats:
            load = os.getloadavg()[0]
            heat = Heat(given.quick, given.limit, given.settings, given.against, given.scenes)
            old = read_result(name).get(key, {}).get("lanes", []) if self.resumes else []
            try:
                self.heats[key](heat)
            except PeerError as error:
                heat.skip(f"{key}: {error}")
            entered = [lane.who for lane in heat.lanes]
            done = {row["lane"] for row in old if not row["error"]}
            heat.lanes = [x for x in heat.lanes if only in x.who and x.who not in done]
            before = [row for row in old if row["lane"] in done]
            running = set(map(id, heat.lanes))
            heat.ratios = [x for x in heat.ratios if running & set(map(id, (x.fast, *x.slow)))]
            keep = partial(_keep, name, key, heat, before, entered, load)
            heat.run(rounds, keep)
            out[key] = keep()
        return out


def _keep(
    name: str, key: str, heat: Heat, before: list[Record], entered: list[str], load: float
) -> Record:
    """Keep the record of a heat, rows of an earlier run among those of this one, with the load of the
    machine before it began.
    """
    record = {**stamp(), "load before": load, **heat.record()}
    order = {who: k for k, who in enumerate(entered)}
    rows = [*before, *record["lanes"]]
    record["lanes"] = sorted(rows, key=lambda row: order.get(row["lane"], len(order)))
    kept(name, {key: record})
    return record


def told(name: str, key: str, record: Record) -> None:
    """Show the record of a heat."""
    machine = record["machine"]
    made = f"{record['date']}, {record['commit']}, {machine['cpu']}, {machine['cores']} cores"
    for what in ("answers", "lanes", "ratios"):
        if record[what]:
            show(f"{name}, {key}: {what} ({made})", [_narrow(row) for row in record[what]])
    for text in record["skipped"]:
        print(f"not raced: {text}")
    for program, version in record["versions"].items():
        print(f"{program} {version}")


def _narrow(row: Record) -> Record:
    """A row of a lane with its stages and facts in one cell; other rows as they are."""
    if "lane" not in row:
        return row
    more = {k: v for k, v in row.items() if k not in OF_ALL}
    said = (f"{k} {v:.4g}" if isinstance(v, float) else f"{k} {v}" for k, v in more.items())
    return {k: row.get(k) for k in OF_ALL} | {"stages and more": "; ".join(said)}


def missed(record: Record) -> bool:
    """Something that was asked for was not met, or a lane failed."""
    asked = [*record["lanes"], *record["ratios"]]
    return any(row.get("met") == "NO" for row in asked)
