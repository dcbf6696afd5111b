"""Python of the README and the guide, as it is printed: six lines on the first screen, and strands of an array to USD and a picture."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import strandline

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def scripts(text):
    """The Python of a document."""
    return [part.split("```")[0] for part in text.split("```python\n")[1:]]


(SHORT,) = scripts(README)
(WHOLE,) = (script for script in scripts((ROOT / "docs" / "python.md").read_text(encoding="utf-8")) if "hair.usdc" in script)


def run(folder, script):
    """Runs a script as a user would: a file, in an empty folder."""
    (folder / "script.py").write_text(script, encoding="utf-8")
    done = subprocess.run([sys.executable, "script.py"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout


def test_six_lines_are_on_the_first_screen(tmp_path):
    assert SHORT.count("\n") == 6 and README[: README.index(SHORT)].count("\n") < 12
    # Fewer strands and frames than a picture wants.
    small = SHORT.replace("strand_count=1500", "strand_count=40").replace("frames(48)", "frames(3)")
    assert small != SHORT
    assert run(tmp_path, small).splitlines()[2].startswith("0.1")
    assert (tmp_path / "bob.png").stat().st_size > 3000


def test_strands_of_an_array_on_a_moving_mesh_are_written_and_drawn(tmp_path):
    pytest.importorskip("pxr")
    assert WHOLE.count("\n") == 12
    assert "frames=24" in run(tmp_path, WHOLE)
    first, last = (strandline.load(tmp_path / "hair.usdc", frame=frame) for frame in (0, 6))
    roots = [groom.array[:, 0] for groom in (first, last)]
    moved = roots[1] - roots[0]
    assert np.allclose(moved, moved[0], atol=2e-3) and 0.015 < moved[0, 0] < 0.03, "the mesh carries the roots"
    tips = last.array[:, -1] - first.array[:, -1]
    assert np.isfinite(tips).all() and np.linalg.norm(tips - moved, axis=1).mean() > 2e-3, "and the hair lags behind"
    assert (tmp_path / "hair.png").read_bytes().startswith(b"\x89PNG") and (tmp_path / "hair.png").stat().st_size > 20_000
