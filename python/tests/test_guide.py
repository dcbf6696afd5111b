"""The pages of the guide: each is a script that makes its picture. The notebooks: each shows what its cells make."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

PAGES = Path(__file__).parents[2] / "docs/python"

#: With this variable the pictures of the pages are written.
WRITE = os.environ.get("STRANDLINE_WRITE_GUIDE")

#: All pages, and those of a short run; `cargo xtask long` has all.
ALL = ("research", "unreal", "blender", "batch", "game_loop")
RUN = ALL if WRITE or os.environ.get("STRANDLINE_JOBS") else ("unreal", "game_loop")


def test_every_page_is_tested():
    assert {path.stem for path in PAGES.glob("*.md")} == set(ALL)


NOTEBOOKS = Path(__file__).parents[2] / "examples/notebooks"
NAMES = ("data_set", "exchange", "first_steps")


def test_notebooks_are_small_and_have_run():
    assert sorted(path.stem for path in NOTEBOOKS.glob("*")) == list(NAMES)
    for name in NAMES:
        path = NOTEBOOKS / f"{name}.ipynb"
        cells = [cell for cell in json.loads(path.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == "code"]
        assert path.stat().st_size < 300_000 and [cell["execution_count"] for cell in cells] == list(range(1, len(cells) + 1))
        assert any("image/png" in output.get("data", {}) for cell in cells for output in cell["outputs"])


if len(RUN) == len(ALL):

    @pytest.mark.parametrize("name", NAMES)
    def test_a_notebook_shows_what_its_cells_make(name):
        pytest.importorskip("pxr")
        pytest.importorskip("alembic3d")
        writer = Path(__file__).parents[1] / "write_notebooks.py"
        done = subprocess.run([sys.executable, "-P", writer, "check", name], capture_output=True, text=True)
        assert done.returncode == 0, f"python -P python/write_notebooks.py\n{done.stdout}{done.stderr[-2000:]}"


@pytest.mark.parametrize("page", RUN)
def test_a_page_makes_its_picture(tmp_path, page):
    if page in ("unreal", "blender"):
        pytest.importorskip("pxr")
        pytest.importorskip("alembic3d")
    text = (PAGES / f"{page}.md").read_text(encoding="utf-8")
    makes(tmp_path, "\n".join(scripts(text)), f"guide_{page}.png")
    assert f"](../gallery/guide_{page}.png)" in text


if len(RUN) == len(ALL):

    def test_the_page_before_the_guide_makes_its_picture(tmp_path):
        text = (PAGES.parent / "python.md").read_text(encoding="utf-8")
        makes(tmp_path, scripts(text)[0], "python.png")
        assert "](gallery/python.png)" in text


def scripts(text):
    """The blocks of Python of a page."""
    return [part.split("```")[0] for part in text.split("```python\n")[1:]]


def makes(folder, script, name):
    """Runs a script, which makes a picture that the gallery has."""
    (folder / "page.py").write_text(script, encoding="utf-8")
    done = subprocess.run([sys.executable, "page.py"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-2000:]
    assert (folder / name).stat().st_size > 3000
    if WRITE:
        shutil.copy(folder / name, PAGES.parent / "gallery" / name)
    assert (PAGES.parent / "gallery" / name).exists()
