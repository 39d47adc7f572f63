"""Viewers that watch a simulation, over a socket as they do."""

import json
import struct
import threading
import time

import pytest
import unipbd as up
from websockets.sync.client import ClientConnection, connect


def drop() -> up.Simulation:
    scene = up.Scene(spacing=0.1, fps=50)
    scene.add_liquid("water")
    scene.add_block("water", min=(0, 1), max=(0.4, 1.4))
    scene.add_tank(min=(0, 0), max=(2, 3), open=["top"])
    return scene.build()


class Viewer:
    def __init__(self, url: str) -> None:
        self.connection = connect(url, subprotocols=["foxglove.sdk.v1"], compression=None)
        self.socket: ClientConnection = self.connection.__enter__()
        self.kept: list[object] = []
        self.channels: dict[str, int] = {}
        for channel in self.text("advertise")["channels"]:
            self.channels[channel["topic"]] = channel["id"]
        self.step_service = self.text("advertiseServices")["services"][0]["id"]

    def __enter__(self) -> "Viewer":
        return self

    def __exit__(self, *_: object) -> None:
        self.connection.__exit__(None, None, None)

    def say(self, **message: object) -> None:
        self.socket.send(json.dumps(message))

    def subscribe(self, topic: str) -> None:
        number = self.channels[topic]
        self.say(op="subscribe", subscriptions=[{"id": number, "channelId": number}])

    def text(self, op: str) -> dict:
        while True:
            message = self.socket.recv(timeout=60)
            if isinstance(message, str) and json.loads(message)["op"] == op:
                return json.loads(message)

    def data(self) -> tuple[int, bytes]:
        """The next message: its time [ns] and its bytes."""
        while True:
            message = self.socket.recv(timeout=60)
            if isinstance(message, bytes) and message[0] == 1:
                return struct.unpack_from("<Q", message, 5)[0], message[13:]

    def set(self, name: str, value: object) -> None:
        self.say(op="setParameters", parameters=[{"name": name, "value": value}], id="set")

    def step(self, frames: int) -> None:
        request = json.dumps({"frames": frames}).encode()
        self.socket.send(struct.pack("<BIII", 2, self.step_service, 1, 4) + b"json" + request)


def test_viewers_see_each_frame_while_python_steps() -> None:
    sim = drop()
    with sim.live("127.0.0.1:0", speed=0) as live, Viewer(live.url) as viewer:
        assert live.viewers == 1
        viewer.subscribe("/particles")
        live.hold(0.3)
        assert viewer.data()[0] == 0
        for frame in range(1, 4):
            time.sleep(0.02)  # as slow as a viewer draws
            sim.step()
            assert viewer.data()[0] == frame * 20_000_000
    assert "closed" in repr(live) and live.viewers == 0
    sim.step()


def test_a_pause_holds_python_and_a_step_lets_a_frame_pass() -> None:
    sim = drop()
    with sim.live("127.0.0.1:0", paused=True) as live, Viewer(live.url) as viewer:
        stepper = threading.Thread(target=sim.step, args=(3,))
        stepper.start()
        viewer.step(2)
        stepper.join(0.4)
        assert stepper.is_alive()
        viewer.set("paused", False)
        stepper.join(60)
        assert not stepper.is_alive() and sim.frame == 3


def test_gravity_that_a_viewer_sets_is_that_of_the_simulation_and_is_logged(caplog: pytest.LogCaptureFixture) -> None:
    sim, alone = drop(), drop()
    caplog.set_level("INFO", logger="unipbd")
    with sim.live("127.0.0.1:0", speed=0) as live, Viewer(live.url) as viewer:
        viewer.set("gravity", [0.0, -1.62])
        live.hold(0.2)
        sim.step(5)
        assert viewer.text("parameterValues")["parameters"][0]["value"] == [0.0, -1.62]
    assert sim.gravity[1] == -1.62 and "gravity" in caplog.text
    with alone.edit() as edit:
        edit.gravity = (0, -1.62)
    alone.step(5)
    assert sim.state_hash() == alone.state_hash()


def test_what_cannot_be_is_refused() -> None:
    sim = drop()
    for wrong in ({"address": "nowhere"}, {"speed": -1}, {"fields": "color"}):
        with pytest.raises(ValueError):
            sim.live(**wrong)
    with sim.live("127.0.0.1:0") as live:
        with pytest.raises(RuntimeError):
            sim.live("127.0.0.1:0")
        with pytest.raises(OSError, match="cannot listen"):
            drop().live(live.url.removeprefix("ws://"))
