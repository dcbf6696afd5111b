"""Sweeps on Ray: the same files as on one machine, also where a machine of the cluster is lost."""

import os
import threading
import time

import numpy as np
import pytest

from strandline import Error, Scene, sweep, sweeps

ray = pytest.importorskip("ray")

SCENE = Scene(style={"style": "pixie", "strand_count": 12}, film={"frames": 2}, devices={"simulation": "cpu", "pictures": "cpu"})

#: Jobs on two machines, one of which is lost; none in the short form, `cargo xtask long` has 64.
JOBS = int(os.environ.get("STRANDLINE_JOBS", "0"))


@pytest.fixture
def quiet(monkeypatch):
    monkeypatch.setenv("RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO", "0")
    monkeypatch.setenv("RAY_USAGE_STATS_ENABLED", "0")


def test_tasks_of_ray_are_the_jobs_of_one_machine(tmp_path, quiet, monkeypatch):
    samples = [*sweeps.grid({"style.seed": [1, 2]}), {"film.frames": 0}]
    here = sweep(SCENE, samples, tmp_path / "here", workers=0)
    begin()
    try:
        there = sweep(SCENE, samples, tmp_path / "there", cluster="auto")
        assert [row["hash"] for row in there.rows] == [row["hash"] for row in here.rows]
        assert [row["state"] for row in there.rows] == ["done", "done", "failed"]
        # Machines that see another folder send their files.
        monkeypatch.setattr("strandline.jobs.write", apart(tmp_path))
        sent = sweep(SCENE, samples[:1], tmp_path / "sent", cluster="auto")
        assert sent.rows[0]["hash"] == here.rows[0]["hash"]
        with np.load(tmp_path / "sent" / sent.rows[0]["file"]) as arrays:
            assert arrays["guides"].shape[1] == 12
    finally:
        ray.shutdown()


def begin():
    """Starts Ray on this machine; a busy one may take longer than Ray waits."""
    for attempt in range(3):
        try:
            ray.init(address="local", num_cpus=1, include_dashboard=False, log_to_driver=False)
            return
        except Exception:
            ray.shutdown()
            if attempt == 2:
                raise


def apart(folder):
    """Writes files as ever, but for the one by which machines find that they share the folder."""
    from strandline import jobs

    write = jobs.write
    return lambda path, content: None if os.path.basename(path).startswith(".sweep") else write(path, content)


def test_a_cluster_that_is_not_there_is_said(tmp_path, quiet):
    with pytest.raises(Error, match="cluster is `127.0.0.1:1`"):
        sweep(SCENE, [{}], tmp_path, cluster="127.0.0.1:1")


if JOBS:

    def test_a_machine_is_lost_in_the_middle(tmp_path, quiet):
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
