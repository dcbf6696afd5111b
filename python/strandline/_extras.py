"""Files that extras read and write, brought to files that the engine reads and writes."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from types import TracebackType
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import Error, missing

if TYPE_CHECKING:
    from .body import Body
    from .groom import Groom

#: Suffixes of grooms, of bodies and of moving hair that extras read or write.
GROOMS = (".usdc", ".usd", ".usdz", ".abc")
BODIES = (".usda", *GROOMS)
MOVING = (".usdc", ".usd", ".abc")


def pxr_package() -> Any:
    """The package pxr, or the error that names the extra."""
    try:
        import pxr
        from pxr import Gf, Sdf, Usd, UsdGeom, UsdSkel, Vt  # noqa: F401
    except ImportError:
        raise missing("usd-core", "usd") from None
    return pxr


def alembic_package() -> Any:
    """The package alembic3d, or the error that names the extra."""
    try:
        import alembic3d
        import alembic3d.Abc
        import alembic3d.AbcCoreAbstract
        import alembic3d.AbcGeom
    except ImportError:
        raise missing("alembic3d", "abc") from None
    return alembic3d


def suffix(path: str | os.PathLike[str]) -> str:
    """The suffix of a path in small letters, with its dot."""
    return os.path.splitext(os.fspath(path))[1].lower()


def groom(path: str, frame: int | None = None) -> Groom:
    """The groom of a file: that of a stage in metres with y up, that of an archive in its own units."""
    if suffix(path) == ".abc":
        from . import abc

        return abc.load_groom(path, frame=frame)
    from . import usd

    return usd.load_groom(path, frame=frame)


def body(path: str, scale: float = 1.0) -> Body:
    """The body of a file; ``scale`` is metres for each unit of an archive."""
    if suffix(path) == ".abc":
        from . import abc

        return abc.load_body(path, scale=scale)
    from . import usd

    return usd.load_body(path)


def write_obj(of: Body, path: str) -> None:
    """Writes a body at rest as an .obj, to the bit."""
    with open(path, "w", encoding="utf-8") as file:
        np.savetxt(file, of.vertices, fmt="v %.9g %.9g %.9g")
        np.savetxt(file, of.faces.astype(np.int64) + 1, fmt="f %d %d %d")


class Files:
    """Copies of such files in a folder of their own, for as long as they are needed."""

    def __init__(self) -> None:
        self._folder = ""
        #: The file that each copy stands for.
        self.originals: dict[str, str] = {}

    def __enter__(self) -> Files:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._folder:
            shutil.rmtree(self._folder, ignore_errors=True)

    def place(self, path: str, ending: str) -> str:
        """A free path with the name of a file and another suffix."""
        self._folder = self._folder or tempfile.mkdtemp(prefix="strandline-")
        stem = os.path.splitext(os.path.basename(path))[0]
        folder = os.path.join(self._folder, str(len(self.originals)))
        os.mkdir(folder)
        copy = os.path.join(folder, stem + ending)
        self.originals[copy] = path
        return copy

    def groom(self, path: str, frame: int | None = None) -> str:
        """An .npz of a groom."""
        own = groom(path, frame)
        arrays: dict[str, Any] = {"points": own.points, "starts": own.starts}
        if np.ndim(own.widths):
            arrays["widths" if np.size(own.widths) == len(own.points) else "strand_widths"] = own.widths
        names = {"root_uvs": "root_uv"}
        arrays.update({names.get(name, name): numbers for name, numbers in own.attributes.items()})
        meta = json.dumps({"groups": own.group_names})
        arrays["meta"] = np.frombuffer(meta.encode(), dtype=np.uint8)
        copy = self.place(path, ".npz")
        np.savez(copy, **arrays)
        return copy

    def body(self, path: str, scale: float = 1.0) -> str:
        """An .obj of a body, or an .npz of one that moves."""
        own = body(path, scale)
        if own.motion is not None:
            copy = self.place(path, ".npz")
            np.savez(copy, vertices=own.motion, faces=own.faces, fps=own.frames_per_second, teleports=own.teleports)
            return copy
        copy = self.place(path, ".obj")
        write_obj(own, copy)
        return copy

    def named(self, text: str) -> str:
        """A text that names the files in place of their copies."""
        for copy, path in self.originals.items():
            text = text.replace(copy, path)
        return text

    def error(self, error: Error) -> Error:
        """An error that names the files in place of their copies."""
        return Error(self.named(str(error)), error.kind)
