"""Alembic by the extra [abc]: grooms, bodies over time, and moving hair."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import threading
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .body import Body
from .errors import Error, missing
from .groom import Groom
from .usd import cache_attributes, left_out, moments, nearest_guides, placed, point_widths, target

if TYPE_CHECKING:
    from .cache import Cache
    from .simulation import Written

#: Version of Unreal's schema of grooms, and our name in it.
_MAJOR, _MINOR, _TOOL = 1, 5, "strandline"


def required() -> Any:
    """The package alembic3d, or the error that names the extra."""
    try:
        import alembic3d
        import alembic3d.Abc
        import alembic3d.AbcCoreAbstract
        import alembic3d.AbcGeom
    except ImportError:
        raise missing("alembic3d", "abc") from None
    return alembic3d


def _vectors(points: NDArray[np.float32]) -> Any:
    import imath

    return imath.V3fArrayFromBuffer(np.ascontiguousarray(points, dtype=np.float32))


def _floats(numbers: Any) -> Any:
    import imath

    return imath.FloatArrayFromBuffer(np.ascontiguousarray(numbers, dtype=np.float32))


def _whole(numbers: Any) -> Any:
    import imath

    return imath.IntArrayFromBuffer(np.ascontiguousarray(numbers, dtype=np.int32))


class _File:
    """An archive of curves that is being written."""

    def __init__(self, path: str, frames_per_second: float, for_: str) -> None:
        package = required()
        target(for_)
        self.for_ = for_
        try:
            self._archive = package.Abc.OArchive(path)
        except Exception:
            raise Error(f"cannot write the archive: no such folder, or no permission: {path}", "file") from None
        sampling = package.AbcCoreAbstract.TimeSampling(1.0 / frames_per_second, 0.0)
        self._index = self._archive.addTimeSampling(sampling)
        self._strands: list[_Strands] = []

    def strands(self, name: str, moves: bool = True) -> _Strands:
        """New curves by a name."""
        package = required()
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
        package = required()
        geometry = package.AbcGeom
        counts = np.diff(starts.astype(np.int64)).astype(np.int32)
        unit, _ = target(self._for)
        vertex = geometry.GeometryScope.kVertexScope
        uniform = geometry.GeometryScope.kUniformScope
        self._counts = _whole(counts)
        thick = _floats(widths / np.float32(unit))
        self._widths = geometry.OFloatGeomParamSample(thick, vertex)
        arbitrary = self._schema.getArbGeomParams()

        def put(kind: str, name: str, value: Any, scope: Any) -> None:
            param = getattr(geometry, f"O{kind}GeomParam")(arbitrary, name, False, scope, 1)
            param.set(getattr(geometry, f"O{kind}GeomParamSample")(value, scope))

        put("Float", "groom_width", thick, vertex)
        put("Int32", "groom_id", _whole(np.arange(first, first + len(counts))), uniform)
        if "colors" in more:
            put("V3f", "groom_color", _vectors(more["colors"]), vertex)
        if "root_uvs" in more:
            import imath

            uvs = imath.V2fArrayFromBuffer(np.ascontiguousarray(more["root_uvs"], dtype=np.float32))
            put("V2f", "groom_root_uv", uvs, uniform)
        if "groups" in more:
            put("Int32", "groom_group_id", _whole(more["groups"]), uniform)
        if "guide_flags" in more:
            put("Int32", "groom_guide", _whole(more["guide_flags"]), uniform)
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
        geometry = required().AbcGeom
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
    file = _File(part, 24.0, for_)
    try:
        strands = file.strands("hair")
        strands.describe(groom.starts, point_widths(groom), groom.attributes)
        strands.add(groom.points)
        del strands
        file.close()
        os.replace(part, path)
    finally:
        if os.path.exists(part):
            os.remove(part)
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
    file = _File(part, cache.frames_per_second, for_)
    try:
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
        os.replace(part, path)
    finally:
        if os.path.exists(part):
            os.remove(part)
    return Written(path, len(cache), os.path.getsize(path), [])


def _checked(path: str) -> None:
    """Refuses what is no whole archive."""
    try:
        with open(path, "rb") as file:
            head = file.read(6)
    except OSError as error:
        raise Error(f"cannot read the archive: {error.strerror}: {path}", "file") from None
    if head[:5] != b"Ogawa":
        raise Error(f"not an Alembic archive: it starts with {head[:5]!r}, expected b'Ogawa': {path}", "file")
    if head[5:6] != b"\xff":
        raise Error(f"the archive is not complete: whoever wrote it was stopped: {path}", "file")


def _opened(path: str) -> Any:
    package = required()
    try:
        archive = package.Abc.IArchive(path)
        return archive, archive.getTop()
    except Exception as error:
        raise Error(f"cannot read the archive: {_first_line(error)}: {path}", "file") from None


def _first_line(error: BaseException) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return lines[0] if lines else type(error).__name__


def _below(of: Any, depth: int = 0) -> Any:
    """Objects below one, at most 64 levels."""
    for index in range(of.getNumChildren() if depth < 64 else 0):
        child = of.getChild(index)
        yield child
        yield from _below(child, depth + 1)


def _world(of: Any, time: float) -> NDArray[np.float64]:
    """The 4 x 4 matrix, for columns, of the transforms above an object."""
    package = required()
    matrix = np.eye(4)
    parent = of.getParent()
    while parent and parent.getParent().valid():
        if package.AbcGeom.IXform.matches(parent.getHeader()):
            schema = package.AbcGeom.IXform(parent, package.Abc.WrapExistingFlag.kWrapExisting).getSchema()
            own = schema.getValue(package.Abc.ISampleSelector(float(time))).getMatrix()
            rows = np.array([[own[row][column] for column in range(4)] for row in range(4)], dtype=np.float64)
            matrix = rows.T @ matrix
        parent = parent.getParent()
    return matrix


def _at(schema: Any, index: int) -> Any:
    """Selects a sample by its time: a number alone would be taken for a time too."""
    return required().Abc.ISampleSelector(float(schema.getTimeSampling().getSampleTime(index)))


def _array(of: Any, columns: int = 3) -> NDArray[Any]:
    array = np.array(of)
    return array.reshape(-1, columns) if columns > 1 else array.reshape(-1)


def load_groom(path: str | os.PathLike[str], *, frame: int | None = None, scale: float = 1.0) -> Groom:
    """All curves of an archive as one groom, y up; ``scale`` is metres for each unit. ``frame`` is the number of a
    sample, without it the first is taken."""
    arrays = _apart("groom", os.fspath(path), {"frame": frame, "scale": scale})
    return Groom(arrays.pop("points"), arrays.pop("starts"), widths=arrays.pop("widths"), **arrays)


def load_body(path: str | os.PathLike[str], *, scale: float = 1.0) -> Body:
    """The first mesh of an archive as a Body, y up, with its motion; ``scale`` is metres for each unit."""
    arrays = _apart("body", os.fspath(path), {"scale": scale})
    return Body(arrays["vertices"], arrays["faces"], motion=arrays.get("motion"), frames_per_second=float(arrays["rate"]))


def _apart(what: str, path: str, options: dict[str, Any]) -> dict[str, Any]:
    """The arrays of an archive, which a process of its own reads: the library ends its process on some damaged files."""
    required()
    _checked(path)
    with tempfile.TemporaryDirectory(prefix="strandline-") as folder:
        out = os.path.join(folder, "read.npz")
        answer = _reader.ask({"what": what, "file": os.path.abspath(path), "out": out, "options": options})
        if answer == ["done"]:
            with np.load(out) as arrays:
                return {name: arrays[name] for name in arrays.files}
    text, kind = answer or (f"cannot read the archive: its reader broke off, the file is damaged: {path}", "file")
    raise Error(text.replace(os.path.abspath(path), path), kind)


class _Reader:
    """A process that reads archives one after the other; it ends with this one, and begins anew where a file ends it."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._process: subprocess.Popen[str] | None = None
        self._owner = 0

    def ask(self, task: dict[str, Any]) -> list[str]:
        """The answer to a task; none where the file ended the process."""
        with self._lock:
            process = self._running()
            assert process.stdin is not None and process.stdout is not None
            try:
                print(json.dumps(task), file=process.stdin, flush=True)
                return list(json.loads(process.stdout.readline()))
            except (OSError, ValueError):
                process.kill()
                process.wait()
                return []

    def _running(self) -> subprocess.Popen[str]:
        # A forked process has a reader of its own.
        if self._process is None or self._owner != os.getpid() or self._process.poll() is not None:
            code = f"import sys; sys.path[:] = {sys.path!r}; import strandline.abc as own; own._serve()"
            pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
            self._process = subprocess.Popen([sys.executable, "-c", code], text=True, start_new_session=True, **pipes)
            self._owner = os.getpid()
        return self._process


