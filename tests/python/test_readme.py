"""What README.md promises: short, its badges and figures true, its gallery made by the commands beside the pictures."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

import pytest
from documents import ROOT, Folder

README = (ROOT / "README.md").read_text(encoding="utf-8")
GALLERY = re.findall(r"!\[\]\((docs/gallery/[^)]+)\) `(unipbd render [^`]+)`", README)


def test_it_is_short_and_begins_with_the_two_commands() -> None:
    assert README.count("\n") <= 120
    commands = re.findall(r"```sh\n(\S[^#\n]*?) *(?:#.*)?\n", README)
    assert commands[:2] == ["cargo run -p unipbd-cli -- scenes/open_gas.toml", "./test.sh"]


def test_the_badges_are_true() -> None:
    workspace = (ROOT / "Cargo.toml").read_text(encoding="utf-8")
    package = (ROOT / "crates/unipbd-py/pyproject.toml").read_text(encoding="utf-8")
    for value, text in ((r'rust-version = "([\d.]+)"', "Rust-{}%2B"), (r'requires-python = ">=([\d.]+)"', "Python-{}%2B")):
        found = re.search(value, workspace + package)
        assert found and text.format(found[1]) in README
    assert 'license = "MIT OR Apache-2.0"' in workspace and "license-MIT%20or%20Apache--2.0" in README


def test_the_chart_is_that_of_the_table() -> None:
    sys.path.insert(0, str(ROOT / "scripts"))
    import chart

    assert chart.CHART.read_text(encoding="utf-8") == chart.draw((ROOT / "docs/peers.md").read_text(encoding="utf-8")), (
        "python3 scripts/chart.py draws it anew"
    )


def test_there_are_nine_pictures_with_their_commands() -> None:
    assert len(GALLERY) == 9 and README.count("docs/gallery/") == 9
    for picture, command in GALLERY:
        assert (ROOT / picture).exists() and (ROOT / command.split()[2]).exists()


@pytest.mark.skipif(os.name == "nt", reason="runs in a POSIX shell")
@pytest.mark.parametrize("command", [command for _, command in GALLERY], ids=lambda text: Path(text.split()[2]).stem)
def test_the_commands_of_the_gallery_draw(command: str, tmp_path: Path) -> None:
    folder = Folder(tmp_path)
    words = command.split()
    # The first frames only.
    folder.run([*words, "--duration", "0.05"])
    assert (tmp_path / words[words.index("-o") + 1]).stat().st_size > 1000


def test_the_citation_has_the_version() -> None:
    version = re.search(r'^version = "(.*)"', (ROOT / "Cargo.toml").read_text(encoding="utf-8"), re.MULTILINE)
    assert version and f"\nversion: {version[1]}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
