"""Many simulations: samples over settings of a scene, on this machine, on a cluster or a render farm, stopped and resumed
at will."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
import socket
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from . import _arrays, _native, _toml, jobs
from .errors import Error, missing
from .jobs import KEPT, Job
from .progress import Progress
from .samplers import grid, random, sobol
from .scene import Scene

if TYPE_CHECKING:
    from concurrent.futures import Future, ProcessPoolExecutor

__all__ = ["KEPT", "Sweep", "grid", "key", "random", "sobol", "sweep"]


@dataclass(frozen=True)
class Sweep:
    """The outcome of a sweep: rows of the manifest, failed samples among them."""

    folder: str
    rows: list[dict[str, Any]]

    @property
    def failed(self) -> list[dict[str, Any]]:
        """Rows of samples that failed, with their errors."""
        return [row for row in self.rows if row["state"] == "failed"]


def key(scene: Scene, keep: Sequence[str] = ("guides",)) -> str:
    """The key of a job: a hash of the whole scene, of what is kept, and of the version."""
    content = json.dumps([_native.__version__, scene.to_toml(), scene.folder, sorted(keep)])
    return hashlib.sha256(content.encode()).hexdigest()[:32]


def sweep(
    scene: Scene,
    samples: Sequence[Mapping[str, Any]],
    folder: str | os.PathLike[str],
    *,
    keep: Sequence[str] = ("guides",),
    drape: bool = False,
    workers: int | None = None,
    threads: int = 1,
    cluster: str | None = None,
    gpus: float | None = None,
    progress: bool | None = None,
) -> Sweep:
    """Runs a scene with each sample of settings, some at a time in processes of their own.

    ``samples`` are dictionaries of settings by key, as :func:`grid`, :func:`random` and :func:`sobol` make them. A job
    writes FOLDER/KEY.npz and FOLDER/KEY.json, its row. ``keep`` is some of: "guides" and "strands" (all that is drawn) of
    all frames; "points", the guides of the last frame alone; "picture", "mask" and "camera" of the last frame, and its
    channels "light", "depth", "hair_mask", "direction", "tangents", "normals" and "strand_ids". Keys that are there are
    skipped, so a sweep that was stopped is resumed by the same call; a sample that fails is a row with its error, and is
    tried again by the next call. ``manifest.csv`` holds all rows, and ``manifest.parquet`` where pyarrow is installed.

    Without ``cluster`` jobs are processes of this machine, ``workers`` at a time, or run in this process with 0 workers.
    ``cluster`` runs them on Ray, with the extra [sweep]: ``"local"`` starts it on this machine, ``"auto"`` or an address
    joins one that runs. A job takes ``threads`` CPUs, and as many GPUs as ``gpus`` says: by default one where its scene
    names a GPU as a device. A cluster whose machines do not share the folder sends the files to this one.
    """
    if not isinstance(scene, Scene):
        raise Error(f"scene is a {type(scene).__name__}, expected a Scene: Scene.load(path) reads one", "value")
    folder = os.path.abspath(os.fspath(folder))
    check(keep, threads)
    workers = None if workers is None else _arrays.count(workers, "workers")
    if cluster is not None:
        _ray()
    os.makedirs(folder, exist_ok=True)
    todo, rows, order = plan(scene, samples, folder, keep, drape)
    with Progress(len(order), "sweep", "job", progress) as bar:
        made = _on_ray(todo, folder, threads, cluster, gpus) if cluster is not None else _local(todo, folder, workers, threads)
        for row in made:
            rows[row["key"]] = row
            bar.show(len(rows))
    listed = [rows[name] for name in order if name in rows]
    write_manifest(folder, listed)
    return Sweep(folder, listed)


def check(keep: Sequence[str], threads: int) -> None:
    """Refuses what cannot be kept."""
    if isinstance(keep, str):
        raise Error(f"keep is `{keep}`, expected a list: ({keep!r},)", "value")
    for name in keep:
        if name not in KEPT:
            raise Error(f"keep has `{name}`, expected some of {', '.join(KEPT)}", "value")
    _arrays.count(threads, "threads", 1)


def plan(
    scene: Scene, samples: Sequence[Mapping[str, Any]], folder: str, keep: Sequence[str], drape: bool
) -> tuple[list[Job], dict[str, dict[str, Any]], list[str]]:
    """Jobs that are left, rows of the others by key, and the keys in the order of the samples."""
    todo: dict[str, Job] = {}
    rows: dict[str, dict[str, Any]] = {}
    order: list[str] = []
    for sample in samples:
        own = scene.copy()
        try:
            own.update(sample)
        except Error as error:
            name = hashlib.sha256(json.dumps(_toml.plain(sample), sort_keys=True).encode()).hexdigest()[:32]
            rows[name] = jobs.row(name, sample) | {"state": "failed", "error": str(error)}
            order.append(name)
            continue
        name = key(own, [*keep, *(["drape"] if drape else [])])
        order.append(name)
        done = jobs.done(folder, name)
        if done is not None:
            rows[name] = done
        else:
            todo[name] = Job(own, _toml.plain(dict(sample)), name, tuple(keep), drape)
    return list(todo.values()), rows, list(dict.fromkeys(order))


def _local(todo: list[Job], folder: str, workers: int | None, threads: int) -> Iterator[dict[str, Any]]:
    """Runs jobs in processes of this machine."""
    # With the package they would take a tenth of the time of its import.
    from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
    from concurrent.futures.process import BrokenProcessPool
    from multiprocessing import get_context

    if not todo:
        return
    count = min(workers or max((os.cpu_count() or 1) // threads, 1), len(todo))
    if workers == 0:
        yield from (jobs.run(job, folder) for job in todo)
        return
    before = os.environ.get("RAYON_NUM_THREADS")
    os.environ["RAYON_NUM_THREADS"] = str(threads)
    pool = ProcessPoolExecutor(count, mp_context=get_context("spawn"))
    try:
        # The processes begin with the first jobs.
        waiting: set[Future[dict[str, Any]]] = {_submitted(pool, job, folder) for job in todo}
        while waiting:
            finished, waiting = wait(waiting, return_when=FIRST_COMPLETED)
            for future in finished:
                yield future.result()
    except BrokenProcessPool:
        # One that began while another ended is not among those that a broken pool ends, which then waits for it without end.
        for process in list((getattr(pool, "_processes", None) or {}).values()):
            process.kill()
        raise Error("a process of the sweep was ended from outside; the same call goes on with the samples that are left", "other") from None
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
        if before is None:
            del os.environ["RAYON_NUM_THREADS"]
        else:
            os.environ["RAYON_NUM_THREADS"] = before


def _submitted(pool: ProcessPoolExecutor, job: Job, folder: str) -> Future[dict[str, Any]]:
    """The future row of a job."""
    from concurrent.futures.process import BrokenProcessPool

    try:
        return pool.submit(jobs.run, job, folder)
    except Exception as error:
        # A pool that breaks closes its pipes, also those of a process that it begins at that moment.
        if getattr(pool, "_broken", False):
            raise BrokenProcessPool from error
        raise


#: Runs of a job on a cluster whose machine is lost meanwhile, beside the first.
_RETRIES = 3


def _ray() -> Any:
    """The module of Ray."""
    try:
        import ray
    except ImportError:
        raise missing("ray", "sweep") from None
    return ray


def _on_ray(todo: list[Job], folder: str, threads: int, cluster: str | None, gpus: float | None) -> Iterator[dict[str, Any]]:
    """Runs jobs as tasks of Ray. A task whose machine is lost runs again on another."""
    if not todo:
        return
    ray = _ray()
    joined = not ray.is_initialized()
    if joined:
        _reach(cluster)
        try:
            ray.init(address=cluster, include_dashboard=False if cluster == "local" else None, log_to_driver=False)
        except (ConnectionError, ValueError, RuntimeError) as error:
            raise Error(f"cluster is `{cluster}`, expected \"local\", \"auto\" or the address of one that runs: {error}", "value") from None
    # Machines that find this file share the folder.
    marker = os.path.join(folder, f".sweep.{os.getpid()}")
    try:
        jobs.write(marker, b"")
        task = ray.remote(max_retries=_RETRIES)(_task)
        waiting = {}
        for job in todo:
            one = task.options(num_cpus=threads, num_gpus=_gpus(job.scene) if gpus is None else gpus)
            waiting[one.remote(job, folder, marker, threads)] = job
        while waiting:
            finished, _ = ray.wait(list(waiting), num_returns=1)
            job = waiting.pop(finished[0])
            try:
                row, content = ray.get(finished[0])
            except ray.exceptions.RayError as error:
                yield jobs.keep(jobs.failed(job, f"its process was lost: {type(error).__name__}"), None, folder)
                continue
            yield row if content is None and row["state"] == "done" else jobs.keep(row, content, folder)
    finally:
        if os.path.exists(marker):
            os.remove(marker)
        if joined:
            ray.shutdown()


def _reach(cluster: str | None) -> None:
    """Refuses an address where nobody answers: Ray would try for minutes."""
    host, _, port = (cluster or "").removeprefix("ray://").rpartition(":")
    if not host or not port.isdecimal():
        return
    try:
        socket.create_connection((host, int(port)), timeout=10).close()
    except OSError as error:
        raise Error(f"cluster is `{cluster}`, where nobody answers ({error}), expected \"local\", \"auto\" or the address of one that runs", "value") from None


def _gpus(scene: Scene) -> float:
    """GPUs of a job: one where its scene names one."""
    return 1.0 if any(str(scene[f"devices.{what}"]).startswith("gpu") for what in ("simulation", "pictures")) else 0.0


def _task(job: Job, folder: str, marker: str, threads: int) -> tuple[dict[str, Any], bytes | None]:
    """A job on a machine of a cluster: its row, and its arrays where the folder is not shared."""
    os.environ["RAYON_NUM_THREADS"] = str(threads)
    if os.path.exists(marker):
        return jobs.run(job, folder), None
    return jobs.simulated(job)


def write_manifest(folder: str, rows: list[dict[str, Any]]) -> None:
    """Writes the rows of all samples as manifest.csv, and as manifest.parquet where pyarrow is installed."""
    columns = list(dict.fromkeys(column for row in rows for column in row)) or list(jobs.COLUMNS)
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, columns)
    writer.writeheader()
    writer.writerows(rows)
    jobs.write(os.path.join(folder, "manifest.csv"), text.getvalue().encode())
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        return
    table = pyarrow.table({column: _column([row.get(column) for row in rows]) for column in columns})
    packed = io.BytesIO()
    pyarrow.parquet.write_table(table, packed)
    jobs.write(os.path.join(folder, "manifest.parquet"), packed.getvalue())


def _column(values: list[Any]) -> list[Any]:
    """Values of one kind: numbers, truths or texts."""
    kinds = {type(value) for value in values if value is not None}
    if kinds <= {int, float} and len(kinds) > 1:
        return [None if value is None else float(value) for value in values]
    if len(kinds) > 1 or kinds & {list, tuple, dict}:
        return [None if value is None else value if isinstance(value, str) else json.dumps(value) for value in values]
    return values
