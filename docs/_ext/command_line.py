"""The page of the command line, from the help of the command itself."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

HEAD = """\
# Command line

The help of the command itself, as `unipbd --help` and `unipbd COMMAND --help` print it. Completions for your shell
come from [`unipbd completions`](#unipbd-completions), a manual page from [`unipbd man`](#unipbd-man).
"""


def help_of(unipbd: Path, *words: str) -> str:
    run = subprocess.run([unipbd, *words, "--help"], check=True, capture_output=True, text=True, env={"COLUMNS": "100"})
    return run.stdout.rstrip()


def block(title: str, text: str) -> str:
    return f"## {title}\n\n```text\n{text}\n```\n"


def write(unipbd: Path, out: Path) -> None:
    whole = help_of(unipbd)
    listed = whole.split("Commands:\n", 1)[1].split("\n\n", 1)[0]
    commands = [name for name in re.findall(r"^  (\w+)", listed, re.MULTILINE) if name != "help"]
    parts = [HEAD, block("unipbd", whole)]
    parts += [block(f"unipbd {name}", help_of(unipbd, name)) for name in commands]
    (out / "command_line.md").write_text("\n".join(parts), encoding="utf-8")
