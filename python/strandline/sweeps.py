"""Many simulations: samples over settings of a scene, one process each, stopped and resumed at will."""

from __future__ import annotations

import csv
import hashlib
import json
import os
import socket
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from itertools import product
from multiprocessing import get_context
from typing import Any

import numpy as np

from . import _native, _toml
from .errors import Error
from .progress import Progress
from .scene import Scene

#: What a job may keep.
KEPT = ("guides", "points", "picture", "mask", "camera")

#: Columns of the manifest beside those of the parameters.
COLUMNS = ("key", "state", "error", "strands", "points", "frames", "stretch_max", "penetration_max", "non_finite", "seconds", "host", "file", "hash")


@dataclass(frozen=True)
class Sweep:
    """The outcome of a sweep: rows of the manifest, failed samples among them."""

    folder: str
    rows: list[dict[str, Any]]

    @property
    def failed(self) -> list[dict[str, Any]]:
        """Rows of samples that failed, with their errors."""
        return [row for row in self.rows if row["state"] == "failed"]


def grid(values: Mapping[str, Sequence[Any]]) -> list[dict[str, Any]]:
    """Every combination of values: ``grid({"wind.velocity": [(0, 0, 0), (0, 0, 2)], "style.seed": [1, 2]})``."""
    return [dict(zip(values, chosen, strict=True)) for chosen in product(*values.values())]


def random(ranges: Mapping[str, Any], count: int, *, seed: int = 0) -> list[dict[str, Any]]:
    """Samples of ranges (least, most) or lists of words, at random by a seed: ``random({"wind.gust": (0.0, 1.0)}, 8)``."""
    generator = np.random.default_rng(seed)
    return [_sample(ranges, generator.random(len(ranges))) for _ in range(count)]


def sobol(ranges: Mapping[str, Any], count: int, *, seed: int = 0) -> list[dict[str, Any]]:
    """Samples of ranges as :func:`random`, spread evenly: the first points of a Sobol sequence with a random shift."""
    shift = np.random.default_rng(seed).random(len(ranges))
    return [_sample(ranges, (row + shift) % 1.0) for row in _sobol(count, len(ranges))]


#: Degrees, coefficients and first direction numbers of Sobol sequences [Joe & Kuo 2008], from the second dimension on.
_DIRECTIONS = (
    (1, 0, (1,)), (2, 1, (1, 3)), (3, 1, (1, 3, 1)), (3, 2, (1, 1, 1)), (4, 1, (1, 1, 3, 3)), (4, 4, (1, 3, 5, 13)),
    (5, 2, (1, 1, 5, 5, 17)), (5, 4, (1, 1, 5, 5, 5)), (5, 7, (1, 1, 7, 11, 19)), (5, 11, (1, 1, 5, 1, 1)),
    (5, 13, (1, 1, 1, 3, 11)), (5, 14, (1, 3, 5, 5, 31)), (6, 1, (1, 3, 3, 9, 7, 49)), (6, 13, (1, 1, 1, 15, 21, 21)),
    (6, 16, (1, 3, 1, 13, 27, 49)),
)  # fmt: skip


def _sobol(count: int, dimensions: int) -> np.ndarray[Any, Any]:
    if dimensions > len(_DIRECTIONS) + 1:
        raise Error(f"{dimensions} ranges, expected {len(_DIRECTIONS) + 1} at most: take random samples", "value")
    bits = 32
    directions = np.zeros((dimensions, bits), dtype=np.uint64)
    for dimension in range(dimensions):
        if dimension == 0:
            numbers = [1] * bits
        else:
            degree, coefficients, first = _DIRECTIONS[dimension - 1]
            numbers = list(first)
            for at in range(degree, bits):
                number = numbers[at - degree] ^ (numbers[at - degree] << degree)
                for k in range(1, degree):
                    if coefficients >> (degree - 1 - k) & 1:
                        number ^= numbers[at - k] << k
                numbers.append(number)
        directions[dimension] = [number << (bits - 1 - at) for at, number in enumerate(numbers[:bits])]
    points = np.zeros((count, dimensions))
    state = np.zeros(dimensions, dtype=np.uint64)
    for index in range(1, count):
        lowest = ((index & -index).bit_length()) - 1
        state ^= directions[:, lowest]
        points[index] = state / 2.0**bits
    return points


