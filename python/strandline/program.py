"""The ``strandline`` program."""

from __future__ import annotations

import os
import sys

from . import _native, cache
from .errors import Error

_EXTRA = (".usdc", ".usd", ".abc")


def main(words: list[str] | None = None) -> int:
    """Runs the program with the words of a command line, without its name. ``sim --out`` also takes .usdc, .usd and .abc,
    which extras write."""
    words = list(sys.argv[1:] if words is None else words)
    try:
        return _run(words)
    except Error as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130


def _run(words: list[str]) -> int:
    place = next((at + 1 for at, word in enumerate(words[:-1]) if word == "--out"), None)
    suffix = "" if place is None else os.path.splitext(words[place])[1].lower()
    if place is None or not words[:1] == ["sim"] or suffix not in _EXTRA:
        return _native.program(["strandline", *words])
    path = words[place]
    target = "any"
    if "--for" in words[:-1]:
        at = words.index("--for")
        target = words[at + 1]
        words = words[:at] + words[at + 2 :]
        place -= 2 if at < place else 0
    writer = cache.writer(suffix)
    part = f"{path}.part.npz"
    try:
        code = _native.program(["strandline", *words[:place], part, *words[place + 1 :]])
        if code == 0 or os.path.exists(part):
            written = writer(cache.Cache(part), path, for_=target)
            print(f"wrote {written.frames} frames to {written.path}")
        return code
    finally:
        if os.path.exists(part):
            os.remove(part)


if __name__ == "__main__":
    sys.exit(main())
