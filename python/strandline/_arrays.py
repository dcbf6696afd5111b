"""Arguments as the engine takes them: arrays, those of other libraries by DLPack too, and numbers."""

from __future__ import annotations

import math
import operator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import Error

#: DLPack's numbers of memory that the CPU reads: its own, and that which CUDA and ROCm have pinned.
_HOST = (1, 3, 11)


def host(of: Any, name: str) -> Any:
    """An array of another library as one of numpy without a copy; all else as it is. Arrays on a device are refused."""
    if isinstance(of, np.ndarray | np.generic) or not hasattr(of, "__dlpack__") or not hasattr(of, "__dlpack_device__"):
        return of
    device = int(of.__dlpack_device__()[0])
    if device not in _HOST:
        raise Error(f"{name} is on a device (DLPack type {device}), expected memory of the CPU: move it there first", "value")
    try:
        return np.from_dlpack(of)
    except (BufferError, RuntimeError, TypeError) as error:
        raise Error(f"{name} cannot be read by DLPack: {error}", "value") from None


def numbers(of: Any, name: str, shape: str, kind: Any = np.float32) -> NDArray[Any]:
    """Numbers of an argument in C order, without a copy where they are so. ``shape`` is that which errors name; whole
    numbers are refused where ``kind`` cannot hold them."""
    try:
        found = np.asarray(host(of, name))
    except (ValueError, TypeError, OverflowError):
        raise Error(f"{name} is a {type(of).__name__} with rows of different lengths, or no numbers, expected an array of the shape {shape}", "value") from None
    if found.dtype.kind not in "biuf":
        what = f"a {type(of).__name__}" if found.ndim == 0 else f"an array of {found.dtype}"
        raise Error(f"{name} is {what}, expected numbers of the shape {shape}", "value")
    if np.issubdtype(kind, np.integer) and found.size:
        if found.dtype.kind == "f" and not np.all(found == np.trunc(found)):
            raise Error(f"{name} has numbers that are not whole, expected whole numbers of the shape {shape}", "value")
        most = np.iinfo(kind).max
        if found.min() < 0 or found.max() > most:
            raise Error(f"{name} has the number {found.min() if found.min() < 0 else found.max()}, expected 0 to {most}", "value")
    return np.asarray(found, dtype=kind, order="C")


def number(of: Any, name: str, expected: str, least: float = -math.inf, most: float = math.inf) -> float:
    """A number in a range; NaN is in none."""
    try:
        found = float(of)
    except (TypeError, ValueError):
        raise Error(f"{name} is {of!r}, expected {expected}", "value") from None
    if not least <= found <= most:
        raise Error(f"{name} is {found}, expected {expected}", "value")
    return found


def count(of: Any, name: str, least: int = 0, most: int = 2**32 - 1) -> int:
    """A whole number in a range."""
    try:
        found = operator.index(of)
    except TypeError:
        raise Error(f"{name} is {of!r}, expected a whole number", "value") from None
    if not least <= found <= most:
        raise Error(f"{name} is {found}, expected {least} or more" if found < least else f"{name} is {found}, expected {most} or less", "value")
    return found
