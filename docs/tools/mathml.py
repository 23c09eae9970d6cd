"""Formulas of the documentation as MathML, which browsers draw themselves.

Nothing is fetched from a network, and no script runs in the page.
"""

import re
import unicodedata

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.util import logging

log = logging.getLogger(__name__)

#: names of functions, which take a thin space before what follows
FUNCTION = re.compile(r"(<mi>(?:cos|sin|cosh|sinh|ln|det)</mi>)(?!<mo stretchy)")
BOLD = re.compile(r'<mi mathvariant="bold(?:-italic)?">(.+?)</mi>')


def bold(match: re.Match) -> str:
    """A bold letter as a character of its own: browsers no longer know the attribute."""
    letter = unicodedata.normalize("NFKC", _plain(match[1]))
    name = unicodedata.name(letter)
    wanted = name.replace("LATIN ", "").replace("GREEK ", "").replace(" LETTER", "")
    try:
        return f'<mi mathvariant="normal">{unicodedata.lookup(f"MATHEMATICAL BOLD {wanted}")}</mi>'
    except KeyError:
        return match[0]


def _plain(text: str) -> str:
    """A character from its reference."""
    found = re.fullmatch(r"&#x([0-9A-Fa-f]+);", text)
    return chr(int(found[1], 16)) if found else text


def converted(node, display: bool) -> str:
    """LaTeX of a math node as MathML; what the converter leaves undone is a warning."""
    latex = node.astext().strip()
    out = convert(latex, display="block" if display else "inline")
    if "\\" in out or re.search(r"&(?!#)", out):
        log.warning("formula %r holds what has no MathML", latex, location=node)
    return FUNCTION.sub(r'\1<mspace width="0.17em"/>', BOLD.sub(bold, out))


def inline(translator, node):
    """A formula in a sentence."""
    translator.body.append(f'<span class="formula">{converted(node, display=False)}</span>')
    raise nodes.SkipNode


def block(translator, node):
    """A formula on a line of its own."""
    translator.body.append(f'<div class="formula">{converted(node, display=True)}</div>')
    raise nodes.SkipNode


def setup(app):
    """Register the renderer under the name `mathml`."""
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
