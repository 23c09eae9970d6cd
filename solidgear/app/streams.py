"""Output streams that cannot hold every character: a console or a pipe of Windows in cp1252, say."""

from __future__ import annotations

import codecs
import unicodedata
from typing import TextIO

#: the handler of characters that an encoding lacks
SPELT = "solidgear: spelt"
SIGNS = {
    "≤": "<=",
    "≥": ">=",
    "≈": "~",
    "→": "->",
    "←": "<-",
    "−": "-",
    "–": "-",
    "—": "-",
    "×": "x",
    "·": "*",
    "±": "+-",
    "°": " deg",
    "µ": "u",
    "μ": "u",
    "√": "sqrt",
    "∞": "inf",
    "━": "-",
    "─": "-",
    "│": "|",
    "┃": "|",
    "•": "*",
    "✓": "ok",
}


def spell_out(stream: TextIO) -> None:
    """Let a stream write characters that its encoding lacks in other words, where it would fail."""
    reconfigure = getattr(stream, "reconfigure", None)
    if reconfigure is not None and stream.errors in ("strict", "backslashreplace"):
        codecs.register_error(SPELT, _spelt)
        reconfigure(errors=SPELT)


def _spelt(error: UnicodeError) -> tuple[str | bytes, int]:
    """Return characters in ASCII, and where to go on."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(_word, error.object[error.start : error.end])), error.end


def _word(character: str) -> str:
    """Return a character in ASCII.

    Examples
    --------
    >>> [_word(character) for character in "≤αΩ┼ő漢"]
    ['<=', 'alpha', 'Omega', '+', 'o', '?']
    """
    if character in SIGNS:
        return SIGNS[character]
    plain = unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode()
    if plain:
        return plain
    name = unicodedata.name(character, "")
    if name.startswith("BOX DRAWINGS"):
        return "+"
    if name.startswith("GREEK"):
        letter = name.rpartition(" ")[2]
        return letter.capitalize() if "CAPITAL" in name else letter.lower()
    return "?"
