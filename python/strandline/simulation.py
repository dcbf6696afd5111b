"""Hair that moves."""

from __future__ import annotations

import difflib
import os
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _extras, _native, _toml, cache
from .body import Body
from .errors import Error
from .film import Film
from .groom import Groom, load
from .picture import Camera, Picture
from .progress import Progress
from .scene import Look, Motion, Scene, Settings

Path = str | os.PathLike[str]

#: Speed [m/s] below which hair that is draped counts as at rest, and the time [s] between two looks.
_REST, _LOOK = 2e-3, 0.1


class StepReport(NamedTuple):
    """Quality of one step."""

    #: Mean and largest length over rest length, less 1.
    stretch_mean: float
    stretch_max: float
    #: Depth of the deepest point inside a solid [m].
    penetration_max: float
    #: Mean and largest speed [m/s].
    speed_mean: float
    speed_max: float
    #: Points that are not finite.
    non_finite: int


@dataclass(frozen=True)
class Frame:
    """A frame of a simulation. ``points`` shows the present moment: copy it to keep it."""

    index: int
    time: float
    points: NDArray[np.float32]
    reports: list[StepReport]


@dataclass(frozen=True)
class Written:
    """A file of moving hair that is complete."""

    path: str
    frames: int
    bytes: int
    notes: list[str]


