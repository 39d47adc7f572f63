"""A small game loop: bodies are dropped into a pit, a bar sweeps them, every second the one on top is
taken away, and the pit is drawn in the terminal.

    python game.py
"""

from __future__ import annotations

from typing import Any

import numpy as np

import unipbd

COLUMNS, ROWS = 72, 24
LOW, HIGH = (-3.0, -0.3), (3.0, 3.7)


def pit() -> unipbd.Scene:
    """A pit with a bar that swings in it."""
    scene = unipbd.Scene(spacing=0.05)
    motion = {"amplitude": (1.6, 0.0), "frequency": 0.25}
    scene.add_body("bar", at=(0.0, 0.5), size=(0.2, 1.0), kind="kinematic", motion=motion)
    for low, high in [((-3, -0.3), (3, 0)), ((-3, 0), (-2.7, 2.5)), ((2.7, 0), (3, 2.5))]:
        scene.add("obstacle", min=low, max=high)
    return scene


def drop(sim: unipbd.Simulation, number: int, random: np.random.Generator) -> None:
    """Adds a body above the pit, of a shape and at a place drawn by lot."""
    size = 0.18 + 0.06 * random.uniform(-1, 1)
    shapes: list[dict[str, Any]] = [
        {"radius": size},
        {"size": (3 * size, 1.5 * size)},
        {"outline": [(-size, -size), (size, -size), (0, size)]},
    ]
    spin = 200 * random.uniform(-1, 1)
    with sim.edit() as edit:
        place = (1.8 * random.uniform(-1, 1), 3.5)
        edit.add_body(f"body {number}", at=place, restitution=0.2, spin_deg=spin, **shapes[number % 3])


def top(sim: unipbd.Simulation) -> str | None:
    """The highest body in the pit: what a ray from above meets first."""
    hits = [sim.ray_cast((x, 3.0), (x, 0.0), walls=False)[:1] for x in np.linspace(-2.6, 2.6, 50)]
    loose = [hit[0] for hit in hits if hit and hit[0].body != "bar"]
    return max(loose, key=lambda hit: hit.point[1]).body if loose else None


def draw(sim: unipbd.Simulation) -> str:
    """The pit in letters: ``#`` for walls, ``=`` for the bar, a letter for each body."""
    lines = []
    for row in range(ROWS):
        y = HIGH[1] - (HIGH[1] - LOW[1]) * (row + 0.5) / ROWS
        line = ""
        for column in range(COLUMNS):
            x = LOW[0] + (HIGH[0] - LOW[0]) * (column + 0.5) / COLUMNS
            inside = sim.bodies_at((x, y))
            wall = abs(x) > 2.7 and y < 2.5 or y < 0
            if inside:
                line += "=" if inside[0] == "bar" else chr(ord("a") + int(inside[0].split()[1]) % 26)
            else:
                line += "#" if wall else " "
        lines.append(line)
    return "\n".join(lines)


def main(seconds: int = 15) -> unipbd.Simulation:
    """Plays for this long [s]; returns the simulation."""
    sim = pit().build()
    sim.watch_contacts()
    random, hits = np.random.default_rng(7), 0
    for frame in range(60 * seconds):
        if frame % 20 == 0:
            drop(sim, frame // 20, random)
        if frame % 60 == 59 and (highest := top(sim)):
            with sim.edit() as edit:
                edit.remove_body(highest)
        sim.step()
        events = sim.take_contact_events()
        hits += sum(event.began and "bar" in (event.body, event.other) for event in events)
        if frame % 180 == 179:
            print(draw(sim))
            print(f"{sim.time:.0f} s: {len(sim.bodies) - 1} bodies in the pit, the bar has hit {hits} times\n")
    return sim


if __name__ == "__main__":
    main()
