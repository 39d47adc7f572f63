"""Settings of the documentation site. Build it with `python3 docs/build.py`."""

from __future__ import annotations

import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path[:0] = [str(HERE / "_ext"), str(ROOT / "crates" / "unipbd-py" / "python")]


def _workspace(key: str) -> str:
    """A string of [workspace.package] in the root Cargo.toml: the one place for version and addresses."""
    found = re.search(rf'^{key} = "(.*)"$', (ROOT / "Cargo.toml").read_text(encoding="utf-8"), re.MULTILINE)
    if found is None:
        raise ValueError(f"Cargo.toml has no {key}")
    return found[1]


project = "unipbd"
author = "The unipbd developers"
copyright = "the unipbd developers"
release = version = _workspace("version")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton", "mathml", "repository"]
exclude_patterns = ["_ext", "_static"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}

myst_enable_extensions = ["amsmath", "attrs_inline", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 4
myst_dmath_allow_space = False

# The native module need not be built: every docstring is in Python.
autodoc_mock_imports = ["unipbd._native", "gymnasium", "tomli"]
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_default_options = {"members": True, "inherited-members": "Mapping,MutableMapping,Sequence,Exception,Env"}
napoleon_google_docstring = True
napoleon_use_ivar = True
default_role = "literal"

repository_url = _workspace("repository")
repository_branch = "main"

html_theme = "pydata_sphinx_theme"
html_title = f"unipbd {release}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_theme_options = {
    "navigation_with_keys": False,
    "show_nav_level": 2,
    "show_toc_level": 2,
    "navbar_align": "left",
    "header_links_before_dropdown": 7,
    "footer_start": ["copyright"],
    "footer_end": [],
    "secondary_sidebar_items": ["page-toc"],
}
copybutton_prompt_text = r">>> |\$ "
copybutton_prompt_is_regexp = True
