"""Every command and every piece of code in README and docs does what the page says, or says why it is not run.

`UPDATE_DOCUMENTS=1` copies the pictures that pages make into docs/images.
"""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

import pytest
from documents import READ, ROOT, Folder, blocks, pages, runs

PICTURE = re.compile(r"""(?:!\[[^\]]*\]\(|<img src=")([^)\s"]+)[)"]""")


# Pages of measured figures; each says when they were measured, and from which commit.
MEASURED = ["accuracy", "figure5", "figures", "gallery", "peers", "performance", "plain_and_grid"]
STAMP = re.compile(r"\b20\d\d-\d\d-\d\d, commit [0-9a-f]{7}\b")

shell = pytest.mark.skipif(os.name == "nt", reason="the commands of the documents are those of a POSIX shell")


def name(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


def test_every_block_is_run_or_says_why_not() -> None:
    wrong = []
    for page in pages():
        for block in blocks(page):
            where = f"{name(page)}:{block.line}"
            if block.reason is not None and not block.known_reason:
                wrong.append(f"{where}: is no reason for this block: {block.reason!r}")
            if block.reason is None and block.language not in {"toml", "sh", "python", "rust", *READ}:
                wrong.append(f"{where}: {block.language!r} is not run, and not marked")
    assert not wrong, "\n".join(wrong)


def test_rust_of_the_documents_is_in_the_doctests() -> None:
    included = (ROOT / "tests/src/documents.rs").read_text(encoding="utf-8")
    missing = [name(page) for page in pages() if "crates" not in page.parts
               and any(block.language == "rust" and block.reason is None for block in blocks(page))
               and f'include_str!("../../{name(page)}")' not in included]
    assert not missing


@pytest.mark.parametrize("page", MEASURED)
def test_a_page_of_figures_says_when_and_from_which_commit(page: str) -> None:
    text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
    assert STAMP.search(text)
    # A page in sections that are renewed one by one has one in each section with a table.
    sections = re.split(r"^## ", text, flags=re.MULTILINE)[1:] if page == "accuracy" else []
    assert not [part.splitlines()[0] for part in sections if "\n|" in part and not STAMP.search(part)]


@shell
@pytest.mark.parametrize("page", [page for page in pages() if runs(page)], ids=name)
def test_a_page_runs_from_top_to_bottom(page: Path, tmp_path: Path) -> None:
    pytest.importorskip("gymnasium")
    pytest.importorskip("matplotlib")
    Folder(tmp_path).all_of(page)
    for picture in map(Path, PICTURE.findall(page.read_text(encoding="utf-8"))):
        made = tmp_path / picture.name
        if made.exists():
            target = (page.parent / picture).resolve()
            if os.environ.get("UPDATE_DOCUMENTS"):
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(made, target)
            assert target.exists(), f"{picture} is not there: UPDATE_DOCUMENTS=1 makes it"


def test_pictures_of_the_documents_are_there_and_small() -> None:
    for page in pages():
        for picture in PICTURE.findall(page.read_text(encoding="utf-8")):
            if "://" in picture:
                continue
            path = (page.parent / picture).resolve()
            assert path.exists(), f"{name(page)}: {picture}"
            assert path.stat().st_size < 3_000_000, picture


@shell
@pytest.mark.parametrize(("text", "message"), [
    ("```python\nassert 1 + 1 == 3\n```\n", "line 1"),
    ("```sh\nunipbd check nowhere.toml\n```\n", "line 1"),
    ("```sh\nunipbd scenes/dam_break.toml -q --no-record --duration 0.1 --stop-on \"speed>99\"\n```\n", "exit code 0"),
    ("text\n\n```toml\n# a.toml\nspacing = -1.0\n```\n", "line 3"),
])
def test_a_page_that_is_wrong_is_found(text: str, message: str, tmp_path: Path) -> None:
    page = ROOT / "target" / "wrong_page.md"
    page.parent.mkdir(exist_ok=True)
    page.write_text(text, encoding="utf-8")
    try:
        with pytest.raises(AssertionError, match=message):
            Folder(tmp_path).all_of(page)
    finally:
        page.unlink()


def test_a_reason_must_fit_the_block(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("<!-- not run: unpublished -->\n```sh\nls\n```\n<!-- not run: I say so -->\n```sh\nls\n```\n")
    assert [block.known_reason for block in blocks(page)] == [False, False]
