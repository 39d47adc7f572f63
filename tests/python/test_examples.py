"""The examples run, each within a minute."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

EXAMPLES = ROOT / "crates" / "unipbd-py" / "examples"
NEEDS = {"balance": "gymnasium", "pour": "gymnasium", "first_steps": "matplotlib", "fit_cma": "cma"}
WRITES = {"first_steps": "picture.png", "force_field": "picture.png", "trajectories": "data.npz", "session": "."}
HEAVY = {"learn_ppo": "its test in test_learning.py is of the full tier"}


@pytest.mark.parametrize("name", sorted(path.stem for path in EXAMPLES.glob("*.py")))
def test_example_runs(name: str, tmp_path: Path) -> None:
    if name in HEAVY:
        pytest.skip(HEAVY[name])
    if name in NEEDS:
        pytest.importorskip(NEEDS[name])
    arguments = [WRITES[name]] if name in WRITES else []
    command = [sys.executable, str(EXAMPLES / f"{name}.py"), *arguments]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert run.returncode == 0, run.stderr
    assert run.stdout
    if name in WRITES and WRITES[name] != ".":
        assert (tmp_path / WRITES[name]).stat().st_size > 1000


def test_the_notebook_executes(tmp_path: Path) -> None:
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    notebook = nbformat.read(EXAMPLES / "notebook.ipynb", as_version=4)
    client = nbclient.NotebookClient(
        notebook, timeout=60, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}
    )
    client.execute()
    outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    assert any("data:image/png;base64" in output.get("data", {}).get("text/html", "") for output in outputs)
