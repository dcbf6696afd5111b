"""Jobs of a sweep: a scene with one sample of settings, simulated, and its files."""

from __future__ import annotations

import hashlib
import io
import json
import os
import socket
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import Error
from .scene import Scene

if TYPE_CHECKING:
    from .picture import Picture
    from .simulation import Simulation

#: Channels of pictures that a job may keep, by their names as properties of a picture.
CHANNELS = ("light", "depth", "hair_mask", "direction", "tangents", "normals", "strand_ids")

#: All that a job may keep.
KEPT = ("guides", "strands", "points", "picture", "mask", "camera", *CHANNELS)

#: Columns of the manifest beside those of the parameters.
COLUMNS = ("key", "state", "error", "strands", "points", "frames", "stretch_max", "penetration_max", "non_finite", "seconds", "host", "file", "hash")


@dataclass(frozen=True)
class Job:
    """Work of one process: plain data."""

    scene: Scene
    sample: dict[str, Any]
    key: str
    keep: tuple[str, ...]
    drape: bool

    def to_json(self) -> str:
        """The job as a text that any process can run."""
        of = {"scene": self.scene.given, "folder": self.scene.folder, "sample": self.sample, "key": self.key, "keep": self.keep, "drape": self.drape}
        return json.dumps(of, indent=1)

    @classmethod
    def from_json(cls, text: str) -> Job:
        """The job of such a text."""
        of = json.loads(text)
        scene = Scene(of["scene"])
        scene.folder = of["folder"]
        return cls(scene, of["sample"], of["key"], tuple(of["keep"]), of["drape"])


def row(key: str, sample: Mapping[str, Any]) -> dict[str, Any]:
    """The row of a job that has not begun."""
    parameters = {f"parameter.{name}": value for name, value in sample.items()}
    return {column: None for column in COLUMNS} | {"key": key, "host": socket.gethostname()} | parameters


def done(folder: str, key: str) -> dict[str, Any] | None:
    """The row of a job that is done."""
    try:
        with open(os.path.join(folder, f"{key}.json"), encoding="utf-8") as file:
            found: dict[str, Any] = json.load(file)
    except (OSError, ValueError):
        return None
    whole = found.get("state") == "done" and os.path.exists(os.path.join(folder, f"{key}.npz"))
    return found if whole else None


def failed(job: Job, error: str) -> dict[str, Any]:
    """The row of a job that failed."""
    return row(job.key, job.sample) | {"state": "failed", "error": error}


def run(job: Job, folder: str) -> dict[str, Any]:
    """Runs a job that is not done yet and writes its files; returns its row."""
    found = done(folder, job.key)
    if found is not None:
        return found
    own, content = simulated(job)
    return keep(own, content, folder)


def simulated(job: Job) -> tuple[dict[str, Any], bytes | None]:
    """The row of a job and the bytes of its arrays; none where it failed."""
    begun = time.monotonic()
    own: dict[str, Any] = row(job.key, job.sample)
    content = None
    try:
        arrays, quality = _arrays(job)
        digest = hashlib.sha256()
        for array in sorted(arrays):
            digest.update(array.encode() + np.ascontiguousarray(arrays[array]).tobytes())
        packed = io.BytesIO()
        np.savez(packed, **arrays)
        content = packed.getvalue()
        own |= quality | {"state": "done", "file": f"{job.key}.npz", "hash": digest.hexdigest()}
    except (Error, OSError, MemoryError) as error:
        own |= {"state": "failed", "error": str(error)}
    own["seconds"] = round(time.monotonic() - begun, 3)
    return own, content


def keep(own: dict[str, Any], content: bytes | None, folder: str) -> dict[str, Any]:
    """Writes the files of a job, each of which is whole or not there; a full disk is an error in its row."""
    try:
        if content is not None:
            write(os.path.join(folder, f"{own['key']}.npz"), content)
    except OSError as error:
        own = own | {"state": "failed", "error": str(error), "file": None, "hash": None}
    write(os.path.join(folder, f"{own['key']}.json"), json.dumps(own).encode())
    return own


def write(path: str, content: bytes) -> None:
    """Writes a file beside its name, then gives it the name."""
    folder, name = os.path.split(path)
    part = os.path.join(folder, f".{socket.gethostname()}.{os.getpid()}.{name}")
    try:
        with open(part, "wb") as file:
            file.write(content)
        os.replace(part, path)
    finally:
        if os.path.exists(part):
            os.remove(part)


def _arrays(job: Job) -> tuple[dict[str, Any], dict[str, Any]]:
    from .simulation import Simulation

    arrays: dict[str, Any] = {}
    with Simulation(job.scene) as simulation:
        heads, moments, worst = [], [], [0.0, 0.0, 0]
        if job.drape:
            simulation.drape()
        strands = _Strands(simulation, "strands" in job.keep)
        for frame in simulation.frames(0 if job.drape else None, progress=False):
            heads.append(simulation.head)
            strands.add()
            if "guides" in job.keep:
                moments.append(frame.points.copy())
            for report in frame.reports:
                worst = [max(worst[0], report.stretch_max), max(worst[1], report.penetration_max), worst[2] + report.non_finite]
        arrays |= strands.arrays(job.drape)
        last = simulation.points.copy()
        if "guides" in job.keep:
            arrays["guides"] = np.stack(moments or [last])
        if "points" in job.keep:
            arrays["points"] = last
        arrays["world_from_head"] = np.stack(heads or [simulation.head])
        drawn = {"picture", "mask", "camera", *CHANNELS} & set(job.keep)
        if drawn:
            settings: dict[str, Any] = {"transparent": True} if "mask" in drawn else {}
            settings |= {"layers": True} if drawn & set(CHANNELS) else {}
            arrays |= _drawn(simulation.picture(**settings), drawn)
        quality = {
            "strands": simulation.strand_count,
            "points": simulation.points_per_strand,
            "frames": len(heads),
            "stretch_max": float(worst[0]),
            "penetration_max": float(worst[1]),
            "non_finite": int(worst[2]),
        }
    return arrays, quality


def _drawn(picture: Picture, wanted: set[str]) -> dict[str, Any]:
    """The arrays of a picture that are kept."""
    arrays: dict[str, Any] = {name: getattr(picture, name) for name in CHANNELS if name in wanted}
    if "picture" in wanted:
        arrays["picture"] = picture.color
    if "mask" in wanted:
        arrays["mask"] = picture.mask
    if "camera" in wanted:
        arrays["view_from_world"] = picture.camera.view_from_world
        arrays["clip_from_view"] = picture.camera.clip_from_view(picture.width / picture.height)
    return arrays


class _Strands:
    """All drawn strands of each frame, which a moving cache in a folder of its own gathers."""

    def __init__(self, simulation: Simulation, wanted: bool) -> None:
        self._simulation = simulation
        self._folder = tempfile.TemporaryDirectory(prefix="strandline-") if wanted else None
        self._path = ""
        if self._folder is not None:
            self._path = os.path.join(self._folder.name, "strands.npz")
            simulation._native.begin_file(self._path, "strands", "any", 1)

    def add(self) -> None:
        """Adds the frame of the moment."""
        if self._folder is not None:
            self._simulation._native.write_frame()

    def arrays(self, moment: bool) -> dict[str, Any]:
        """Points [m] of all strands, shape (frame, point, 3), and the first point of each; ``moment`` adds this one first."""
        if self._folder is None:
            return {}
        with self._folder:
            if moment:
                self.add()
            self._simulation._native.end_file()
            with np.load(self._path) as found:
                return {"strands": found["points"], "strand_starts": found["starts"]}
