"""Sweeps: samples, keys, resuming, failures."""

import json
import multiprocessing
import os
import signal
import sys
import threading
import time

import numpy as np
import pytest

from strandline import Error, Scene, sweep, sweeps

SCENE = Scene(style={"style": "pixie", "strand_count": 12}, film={"frames": 2}, devices={"simulation": "cpu", "pictures": "cpu"}, picture={"width": 24, "height": 24})


def test_samples_are_grids_and_spread_evenly():
    assert len(sweeps.grid({"style.seed": [1, 2], "film.frames": [1, 2, 3]})) == 6
    spread = np.array([[sample["a"], sample["b"]] for sample in sweeps.sobol({"a": (0.0, 1.0), "b": (0.0, 1.0)}, 64)])
    counts, _, _ = np.histogram2d(spread[:, 0], spread[:, 1], bins=4, range=[[0, 1], [0, 1]])
    assert counts.min() >= 2, "a random sample leaves cells of the grid with fewer"
    one, other = sweeps.random({"a": (0, 9), "w": ["x", "y"]}, 5, seed=1), sweeps.random({"a": (0, 9), "w": ["x", "y"]}, 5, seed=1)
    assert one == other and all(isinstance(sample["a"], int) and sample["w"] in "xy" for sample in one)


def test_a_sweep_keeps_rows_resumes_and_reports_failures(tmp_path):
    samples = [*sweeps.grid({"style.seed": [1, 2]}), {"film.frames": 0}, {"style.sede": 1}]
    keep = ("guides", "picture", "mask", "camera")
    done = sweep(SCENE, samples, tmp_path, keep=keep, workers=0)
    assert [row["state"] for row in done.rows] == ["done", "done", "failed", "failed"]
    assert "film.frames" in done.failed[0]["error"] and "`style.seed`" in done.failed[1]["error"]
    assert done.rows[0]["key"] != done.rows[1]["key"] and done.rows[0]["hash"] != done.rows[1]["hash"]
    with np.load(tmp_path / done.rows[0]["file"]) as arrays:
        assert arrays["guides"].shape[:2] == (2, 12) and arrays["world_from_head"].shape == (2, 4, 4)
        assert arrays["picture"].shape == (24, 24, 3) and arrays["mask"].shape == (24, 24)
        assert arrays["view_from_world"].shape == (4, 4)
    stamps = {path.name: path.stat().st_mtime_ns for path in tmp_path.glob("*.npz")}
    (tmp_path / f"{done.rows[1]['key']}.npz").unlink()
    again = sweep(SCENE, samples, tmp_path, keep=keep, workers=0)
    assert [row["hash"] for row in again.rows] == [row["hash"] for row in done.rows]
    kept = tmp_path / done.rows[0]["file"]
    assert kept.stat().st_mtime_ns == stamps[kept.name], "nothing is done twice but what was lost"
    manifest = (tmp_path / "manifest.csv").read_text()
    assert manifest.count("\n") == 5 and "parameter.style.seed" in manifest
    assert json.loads((tmp_path / f"{done.rows[0]['key']}.json").read_text())["state"] == "done"


def test_other_processes_and_threads_make_the_same_hashes(tmp_path):
    samples = sweeps.grid({"style.seed": [1, 2]})
    here = sweep(SCENE, samples, tmp_path / "here", workers=0)
    there = sweep(SCENE, samples, tmp_path / "there", workers=2, threads=1)
    assert [row["hash"] for row in here.rows] == [row["hash"] for row in there.rows]


@pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
def test_a_process_that_is_ended_is_said_and_the_rest_goes_on(tmp_path):
    def end_one():
        while not (children := multiprocessing.active_children()):
            time.sleep(0.01)
        os.kill(children[0].pid, signal.SIGKILL)

    samples = sweeps.grid({"style.seed": [1, 2]})
    ending = threading.Thread(target=end_one)
    ending.start()
    with pytest.raises(Error, match="the same call goes on"):
        sweep(SCENE, samples, tmp_path, workers=2)
    ending.join()
    assert [row["state"] for row in sweep(SCENE, samples, tmp_path, workers=0).rows] == ["done", "done"]


@pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
def test_a_process_that_begins_while_another_is_ended_is_not_waited_for(tmp_path, monkeypatch):
    from concurrent.futures import ProcessPoolExecutor

    class Late(dict):
        """The processes of a pool: the second comes among them after the pool has ended those that it knew."""

        def __setitem__(self, pid, process):
            if self:
                os.kill(next(iter(self)), signal.SIGKILL)
                until = time.monotonic() + 20
                while not self.pool._call_queue._reader.closed and time.monotonic() < until:
                    time.sleep(0.01)
            super().__setitem__(pid, process)

    begin = ProcessPoolExecutor.__init__

    def begin_late(pool, *words, **more):
        begin(pool, *words, **more)
        pool._processes = Late()
        pool._processes.pool = pool

    monkeypatch.setattr(ProcessPoolExecutor, "__init__", begin_late)
    with pytest.raises(Error, match="the same call goes on"):
        sweep(SCENE, sweeps.grid({"style.seed": [1, 2]}), tmp_path, workers=2)


@pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
def test_pipes_that_a_broken_pool_closes_are_a_broken_pool(tmp_path, monkeypatch):
    from concurrent.futures import ProcessPoolExecutor

    begin = ProcessPoolExecutor._spawn_process

    def begin_late(pool):
        if pool._processes:
            os.kill(next(iter(pool._processes)), signal.SIGKILL)
            until = time.monotonic() + 20
            while not pool._call_queue._reader.closed and time.monotonic() < until:
                time.sleep(0.01)
            # A Python that closes nothing before this ends has no such error.
            if pool._call_queue._reader.closed:
                raise ValueError("bad value(s) in fds_to_keep")
        begin(pool)

    monkeypatch.setattr(ProcessPoolExecutor, "_spawn_process", begin_late)
    with pytest.raises(Error, match="the same call goes on"):
        sweep(SCENE, sweeps.grid({"style.seed": [1, 2]}), tmp_path, workers=2)


def test_an_error_of_a_pool_that_is_whole_is_told(tmp_path, monkeypatch):
    from concurrent.futures import ProcessPoolExecutor

    def none(pool):
        raise OSError("no more processes")

    monkeypatch.setattr(ProcessPoolExecutor, "_spawn_process", none)
    with pytest.raises(OSError, match="no more processes"):
        sweep(SCENE, sweeps.grid({"style.seed": [1, 2]}), tmp_path, workers=2)


def test_draped_hair_is_one_moment(tmp_path):
    done = sweep(SCENE, [{"style.seed": 1}], tmp_path, keep=("points",), drape=True, workers=0)
    with np.load(tmp_path / done.rows[0]["file"]) as arrays:
        assert arrays["points"].shape[0] == 12


def test_a_cluster_without_ray_is_refused_before_anything_is_made(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(Error, match="strandline.sweep") as caught:
        sweep(SCENE, [{"style.seed": 1}], tmp_path / "made", cluster="local")
    assert caught.value.kind == "extra" and not (tmp_path / "made").exists()


def test_what_cannot_be_kept_is_refused(tmp_path):
    with pytest.raises(Error, match="keep has `depht`"):
        sweep(SCENE, [{}], tmp_path, keep=("depht",))
