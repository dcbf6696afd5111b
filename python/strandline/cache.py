"""Files of moving hair."""

from __future__ import annotations

import json
import os
import tomllib
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _extras, _native, _receivers
from .errors import Error
from .groom import HAIR_WIDTH
from .scene import Scene

if TYPE_CHECKING:
    from .simulation import Written


class Cache:
    """A moving cache (.npz), read frame by frame: ``Cache(path)[k]`` are the points of frame k [m], world space, shape
    (point, 3); ``array(k)`` has the shape (strand, point, 3)."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = os.fspath(path)
        self._native = _native.Cache(self.path)
        self.times, self.starts, self.what, scene = self._native.about()
        self._scene = scene

    @property
    def scene(self) -> Scene | None:
        """The scene that it was made with."""
        return None if self._scene is None else Scene(tomllib.loads(self._scene))

    def __len__(self) -> int:
        return len(self.times)

    def read(self, frame: int) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Points of a frame, shape (point, 3), and the 4 x 4 matrix world_from_head."""
        index = frame + len(self) if frame < 0 else frame
        if not 0 <= index < len(self):
            raise IndexError(f"frame {frame} of {len(self)}")
        points, head = self._native.read(index)
        return points, np.asarray(head, dtype=np.float32)

    def __getitem__(self, frame: int) -> NDArray[np.float32]:
        return self.read(frame)[0]

    def array(self, frame: int) -> NDArray[np.float32]:
        """Points of a frame, shape (strand, point, 3)."""
        counts = np.diff(self.starts)
        if len(counts) == 0 or np.any(counts != counts[0]):
            raise Error("strands have different numbers of points, expected the same: use cache[frame] and cache.starts", "value")
        return self[frame].reshape(len(counts), -1, 3)

    def __iter__(self) -> Iterator[NDArray[np.float32]]:
        return (self[frame] for frame in range(len(self)))

    def attributes(self) -> dict[str, Any]:
        """Attributes of the strands that the file has: widths and colors per point, root_uv and groups per strand,
        guide_indices and guide_weights of strands that are bound, guide_flags where guides are among the strands; and
        group_names, the names of groups by number."""
        names = ("widths", "colors", "root_uv", "groups", "guide_flags", "guide_indices", "guide_weights", "bound_points", "bound_starts")
        with np.load(self.path) as arrays:
            found: dict[str, Any] = {name: arrays[name] for name in names if name in arrays.files}
            labels = json.loads(arrays["meta"].tobytes()).get("group_names", [])
        return found | {"group_names": {group: name for group, name in enumerate(labels) if name}}

    def widths(self) -> NDArray[np.float32]:
        """Diameter at each point [m]."""
        widths = self.attributes().get("widths")
        return np.full(int(self.starts[-1]), HAIR_WIDTH, dtype=np.float32) if widths is None else widths

    @property
    def frames_per_second(self) -> float:
        """Frames per second, by their times."""
        if len(self.times) < 2:
            scene = self.scene
            return 30.0 if scene is None else float(scene["film.frames_per_second"])
        return float(round((len(self.times) - 1) / (self.times[-1] - self.times[0]), 6))

    def save(self, path: str | os.PathLike[str], *, for_: str = "any", velocities: bool = False) -> Written:
        """Writes the frames as .usdc, .usd or .abc, with the extra that the suffix needs. ``velocities`` writes those of each
        point too, for motion blur: by the frames before and after."""
        return writer(os.path.splitext(os.fspath(path))[1].lower())(self, path, for_=for_, velocities=velocities)

    def __reduce__(self) -> tuple[Any, ...]:
        return Cache, (self.path,)

    def __repr__(self) -> str:
        return f"Cache({len(self)} frames of {len(self.starts) - 1} {self.what}, {self.path})"


def by_part(path: str | os.PathLike[str], make: Callable[[str], bool], *, for_: str, velocities: bool = False) -> Written | None:
    """Writes moving hair by a moving cache beside the file: ``make`` writes that and says whether it did. Frames are kept
    where anything ends this early: what is raised names their cache, which ``Cache(part).save(path)`` writes."""
    path = os.fspath(path)
    write = writer(os.path.splitext(path)[1].lower())
    _receivers.target(for_)
    part = f"{path}.part.npz"
    if os.path.exists(part):
        os.remove(part)
    try:
        if not make(part):
            return None
        written = write(Cache(part), path, for_=for_, velocities=velocities)
    except KeyboardInterrupt as stopped:
        if os.path.exists(part):
            stopped.add_note(f"the frames so far are kept: {part}")
        raise
    except Exception as error:
        if not os.path.exists(part):
            raise
        raise Error(f"{error}; the frames so far are kept: {part}", getattr(error, "kind", "file")) from error
    os.remove(part)
    return written


def writer(suffix: str) -> Callable[..., Written]:
    """The function that writes moving hair to files of a suffix."""
    if suffix in (".usdc", ".usd"):
        from . import usd

        _extras.pxr_package()
        return usd.save_cache
    if suffix == ".abc":
        from . import abc

        _extras.alembic_package()
        return abc.save_cache
    raise Error(f"`{suffix}` names no format of moving hair, expected .usdc, .usd or .abc", "value")
