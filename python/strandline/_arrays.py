"""Arrays of other libraries, by DLPack."""

from __future__ import annotations

from typing import Any

import numpy as np

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
