"""Sweeps on Ray: the same files as on one machine, also where a machine of the cluster is lost."""

import os
import pickle
import sys
import threading
import time
import types
from dataclasses import dataclass
from typing import Any, Callable

import numpy as np
import pytest

from strandline import Error, Scene, sweep, sweeps

SCENE = Scene(style={"style": "pixie", "strand_count": 12}, film={"frames": 2}, devices={"simulation": "cpu", "pictures": "cpu"})
SAMPLES = [*sweeps.grid({"style.seed": [1, 2]}), {"film.frames": 0}]

#: Jobs on two machines, one of which is lost. The short form has none and starts no Ray, which takes minutes on a busy
#: machine and waits without end where its processes do not start. `cargo xtask long` has 64.
JOBS = int(os.environ.get("STRANDLINE_JOBS", "0"))


@dataclass
class Task:
    """A task that was handed in: its words are pickled, as on their way to another machine."""

    number: int
    run: Callable[..., Any]
    words: bytes

    __hash__ = object.__hash__


class OneProcess(types.ModuleType):
    """The functions of Ray that sweeps call, in this process. A task may be lost with its machine."""

    RayError = type("RayError", (Exception,), {})
    exceptions = types.SimpleNamespace(RayError=RayError)

    def __init__(self, lost=None):
        super().__init__("ray")
        self.lost, self.begun, self.needs = lost, [], []

    def is_initialized(self):
        return False

    def init(self, **settings):
        self.begun.append(settings["address"])

    def shutdown(self):
        self.begun.append("ended")

    def remote(self, max_retries):
        assert max_retries == 3

        def options_of(run):
            def options(**needs):
                self.needs.append(needs)
                hand_in = lambda *words: Task(len(self.needs), run, pickle.dumps(words))  # noqa: E731
                return types.SimpleNamespace(remote=hand_in)

            return types.SimpleNamespace(options=options)

        return options_of

    def wait(self, tasks, num_returns):
        # The last one ends first.
        return tasks[-num_returns:], tasks[:-num_returns]

    def get(self, task):
        if task.number == self.lost:
            raise self.RayError("its machine is gone")
        return pickle.loads(pickle.dumps(task.run(*pickle.loads(task.words))))


def test_tasks_are_the_jobs_of_one_machine(tmp_path, monkeypatch):
    here = sweep(SCENE, SAMPLES, tmp_path / "here", workers=0)
    ray = OneProcess()
    # Tasks set it.
    monkeypatch.setenv("RAYON_NUM_THREADS", "1")
    monkeypatch.setitem(sys.modules, "ray", ray)
    compare(here, tmp_path, monkeypatch, "local")
    assert ray.begun == ["local", "ended"] * 2 and len(ray.needs) == 3 and ray.needs[0]["num_gpus"] == 0


def test_a_task_that_is_lost_has_failed_and_is_done_the_next_time(tmp_path, monkeypatch):
    monkeypatch.setenv("RAYON_NUM_THREADS", "1")
    monkeypatch.setitem(sys.modules, "ray", OneProcess(lost=2))
    first = sweep(SCENE, SAMPLES[:2], tmp_path, cluster="local")
    assert [row["state"] for row in first.rows] == ["done", "failed"]
    assert first.rows[1]["error"] == "its process was lost: RayError"
    again = sweep(SCENE, SAMPLES[:2], tmp_path, cluster="local")
    assert [row["state"] for row in again.rows] == ["done", "done"] and again.rows[0]["hash"] == first.rows[0]["hash"]


def compare(here, folder, monkeypatch, cluster):
    """Holds a sweep on a cluster to one on this machine."""
    there = sweep(SCENE, SAMPLES, folder / "there", cluster=cluster)
    assert [row["hash"] for row in there.rows] == [row["hash"] for row in here.rows]
    assert [row["state"] for row in there.rows] == ["done", "done", "failed"]
    # Machines that see another folder send their files.
    monkeypatch.setattr("strandline.jobs.write", apart(folder))
    sent = sweep(SCENE, SAMPLES[:1], folder / "sent", cluster=cluster)
    assert sent.rows[0]["hash"] == here.rows[0]["hash"]
    with np.load(folder / "sent" / sent.rows[0]["file"]) as arrays:
        assert arrays["guides"].shape[1] == 12


def apart(folder):
    """Writes files as ever, but for the one by which machines find that they share the folder."""
    from strandline import jobs

    write = jobs.write
    return lambda path, content: None if os.path.basename(path).startswith(".sweep") else write(path, content)


def test_a_cluster_that_is_not_there_is_said(tmp_path):
    pytest.importorskip("ray")
    with pytest.raises(Error, match="cluster is `127.0.0.1:1`"):
        sweep(SCENE, [{}], tmp_path, cluster="127.0.0.1:1")


@pytest.fixture
def quiet(monkeypatch):
    monkeypatch.setenv("RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO", "0")
    monkeypatch.setenv("RAY_USAGE_STATS_ENABLED", "0")


def begin():
    """Starts Ray on this machine; a busy one may take longer than Ray waits."""
    import ray

    for attempt in range(3):
        try:
            ray.init(address="local", num_cpus=1, include_dashboard=False, log_to_driver=False)
            return
        except Exception:
            ray.shutdown()
            if attempt == 2:
                raise


if JOBS:

    def test_tasks_of_ray_are_the_jobs_of_one_machine(tmp_path, quiet, monkeypatch):
        import ray

        here = sweep(SCENE, SAMPLES, tmp_path / "here", workers=0)
        begin()
        try:
            compare(here, tmp_path, monkeypatch, "auto")
        finally:
            ray.shutdown()

    def test_a_machine_is_lost_in_the_middle(tmp_path, quiet):
        import ray
        from ray.cluster_utils import Cluster

        samples = sweeps.grid({"style.seed": range(JOBS)})
        folder = tmp_path / "there"
        cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1})
        lost = cluster.add_node(num_cpus=1)
        ray.init(address=cluster.address, log_to_driver=False)
        finished, kept = threading.Event(), {}

        def end_one():
            while len(found := list(folder.glob("*.json"))) < JOBS // 4 and not finished.is_set():
                time.sleep(0.05)
            kept.update({path.name: path.stat().st_mtime_ns for path in found})
            cluster.remove_node(lost, allow_graceful=False)

        ending = threading.Thread(target=end_one)
        ending.start()
        try:
            done = sweep(SCENE, samples, folder, cluster=cluster.address)
            finished.set()
            ending.join()
            again = sweep(SCENE, samples, folder, cluster=cluster.address)
        finally:
            finished.set()
            ray.shutdown()
            cluster.shutdown()
        assert JOBS // 4 <= len(kept) < JOBS, "it was lost in the middle"
        assert len({row["hash"] for row in again.rows}) == JOBS and not again.failed
        assert all((folder / name).stat().st_mtime_ns == stamp for name, stamp in kept.items()), "nothing is done twice but what was lost"
        assert not done.failed
        here = sweep(SCENE, samples[:: max(JOBS // 4, 1)], tmp_path / "here", workers=0)
        assert [row["hash"] for row in here.rows] == [row["hash"] for row in again.rows[:: max(JOBS // 4, 1)]]
