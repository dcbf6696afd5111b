"""Runs the notebooks of examples/notebooks and writes what their cells show, or with the word ``check`` compares it."""

from __future__ import annotations

import ast
import base64
import contextlib
import io
import json
import os
import sys
import tempfile
from pathlib import Path
from typing import Any

NOTEBOOKS = Path(__file__).parents[1] / "examples/notebooks"


def main() -> int:
    """Runs those whose names are given, or all; 1 where a text that a cell shows is another one than the file has."""
    words = sys.argv[1:]
    check = words[:1] == ["check"]
    names = words[1:] if check else words
    wrong = []
    for path in sorted(NOTEBOOKS.glob("*.ipynb")):
        if names and path.stem not in names:
            continue
        notebook = json.loads(path.read_text(encoding="utf-8"))
        had = [shown(cell) for cell in notebook["cells"]]
        run(notebook)
        if check:
            wrong += [f"{path.name}, cell {at}: shows {now}, expected {then}" for at, (then, now) in enumerate(zip(had, map(shown, notebook["cells"]), strict=True)) if then != now]
        else:
            path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    print("\n".join(wrong), end="\n" if wrong else "")
    return 1 if wrong else 0


def run(notebook: dict[str, Any]) -> None:
    """Runs the cells one after the other in a folder of their own, and replaces what they show."""
    names: dict[str, Any] = {"__name__": "__main__"}
    here = os.getcwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
            for number, cell in enumerate(cells, 1):
                cell["outputs"] = outputs("".join(cell["source"]), names, number)
                cell["execution_count"] = number
        finally:
            os.chdir(here)


def outputs(source: str, names: dict[str, Any], number: int) -> list[dict[str, Any]]:
    """Text that a cell prints, and its last expression as notebooks show it: a picture where it has one, else a text."""
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    said, value = io.StringIO(), None
    with contextlib.redirect_stdout(said):
        exec(compile(tree, f"cell {number}", "exec"), names)
        if isinstance(last, ast.Expr):
            value = eval(compile(ast.Expression(last.value), f"cell {number}", "eval"), names)
    found: list[dict[str, Any]] = []
    if said.getvalue():
        found.append({"name": "stdout", "output_type": "stream", "text": said.getvalue().splitlines(keepends=True)})
    if value is not None:
        data: dict[str, Any] = {"text/plain": repr(value).splitlines(keepends=True)}
        if hasattr(value, "_repr_png_"):
            data["image/png"] = base64.b64encode(value._repr_png_()).decode()
        found.append({"data": data, "execution_count": number, "metadata": {}, "output_type": "execute_result"})
    return found


def shown(cell: dict[str, Any]) -> list[Any]:
    """Texts that a cell shows, and true for each picture."""
    return [of.get("text") or [of["data"]["text/plain"], "image/png" in of["data"]] for of in cell.get("outputs", [])]


if __name__ == "__main__":
    sys.exit(main())
