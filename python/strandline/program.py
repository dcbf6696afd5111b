"""The ``strandline`` program."""

from __future__ import annotations

import json
import os
import re
import sys
import tempfile
import tomllib
from collections.abc import Callable
from contextlib import ExitStack
from typing import Any

from . import _extras, _native, cache
from .errors import Error

#: Commands that take a scene, and those that read or write a groom.
_SCENES = ("view", "render", "sim")
_GROOMS = ("convert", "info", "groom")

#: Flags of ``convert`` and ``info`` that have no value.
_BARE = ("--clean", "--json", "--help", "-h")


def main(words: list[str] | None = None) -> int:
    """Runs the program with the words of a command line, without its name. Files of extras stand wherever others do:
    .usdc, .usd, .usdz and .abc as grooms and bodies, and but for .usdz as outputs of ``sim``, ``convert`` and ``groom``."""
    words = list(sys.argv[1:] if words is None else words)
    try:
        return _run(words)
    except Error as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130


def _program(words: list[str]) -> int:
    return _native.program(["strandline", *words])


def _run(words: list[str]) -> int:
    if sys.platform == "linux" and not os.path.isabs(os.environ.get("XDG_RUNTIME_DIR", "")):
        # Else the program begins the process anew, to keep a driver's lines off the terminal.
        os.environ.setdefault("NODEVICE_SELECT", "1")
    command = words[0] if words else ""
    if command == "sweep":
        from . import farm

        return farm.main(words[1:])
    with _extras.Files() as files:
        if command in _SCENES:
            return _scene(command, _scene_inputs(words, files))
        if command in _GROOMS:
            return _groom(command, words[1:], files)
        return _program(words)


def _flag(words: list[str], at: int) -> tuple[str, str | None, int]:
    """Name and value of the flag at a place, and the number of its words."""
    name, joined, value = words[at].partition("=")
    if joined:
        return name, value, 1
    return (name, words[at + 1], 2) if at + 1 < len(words) else (name, None, 1)


def _value(words: list[str], flag: str) -> str | None:
    """The value of a flag, as the next word or behind ``=``; the last one counts. It is taken out of the words."""
    found = None
    for at in reversed(range(len(words))):
        name, value, taken = _flag(words, at)
        if name == flag and value is not None:
            found = found or value
            del words[at : at + taken]
    return found


def _is_extra(path: str, suffixes: tuple[str, ...]) -> bool:
    """True for a file that an extra reads. A text in a .usd is read by the engine."""
    ending = _extras.suffix(path)
    if ending == ".usd" and suffixes is _extras.GROOMS and os.path.isfile(path):
        with open(path, "rb") as file:
            return not file.read(5).startswith(b"#usda")
    return ending in suffixes


def _scene_inputs(words: list[str], files: _extras.Files) -> list[str]:
    """The words with copies in place of files that extras read; those of a scene's own are set at the end."""
    made: list[str] = []
    scene, given, at = None, set(), 0
    while at < len(words):
        name, value, taken = _flag(words, at)
        if name in ("--groom", "--body") and value is not None:
            given.add(f"{name[2:]}.file")
            value = _copy(f"{name[2:]}.file", value, files)
        elif name == "--set" and value is not None and value.partition("=")[0].strip() in ("groom.file", "body.file"):
            key, _, path = value.partition("=")
            given.add(key.strip())
            copy = _copy(key.strip(), path.strip().strip('"'), files)
            value = f"{key}={copy}"
        elif name == "--scene":
            scene = value
        else:
            word = words[at]
            if words[0] == "view" and not word.startswith("-"):
                scene = word if word.endswith(".toml") else scene
                word = _shown(word, files)
            made.append(word)
            at += 1
            continue
        made += [name] if value is None else [name, value]
        at += taken
    for key, path in _files_of(scene):
        if key not in given and (copy := _copy(key, path, files)) != path:
            made += ["--set", f"{key}={copy}"]
    return made


def _copy(key: str, path: str, files: _extras.Files) -> str:
    if key == "groom.file":
        return files.groom(path) if _is_extra(path, _extras.GROOMS) else path
    return files.body(path) if _is_extra(path, _extras.BODIES) else path


def _shown(word: str, files: _extras.Files) -> str:
    """The copy of a file that the window opens: of a groom, or of a body where it holds no strands."""
    if not _is_extra(word, _extras.GROOMS):
        return word
    try:
        return files.groom(word)
    except Error as error:
        if "it holds no" not in str(error):
            raise
        return files.body(word)


def _files_of(scene: str | None) -> list[tuple[str, str]]:
    """Keys and paths of the groom and the body of a scene's file."""
    if scene is None or not scene.endswith(".toml"):
        return []
    try:
        with open(scene, "rb") as file:
            whole: dict[str, Any] = tomllib.load(file)
    except (OSError, tomllib.TOMLDecodeError):
        # The engine says what is wrong with it.
        return []
    folder = os.path.dirname(os.path.abspath(scene))
    sections = {name: whole.get(name) for name in ("groom", "body")}
    found = {name: section.get("file") for name, section in sections.items() if isinstance(section, dict)}
    return [(f"{name}.file", os.path.join(folder, path)) for name, path in found.items() if isinstance(path, str)]


