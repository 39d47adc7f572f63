"""The position based fluid that comes with taichi (pbf2d), on one thread, without its moving board.

Its lengths are scaled so that its lattice spacing is ours, its time so that its gravity is ours.
"""
import json
import re
import sys
import time
from importlib.util import find_spec
from pathlib import Path

dx, width, height, tank_width, tank_height, seconds, look = map(float, sys.argv[1:8])
threads = int(sys.argv[8])
unit = dx / 0.88  # metres per unit of length: its spacing is 0.8 h = 0.88
dt = (1.0 / 20.0) * (unit * 9.8 / 9.81) ** 0.5

package = Path(find_spec("taichi").submodule_search_locations[0])
text = (package / "examples/simulation/pbf2d.py").read_text()
columns, rows = round(width / dx), round(height / dx)
margin = 0.3 - 0.44  # its walls are 0.3 inside the boundary, ours half a spacing from the first row
for pattern, new in [
    (r"ti\.init\(arch=ti\.gpu\)", f"ti.init(arch=ti.cpu, cpu_max_num_threads={threads})"),
    (r"boundary = \([^)]*\)", f"boundary = ({tank_width / unit + 2 * margin}, {tank_height / unit + 2 * margin})"),
    (r"num_particles_x = 60", f"num_particles_x = {columns}"),
    (r"num_particles_x \* 20", f"num_particles_x * {rows}"),
    (r"offs = ti\.Vector\(\[.*\]\)", f"offs = ti.Vector([{0.44 + margin}, {0.44 + margin}])"),
    (r"\(ti\.random\(\) - 0\.5\) \* 4", "0.0"),
]:
    text, found = re.subn(pattern, new, text, count=1, flags=re.S if "boundary" in pattern else 0)
    assert found, f"pbf2d has changed: {pattern}"
work = Path(sys.prefix) / "pbf2d_patched.py"
work.write_text(text)
sys.path.insert(0, str(work.parent))
import pbf2d_patched as pbf  # noqa: E402
import taichi as ti  # noqa: E402


def check_settings():
    """Fails where the example is not what it is taken for, or not what it was patched to be."""
    settings = ti.lang.impl.current_cfg()
    size = (tank_width / unit + 2 * margin, tank_height / unit + 2 * margin)
    asked_and_found = {
        "arch": (str(ti.x64), str(settings.arch)),
        "threads": (threads, settings.cpu_max_num_threads),
        "particles": (columns * rows, pbf.num_particles),
        "boundary": (size, pbf.boundary),
        "time step": (1.0 / 20.0, pbf.time_delta),
        "iterations": (5, pbf.pbf_num_iters),
        "kernel radius": (1.1, pbf.h_),
    }
    differ = {key: both for key, both in asked_and_found.items() if both[0] != both[1]}
    if differ:
        sys.exit(f"settings differ, asked and found: {differ}")


check_settings()
pbf.init_particles()
pbf.run_pbf()
pbf.init_particles()
ti.sync()
print(json.dumps({"solver": "taichi 1.7 pbf2d"}), flush=True)
now, following = 0.0, look
for _ in sys.stdin:  # a line for each look: other solvers run in between
    spent, steps = 0.0, 0
    while now < following - 1e-9:
        begin = time.process_time()
        pbf.run_pbf()
        ti.sync()
        spent += time.process_time() - begin
        now += dt
        steps += 1
    following += look
    positions = ((pbf.positions.to_numpy() - margin) * unit).tolist()
    print(json.dumps({"time": spent, "steps": steps, "positions": positions}), flush=True)
