"""Tests of the Python package, with nothing but Python 3.10 and a Rust toolchain at hand.

    python3 tests/python/run.py [--full] [--wheel WHEEL] [pytest arguments]

Makes a virtual environment in target/, installs the package from this clone and what the tests
need, and runs pytest, mypy (strict, on package and examples) and stubtest. The quick tier builds
with the profile that `cargo test` uses and takes a few minutes; --full builds a release wheel and
takes property and leak tests further.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "crates" / "unipbd-py"
EXAMPLES = PACKAGE / "examples"
STUBTEST_KNOWN = Path(__file__).with_name("stubtest_allowlist.txt")


def run(*command: str | Path, environment: dict[str, str] | None = None, cwd: Path = ROOT) -> None:
    words = [str(word) for word in command]
    print("$", " ".join(words), flush=True)
    status = subprocess.run(words, cwd=cwd, env={**os.environ, **(environment or {})}).returncode
    if status != 0:
        sys.exit(status)


def environment_python(place: Path) -> Path:
    python = place / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    if not python.exists():
        venv.EnvBuilder(with_pip=True, clear=True).create(place)
    return python


def install(python: Path, tier: str, wheel: Path | None) -> None:
    pip = (python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check")
    if wheel is not None:
        run(*pip, "--force-reinstall", "--no-deps", wheel)
        run(*pip, f"unipbd[test,gym,plot] @ {wheel.resolve().as_uri()}")
        return
    # Without isolation the interpreter keeps its path, and Cargo what it has built for it.
    run(*pip, "maturin>=1.9,<2")
    profile = "dev" if tier == "quick" else "release"
    path = os.pathsep.join([str(python.parent), os.environ.get("PATH", "")])
    built = {"MATURIN_PEP517_ARGS": f"--profile {profile}", "PATH": path}
    run(*pip, "--no-build-isolation", f"{PACKAGE}[test,gym,plot]", environment=built)


def main() -> None:
    parser = argparse.ArgumentParser(description="Tests of the Python package.")
    parser.add_argument("--full", action="store_true", help="the long tier")
    parser.add_argument("--wheel", type=Path, help="test this wheel instead of the clone")
    parser.add_argument("--no-types", action="store_true", help="leave out mypy and stubtest")
    arguments, further = parser.parse_known_args()
    tier = "full" if arguments.full else "quick"
    python = environment_python(ROOT / "target" / "python-tests")
    install(python, tier, arguments.wheel)
    run(python, "-m", "pytest", "-q", "tests/python", *further, environment={"UNIPBD_TIER": tier})
    if not arguments.no_types:
        run(python, "-m", "mypy.stubtest", "unipbd", "--allowlist", STUBTEST_KNOWN, "--ignore-unused-allowlist", cwd=PACKAGE)
        scripts = sorted(EXAMPLES.glob("*.py"))
        for part in ([PACKAGE / "python" / "unipbd"], scripts, sorted((ROOT / "benches" / "python").glob("*.py"))):
            run(python, "-m", "mypy", "--strict", *part, environment={"MYPYPATH": str(PACKAGE / "python")})


if __name__ == "__main__":
    main()