_reader = _Reader()


def _serve() -> None:
    """Reads the archives that lines of standard input ask for."""
    for line in sys.stdin:
        print(json.dumps(_answer(json.loads(line))), flush=True)


def _answer(task: dict[str, Any]) -> list[str]:
    arrays: dict[str, Any]
    try:
        if task["what"] == "groom":
            groom = _read_groom(task["file"], **task["options"])
            arrays = {"points": groom.points, "starts": groom.starts, "widths": np.asarray(groom.widths), **groom.attributes}
        else:
            body = _read_body(task["file"], **task["options"])
            arrays = {"vertices": body.vertices, "faces": body.faces, "rate": np.asarray(body.frames_per_second)}
            arrays |= {} if body.motion is None else {"motion": body.motion}
        np.savez(task["out"], **arrays)
    except Error as error:
        return [str(error), error.kind]
    except Exception as error:
        return [f"cannot read the archive: {_first_line(error)}: {task['file']}", "file"]
    return ["done"]


def _read_groom(path: str, frame: int | None, scale: float) -> Groom:
    archive, top = _opened(path)
    geometry = required().AbcGeom
    parts: list[dict[str, Any]] = []
    try:
        for of in _below(top):
            if geometry.ICurves.matches(of.getHeader()):
                part = _curves(of, frame or 0, scale)
                if len(part["counts"]):
                    parts.append(part)
    except (RuntimeError, IndexError, ValueError) as error:
        raise Error(f"cannot read the archive: {_first_line(error)}: {path}", "file") from None
    del archive
    if not parts:
        raise Error(f"it holds no curves, expected strands: {path}", "file")
    counts = np.concatenate([part["counts"] for part in parts]).astype(np.int64)
    points = np.concatenate([part["points"] for part in parts])
    if counts.min() < 0 or counts.sum() != len(points) or not np.all(np.isfinite(points)):
        raise Error(f"it holds {len(points)} points, expected {counts.sum()} by its counts, all finite: {path}", "file")
    names = [name for name in parts[0] if name not in ("counts", "points") and all(name in part for part in parts)]
    shared: dict[str, Any] = {name: np.concatenate([part[name] for part in parts]) for name in names}
    starts = np.concatenate([[0], np.cumsum(counts)])
    groom = Groom(points, starts, **shared)
    return groom.selected(counts > 1) if (counts < 2).any() else groom


