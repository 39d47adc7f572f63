"""The commands and the code of the documents: found, and run as a reader would.

A page is run from top to bottom in a folder of its own, in which `unipbd` is the command of the installed package and
`scenes` and `recipes` the folders of the repository. Blocks mean:

- `toml` with a first line `# NAME.toml`: a file, checked by `unipbd check`; with `# NAME.toml, continued`: more of it;
  with `# NAME.toml, a recipe` or `a sweep`: no scene, and not checked;
- `sh`: run by bash, which stops at the first command that fails; with `--stop-on` in its last line it ends with exit code 5;
- `python`: run by one interpreter per page, block after block; with a first line `# NAME.py`: a file, run by itself;
- `rust`: run by `cargo test --doc`, which `tests/src/lib.rs` tells about the page;
- `text`, `bibtex`, `js`: something to read; `js` of the npm package is run by the tests of the browser.

A block that is not run has a comment above it, `<!-- not run: REASON -->`, with a reason that `REASONS` knows.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
READ = {"js", "json", "text", "bibtex", "{toctree}", "{include}", "{math}", "{autoclass}", "{eval-rst}"}
# Reasons not to run a block, and what must be true of it.
REASONS = {
    "unpublished": r"pip install|cargo (add|install)|conda install|unipbd-core = ",
    "hours long": r"--full|\./benches/|benches/|cargo (bench|run --release)|scripts/fuzz",
    "minutes long": r"--full|benches/|scripts/|cargo (bench|run --release|test)|unipbd-validation|dataset recipes/",
    "builds anew": r"cargo (install|build|publish)|pip install|maturin|scripts/web",
    "runs the tests": r"test\.sh|docs/build\.py|tests/python/run\.py|-m pytest",
    "needs a clone": r"git |cargo run --release",
    "needs another program": r"rerun|\.mp4|valgrind|jq|lichtblick",
}
BLOCK = re.compile(
    r"^(?:<!-- not run: (?P<reason>.*?) -->\n)?(?P<indent> *)```(?P<language>[^\n`]*)\n(?P<code>.*?)^(?P=indent)```$",
    re.DOTALL | re.MULTILINE)


@dataclass(frozen=True)
class Block:
    language: str
    code: str
    line: int
    reason: str | None

    @property
    def known_reason(self) -> bool:
        """Whether it says why it is not run, and what it says fits what it does."""
        found = next((text for text in REASONS if (self.reason or "").startswith(text)), None)
        return found is not None and re.search(REASONS[found], self.code) is not None

    @property
    def script(self) -> str | None:
        """The name of the file that a block of Python is."""
        named = re.match(r"# (\S+\.py)\n", self.code)
        return named[1] if named else None

    @property
    def status(self) -> int:
        """The exit code that it ends with: 5 where the last command stops on a condition."""
        return 5 if "--stop-on" in self.code.strip().splitlines()[-1] else 0


def pages() -> list[Path]:
    """Every document with blocks, those that commands write left out."""
    found = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *ROOT.glob("crates/*/README.md"), ROOT / "viewers/README.md"]
    found += [path for path in ROOT.glob("docs/**/*.md") if "generated" not in path.parts]
    return sorted(found)


def blocks(page: Path) -> list[Block]:
    text = page.read_text(encoding="utf-8").replace("\r\n", "\n")
    found = []
    for match in BLOCK.finditer(text):
        code = re.sub(rf"^{match['indent']}", "", match["code"], flags=re.MULTILINE)
        line = text[: match.start("language")].count("\n") + 1
        found.append(Block(match["language"].split(" ")[0].strip(), code, line, match["reason"]))
    return found


def runs(page: Path) -> list[Block]:
    """The blocks that this module runs."""
    return [block for block in blocks(page) if block.reason is None and block.language in ("toml", "sh", "python")]


class Folder:
    """Where a page is run."""

    def __init__(self, place: Path) -> None:
        self.place = place
        for folder in ("scenes", "recipes"):
            shutil.copytree(ROOT / folder, place / folder)
        commands = place / ".commands"
        commands.mkdir()
        # What a clone offers, by the command that is installed already: same source, no build.
        unipbd = Path(sys.executable).with_name("unipbd")
        cargo = commands / "cargo"
        cargo.write_text(CARGO.format(unipbd=unipbd, root=ROOT), encoding="utf-8")
        cargo.chmod(0o755)
        path = os.pathsep.join([str(commands), str(unipbd.parent), os.environ["PATH"]])
        self.environment = {**os.environ, "PATH": path, "MPLBACKEND": "Agg"}

    def run(self, command: list[str], status: int = 0) -> str:
        made = subprocess.run(command, cwd=self.place, env=self.environment, capture_output=True, text=True, timeout=300)
        assert made.returncode == status, f"exit code {made.returncode}\n{made.stdout[-3000:]}\n{made.stderr[-3000:]}"
        return made.stdout

    def toml(self, code: str) -> None:
        named = re.match(r"# (\S+\.toml)(, continued)?(, a (?:recipe|sweep))?\n", code)
        if named is None:
            assert sys.version_info < (3, 11) or __import__("tomllib").loads(code) is not None
            return
        path = self.place / named[1]
        before = path.read_text(encoding="utf-8") if named[2] else ""
        path.write_text(before + code, encoding="utf-8")
        if not named[3]:
            self.run(["unipbd", "check", named[1]])

    def script(self, name: str, code: str) -> str:
        (self.place / name).write_text(code, encoding="utf-8")
        return self.run([sys.executable, name])

    def all_of(self, page: Path) -> str:
        """Runs the page; what was printed."""
        printed, script = "", []
        for number, block in enumerate(runs(page)):
            try:
                if block.language == "toml":
                    self.toml(block.code)
                elif block.language == "sh":
                    printed += self.run(["bash", "-euo", "pipefail", "-c", block.code], block.status)
                elif block.script:
                    printed += self.script(block.script, block.code)
                else:
                    # Files come from the shell blocks before it: the whole script so far would run them twice.
                    script.append(f"# line {block.line}\n{block.code}")
                    last = not any(later.language == "python" and not later.script for later in runs(page)[number + 1 :])
                    printed += self.run([sys.executable, "-c", "\n".join(script)]) if last else ""
            except AssertionError as error:
                raise AssertionError(f"{page.relative_to(ROOT)}, line {block.line}: {error}") from None
        return printed


def main() -> None:
    """Runs pages with the `unipbd` beside this interpreter: `python tests/python/documents.py PAGE...`"""
    for page in sys.argv[1:]:
        with tempfile.TemporaryDirectory() as place:
            Folder(Path(place)).all_of(Path(page).resolve())
        print(f"{page}: runs")


CARGO = """#!/bin/sh
# `cargo run -p unipbd-cli -- ARGUMENTS` by the installed command, of shipped scenes the first half second;
# nothing else is known.
case "$*" in
    "run -p unipbd-cli -- scenes/"*.toml) shift 4; exec "{unipbd}" "$@" --duration 0.5 ;;
    "run -p unipbd-cli -- render scenes/"*) shift 4; exec "{unipbd}" "$@" --duration 0.2 ;;
    "run -p unipbd-cli -- "*) shift 4; exec "{unipbd}" "$@" ;;
esac
echo "cargo $*: not known to the tests of the documents" >&2
exit 1
"""


if __name__ == "__main__":
    main()
