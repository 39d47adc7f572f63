"""Builder calls of scenes."""

from __future__ import annotations

from typing import Any

import numpy.typing as npt

from ._arrays import pairs, points
from ._tables import Table, Tables


class Builder:
    """Builder calls of `Scene`: each adds a table, whose further keys are given by name."""

    def _tables(self, kind: str) -> Tables:
        raise NotImplementedError

    def add(self, table: str, /, **values: Any) -> Table:
        """Adds a table of any kind, such as ``scene.add("tank", min=(0, 0), max=(1, 1))``."""
        return self._tables(table).append(**values)

    def add_liquid(self, name: str, density: float = 1000.0, **values: Any) -> Table:
        """Adds a liquid of this rest density [kg/m^2]."""
        return self.add("liquid", name=name, density=density, **values)

    def add_gas(self, name: str, density: float = 1.2, **values: Any) -> Table:
        """Adds a gas of this rest density [kg/m^2]."""
        return self.add("gas", name=name, density=density, **values)

    def add_smoke(self, name: str, **values: Any) -> Table:
        """Adds a smoke: markers that follow the flow."""
        return self.add("smoke", name=name, **values)

    def add_solid(self, name: str, density: float = 1000.0, **values: Any) -> Table:
        """Adds a solid: free points for constraints of your own."""
        return self.add("solid", name=name, density=density, **values)

    def add_block(
        self, material: str, min: tuple[float, float], max: tuple[float, float], **values: Any
    ) -> Table:
        """Fills a rectangle [m] with particles of a material."""
        return self.add("block", material=material, min=min, max=max, **values)

    def add_disc(self, material: str, center: tuple[float, float], radius: float, **values: Any) -> Table:
        """Fills a disc [m] with particles of a material."""
        return self.add("disc", material=material, center=center, radius=radius, **values)

    def add_gauge(self, name: str, kind: str, **values: Any) -> Table:
        """Adds a gauge: ``kind`` is level, pressure, force, flow_rate or front; see `describe`."""
        return self.add("gauge", name=name, kind=kind, **values)

    def add_particles(
        self,
        material: str,
        positions: npt.ArrayLike,
        velocities: npt.ArrayLike | None = None,
        **values: Any,
    ) -> Table:
        """Adds particles at `positions`, shape (N, 2) [m].

        `velocities` [m/s] is one vector for all of them or an array of shape (N, 2).
        ``motion="kinematic"`` lets only their velocity move them.
        """
        where = points(positions, "positions", ValueError)
        if velocities is not None:
            values["velocities"] = pairs(velocities, len(where), "velocities", ValueError)
        return self.add("points", material=material, positions=where, **values)

    def add_emitter(
        self,
        material: str,
        position: tuple[float, float],
        width: float,
        speed: float,
        direction: tuple[float, float] = (0.0, 1.0),
        **values: Any,
    ) -> Table:
        """Adds a nozzle of this width [m] that pushes a material out at this speed [m/s]."""
        return self.add(
            "emitter", material=material, position=position, width=width, speed=speed, direction=direction, **values
        )

    def add_tank(self, min: tuple[float, float], max: tuple[float, float], **values: Any) -> Table:
        """Adds a container: particles stay inside the rectangle [m]."""
        return self.add("tank", min=min, max=max, **values)

    def add_obstacle(self, min: tuple[float, float], max: tuple[float, float], **values: Any) -> Table:
        """Adds a static box: particles stay outside the rectangle [m]."""
        return self.add("obstacle", min=min, max=max, **values)

    def add_half_plane(self, point: tuple[float, float], normal: tuple[float, float], **values: Any) -> Table:
        """Adds a straight wall without end; particles stay on the side the normal points to."""
        return self.add("half_plane", point=point, normal=normal, **values)

    def add_body(
        self,
        name: str,
        at: tuple[float, float],
        outline: npt.ArrayLike | None = None,
        size: tuple[float, float] | None = None,
        radius: float | None = None,
        density: float = 1000.0,
        **values: Any,
    ) -> Table:
        """Adds a rigid body at `at` [m]: a polygon (`outline`, shape (M, 2), seen from `at`), a box
        (`size`: width and height) or a disc (`radius`), of this mass per area [kg/m^2].

        Further keys are those of ``[[body]]`` in a scene file, such as ``angle_deg``, ``velocity``,
        ``friction`` and ``kind="kinematic"``.
        """
        if outline is not None:
            values["outline"] = points(outline, "outline", ValueError)
        shape = {"size": size, "radius": radius}
        values |= {key: value for key, value in shape.items() if value is not None}
        return self.add("body", name=name, position=at, density=density, **values)

    def add_joint(self, kind: str, body: str, at: tuple[float, float], **values: Any) -> Table:
        """Links two bodies, or a body and the world, at a point [m].

        `kind` is ``"hinge"``, ``"rod"``, ``"rope"``, ``"weld"``, ``"slider"`` or ``"pulley"``; ``other`` names the second body.
        """
        return self.add("joint", kind=kind, body=body, at=at, **values)
