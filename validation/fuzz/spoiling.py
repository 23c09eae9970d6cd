"""Ways to spoil a scene file by dice."""

from __future__ import annotations

import functools
import random
import re
from collections.abc import Callable

import numpy as np

from validation.shipped import shipped_shafts

#: without comments, where a mutation would be wasted
SCENES = {
    path.stem: re.sub(rb"(?m)\s*#.*$", b"", path.read_bytes()).lstrip()
    for path in shipped_shafts()
    # parts from files are spoilt with their files, by `parts`
    if b"[body]" not in path.read_bytes()
}

NUMBERS = (
    *"0 -1 -0.0 1 nan inf -inf 1e308 -1e308 1e-308 5e-324 1e150 1e-150 1e30 1e-30 1e-12".split(),
    *"1e400 0x10 1_000 true 1979-05-27 12:00:00 [] {} [[[[]]]]".split(),
    *("9" * 400, "9" * 5000, "[1, 2]", "{a = 1}", "'''\n'''", '""'),
    *('"mm"', '"nan mm"', '"inf N/m"', '"1e308 km"', '"1e-320 mm"', '"1e400 mm"'),
    *('"1 mm mm"', '"1 m**9**9"', '"٣ mm"', '"\\u0000"', '"\\U0001F600"'),
)
UNITS = (
    *"mm m km um inch deg rad GPa MPa psi kg/m^3 g/cm^3 N/m N/mm N/rad N*m/rad".split(),
    *("kHz", "rpm", "%", "K", "µm", "furlong", "m^0", "", "1/m"),
)
LETTERS = "aezxky_. -\"'=[]{}#\\\n\té\u202e\u2028\u0000\U0001f600٣"
_NUMBER = re.compile(rb"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")
_QUANTITY = re.compile(rb'"[-+.\deE]+ ([^"\n]+)"')
_STIFFNESS = re.compile(rb"(?s)(\[bearing\.stiffness\].*?)(?=\n\[|\Z)")
_VALUE = re.compile(rb"^([A-Za-z_]+)\s*=\s*([^#\n]*[^#\n\s])", re.M)


Mutation = Callable[[random.Random, bytes], bytes]


def _encoded(text: str) -> bytes:
    return text.encode("utf-8", "surrogatepass")


def _one(pattern: re.Pattern, group: int = 0) -> Callable:
    """A mutation of one place where a pattern is found: given dice and match, what stands there."""

    def decorated(change: Callable[[random.Random, re.Match], str]) -> Mutation:
        @functools.wraps(change)
        def mutate(rng, text):
            found = list(pattern.finditer(text))
            if not found:
                return text
            match = rng.choice(found)
            new = _encoded(change(rng, match))
            return text[: match.start(group)] + new + text[match.end(group) :]

        return mutate

    return decorated


def _lines(change: Callable[[random.Random, list[bytes]], None]) -> Mutation:
    """A mutation that changes the list of lines."""

    @functools.wraps(change)
    def mutate(rng, text):
        lines = text.split(b"\n")
        change(rng, lines)
        return b"\n".join(lines)

    return mutate


def flip_bytes(rng, text):
    out = bytearray(text)
    for _ in range(rng.choice((1, 1, 2, 5, 20)) if out else 0):
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
    letters = "".join(rng.choices(LETTERS, k=rng.choice((1, 1, 3, 30))))
    return text[:at] + _encoded(letters) + text[at:]


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
    part = rng.choice(re.split(rb"(?m)^(?=\[\[)", text))
    times = rng.choice((1, 1, 1, 2, 20))
    copies = [re.sub(rb'(?m)^name = "', b'name = "%d' % k, part) for k in range(times)]
    return b"\n".join([text, *copies])


def swap_values(rng, text):
    found = list(_VALUE.finditer(text))
    if len(found) < 2:
        return text
    one, two = sorted(rng.sample(found, 2), key=lambda match: match.start())
    between = text[one.end(2) : two.start(2)]
    return text[: one.start(2)] + two[2] + between + one[2] + text[two.end(2) :]


@_one(_NUMBER)
def wild_number(rng, match):
    return rng.choice(NUMBERS)


@_one(_VALUE, 2)
def wild_value(rng, match):
    return rng.choice(NUMBERS)


@_one(_NUMBER)
def scale_number(rng, match):
    widest = rng.choice((0.3, 4, 30, 300))
    factor = 10.0 ** rng.uniform(-widest, widest)
    return repr(float(match[0]) * factor * rng.choice((1, 1, 1, -1)))


@_one(_NUMBER)
def nudge_number(rng, match):
    nudge = rng.choice((1, -1)) * 10.0 ** rng.randint(-16, -3)
    return repr(float(match[0]) * (1 + nudge))


@_one(_QUANTITY, 1)
def other_unit(rng, match):
    return rng.choice(UNITS)


@_one(_VALUE, 1)
def misspell_key(rng, match):
    key = list(match[1].decode())
    at = rng.randrange(len(key))
    key[at] = rng.choice(("", key[at] * 2, key[at].upper(), rng.choice(LETTERS)))
    return "".join(key)


@_one(_VALUE, 2)
def nest_table(rng, match):
    depth = rng.choice((1, 2, 50, 3000))
    opening, closing = rng.choice((("[", "]"), ("{a = ", "}")))
    return opening * depth + match[2].decode("utf-8", "replace") + closing * depth


@_one(_VALUE, 2)
def huge_array(rng, match):
    entry = rng.choice(("1", '"4.1e8 N/m"', "[1, 0, 0, 0, 0, 0]", "{kxx = 1}", "[]"))
    return "[" + ", ".join([entry] * rng.choice((6, 36, 100, 30_000))) + "]"


@_one(_STIFFNESS, 1)
def spread_stiffness(rng, match):
    """A bearing of a random matrix, often of a rank below six, of entries that may be absurd."""
    numbers = np.random.default_rng(rng.randrange(2**32))
    root = numbers.standard_normal((6, rng.randint(0, 6))) * 10.0 ** numbers.uniform(-2, 5, (6, 1))
    root *= 10.0 ** rng.choice((0, 0, 0, -8, 8, -100, 100, -160, 150))
    with np.errstate(all="ignore"):
        rows = (root @ root.T).tolist()
    return f"matrix = {rows}"


MUTATIONS = (
    flip_bytes,
    flip_a_bit,
    truncate,
    cut_out,
    insert_letters,
    delete_line,
    duplicate_line,
    swap_lines,
    shuffle_tables,
    repeat_table,
    misspell_key,
    swap_values,
    nest_table,
    huge_array,
    spread_stiffness,
    *(wild_number, wild_value, other_unit) * 2,
    *(scale_number, nudge_number) * 6,
)


def spoilt(rng: random.Random) -> tuple[str, bytes]:
    """How a scene was spoilt, and the file."""
    name = rng.choice(tuple(SCENES))
    text, done = SCENES[name], []
    for _ in range(rng.choice((1, 1, 1, 2, 3, 6))):
        mutate = rng.choice(MUTATIONS)
        text = mutate(rng, text)
        done.append(mutate.__name__)
    return f"{name}: {' '.join(done)}", text
