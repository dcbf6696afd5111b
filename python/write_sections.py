"""Writes strandline/sections.py, the types of the sections of a scene, from the settings table of the engine."""

from __future__ import annotations

import sys
import textwrap
from pathlib import Path
from typing import Any

from strandline import _native

HEAD = '''"""Types of the sections of a scene, one setting a line. Written by python/write_sections.py from the settings table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypedDict
'''


def main() -> None:
    """Writes the file, or prints it with the word ``print``."""
    text = page(_native.settings())
    if sys.argv[1:] == ["print"]:
        print(text, end="")
    else:
        (Path(__file__).parent / "strandline" / "sections.py").write_text(text, encoding="utf-8")


def page(table: list[dict[str, Any]]) -> str:
    """The whole file."""
    classes: dict[str, str] = {}
    scene = {"name": "SceneSections", "about": "The sections of a scene.", "rows": table}
    add(scene, "SceneSections", classes)
    return HEAD + "".join(f"\n\n{text}" for text in classes.values())


def add(section: dict[str, Any], name: str, classes: dict[str, str]) -> None:
    """Adds the class of a section, and before it those of the sections in it."""
    lines = []
    for row in section["rows"]:
        kind = row["kind"]
        if "rows" in row:
            own = words(row["name"]) if name == "SceneSections" else f"{name}{words(row['name'])}"
            add(row, own, classes)
            kind = f"{own}" if kind == "section" else f"Sequence[{own}]"
        doc = row["doc"] if row["kind"] != "section" else row["about"].split("\n\n")[0]
        allowed = f" Allowed: {row['expected']}." if row["expected"] else ""
        lines.append(f"    {row['name']}: {kind}\n{quoted(doc + allowed, 4)}")
    about = quoted(section.get("about") or section.get("doc", ""), 4)
    classes[name] = f"class {name}(TypedDict, total=False):\n{about}\n" + "\n".join(lines)


def words(name: str) -> str:
    """The name of a class."""
    return "".join(part.capitalize() for part in name.split("_"))


def quoted(text: str, indent: int) -> str:
    """A docstring in lines of 118 characters."""
    escaped = " ".join(text.replace("\\", "\\\\").replace('"""', "'''").split())
    # A quote at the end would end the docstring early.
    escaped += " " if escaped.endswith('"') else ""
    lines = textwrap.wrap(f'"""{escaped}"""', 118 - indent, break_long_words=False, break_on_hyphens=False)
    return "".join(f"{' ' * indent}{line}\n" for line in lines)


if __name__ == "__main__":
    main()
