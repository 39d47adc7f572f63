"""SPlisHSPlasH in two dimensions on one thread: DFSPH, or its PBF."""
import json
import os
import sys
import tempfile
import time

dx, width, height, tank_width, tank_height, seconds, look = map(float, sys.argv[1:8])
method, _, error = sys.argv[8].partition(":")
name = "DFSPH" if method == "dfsph" else "PBF"
# The settings are read back from the solver before the first step.
limits = {"maxError": float(error), "maxIterations": 100} if method == "dfsph" else {"maxIterations": 5}
os.environ["OMP_NUM_THREADS"] = "1"
import numpy as np  # noqa: E402
import pysplishsplash as sph  # noqa: E402

columns, rows = round(width / dx), round(height / dx)
dt = min(0.002, 0.1 * dx)
folder = tempfile.mkdtemp()
box = os.path.join(folder, "box.obj")
with open(box, "w") as out:
    corners = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    out.writelines(f"v {x} {y} {z}\n" for x, y, z in corners)
    quads = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    out.writelines(f"f {a} {b} {c}\nf {a} {c} {d}\n" for a, b, c, d in quads)
scene = {
    "Configuration": {
        "particleRadius": dx / 2, "sim2D": True, "numberOfStepsPerRenderUpdate": 1, "density0": 1000,
        "simulationMethod": 4 if method == "dfsph" else 2, "gravitation": [0, -9.81, 0], "cflMethod": 0,
        "timeStepSize": dt, "stopAt": seconds + look, "pause": False, "boundaryHandlingMethod": 0,
        # Written beside the others, not under the name of the method, limits are ignored in silence.
        name: limits,
    },
    "Materials": [{"id": "Fluid"}],
    "RigidBodies": [{
        "geometryFile": box, "translation": [tank_width / 2, tank_height / 2, 0],
        "scale": [tank_width + dx, tank_height + dx, 1], "isDynamic": False, "isWall": True,
        "mapInvert": True, "samplingMode": 1,
    }],
    "FluidBlocks": [{
        "denseMode": 0, "start": [0, 0, -1],
        "end": [(columns + 0.6) * dx, (rows + 0.6) * dx, 1], "translation": [-dx / 2, -dx / 2, 0], "scale": [1, 1, 1],
    }],
}
path = os.path.join(folder, "scene.json")
with open(path, "w") as out:
    json.dump(scene, out)
base = sph.Exec.SimulatorBase()
base.init(useGui=False, sceneFile=path, stopAt=seconds + look, outputDir=folder)
base.initSimulation()


def check_settings():
    """Fails where the solver does not use what it was asked for."""
    simulation = sph.Simulation.getCurrent()
    step = simulation.getTimeStep()
    found = {
        "method": step.getMethodName(),
        "maxIterations": step.getValueUInt(step.MAX_ITERATIONS),
        "maxError": step.getValueFloat(step.MAX_ERROR),
        "timeStepSize": sph.TimeManager.getCurrent().getTimeStepSize(),
        "cflMethod": simulation.getValueInt(simulation.CFL_METHOD),
        "particleRadius": simulation.getParticleRadius(),
        "sim2D": simulation.is2DSimulation(),
        "gravitation": list(simulation.getVec3ValueReal(simulation.GRAVITATION)),
        "particles": simulation.getFluidModel(0).numActiveParticles(),
    }
    asked = limits | {
        "method": name, "timeStepSize": dt, "cflMethod": 0, "particleRadius": dx / 2, "sim2D": True,
        "gravitation": [0, -9.81, 0], "particles": columns * rows,
    }
    differ = {key: (asked[key], found[key]) for key in asked if not agrees(asked[key], found[key])}
    if differ:
        sys.exit(f"settings differ, asked and found: {differ}")


def agrees(asked, found):
    return asked == found if isinstance(asked, (str, bool)) else bool(np.allclose(asked, found, rtol=1e-5))


check_settings()
solver = f"SPlisHSPlasH 2.19 DFSPH {error} %" if method == "dfsph" else "SPlisHSPlasH 2.19 PBF, 5 iterations"
state = {"time": 0.0, "steps": 0, "next": look, "begin": 0.0}


def wait():
    """Waits for a line: other solvers run in between."""
    if not sys.stdin.readline():
        os._exit(0)
    state["time"], state["steps"], state["begin"] = 0.0, 0, time.process_time()


def after_step():
    state["time"] += time.process_time() - state["begin"]
    state["steps"] += 1
    if sph.TimeManager.getCurrent().getTime() >= state["next"] - 1e-9:
        state["next"] += look
        model = sph.Simulation.getCurrent().getFluidModel(0)
        positions = np.array(model.getFieldBuffer("position"), copy=True)[: model.numActiveParticles(), :2]
        found = {"time": state["time"], "steps": state["steps"], "positions": positions.tolist()}
        print(json.dumps(found), flush=True)
        wait()
    state["begin"] = time.process_time()


base.setTimeStepCB(after_step)
print(json.dumps({"solver": solver}), flush=True)
wait()
base.runSimulation()
