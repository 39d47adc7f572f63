"""Checks that unipbd logs can be read by tools that know nothing of unipbd.

    pip install -r tests/python/requirements.txt
    python tests/python/check_log.py run.mcap ...

Prints a line for each check and exits with 1 if one fails.
"""

import hashlib
import subprocess
import sys
import sysconfig
import tempfile
from collections import Counter
from pathlib import Path

import numpy
from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from rerun.chunk import RrdReader

SCHEMAS = {
    "/particles": "foxglove.PointCloud",
    "/bodies/samples": "foxglove.PointCloud",
    "/boundary": "foxglove.PointCloud",
    "/scene": "foxglove.SceneUpdate",
    "/tf": "foxglove.FrameTransforms",
    "/diagnostics": "unipbd.Diagnostics",
    "/particles/columns": "unipbd.ParticleColumns",
    "/bodies": "unipbd.Bodies",
    "/log": "foxglove.Log",
}
POINT = numpy.dtype([("position", "<f4", 3), ("color", "u1", 4)])
COUNTS = ("count_liquid", "count_gas", "count_smoke", "count_rigid", "count_solid")


class Checks:
    """Prints a line for each check and remembers failures."""

    def __init__(self):
        self.failures = 0

    def __call__(self, passed, claim, found=""):
        print(f"{'PASS' if passed else 'FAIL'} {claim}{f': {found}' if found != '' else ''}")
        self.failures += not passed


def check_opening(check, reader, text):
    """Scene and metadata; returns the metadata."""
    metadata = {record.name: record.metadata for record in reader.iter_metadata()}.get("unipbd", {})
    wanted = {"version", "scene_sha256", "overrides", "seed", "dt", "fps", "spacing", "materials"}
    check(wanted <= metadata.keys(), "the metadata say where the log comes from", sorted(metadata))
    sha256 = hashlib.sha256(text).hexdigest()
    check(metadata.get("scene_sha256") == sha256, "the attached scene has the SHA-256 of the metadata", sha256[:12])
    return metadata


class Contents:
    """What the messages of a log hold, as far as the checks need it."""

    def __init__(self):
        self.counts, self.schemas, self.times = Counter(), {}, []
        self.frames = []  # points of each frame
        self.numbers = []  # diagnostics
        self.rows = 0  # rows of the particle columns
        self.poses = None  # time of the last poses
        self.rows_agree = self.poses_first = self.one_time = True

    def add(self, schema, channel, record, message):
        self.counts[channel.topic] += 1
        self.schemas[channel.topic] = schema.name
        self.times.append(record.log_time)
        self.one_time &= record.log_time == record.publish_time
        if channel.topic == "/particles":
            self.frames.append(numpy.frombuffer(message.data, POINT))
            self.rows_agree &= message.point_stride == POINT.itemsize and len(self.frames[-1]) in (0, self.rows)
            self.poses_first &= self.poses in (None, record.log_time)
        elif channel.topic == "/particles/columns":
            self.rows = len(message.id) or self.rows
            self.rows_agree &= len(message.id) == len(message.material) == len(message.phase)
            fields = (message.velocity_x, message.velocity_y, message.density_error, message.temperature)
            self.rows_agree &= all(len(field) in (0, self.rows) for field in fields)
        elif channel.topic == "/diagnostics":
            self.numbers.append(message)
        elif channel.topic == "/tf":
            self.poses = record.log_time

    def points(self):
        return [len(frame) for frame in self.frames]


def read_messages(check, path):
    """Decodes every message of a log; returns its contents and its metadata."""
    contents = Contents()
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        summary = reader.get_summary()
        attachments = {attachment.name: attachment for attachment in reader.iter_attachments()}
        check(list(attachments) == ["scene.toml"], "the scene is attached", list(attachments))
        metadata = check_opening(check, reader, attachments["scene.toml"].data)
        for item in reader.iter_decoded_messages(log_time_order=False):
            contents.add(*item)
    total = sum(contents.counts.values())
    check(summary.statistics.message_count == total, "every message decodes", f"{total} messages")
    encodings = {channel.message_encoding for channel in summary.channels.values()}
    check(encodings == {"protobuf"}, "all messages are protobuf")
    return contents, metadata


