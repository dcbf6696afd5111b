"""Curves of USD and Alembic: as receivers want them, and as one groom of what a file holds."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .errors import Error
from .groom import HAIR_WIDTH, Groom

if TYPE_CHECKING:
    from .cache import Cache

#: Metres for each unit and the axis that points up, by receiver.
TARGETS: dict[str, tuple[float, str]] = {"any": (1.0, "Y"), "unreal": (0.01, "Z"), "blender": (1.0, "Z")}

@contextmanager
def whole(path: str, part: str, what: str) -> Iterator[None]:
    """Gives a file that is written as ``part`` its name, if all goes well; errors name it."""
    folder = os.path.dirname(path) or "."
    if not os.access(folder, os.W_OK):
        raise Error(f"cannot write the {what}: no such folder, or no permission: {folder}", "file")
    try:
        yield
        os.replace(part, path)
    except Error:
        raise
    except Exception as error:
        lines = [line.strip() for line in str(error).splitlines() if line.strip()]
        reason = getattr(error, "strerror", None) or (lines[-1] if lines else type(error).__name__)
        raise Error(f"cannot write the {what}: {reason}: {path}", "file") from None
    finally:
        if os.path.exists(part):
            os.remove(part)


#: Arrays of a part of a file that are no attributes of a groom by themselves.
_OWN = ("counts", "points", "ids", "closest", "shares", "group_names")


@contextmanager
def of_file(path: str) -> Iterator[None]:
    """Names the file in errors on arrays that it holds."""
    try:
        yield
    except Error as error:
        raise Error(f"{error}: {path}", "file") from None


def placed(points: NDArray[np.float32], for_: str) -> NDArray[np.float32]:
    """Points in the units and axes of a receiver."""
    unit, up = target(for_)
    if up == "Z":
        points = np.stack([points[..., 0], -points[..., 2], points[..., 1]], axis=-1)
    return np.ascontiguousarray(points / np.float32(unit), dtype=np.float32)


def target(for_: str) -> tuple[float, str]:
    """Metres per unit and up axis of a receiver by name."""
    if for_ not in TARGETS:
        raise Error(f"for is `{for_}`, expected one of {', '.join(TARGETS)}", "value")
    return TARGETS[for_]


def left_out(groom: Groom, path: str, for_: str) -> list[str]:
    """Notes on attributes that a file of a receiver has not."""
    weights = ("guide_indices", "guide_weights") if for_ == "unreal" else ()
    held = ("colors", "root_uvs", "groups", "guide_flags", "velocities", *weights)
    lacking = [name for name in groom.attributes if name not in held]
    if groom.group_names.keys() - set(groom.attributes.get("groups", np.empty(0)).tolist()):
        lacking.append("group_names of groups without strands")
    return [f"{os.path.basename(path)} has no {name}" for name in lacking]


def attributes(groom: Groom) -> dict[str, Any]:
    """Attributes of a groom by name, with the names of its groups."""
    return {**groom.attributes, "group_names": groom.group_names}


def group_labels(more: dict[str, Any]) -> list[str]:
    """The name of each strand's group among attributes, empty for a group without one; none where no group has one."""
    names, groups = more.get("group_names", {}), more.get("groups")
    if groups is None or not names:
        return []
    if cut := [name for name in names.values() if "\0" in name]:
        raise Error(f"group_names has {cut[0]!r} with a zero character, expected names without one", "value")
    numbers, places = np.unique(groups, return_inverse=True)
    own = [names.get(int(number), "") for number in numbers]
    return [own[place] for place in places] if any(own) else []


def group_names(groups: NDArray[Any] | None, labels: list[str]) -> dict[int, str]:
    """Names of groups by number, of the group and the label of each strand."""
    if groups is None or len(labels) != len(groups):
        return {}
    numbers, firsts = np.unique(groups, return_index=True)
    return {int(number): labels[first] for number, first in zip(numbers, firsts, strict=True) if labels[first]}


def nearest_guides(indices: NDArray[Any], weights: NDArray[Any]) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    """The three guides of each strand with the largest weights, and these as shares of 1."""
    order = np.argsort(-weights, axis=1, kind="stable")[:, :3]
    guides = np.take_along_axis(indices, order, axis=1).astype(np.int32)
    shares = np.take_along_axis(weights, order, axis=1).astype(np.float32)
    if order.shape[1] < 3:
        lacking = 3 - order.shape[1]
        guides = np.concatenate([guides, np.repeat(guides[:, :1], lacking, axis=1)], axis=1)
        shares = np.concatenate([shares, np.zeros((len(shares), lacking), dtype=np.float32)], axis=1)
    sums = shares.sum(axis=1, keepdims=True)
    shares = np.where(sums > 0, shares / np.where(sums > 0, sums, 1), np.array([1, 0, 0], dtype=np.float32))
    return np.ascontiguousarray(guides), np.ascontiguousarray(shares, dtype=np.float32)


def point_widths(groom: Groom) -> NDArray[np.float32]:
    """Diameter at each point of a groom [m]."""
    widths = np.asarray(groom.widths, dtype=np.float32)
    if widths.ndim == 0:
        return np.full(len(groom.points), widths, dtype=np.float32)
    if len(widths) == len(groom.points):
        return widths
    counts: Any = np.diff(groom.starts.astype(np.int64))
    return np.repeat(widths, counts)