def _sample(ranges: Mapping[str, Any], shares: Any) -> dict[str, Any]:
    chosen = {}
    for (key, span), share in zip(ranges.items(), shares, strict=True):
        if len(span) == 2 and all(isinstance(end, int | float) and not isinstance(end, bool) for end in span):
            least, most = span
            value = least + (most - least) * float(share)
            chosen[key] = round(value) if all(isinstance(end, int) for end in span) else value
        else:
            chosen[key] = span[min(int(share * len(span)), len(span) - 1)]
    return chosen


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
    progress: bool | None = None,
) -> Sweep:
    """Runs a scene with each sample of settings, some at a time in processes of their own.

    ``samples`` are dictionaries of settings by key, as :func:`grid`, :func:`random` and :func:`sobol` make them. A job
    writes FOLDER/KEY.npz (``keep``: "guides" all frames, "points" the last frame alone, "picture", "mask" and "camera"
    of it) and FOLDER/KEY.json, its row. Keys that are there are skipped, so a sweep that was stopped is resumed by the
    same call; a sample that fails is a row with its error, and is tried again by the next call.
    ``manifest.csv`` holds all rows, and ``manifest.parquet`` where pyarrow is installed.
    """
    folder = os.path.abspath(os.fspath(folder))
    for name in keep:
        if name not in KEPT:
            raise Error(f"keep has `{name}`, expected some of {', '.join(KEPT)}", "value")
    os.makedirs(folder, exist_ok=True)
    jobs: dict[str, tuple[Any, ...]] = {}
    rows: dict[str, dict[str, Any]] = {}
    order: list[str] = []
    for sample in samples:
        try:
            own = scene.copy().update(sample)
        except Error as error:
            name = hashlib.sha256(json.dumps(_toml.plain(sample), sort_keys=True).encode()).hexdigest()[:32]
            rows[name] = _row(name, sample) | {"state": "failed", "error": str(error)}
            order.append(name)
            continue
        name = key(own, [*keep, *(["drape"] if drape else [])])
        order.append(name)
        done = _done(folder, name)
        if done is not None:
            rows[name] = done
        else:
            jobs[name] = (own, _toml.plain(dict(sample)), folder, name, tuple(keep), drape)
    order = list(dict.fromkeys(order))
    with Progress(len(order), "sweep", "job", progress) as bar:
        for row in _run(list(jobs.values()), workers, threads):
            rows[row["key"]] = row
            bar.show(len(rows))
    listed = [rows[name] for name in order if name in rows]
    _write_manifest(folder, listed)
    return Sweep(folder, listed)


def _row(name: str, sample: Mapping[str, Any]) -> dict[str, Any]:
    parameters = {f"parameter.{key}": value for key, value in sample.items()}
    return {column: None for column in COLUMNS} | {"key": name, "host": socket.gethostname()} | parameters


def _done(folder: str, name: str) -> dict[str, Any] | None:
    """The row of a job that is done."""
    try:
        with open(os.path.join(folder, f"{name}.json"), encoding="utf-8") as file:
            row: dict[str, Any] = json.load(file)
    except (OSError, ValueError):
        return None
    whole = row.get("state") == "done" and os.path.exists(os.path.join(folder, f"{name}.npz"))
    return row if whole else None


