"""USD that is read: grooms, and bodies over time."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._extras import pxr_package
from ._receivers import group_names, joined, of_file, triangles
from .body import Body
from .errors import Error
from .groom import Groom


def told(read: Any, path: str, *more: Any) -> Any:
    """Reads something of a stage; errors of the library name the file."""
    try:
        return read(path, *more)
    except Error:
        raise
    except MemoryError:
        raise Error(f"cannot read the stage: it needs more memory than there is: {path}", "file") from None
    except Exception as error:
        raise Error(f"cannot read the stage: {first_line(error)}: {path}", "file") from None


def _opened(path: str | os.PathLike[str]) -> Any:
    pxr = pxr_package()
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


def first_line(error: BaseException) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return lines[-1] if lines else type(error).__name__


def _to_here(stage: Any) -> NDArray[np.float64]:
    """The 4 x 4 matrix, for columns, from the stage's space to metres with y up."""
    geometry = pxr_package().UsdGeom
    unit = geometry.GetStageMetersPerUnit(stage)
    axes = np.eye(4)
    if geometry.GetStageUpAxis(stage) == geometry.Tokens.z:
        axes[:3, :3] = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    axes[:3, :3] *= unit
    return axes


def _carried(points: Any, matrix: NDArray[np.float64]) -> NDArray[np.float32]:
    rows = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    return np.ascontiguousarray(rows @ matrix[:3, :3].T + matrix[:3, 3], dtype=np.float32)


def _turned(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """A matrix without its translation, for directions."""
    turned = np.eye(4)
    turned[:3, :3] = matrix[:3, :3]
    return turned


def _world(prim: Any, time: Any) -> NDArray[np.float64]:
    """The 4 x 4 matrix, for columns, from a prim to its stage."""
    matrix = pxr_package().UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(time)
    return np.asarray(matrix, dtype=np.float64).T


def _time(stage: Any, frame: int | None) -> Any:
    usd = pxr_package().Usd
    return usd.TimeCode.EarliestTime() if frame is None else usd.TimeCode(float(frame))


def read_groom(path: str, frame: int | None) -> Groom:
    stage = _opened(path)
    pxr = pxr_package()
    time, here = _time(stage, frame), _to_here(stage)
    parts: list[dict[str, Any]] = []
    found = [prim for prim in stage.Traverse() if prim.IsA(pxr.UsdGeom.BasisCurves)]
    codes = [code for prim in found for code in pxr.UsdGeom.BasisCurves(prim).GetPointsAttr().GetTimeSamples()]
    if frame is not None and codes and not min(codes) <= frame <= max(codes):
        raise Error(f"frame is {frame}, expected {min(codes):g} to {max(codes):g}, its time codes: {path}", "value")
    for prim in found:
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
        part: dict[str, Any] = {"counts": counts, "points": _carried(points, matrix)}
        if not np.all(np.isfinite(part["points"])):
            raise Error(f"{prim.GetPath()} has points that are not finite: {path}", "file")
        part.update(_attributes(curves, counts, matrix, time))
        parts.append(part)
    if not parts:
        raise Error(f"it holds no BasisCurves with points, expected strands: {path}", "file")
    return joined(parts, path)


def _attributes(curves: Any, counts: NDArray[np.int64], matrix: NDArray[np.float64], time: Any) -> dict[str, Any]:
    """Attributes of curves per point or per strand, by name; ``matrix`` carries them to metres with y up."""
    pxr = pxr_package()
    sizes = {"point": int(counts.sum()), "strand": len(counts)}
    primvars = pxr.UsdGeom.PrimvarsAPI(curves)

    def read(name: str) -> NDArray[Any] | None:
        primvar = primvars.GetPrimvar(name)
        value = primvar.ComputeFlattened(time) if primvar and primvar.HasValue() else None
        return None if value is None else np.asarray(value)

    def either(*names: str) -> NDArray[Any] | None:
        return next((value for value in map(read, names) if value is not None), None)

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
    scale = float(np.cbrt(abs(np.linalg.det(matrix[:3, :3]))))
    velocities = curves.GetVelocitiesAttr().Get(time)
    moved = None if velocities is None or len(velocities) != sizes["point"] else _carried(velocities, _turned(matrix))
    found: dict[str, Any] = {
        "widths": spread(None if widths is None else widths * scale, "point"),
        "velocities": moved if moved is not None and np.all(np.isfinite(moved)) else None,
        "colors": spread(either("displayColor", "groom_color"), "point"),
        "root_uvs": spread(either("st", "groom_root_uv", "surface_uv_coordinate"), "strand"),
        "groups": spread(either("groom_group_id", "group_id"), "strand"),
        "guide_flags": spread(read("groom_guide"), "strand"),
        "ids": spread(read("groom_id"), "strand"),
    }
    labels = spread(either("groom_group_name", "group_name"), "strand")
    if labels is not None:
        found["group_names"] = group_names(found["groups"], labels.tolist())
    closest, shares = read("groom_closest_guides"), read("groom_guide_weights")
    if all(rows is not None and rows.shape == (sizes["strand"], 3) for rows in (closest, shares)):
        found |= {"closest": closest, "shares": shares}
    return {name: numbers for name, numbers in found.items() if numbers is not None}


def read_body(path: str) -> Body:
    stage = _opened(path)
    pxr = pxr_package()
    mesh = next((prim for prim in stage.Traverse() if prim.IsA(pxr.UsdGeom.Mesh)), None)
    if mesh is None:
        raise Error(f"it holds no Mesh, expected a body: {path}", "file")
    geometry, here = pxr.UsdGeom.Mesh(mesh), _to_here(stage)
    counts = np.asarray(geometry.GetFaceVertexCountsAttr().Get() or [], dtype=np.int64)
    corners = np.asarray(geometry.GetFaceVertexIndicesAttr().Get() or [], dtype=np.int64)
    if counts.sum() != len(corners) or counts.size == 0:
        raise Error(f"{mesh.GetPath()} has {len(corners)} corners, expected {counts.sum()} by its counts: {path}", "file")
    faces = triangles(counts, corners)
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
        with of_file(path):
            return Body(rest, faces)
    shapes = [shape(pxr.Usd.TimeCode(code)) for code in codes]
    if any(len(one) != len(rest) for one in shapes):
        raise Error(f"{mesh.GetPath()} changes its number of vertices, expected the same at every time: {path}", "file")
    with of_file(path):
        return Body(rest, faces, motion=np.stack(shapes), frames_per_second=stage.GetTimeCodesPerSecond() or 24.0)


def _codes(stage: Any, mesh: Any, skinned: bool) -> list[float]:
    """Time codes at which the mesh has a shape, one for each whole code in its range."""
    pxr = pxr_package()
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
    pxr = pxr_package()
    root = pxr.UsdSkel.Root.Find(mesh)
    if not root or not mesh.HasAPI(pxr.UsdSkel.BindingAPI):
        return None
    cache = pxr.UsdSkel.Cache()
    cache.Populate(root, pxr.Usd.TraverseInstanceProxies())
    query = cache.GetSkinningQuery(mesh)
    if not query or not query.HasJointInfluences():
        return None
    bound = pxr.UsdSkel.BindingAPI(mesh).GetInheritedSkeleton()
    skeleton = cache.GetSkelQuery(bound) if bound else None
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
