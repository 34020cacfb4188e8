"""How these pages are built: sphinx-build -E -W --keep-going docs docs/_build.

Building asks nothing of the internet, and neither does reading: no script, font or style comes
from elsewhere.
"""

from __future__ import annotations

import re
import sys
from importlib.metadata import version as version_of
from pathlib import Path
from typing import TYPE_CHECKING

from sphinx.util import logging

sys.path.insert(0, str(Path(__file__).parent))
import commands_page

if TYPE_CHECKING:
    from sphinx.application import Sphinx

project = "fieldmon"
author = "the fieldmon founders"
copyright = "2026, the fieldmon founders, MIT licence"  # noqa: A001 - Sphinx calls it so
version = release = version_of("fieldmon")

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx_design",
]
exclude_patterns = ["_build", "generated/.ipynb_checkpoints"]
templates_path = ["_templates"]
# two hyphens are an option, not a dash
smartquotes = False
# names in single backquotes, as docstrings have them
default_role = "py:obj"

myst_enable_extensions = ["colon_fence", "deflist", "attrs_inline"]
myst_heading_anchors = 3

# the notebooks are run anew at each build: what they show is what the library does
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 1200  # seconds a cell; the first ones wait for loops to be compiled
nb_merge_streams = True
# no widgets, and so no script from elsewhere for them
nb_ipywidgets_js = {}

autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
python_maximum_signature_line_length = 72
autosummary_generate = True
napoleon_google_docstring = False
napoleon_attr_annotations = False

html_theme = "pydata_sphinx_theme"
html_title = "fieldmon"
html_static_path = ["_static"]
html_css_files = ["fieldmon.css"]
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "logo": {"text": "fieldmon"},
    "navbar_align": "left",
    "navbar_end": ["theme-switcher"],
    "navigation_with_keys": False,
    "footer_start": ["copyright"],
    "footer_end": [],
}

_FROM_ELSEWHERE = re.compile(
    r"""<(?:script|img|iframe|link(?![^>]*rel="canonical"))[^>]*(?:src|href)=["'](?:https?:)?//[^"']+"""
)


def setup(app: Sphinx) -> None:
    """Write the page of commands first, and look through the finished pages."""
    app.connect("builder-inited", commands_page.write)
    app.connect("build-finished", _warn_of_what_comes_from_elsewhere)


def _warn_of_what_comes_from_elsewhere(app: Sphinx, error: Exception | None) -> None:
    """Warn of every script, picture or style that would be fetched to read a page."""
    if error is not None or app.builder.format != "html":
        return
    for page in sorted(Path(app.outdir).rglob("*.html")):
        for found in _FROM_ELSEWHERE.findall(page.read_text(encoding="utf-8")):
            logging.getLogger(__name__).warning("%s fetches %s", page.name, found)
