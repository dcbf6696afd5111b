"""USD by the extra [usd]: grooms, bodies over time, and moving hair."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .body import Body
from .errors import Error, missing
from .groom import HAIR_WIDTH, Groom

if TYPE_CHECKING:
    from .cache import Cache
    from .simulation import Written

#: Metres for each unit, up axis, and turn of y-up points, by receiver.
TARGETS: dict[str, tuple[float, str]] = {"any": (1.0, "Y"), "unreal": (0.01, "Z"), "blender": (1.0, "Z")}

#: Bytes of samples that a stage holds before they go to its file.
_HELD = 128 << 20


def required() -> Any:
    """The package pxr, or the error that names the extra."""
    try:
        import pxr
        from pxr import Gf, Sdf, Usd, UsdGeom, UsdSkel, Vt  # noqa: F401
    except ImportError:
        raise missing("usd-core", "usd") from None
    return pxr


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


def _opened(path: str | os.PathLike[str]) -> Any:
    pxr = required()
    path = os.fspath(path)
    if not os.path.isfile(path):
        raise Error(f"cannot read the stage: no such file: {path}", "file")
    try:
        stage = pxr.Usd.Stage.Open(path)
    except Exception:
        stage = None
    if stage is None:
        raise Error(f"cannot read the stage: no USD in it, or not a whole file: {path}", "file")
    return stage


def _first_line(error: BaseException) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return lines[-1] if lines else type(error).__name__


def _to_here(stage: Any) -> NDArray[np.float64]:
    """The 4 x 4 matrix, for columns, from the stage's space to metres with y up."""
    geometry = required().UsdGeom
    unit = geometry.GetStageMetersPerUnit(stage)
    axes = np.eye(4)
    if geometry.GetStageUpAxis(stage) == geometry.Tokens.z:
        axes[:3, :3] = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    axes[:3, :3] *= unit
    return axes


def _carried(points: Any, matrix: NDArray[np.float64]) -> NDArray[np.float32]:
    rows = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    return np.ascontiguousarray(rows @ matrix[:3, :3].T + matrix[:3, 3], dtype=np.float32)


def _world(prim: Any, time: Any) -> NDArray[np.float64]:
    """The 4 x 4 matrix, for columns, from a prim to its stage."""
    matrix = required().UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(time)
    return np.asarray(matrix, dtype=np.float64).T


def _time(stage: Any, frame: int | None) -> Any:
    usd = required().Usd
    return usd.TimeCode.EarliestTime() if frame is None else usd.TimeCode(float(frame))


def load_groom(path: str | os.PathLike[str], *, frame: int | None = None) -> Groom:
    """All linear BasisCurves of a stage as one groom, in metres with y up, with widths, colours, root uv and groups where
    all curves have them. ``frame`` is a time code; without it the first is taken."""
    return _told(_read_groom, os.fspath(path), frame)  # type: ignore[no-any-return]


def load_body(path: str | os.PathLike[str]) -> Body:
    """The first mesh of a stage as a Body, in metres with y up: with its motion, by time samples of its points or its
    transforms, or by UsdSkel."""
    return _told(_read_body, os.fspath(path))  # type: ignore[no-any-return]


def _told(read: Any, path: str, *more: Any) -> Any:
    """What a function reads of a stage; what the library finds wrong names the file."""
    try:
        return read(path, *more)
    except Error:
        raise
    except MemoryError:
        raise Error(f"cannot read the stage: it needs more memory than there is: {path}", "file") from None
    except Exception as error:
        raise Error(f"cannot read the stage: {_first_line(error)}: {path}", "file") from None


