"""Sphinx' settings for the site. tools/site/build.py writes the pages beside a copy of this file."""

project = "hamflow"
copyright = "the hamflow authors, Apache-2.0"
author = "the hamflow authors"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinxcontrib.bibtex"]
source_suffix = {".md": "markdown"}
master_doc = "index"
exclude_patterns = []
myst_heading_anchors = 3
bibtex_bibfiles = ["references.bib"]
bibtex_default_style = "alpha"
napoleon_use_ivar = True  # a property is documented once
autodoc_member_order = "bysource"
autodoc_typehints = "none"
add_module_names = False
suppress_warnings = ["misc.highlighting_failure"]  # formulas and outputs are not of a language
html_theme = "alabaster"
html_theme_options = {"description": "Hamiltonian systems over long times", "page_width": "1100px", "sidebar_width": "240px",
                      "fixed_sidebar": True}
html_sidebars = {"**": ["about.html", "navigation.html", "searchbox.html"]}
html_show_sourcelink = False
