"""Derivatives by differences over a batch."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import unipbd as up


def falling() -> up.Scene:
    scene = up.Scene(spacing=0.1, fps=60, gravity=(0, -10.0))
    scene.add_body("ball", at=(0, 5), radius=0.2)
    scene.solver.substeps = 4
    return scene


def channel() -> up.Scene:
    """Flow between two walls, from rest."""
    scene = up.Scene(spacing=0.1, fps=60, gravity=(0.8, 0.0))
    scene.add_liquid("fluid", density=1.0, kinematic_viscosity=0.1, surface="none")
    scene.domain.periodic_x = (0.0, 1.0)
    scene.add_block("fluid", min=(0, 0), max=(1, 1))
    scene.add_half_plane((0, 0), (0, 1), slip="none")
    scene.add_half_plane((0, 1), (0, -1), slip="none")
    return scene


def splash() -> up.Scene:
    scene = up.Scene(spacing=0.08, fps=60)
    scene.add_liquid("water")
    scene.add_block("water", min=(0, 0), max=(0.5, 1.0))
    scene.add_tank(min=(0, 0), max=(1.5, 2))
    return scene


def test_a_fall_has_the_derivative_of_its_formula() -> None:
    found = up.gradient(lambda sim: sim.bodies["ball"].position[1], falling(), {"gravity.1": -10.0, "gravity.0": 0.0},
                        frames=30, scales={"gravity.0": 1.0})
    time, dt = 0.5, 0.5 / 120
    assert found.value == pytest.approx(5.0 - 5.0 * (time**2 + time * dt), rel=1e-6)
    assert found.derivatives["gravity.1"] == pytest.approx(0.5 * (time**2 + time * dt), rel=1e-4)
    assert found.derivatives["gravity.0"] == pytest.approx(0.0, abs=1e-9)
    assert found.usable["gravity.1"] == pytest.approx((1e-3, 1.0)) and found.trusted and found.substeps == 4


def test_the_flow_of_a_channel_has_the_derivative_of_the_series() -> None:
    """Mean speed of a starting Poiseuille flow: f/nu (1/12 - sum of 8/(n pi)^4 exp(-n^2 pi^2 nu t)), n odd."""

    def mean(force: float, nu: float, t: float) -> float:
        terms = (8.0 / (n * math.pi) ** 4 * math.exp(-((n * math.pi) ** 2) * nu * t) for n in range(1, 40, 2))
        return force / nu * (1.0 / 12.0 - sum(terms))

    keys = {"liquid.fluid.kinematic_viscosity": 0.1, "gravity.0": 0.8}
    found = up.gradient(lambda sim: sim.velocities[:, 0].mean(), channel(), list(keys), frames=60)
    exact = [(mean(0.8, 0.101, 1.0) - mean(0.8, 0.099, 1.0)) / 0.002, mean(1.0, 0.1, 1.0)]
    assert found.trusted and found.value == pytest.approx(mean(0.8, 0.1, 1.0), rel=0.03)
    assert list(found.derivatives.values()) == pytest.approx(exact, rel=0.06)
    # Steps that are known spare the search, and change nothing.
    again = up.gradient(lambda sim: sim.velocities[:, 0].mean(), channel(), keys, frames=60, steps=found.steps)
    assert again.derivatives == found.derivatives and again.runs == 5 and found.runs == 29
    forward = up.gradient(lambda sim: sim.velocities[:, 0].mean(), channel(), keys, frames=60, steps=found.steps,
                          method="forward")
    assert forward.runs == 3
    assert list(forward.derivatives.values()) == pytest.approx(list(found.derivatives.values()), rel=0.02)


def test_arrays_give_a_jacobian_and_what_is_watched_is_handed_over() -> None:
    def loss(seen: list[Any]) -> Any:
        assert len(seen) == 11
        return np.array(seen)[[5, 10]]

    found = up.gradient(loss, falling(), ["gravity.1"], frames=10, watch=lambda sim: sim.bodies["ball"].position)
    assert np.shape(found.value) == (2, 2) and found.jacobian().shape == (4, 1)
    times = np.array([5, 10]) / 60
    np.testing.assert_allclose(found.jacobian()[[1, 3], 0], 0.5 * (times**2 + times / 240), rtol=1e-4)


def test_chaos_is_said(caplog: pytest.LogCaptureFixture) -> None:
    early = up.gradient(lambda sim: sim.positions[:, 0].mean(), splash(), ["gravity.1"], frames=12)
    assert early.trusted and early.derivatives["gravity.1"] < 0.0
    late = up.gradient(lambda sim: sim.positions[3, 0], splash(), ["gravity.1"], frames=90)
    assert late.usable["gravity.1"] is None and not late.trusted
    assert "depends on the step" in caplog.text


def test_runs_repeat_whatever_the_threads() -> None:
    one = up.gradient(lambda sim: sim.positions, splash(), ["gravity.1"], frames=5, steps={"gravity.1": 0.1}, threads=1)
    two = up.gradient(lambda sim: sim.positions, splash(), ["gravity.1"], frames=5, steps={"gravity.1": 0.1}, threads=2)
    np.testing.assert_array_equal(one.derivatives["gravity.1"], two.derivatives["gravity.1"])
    assert one.substeps >= 1 and one.trusted


@pytest.mark.parametrize(("arguments", "message"), [
    ({"parameters": ["gravity"]}, "name one of its entries, such as gravity.0"),
    ({"parameters": ["gravty.1"]}, "no 'gravty.1'"),
    ({"parameters": ["gravity.0"]}, "is 0: give its size"),
    ({"method": "reverse"}, "'central' or 'forward'"),
])
def test_wrong_arguments_are_refused(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        up.gradient(**{"loss": lambda sim: 0.0, "scene": falling(), "parameters": ["gravity.1"], "frames": 1, **arguments})
