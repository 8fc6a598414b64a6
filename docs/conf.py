"""The documentation site: ``python -m sphinx -W --keep-going -b html docs out/site``."""

import re
import sys
from pathlib import Path

DOCS = Path(__file__).parent
sys.path.insert(0, str(DOCS / "_site"))

project = "ALi3"
author = "ALi3 contributors"
version = release = re.search(r'^version = "(.+)"', (DOCS.parent / "pyproject.toml").read_text(), re.MULTILINE)[1]  # type: ignore[index]

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "made_tables",
    "mathml",
    "pages",
    "docstrings",
    "live_pages",
]
exclude_patterns = ["_site"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
default_role = "code"  # docstrings write names in single backticks
nitpicky = False

myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 4
myst_dmath_double_inline = False

smartquotes_action = "D"  # dashes only: A' is a transpose

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
CHECKED = ("Number", "NotNegative", "Positive", "Share", "ConstantForce", "LargestForce")  # mbs/elements/reals.py
PAIRS = ("AtTwoLoads", "SignedAtTwoLoads", "AlongAxes")
autodoc_type_aliases = {"ArrayLike": "ArrayLike"} | dict.fromkeys(CHECKED, "float") | dict.fromkeys(PAIRS, "Pair")
autodoc_preserve_defaults = True
autodoc_default_options = {"members": True, "inherited-members": "int,Exception,Mapping"}
suppress_warnings = ["ref.python"]  # words of a type in a docstring that are names of two classes
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
python_maximum_signature_line_length = 100

html_theme = "furo"
html_title = "ALi3"
html_math_renderer = "mathml"
html_static_path = ["_site/static"]
html_css_files = ["site.css"]
html_copy_source = False
html_theme_options = {"navigation_with_keys": False}
copyright = "ALi3 contributors, BSD 3-Clause"
