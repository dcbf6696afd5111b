"""Layouts of code that learns hair, by name."""

from __future__ import annotations

import os
import struct
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _native
from .errors import Error

if TYPE_CHECKING:
    from .groom import Groom


class Layout(NamedTuple):
    """A layout: its suffix, what it is, metres per unit, the axis that points up, and points of each strand."""

    suffix: str
    about: str
    scale: float
    up: str
    points_per_strand: int | None


#: Layouts by name.
LAYOUTS: dict[str, Layout] = {
    "usc": Layout(".data", "USC-HairSalon: strands of a count and points; one point is no hair", 1.0, "y", None),
    "ct2hair": Layout(".bin", "CT2Hair: strands of a count and 7 numbers a point, millimetres", 0.001, "y", None),
    "neural": Layout(".ply", "NeuralHaircut, HAAR: bare points, 100 a strand", 1.0, "y", 100),
    "positions": Layout(".npz", "an array `positions`, shape (strand, point, 3)", 1.0, "y", None),
    "points": Layout(".npy", "one array, shape (strand, point, 3)", 1.0, "y", None),
}


def check(layout: str, path: str) -> None:
    """Refuses a layout that has no such name, and a file whose suffix is that of another."""
    if layout not in LAYOUTS:
        import difflib

        near = difflib.get_close_matches(layout, LAYOUTS, 1)
        nearest = f"`{near[0]}` or another of " if near else "one of "
        raise Error(f"`{layout}` is no layout, expected {nearest}{', '.join(LAYOUTS)}", "value")
    if os.path.splitext(path)[1].lower() != LAYOUTS[layout].suffix:
        raise Error(f"`{os.path.basename(path)}` has another suffix, expected {LAYOUTS[layout].suffix} for {layout}", "value")


def root_uvs(path: str | os.PathLike[str]) -> NDArray[np.float32]:
    """Coordinates of roots on the scalp from a .npy, or from the array `uv_coords` (or the only one) of a .npz."""
    from zipfile import BadZipFile

    try:
        loaded: Any = np.load(path)
    except OSError as error:
        raise Error(f"cannot read root coordinates: {error.strerror or error}: {os.fspath(path)}", "file") from None
    except (ValueError, EOFError, BadZipFile):
        raise Error(f"cannot read root coordinates: no .npy or .npz of numbers: {os.fspath(path)}", "file") from None
    if not isinstance(loaded, np.ndarray):
        names = loaded.files
        name = "uv_coords" if "uv_coords" in names else names[0] if len(names) == 1 else None
        if name is None:
            raise Error(f"it holds {', '.join(names)}, expected an array `uv_coords`: {os.fspath(path)}", "file")
        loaded = loaded[name]
    return np.ascontiguousarray(loaded, dtype=np.float32)


def save(groom: Groom, path: str | os.PathLike[str], layout: str) -> list[str]:
    """Writes a groom in a layout; returns notes on what it cannot hold."""
    path = os.fspath(path)
    check(layout, path)
    about = LAYOUTS[layout]
    notes = [f"{layout} cannot hold {name}" for name in groom.attributes if not (layout == "positions" and name == "root_uvs")]
    if groom.group_names:
        notes.append(f"{layout} cannot hold group_names")
    each = about.points_per_strand
    if each is not None and not (groom.is_uniform and len(groom.points) == each * groom.strand_count):
        groom = groom.resampled(each)
        notes.append(f"strands have {each} points each now")
    points = (groom.points / np.float32(about.scale)).astype("<f4")
    try:
        _write(groom, points, path, layout)
    except OSError as error:
        raise Error(f"cannot write the groom: {error.strerror}: {path}", "file") from None
    return notes


def _write(groom: Groom, points: NDArray[np.float32], path: str, layout: str) -> None:
    shape = (groom.strand_count, -1, 3)
    if layout == "points":
        np.save(path, groom.array)
    elif layout == "positions":
        arrays = {"positions": groom.array}
        if "root_uvs" in groom:
            arrays["uv_coords"] = groom["root_uvs"]
        np.savez(path, **arrays)  # type: ignore[arg-type]
    elif layout == "neural":
        points = points.reshape(shape)
        with open(path, "wb") as file:
            head = "ply\nformat binary_little_endian 1.0\n"
            axes = "".join(f"property float {axis}\n" for axis in "xyz")
            file.write(f"{head}element vertex {points.size // 3}\n{axes}end_header\n".encode())
            file.write(points.tobytes())
    else:
        pad = 4 if layout == "ct2hair" else 0
        rows = np.concatenate([points, np.zeros((len(points), pad), dtype="<f4")], axis=1) if pad else points
        with open(path, "wb") as file:
            file.write(struct.pack("<i", groom.strand_count))
            for first, end in zip(groom.starts[:-1], groom.starts[1:], strict=True):
                file.write(struct.pack("<i", int(end - first)))
                file.write(rows[first:end].tobytes())


def resampled_points(points: NDArray[np.float32], each: int) -> NDArray[np.float32]:
    """Strands of shape (strand, point, 3) with another number of points, evenly along them."""
    strands, had, _ = points.shape
    starts = np.arange(strands + 1, dtype=np.uint32) * np.uint32(had)
    of = {"points": np.ascontiguousarray(points.reshape(-1, 3), dtype=np.float32), "starts": starts, "widths": 8e-5}
    return _native.resample(of, each)["points"].reshape(strands, each, 3)  # type: ignore[no-any-return]
