"""Makes a Rerun recording with a fitting view out of a unipbd log.

    python viewers/rerun_view.py RUN.mcap [VIEW.rrd]

Needs `pip install rerun-sdk==0.41.0`. Rerun ignores a blueprint that is given next to an MCAP file,
so this converts the log, looks at it from above and puts both into one file.
"""

import json
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

import numpy
import rerun as rr
import rerun.blueprint as rrb
from rerun.chunk import RrdReader

APPLICATION = "unipbd"
PLOTS = {
    "Density error": ["density_error_mean", "density_error_max"],
    "Energy [J]": ["kinetic_energy", "potential_energy"],
    "Particles": ["count_liquid", "count_gas", "count_smoke"],
}


def rerun(*arguments):
    """Runs the rerun command of this environment."""
    subprocess.run([str(Path(sysconfig.get_path("scripts")) / "rerun"), *map(str, arguments)], check=True)


def region(recording):
    """What to show: the view of the scene, or else where the particles and walls are."""
    corners = []
    for chunk in RrdReader(recording).stream().to_chunks():
        batch = chunk.to_record_batch()
        if chunk.entity_path == "/__mcap_metadata" and "unipbd" in batch.schema.names:
            metadata = {pair["first"]: pair["second"] for pair in batch["unipbd"][0].as_py()[0]}
            if "view" in metadata:
                return numpy.array(json.loads(metadata["view"]))
        if chunk.entity_path in ("/particles", "/boundary") and "Points3D:positions" in batch.schema.names:
            points = numpy.array(batch["Points3D:positions"].values.flatten()).reshape(-1, 3)[:, :2]
            if len(points):
                corners += [points.min(axis=0), points.max(axis=0)]
    return numpy.array([numpy.min(corners, axis=0), numpy.max(corners, axis=0)]) if corners else numpy.eye(2)


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
    middle, size = (lower + upper) / 2, max(upper - lower)
    particles = rrb.Spatial3DView(
        name="Particles",
        origin="/",
        contents=["/particles", "/boundary", "/scene/**"],
        background=[16, 20, 24],
        line_grid=False,
        spatial_information=rrb.SpatialInformation(target_frame="world", show_axes=False),
        eye_controls=rrb.EyeControls3D(
            position=[*middle, 1.1 * size], look_target=[*middle, 0.0], eye_up=[0.0, 1.0, 0.0]
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
    with tempfile.TemporaryDirectory() as folder:
        recording, view = Path(folder) / "log.rrd", Path(folder) / "view.rbl"
        options = ["--application-id", APPLICATION, "--timeline-type", "duration"]
        rerun("mcap", "convert", log, *options, "-o", recording)
        blueprint(*region(recording)).save(APPLICATION, view)
        rerun("rrd", "merge", recording, view, "-o", output)
    print(output)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
