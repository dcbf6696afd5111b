"""Scenes and their settings."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _arrays, _native, _toml
from .errors import Error

if TYPE_CHECKING:
    from typing import Unpack

    from . import sections


class Scene:
    """All settings of one run; docs/scene.md lists every key.

    Sections are keywords with dictionaries, or single settings with their whole key::

        scene = Scene(style={"style": "bob", "strand_count": 500}, motion={"name": "nod"})
        scene["simulation.gravity"] = (0, -1.6, 0)
        scene["film.frames"]

    Only settings that are given are kept, as in a file: what is left open is chosen to fit the groom. A key that no
    setting has is refused with the nearest one, a value outside its range with that range.
    """

    def __init__(
        self, given: Mapping[str, Any] | None = None, /, **settings: Unpack[sections.SceneSections]
    ) -> None:
        self._given: dict[str, Any] = {}
        self.folder = ""
        taken: dict[str, Any] = {}
        for key, value in {**(given or {}), **settings}.items():
            _put(taken, key, _toml.plain(getattr(value, "given", value)))
        self._take(taken)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Scene:
        """Reads a .toml file; paths in it are relative to its folder."""
        path = os.fspath(path)
        try:
            with open(path, "rb") as file:
                content = file.read()
            text = content.decode()
        except (OSError, UnicodeDecodeError) as error:
            reason = error.strerror if isinstance(error, OSError) else str(error)
            raise Error(f"cannot read the scene: {reason}: {path}", "file") from None
        try:
            _native.whole(text)
        except Error as error:
            raise Error(f"{error}: {path}", error.kind) from None
        scene = cls(tomllib.loads(text))
        scene.folder = os.path.dirname(os.path.abspath(path))
        return scene

    @classmethod
    def demo(cls) -> Scene:
        """Long hair that shakes its head for 4 s."""
        return cls()

    @classmethod
    def thesis(cls) -> Scene:
        """The scene of the thesis that the methods come from."""
        return cls(tomllib.loads(_native.builtin("thesis")))

    @property
    def given(self) -> dict[str, Any]:
        """The settings that were given, as plain data."""
        return _toml.plain(self._given)  # type: ignore[no-any-return]

    def to_toml(self) -> str:
        """The scene as TOML, every key spelled out."""
        return _native.whole(_toml.document(self._given))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the settings that were given as a .toml file."""
        try:
            with open(path, "w", encoding="utf-8") as file:
                file.write(_toml.document(self._given))
        except OSError as error:
            raise Error(f"cannot write the scene: {error.strerror}: {os.fspath(path)}", "file") from None

    def explain(self, key: str) -> str:
        """The sentence, the range and the value of a setting, or a line for each setting of a section."""
        return _native.explain(_toml.document(self._given), key)

    def __getitem__(self, key: str) -> Any:
        text = _native.get(_toml.document(self._given), key)
        if not text:
            return None
        # Sections are printed as documents, values are not.
        try:
            return tomllib.loads(f"value = {text}")["value"]
        except tomllib.TOMLDecodeError:
            return tomllib.loads(text)

    def __setitem__(self, key: str, value: Any) -> None:
        changed: dict[str, Any] = _toml.plain(self._given)
        _put(changed, key, _toml.plain(getattr(value, "given", value)))
        self._take(changed)

    def update(self, settings: Mapping[str, Any]) -> Scene:
        """Sets several settings by key and returns the scene."""
        changed: dict[str, Any] = _toml.plain(self._given)
        for key, value in settings.items():
            _put(changed, key, _toml.plain(getattr(value, "given", value)))
        self._take(changed)
        return self

    def copy(self) -> Scene:
        """A scene of its own with the same settings."""
        scene = Scene(self._given)
        scene.folder = self.folder
        return scene

    def _take(self, settings: dict[str, Any]) -> None:
        """Checks settings one by one, whose errors name them, then as a whole."""
        leaves = list(_leaves(settings, ""))
        for key, _ in leaves:
            _native.check(key)
        try:
            _native.whole(_toml.document(settings))
        except Error:
            for key, value in leaves:
                if value is not None:
                    _native.check(key, _toml.value(value, key))
            raise
        self._given = settings

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self.to_toml() == other.to_toml()

    def __repr__(self) -> str:
        parts = ", ".join(f"{name}={part!r}" for name, part in self._given.items())
        return f"Scene({parts})"

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._given, self.folder)


