"""Pictures and cameras."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native

Vector = Sequence[float]


@dataclass(frozen=True)
class Camera:
    """A perspective camera: position and target [m], world space, and the vertical field of view [degrees]."""

    position: Vector = (0.0, -0.07, 1.05)
    target: Vector = (0.0, -0.07, 0.0)
    up: Vector = (0.0, 1.0, 0.0)
    field_of_view: float = 30.0
    near: float = 0.01

    @classmethod
    def framing(cls, points: ArrayLike, view: str = "three_quarter", aspect: float = 1.0) -> Camera:
        """A camera that sees all of some points [m] from a side: front, three_quarter, side or back."""
        places = np.ascontiguousarray(points, dtype=np.float32).reshape(-1, 3)
        return cls(*_native.view(view, places, aspect))

    @property
    def _parts(self) -> tuple[Any, ...]:
        vectors = ([float(part) for part in vector] for vector in (self.position, self.target, self.up))
        return (*vectors, float(self.field_of_view), float(self.near))

    @property
    def view_from_world(self) -> NDArray[np.float32]:
        """The 4 x 4 matrix from world space to view space: x right, y up, looking along -z."""
        return np.asarray(_native.camera_matrices(self._parts, 1.0)[0], dtype=np.float32)

    def clip_from_view(self, aspect: float) -> NDArray[np.float32]:
        """The 4 x 4 matrix from view space to clip space for a width over height; depth is 1 near and 0 at infinity."""
        return np.asarray(_native.camera_matrices(self._parts, aspect)[1], dtype=np.float32)


@dataclass(frozen=True)
class Picture:
    """A picture: ``pixels``, 8-bit sRGB, shape (row, column, 3), or 4 with opacity. Notebooks show it."""

    pixels: NDArray[np.uint8]
    camera: Camera = field(default_factory=Camera)

    @property
    def width(self) -> int:
        """Columns."""
        return int(self.pixels.shape[1])

    @property
    def height(self) -> int:
        """Rows."""
        return int(self.pixels.shape[0])

    @property
    def color(self) -> NDArray[np.uint8]:
        """Colours alone, shape (row, column, 3), a view."""
        return self.pixels[:, :, :3]

    @property
    def mask(self) -> NDArray[np.uint8] | None:
        """Opacity of what is drawn, shape (row, column); None without ``transparent=True``."""
        return self.pixels[:, :, 3] if self.pixels.shape[2] == 4 else None

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a .png, which is whole or not there."""
        _native.save_png(np.ascontiguousarray(self.pixels), os.fspath(path))

    def png(self) -> bytes:
        """The bytes of a .png."""
        return _native.png(np.ascontiguousarray(self.pixels))

    def _repr_png_(self) -> bytes:
        return self.png()

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(self.pixels, dtype=dtype, copy=bool(copy))

    def __repr__(self) -> str:
        return f"Picture({self.width} x {self.height})"
