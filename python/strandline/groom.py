"""Strands as arrays."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _extras, _native, _toml, research
from .errors import Error
from .scene import Scene

#: Attributes, the type of their numbers, their columns (0 for one number), and whether they are per point or strand.
ATTRIBUTES: dict[str, tuple[Any, int, str]] = {
    "colors": (np.float32, 3, "point"),
    "transparencies": (np.float32, 0, "point"),
    "masses": (np.float32, 0, "point"),
    "velocities": (np.float32, 3, "point"),
    "root_uvs": (np.float32, 2, "strand"),
    "root_normals": (np.float32, 3, "strand"),
    "groups": (np.uint32, 0, "strand"),
    "guide_flags": (np.bool_, 0, "strand"),
    "guide_indices": (np.uint32, -1, "strand"),
    "guide_weights": (np.float32, -1, "strand"),
}

#: Diameter of a human hair [m], for grooms that name none.
HAIR_WIDTH = 8e-5


class Groom:
    """Strands at rest, root first, head space [m], y up.

    ``Groom(points)`` takes an array of shape (strand, point, 3), or with ``starts`` one of shape (point, 3) for strands
    of different lengths: ``starts`` holds the first point of each strand and at the end the number of points.
    Attributes are keywords: ``widths`` (one number, or per strand or point, diameters in metres), ``colors`` (linear
    RGB per point), ``root_uvs``, ``root_normals``, ``groups``, ``guide_flags`` per strand, ``transparencies``,
    ``masses`` [kg] and ``velocities`` [m/s] per point, ``guide_indices`` and ``guide_weights`` of shape (strand, n).

    Plain data: it can be pickled, and its arrays changed in place.
    """

    points: NDArray[np.float32]
    starts: NDArray[np.uint32]
    widths: float | NDArray[np.float32]
    attributes: dict[str, NDArray[Any]]
    group_names: dict[int, str]
    notes: list[str]

    def __init__(
        self,
        points: ArrayLike,
        starts: ArrayLike | None = None,
        *,
        widths: float | ArrayLike = HAIR_WIDTH,
        group_names: dict[int, str] | None = None,
        **attributes: ArrayLike | None,
    ) -> None:
        array = _arrays.numbers(points, "points", "(strand, point, 3)" if starts is None else "(point, 3)")
        if starts is None:
            if array.ndim != 3 or array.shape[2] != 3:
                text = f"points has the shape {array.shape}, expected (strand, point, 3), or (point, 3) with starts"
                raise Error(text, "value")
            strands, each, _ = array.shape
            self.starts = np.arange(strands + 1, dtype=np.uint32) * np.uint32(each)
        else:
            if array.ndim != 2 or array.shape[1] != 3:
                raise Error(f"points has the shape {array.shape}, expected (point, 3) beside starts", "value")
            self.starts = _arrays.numbers(starts, "starts", "(strand + 1,)", np.uint32).reshape(-1)
        self.points = array.reshape(-1, 3)
        thick = _arrays.numbers(widths, "widths", "() or (n,)")
        if thick.size and not (np.all(np.isfinite(thick)) and thick.min() >= 0):
            raise Error("widths has numbers that are negative or not finite, expected diameters of 0 or more [m]", "value")
        self.widths = float(thick) if thick.ndim == 0 else thick.reshape(-1)
        self.group_names = dict(group_names or {})
        self.attributes = {}
        self.notes = []
        for name, numbers in attributes.items():
            if numbers is not None:
                self[name] = numbers
        self.check()

    @classmethod
    def _of(cls, of: dict[str, Any], notes: Sequence[str] = ()) -> Groom:
        points, starts, widths = of.pop("points"), of.pop("starts"), of.pop("widths")
        groom = cls(points, starts, widths=widths, group_names=of.pop("group_names", None), **of)
        groom.notes = list(notes)
        return groom

    def _dictionary(self) -> dict[str, Any]:
        of: dict[str, Any] = {name: np.ascontiguousarray(numbers) for name, numbers in self.attributes.items()}
        widths = self.widths if np.ndim(self.widths) == 0 else np.ascontiguousarray(self.widths, dtype=np.float32)
        points = np.ascontiguousarray(self.points, dtype=np.float32)
        of.update(points=points, starts=np.ascontiguousarray(self.starts, dtype=np.uint32), widths=widths)
        if self.group_names:
            of["group_names"] = {int(group): name for group, name in self.group_names.items()}
        return of

    def check(self) -> None:
        """Refuses arrays whose lengths do not belong together."""
        if len(self.starts) < 1 or self.starts[0] != 0 or self.starts[-1] != len(self.points):
            raise Error(f"starts has {len(self.starts)} numbers, expected the first point of each strand from 0 and at the end {len(self.points)}, the number of points", "value")
        if np.any(np.diff(self.starts.astype(np.int64)) < 0):
            raise Error("starts falls, expected numbers that rise", "value")
        counts = {"point": len(self.points), "strand": self.strand_count}
        for name, numbers in self.attributes.items():
            _, _, place = ATTRIBUTES[name]
            if len(numbers) != counts[place]:
                raise Error(f"{name} has {len(numbers)} rows, expected {counts[place]}, one for each {place}", "value")
        self._check_guides()
        if np.ndim(self.widths) and len(self.widths) not in counts.values():  # type: ignore[arg-type]
            raise Error(f"widths has {len(self.widths)} numbers, expected one, or one for each of {self.strand_count} strands or {len(self.points)} points", "value")  # type: ignore[arg-type]

    def _check_guides(self) -> None:
        guides, weights = self.attributes.get("guide_indices"), self.attributes.get("guide_weights")
        shapes = [None if part is None else part.shape for part in (guides, weights)]
        if shapes[0] != shapes[1]:
            raise Error(f"guide_indices has the shape {shapes[0]} and guide_weights {shapes[1]}, expected both, of the same shape", "value")
        if guides is not None and guides.size and guides.max() >= self.strand_count:
            raise Error(f"guide_indices has the strand {guides.max()}, expected 0 to {self.strand_count - 1}", "value")

    @property
    def strand_count(self) -> int:
        """Number of strands."""
        return len(self.starts) - 1

    @property
    def is_uniform(self) -> bool:
        """True if every strand has the same number of points."""
        counts = np.diff(self.starts)
        return bool(len(counts) == 0 or np.all(counts == counts[0]))

    @property
    def array(self) -> NDArray[np.float32]:
        """Points, shape (strand, point, 3): a view, where every strand has the same number of points."""
        if not self.is_uniform or self.strand_count == 0:
            raise Error("strands have different numbers of points, expected the same: groom.resampled(n) makes it so", "value")
        return self.points.reshape(self.strand_count, -1, 3)

    def __getitem__(self, name: str) -> NDArray[Any]:
        """An attribute by its name, as in ``groom["root_uvs"]``."""
        if name in self.attributes:
            return self.attributes[name]
        if name in ATTRIBUTES:
            raise Error(f"the groom has no {name}, it has {', '.join(self.attributes) or 'no attributes'}", "value")
        raise Error(_unknown(name), "value")

    def __setitem__(self, name: str, numbers: ArrayLike) -> None:
        if name not in ATTRIBUTES:
            raise Error(_unknown(name), "value")
        kind, columns, place = ATTRIBUTES[name]
        wanted = f"({place},)" if columns == 0 else f"({place}, {columns if columns > 0 else 'guides'})"
        array = _arrays.numbers(numbers, name, wanted, kind)
        if array.ndim != (1 if columns == 0 else 2) or (columns > 0 and array.shape[1] != columns):
            raise Error(f"{name} has the shape {array.shape}, expected {wanted}", "value")
        self.attributes[name] = array

    def __contains__(self, name: str) -> bool:
        return name in self.attributes

    def strands(self) -> Iterator[NDArray[np.float32]]:
        """The points of each strand, views of shape (point, 3)."""
        for first, end in zip(self.starts[:-1], self.starts[1:], strict=True):
            yield self.points[first:end]

    def resampled(self, points_per_strand: int) -> Groom:
        """The groom with so many points on each strand, evenly along it."""
        return Groom._of(_native.resample(self._dictionary(), _arrays.count(points_per_strand, "points_per_strand", 2)))

    def selected(self, strands: ArrayLike) -> Groom:
        """A groom of some of the strands, by index or by a mask. Guides of strands are left out."""
        try:
            chosen = np.arange(self.strand_count)[np.asarray(strands)].reshape(-1)
        except (IndexError, ValueError) as error:
            raise Error(f"strands is no index or mask of {self.strand_count} strands: {error}", "value") from None
        counts = np.diff(self.starts.astype(np.int64))[chosen]
        starts = np.concatenate([[0], np.cumsum(counts)])
        first = self.starts.astype(np.int64)[chosen]
        index = np.repeat(first - starts[:-1], counts) + np.arange(starts[-1])
        rows = {"point": index, "strand": chosen}
        kept = {
            name: numbers[rows[ATTRIBUTES[name][2]]]
            for name, numbers in self.attributes.items()
            if name not in ("guide_indices", "guide_weights")
        }
        widths: Any = self.widths
        if np.ndim(widths):
            widths = widths[chosen if len(widths) == self.strand_count else index]
        return Groom(self.points[index], starts, widths=widths, group_names=self.group_names, **kept)

    def save(self, path: str | os.PathLike[str], layout: str | None = None, *, for_: str = "any") -> list[str]:
        """Writes a file of the format that its suffix names, or of a research ``layout`` by name; returns notes on what the
        format cannot hold or what was changed to fit it. ``for_`` is the receiver of USD and Alembic: ``"any"``,
        ``"unreal"`` or ``"blender"``."""
        suffix = os.path.splitext(os.fspath(path))[1].lower()
        if for_ != "any" and (layout is not None or suffix not in (".usdc", ".usda", ".usd", ".abc")):
            raise Error(f"for_ is `{for_}` beside {layout or suffix or 'no suffix'}, expected it for .usdc, .usda, .usd and .abc alone", "value")
        if layout is not None:
            return research.save(self, path, layout)
        if suffix in (".usdc", ".usda", ".usd"):
            from . import usd

            return usd.save_groom(self, path, for_=for_)
        if suffix == ".abc":
            from . import abc

            return abc.save_groom(self, path, for_=for_)
        left_out, notes = _native.save(self._dictionary(), os.fspath(path))
        return [*(f"{os.path.basename(os.fspath(path))} cannot hold {part}" for part in left_out), *notes]

    def copy(self) -> Groom:
        """A groom with arrays of its own."""
        return Groom(self.points.copy(), self.starts.copy(), widths=np.copy(self.widths), group_names=self.group_names, **{name: numbers.copy() for name, numbers in self.attributes.items()})

    def __dlpack__(self, **options: Any) -> Any:
        """The points for another library, shape (strand, point, 3), without a copy."""
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self) -> tuple[Any, Any]:
        return self.points.__dlpack_device__()

    def __len__(self) -> int:
        return self.strand_count

    def __repr__(self) -> str:
        has = f" with {', '.join(self.attributes)}" if self.attributes else ""
        return f"Groom({self.strand_count} strands, {len(self.points)} points{has})"


def _unknown(name: Any) -> str:
    import difflib

    near = difflib.get_close_matches(str(name), ATTRIBUTES, 1)
    nearest = f"`{near[0]}` or another of " if near else "one of "
    return f"`{name}` is no attribute of a groom, expected {nearest}{', '.join(ATTRIBUTES)}"


def load(
    path: str | os.PathLike[str],
    *,
    scale: float | str = "auto",
    up: str = "y",
    turn: Sequence[float] = (0.0, 0.0, 0.0),
    points_per_strand: int | None = None,
    frame: int | None = None,
    root_end: str = "auto",
    strict: bool = False,
    clean: bool = False,
    layout: str | None = None,
    root_uvs: str | os.PathLike[str] | None = None,
) -> Groom:
    """Reads a groom, in metres with y up; the suffix decides the format, or ``layout`` a research layout by name.

    ``scale`` is metres for each unit of the file, ``"auto"`` chooses what makes the groom as large as a head of hair;
    ``up`` its axis that points up (``"z"``, ``"-y"``). ``points_per_strand`` is for files that hold points and do not
    say which of them make a strand. ``strict`` refuses bad strands, which else are left out with a note;
    ``clean`` mends them. ``groom.notes`` says what was odd.
    """
    path = os.fspath(path)
    suffix = os.path.splitext(path)[1].lower()
    if layout is not None:
        research.check(layout, path)
        scale = research.LAYOUTS[layout].scale if scale == "auto" else scale
        points_per_strand = points_per_strand or research.LAYOUTS[layout].points_per_strand
        up = research.LAYOUTS[layout].up if up == "y" else up
    if scale != "auto":
        scale = _arrays.number(scale, "scale", "\"auto\" or a number above 0 [m]", 1e-9, 1e9)
    angles = _arrays.numbers(turn, "turn", "(3,)")
    if angles.shape != (3,):
        raise Error(f"turn has the shape {angles.shape}, expected (3,): pitch, yaw and roll [degrees]", "value")
    frame = None if frame is None else _arrays.count(frame, "frame")
    points_per_strand = None if points_per_strand is None else _arrays.count(points_per_strand, "points_per_strand", 1)
    if suffix in _extras.GROOMS:
        with _extras.Files() as files:
            copy = files.groom(path, frame)
            # A stage says its units, an archive does not.
            scale = 1.0 if scale == "auto" and suffix != ".abc" else scale
            try:
                return load(copy, scale=scale, up=up, turn=turn, root_end=root_end, strict=strict, clean=clean, root_uvs=root_uvs)
            except Error as error:
                raise files.error(error) from None
    of, notes = _native.load(
        path,
        scale=None if isinstance(scale, str) else scale,
        up=up,
        turn=angles.tolist(),
        points_per_strand=points_per_strand,
        frame=frame,
        root_end=root_end,
        strict=strict,
        clean=clean,
    )
    groom = Groom._of(of, notes)
    if root_uvs is not None:
        groom["root_uvs"] = research.root_uvs(root_uvs)
        groom.check()
    return groom


def grow(style: str = "long", *, strands: int | None = None, **settings: Any) -> Groom:
    """Grows a built-in style on the built-in bust: bob, long, wavy, curly, pixie, ponytail, buzz, side_swept, afro,
    coils, bun, braid, beard, brows or lashes. Keywords are the settings of the section ``style``:
    ``grow("bob", strand_count=500, seed=3)``. With ``strands`` it grows so many strands of hair, each with a curve of its own,
    as a scene does with ``groom.bound``: the first ``strand_count`` are marked as guides in ``guide_flags``."""
    bound = {} if strands is None else {"groom": {"bound": strands}}
    scene = Scene({"style": {"style": style, **settings}, **bound})
    return Groom._of(_native.grow(_toml.document(scene.given)))
