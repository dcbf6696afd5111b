"""USD by the extra [usd]: grooms, bodies over time, and moving hair."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._extras import pxr_package
from ._receivers import attributes, cache_attributes, group_labels, left_out, moments, nearest_guides, placed, point_widths, target, whole
from ._stages import read_body, read_groom, told
from .body import Body
from .errors import Error
from .groom import Groom

if TYPE_CHECKING:
    from .cache import Cache
    from .simulation import Written

#: Bytes of samples that a stage holds before they go to its file.
_HELD = 128 << 20


def load_groom(path: str | os.PathLike[str], *, frame: int | None = None) -> Groom:
    """All linear BasisCurves of a stage as one groom, in metres with y up, with widths, colours, root uv and groups where
    all curves have them. ``frame`` is a time code; without it the first is taken."""
    return told(read_groom, os.fspath(path), frame)  # type: ignore[no-any-return]


def load_body(path: str | os.PathLike[str]) -> Body:
    """The first mesh of a stage as a Body, in metres with y up: with its motion, by time samples of its points or its
    transforms, or by UsdSkel."""
    return told(read_body, os.fspath(path))  # type: ignore[no-any-return]


def _stage(path: str, for_: str, frames_per_second: float, frames: int) -> Any:
    """A new stage with a root for strands."""
    pxr = pxr_package()
    unit, up = target(for_)
    stage = pxr.Usd.Stage.CreateNew(path)
    pxr.UsdGeom.SetStageUpAxis(stage, up)
    pxr.UsdGeom.SetStageMetersPerUnit(stage, unit)
    stage.SetTimeCodesPerSecond(frames_per_second)
    stage.SetFramesPerSecond(frames_per_second)
    if frames > 1:
        stage.SetStartTimeCode(0)
        stage.SetEndTimeCode(frames - 1)
    root = pxr.UsdGeom.Xform.Define(stage, "/Groom")
    root.GetPrim().AddAppliedSchema("GroomAPI")
    stage.SetDefaultPrim(root.GetPrim())
    return stage


def _strands(stage: Any, name: str) -> Any:
    """New linear curves."""
    curves = pxr_package().UsdGeom.BasisCurves.Define(stage, f"/Groom/{name}")
    curves.CreateTypeAttr("linear")
    curves.CreateWrapAttr("nonperiodic")
    return curves


def _describe(curves: Any, starts: NDArray[np.uint32], widths: NDArray[np.float32], more: dict[str, Any], for_: str, first: int = 0) -> None:
    """Writes counts, widths and attributes of strands, whose numbers begin with ``first``."""
    pxr = pxr_package()
    unit, _ = target(for_)
    counts = np.diff(starts.astype(np.int64)).astype(np.int32)
    curves.CreateCurveVertexCountsAttr(pxr.Vt.IntArray.FromNumpy(np.ascontiguousarray(counts)))
    curves.CreateWidthsAttr(pxr.Vt.FloatArray.FromNumpy(np.ascontiguousarray(widths / np.float32(unit), dtype=np.float32)))
    curves.SetWidthsInterpolation("vertex")
    primvars = pxr.UsdGeom.PrimvarsAPI(curves)
    kinds, vt = pxr.Sdf.ValueTypeNames, pxr.Vt

    def put(name: str, kind: Any, place: str, value: Any) -> None:
        primvars.CreatePrimvar(name, kind, place).Set(value)

    def floats(numbers: Any) -> NDArray[np.float32]:
        return np.ascontiguousarray(numbers, dtype=np.float32)

    def integers(numbers: Any) -> Any:
        return vt.IntArray.FromNumpy(np.ascontiguousarray(numbers, dtype=np.int32))

    unreal = for_ == "unreal"
    if "colors" in more:
        put("groom_color" if unreal else "displayColor", kinds.Float3Array if unreal else kinds.Color3fArray, "vertex", vt.Vec3fArray.FromNumpy(floats(more["colors"])))
    if "root_uvs" in more:
        put("groom_root_uv" if unreal else "st", kinds.TexCoord2fArray, "uniform", vt.Vec2fArray.FromNumpy(floats(more["root_uvs"])))
    if "groups" in more:
        put("groom_group_id", kinds.IntArray, "uniform", integers(more["groups"]))
    if labels := group_labels(more):
        put("groom_group_name", kinds.StringArray, "uniform", vt.StringArray(labels))
    if "guide_flags" in more:
        put("groom_guide", kinds.IntArray, "uniform", integers(more["guide_flags"]))
    if unreal:
        put("groom_width", kinds.FloatArray, "vertex", vt.FloatArray.FromNumpy(floats(widths / np.float32(unit))))
        put("groom_id", kinds.IntArray, "uniform", integers(np.arange(first, first + len(counts))))
        if "guide_indices" in more:
            guides, weights = nearest_guides(more["guide_indices"], more["guide_weights"])
            put("groom_closest_guides", kinds.Int3Array, "uniform", vt.Vec3iArray.FromNumpy(guides))
            put("groom_guide_weights", kinds.Float3Array, "uniform", vt.Vec3fArray.FromNumpy(weights))


def _extent(points: NDArray[np.float32], widths: NDArray[np.float32], unit: float) -> Any:
    pxr = pxr_package()
    reach = np.float32(0.5 * float(widths.max(initial=0.0)) / unit)
    corners = np.stack([points.min(axis=0) - reach, points.max(axis=0) + reach])
    return pxr.Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(corners, dtype=np.float32))


def _part(path: str) -> str:
    folder, name = os.path.split(path)
    return os.path.join(folder, f".part-{os.getpid()}-{name}")


def save_groom(groom: Groom, path: str | os.PathLike[str], *, for_: str = "any") -> list[str]:
    """Writes a groom at rest; returns notes on what the file lacks."""
    pxr, path = pxr_package(), os.fspath(path)
    part = _part(path)
    with whole(path, part, "stage"):
        stage = _stage(part, for_, 24.0, 1)
        curves = _strands(stage, "Hair")
        widths = point_widths(groom)
        _describe(curves, groom.starts, widths, attributes(groom), for_)
        points = placed(groom.points, for_)
        curves.CreatePointsAttr(pxr.Vt.Vec3fArray.FromNumpy(points))
        if "velocities" in groom:
            curves.CreateVelocitiesAttr(pxr.Vt.Vec3fArray.FromNumpy(placed(groom["velocities"], for_)))
        curves.CreateExtentAttr(_extent(points, widths, target(for_)[0]))
        stage.GetRootLayer().Save()
    return left_out(groom, path, for_)


def save_cache(cache: Cache, path: str | os.PathLike[str], *, for_: str = "any", velocities: bool = False) -> Written:
    """Writes the frames of a cache as time samples, one after the other; for Unreal the strands that follow them too, with
    their guides and weights."""
    from .simulation import Written

    pxr, path = pxr_package(), os.fspath(path)
    if len(cache) == 0:
        raise Error(f"it holds no frames, expected one or more: {cache.path}", "file")
    part, unit = _part(path), target(for_)[0]
    with whole(path, part, "stage"):
        stage = _stage(part, for_, cache.frames_per_second, len(cache))
        more, bound = cache_attributes(cache, for_)
        curves = _strands(stage, "Hair" if bound is None else "Guides")
        widths = cache.widths()
        _describe(curves, cache.starts, widths, more, for_)
        if bound is not None:
            strands = _strands(stage, "Hair")
            _describe(strands, bound.starts, bound.widths, bound.attributes, for_, len(cache.starts) - 1)
            points = placed(bound.points, for_)
            strands.CreatePointsAttr(pxr.Vt.Vec3fArray.FromNumpy(points))
            strands.CreateExtentAttr(_extent(points, bound.widths, unit))
        points_attribute, extent = curves.CreatePointsAttr(), curves.CreateExtentAttr()
        moved_attribute = curves.CreateVelocitiesAttr() if velocities else None
        held = 0
        for frame, (points, moved) in enumerate(moments(cache, velocities)):
            points = placed(points, for_)
            points_attribute.Set(pxr.Vt.Vec3fArray.FromNumpy(points), frame)
            extent.Set(_extent(points, widths, unit), frame)
            if moved_attribute is not None and moved is not None:
                moved_attribute.Set(pxr.Vt.Vec3fArray.FromNumpy(placed(moved, for_)), frame)
            # Samples leave memory for the file now and then.
            held += points.nbytes * (1 if moved is None else 2)
            if held > _HELD:
                stage.GetRootLayer().Save()
                held = 0
        stage.GetRootLayer().Save()
    return Written(path, len(cache), os.path.getsize(path), [])
