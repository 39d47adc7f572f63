"""What goes out: versions, licences, the workflow that builds wheels."""

from __future__ import annotations

import importlib.metadata
import os
import re
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest
from conftest import ROOT

import unipbd as up

PACKAGE = ROOT / "crates" / "unipbd-py"


def test_the_version_stands_in_one_file() -> None:
    version = f'"{up.__version__}"'
    root = (ROOT / "Cargo.toml").read_text()
    assert re.findall(r'^(?:version|unipbd-[\w-]+) .*?("\d+\.\d+\.\d+")', root, re.MULTILINE) == [version] * 4
    for manifest in ROOT.glob("crates/*/Cargo.toml"):
        assert "version.workspace = true" in manifest.read_text(), manifest
    assert 'dynamic = ["version"]' in (PACKAGE / "pyproject.toml").read_text()
    assert f'"version": {version}' in (ROOT / "web/package/package.json").read_text()
    assert up.__version__ in (ROOT / "CHANGELOG.md").read_text()


def test_the_wheel_says_who_may_use_it_and_how() -> None:
    about = importlib.metadata.metadata("unipbd")
    assert about["License-Expression"] == "MIT OR Apache-2.0" and about["Requires-Python"] == ">=3.10"
    assert sorted(about.get_all("License-File") or []) == ["LICENSE-APACHE", "LICENSE-MIT"]
    assert about["Summary"] and "pip install" in str(about.get_payload())
    files = {str(file) for file in importlib.metadata.files("unipbd") or []}
    assert "unipbd/py.typed" in files and "unipbd/_native.pyi" in files
    assert any(file.startswith("unipbd/_native.abi3.") or file.endswith("_native.pyd") for file in files)
    wheel = next(file for file in importlib.metadata.files("unipbd") or [] if file.name == "WHEEL")
    assert "cp310-abi3" in wheel.read_text()


def test_the_address_is_that_of_the_workspace() -> None:
    address = re.search(r'^repository = "(.*)"$', (ROOT / "Cargo.toml").read_text(), re.MULTILINE)
    assert address
    for path in ("CITATION.cff", "packaging/conda/recipe.yaml"):
        addresses = set(re.findall(r"https://github\.com/[\w.-]+/[\w.-]+", (ROOT / path).read_text()))
        assert addresses == {address[1]}, path
    for manifest in ("core", "scene-file", "cli", "py", "web"):
        assert "repository.workspace = true" in (ROOT / f"crates/unipbd-{manifest}/Cargo.toml").read_text()


def test_the_archive_of_the_command_is_complete(tmp_path: Path) -> None:
    if sys.platform == "win32" or shutil.which("rustc") is None:
        pytest.skip("needs bash and rustc")
    made = subprocess.run(
        ["scripts/archive.sh"], cwd=ROOT, capture_output=True, text=True, check=True, timeout=120,
        env={**os.environ, "UNIPBD": str(Path(sys.executable).with_name("unipbd"))},
    )
    archive = ROOT / made.stdout.splitlines()[-1]
    with tarfile.open(archive) as files:
        names = {name.split("/", 1)[1] for name in files.getnames() if "/" in name}
    completions = {"unipbd.bash", "_unipbd", "unipbd.fish", "unipbd.elv", "_unipbd.ps1"}
    assert {f"completions/{name}" for name in completions} | {"unipbd", "man/unipbd.1", "LICENSE-MIT"} <= names
    assert up.__version__ in archive.name and archive.with_name(archive.name + ".sha256").exists()


def test_nothing_binds_the_build_to_one_processor() -> None:
    settings = [*ROOT.glob(".cargo/config*"), *ROOT.glob("crates/*/.cargo/config*"), *ROOT.glob("**/build.rs")]
    assert not [path for path in settings if "target-cpu" in path.read_text()]
    written = [ROOT / "Cargo.toml", PACKAGE / "pyproject.toml", ROOT / ".github" / "workflows" / "wheels.yml"]
    assert not [path for path in written if "target-cpu" in path.read_text()]


def test_the_workflow_builds_for_every_platform_and_a_source_distribution() -> None:
    yaml = pytest.importorskip("yaml")
    workflow = yaml.safe_load((ROOT / ".github" / "workflows" / "wheels.yml").read_text())
    jobs = workflow["jobs"]
    rows = jobs["wheel"]["strategy"]["matrix"]["include"]
    built = {(row["os"].split("-")[0], row["target"].replace("x64", "x86_64")) for row in rows}
    linux = {("ubuntu", "x86_64"), ("ubuntu", "aarch64")}
    assert built >= linux | {("macos", "x86_64"), ("macos", "aarch64"), ("windows", "x86_64")}
    for job in jobs.values():
        needs = job.get("needs", [])
        assert set([needs] if isinstance(needs, str) else needs) <= set(jobs)
        assert job["runs-on"] and all("uses" in step or "run" in step for step in job["steps"])
    commands = [step.get("with", {}).get("command") for step in jobs["sdist"]["steps"]]
    assert "sdist" in commands and set(jobs["publish"]["needs"]) >= {"wheel", "sdist"}


def test_the_workflow_of_the_archives_covers_every_platform() -> None:
    yaml = pytest.importorskip("yaml")
    jobs = yaml.safe_load((ROOT / ".github" / "workflows" / "release.yml").read_text())["jobs"]
    targets = {row["target"] for row in jobs["archive"]["strategy"]["matrix"]["include"]}
    wanted = {"unknown-linux-gnu", "apple-darwin"}
    assert {f"{arch}-{system}" for arch in ("x86_64", "aarch64") for system in wanted} | {"x86_64-pc-windows-msvc"} == targets
    assert set(jobs["attach"]["needs"]) == {"archive", "semver"}


def test_the_source_distribution_is_complete(tmp_path: Path) -> None:
    maturin = Path(sys.executable).with_name("maturin")
    if not maturin.exists() or shutil.which("cargo") is None:
        pytest.skip("needs maturin and cargo")
    made = [maturin, "sdist", "--manifest-path", PACKAGE / "Cargo.toml", "--out", tmp_path]
    subprocess.run(made, check=True, capture_output=True, timeout=300)
    (archive,) = tmp_path.glob("*.tar.gz")
    with tarfile.open(archive) as files:
        names = {name.split("/", 1)[1] for name in files.getnames() if "/" in name}
    here = subprocess.run(
        ["git", "ls-files", "crates/unipbd-core/src", "crates/unipbd-scene-file/src", "crates/unipbd-cli/src", "crates/unipbd-py"],
        cwd=ROOT, capture_output=True, text=True, check=True,
    ).stdout.split()
    wanted = {name.replace("crates/unipbd-py/python/", "python/") for name in here if "/python/" in name or "/src/" in name}
    assert not sorted(wanted - names - {name for name in wanted if name.startswith("crates/unipbd-py/src")})
    assert {"pyproject.toml", "PKG-INFO", "LICENSE-MIT", "LICENSE-APACHE", "Cargo.lock"} <= names