def cache_attributes(cache: Cache, for_: str) -> tuple[dict[str, Any], Bound | None]:
    """Attributes of a cache's strands by the names of a groom's, and for Unreal the strands that are bound to them."""
    found = cache.attributes()
    named = {"colors": "colors", "root_uv": "root_uvs", "groups": "groups", "guide_flags": "guide_flags"}
    more = {own: found[name] for name, own in named.items() if name in found} | {"group_names": found["group_names"]}
    if for_ != "unreal" or "guide_indices" not in found:
        return more, None
    binding = {name: found[name] for name in ("guide_indices", "guide_weights")}
    if "bound_points" not in found:
        return {**more, **binding}, None
    more["guide_flags"] = np.ones(len(cache.starts) - 1, dtype=np.uint8)
    _, head = cache.read(0)
    points = np.asarray(found["bound_points"] @ head[:3, :3].T + head[:3, 3], dtype=np.float32)
    width = float(np.mean(found["widths"])) if "widths" in found else HAIR_WIDTH
    flags = np.zeros(len(found["bound_starts"]) - 1, dtype=np.uint8)
    return more, Bound(points, found["bound_starts"], np.full(len(points), width, dtype=np.float32), {**binding, "guide_flags": flags})


class Bound(NamedTuple):
    """Strands that follow guides: points [m] where the head is at the first frame, first points, widths and attributes."""

    points: NDArray[np.float32]
    starts: NDArray[np.uint32]
    widths: NDArray[np.float32]
    attributes: dict[str, Any]


def moments(cache: Cache, velocities: bool) -> Iterator[tuple[NDArray[np.float32], NDArray[np.float32] | None]]:
    """Points of each frame [m], and velocities [m/s] by the frames before and after it. At most three frames are held."""
    rate = np.float32(cache.frames_per_second)
    before, now = None, cache[0]
    for frame in range(len(cache)):
        after = cache[frame + 1] if frame + 1 < len(cache) else None
        moved = None
        if velocities:
            first, last = now if before is None else before, now if after is None else after
            span = max((before is not None) + (after is not None), 1)
            moved = (last - first) * (rate / np.float32(span))
        yield now, moved
        if after is not None:
            before, now = now if velocities else None, after


def triangles(counts: NDArray[np.int64], corners: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles of polygons, as fans."""
    starts = np.concatenate([[0], np.cumsum(counts)[:-1]])
    fans: list[NDArray[np.int64]] = []
    for size in np.unique(counts[counts > 2]):
        first = starts[counts == size]
        fans.extend(np.stack([corners[first], corners[first + at], corners[first + at + 1]], axis=1) for at in range(1, size - 1))
    return np.concatenate(fans) if fans else np.empty((0, 3), dtype=np.int64)


def joined(parts: list[dict[str, Any]], path: str) -> Groom:
    """The groom of the curves of a file, each with ``counts``, ``points`` and attributes by the names of a groom's. Those
    that not all curves have are left out. Strands are bound to guides by ``closest``, numbers of guides among ``ids``, and
    ``shares``, their weights; curves without them follow none."""
    counts = np.concatenate([part["counts"] for part in parts]).astype(np.int64)
    points = np.concatenate([part["points"] for part in parts])
    if counts.min() < 0 or counts.sum() != len(points) or not np.all(np.isfinite(points)):
        raise Error(f"it holds {len(points)} points, expected {counts.sum()} by its counts, all finite: {path}", "file")
    names = [name for name in parts[0] if name not in _OWN and all(name in part for part in parts)]
    shared: dict[str, Any] = {name: np.concatenate([part[name] for part in parts]) for name in names}
    starts = np.concatenate([[0], np.cumsum(counts)])
    labels: dict[int, str] = {}
    for part in reversed(parts if "groups" in shared else []):
        labels |= part.get("group_names", {})
    with of_file(path):
        groom = Groom(points, starts, group_names=labels, **shared, **_bound(parts, len(counts)))
        return groom.selected(counts > 1) if (counts < 2).any() else groom


def _bound(parts: list[dict[str, Any]], strands: int) -> dict[str, Any]:
    """Guides of each strand and their weights, as a groom has them; none where no weight belongs to a strand."""
    if not any("closest" in part for part in parts):
        return {}
    closest, shares = (np.concatenate([part.get(name, np.zeros((len(part["counts"]), 3), kind)) for part in parts]) for name, kind in (("closest", np.int64), ("shares", np.float32)))
    ids: Any = np.arange(strands)
    if all("ids" in part for part in parts):
        ids = np.concatenate([part["ids"] for part in parts])
    order = np.argsort(ids, kind="stable")
    places = np.searchsorted(ids, closest, sorter=order).clip(0, strands - 1)
    guides = order[places]
    known = (ids[guides] == closest) & np.isfinite(shares) & (shares > 0)
    weights = np.where(known, shares, 0)
    return {"guide_indices": np.where(known, guides, 0), "guide_weights": weights} if known.any() else {}