def _restored(given: dict[str, Any], folder: str) -> Scene:
    scene = Scene(given)
    scene.folder = folder
    return scene


def _leaves(settings: Mapping[str, Any], key: str) -> Iterator[tuple[str, Any]]:
    """Keys and values; lists count as values."""
    for name, value in settings.items():
        own = f"{key}.{name}" if key else name
        if isinstance(value, Mapping) and _native.check(own):
            yield from _leaves(value, own)
        else:
            yield own, value


def _put(settings: dict[str, Any], key: str, value: Any) -> None:
    """Sets a value by its whole key; sections are merged."""
    *path, name = key.split(".")
    inner = settings
    for section in path:
        if "[" in section:
            raise Error(f"{key} is a setting of an item, expected the list as a whole, such as lights=[...]", "value")
        inner = inner.setdefault(section, {})
        if not isinstance(inner, dict):
            _native.check(key)
    if isinstance(value, Mapping) and isinstance(inner.get(name), dict):
        for part, own in value.items():
            _put(inner[name], part, own)
    elif isinstance(value, Mapping):
        inner[name] = {}
        for part, own in value.items():
            _put(inner[name], part, own)
    else:
        inner[name] = value


class _Section:
    """Settings of one section of a scene by keyword."""

    _name = ""

    def __init__(self, **settings: Any) -> None:
        self.given: dict[str, Any] = Scene({self._name: settings}).given.get(self._name, {})

    def __repr__(self) -> str:
        parts = ", ".join(f"{name}={part!r}" for name, part in self.given.items())
        return f"{type(self).__name__}({parts})"

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self.given == other.given


class Settings(_Section):
    """Settings of the section ``simulation``: how hair moves. ``Settings(gravity=(0, -1.6, 0))``."""

    _name = "simulation"

    if TYPE_CHECKING:

        def __init__(self, **settings: Unpack[sections.Simulation]) -> None: ...


class Look(_Section):
    """Settings of the section ``look``: colour and shape of the drawn hair. ``Look(follow_strands=8)``."""

    _name = "look"

    if TYPE_CHECKING:

        def __init__(self, **settings: Unpack[sections.Look]) -> None: ...


class Motion(_Section):
    """Motion of the head: ``Motion("nod")``, or poses at times, ``Motion.keyframes([(0, (0, 0, 0)), (0.2, (0, 60, 0))])``."""

    _name = "motion"

    def __init__(self, name: str | None = None, **settings: Any) -> None:
        super().__init__(**({} if name is None else {"name": name}), **settings)

    @classmethod
    def still(cls) -> Motion:
        """A head that rests."""
        return cls("still")

    @classmethod
    def keyframes(cls, keys: Any, **settings: Any) -> Motion:
        """Poses at times: items (time [s], pitch/yaw/roll [degrees]) or (time, angles, translation [m]), or dictionaries
        with the keys of ``motion.keyframes``."""
        return cls("keyframes", keyframes=[_keyframe(key) for key in keys], **settings)

    def matrices(self, times: Any, pivot: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Any:
        """4 x 4 matrices ``world_from_head`` at times [s], shape (time, 4, 4). A head without a pivot of its own turns
        about ``pivot`` [m]."""
        scene = _toml.document({"motion": self.given})
        moments, place = _arrays.numbers(times, "times", "(n,)", np.float64), _arrays.numbers(pivot, "pivot", "(3,)")
        if place.shape != (3,):
            raise Error(f"pivot has the shape {place.shape}, expected (3,) [m]", "value")
        return np.asarray(_native.head(scene, moments.reshape(-1).tolist(), place.tolist()), dtype=np.float32).reshape(-1, 4, 4)


def _keyframe(key: Any) -> dict[str, Any]:
    if isinstance(key, Mapping):
        return dict(key)
    if not isinstance(key, Sequence) or len(key) not in (2, 3):
        raise Error(f"a keyframe is {key!r}, expected (time, angles), (time, angles, translation) or a dictionary", "value")
    return dict(zip(("time", "rotation", "translation"), _toml.plain(key), strict=False))
