"""Pictures and cameras."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _native
from .errors import Error

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
        places = _arrays.numbers(points, "points", "(..., 3)")
        if places.ndim < 2 or places.shape[-1] != 3 or places.size == 0 or not np.all(np.isfinite(places)):
            raise Error(f"points has the shape {places.shape}, expected (..., 3), one point or more, all finite", "value")
        return cls(*_native.view(view, places.reshape(-1, 3), _aspect(aspect)))

    @property
    def _parts(self) -> tuple[Any, ...]:
        vectors = []
        for name in ("position", "target", "up"):
            vector = _arrays.numbers(getattr(self, name), f"camera.{name}", "(3,)")
            if vector.shape != (3,):
                raise Error(f"camera.{name} has the shape {vector.shape}, expected (3,)", "value")
            vectors.append(vector.tolist())
        lens = (_arrays.number(getattr(self, name), f"camera.{name}", "a number") for name in ("field_of_view", "near"))
        return (*vectors, *lens)

    @property
    def view_from_world(self) -> NDArray[np.float32]:
        """The 4 x 4 matrix from world space to view space: x right, y up, looking along -z."""
        return np.asarray(_native.camera_matrices(self._parts, 1.0)[0], dtype=np.float32)

    def clip_from_view(self, aspect: float) -> NDArray[np.float32]:
        """The 4 x 4 matrix from view space to clip space for a width over height; depth is 1 near and 0 at infinity."""
        return np.asarray(_native.camera_matrices(self._parts, _aspect(aspect))[1], dtype=np.float32)


def _aspect(of: float) -> float:
    return _arrays.number(of, "aspect", "a width over a height above 0", 1e-6, 1e6)


@dataclass(frozen=True)
class Picture:
    """A picture: ``pixels``, 8-bit sRGB, shape (row, column, 3), or 4 with opacity. Notebooks show it.

    A picture with ``layers=True`` has ``channels`` too, arrays of shape (row, column) by name, on a CPU and on a GPU
    alike: ``R``, ``G``, ``B``, ``A``, ``depth.Z``, ``mask.hair``, ``tangent.X``, ``tangent.Y``, ``tangent.Z``,
    ``motion.X``, ``motion.Y`` and ``strand.id``. Its properties show them by their use.
    """

    pixels: NDArray[np.uint8]
    camera: Camera = field(default_factory=Camera)
    channels: dict[str, NDArray[np.float32]] | None = None

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

    # Channels

    def _channel(self, *names: str) -> NDArray[np.float32]:
        if self.channels is None:
            raise Error("the picture has no channels, expected simulation.picture(layers=True)", "value")
        own = [self.channels[name] for name in names]
        return own[0] if len(own) == 1 else np.asarray(np.stack(own, axis=-1))

    @property
    def light(self) -> NDArray[np.float32]:
        """Radiance, linear RGB before exposure and tone map, times opacity, shape (row, column, 3)."""
        return self._channel("R", "G", "B")

    @property
    def depth(self) -> NDArray[np.float32]:
        """Distance along the view [m], shape (row, column): of the hair where it covers half of a pixel, else of the body;
        infinite where neither is."""
        return self._channel("depth.Z")

    @property
    def hair_mask(self) -> NDArray[np.float32]:
        """Share of each pixel that hair covers, shape (row, column)."""
        return self._channel("mask.hair")

    @property
    def strand_ids(self) -> NDArray[np.int32]:
        """Index of the nearest drawn strand whose middle line passes a pixel, -1 where there is none, shape (row, column)."""
        return self._channel("strand.id").round().astype(np.int32) - 1

    @property
    def tangents(self) -> NDArray[np.float32]:
        """Mean direction of the hair of each pixel toward its tips, world space, shape (row, column, 3); zero without
        hair, shorter than 1 where strands cross."""
        return self._channel("tangent.X", "tangent.Y", "tangent.Z")

    @property
    def direction(self) -> NDArray[np.float32]:
        """Direction of the hair in the picture toward its tips, shape (row, column, 2): right and down, of length 1; zero
        where there is no hair, or where it points along the view."""
        places, _ = self._rays()
        matrix = self.camera.view_from_world[:3, :3].astype(np.float64)
        ways = self.tangents @ matrix.T
        # The picture of place + s way moves by way - place (way.z / place.z), over the depth.
        moved = ways[..., :2] - places[..., :2] * (ways[..., 2:] / places[..., 2:])
        moved[..., 1] *= -1
        moved *= np.isfinite(self.depth)[..., None] & (self.hair_mask > 0)[..., None]
        length = np.linalg.norm(moved, axis=-1, keepdims=True)
        return np.asarray(np.divide(moved, length, out=np.zeros_like(moved), where=length > 1e-6), dtype=np.float32)

    @property
    def normals(self) -> NDArray[np.float32]:
        """Normals toward the camera, world space, shape (row, column, 3); zero where nothing is drawn. On hair that across
        the strand which faces the camera most; on the body that of the surface through the depths of the neighbouring
        pixels."""
        _, rays = self._rays()
        turn = self.camera.view_from_world[:3, :3].astype(np.float64)
        hair = self.hair_mask >= 0.5
        ways = self.tangents.astype(np.float64)
        ways /= np.maximum(np.linalg.norm(ways, axis=-1, keepdims=True), 1e-9)
        back = -(rays / np.linalg.norm(rays, axis=-1, keepdims=True)) @ turn
        across = back - ways * (back * ways).sum(axis=-1, keepdims=True)
        found = np.where(hair[..., None], across, self._body_normals(rays, hair) @ turn)
        length = np.linalg.norm(found, axis=-1, keepdims=True)
        return np.asarray(np.divide(found, length, out=np.zeros_like(found), where=length > 1e-9), dtype=np.float32)

    def _rays(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Places of what is drawn and rays through the pixels at a depth of 1 m, view space, shape (row, column, 3)."""
        clip = self.camera.clip_from_view(self.width / self.height).astype(np.float64)
        x = (2 * (np.arange(self.width) + 0.5) / self.width - 1) / clip[0, 0]
        y = (1 - 2 * (np.arange(self.height) + 0.5) / self.height) / clip[1, 1]
        rays = np.stack([*np.broadcast_arrays(x[None, :], y[:, None]), np.full((self.height, self.width), -1.0)], axis=-1)
        depth = self.depth.astype(np.float64)
        return rays * np.where(np.isfinite(depth), depth, 1.0)[..., None], rays

    def _body_normals(self, rays: NDArray[np.float64], hair: NDArray[np.bool_]) -> NDArray[np.float64]:
        """Normals of the body in view space, of the nearer neighbour along each axis; zero elsewhere."""
        depth = np.where(hair, np.inf, self.depth.astype(np.float64))
        places = rays * np.where(np.isfinite(depth), depth, np.nan)[..., None]
        sides = []
        for axis in (1, 0):
            step = np.diff(places, axis=axis)
            none = np.full_like(np.take(places, [0], axis=axis), np.nan)
            ahead, behind = np.concatenate([step, none], axis=axis), np.concatenate([none, step], axis=axis)
            far = np.abs(np.nan_to_num(ahead[..., 2:], nan=np.inf)) > np.abs(np.nan_to_num(behind[..., 2:], nan=np.inf))
            sides.append(np.where(far, behind, ahead))
        return np.asarray(np.nan_to_num(np.cross(sides[1], sides[0])))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a .png, which is whole or not there."""
        _native.save_png(self._bytes(), os.fspath(path))

    def png(self) -> bytes:
        """The bytes of a .png."""
        return _native.png(self._bytes())

    def _bytes(self) -> NDArray[np.uint8]:
        pixels = _arrays.numbers(self.pixels, "pixels", "(row, column, 3), or 4 with opacity", np.uint8)
        if pixels.ndim != 3 or pixels.shape[2] not in (3, 4) or pixels.size == 0:
            raise Error(f"pixels has the shape {pixels.shape}, expected (row, column, 3), or 4 with opacity", "value")
        return pixels

    def _repr_png_(self) -> bytes:
        return self.png()

    def __dlpack__(self, **options: Any) -> Any:
        """The pixels for another library, without a copy."""
        return self.pixels.__dlpack__(**options)

    def __dlpack_device__(self) -> tuple[Any, Any]:
        return self.pixels.__dlpack_device__()

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(self.pixels, dtype=dtype, copy=copy)

    def __repr__(self) -> str:
        return f"Picture({self.width} x {self.height})"
