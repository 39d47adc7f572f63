"""Makes a Rerun recording with a fitting view out of a unipbd log.

    python viewers/rerun_view.py RUN.mcap [VIEW.rrd]

Needs `pip install rerun-sdk==0.41.0`. Rerun draws the clouds of a log as points of no size, bodies as their samples, and
no outlines; and it ignores a blueprint that is given next to an MCAP file. So this converts the log, draws particles as
large as they are, bodies and walls as outlines, looks at them from above and puts all into one file.
"""

import json
import subprocess
import sys
import sysconfig
import tempfile
import uuid
from pathlib import Path

import numpy
import rerun as rr
import rerun.blueprint as rrb
from rerun.chunk import RrdReader

APPLICATION = "unipbd"
# Numbers of phases in a log.
GAS, SMOKE, RIGID = 1, 2, 3
GROUND, BODY, WALL = [16, 20, 24], [214, 160, 92], [150, 150, 150]
PLOTS = {
    "Density error": ["density_error_mean", "density_error_max"],
    "Energy [J]": ["kinetic_energy", "potential_energy"],
    "Particles": ["count_liquid", "count_gas", "count_smoke"],
}


def rerun(*arguments):
    """Runs the rerun command of this environment."""
    subprocess.run([str(Path(sysconfig.get_path("scripts")) / "rerun"), *map(str, arguments)], check=True)


class Run:
    """What a converted log holds of the picture."""

    def __init__(self, recording):
        self.metadata, self.shapes = {}, {}
        self.particles, self.phases, self.bodies = [], [], []
        for chunk in RrdReader(recording).stream().to_chunks():
            batch = chunk.to_record_batch()
            names = batch.schema.names
            if chunk.entity_path == "/__mcap_metadata" and "unipbd" in names:
                self.metadata = {pair["first"]: pair["second"] for pair in batch["unipbd"][0].as_py()[0]}
            elif chunk.entity_path == "/particles" and "Points3D:positions" in names:
                for time, places, colors in rows(batch, "Points3D:positions", "Points3D:colors"):
                    places = numpy.array(places.values.flatten()).reshape(-1, 3)
                    self.particles.append((time, places, numpy.array(colors.values, dtype=numpy.uint32)))
            elif chunk.entity_path == "/particles/columns" and "unipbd.ParticleColumns:message" in names:
                for time, message in rows(batch, "unipbd.ParticleColumns:message"):
                    phases = message.as_py()[0]["phase"]
                    if phases:
                        self.phases.append((time, numpy.array(phases)))
            elif chunk.entity_path == "/bodies" and "unipbd.Bodies:message" in names:
                for time, message in rows(batch, "unipbd.Bodies:message"):
                    self.bodies.append((time, message.as_py()[0]))
        for found in (self.particles, self.phases, self.bodies):
            found.sort(key=lambda one: one[0])
        self.spacing = float(self.metadata.get("spacing", 0.02))
        self.walls = json.loads(self.metadata.get("walls", "[]"))

    def region(self):
        """What to show: the view of the scene, or else where the particles and walls are."""
        if "view" in self.metadata:
            return numpy.array(json.loads(self.metadata["view"]))
        corners = [numpy.array(wall["points"]) for wall in self.walls if not wall["endless"]]
        corners += [places[:, :2] for _, places, _ in self.particles if len(places)]
        if not corners:
            return numpy.array([[0.0, 0.0], [1.0, 1.0]])
        return numpy.array([numpy.min([c.min(axis=0) for c in corners], axis=0),
                            numpy.max([c.max(axis=0) for c in corners], axis=0)])

    def fluids(self):
        """Times, and for each the places and colours of all that is no body: smoke above liquids above gas."""
        known = iter(self.phases)
        upcoming, phases = next(known, None), None
        for time, places, colors in self.particles:
            while upcoming is not None and upcoming[0] <= time:
                phases, upcoming = upcoming[1], next(known, None)
            if phases is None or len(phases) != len(places):
                phases = numpy.zeros(len(places), dtype=int)
            drawn = phases != RIGID
            places, colors, phase = places[drawn].copy(), colors[drawn], phases[drawn]
            places[:, 2] = self.spacing * numpy.select([phase == GAS, phase == SMOKE], [-1.0, 1.0], 0.0)
            yield time, places, opaque(colors)

    def outlines(self):
        """Times, and for each the outlines of the bodies where they are."""
        shapes = {}
        for time, message in self.bodies:
            shapes.update({shape["id"]: outline(shape) for shape in message["shapes"] or []})
            yield time, [placed(shapes[body["id"]], body) for body in message["bodies"] or [] if body["id"] in shapes]


def rows(batch, *columns):
    """The log time [ns] and these columns, row by row."""
    times = batch["message_log_time"].cast("int64").to_pylist()
    return zip(times, *(batch[column] for column in columns))


def opaque(colors):
    """Colours as they look on the ground of the view: Rerun adds translucent points up."""
    parts = (colors[:, None] >> numpy.array([24, 16, 8, 0])) & 0xFF
    share = numpy.clip(2.5 * parts[:, 3:] / 255.0, 0.0, 1.0)
    return (share * parts[:, :3] + (1.0 - share) * numpy.array(GROUND)).astype(numpy.uint8)


