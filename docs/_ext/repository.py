"""Links to files of the repository that are no pages of the site lead to the repository."""

from __future__ import annotations

import re
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

LINK = re.compile(r"(?<!!)\]\(((?:\.\./)+[^)#\s]*)(#[^)\s]*)?\)")


def outside(app: Sphinx, docname: str, source: list[str]) -> None:
    """Rewrites relative links that leave docs/; a file that does not exist is an error."""
    docs = Path(app.srcdir)
    page = Path(str(app.env.doc2path(docname))).parent

    def rewrite(link: re.Match[str]) -> str:
        target = (page / link[1]).resolve()
        if target.is_relative_to(docs):
            return link[0]
        if not target.exists():
            raise ExtensionError(f"{docname}: there is no {link[1]}")
        kind = "tree" if target.is_dir() else "blob"
        place = target.relative_to(docs.parent).as_posix()
        return f"]({app.config.repository_url}/{kind}/{app.config.repository_branch}/{place}{link[2] or ''})"

    source[0] = LINK.sub(rewrite, source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_config_value("repository_url", "", "env")
    app.add_config_value("repository_branch", "main", "env")
    app.connect("source-read", outside)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
