# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings of Sphinx for the API reference; `./freecad-am docs` builds it."""

project = "Robotic AM"
author = "Robotic AM developers"
extensions = ["sphinx.ext.autodoc", "sphinx.ext.autosummary", "numpydoc"]
root_doc = "index"
exclude_patterns = ["build.py"]
html_theme = "alabaster"
html_theme_options = {"page_width": "70em", "sidebar_width": "18em"}
html_show_sourcelink = False
autodoc_typehints = "signature"
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "show-inheritance": False}
numpydoc_show_class_members = False
