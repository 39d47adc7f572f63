"""Pictures of a report, where matplotlib is installed."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._checks import Curve, Flow
from ._read import all_trajectories


def draw(place: Path, flow: Flow, curves: list[Curve], spectrum: npt.NDArray[np.float64]) -> list[Path]:
    """Draws frames, curves and the spectrum into PNG files; nothing without matplotlib."""
    try:
        agg = importlib.import_module("matplotlib.backends.backend_agg")
        figure = importlib.import_module("matplotlib.figure")
    except ImportError:
        return []
    drawn = []
    for name, panels in (("frames.png", _frames(flow)), ("curves.png", [*map(_curve, curves), _power(spectrum)])):
        made: Any = figure.Figure(figsize=(4.0 * len(panels), 3.6), layout="constrained")
        agg.FigureCanvasAgg(made)
        for panel, axes in zip(panels, np.atleast_1d(made.subplots(1, len(panels))), strict=True):
            panel(axes)
        made.savefig(place / name, dpi=100)
        drawn.append(place / name)
    return drawn


def _frames(flow: Flow) -> list[Any]:
    """Beginning, middle and end of the first trajectory."""
    reader = all_trajectories(flow.folder)  # kept until the frames are read: it holds the file open
    positions, types = next(reader)
    numbers = [0, len(positions) // 2, len(positions) - 1]
    frames = [np.array(positions[number]) for number in numbers]
    return [_frame(frame, np.array(types), number * flow.dt) for frame, number in zip(frames, numbers, strict=True)]


def _frame(x: npt.NDArray[np.float32], types: npt.NDArray[np.int64], time: float) -> Any:
    def panel(axes: Any) -> None:
        axes.scatter(x[:, 0], x[:, 1], s=2.0, c=types, cmap="tab10", vmin=0, vmax=9, linewidths=0)
        axes.set_aspect("equal")
        axes.set_title(f"{time:.2f} s")

    return panel


def _curve(curve: Curve) -> Any:
    def panel(axes: Any) -> None:
        axes.plot(curve.x, curve.measured, "-", label="data set")
        axes.plot(curve.known_x, curve.known, "o", markersize=3.0, fillstyle="none", label="known")
        axes.set_title(curve.title)
        axes.set_xlabel(curve.axis)
        axes.legend()

    return panel


def _power(spectrum: npt.NDArray[np.float64]) -> Any:
    def panel(axes: Any) -> None:
        axes.semilogy(spectrum[1:, 0], np.maximum(spectrum[1:, 1], 1e-16))
        axes.set_title("share of the power of displacements")
        axes.set_xlabel("frequency [1/s]")

    return panel
