"""Settings as TOML, the language of scenes."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .errors import Error


def value(of: Any, key: str = "value") -> str:
    """A value as TOML: numbers, words, paths, vectors, sections and lists of sections."""
    if isinstance(of, np.ndarray | np.generic):
        of = of.tolist()
    if isinstance(of, bool):
        return "true" if of else "false"
    if isinstance(of, int):
        return str(of)
    if isinstance(of, float):
        if math.isnan(of):
            return "nan"
        return repr(of) if math.isfinite(of) else ("inf" if of > 0 else "-inf")
    if isinstance(of, os.PathLike):
        of = os.fspath(of)
    if isinstance(of, str):
        return _text(of)
    if isinstance(of, Mapping):
        inner = (f"{name} = {value(part, f'{key}.{name}')}" for name, part in of.items() if part is not None)
        return "{ " + ", ".join(inner) + " }"
    if isinstance(of, Sequence):
        return "[" + ", ".join(value(part, f"{key}[{index}]") for index, part in enumerate(of)) + "]"
    raise Error(f"{key} is a {type(of).__name__}, expected a number, a text, a vector or a section", "value")


def _text(of: str) -> str:
    escaped = of.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(_escaped(character) for character in escaped) + '"'


def _escaped(character: str) -> str:
    return f"\\u{ord(character):04x}" if ord(character) < 32 or ord(character) == 127 else character


def document(of: Mapping[str, Any]) -> str:
    """A scene as TOML."""
    return "".join(f"{name} = {value(part, name)}\n" for name, part in of.items() if part is not None)


def plain(of: Any) -> Any:
    """The same as plain data, which can be changed and pickled."""
    if isinstance(of, Mapping):
        return {str(name): plain(part) for name, part in of.items() if part is not None}
    if isinstance(of, np.ndarray | np.generic):
        return of.tolist()
    if isinstance(of, os.PathLike):
        return os.fspath(of)
    if isinstance(of, Sequence) and not isinstance(of, str):
        return [plain(part) for part in of]
    return of