def _read_groom(path: str, frame: int | None) -> Groom:
    stage = _opened(path)
    pxr = required()
    time, here = _time(stage, frame), _to_here(stage)
    parts: list[dict[str, Any]] = []
    for prim in stage.Traverse():
        if not prim.IsA(pxr.UsdGeom.BasisCurves):
            continue
        curves = pxr.UsdGeom.BasisCurves(prim)
        counts = np.asarray(curves.GetCurveVertexCountsAttr().Get(time) or [], dtype=np.int64)
        points = curves.GetPointsAttr().Get(time)
        if points is None or counts.size == 0:
            continue
        kind, basis = curves.GetTypeAttr().Get(), curves.GetBasisAttr().Get()
        if kind == "cubic" and basis in ("bezier", "bspline"):
            raise Error(f"{prim.GetPath()} has cubic curves of the basis {basis}, expected linear or catmullRom: {path}", "file")
        if counts.min() < 0 or counts.sum() != len(points):
            raise Error(f"{prim.GetPath()} has {len(points)} points, expected {counts.sum()} by its counts: {path}", "file")
        matrix = here @ _world(prim, time)
        scale = float(np.cbrt(abs(np.linalg.det(matrix[:3, :3]))))
        part: dict[str, Any] = {"counts": counts, "points": _carried(points, matrix)}
        if not np.all(np.isfinite(part["points"])):
            raise Error(f"{prim.GetPath()} has points that are not finite: {path}", "file")
        part.update(_attributes(curves, counts, scale, time))
        parts.append(part)
    if not parts:
        raise Error(f"it holds no BasisCurves with points, expected strands: {path}", "file")
    counts = np.concatenate([part["counts"] for part in parts])
    shared: dict[str, Any] = {name: np.concatenate([part[name] for part in parts]) for name in parts[0] if name not in ("counts", "points") and all(name in part for part in parts)}
    widths = shared.pop("widths", None)
    starts = np.concatenate([[0], np.cumsum(counts)])
    points = np.concatenate([part["points"] for part in parts])
    groom = Groom(points, starts, **({} if widths is None else {"widths": widths}), **shared)
    thin = counts < 2
    return groom.selected(~thin) if thin.any() else groom


def _attributes(curves: Any, counts: NDArray[np.int64], scale: float, time: Any) -> dict[str, Any]:
    """Attributes of curves per point or per strand, by name."""
    pxr = required()
    sizes = {"point": int(counts.sum()), "strand": len(counts)}
    primvars = pxr.UsdGeom.PrimvarsAPI(curves)

    def read(name: str) -> NDArray[Any] | None:
        primvar = primvars.GetPrimvar(name)
        value = primvar.ComputeFlattened(time) if primvar and primvar.HasValue() else None
        return None if value is None else np.asarray(value)

    def spread(numbers: NDArray[Any] | None, place: str) -> NDArray[Any] | None:
        if numbers is None or numbers.ndim == 0:
            return None
        if len(numbers) == sizes[place]:
            return numbers
        if len(numbers) == 1:
            return np.repeat(numbers, sizes[place], axis=0)
        if place == "point" and len(numbers) == sizes["strand"]:
            return np.repeat(numbers, counts, axis=0)
        return None

    own = curves.GetWidthsAttr().Get(time)
    widths = read("groom_width") if own is None else np.asarray(own)
    found = {
        "widths": spread(None if widths is None else widths * scale, "point"),
        "colors": spread(next((value for value in map(read, ("displayColor", "groom_color")) if value is not None), None), "point"),
        "root_uvs": spread(next((value for value in map(read, ("st", "groom_root_uv", "surface_uv_coordinate")) if value is not None), None), "strand"),
        "groups": spread(read("groom_group_id"), "strand"),
        "guide_flags": spread(read("groom_guide"), "strand"),
    }
    return {name: numbers for name, numbers in found.items() if numbers is not None}


def _read_body(path: str) -> Body:
    stage = _opened(path)
    pxr = required()
    mesh = next((prim for prim in stage.Traverse() if prim.IsA(pxr.UsdGeom.Mesh)), None)
    if mesh is None:
        raise Error(f"it holds no Mesh, expected a body: {path}", "file")
    geometry, here = pxr.UsdGeom.Mesh(mesh), _to_here(stage)
    counts = np.asarray(geometry.GetFaceVertexCountsAttr().Get() or [], dtype=np.int64)
    corners = np.asarray(geometry.GetFaceVertexIndicesAttr().Get() or [], dtype=np.int64)
    if counts.sum() != len(corners) or counts.size == 0:
        raise Error(f"{mesh.GetPath()} has {len(corners)} corners, expected {counts.sum()} by its counts: {path}", "file")
    faces = _triangles(counts, corners)
    skin = _skinned(stage, mesh)
    codes = _codes(stage, mesh, skin is not None)

    def shape(time: Any) -> NDArray[np.float32]:
        points = geometry.GetPointsAttr().Get(time)
        if points is None:
            raise Error(f"{mesh.GetPath()} has no points: {path}", "file")
        if skin is not None:
            points, world = skin(time, points), np.eye(4)
            return _carried(points, here @ world)
        return _carried(points, here @ _world(mesh, time))

    rest = shape(pxr.Usd.TimeCode(codes[0]) if codes else pxr.Usd.TimeCode.Default())
    if faces.size and (faces.min() < 0 or faces.max() >= len(rest)):
        raise Error(f"{mesh.GetPath()} has the corner {faces.max()} of {len(rest)} vertices: {path}", "file")
    if len(codes) < 2:
        return Body(rest, faces)
    shapes = [shape(pxr.Usd.TimeCode(code)) for code in codes]
    if any(len(one) != len(rest) for one in shapes):
        raise Error(f"{mesh.GetPath()} changes its number of vertices, expected the same at every time: {path}", "file")
    return Body(rest, faces, motion=np.stack(shapes), frames_per_second=stage.GetTimeCodesPerSecond() or 24.0)


