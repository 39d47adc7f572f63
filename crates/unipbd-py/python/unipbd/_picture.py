"""Pictures of a running simulation."""

from __future__ import annotations

import html
import os
from base64 import b64encode
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._arrays import fixed
from ._observe import Observable

_SMALL: dict[str, Any] = {
    "width": 480,
    "color_by": "material",
    "style": "surface",
    "background": "dark",
    "view": None,
    "time_stamp": True,
}


class Drawable(Observable):
    """What a `Simulation` shows of itself: pictures, and a line of text."""

    def render(
        self,
        path: str | os.PathLike[str] | None = None,
        width: int = 960,
        color_by: str = "material",
        style: str = "surface",
        background: str = "dark",
        view: tuple[tuple[float, float], tuple[float, float]] | None = None,
        time_stamp: bool = True,
    ) -> npt.NDArray[np.uint8]:
        """Draws the present frame, returns the picture, uint8, shape (height, width, 3), and writes
        it to a PNG file where `path` is given.

        `color_by` is ``"material"``, ``"speed"``, ``"density"`` or ``"temperature"``; `style` is
        ``"surface"`` or ``"discs"``; `background` is ``"dark"`` or ``"light"``; `view` is the lower
        left and the upper right corner [m].
        """
        look = {
            "width": width,
            "color_by": color_by,
            "style": style,
            "background": background,
            "view": view,
            "time_stamp": time_stamp,
        }
        if path is not None:
            path = Path(path)
            if path.suffix.lower() != ".png":
                raise ValueError(f"pictures are PNG files: {path}")
            path.write_bytes(self._native.png(look))
        return fixed(self._native.pixels(look))

    def _summary(self) -> str:
        counts = [f"{count} {phase}" for phase, count in self._native.counts().items() if count]
        return f"{', '.join(counts) or 'no particles'} at {self.time:.4g} s, {self.substeps} substeps"

    def __repr__(self) -> str:
        title = f" {self._scene.name!r}" if self._scene.name else ""
        return f"<unipbd.Simulation{title}: {self._summary()}>"

    def _repr_html_(self) -> str:
        picture = b64encode(self._native.png(_SMALL)).decode("ascii")
        title = html.escape(self._scene.name or "Simulation")
        return (
            f'<figure><img alt="{title}" src="data:image/png;base64,{picture}">'
            f"<figcaption><b>{title}</b>: {html.escape(self._summary())}</figcaption></figure>"
        )
