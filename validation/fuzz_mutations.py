"""Ways to spoil a scene file at random; every case follows from a seed and its number alone."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

import numpy as np

from validation.shipped import shipped_shafts

#: without comments, where a mutation would be wasted
SCENES = {
    path.stem: re.sub(rb"(?m)\s*#.*$", b"", path.read_bytes()).lstrip()
    for path in shipped_shafts()
    # parts from files are spoilt with their files, by `fuzz_parts`
    if b"[body]" not in path.read_bytes()
}

# ------------------------------------------------------------------------------------------------- mutations
NUMBERS = (
    "0",
    "-1",
    "-0.0",
    "1",
    "nan",
    "inf",
    "-inf",
    "1e308",
    "-1e308",
    "1e-308",
    "5e-324",
    "1e150",
    "1e-150",
    "1e30",
    "1e-30",
    "1e-12",
    "1e400",
    "9" * 400,
    "9" * 5000,
    "0x10",
    "1_000",
    "true",
    "1979-05-27",
    "12:00:00",
    "[]",
    "{}",
    '""',
    '"mm"',
    "[1, 2]",
    "{a = 1}",
    "[[[[]]]]",
    "'''\n'''",
    '"nan mm"',
    '"inf N/m"',
    '"1e308 km"',
    '"1e-320 mm"',
    '"1e400 mm"',
    '"\\u0000"',
    '"\\U0001F600"',
    '"٣ mm"',
    '"1 mm mm"',
    '"1 m**9**9"',
)
UNITS = (
    "mm",
    "m",
    "km",
    "um",
    "inch",
    "deg",
    "rad",
    "GPa",
    "MPa",
    "psi",
    "kg/m^3",
    "g/cm^3",
    "N/m",
    "N/mm",
    "N/rad",
    "N*m/rad",
    "kHz",
    "rpm",
    "%",
    "K",
    "µm",
    "furlong",
    "m^0",
    "",
    "1/m",
)
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
    return (
        text[:at]
        + "".join(rng.choices(LETTERS, k=rng.choice((1, 1, 3, 30)))).encode(
            "utf-8", "surrogatepass"
        )
        + text[at:]
    )


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
    return (
        text
        + b"\n"
        + b"\n".join(re.sub(rb'(?m)^name = "', b'name = "%d' % k, part) for k in range(times))
    )


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
    factor = 10.0 ** rng.choice(
        (rng.uniform(-0.3, 0.3), rng.uniform(-4, 4), rng.uniform(-30, 30), rng.uniform(-300, 300))
    )
    return _put(text, match, 0, repr(float(match[0]) * factor * rng.choice((1, 1, 1, -1))))


def nudge_number(rng, text):
    match = _some(rng, _NUMBER, text)
    return (
        _put(
            text,
            match,
            0,
            repr(float(match[0]) * (1 + rng.choice((1, -1)) * 10.0 ** rng.randint(-16, -3))),
        )
        if match
        else text
    )


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
    one, two = sorted(
        (_some(rng, _VALUE, text), _some(rng, _VALUE, text)), key=lambda m: m.start() if m else -1
    )
    return (
        text
        if not one or one.start() == two.start()
        else _put(_put(text, two, 2, one[2]), one, 2, two[2])
    )


def nest_table(rng, text):
    match = _some(rng, _VALUE, text)
    depth = rng.choice((1, 2, 50, 3000))
    opening, closing = rng.choice((("[", "]"), ("{a = ", "}")))
    return (
        _put(
            text, match, 2, opening * depth + match[2].decode("utf-8", "replace") + closing * depth
        )
        if match
        else text
    )


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
    root = (
        numbers.standard_normal((6, rng.randint(0, 6)))
        * 10.0 ** numbers.uniform(-2, 5, (6, 1))
        * 10.0 ** rng.choice((0, 0, 0, -8, 8, -100, 100, -160, 150))
    )
    with np.errstate(all="ignore"):
        rows = (root @ root.T).tolist()
    return _put(text, match, 1, f"matrix = {rows}".replace("Infinity", "inf"))


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