def _run(jobs: list[tuple[Any, ...]], workers: int | None, threads: int) -> Iterator[dict[str, Any]]:
    if not jobs:
        return
    count = min(workers or max((os.cpu_count() or 1) // max(threads, 1), 1), len(jobs))
    if workers == 0:
        yield from (_job(*job) for job in jobs)
        return
    before = os.environ.get("RAYON_NUM_THREADS")
    os.environ["RAYON_NUM_THREADS"] = str(threads)
    pool = ProcessPoolExecutor(count, mp_context=get_context("spawn"))
    try:
        # The processes begin with the first job.
        waiting: set[Future[dict[str, Any]]] = {pool.submit(_job, *job) for job in jobs}
        while waiting:
            finished, waiting = wait(waiting, return_when=FIRST_COMPLETED)
            for future in finished:
                try:
                    row = future.result()
                except BrokenProcessPool:
                    raise Error("a process of the sweep was ended from outside; the same call goes on with the samples that are left", "other") from None
                yield row
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
        if before is None:
            del os.environ["RAYON_NUM_THREADS"]
        else:
            os.environ["RAYON_NUM_THREADS"] = before


def _job(scene: Scene, sample: dict[str, Any], folder: str, name: str, keep: tuple[str, ...], drape: bool) -> dict[str, Any]:
    """Runs one job; its files are whole or not there."""
    begun, row = time.monotonic(), _row(name, sample)
    path = os.path.join(folder, f"{name}.npz")
    try:
        arrays, quality = _simulated(scene, keep, drape)
        part = os.path.join(folder, f".{name}.{os.getpid()}.npz")
        np.savez(part, **arrays)
        digest = hashlib.sha256()
        for array in sorted(arrays):
            digest.update(array.encode() + np.ascontiguousarray(arrays[array]).tobytes())
        os.replace(part, path)
        row |= quality | {"state": "done", "file": os.path.basename(path), "hash": digest.hexdigest()}
    except (Error, OSError, MemoryError) as error:
        row |= {"state": "failed", "error": str(error)}
    row["seconds"] = round(time.monotonic() - begun, 3)
    part = os.path.join(folder, f".{name}.{os.getpid()}.json")
    with open(part, "w", encoding="utf-8") as file:
        json.dump(row, file)
    os.replace(part, os.path.join(folder, f"{name}.json"))
    return row


def _simulated(scene: Scene, keep: tuple[str, ...], drape: bool) -> tuple[dict[str, Any], dict[str, Any]]:
    from .simulation import Simulation

    arrays: dict[str, Any] = {}
    with Simulation(scene) as simulation:
        heads, moments, worst = [], [], [0.0, 0.0, 0]
        if drape:
            simulation.drape()
        for frame in simulation.frames(0 if drape else None, progress=False):
            heads.append(simulation.head)
            if "guides" in keep:
                moments.append(frame.points.copy())
            for report in frame.reports:
                worst = [max(worst[0], report.stretch_max), max(worst[1], report.penetration_max), worst[2] + report.non_finite]
        last = simulation.points.copy()
        if "guides" in keep:
            arrays["guides"] = np.stack(moments or [last])
        if "points" in keep:
            arrays["points"] = last
        arrays["world_from_head"] = np.stack(heads or [simulation.head])
        if {"picture", "mask", "camera"} & set(keep):
            transparent: dict[str, Any] = {"transparent": True} if "mask" in keep else {}
            picture = simulation.picture(**transparent)
            if "picture" in keep:
                arrays["picture"] = picture.color
            if "mask" in keep:
                arrays["mask"] = picture.mask
            if "camera" in keep:
                arrays["view_from_world"] = picture.camera.view_from_world
                arrays["clip_from_view"] = picture.camera.clip_from_view(picture.width / picture.height)
        quality = {
            "strands": simulation.strand_count,
            "points": simulation.points_per_strand,
            "frames": len(heads),
            "stretch_max": float(worst[0]),
            "penetration_max": float(worst[1]),
            "non_finite": int(worst[2]),
        }
    return arrays, quality


def _write_manifest(folder: str, rows: list[dict[str, Any]]) -> None:
    columns = list(dict.fromkeys(column for row in rows for column in row)) or list(COLUMNS)
    part = os.path.join(folder, f".manifest.{os.getpid()}.csv")
    with open(part, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, columns)
        writer.writeheader()
        writer.writerows(rows)
    os.replace(part, os.path.join(folder, "manifest.csv"))
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        return
    texts = [{column: _cell(row.get(column)) for column in columns} for row in rows]
    pyarrow.parquet.write_table(pyarrow.Table.from_pylist(texts), os.path.join(folder, "manifest.parquet"))


def _cell(value: Any) -> Any:
    return json.dumps(value) if isinstance(value, list | tuple | dict) else value