def _scene(command: str, words: list[str]) -> int:
    rest = list(words)
    path = _value(rest, "--out")
    if command != "sim" or path is None or _extras.suffix(path) not in _extras.MOVING:
        return _program(words)
    target = _value(rest, "--for") or "any"
    velocities = "--velocities" in rest
    rest = [word for word in rest if word != "--velocities"]
    code, said = 0, ""

    def simulate(part: str) -> bool:
        nonlocal code, said
        code, (said,) = _captured(lambda: _program([*rest, "--out", part]), (1,))
        return code == 0 or os.path.exists(part)

    try:
        written = cache.by_part(path, simulate, for_=target, velocities=velocities)
        said = said if written is None else _written(said, written.path, written.bytes)
    finally:
        print(said, end="")
    return code


def _written(said: str, path: str, size: int) -> str:
    """The report of ``sim`` with a file and its size [byte] in place of those of the cache that it is made from."""
    if said.startswith("{"):
        report = json.loads(said)
        report["out"] |= {"path": path, "bytes": size}
        return json.dumps(report) + "\n"
    counts = re.compile(r"^(wrote \d+ frames of \d+ strands, \d+ points, ).*$", re.MULTILINE)
    return counts.sub(lambda found: f"{found[1]}{1e-6 * size:.1f} MB to {path}", said)


def _groom(command: str, words: list[str], files: _extras.Files) -> int:
    """``convert``, ``info`` and ``groom``, whose lines name the files in place of their copies."""
    out, target = None, None
    if command == "groom":
        found = _value(list(words), "--out")
        if found is not None and _extras.suffix(found) in _extras.MOVING:
            out = _value(words, "--out")
    else:
        places = _places(words)
        if command == "convert" and len(places) > 1 and _extras.suffix(words[places[-1]]) in _extras.MOVING:
            out = words.pop(places.pop())
        _inputs(words, places[:-1] if command == "convert" and out is None else places, files)
    if out is None:
        return _named(lambda: _program([command, *words]), files) if files.originals else _program([command, *words])
    target = _value(words, "--for") or "any"
    cache.writer(_extras.suffix(out))
    copy = files.place(out, ".npz")
    ends = ["--out", copy] if command == "groom" else [copy]
    code = _named(lambda: _program([command, *words, *ends]), files)
    if code == 0:
        from .groom import load

        groom = load(copy, scale=1)
        for note in groom.save(out, for_=target):
            print(f"note: {note}", file=sys.stderr)
    return code


def _places(words: list[str]) -> list[int]:
    """Places of the words that are neither flags nor their values."""
    places, at = [], 0
    while at < len(words):
        if words[at].startswith("-") and words[at] != "-":
            at += 1 if words[at].partition("=")[0] in _BARE else _flag(words, at)[2]
        else:
            places.append(at)
            at += 1
    return places


def _inputs(words: list[str], places: list[int], files: _extras.Files) -> None:
    """Puts copies in place of the grooms that extras read, and of the mesh of ``--outside``."""
    taken = [at for at in places if _is_extra(words[at], _extras.GROOMS)]
    frame = _value(list(words), "--frame") if taken else None
    number = int(frame) if frame is not None and frame.isdecimal() else None
    stages = all(at in taken and _extras.suffix(words[at]) != ".abc" for at in places)
    for at in taken:
        words[at] = files.groom(words[at], number)
    for at in range(len(words)):
        name, value, count = _flag(words, at)
        if name == "--outside" and value is not None and _is_extra(value, _extras.BODIES):
            words[at : at + count] = ["--outside", files.body(value)]
            break
    if taken and len(taken) == len(places):
        _value(words, "--frame")
        if stages and _value(list(words), "--scale") is None:
            # A stage says its units.
            words += ["--scale", "1"]


def _named(act: Callable[[], int], files: _extras.Files) -> int:
    """Does something whose lines on standard output and error are printed with the names of the files."""
    code, said = _captured(act, (1, 2))
    for text, stream in zip(said, (sys.stdout, sys.stderr), strict=True):
        print(files.named(text), end="", file=stream)
    return code


def _captured(act: Callable[[], int], streams: tuple[int, ...]) -> tuple[int, list[str]]:
    """Does something, and returns its code and what it wrote to standard output (1) and error (2)."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept = [os.dup(number) for number in streams]
    with ExitStack() as stack:
        taken = [stack.enter_context(tempfile.TemporaryFile()) for _ in streams]
        try:
            for file, number in zip(taken, streams, strict=True):
                os.dup2(file.fileno(), number)
            code = act()
        finally:
            for own, number in zip(kept, streams, strict=True):
                os.dup2(own, number)
                os.close(own)
        for file in taken:
            file.seek(0)
        return code, [file.read().decode(errors="replace") for file in taken]


if __name__ == "__main__":
    sys.exit(main())
