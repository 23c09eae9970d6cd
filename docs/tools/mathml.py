"""Formulas of the documentation as MathML, which browsers draw themselves.

Nothing is fetched from a network, and no script runs in the page. The LaTeX converter is that of
docutils; a formula it does not know is a warning, and ends a strict build.
"""

from docutils import nodes
from docutils.utils.math import MathError, latex2mathml
from sphinx.util import logging


def converted(node, display: bool) -> str:
    """LaTeX of a math node as MathML."""
    try:
        return latex2mathml.tex2mathml(node.astext().strip(), as_block=display)
    except MathError as error:
        logging.getLogger(__name__).warning("formula %r: %s", node.astext(), error, location=node)
        return ""


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
