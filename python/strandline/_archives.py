"""Alembic that is read, by a process of its own: grooms, and bodies over time."""

from __future__ import annotations

import faulthandler
import json
import os
import subprocess
import sys
import tempfile
import threading
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._extras import alembic_package
from ._receivers import group_names, joined, of_file, triangles
from .body import Body
from .errors import Error
from .groom import Groom


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
    package = alembic_package()
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
    package = alembic_package()
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
    return alembic_package().Abc.ISampleSelector(float(schema.getTimeSampling().getSampleTime(index)))


def _array(of: Any, columns: int = 3) -> NDArray[Any]:
    array = np.array(of)
    return array.reshape(-1, columns) if columns > 1 else array.reshape(-1)


def apart(what: str, path: str, options: dict[str, Any]) -> dict[str, Any]:
    """The arrays of an archive, which a process of its own reads: the library ends its process on some damaged files."""
    alembic_package()
    _checked(path)
    with tempfile.TemporaryDirectory(prefix="strandline-") as folder:
        out = os.path.join(folder, "read.npz")
        seconds = time_limit(os.path.getsize(path))
        task = {"what": what, "file": os.path.abspath(path), "out": out, "options": options, "seconds": seconds}
        answer = _reader.ask(task, seconds)
        if answer == ["done"]:
            with np.load(out) as arrays:
                return {name: arrays[name] for name in arrays.files}
    late = f"was stopped after {seconds:.0f} s, which is long for its size" if answer is None else "broke off"
    text, kind = answer or (f"cannot read the archive: its reader {late}, the file is damaged: {path}", "file")
    raise Error(text.replace(os.path.abspath(path), path), kind)


def time_limit(size: int) -> float:
    """Seconds that an archive of so many bytes may be read: a minute, and a second for each megabyte."""
    return 60 + 1e-6 * size


