"""The site of documentation, by Sphinx; `build.py` beside this file lays out the sources."""

from importlib import metadata

project = "mrbd"
author = "the authors of mrbd"
release = version = metadata.version("mrbd")
extensions = ["myst_parser", "sphinx.ext.autodoc"]
exclude_patterns = ["_extra"]
# Docstrings have names in single backticks.
default_role = "code"
html_theme = "furo"
html_title = f"mrbd {release}"
# What Sphinx does not make: the API of Rust.
html_extra_path = ["_extra"]
html_copy_source = False
html_show_sourcelink = False
html_show_copyright = False
# The fonts of the reader's system; nothing is fetched.
html_static_path = ["_static"]
html_css_files = ["site.css"]
myst_heading_anchors = 4
autodoc_member_order = "bysource"
# Comments that tests of the docs read are none of Markdown's errors; figures of text need no highlighter.
highlight_language = "none"
suppress_warnings = ["myst.header", "misc.highlighting_failure"]
