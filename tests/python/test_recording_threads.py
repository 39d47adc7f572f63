"""Recordings that one thread leaves while another one steps."""

from __future__ import annotations

import subprocess
import sys

# In a process of its own: what blocks with the interpreter's lock held can only be ended from outside.
PROGRAM = """
import sys, threading, time
import unipbd as up

scene = up.Scene(name="pool", spacing=0.1, duration=1.0)
scene.add_liquid("water", density=1000.0)
scene.add_block("water", min=(0, 0), max=(3, 3))
scene.add_tank(min=(0, 0), max=(4, 4))
sim = scene.build(threads=1)
failures = []

def step():
    try:
        sim.step(30)
    except Exception as error:
        failures.append(repr(error))

for turn in range(30):
    recording = sim.record(sys.argv[1], fields="all")
    recording.__enter__()
    stepping = threading.Thread(target=step)
    stepping.start()
    time.sleep(0.001 * (1 + turn % 7))
    recording.__exit__(None, None, None)
    stepping.join()
    assert 1 <= recording.frames <= 31, recording.frames
assert not failures, failures
print("left", sim.frame)
"""


def test_leaving_a_recording_while_another_thread_steps_never_blocks(tmp_path: object) -> None:
    command = [sys.executable, "-c", PROGRAM, f"{tmp_path}/run.mcap"]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert result.returncode == 0, result.stderr
    assert result.stdout == "left 900\n"