def outline(shape):
    """Corners of a body in its own coordinates; a disc shows how far it has turned."""
    if shape["radius"] > 0:
        angles = numpy.linspace(0.0, 2.0 * numpy.pi, 49)
        rim = shape["radius"] * numpy.stack([numpy.cos(angles), numpy.sin(angles)], axis=1)
        return numpy.concatenate([[[0.0, 0.0]], rim])
    corners = numpy.stack([shape["outline_x"], shape["outline_y"]], axis=1)
    return numpy.concatenate([corners, corners[:1]])


def placed(corners, body):
    """Corners where the body is, above all particles."""
    cos, sin = numpy.cos(body["angle"]), numpy.sin(body["angle"])
    x, y = corners.T
    return numpy.stack([body["x"] + cos * x - sin * y, body["y"] + sin * x + cos * y, 0.0 * x], axis=1)


def draw(run, path, identity):
    """Writes what the view shows: /fluids, /outlines, /walls."""
    stream = rr.RecordingStream(APPLICATION, recording_id=identity)
    stream.save(path)
    half = 0.5 * run.spacing
    for entity in ("/fluids", "/outlines", "/walls"):
        stream.log(entity, rr.CoordinateFrame("world"), static=True)
    stream.log("/fluids", rr.Points3D.from_fields(radii=[half]), static=True)
    stream.log("/outlines", rr.LineStrips3D.from_fields(radii=[0.25 * half], colors=[BODY]), static=True)
    lines = [numpy.array(wall["points"] + wall["points"][: int(wall["closed"])]) for wall in run.walls]
    flat = [numpy.column_stack([line, 0.0 * line[:, 0]]) for line in lines]
    stream.log("/walls", rr.LineStrips3D(flat, radii=[0.25 * half], colors=[WALL]), static=True)
    send(stream, "/fluids", run.fluids(), lambda places, colors: rr.Points3D.columns(positions=places, colors=colors))
    at_bodies = ((time, strips) for time, strips in run.outlines() if strips)
    send(stream, "/outlines", at_bodies, lambda strips: rr.LineStrips3D.columns(strips=strips))
    stream.flush()
    stream.disconnect()


def send(stream, entity, frames, columns):
    """Sends columns of frames of different lengths."""
    frames = list(frames)
    if not frames:
        return
    times, *parts = zip(*frames)
    lengths = [len(part) for part in parts[0]]
    joined = [[one for part in column for one in part] if isinstance(column[0], list) else numpy.concatenate(column)
              for column in parts]
    index = rr.TimeColumn("message_log_time", duration=numpy.array(times, dtype="timedelta64[ns]"))
    stream.send_columns(entity, indexes=[index], columns=columns(*joined).partition(lengths=lengths))


def plot(name, fields):
    """One series for each field of /diagnostics."""
    def series(field):
        mapping = rrb.encodings.VisualizerComponentMapping(
            target="Scalars:scalars",
            source_kind=rrb.encodings.ComponentSourceKind.SourceComponent,
            source_component="unipbd.Diagnostics:message",
            selector=f".{field}",
        )
        return rr.SeriesLines(names=field.replace("_", " ")).visualizer(mappings=[mapping])

    return rrb.TimeSeriesView(
        name=name, origin="/diagnostics", overrides={"/diagnostics": [series(field) for field in fields]}
    )


def blueprint(lower, upper):
    """Particles from above, numbers beside them."""
    middle, (width, height) = (lower + upper) / 2, upper - lower
    # What a view beside plots shows at distance 1 is about 0.86 high and 1.15 wide.
    distance = max(width / 1.07, height / 0.80)
    particles = rrb.Spatial3DView(
        name="Particles",
        origin="/",
        contents=["/fluids", "/outlines", "/walls"],
        background=GROUND,
        line_grid=False,
        spatial_information=rrb.SpatialInformation(target_frame="world", show_axes=False),
        eye_controls=rrb.EyeControls3D(
            position=[*middle, distance], look_target=[*middle, 0.0], eye_up=[0.0, 1.0, 0.0]
        ),
    )
    plots = [plot(name, fields) for name, fields in PLOTS.items()]
    log = rrb.TextLogView(name="Events", origin="/log")
    return rrb.Blueprint(
        rrb.Horizontal(particles, rrb.Vertical(*plots, log), column_shares=[2, 1]),
        rrb.TimePanel(timeline="message_log_time", expanded=False),
        collapse_panels=True,
    )


def main(arguments):
    if len(arguments) not in (1, 2):
        print(__doc__, file=sys.stderr)
        return 2
    log = Path(arguments[0])
    output = Path(arguments[1]) if len(arguments) == 2 else log.with_suffix(".rrd")
    identity = str(uuid.uuid4())
    with tempfile.TemporaryDirectory() as folder:
        recording, drawn, rest, view = (Path(folder) / name for name in ("log.rrd", "drawn.rrd", "rest.rrd", "view.rbl"))
        options = ["--application-id", APPLICATION, "--recording-id", identity, "--timeline-type", "duration"]
        rerun("mcap", "convert", log, *options, "-o", recording)
        run = Run(recording)
        draw(run, drawn, identity)
        blueprint(*run.region()).save(APPLICATION, view)
        rerun("rrd", "filter", "--drop-entity", "/particles", recording, "-o", rest)
        rerun("rrd", "merge", rest, drawn, view, "-o", output)
    print(output)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
