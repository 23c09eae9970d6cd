"""Docstrings of the project, made easier to read for Sphinx; they stay numpydoc."""

from __future__ import annotations

import re

from sphinx.domains.python import PyObject

#: several attributes described at once, `lo, hi : float`, and the lines that describe them
SEVERAL = re.compile(r"^(?P<names>\w+(?:, \w+)+) : (?P<kind>.*)\n(?P<text>(?:    .*\n)*)", re.M)


def one_each(app, what, name, obj, options, lines) -> None:
    """Attributes that share a description, one by one: Sphinx would take the first for a type."""
    head, section, rest = "\n".join([*lines, ""]).partition("\nAttributes\n")
    if section:
        rest = SEVERAL.sub(_each, rest)
    lines[:] = f"{head}{section}{rest}".split("\n")


def _each(found: re.Match) -> str:
    return "".join(f"{n} : {found['kind']}\n{found['text']}" for n in found["names"].split(", "))


def setup(app) -> None:
    """Before napoleon reads them; and attributes are called what they are."""
    app.connect("autodoc-process-docstring", one_each, priority=100)
    for field in PyObject.doc_field_types:
        if field.name == "variable":
            field.label = "Attributes"
