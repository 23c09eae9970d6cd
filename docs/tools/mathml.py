"""Formulas of the documentation as MathML, which browsers draw themselves.

Nothing is fetched from a network, and no script runs in the page. The LaTeX converter is that of
docutils; a formula it does not know ends the build.
"""

from docutils import nodes
from docutils.utils.math import MathError, latex2mathml


def converted(node, display: bool) -> str:
    """LaTeX of a math node as MathML."""
    try:
        return latex2mathml.tex2mathml(node.astext().strip(), as_block=display)
    except MathError as error:
        raise ValueError(f"formula {node.astext()!r}: {error}") from error


def inline(translator, node):
    """A formula in a sentence."""
    translator.body.append(f'<span class="formula">{converted(node, display=False)}</span>')
    raise nodes.SkipNode


def block(translator, node):
    """A formula on a line of its own, with its number if it has a label."""
    number = f'<span class="eqno">({node["number"]})</span>' if node["number"] else ""
    label = f' id="equation-{node["label"]}"' if node["label"] else ""
    body = converted(node, display=True)
    translator.body.append(f'<div class="formula"{label}>{body}{number}</div>')
    raise nodes.SkipNode


def setup(app):
    """Register the renderer under the name `mathml`."""
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