def _curves(of: Any, index: int, scale: float) -> dict[str, Any]:
    package = required()
    schema = package.AbcGeom.ICurves(of, package.Abc.WrapExistingFlag.kWrapExisting).getSchema()
    index = min(index, max(schema.getNumSamples() - 1, 0))
    at = _at(schema, index)
    sample = schema.getValue(at)
    time = schema.getTimeSampling().getSampleTime(index)
    matrix = _world(of, time)
    counts = _array(sample.getCurvesNumVertices(), 1)
    points = _array(sample.getPositions()).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    size = scale * float(np.cbrt(abs(np.linalg.det(matrix[:3, :3]))))
    part: dict[str, Any] = {"counts": counts, "points": (points * scale).astype(np.float32)}
    widths = schema.getWidthsParam()
    own = _array(widths.getExpandedValue(at).getVals(), 1) if widths and widths.valid() else np.empty(0)
    total = len(part["points"])
    if len(own) == 1:
        own = np.full(total, own[0])
    elif len(own) == len(counts) and len(own) != total:
        own = np.repeat(own, counts)
    if len(own) == total:
        part["widths"] = (own * size).astype(np.float32)
    part.update(_attributes(schema, len(counts), total))
    return part


def _attributes(schema: Any, strands: int, points: int) -> dict[str, Any]:
    """Unreal's attributes of curves that are whole."""
    package = required()
    found: dict[str, Any] = {}
    arbitrary = schema.getArbGeomParams()
    if not arbitrary or not arbitrary.valid():
        return found
    names = {arbitrary.getPropertyHeader(at).getName() for at in range(arbitrary.getNumProperties())}
    for name, own, kind, columns, length in (
        ("groom_color", "colors", "V3f", 3, points),
        ("groom_root_uv", "root_uvs", "V2f", 2, strands),
        ("groom_group_id", "groups", "Int32", 1, strands),
        ("groom_guide", "guide_flags", "Int32", 1, strands),
    ):
        if name in names:
            param = getattr(package.AbcGeom, f"I{kind}GeomParam")(arbitrary, name)
            values = _array(param.getExpandedValue().getVals(), columns)
            if len(values) == length:
                found[own] = values
    return found


def _read_body(path: str, scale: float) -> Body:
    archive, top = _opened(path)
    package = required()
    mesh = next((of for of in _below(top) if package.AbcGeom.IPolyMesh.matches(of.getHeader())), None)
    if mesh is None:
        raise Error(f"it holds no mesh, expected a body: {path}", "file")
    schema = package.AbcGeom.IPolyMesh(mesh, package.Abc.WrapExistingFlag.kWrapExisting).getSchema()
    shapes, faces = [], np.empty((0, 3), dtype=np.int64)
    sampling = schema.getTimeSampling()
    for index in range(max(schema.getNumSamples(), 1)):
        sample = schema.getValue(_at(schema, index))
        matrix = _world(mesh, sampling.getSampleTime(index))
        points = _array(sample.getPositions()).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
        shapes.append((points * scale).astype(np.float32))
        if index == 0:
            from .usd import _triangles

            counts = _array(sample.getFaceCounts(), 1).astype(np.int64)
            # Alembic's faces are clockwise.
            faces = _triangles(counts, _array(sample.getFaceIndices(), 1).astype(np.int64))[:, ::-1]
    step = sampling.getSampleTime(1) - sampling.getSampleTime(0) if len(shapes) > 1 else 1 / 24
    del archive
    if any(len(shape) != len(shapes[0]) for shape in shapes):
        raise Error(f"the mesh changes its number of vertices, expected the same at every time: {path}", "file")
    if len(shapes) < 2:
        return Body(shapes[0], faces)
    return Body(shapes[0], faces, motion=np.stack(shapes), frames_per_second=1 / step)
