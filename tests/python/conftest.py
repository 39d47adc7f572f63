"""Scenes and settings shared by all tests."""

from __future__ import annotations

import os
from collections.abc import Generator
from pathlib import Path

import pytest
from hypothesis import settings

import unipbd as up

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"

settings.register_profile("quick", max_examples=25, deadline=None)
settings.register_profile("full", max_examples=300, deadline=None)
settings.load_profile(os.environ.get("UNIPBD_TIER", "quick"))


def pool() -> up.Scene:
    """A small column of water in a tank."""
    scene = up.Scene(name="pool", spacing=0.1, duration=1.0)
    scene.add_liquid("water", density=1000.0)
    scene.add_block("water", min=(0, 0), max=(1, 1))
    scene.add_tank(min=(0, 0), max=(2, 3))
    return scene


@pytest.fixture
def scene() -> up.Scene:
    return pool()


@pytest.fixture
def sim(scene: up.Scene) -> up.Simulation:
    return scene.build(seed=7, threads=1)


@pytest.fixture
def plume() -> up.Scene:
    """A coarse plume of gas with smoke, whose particles come and go."""
    scene = up.Scene.load(SCENES / "open_gas.toml")
    scene.spacing = 0.05
    scene.duration = 1.0
    return scene


@pytest.fixture(scope="session")
def small_set(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small data set in all formats."""
    from small_dataset import small

    from unipbd import datasets

    folder = tmp_path_factory.mktemp("set")
    datasets.generate(small(), folder, jobs=1)
    return folder


@pytest.fixture(scope="session")
def full_tier() -> bool:
    return os.environ.get("UNIPBD_TIER") == "full"


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """No panic of Rust goes unnoticed, whatever a test made of the exception."""
    report = yield
    said = "".join(text for name, text in report.sections if "stderr" in name)
    panicked = "panicked at" in said or (call.excinfo is not None and call.excinfo.typename == "PanicException")
    if panicked and report.passed:
        report.outcome = "failed"
        report.longrepr = "a panic of Rust:\n" + said
    return report
