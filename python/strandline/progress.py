"""A line of progress on a terminal."""

from __future__ import annotations

import sys
import time
from types import TracebackType

_WIDTH = 24


class Progress:
    """A bar on standard error, where that is a terminal or ``shown`` is true."""

    def __init__(self, total: int, what: str, unit: str, shown: bool | None = None) -> None:
        self._total, self._what, self._unit = max(total, 1), what, unit
        self._shown = sys.stderr is not None and sys.stderr.isatty() if shown is None else shown
        self._start = self._last = time.monotonic()
        self._printed = False

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._printed:
            print(file=sys.stderr)

    def show(self, done: int) -> None:
        """Draws the bar ten times a second and at the end."""
        now = time.monotonic()
        if not self._shown or (done < self._total and now - self._last < 0.1):
            return
        self._last, self._printed = now, True
        share, spent = done / self._total, now - self._start
        rate = done / spent if spent > 0 else 0.0
        left = (self._total - done) / rate if rate > 0 else 0.0
        bar = ("█" * int(share * _WIDTH)).ljust(_WIDTH)
        line = f"\r{self._what}: {share:4.0%}|{bar}| {done}/{self._total} [{_clock(spent)}<{_clock(left)}, {rate:.1f} {self._unit}/s]"
        print(line, end="", file=sys.stderr, flush=True)


def _clock(seconds: float) -> str:
    return f"{int(seconds) // 60:02d}:{int(seconds) % 60:02d}"