class Simulation:
    """A simulation of hair on a body.

    ``groom`` is a Groom, an array of its points or the path of a file, ``body`` a Body or a path; without them the scene names
    a file or a style, and a file or the built-in bust. Grooms and bodies in memory are in metres with y up and stay where they
    are. ``settings``, ``look`` and ``motion`` are sections of the scene,
    other sections are keywords: ``Simulation(groom=groom, film={"frames": 48}, backend="cpu")``.

    ``backend`` is ``"auto"``, ``"cpu"``, ``"gpu"`` or ``"gpu:1"``. A simulation is closed by ``with`` or ``close()``.
    """

    def __init__(
        self,
        scene: Scene | Path | None = None,
        *,
        groom: Groom | ArrayLike | Path | None = None,
        body: Body | Path | None = None,
        motion: Motion | str | None = None,
        settings: Settings | None = None,
        look: Look | None = None,
        backend: str | None = None,
        frames: int | None = None,
        **sections: Any,
    ) -> None:
        _check_names(sections)
        scene = scene.copy() if isinstance(scene, Scene) else Scene.load(scene) if scene is not None else Scene()
        groom = _by_extra(scene, "groom.file", groom, _extras.GROOMS, load)
        body = _by_extra(scene, "body.file", body, _extras.BODIES, Body.load)
        if not isinstance(body, Body | str | os.PathLike | None):
            raise Error(f"body is a {type(body).__name__}, expected a Body or a path: Body(vertices, faces)", "value")
        self._body = body if isinstance(body, Body) else None
        held: Groom | None = None
        changes: dict[str, Any] = dict(sections)
        grooms: list[Any] = []
        meshes: list[Any] = []
        motions: list[Any] = []
        if isinstance(groom, str | os.PathLike):
            changes["groom.file"] = os.path.abspath(groom)
        elif groom is not None:
            own = groom if isinstance(groom, Groom) else Groom(groom)
            own.check()
            held = own
            changes.update({"groom.file": "groom", "groom.scale": 1.0, "groom.up": "y", "groom.root_end": "first"})
            grooms.append(("groom", own._dictionary()))
        if isinstance(body, str | os.PathLike):
            changes["body.file"] = os.path.abspath(body)
        elif body is not None:
            changes.update({"body.file": "body", "body.scale": 1.0, "body.up": "y"})
            meshes.append(("body", np.ascontiguousarray(body.vertices), np.ascontiguousarray(body.faces)))
            if body.motion is not None:
                motions.append(("body", np.ascontiguousarray(body.motion), body.frames_per_second, body.teleports))
        if motion is not None:
            changes["motion"] = Motion(motion) if isinstance(motion, str) else motion
        changes.update({name: part for name, part in (("simulation", settings), ("look", look)) if part is not None})
        if backend is not None:
            changes.update({"devices.simulation": backend, "devices.pictures": backend})
        if frames is not None:
            changes["film.frames"] = frames
        scene.update(changes)
        self._native = _native.Hair(_toml.document(scene.given), scene.folder, grooms, meshes, motions)
        self._view = self._native.memory().view()
        self._view.flags.writeable = False
        self._fresh = False
        self._frame = 0
        self._time = 0.0
        # Vertices that the body was last told to have.
        self._shape: NDArray[np.float32] | None = None
        self._scene = scene
        self._sources = (held, self._body)
        fitted = tomllib.loads(self._native.scene())
        self._fitted = fitted
        self.simulated_on, self.drawn_on, self.notes = self._native.about()

    # Time

    def step(
        self,
        seconds: float = 1 / 60,
        *,
        head: ArrayLike | None = None,
        vertices: ArrayLike | None = None,
        wind: Sequence[float] | None = None,
    ) -> list[StepReport]:
        """Lets time pass while the body moves evenly to where it is told to be at the end of it.

        ``head`` is a 4 x 4 matrix world_from_head, rigid; ``vertices`` the body's vertices [m], shape (n, 3), in head
        space: in the world as long as no head is given. ``wind`` is a velocity [m/s] that blows from now on. What is not
        given stays. Steps have a fixed length (``simulation.time_step``), so zero or more happen; each has a report, on
        a GPU with a later call.
        """
        rows = None if head is None else _arrays.numbers(head, "head", "(4, 4)")
        if rows is not None and rows.shape != (4, 4):
            raise Error(f"head has the shape {rows.shape}, expected (4, 4)", "value")
        skin = None
        if vertices is not None:
            skin = _arrays.numbers(vertices, "vertices", "(n, 3)")
            if self._body is None:
                raise Error("vertices are given for a body from a file or the built-in one, expected Simulation(body=Body(vertices, faces))", "value")
            if skin.shape != self._body.vertices.shape:
                raise Error(f"vertices has the shape {skin.shape}, expected {self._body.vertices.shape}, that of the body", "value")
        air = None if wind is None else _arrays.numbers(wind, "wind", "(3,)")
        if air is not None and air.shape != (3,):
            raise Error(f"wind has {air.size} numbers, expected 3 [m/s]", "value")
        seconds = _arrays.number(seconds, "seconds", "0 to 1,000,000 s", 0, 1e6)
        try:
            reports = self._native.step(seconds, None if rows is None else rows.tolist(), skin, None if air is None else air.tolist())
        except Error:
            seconds, skin = 0.0, None
            raise
        finally:
            # Ctrl-C comes after the steps.
            self._fresh = False
            self._time += seconds
            self._shape = self._shape if skin is None else skin
        return [StepReport(*report) for report in reports]

    def frames(self, count: int | None = None, *, progress: bool | None = None) -> Iterator[Frame]:
        """Plays the scene's film frame by frame, from the frame after the last: ``for frame in simulation.frames(240)``.

        Head and wind move as the scene has them, and a Body with a motion by that. The frames are those of
        ``strandline sim`` to the bit on the CPU. Ctrl-C stops between two frames; the next call goes on with the frame
        that was not handed out.
        """
        count = self._left(count, "count")
        return self._played(count, progress)

    def _left(self, count: int | None, name: str) -> int:
        """A number of frames that is given, or those that the film still has."""
        return max(int(self._fitted["film"]["frames"]) - self._frame, 0) if count is None else _arrays.count(count, name)

    def _played(self, count: int, progress: bool | None) -> Iterator[Frame]:
        with Progress(count, "simulating", "frame", progress) as bar:
            for done in range(count):
                yield self._next()
                bar.show(done + 1)

    def _next(self) -> Frame:
        index = self._frame
        try:
            time, stepped = self._native.play(index)
        finally:
            self._fresh = False
        self._frame, self._time = index + 1, time
        return Frame(index, time, self.points, [StepReport(*report) for report in stepped])

    def settle(self, seconds: float) -> None:
        """Lets the hair hang on the resting body for a time [s]; no time of the film passes."""
        left = _arrays.number(seconds, "seconds", "0 to 1,000,000 s", 0, 1e6)
        try:
            while left > 0:
                self._native.settle(min(left, _LOOK))
                left -= _LOOK
        finally:
            self._fresh = False

    def drape(self, seconds: float = 10.0) -> float:
        """Runs to rest on the resting body: until no point moves faster than 2 mm/s, or so many seconds are over.
        Returns the seconds that passed in the simulation."""
        seconds = _arrays.number(seconds, "seconds", "0 to 1,000,000 s", 0, 1e6)
        before = self.points.copy()
        passed = 0.0
        while passed < seconds:
            self.settle(_LOOK)
            passed += _LOOK
            now = self.points
            speed = float(np.sqrt(((now - before) ** 2).sum(axis=2)).max(initial=0.0)) / _LOOK
            if speed < _REST:
                break
            np.copyto(before, now)
        return passed

    # Moment

    @property
    def points(self) -> NDArray[np.float32]:
        """Points of the simulated strands now [m], world space, shape (strand, point, 3).

        A read-only view of memory that is filled anew when it is asked for after a step; no copy is made. It stays
        valid after the simulation is gone.
        """
        if not self._fresh:
            self._native.refresh()
            self._fresh = True
        return self._view

    @property
    def head(self) -> NDArray[np.float32]:
        """The 4 x 4 matrix world_from_head of the moment."""
        return np.asarray(self._native.head(), dtype=np.float32)

    @property
    def time(self) -> float:
        """Time that has passed [s]."""
        return self._time

    @property
    def scene(self) -> Scene:
        """The scene, with the settings that it leaves open chosen to fit the groom."""
        return Scene(tomllib.loads(self._native.scene()))

    @property
    def strand_count(self) -> int:
        """Number of simulated strands."""
        return int(self._view.shape[0])

    @property
    def points_per_strand(self) -> int:
        """Points of each simulated strand."""
        return int(self._view.shape[1])

    def reports(self) -> list[StepReport]:
        """Reports of steps that a GPU still had; it is waited for."""
        return [StepReport(*report) for report in self._native.reports()]

    def take_notes(self) -> list[str]:
        """Notes on loading and devices since the last call."""
        notes, self.notes = self.notes, []
        self.simulated_on, self.drawn_on, new = self._native.about()
        return [*notes, *new]

    # Changes

    def set(self, settings: Mapping[str, Any] | None = None, /, **sections: Any) -> None:
        """Changes settings of simulation, look, body_look, lights, level_of_detail or picture while it runs:
        ``simulation.set({"simulation.gravity": (0, 0, 0)})`` or ``simulation.set(look={"follow_strands": 8})``."""
        for key, value in {**(settings or {}), **sections}.items():
            self._change(key, getattr(value, "given", value))

    def _change(self, key: str, value: Any) -> None:
        if isinstance(value, Mapping):
            for name, part in value.items():
                self._change(f"{key}.{name}", part)
        else:
            self._native.set(key, _toml.value(_toml.plain(value), key))

    # Pictures

    def picture(self, camera: Camera | str | None = None, look: Look | None = None, **settings: Any) -> Picture:
        """Draws the moment. ``camera`` is a Camera or a side: front, three_quarter, side or back. Keywords are the settings
        of the section ``picture``: ``simulation.picture(width=800, height=600, transparent=True)``; they stay.
        ``layers=True`` keeps what is known of each pixel: ``picture.depth``, ``picture.direction`` and more."""
        self.set({**({} if look is None else {"look": look}), **({"picture": settings} if settings else {})})
        if not isinstance(camera, Camera | str | None):
            raise Error(f"camera is a {type(camera).__name__}, expected a Camera or a side: front, three_quarter, side or back", "value")
        if isinstance(camera, str):
            picture = tomllib.loads(self._native.scene())["picture"]
            camera = Camera.framing(self._seen(), camera, picture["width"] / picture["height"])
        pixels, channels = self._native.picture(None if camera is None else camera._parts)
        return Picture(pixels, Camera(*self._native.camera()), channels)

    def _seen(self) -> NDArray[np.float32]:
        """Points of the hair and of a body in memory where they are now, world space."""
        places = self.points.reshape(-1, 3)
        if self._body is None:
            return places
        shape, head = self._body.at(self._time) if self._shape is None else self._shape, self.head
        return np.concatenate([places, shape @ head[:3, :3].T + head[:3, 3]])

    def film(
        self,
        frames: int | None = None,
        camera: Camera | str | None = None,
        *,
        width: int = 320,
        height: int = 240,
        every: int = 2,
        progress: bool | None = None,
    ) -> Film:
        """Plays frames and draws every so many of them as a small moving picture, which notebooks show. A side as the camera
        frames the first of them."""
        every = _arrays.count(every, "every", 1)
        pictures: list[Picture] = []
        for frame in self.frames(frames, progress=progress):
            if frame.index % every == 0 or not pictures:
                chosen = pictures[0].camera if pictures else camera
                pictures.append(self.picture(chosen, width=width, height=height))
        return Film(pictures, float(self._fitted["film"]["frames_per_second"]) / every)

    def _repr_png_(self) -> bytes:
        return self.picture().png()

    def __dlpack__(self, **options: Any) -> Any:
        """The points of the moment for another library, shape (strand, point, 3): without a copy where it takes arrays that
        are read-only."""
        try:
            return self.points.__dlpack__(**options)
        except BufferError:
            return self.points.copy().__dlpack__(**options)

    def __dlpack_device__(self) -> tuple[Any, Any]:
        return self._view.__dlpack_device__()

    def __reduce__(self) -> tuple[Any, ...]:
        raise Error("a simulation is not pickled, expected its scene, groom and body, from which another one is made", "value")

    # Files

    def record(
        self,
        path: Path,
        frames: int | None = None,
        *,
        what: str = "guides",
        for_: str = "any",
        every: int = 1,
        velocities: bool = False,
        progress: bool | None = None,
    ) -> Written:
        """Plays frames and writes them as they are made: .npz (a moving cache), .usda, ``hair.%04d.hair`` (a file a frame),
        and with extras .usdc, .usd and .abc. ``what`` is ``"guides"`` or ``"strands"``, ``for_`` ``"any"``,
        ``"unreal"`` or ``"blender"``. ``velocities`` adds those of each point to .usdc, .usd and .abc, for motion blur."""
        suffix = os.path.splitext(os.fspath(path))[1].lower()
        if suffix in (".usdc", ".usd", ".abc"):
            return self._record_by_extra(path, frames, what, for_, every, velocities, progress)
        if velocities:
            raise Error(f"velocities are asked for in a {suffix or 'file'}, expected .usdc, .usd or .abc", "value")
        left, every = self._left(frames, "frames"), _arrays.count(every, "every", 1)
        if left == 0:
            over = "the film is over" if frames is None else "frames is 0"
            raise Error(f"{over}, expected frames=1 or more", "value")
        frames = left
        self._native.set_frames(max(self._frame + frames, 1))
        self._native.begin_file(os.fspath(path), what, for_, every)
        try:
            for _ in self.frames(frames, progress=progress):
                self._native.write_frame()
        finally:
            ended = self._native.end_file()
        assert ended is not None
        place, written, size, left_out, notes = ended
        return Written(os.fspath(place), written, size, [*(f"left out: {part}" for part in left_out), *notes])

    def _record_by_extra(
        self, path: Path, frames: int | None, what: str, for_: str, every: int, velocities: bool, progress: bool | None
    ) -> Written:
        def simulate(part: str) -> bool:
            self.record(part, frames, what=what, every=every, progress=progress)
            return True

        written = cache.by_part(path, simulate, for_=for_, velocities=velocities)
        assert written is not None
        return written

    def save_pose(self, path: Path) -> None:
        """Saves positions and motion of the hair, for ``groom.pose`` of a scene."""
        self._native.save_pose(os.fspath(path))

    def groom(self) -> Groom:
        """The simulated strands as they are now, as a groom in world space."""
        return Groom(self.points.copy())

    # Life

    def close(self) -> None:
        """Gives memory and devices back. Views of points stay valid."""
        self._native.close()

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"Simulation({self.strand_count} strands x {self.points_per_strand} points, {self._time:.3f} s, on {self.simulated_on})"


def _check_names(sections: Mapping[str, Any]) -> None:
    """Refuses a keyword that is no setting with the nearest argument, where one is near."""
    for name in sections:
        try:
            _native.check(name)
        except Error:
            near = difflib.get_close_matches(name, ("scene", "groom", "body", "motion", "settings", "look", "backend", "frames"), 1)
            if near:
                raise Error(f"{name} is no argument of Simulation, expected `{near[0]}` or a key of docs/scene.md", "value") from None
            raise


def _by_extra(scene: Scene, key: str, given: Any, suffixes: tuple[str, ...], read: Callable[[str], Any]) -> Any:
    """Returns the value given for a file of a scene, or the data that an extra reads of that file."""
    path = scene[key] if given is None else given
    if not isinstance(path, str | os.PathLike):
        return given
    # Paths in a scene are relative to its folder.
    path = os.path.join(scene.folder, path) if given is None else os.fspath(path)
    return read(path) if _extras.suffix(path) in suffixes else given