def _triangles(counts: NDArray[np.int64], corners: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles of polygons, as fans."""
    starts = np.concatenate([[0], np.cumsum(counts)[:-1]])
    fans: list[NDArray[np.int64]] = []
    for size in np.unique(counts[counts > 2]):
        first = starts[counts == size]
        fans.extend(np.stack([corners[first], corners[first + at], corners[first + at + 1]], axis=1) for at in range(1, size - 1))
    return np.concatenate(fans) if fans else np.empty((0, 3), dtype=np.int64)


def _codes(stage: Any, mesh: Any, skinned: bool) -> list[float]:
    """Time codes at which the mesh has a shape, one for each whole code in its range."""
    pxr = required()
    times = set(pxr.UsdGeom.Mesh(mesh).GetPointsAttr().GetTimeSamples())
    prim = mesh
    while prim and not prim.IsPseudoRoot():
        times.update(pxr.UsdGeom.Xformable(prim).GetTimeSamples() if prim.IsA(pxr.UsdGeom.Xformable) else [])
        prim = prim.GetParent()
    if skinned and stage.HasAuthoredTimeCodeRange():
        times.update([stage.GetStartTimeCode(), stage.GetEndTimeCode()])
    if len(times) < 2:
        return sorted(times)
    first, last = min(times), max(times)
    return [float(code) for code in np.arange(first, last + 0.5, 1.0)]


def _skinned(stage: Any, mesh: Any) -> Any:
    """A function from a time and points to points that joints carry, in the stage's space; None without joints."""
    pxr = required()
    root = pxr.UsdSkel.Root.Find(mesh)
    if not root or not mesh.HasAPI(pxr.UsdSkel.BindingAPI):
        return None
    cache = pxr.UsdSkel.Cache()
    cache.Populate(root, pxr.Usd.TraverseInstanceProxies())
    query = cache.GetSkinningQuery(mesh)
    if not query or not query.HasJointInfluences():
        return None
    skeleton = cache.GetSkelQuery(pxr.UsdSkel.BindingAPI(mesh).GetInheritedSkeleton().GetPrim() and pxr.UsdSkel.BindingAPI(mesh).GetInheritedSkeleton())
    if not skeleton:
        return None

    def carry(time: Any, points: Any) -> NDArray[np.float64]:
        transforms = skeleton.ComputeSkinningTransforms(time)
        moved = pxr.Vt.Vec3fArray(points)
        query.ComputeSkinnedPoints(transforms, moved, time)
        matrix = _world(skeleton.GetPrim(), time)
        rows = np.asarray(moved, dtype=np.float64)
        return np.asarray(rows @ matrix[:3, :3].T + matrix[:3, 3])

    return carry


def _stage(path: str, for_: str, frames_per_second: float, frames: int) -> Any:
    """A new stage with a root for strands."""
    pxr = required()
    unit, up = target(for_)
    folder = os.path.dirname(path) or "."
    if not os.access(folder, os.W_OK):
        raise Error(f"cannot write the stage: no such folder, or no permission: {folder}", "file")
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
    curves = required().UsdGeom.BasisCurves.Define(stage, f"/Groom/{name}")
    curves.CreateTypeAttr("linear")
    curves.CreateWrapAttr("nonperiodic")
    return curves


def _describe(curves: Any, starts: NDArray[np.uint32], widths: NDArray[np.float32], more: dict[str, Any], for_: str, first: int = 0) -> None:
    """Writes counts, widths and attributes of strands, whose numbers begin with ``first``."""
    pxr = required()
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

    def whole(numbers: Any) -> Any:
        return vt.IntArray.FromNumpy(np.ascontiguousarray(numbers, dtype=np.int32))

    unreal = for_ == "unreal"
    if "colors" in more:
        put("groom_color" if unreal else "displayColor", kinds.Float3Array if unreal else kinds.Color3fArray, "vertex", vt.Vec3fArray.FromNumpy(floats(more["colors"])))
    if "root_uvs" in more:
        put("groom_root_uv" if unreal else "st", kinds.TexCoord2fArray, "uniform", vt.Vec2fArray.FromNumpy(floats(more["root_uvs"])))
    if "groups" in more:
        put("groom_group_id", kinds.IntArray, "uniform", whole(more["groups"]))
    if "guide_flags" in more:
        put("groom_guide", kinds.IntArray, "uniform", whole(more["guide_flags"]))
    if unreal:
        put("groom_width", kinds.FloatArray, "vertex", vt.FloatArray.FromNumpy(floats(widths / np.float32(unit))))
        put("groom_id", kinds.IntArray, "uniform", whole(np.arange(first, first + len(counts))))
        if "guide_indices" in more:
            guides, weights = nearest_guides(more["guide_indices"], more["guide_weights"])
            put("groom_closest_guides", kinds.Int3Array, "uniform", vt.Vec3iArray.FromNumpy(guides))
            put("groom_guide_weights", kinds.Float3Array, "uniform", vt.Vec3fArray.FromNumpy(weights))


def _extent(points: NDArray[np.float32], widths: NDArray[np.float32], unit: float) -> Any:
    pxr = required()
    reach = np.float32(0.5 * float(widths.max(initial=0.0)) / unit)
    corners = np.stack([points.min(axis=0) - reach, points.max(axis=0) + reach])
    return pxr.Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(corners, dtype=np.float32))


