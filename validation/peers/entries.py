"""Ways to enter a race: ours in this process or as a whole one, CalculiX as a whole one."""

from __future__ import annotations

from validation.peers import calculix, ours
from validation.peers.lanes import Lane, Sample
from validation.peers.process import PeerError, cores
from validation.peers.settings import SCENE


def mine(race, heat, who, scene, fidelity, options, *, free=False, **rest) -> Lane:
    """A lane of ours in this process: a fresh body each time."""

    def call():
        done = ours.solve(scene, fidelity, options, free=free)
        lane.unknowns = done.body.size
        return Sample(done.stages, done.cpu)

    lane = race.add(Lane(heat, who, call, **rest))
    return lane


def process(race, heat, who, attachment, fidelity, options, **rest) -> Lane:
    """A lane of ours as a whole process."""

    def call():
        return Sample(*ours.whole(SCENE, attachment, fidelity, options, limit=race.limit))

    return race.add(Lane(heat, who, call, **rest))


def ccx(race, heat, who, problem, kind, verify, *, loads) -> Lane:
    """A lane of CalculiX: whole process, deck given."""

    def call():
        a = calculix.solve(
            problem, kind, modes=10, loads=loads, limit=race.limit, threads=race.threads
        )
        race.versions["CalculiX"] = a.version
        if not lane.samples:
            verify(a)
        return Sample({"whole process": a.seconds}, a.cpu)

    lane = race.add(
        Lane(
            heat,
            who,
            call,
            3 * len(problem.nodes),
            note=f"{race.threads} thread{'s' * (race.threads > 1)}",
        )
    )
    return lane


def choose_threads(race, problem, kind) -> None:
    """The number of threads CalculiX is fastest with here: its solver waits by spinning, so more
    are not always better.
    """
    seconds = {}
    for threads in sorted({1, cores()}):
        try:
            seconds[threads] = calculix.solve(
                problem, kind, modes=10, limit=race.limit, threads=threads
            ).seconds
        except PeerError as error:
            race.say(f"CalculiX with {threads} threads: {error}")
    race.threads = min(seconds, key=seconds.get, default=1)
    race.say(
        "CalculiX, ten modes: "
        + ", ".join(f"{s:.1f} s with {t} thread{'s' * (t > 1)}" for t, s in seconds.items())
        + f"; raced with {race.threads}"
    )
