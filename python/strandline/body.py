"""Bodies that hair grows on and hits."""

from __future__ import annotations

import os
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _extras, _native
from .errors import Error


class Body:
    """A triangle mesh, head space [m], y up: ``Body(vertices, faces)``, of shapes (n, 3).

    ``motion`` holds its vertices over time, shape (frame, n, 3), at ``frames_per_second``: then the body moves with
    every frame of a simulation. ``teleports`` are times [s] of the motion at which the body is elsewhere at once: hair is
    carried there instead of being pulled, and nothing is interpolated over them. Plain data: it can be pickled.
    """

    vertices: NDArray[np.float32]
    faces: NDArray[np.uint32]
    notes: list[str]

    def __init__(
        self,
        vertices: ArrayLike,
        faces: ArrayLike,
        *,
        motion: ArrayLike | None = None,
        frames_per_second: float = 24.0,
        teleports: ArrayLike = (),
        notes: Sequence[str] = (),
    ) -> None:
        self.vertices = _arrays.numbers(vertices, "vertices", "(n, 3)")
        if self.vertices.ndim != 2 or self.vertices.shape[1] != 3:
            raise Error(f"vertices has the shape {self.vertices.shape}, expected (n, 3)", "value")
        self.faces = _arrays.numbers(faces, "faces", "(n, 3)", np.uint32)
        if self.faces.ndim != 2 or self.faces.shape[1] != 3:
            raise Error(f"faces has the shape {self.faces.shape}, expected (n, 3): triangles", "value")
        if self.faces.size and self.faces.max() >= len(self.vertices):
            raise Error(f"faces has the index {self.faces.max()}, expected 0 to {len(self.vertices) - 1}, one of the vertices", "value")
        self.motion: NDArray[np.float32] | None = None
        if motion is not None:
            moving = _arrays.numbers(motion, "motion", f"(frame, {len(self.vertices)}, 3)")
            if moving.ndim != 3 or len(moving) == 0 or moving.shape[1:] != self.vertices.shape:
                raise Error(f"motion has the shape {moving.shape}, expected (frame, {len(self.vertices)}, 3)", "value")
            self.motion = moving
        self.frames_per_second = _arrays.number(frames_per_second, "frames_per_second", "a number above 0", 1e-9, 1e9)
        marks = _arrays.numbers(teleports, "teleports", "(n,)", np.float64)
        if marks.ndim != 1 or not np.isfinite(marks).all():
            raise Error("teleports is no list of finite times, expected times of the motion [s]", "value")
        if len(marks) and self.motion is None:
            raise Error("teleports are marks of a body without a motion, expected `motion` too", "value")
        self.teleports: list[float] = sorted(set(marks.tolist()))
        self.notes = list(notes)

    @classmethod
    def load(cls, path: str | os.PathLike[str], scale: float = 1.0) -> Body:
        """Reads a mesh of an .obj, .gltf, .glb, .vrm, .ply or .stl, or with its motion by the extras [usd] and [abc] of a
        .usd or .abc; ``scale`` is metres for each unit of the file, which a .usd says itself."""
        path = os.fspath(path)
        scale = _arrays.number(scale, "scale", "a number above 0 [m]", 1e-9, 1e9)
        if _extras.suffix(path) in _extras.BODIES:
            return _extras.body(path, scale)
        vertices, faces, notes = _native.load_mesh(path, scale)
        return cls(vertices, faces, notes=notes)

    @classmethod
    def mannequin(cls) -> Body:
        """The built-in bust as one rigid mesh. The bust of a scene without a body is the same, and its neck bends
        under ``motion.neck``."""
        vertices, faces, _ = _native.mannequin()
        return cls(vertices, faces)

    def at(self, time: float) -> NDArray[np.float32]:
        """Vertices at a time [s], between frames on straight lines; those at rest without a motion."""
        if self.motion is None:
            return self.vertices
        time = _arrays.number(time, "time", "a number [s]")
        place = float(np.clip(time * self.frames_per_second, 0, len(self.motion) - 1))
        low = min(int(place), len(self.motion) - 1)
        high = min(low + 1, len(self.motion) - 1)
        share = np.float32(place - low)
        marks = [mark for mark in self.teleports if low < mark * self.frames_per_second <= high]
        if marks:
            share = np.float32(time >= marks[0])
        if share == 0 or low == high:
            return np.asarray(self.motion[low])
        return np.asarray(self.motion[low] * (1 - share) + self.motion[high] * share)

    def __repr__(self) -> str:
        moves = "" if self.motion is None else f", {len(self.motion)} frames"
        return f"Body({len(self.vertices)} vertices, {len(self.faces)} faces{moves})"