def check_contents(check, contents, metadata):
    """Topics, counts, times and sizes."""
    counts, times, points = contents.counts, contents.times, contents.points()
    check(contents.schemas.items() <= SCHEMAS.items(), "topics have the schemas of the format", ", ".join(sorted(counts)))
    runs_on = times == sorted(times) and times[0] == 0
    check(runs_on, "log time starts at 0 and never runs backwards", f"{times[-1] / 1e9:.3f} s")
    check(contents.one_time, "publish time is log time")
    check(len(points) >= 1, "there are frames", len(points))
    finite = all(numpy.isfinite(frame["position"]).all() for frame in contents.frames)
    check(finite, "all positions are finite", f"{sum(points)} points, at most {max(points)} in a frame")
    check(contents.rows_agree, "columns have as many rows as there are points")
    if contents.numbers:
        check(counts["/diagnostics"] == counts["/particles"], "there are diagnostics for every frame")
        sums = [sum(getattr(message, name) for name in COUNTS) for message in contents.numbers]
        check(sums == points, "counts by phase add up to the points of each frame")
    check(("/bodies" in counts) == ("/tf" in counts), "bodies have poses and poses have bodies")
    check(contents.poses_first, "poses come before the particles of their frame")
    fields = metadata.get("fields", "")
    if fields:
        everywhere = counts["/particles/columns"] == counts["/particles"]
        check(everywhere, f"asked fields ({fields}) are in every frame")


def rerun(*arguments):
    """Runs the rerun command of this environment."""
    command = Path(sysconfig.get_path("scripts")) / "rerun"
    return subprocess.run([str(command), *map(str, arguments)], capture_output=True, text=True, check=False)


def decoded(chunks, entity, column):
    """All values that Rerun has for a column of an entity, in the order of log time."""
    rows = []
    for chunk in chunks:
        if chunk.entity_path == entity and not chunk.is_static:
            batch = chunk.to_record_batch()
            if column in batch.schema.names:
                times = batch["message_log_time"].cast("int64").to_pylist()
                rows += zip(times, batch[column])
    return [value for _, value in sorted(rows, key=lambda row: row[0])]


def same_points(frame, positions, colors):
    """Whether Rerun has the points of a frame, with colours as 0xRRGGBBAA."""
    red, green, blue, alpha = frame["color"].astype("u4").T
    packed = red << 24 | green << 16 | blue << 8 | alpha
    seen = numpy.array(positions.values.flatten()).reshape(-1, 3)
    return numpy.array_equal(seen, frame["position"]) and numpy.array_equal(numpy.array(colors.values), packed)


def check_in_rerun(check, path, contents):
    """Lets Rerun check and convert the log and looks at what it made of it."""
    result = rerun("mcap", "check", path)
    check(result.returncode == 0, "rerun mcap check accepts the log", result.stderr[-200:].strip())
    with tempfile.TemporaryDirectory() as folder:
        recording = Path(folder) / "log.rrd"
        options = ["--application-id", "unipbd", "--timeline-type", "duration"]
        result = rerun("mcap", "convert", path, *options, "-o", recording)
        check(result.returncode == 0 and recording.exists(), "rerun converts the log")
        if not recording.exists():
            return
        chunks = RrdReader(recording).stream().to_chunks()
    positions = decoded(chunks, "/particles", "Points3D:positions")
    colors = decoded(chunks, "/particles", "Points3D:colors")
    whole = len(positions) == len(colors) == len(contents.frames)
    check(whole, "Rerun shows every frame of /particles", f"{len(positions)} frames")
    same = whole and all(map(same_points, contents.frames, positions, colors))
    check(same, "Rerun decodes /particles to the points and colours of the log")
    if contents.numbers:
        check_columns_in_rerun(check, decoded(chunks, "/diagnostics", "unipbd.Diagnostics:message"), contents)


def check_columns_in_rerun(check, rows, contents):
    """Compares the columns of Rerun with the messages of the log."""
    values = [row[0].as_py() for row in rows]
    names = set(values[0]) if values else set()
    wanted = {"time", "substeps", "density_error_mean", "density_error_max", "kinetic_energy", *COUNTS}
    check(wanted <= names, "Rerun decodes /diagnostics to columns", f"{len(names)} columns, {len(values)} rows")
    same = len(values) == len(contents.numbers) and all(
        value.get(name) == getattr(message, name)
        for value, message in zip(values, contents.numbers)
        for name in wanted
    )
    check(same, "the columns hold the numbers of the log")


def main(paths):
    if not paths:
        print(__doc__, file=sys.stderr)
        return 2
    check = Checks()
    for path in map(Path, paths):
        print(f"# {path.name}")
        try:
            contents, metadata = read_messages(check, path)
        except (OSError, KeyError, McapError) as error:
            check(False, "the log can be read", error)
            continue
        check_contents(check, contents, metadata)
        check_in_rerun(check, path, contents)
    print(f"{check.failures} checks failed" if check.failures else "all checks passed")
    return 1 if check.failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
