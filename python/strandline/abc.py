"""Alembic by the extra [abc]: grooms, bodies over time, and moving hair."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._archives import apart
from ._extras import alembic_package
from ._receivers import attributes, cache_attributes, group_labels, left_out, moments, nearest_guides, placed, point_widths, target, whole
from .body import Body
from .errors import Error
from .groom import Groom

if TYPE_CHECKING:
    from .cache import Cache
    from .simulation import Written

#: Version of Unreal's schema of grooms, and our name in it.
_MAJOR, _MINOR, _TOOL = 1, 5, "strandline"


def _vectors(points: NDArray[np.float32]) -> Any:
    import imath

    return imath.V3fArrayFromBuffer(np.ascontiguousarray(points, dtype=np.float32))


def _floats(numbers: Any) -> Any:
    import imath

    return imath.FloatArrayFromBuffer(np.ascontiguousarray(numbers, dtype=np.float32))


def _integers(numbers: Any) -> Any:
    import imath

    return imath.IntArrayFromBuffer(np.ascontiguousarray(numbers, dtype=np.int32))


def _texts(texts: list[str]) -> Any:
    import imath

    array = imath.StringArray(len(texts))
    for at, text in enumerate(texts):
        array[at] = text
    return array


class _File:
    """An archive of curves that is being written."""

    def __init__(self, path: str, frames_per_second: float, for_: str) -> None:
        package = alembic_package()
        target(for_)
        # Blender takes every archive for one with y up, and turns it.
        self.for_ = "any" if for_ == "blender" else for_
        self._archive = package.Abc.OArchive(path)
        sampling = package.AbcCoreAbstract.TimeSampling(1.0 / frames_per_second, 0.0)
        self._index = self._archive.addTimeSampling(sampling)
        self._strands: list[_Strands] = []

    def strands(self, name: str, moves: bool = True) -> _Strands:
        """New curves by a name."""
        package = alembic_package()
        index = self._index if moves else 0
        curves = package.AbcGeom.OCurves(self._archive.getTop(), name, package.Abc.Argument(index))
        self._strands.append(_Strands(curves, self.for_))
        return self._strands[-1]

    def close(self) -> None:
        """Ends the file, which is complete when nothing refers to it."""
        while self._strands:
            self._strands.pop().forget()
        del self._archive


class _Strands:
    """Curves that are being written."""

    def __init__(self, curves: Any, for_: str) -> None:
        self._for, self._curves = for_, curves
        self._schema = curves.getSchema()
        self._counts: Any = None
        self._widths: Any = None

    def describe(self, starts: NDArray[np.uint32], widths: NDArray[np.float32], more: dict[str, Any], first: int = 0) -> None:
        """Writes what stays: counts, widths, and Unreal's attributes, each of which is not indexed. Numbers of strands begin
        with ``first``."""
        package = alembic_package()
        geometry = package.AbcGeom
        counts = np.diff(starts.astype(np.int64)).astype(np.int32)
        unit, _ = target(self._for)
        vertex = geometry.GeometryScope.kVertexScope
        uniform = geometry.GeometryScope.kUniformScope
        self._counts = _integers(counts)
        thick = _floats(widths / np.float32(unit))
        self._widths = geometry.OFloatGeomParamSample(thick, vertex)
        arbitrary = self._schema.getArbGeomParams()

        def put(kind: str, name: str, value: Any, scope: Any) -> None:
            param = getattr(geometry, f"O{kind}GeomParam")(arbitrary, name, False, scope, 1)
            param.set(getattr(geometry, f"O{kind}GeomParamSample")(value, scope))

        put("Float", "groom_width", thick, vertex)
        put("Int32", "groom_id", _integers(np.arange(first, first + len(counts))), uniform)
        if "colors" in more:
            put("V3f", "groom_color", _vectors(more["colors"]), vertex)
        if "root_uvs" in more:
            import imath

            uvs = imath.V2fArrayFromBuffer(np.ascontiguousarray(more["root_uvs"], dtype=np.float32))
            put("V2f", "groom_root_uv", uvs, uniform)
        if "groups" in more:
            put("Int32", "groom_group_id", _integers(more["groups"]), uniform)
        if labels := group_labels(more):
            put("String", "groom_group_name", _texts(labels), uniform)
        if "guide_flags" in more:
            put("Int32", "groom_guide", _integers(more["guide_flags"]), uniform)
        if "guide_indices" in more and self._for == "unreal":
            import imath

            guides, weights = nearest_guides(more["guide_indices"], more["guide_weights"])
            put("V3i", "groom_closest_guides", imath.V3iArrayFromBuffer(guides), uniform)
            put("V3f", "groom_guide_weights", _vectors(weights), uniform)
        own = self._schema.getUserProperties()
        for name, number in (("groom_version_major", _MAJOR), ("groom_version_minor", _MINOR)):
            package.Abc.OInt16Property(own, name).setValue(number)
        package.Abc.OStringProperty(own, "groom_tool").setValue(_TOOL)

    def add(self, points: NDArray[np.float32], velocities: NDArray[np.float32] | None = None) -> None:
        """Writes the points of a frame [m] and their velocities [m/s], y up."""
        geometry = alembic_package().AbcGeom
        # Counts, type, wrap and basis come with every sample: the default basis is no linear one.
        sample = geometry.OCurvesSchemaSample(
            _vectors(placed(points, self._for)),
            self._counts,
            geometry.CurveType.kLinear,
            geometry.CurvePeriodicity.kNonPeriodic,
        )
        sample.setBasis(geometry.BasisType.kNoBasis)
        sample.setWidths(self._widths)
        if velocities is not None:
            sample.setVelocities(_vectors(placed(velocities, self._for)))
        self._schema.set(sample)

    def forget(self) -> None:
        """Drops all that refers to the archive."""
        del self._schema, self._curves


def save_groom(groom: Groom, path: str | os.PathLike[str], *, for_: str = "any") -> list[str]:
    """Writes a groom at rest; returns notes on what the file lacks."""
    path = os.fspath(path)
    part = f"{path}.part"
    with whole(path, part, "archive"):
        file = _File(part, 24.0, for_)
        strands = file.strands("hair")
        strands.describe(groom.starts, point_widths(groom), attributes(groom))
        strands.add(groom.points, groom.attributes.get("velocities"))
        del strands
        file.close()
    return left_out(groom, path, for_)


def save_cache(cache: Cache, path: str | os.PathLike[str], *, for_: str = "any", velocities: bool = False) -> Written:
    """Writes the frames of a cache as samples, one after the other; for Unreal the strands that follow them too, with
    their guides and weights."""
    from .simulation import Written

    path = os.fspath(path)
    if len(cache) == 0:
        raise Error(f"it holds no frames, expected one or more: {cache.path}", "file")
    part = f"{path}.part"
    more, bound = cache_attributes(cache, for_)
    with whole(path, part, "archive"):
        file = _File(part, cache.frames_per_second, for_)
        strands = file.strands("hair" if bound is None else "guides")
        strands.describe(cache.starts, cache.widths(), more)
        for points, moved in moments(cache, velocities):
            strands.add(points, moved)
        if bound is not None:
            strands = file.strands("hair", moves=False)
            strands.describe(bound.starts, bound.widths, bound.attributes, len(cache.starts) - 1)
            strands.add(bound.points)
        del strands
        file.close()
    return Written(path, len(cache), os.path.getsize(path), [])


def load_groom(path: str | os.PathLike[str], *, frame: int | None = None, scale: float = 1.0) -> Groom:
    """All curves of an archive as one groom, y up; ``scale`` is metres for each unit. ``frame`` is the number of a
    sample, without it the first is taken."""
    arrays = apart("groom", os.fspath(path), {"frame": frame, "scale": scale})
    names = dict(zip(arrays.pop("named").tolist(), arrays.pop("names").tolist(), strict=True))
    return Groom(arrays.pop("points"), arrays.pop("starts"), widths=arrays.pop("widths"), group_names=names, **arrays)


def load_body(path: str | os.PathLike[str], *, scale: float = 1.0) -> Body:
    """The first mesh of an archive as a Body, y up, with its motion; ``scale`` is metres for each unit."""
    arrays = apart("body", os.fspath(path), {"scale": scale})
    return Body(arrays["vertices"], arrays["faces"], motion=arrays.get("motion"), frames_per_second=float(arrays["rate"]))
