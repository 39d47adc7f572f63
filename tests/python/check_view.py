"""Checks what `viewers/rerun_view.py` makes of a log, and looks at it in the viewer where that can run.

    pip install -r tests/python/requirements.txt
    python tests/python/check_view.py run.mcap ...

Particles are as large as they are, bodies and walls are outlines. The picture needs Vulkan: software rendering is enough
(mesa-vulkan-drivers), and a display or the viewer's own. UNIPBD_PICTURES=FOLDER keeps it.
"""

import json
import os
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

import numpy
from PIL import Image
from rerun.chunk import RrdReader

ROOT = Path(__file__).resolve().parents[2]
GROUND = (16, 20, 24)


def column(chunks, entity, name):
    """All values of a column of an entity, static or not."""
    found = []
    for chunk in chunks:
        batch = chunk.to_record_batch()
        if chunk.entity_path == entity and name in batch.schema.names:
            found += [value.as_py() for value in batch[name] if value.as_py() is not None]
    return found


def check_entities(log, chunks):
    """What the view shows, beside what the log holds."""
    metadata = next(pairs for pairs in column(chunks, "/__mcap_metadata", "unipbd"))[0]
    metadata = {pair["first"]: pair["second"] for pair in metadata}
    radius = column(chunks, "/fluids", "Points3D:radii")[0][0]
    assert numpy.isclose(radius, 0.5 * float(metadata["spacing"])), radius
    walls = json.loads(metadata["walls"])
    assert len(column(chunks, "/walls", "LineStrips3D:strips")[0]) == len(walls), "one line a wall"
    frames = column(chunks, "/diagnostics", "unipbd.Diagnostics:message")
    counts = [sum(row[0][f"count_{phase}"] for phase in ("liquid", "gas", "smoke", "solid")) for row in frames]
    drawn = [len(places) for places in column(chunks, "/fluids", "Points3D:positions") if places]
    assert sorted(drawn) == sorted(count for count in counts if count), "all particles but those of bodies"
    bodies = [row[0]["bodies"] or [] for row in column(chunks, "/bodies", "unipbd.Bodies:message")]
    outlines = column(chunks, "/outlines", "LineStrips3D:strips")
    assert [len(strips) for strips in outlines] == [len(frame) for frame in bodies if frame], "one line a body"
    print(f"{log.name}: {len(drawn)} frames, {len(walls)} walls, {len(bodies[0]) if bodies else 0} bodies")


def look(recording, picture):
    """Takes a picture with the viewer; whether there is one."""
    program = Path(sysconfig.get_path("scripts")) / "rerun"
    command = [program, recording, "--screenshot-to", picture, "--window-size", "1200x700"]
    try:
        subprocess.run(command, capture_output=True, timeout=120, check=True)
    except (subprocess.CalledProcessError, subprocess.TimeoutExpired):
        return False
    return picture.exists()


def main(logs):
    skipped = 0
    for log in map(Path, logs):
        with tempfile.TemporaryDirectory() as folder:
            recording = Path(folder) / "view.rrd"
            view = [sys.executable, ROOT / "viewers" / "rerun_view.py", log, recording]
            subprocess.run(view, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            check_entities(log, RrdReader(recording).stream().to_chunks())
            kept = os.environ.get("UNIPBD_PICTURES")
            picture = Path(kept or folder) / f"rerun_{log.stem}.png"
            if not look(recording, picture):
                skipped += 1
                continue
            # Left of the plots the scene is neither empty nor the ground alone.
            pixels = numpy.asarray(Image.open(picture).convert("RGB"))
            scene = pixels[100:-120, : 2 * pixels.shape[1] // 3]
            share = (numpy.abs(scene.astype(int) - GROUND).max(axis=2) > 12).mean()
            assert 0.02 < share < 0.95, f"{log.name}: {share:.3f} of the view shows something"
    if skipped:
        print(f"pictures of the Rerun viewer: skipped for {skipped} logs, it cannot open a window here")


if __name__ == "__main__":
    main(sys.argv[1:])
