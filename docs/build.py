"""Builds the documentation site into target/docs-site; a warning is an error.

    python3 docs/build.py

Needs Python 3.10 or later and a Rust toolchain. Makes a virtual environment in target/ from docs/requirements.txt,
builds the `unipbd` command (or takes the one that the variable UNIPBD names), lets it write the pages about the scene
format and the command line, and runs Sphinx. Once the packages are installed it needs no network.
"""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
GENERATED = HERE / "reference" / "generated"


def environment() -> Path:
    """The interpreter of an environment with the pinned packages, made where it is not there."""
    place = ROOT / "target" / "docs-venv"
    python = place / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    wanted = hashlib.sha256((HERE / "requirements.txt").read_bytes()).hexdigest()
    stamp = place / "requirements.sha256"
    if not stamp.exists() or stamp.read_text() != wanted or not python.exists():
        venv.EnvBuilder(with_pip=True, clear=True).create(place)
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        subprocess.run([*pip, "-r", HERE / "requirements.txt"], check=True)
        stamp.write_text(wanted)
    return python


def command() -> Path:
    """The `unipbd` command, built from this clone."""
    if "UNIPBD" in os.environ:
        return Path(os.environ["UNIPBD"]).resolve()
    build = ["cargo", "build", "--quiet", "-p", "unipbd-cli", "--message-format=json"]
    run = subprocess.run(build, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    made = [json.loads(line) for line in run.stdout.splitlines() if line.startswith("{")]
    return Path(next(line["executable"] for line in made if line.get("executable")))


def generate(unipbd: Path) -> None:
    sys.path.insert(0, str(HERE / "_ext"))
    import command_line
    import scene_format

    GENERATED.mkdir(parents=True, exist_ok=True)
    for old in GENERATED.iterdir():
        old.unlink()
    bare = scene_format.write(unipbd, ROOT, GENERATED)
    if bare:
        sys.exit("keys of the scene format without an example:\n" + "\n".join(bare))
    command_line.write(unipbd, GENERATED)


def main() -> None:
    python = environment()
    if not Path(sys.prefix).samefile(python.parents[1]):
        sys.exit(subprocess.run([python, __file__]).returncode)
    generate(command())
    out = ROOT / "target" / "docs-site"
    # Every page anew: Sphinx does not see that a docstring of an imported module has changed.
    sphinx = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-E", "-b", "html", HERE, out]
    status = subprocess.run([str(word) for word in sphinx], cwd=ROOT).returncode
    if status:
        sys.exit(status)
    print(f"{len(list(out.rglob('*.html')))} pages in {out}; start at {out / 'index.html'}")


if __name__ == "__main__":
    main()
