"""How these pages are built: sphinx-build -W --keep-going docs docs/_build.

Building asks nothing of the internet, and neither does reading: no script, font or style comes
from elsewhere.
"""

from importlib.metadata import version as version_of

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
nitpicky = True

myst_enable_extensions = ["colon_fence", "deflist", "attrs_inline"]
myst_heading_anchors = 3

# the notebooks are run anew at each build: what they show is what the library does
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 240
# no widgets, and so no script from elsewhere for them
nb_ipywidgets_js = {}

autodoc_member_order = "bysource"
autodoc_typehints = "none"
autosummary_generate = True
napoleon_google_docstring = False

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
    "header_links_before_dropdown": 6,
}
