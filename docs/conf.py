"""How the documentation is built: `python docs/tools/build.py`, or `sphinx-build -W docs build/docs`."""

import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "docs" / "tools")]

import docstrings  # noqa: E402
import mathml  # noqa: E402
import pages  # noqa: E402

import solidgear  # noqa: E402

# before autodoc does: it imports with TYPE_CHECKING true, which is no way to run
for name in solidgear.__all__:
    getattr(solidgear, name)

project = "solidgear"
author = "solidgear developers"
copyright = "solidgear developers, GPL-3.0-or-later"
version = release = solidgear.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
]
# attributes of several classes share a name, and a word in a docstring may be one of them
suppress_warnings = ["ref.python"]
root_doc = "index"
exclude_patterns = ["tools", "package.md"]

# a page an object, made from docs/api.md
autosummary_generate = True
autosummary_ignore_module_all = False
templates_path = ["_templates"]
# notebooks show what they hold; the tests run them
nb_execution_mode = "off"

myst_enable_extensions = ["dollarmath", "amsmath", "deflist", "colon_fence", "attrs_inline"]
myst_heading_anchors = 3
# an array is no reference
myst_linkify_fuzzy_links = False

napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
autodoc_member_order = "bysource"
autodoc_typehints = "none"
add_module_names = False
python_use_unqualified_type_names = True
toc_object_entries_show_parents = "hide"

html_theme = "furo"
html_title = f"solidgear {version}"
html_static_path = ["_static"]
html_css_files = ["solidgear.css"]
html_copy_source = False
html_show_sourcelink = False
html_show_sphinx = False
html_math_renderer = "mathml"
pygments_style = "tango"
pygments_dark_style = "github-dark"
html_theme_options = {"navigation_with_keys": True}

# the same pages to every builder, without dates
html_last_updated_fmt = None


def setup(app):
    """Docstrings in order, formulas as MathML, and pages that other parts of the project have written."""
    docstrings.setup(app)
    mathml.setup(app)
    pages.setup(app)