class _Reader:
    """A process that reads archives one after the other; it ends with this one, and begins anew where a file ends it."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._process: subprocess.Popen[str] | None = None
        self._owner = 0

    def ask(self, task: dict[str, Any], seconds: float) -> list[str] | None:
        """The answer to a task; an empty one where the file ended the process, none where it took more than the time."""
        with self._lock:
            process = self._running()
            assert process.stdin is not None and process.stdout is not None
            late = threading.Event()

            def stop() -> None:
                late.set()
                process.kill()

            timer = threading.Timer(seconds, stop)
            timer.daemon = True
            timer.start()
            answer: list[str] = []
            try:
                print(json.dumps(task), file=process.stdin, flush=True)
                answer = list(json.loads(process.stdout.readline()))
            except (OSError, ValueError):
                return None if late.is_set() else []
            finally:
                timer.cancel()
                if not answer:
                    # Also where Ctrl-C ends the wait: else the next task would get this answer.
                    process.kill()
                    process.wait()
            return answer

    def _running(self) -> subprocess.Popen[str]:
        # A forked process has a reader of its own.
        if self._process is None or self._owner != os.getpid() or self._process.poll() is not None:
            code = f"import sys; sys.path[:] = {sys.path!r}; import strandline._archives as own; own._serve()"
            pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
            self._process = subprocess.Popen([sys.executable, "-c", code], text=True, start_new_session=True, **pipes)
            self._owner = os.getpid()
        return self._process


_reader = _Reader()


def _serve() -> None:
    """Reads the archives that lines of standard input ask for."""
    for line in sys.stdin:
        task = json.loads(line)
        # It ends by itself where the process that asks is gone.
        faulthandler.dump_traceback_later(task["seconds"] + 10, exit=True)
        answer = _answer(task)
        faulthandler.cancel_dump_traceback_later()
        print(json.dumps(answer), flush=True)


def _answer(task: dict[str, Any]) -> list[str]:
    arrays: dict[str, Any]
    try:
        if task["what"] == "groom":
            groom = _read_groom(task["file"], **task["options"])
            arrays = {"points": groom.points, "starts": groom.starts, "widths": np.asarray(groom.widths), **groom.attributes}
            numbers, texts = list(groom.group_names), list(groom.group_names.values())
            arrays |= {"named": np.array(numbers, dtype=np.int64), "names": np.array(texts, dtype=str)}
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
    geometry = alembic_package().AbcGeom
    parts: list[dict[str, Any]] = []
    samples = 0
    try:
        for of in _below(top):
            if geometry.ICurves.matches(of.getHeader()):
                part = _curves(of, frame or 0, scale)
                samples = max(samples, part.pop("samples"))
                if len(part["counts"]):
                    parts.append(part)
    except (RuntimeError, IndexError, ValueError) as error:
        raise Error(f"cannot read the archive: {_first_line(error)}: {path}", "file") from None
    del archive
    if not parts:
        raise Error(f"it holds no curves, expected strands: {path}", "file")
    if frame is not None and frame >= samples:
        raise Error(f"frame is {frame}, expected 0 to {samples - 1}, its samples: {path}", "value")
    return joined(parts, path)


def _curves(of: Any, index: int, scale: float) -> dict[str, Any]:
    package = alembic_package()
    schema = package.AbcGeom.ICurves(of, package.Abc.WrapExistingFlag.kWrapExisting).getSchema()
    samples = max(schema.getNumSamples(), 1)
    index = min(index, samples - 1)
    at = _at(schema, index)
    sample = schema.getValue(at)
    time = schema.getTimeSampling().getSampleTime(index)
    matrix = _world(of, time)
    counts = _array(sample.getCurvesNumVertices(), 1)
    points = _array(sample.getPositions()).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    size = scale * float(np.cbrt(abs(np.linalg.det(matrix[:3, :3]))))
    part: dict[str, Any] = {"samples": samples, "counts": counts, "points": (points * scale).astype(np.float32)}
    widths = schema.getWidthsParam()
    own = _array(widths.getExpandedValue(at).getVals(), 1) if widths and widths.valid() else np.empty(0)
    total = len(part["points"])
    if len(own) == 1:
        own = np.full(total, own[0])
    elif len(own) == len(counts) and len(own) != total:
        own = np.repeat(own, counts)
    if len(own) == total:
        part["widths"] = (own * size).astype(np.float32)
    velocities = sample.getVelocities()
    moved = _array(velocities).astype(np.float64) @ matrix[:3, :3].T * scale if velocities else np.empty((0, 3))
    if len(moved) == total and np.all(np.isfinite(moved)):
        part["velocities"] = moved.astype(np.float32)
    part.update(_attributes(schema, len(counts), total))
    return part


def _attributes(schema: Any, strands: int, points: int) -> dict[str, Any]:
    """Unreal's attributes of curves that are whole."""
    package = alembic_package()
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
        ("groom_id", "ids", "Int32", 1, strands),
        ("groom_closest_guides", "closest", "V3i", 3, strands),
        ("groom_guide_weights", "shares", "V3f", 3, strands),
    ):
        if name in names:
            param = getattr(package.AbcGeom, f"I{kind}GeomParam")(arbitrary, name)
            values = _array(param.getExpandedValue().getVals(), columns)
            if len(values) == length:
                found[own] = values
    if "groom_group_name" in names:
        labels = package.AbcGeom.IStringGeomParam(arbitrary, "groom_group_name").getExpandedValue().getVals()
        found["group_names"] = group_names(found.get("groups"), [labels[at] for at in range(len(labels))])
    if not {"closest", "shares"} <= found.keys():
        found = {name: values for name, values in found.items() if name not in ("closest", "shares")}
    return found


def _read_body(path: str, scale: float) -> Body:
    archive, top = _opened(path)
    package = alembic_package()
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
            counts = _array(sample.getFaceCounts(), 1).astype(np.int64)
            # Alembic's faces are clockwise.
            faces = triangles(counts, _array(sample.getFaceIndices(), 1).astype(np.int64))[:, ::-1]
    step = sampling.getSampleTime(1) - sampling.getSampleTime(0) if len(shapes) > 1 else 1 / 24
    del archive
    if any(len(shape) != len(shapes[0]) for shape in shapes):
        raise Error(f"the mesh changes its number of vertices, expected the same at every time: {path}", "file")
    motion = np.stack(shapes) if len(shapes) > 1 else None
    with of_file(path):
        return Body(shapes[0], faces, motion=motion, frames_per_second=1 / step)
