"""Moving pictures."""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Sequence
from dataclasses import dataclass

from .errors import Error
from .picture import Picture


@dataclass(frozen=True, repr=False)
class Film:
    """Pictures of the same size, one after the other. Notebooks show it moving: it is a .png with frames."""

    pictures: Sequence[Picture]
    frames_per_second: float = 24.0

    def png(self) -> bytes:
        """The bytes of an animated .png, which repeats; what knows no animation shows the first picture."""
        if not self.pictures or len({picture.pixels.shape for picture in self.pictures}) != 1:
            raise Error(f"the film has {len(self.pictures)} pictures, expected one or more of the same size", "value")
        first = self.pictures[0]
        delay = struct.pack(">HH", 1000, max(min(round(1000 * self.frames_per_second), 65535), 1))
        parts, number = [], 0
        for index, picture in enumerate(self.pictures):
            chunks = _chunks(picture.png())
            control = struct.pack(">IIIII", number, first.width, first.height, 0, 0) + delay + bytes(2)
            number += 1
            parts.append(_chunk(b"fcTL", control))
            for name, content in chunks:
                if name == b"IHDR" and index == 0:
                    parts[:0] = [_chunk(name, content), _chunk(b"acTL", struct.pack(">II", len(self.pictures), 0))]
                elif name == b"IDAT" and index == 0:
                    parts.append(_chunk(name, content))
                elif name == b"IDAT":
                    parts.append(_chunk(b"fdAT", struct.pack(">I", number) + content))
                    number += 1
        return b"\x89PNG\r\n\x1a\n" + b"".join(parts) + _chunk(b"IEND", b"")

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the animated .png."""
        part = f"{os.fspath(path)}.part"
        try:
            with open(part, "wb") as file:
                file.write(self.png())
            os.replace(part, path)
        except OSError as error:
            raise Error(f"cannot write the film: {error.strerror}: {os.fspath(path)}", "file") from None

    def _repr_png_(self) -> bytes:
        return self.png()

    def __len__(self) -> int:
        return len(self.pictures)

    def __repr__(self) -> str:
        return f"Film({len(self)} pictures, {self.frames_per_second:g} a second)"


def _chunks(png: bytes) -> list[tuple[bytes, bytes]]:
    """Names and contents of the chunks of a .png."""
    found, at = [], 8
    while at < len(png):
        length = struct.unpack(">I", png[at : at + 4])[0]
        found.append((png[at + 4 : at + 8], png[at + 8 : at + 8 + length]))
        at += 12 + length
    return found


def _chunk(name: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
