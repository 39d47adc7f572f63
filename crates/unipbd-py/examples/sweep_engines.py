"""A sweep by the machinery of others: joblib, Ray, Dask, or submitit, whose script serves Slurm too.

    python sweep_engines.py [one | joblib | ray | dask | submitit] [FOLDER]

The folder decides what is left to do: a run that has its row is not run again, so that the engine may try a run again,
be killed, or be another one the next time. The table is the same.
"""

import importlib
import sys
import tempfile
from typing import Any

from unipbd import sweep

HEIGHTS = sweep.Sweep.from_dict({
    "scene": {
        "spacing": 0.08, "duration": 0.2,
        "liquid": [{"name": "water"}],
        "block": [{"material": "water", "min": [0, 0], "max": [0.5, 0.8]}],
        "tank": [{"min": [0, 0], "max": [2, 2], "open": ["top"]}],
    },
    "grid": [
        {"key": "block.0.max.1", "from": 0.3, "to": 1.3, "count": 20},
        {"key": "gravity.1", "from": -9.81, "to": -1.62, "count": 10},
    ],
    "reduce": {"speed_max": "max"},
})
Row = dict[str, Any]


def by_joblib(folder: str) -> None:
    joblib = importlib.import_module("joblib")
    runs = (joblib.delayed(sweep.run_point)(HEIGHTS, index, folder) for index in sweep.left(HEIGHTS, folder))
    joblib.Parallel(n_jobs=2)(runs)


def by_ray(folder: str) -> None:
    ray = importlib.import_module("ray")
    ray.init(num_cpus=2, include_dashboard=False)
    run = ray.remote(max_retries=3, retry_exceptions=True)(sweep.run_point)
    ray.get([run.remote(HEIGHTS, index, folder) for index in sweep.left(HEIGHTS, folder)])
    ray.shutdown()


def by_dask(folder: str) -> None:
    distributed = importlib.import_module("distributed")
    with distributed.Client(n_workers=2, threads_per_worker=1, dashboard_address=None) as client:
        left = sweep.left(HEIGHTS, folder)
        client.gather([client.submit(sweep.run_point, HEIGHTS, index, folder, retries=3) for index in left])


SHARES = 4
"""Jobs of submitit: a process that does one run alone would take longer to start than to run."""


class Share:
    """A share of the sweep as a job. One that a cluster stops is queued again, and goes on with what is left."""

    def __init__(self, folder: str) -> None:
        self.folder = folder

    def __call__(self, number: int) -> None:
        for index in sweep.left(HEIGHTS, self.folder, (number, SHARES)):
            sweep.run_point(HEIGHTS, index, self.folder)

    def checkpoint(self, number: int) -> Any:
        return importlib.import_module("submitit").helpers.DelayedSubmission(self, number)


def by_submitit(folder: str) -> None:
    submitit = importlib.import_module("submitit")
    # cluster="slurm", and a folder that all machines see, for a cluster.
    executor = submitit.AutoExecutor(folder=f"{folder}/submitit", cluster="local")
    executor.update_parameters(timeout_min=10, cpus_per_task=1)
    jobs = [executor.submit(Share(folder), number) for number in range(1, SHARES + 1)]
    for job in jobs:
        job.result()


def by_one(folder: str) -> None:
    for index in sweep.left(HEIGHTS, folder):
        sweep.run_point(HEIGHTS, index, folder)


def main(engine: str = "one", folder: str = "") -> None:
    folder = folder or tempfile.mkdtemp()
    engines = {"one": by_one, "joblib": by_joblib, "ray": by_ray, "dask": by_dask, "submitit": by_submitit}
    engines[engine](folder)
    sweep.write_table(folder, f"{folder}/results.csv")
    with open(f"{folder}/results.csv", encoding="utf-8") as file:
        print(f"{folder}/results.csv: {len(file.readlines()) - 1} of {len(HEIGHTS)} runs")


if __name__ == "__main__":
    main(*sys.argv[1:])
