"""The window, in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile

import numpy as np

from . import _extras
from .body import Body
from .errors import Error
from .groom import Groom
from .scene import Scene
from .simulation import Simulation


def view(what: Simulation | Scene | Groom | str | os.PathLike[str] | None = None) -> None:
    """Opens the window on a simulation, a scene, a groom or a file, and waits until it is closed.

    The window simulates by itself from the beginning: what was changed by ``step`` and ``set`` is not in it.
    Without a display it raises an error that says so.
    """
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise Error("there is no display, expected DISPLAY or WAYLAND_DISPLAY: simulation.picture() and simulation.film() draw without one", "other")
    with tempfile.TemporaryDirectory(prefix="strandline-") as folder:
        words = words_of(what, folder)
        done = subprocess.run([sys.executable, "-m", "strandline", "view", *words], stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        lines = [line for line in done.stderr.splitlines() if line.strip()]
        raise Error((lines or ["the window broke off"])[-1].removeprefix("strandline: ").removeprefix("error: "), "other")


def words_of(what: Simulation | Scene | Groom | str | os.PathLike[str] | None, folder: str) -> list[str]:
    """The words of ``strandline view`` for something, with files in a folder for what is in memory."""
    if what is None:
        return []
    if not isinstance(what, Simulation | Scene | Groom | str | os.PathLike):
        raise Error(f"what is a {type(what).__name__}, expected a Simulation, a Scene, a Groom or a path", "value")
    if isinstance(what, str | os.PathLike):
        return [os.fspath(what)]
    if isinstance(what, Groom):
        return ["--groom", _groom(what, folder), "--up", "y", "--scale", "1"]
    scene = what.copy() if isinstance(what, Scene) else what._scene.copy()
    if isinstance(what, Simulation):
        groom, body = what._sources
        if groom is not None:
            scene["groom.file"] = _groom(groom, folder)
        if body is not None:
            scene["body.file"] = _body(body, folder)
    for key in ("groom.file", "body.file"):
        if scene[key]:
            scene[key] = os.path.join(scene.folder, scene[key])
    path = os.path.join(folder, "scene.toml")
    scene.save(path)
    return ["--scene", path]


def _groom(groom: Groom, folder: str) -> str:
    path = os.path.join(folder, "groom.npz")
    groom.save(path)
    return path


def _body(body: Body, folder: str) -> str:
    """The file of a body, by the way that files of extras go."""
    path = os.path.join(folder, "body.npz" if body.motion is not None else "body.obj")
    if body.motion is not None:
        np.savez(path, vertices=body.motion, faces=body.faces, fps=body.frames_per_second, teleports=body.teleports)
    else:
        _extras.write_obj(body, path)
    return path
