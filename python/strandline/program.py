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


def _value(words: list[str], flag: str) -> str | None:
    """The value of a flag, as the next word or behind ``=``; the last one counts. It is taken out of the words."""
    found = None
    for at in reversed(range(len(words))):
        name, joined, value = words[at].partition("=")
        if name == flag and (joined or at + 1 < len(words)):
            found = found or (value if joined else words[at + 1])
            del words[at : at + (1 if joined else 2)]
    return found


def _run(words: list[str]) -> int:
    rest = list(words)
    path = _value(rest, "--out")
    if words[:1] != ["sim"] or path is None or os.path.splitext(path)[1].lower() not in _EXTRA:
        return _native.program(["strandline", *words])
    target = _value(rest, "--for") or "any"
    code = 0

    def simulate(part: str) -> bool:
        nonlocal code
        code = _native.program(["strandline", *rest, "--out", part])
        return code == 0 or os.path.exists(part)

    written = cache.by_part(path, simulate, for_=target)
    if written is not None:
        print(f"wrote {written.frames} frames to {written.path}")
    return code


if __name__ == "__main__":
    sys.exit(main())