def _is_written(stage: Any, part: str, path: str) -> None:
    """Saves a stage beside its name, then gives it the name."""
    try:
        stage.GetRootLayer().Save()
        os.replace(part, path)
    except Exception as error:
        raise Error(f"cannot write the stage: {_first_line(error)}: {path}", "file") from None


def _part(path: str) -> str:
    folder, name = os.path.split(path)
    return os.path.join(folder, f".part-{os.getpid()}-{name}")


def save_groom(groom: Groom, path: str | os.PathLike[str], *, for_: str = "any") -> list[str]:
    """Writes a groom at rest; returns notes on what the file lacks."""
    pxr, path = required(), os.fspath(path)
    part = _part(path)
    try:
        stage = _stage(part, for_, 24.0, 1)
        curves = _strands(stage, "Hair")
        widths = point_widths(groom)
        _describe(curves, groom.starts, widths, groom.attributes, for_)
        points = placed(groom.points, for_)
        curves.CreatePointsAttr(pxr.Vt.Vec3fArray.FromNumpy(points))
        curves.CreateExtentAttr(_extent(points, widths, target(for_)[0]))
        _is_written(stage, part, path)
    finally:
        if os.path.exists(part):
            os.remove(part)
    return left_out(groom, path, for_)


def left_out(groom: Groom, path: str, for_: str) -> list[str]:
    """Notes on attributes that a file of a receiver has not."""
    weights = ("guide_indices", "guide_weights") if for_ == "unreal" else ()
    held = ("colors", "root_uvs", "groups", "guide_flags", *weights)
    return [f"{os.path.basename(path)} has no {name}" for name in groom.attributes if name not in held]


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
    more = {own: found[name] for name, own in named.items() if name in found}
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


def save_cache(cache: Cache, path: str | os.PathLike[str], *, for_: str = "any", velocities: bool = False) -> Written:
    """Writes the frames of a cache as time samples, one after the other; for Unreal the strands that follow them too, with
    their guides and weights."""
    from .simulation import Written

    pxr, path = required(), os.fspath(path)
    if len(cache) == 0:
        raise Error(f"it holds no frames, expected one or more: {cache.path}", "file")
    part, unit = _part(path), target(for_)[0]
    try:
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
        _is_written(stage, part, path)
    finally:
        if os.path.exists(part):
            os.remove(part)
    return Written(path, len(cache), os.path.getsize(path), [])
