"""A policy is learned by stable-baselines3. Full tier: torch is heavy."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from commands import own_environment
from conftest import ROOT

import unipbd as up

EXAMPLE = ROOT / "crates" / "unipbd-py" / "examples" / "learn_ppo.py"


def test_a_float_is_kept_upright_by_a_policy_that_was_learned(tmp_path: Path, full_tier: bool) -> None:
    if not full_tier:
        pytest.skip("torch is heavy: full tier")
    python = own_environment("learning", "stable-baselines3", "matplotlib")
    # An environment of its own: stable-baselines3 wants an older Gymnasium.
    shutil.copytree(Path(up.__file__).parent, tmp_path / "package" / "unipbd")
    words = [str(python), str(EXAMPLE), "30000", str(tmp_path / "curve.png")]
    paths = {**os.environ, "PYTHONPATH": str(tmp_path / "package")}
    run = subprocess.run(words, capture_output=True, text=True, timeout=1800, env=paths)
    assert run.returncode == 0, run.stderr[-3000:]
    before, after = (float(value) for value in re.findall(r"(?:before|after) (\d+\.\d)", run.stdout))
    assert after > 150.0 > 40.0 > before, run.stdout
    assert (tmp_path / "curve.png").stat().st_size > 1000
