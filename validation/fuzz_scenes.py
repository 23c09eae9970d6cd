"""Fuzz of the scene loader: shipped scenes, spoilt at random, must be refused in one sentence or solved to finite numbers.

    python validation/fuzz_scenes.py [--cases 10000] [--seed 1]

A *finding* is anything else: an exception that is not raised on purpose (a user would see a traceback), a warning, a number that is not
finite, a message of more than one line or without the file's name, more than two seconds of processor time, or a command that leaves
something behind. Every case follows from the seed and its number alone, so that a finding can be made again.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import random
import re
import resource
import signal
import sys
import tempfile
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from common import ROOT, results_folder, show, write_rows  # noqa: E402  (first of all: it pins BLAS to one thread)

import numpy as np  # noqa: E402

from solidgear.check import check_scene  # noqa: E402
from solidgear.errors import SolidgearError  # noqa: E402
from solidgear.fidelity import build  # noqa: E402
from solidgear.scene_file import load  # noqa: E402
from solidgear.solve.modes import modes  # noqa: E402
from solidgear.solve.statics import condense  # noqa: E402

LIMIT = 5.0  # s of processor time, check of a thin tube included: wall time would blame the program for a busy machine
STUCK = 60.0  # s of wall time, for what waits without computing
ROOM = 3 << 30  # bytes a case may add to the process

#: without comments, where a mutation would be wasted
SCENES = {path.stem: re.sub(rb"(?m)\s*#.*$", b"", path.read_bytes()).lstrip() for path in sorted((ROOT / "geometry").glob("*.toml"))}

# ------------------------------------------------------------------------------------------------- mutations
NUMBERS = (
    "0", "-1", "-0.0", "1", "nan", "inf", "-inf", "1e308", "-1e308", "1e-308", "5e-324", "1e150", "1e-150", "1e30", "1e-30", "1e-12", "1e400",
    "9" * 400, "9" * 5000, "0x10", "1_000", "true", "1979-05-27", "12:00:00", "[]", "{}", '""', '"mm"', "[1, 2]", "{a = 1}", "[[[[]]]]",
    "'''\n'''", '"nan mm"', '"inf N/m"', '"1e308 km"', '"1e-320 mm"', '"1e400 mm"', '"\\u0000"', '"\\U0001F600"', '"٣ mm"', '"1 mm mm"', '"1 m**9**9"',
)  # fmt: skip
UNITS = ("mm", "m", "km", "um", "inch", "deg", "rad", "GPa", "MPa", "psi", "kg/m^3", "g/cm^3", "N/m", "N/mm", "N/rad", "N*m/rad", "kHz", "rpm", "%", "K", "µm",
         "furlong", "m^0", "", "1/m")  # fmt: skip
LETTERS = "aezxky_. -\"'=[]{}#\\\n\té\u202e\u2028\u0000\U0001f600٣"
_NUMBER = re.compile(rb"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")
_VALUE = re.compile(rb"^([A-Za-z_]+)\s*=\s*([^#\n]*[^#\n\s])", re.M)


def _some(rng: random.Random, pattern: re.Pattern, text: bytes):
    found = list(pattern.finditer(text))
    return rng.choice(found) if found else None


def _put(text: bytes, match, group: int, new: str | bytes) -> bytes:
    new = new if isinstance(new, bytes) else new.encode("utf-8", "surrogatepass")
    return text[: match.start(group)] + new + text[match.end(group) :]


def _lines(change: Callable) -> Callable:
    def mutate(rng, text):
        lines = text.split(b"\n")
        change(rng, lines)
        return b"\n".join(lines)

    return mutate


def flip_bytes(rng, text):
    out = bytearray(text)
    for _ in range(rng.choice((1, 1, 2, 5, 20))):
        if out:
            out[rng.randrange(len(out))] = rng.randrange(256)
    return bytes(out)


def flip_a_bit(rng, text):
    out = bytearray(text)
    if out:
        out[rng.randrange(len(out))] ^= 1 << rng.randrange(7)
    return bytes(out)


def truncate(rng, text):
    return text[: rng.randrange(len(text) + 1)]


def cut_out(rng, text):
    start = rng.randrange(len(text) + 1)
    return text[:start] + text[start + rng.randrange(200) :]


def insert_letters(rng, text):
    at = rng.randrange(len(text) + 1)
    return text[:at] + "".join(rng.choices(LETTERS, k=rng.choice((1, 1, 3, 30)))).encode("utf-8", "surrogatepass") + text[at:]


@_lines
def delete_line(rng, lines):
    del lines[rng.randrange(len(lines))]


@_lines
def duplicate_line(rng, lines):
    lines.insert(rng.randrange(len(lines) + 1), rng.choice(lines))


@_lines
def swap_lines(rng, lines):
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[i], lines[j] = lines[j], lines[i]


def shuffle_tables(rng, text):
    parts = re.split(rb"(?m)^(?=\[\[?[a-z])", text)
    rng.shuffle(parts)
    return b"".join(parts)


def repeat_table(rng, text):
    parts = re.split(rb"(?m)^(?=\[\[)", text)
    part = rng.choice(parts)
    times = rng.choice((1, 1, 1, 2, 20))
    return text + b"\n" + b"\n".join(re.sub(rb'(?m)^name = "', b'name = "%d' % k, part) for k in range(times))


def wild_number(rng, text):
    match = _some(rng, _NUMBER, text)
    return _put(text, match, 0, rng.choice(NUMBERS)) if match else text


def wild_value(rng, text):
    match = _some(rng, _VALUE, text)
    return _put(text, match, 2, rng.choice(NUMBERS)) if match else text


def scale_number(rng, text):
    match = _some(rng, _NUMBER, text)
    if not match:
        return text
    factor = 10.0 ** rng.choice((rng.uniform(-0.3, 0.3), rng.uniform(-4, 4), rng.uniform(-30, 30), rng.uniform(-300, 300)))
    return _put(text, match, 0, repr(float(match[0]) * factor * rng.choice((1, 1, 1, -1))))


def nudge_number(rng, text):
    match = _some(rng, _NUMBER, text)
    return _put(text, match, 0, repr(float(match[0]) * (1 + rng.choice((1, -1)) * 10.0 ** rng.randint(-16, -3)))) if match else text


def other_unit(rng, text):
    match = _some(rng, re.compile(rb'"[-+.\deE]+ ([^"\n]+)"'), text)
    return _put(text, match, 1, rng.choice(UNITS)) if match else text


def misspell_key(rng, text):
    match = _some(rng, _VALUE, text)
    if not match:
        return text
    key = list(match[1].decode())
    at = rng.randrange(len(key))
    key[at] = rng.choice(("", key[at] * 2, key[at].upper(), rng.choice(LETTERS)))
    return _put(text, match, 1, "".join(key))


def swap_values(rng, text):
    one, two = sorted((_some(rng, _VALUE, text), _some(rng, _VALUE, text)), key=lambda m: m.start() if m else -1)
    return text if not one or one.start() == two.start() else _put(_put(text, two, 2, one[2]), one, 2, two[2])


def nest_table(rng, text):
    match = _some(rng, _VALUE, text)
    depth = rng.choice((1, 2, 50, 3000))
    opening, closing = rng.choice((("[", "]"), ("{a = ", "}")))
    return _put(text, match, 2, opening * depth + match[2].decode("utf-8", "replace") + closing * depth) if match else text


def huge_array(rng, text):
    match = _some(rng, _VALUE, text)
    n = rng.choice((6, 36, 100, 30_000))
    entry = rng.choice(("1", '"4.1e8 N/m"', "[1, 0, 0, 0, 0, 0]", "{kxx = 1}", "[]"))
    return _put(text, match, 2, "[" + ", ".join([entry] * n) + "]") if match else text


def spread_stiffness(rng, text):
    """A bearing of a random matrix, often of a rank below six, of entries that may be absurd."""
    match = _some(rng, re.compile(rb"(?s)(\[bearing\.stiffness\].*?)(?=\n\[|\Z)"), text)
    if not match:
        return text
    numbers = np.random.default_rng(rng.randrange(2**32))
    root = numbers.standard_normal((6, rng.randint(0, 6))) * 10.0 ** numbers.uniform(-2, 5, (6, 1)) * 10.0 ** rng.choice((0, 0, 0, -8, 8, -100, 100, -160, 150))
    with np.errstate(all="ignore"):
        rows = (root @ root.T).tolist()
    return _put(text, match, 1, f"matrix = {rows}".replace("Infinity", "inf"))


MUTATIONS = (flip_bytes, flip_a_bit, truncate, cut_out, insert_letters, delete_line, duplicate_line, swap_lines, shuffle_tables, repeat_table, misspell_key,
             swap_values, nest_table, huge_array, spread_stiffness, *(wild_number, wild_value, other_unit) * 2, *(scale_number, nudge_number) * 6)  # fmt: skip


def mutant(seed: int, number: int) -> tuple[str, tuple[str, ...], bytes]:
    """Scene spoilt, names of the mutations, and the file: case ``number`` of a run."""
    rng = random.Random(f"{seed}:{number}")
    name = rng.choice(tuple(SCENES))
    text, done = SCENES[name], []
    for _ in range(rng.choice((1, 1, 1, 2, 3, 6))):
        mutate = rng.choice(MUTATIONS)
        text = mutate(rng, text)
        done.append(mutate.__name__)
    return name, tuple(done), text


# ------------------------------------------------------------------------------------------------- one case
class Overrun(BaseException):
    """A case took too long; no handler of `Exception` may swallow it."""


@contextlib.contextmanager
def watched() -> Iterator[None]:
    """Time and memory limits on what runs inside, and warnings made errors."""

    def stop(*_):
        raise Overrun

    old = {number: signal.signal(number, stop) for number in (signal.SIGPROF, signal.SIGALRM)}
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    held = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize() if Path("/proc/self/statm").exists() else 0
    resource.setrlimit(resource.RLIMIT_AS, (held + ROOM if held else soft, hard))
    signal.setitimer(signal.ITIMER_PROF, LIMIT)
    signal.setitimer(signal.ITIMER_REAL, STUCK)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
        for number, handler in old.items():
            signal.signal(number, handler)


@dataclass(frozen=True)
class Outcome:
    """What became of one case: accepted, refused or a finding; how far it came; the sentence, or what was found; its sort, or a traceback."""

    kind: str
    stage: str
    sentence: str = ""
    detail: str = ""


def use(path: Path, harmonic: bool = False) -> Outcome:
    """Load a file and put the scene to use: 6x6 and modes of the Euler beam; on request the check and a light harmonic solid too."""
    stage = "load"
    try:
        with watched():
            scene = load(path)
            for fidelity, options in (("euler", {}), ("harmonic", {"order": 2, "layers": 1}))[: 1 + harmonic]:
                stage = fidelity
                body = build(scene, fidelity, **options)
                found = condense(body, scene, scene.port.name)
                values = modes(body, scene, n=scene.ask.modes).frequency_hz
                if not (np.isfinite(found.stiffness).all() and np.isfinite(values).all()):
                    return Outcome("finding", stage, "a result is not finite")
                json.dumps({"scene": scene.as_dict(), "check": check_scene(scene, body) if harmonic else None, "frequencies": values.tolist()}, allow_nan=False)
    except SolidgearError as error:
        return _judged(error, path, stage)
    except Overrun:
        return Outcome("finding", stage, f"more than {LIMIT:g} s of processor time")
    except Exception as error:
        return Outcome("finding", stage, f"{type(error).__name__}: {error}"[:300], traceback.format_exc())
    return Outcome("accepted", stage)


def _judged(error: SolidgearError, path: Path, stage: str) -> Outcome:
    """Whether a refusal is a sentence one can act on."""
    sentence = str(error)
    faults = {
        "is not one line": len(sentence.splitlines()) != 1,
        "does not name the file": stage == "load" and path.name not in sentence,
        "is not fit for a terminal": not sentence.isprintable() or len(sentence) > 1000,
        "speaks of the program's own parts": "pydantic" in sentence or "Value error" in sentence,
    }
    for fault, true in faults.items():
        if true:
            return Outcome("finding", stage, f"the message {fault}: {sentence!r}"[:400])
    return Outcome("refused", stage, sentence, re.sub(r'"[^"]*"|\([^)]*\)|[-+]?\d[\d.e+-]*', "_", getattr(error, "reason", sentence).split(";")[0])[:60])


def command(arguments: list[str], folder: Path) -> tuple[int, str, str, list[str]]:
    """Exit code, standard output and error of the command line run in this process, and the files it left in ``folder``."""
    from solidgear.cli import main

    out, err = io.StringIO(), io.StringIO()
    old, before = sys.argv, set(folder.rglob("*"))
    sys.argv = ["solidgear", *arguments]
    try:
        with watched(), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), contextlib.chdir(folder):
            main()
        code = 0
    except SystemExit as error:
        code = error.code or 0
    finally:
        sys.argv = old
    return code, out.getvalue(), err.getvalue(), sorted(str(p.relative_to(folder)) for p in set(folder.rglob("*")) - before)


def use_command(path: Path, expected: str) -> Outcome:
    """`stiffness --json` and, for what is refused, `compare --out`: exit code, one sentence or whole JSON, and nothing left behind."""
    runs = [["stiffness", path.name, "-f", "euler", "--json"]]
    if expected == "refused":
        runs.append(["compare", path.name, "--models", "euler", "--no-renders", "--out", "out"])
    for arguments in runs:
        stage = f"command {arguments[0]}"
        try:
            code, out, err, left = command(arguments, path.parent)
            if left:
                return Outcome("finding", stage, f"left behind: {', '.join(left)}")
            if code == 0:
                json.loads(out, parse_constant=lambda word: (_ for _ in ()).throw(ValueError(f"{word} in the JSON")))
            elif code != 1 or out or not err.startswith("solidgear: ") or len(err.splitlines()) != 1:
                return Outcome("finding", stage, f"exit code {code}, output {out[:60]!r}, error {err[:200]!r}")
            if (code == 0) != (expected == "accepted"):
                return Outcome("finding", stage, f"{expected} by the library, exit code {code}: {err[:200]!r}")
        except Overrun:
            return Outcome("finding", stage, f"more than {LIMIT:g} s of processor time")
        except Exception as error:
            return Outcome("finding", stage, f"{type(error).__name__}: {error}"[:300], traceback.format_exc())
    return Outcome(expected, stage)


def run(cases: int, seed: int, *, every_command: int = 20, every_harmonic: int = 20, progress: Callable[[str], None] | None = None) -> list[dict]:
    """Rows of a whole run, one a case; every so many-th also through the command line, or with the harmonic solid."""
    load(ROOT / "geometry" / "pinion_overhung.toml")  # the first text with a unit imports pint, which is not the case's fault
    rows = []
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "spoilt.toml"
        for number in range(cases):
            scene, mutations, text = mutant(seed, number)
            path.write_bytes(text)
            outcome = use(path, harmonic=number % every_harmonic == 0)
            if outcome.kind != "finding" and number % every_command == 0:
                told = use_command(path, outcome.kind)
                outcome = told if told.kind == "finding" else outcome
            rows.append({"case": number, "scene": scene, "mutations": " ".join(mutations), "outcome": outcome.kind, "stage": outcome.stage,
                         "sentence": outcome.sentence, "detail": outcome.detail})  # fmt: skip
            if progress and number % 1000 == 999:
                progress(f"{number + 1} cases, {sum(r['outcome'] == 'finding' for r in rows)} findings")
    return rows


def main() -> int:
    """Command line; the exit code is 1 if anything was found."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    rows = run(options.cases, options.seed, progress=lambda line: print(line, file=sys.stderr, flush=True))
    folder = results_folder("fuzz_scenes")
    write_rows(folder / "rows.csv", rows)
    kinds = Counter((r["outcome"], r["stage"], r["detail"] if r["outcome"] == "refused" else r["sentence"][:70]) for r in rows)
    table = [{"outcome": a, "stage": b, "sentence": c, "cases": n} for (a, b, c), n in sorted(kinds.items(), key=lambda item: (item[0][0], -item[1]))]
    show(f"{options.cases} cases, seed {options.seed}", table)
    total = Counter(r["outcome"] for r in rows)
    print(f"accepted {total['accepted']}, refused {total['refused']} in {sum(k[0] == 'refused' for k in kinds)} kinds of sentence, findings {total['finding']}")
    for row in (r for r in rows if r["outcome"] == "finding"):
        target = folder / f"finding_{options.seed}_{row['case']}.toml"
        target.write_bytes(mutant(options.seed, row["case"])[2])
        print(f"{target.relative_to(ROOT)}: {row['mutations']}: {row['sentence']}")
    return 1 if total["finding"] else 0


if __name__ == "__main__":
    sys.exit(main())
