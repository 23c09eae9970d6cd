"""Bodies of a campaign through its judge, in processes of their own: resumable, and kept apart by
version of the product and by what was asked.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

import solidgear
from validation.campaign.case import Case, Run
from validation.campaign.rows import Found, found_of
from validation.campaign.worker import Worker

#: options that change nothing of what is found of a body
ASIDE = {"campaign", "seeds", "jobs", "seconds", "folder", "again"}
#: and those that choose bodies
CHOICE = {"words", "no_drawn", "no_random", "no_parts", "scenes", "solid", "parts", "sorts"}


def stamp() -> str:
    """A mark of the source of the product, so that results of another version are not taken for
    this one's.
    """
    told = hashlib.sha256()
    folder = Path(solidgear.__file__).parent
    for path in sorted(folder.rglob("*.py")):
        told.update(str(path.relative_to(folder)).encode() + path.read_bytes())
    return told.hexdigest()[:10]


def run(
    case: Case, given: argparse.Namespace, tell: Callable[[str], None] = print
) -> tuple[Found, bool]:
    """Judge all bodies of a campaign; after Ctrl-C what there is, and False."""
    bodies, kept = case.bodies(given), _Kept(case, given)
    done = {} if given.again else kept.read()
    left = [body for body in bodies if _name(body) not in done]
    crew = _Crew(given.seconds)
    pool = ThreadPoolExecutor(given.jobs)
    waiting = {pool.submit(_judged, case, given, crew, body, tell): body for body in left}
    try:
        for count, future in enumerate(as_completed(waiting), start=1):
            name = _name(waiting[future])
            done[name] = future.result()
            kept.write(name, done[name])
            tell(f"{count} of {len(left)}: {name}, {_told(done[name])}")
    except KeyboardInterrupt:
        tell("interrupted; what there is:")
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
        crew.close()
    out = Found()
    for body in bodies:
        out.add(done.get(_name(body), Found()))
    return out, all(_name(body) in done for body in bodies)


def _name(body: tuple) -> str:
    return " ".join(map(str, body))


def _told(found: Found) -> str:
    sure = sum(row.judged for row in found.rows)
    missed = sum(row.held is False for row in found.rows)
    words = f"{sure} of {len(found.rows)} judged, {missed} missed"
    wrong = [*found.failures, *found.problems]
    return "; ".join([words, *wrong])


def _judged(case: Case, given: argparse.Namespace, crew: _Crew, body: tuple, tell) -> Found:
    worker, problems = crew.mine(), []

    def note(text: str) -> None:
        problems.append(f"{_name(body)}, {text}")
        tell(problems[-1])

    try:
        found = case.judge(Run(given, given.folder, worker.call, note), *body)
    except Exception as error:  # one body is not the end of the others
        found = Found(problems=[f"{_name(body)}: {type(error).__name__}: {error}"])
    found.problems += problems
    return found


class _Crew:
    """A worker for every thread."""

    def __init__(self, seconds: float):
        self.seconds, self.own = seconds, threading.local()
        self.workers: list[Worker] = []

    def mine(self) -> Worker:
        """The worker of this thread."""
        if not hasattr(self.own, "worker"):
            self.own.worker = Worker(self.seconds)
            self.workers.append(self.own.worker)
        return self.own.worker

    def close(self) -> None:
        """End all, and let none begin again."""
        for worker in self.workers:
            worker.seconds = 0.0
            worker.close()


class _Kept:
    """File of what was found of bodies, a line of JSON each."""

    def __init__(self, case: Case, given: argparse.Namespace):
        asked = {k: v for k, v in sorted(vars(given).items()) if k not in ASIDE | CHOICE}
        mark = hashlib.sha256(json.dumps(asked, default=str).encode()).hexdigest()[:6]
        self.path = given.folder / case.name / f"{stamp()}-{mark}.jsonl"

    def read(self) -> dict[str, Found]:
        """The last of each body; without a line that was cut off."""
        out = {}
        for text in self.path.read_text().splitlines() if self.path.exists() else ():
            try:
                content = json.loads(text)
            except json.JSONDecodeError:
                continue
            out[content["body"]] = found_of(content["found"])
        return out

    def write(self, name: str, found: Found) -> None:
        """Add a body."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with self.path.open("a") as file:
            file.write(json.dumps({"body": name, "found": found.as_dict()}) + "\n")


def timed(tell: Callable[[str], None]) -> Callable[[str], None]:
    """The same, with the seconds since now before each line."""
    start = time.monotonic()
    return lambda text: tell(f"{time.monotonic() - start:7.0f} s  {text}")
