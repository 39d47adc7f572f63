"""The command `unipbd`, and environments of their own for packages that the tests do not share."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from conftest import ROOT
from run import environment_python

COMMAND = [sys.executable, "-m", "unipbd._command"]


def command(*arguments: object) -> subprocess.CompletedProcess[str]:
    """Runs `unipbd` with these arguments."""
    return subprocess.run([*COMMAND, *map(str, arguments)], capture_output=True, text=True)


def install(python: Path | str, *arguments: str) -> None:
    """Installs packages with these arguments of pip."""
    subprocess.run([str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *arguments], check=True)


def own_environment(name: str, *packages: str) -> Path:
    """The interpreter of an environment in target/ with these packages; it is kept for the next time."""
    python = environment_python(ROOT / "target" / name)
    install(python, *packages)
    return python
