"""The program with the files of extras."""

import os
import subprocess
import sys

import numpy as np
import pytest

import strandline
from strandline import Error, Groom, Scene, program

pytest.importorskip("pxr")
pytest.importorskip("alembic3d")


def run(capfd, *words):
    """Exit code and lines of the program, in this process."""
    code = program.main([str(word) for word in words])
    out, err = capfd.readouterr()
    return code, out, err


@pytest.mark.parametrize("suffix", ["usdc", "abc"])
def test_convert_reads_and_writes_them(tmp_path, points, capfd, suffix):
    groom = Groom(points, groups=np.arange(64) % 3)
    groom.save(tmp_path / "a.npz")
    code, out, err = run(capfd, "convert", tmp_path / "a.npz", "--scale", "1", tmp_path / f"b.{suffix}", "--for", "unreal")
    assert code == 0, err
    assert f"wrote 64 strands, 512 points to {tmp_path / f'b.{suffix}'}" in out, "copies are not named"
    code, out, err = run(capfd, "convert", tmp_path / f"b.{suffix}", tmp_path / "c.hair")
    assert code == 0, err
    back = strandline.load(tmp_path / "c.hair", scale=1, up="y" if suffix == "usdc" else "z")
    assert np.allclose(back.array, points, atol=1e-6)
    code, out, err = run(capfd, "info", tmp_path / f"b.{suffix}")
    assert code == 0 and "strands   64" in out and f"b.{suffix}" in out
    assert not [name for name in os.listdir(tmp_path) if "part" in name]


def test_flags_with_values_are_known(tmp_path):
    """The words of ``convert`` that are no files are those of its page."""
    page = (__import__("pathlib").Path(__file__).parents[2] / "docs/cli.md").read_text(encoding="utf-8")
    section = page.split("## convert\n")[1].split("\n## ")[0] + page.split("## info\n")[1].split("\n## ")[0]
    flags = [line.split("`")[1] for line in section.splitlines() if line.startswith("| `--")]
    bare = {flag for flag in flags if " " not in flag}
    assert len(flags) > 8 and bare <= set(program._BARE) and not {flag.split()[0] for flag in flags if " " in flag} & set(program._BARE)
    words = ["--points", "8", "a.usdc", "--clean", "--up=-z", "--move", "-1,0,0", "b.abc"]
    assert [words[at] for at in program._places(words)] == ["a.usdc", "b.abc"]


def test_grooms_and_bodies_of_a_scene_are_files_of_extras(tmp_path, points, ball, capfd):
    from pxr import Usd, UsdGeom, Vt

    Groom(points).save(tmp_path / "a.usdc")
    stage = Usd.Stage.CreateNew(str(tmp_path / "ball.usdc"))
    UsdGeom.SetStageMetersPerUnit(stage, 1)
    UsdGeom.SetStageUpAxis(stage, "Y")
    stage.SetTimeCodesPerSecond(24)
    mesh = UsdGeom.Mesh.Define(stage, "/Body")
    mesh.CreateFaceVertexCountsAttr([3] * len(ball.faces))
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(ball.faces.reshape(-1).astype(np.int32)))
    for code in range(4):
        mesh.CreatePointsAttr().Set(Vt.Vec3fArray.FromNumpy(ball.vertices + np.float32([0.01 * code, 0, 0])), code)
    stage.GetRootLayer().Save()
    common = ["--motion", "still", "--frames", "3", "--backend", "cpu"]
    words = ["sim", "--groom", tmp_path / "a.usdc", f"--body={tmp_path / 'ball.usdc'}", *common, "--out", tmp_path / "one.usdc"]
    code, out, err = run(capfd, *words)
    assert code == 0, err
    assert "wrote 3 frames" in out and len(strandline.load(tmp_path / "one.usdc")) == 64
    (tmp_path / "a.toml").write_text('[groom]\nfile = "a.usdc"\n[body]\nfile = "ball.usdc"\n')
    code, out, err = run(capfd, "sim", "--scene", tmp_path / "a.toml", *common, "--out", tmp_path / "two.npz")
    assert code == 0, err
    first, last = strandline.Cache(tmp_path / "two.npz"), strandline.load(tmp_path / "one.usdc", frame=2)
    assert np.allclose(first[2], last.points, atol=1e-6)
    moved = first.array(2)[:, 0] - first.array(0)[:, 0]
    assert np.allclose(np.median(moved, axis=0), [0.01 * 24 / 30 * 2, 0, 0], atol=2e-3), "the body carries the roots"
    with strandline.Simulation(tmp_path / "a.toml", backend="cpu", motion="still") as simulation:
        assert simulation.strand_count == 64


def test_the_extra_that_is_missing_is_named(tmp_path, monkeypatch, capfd):
    for module, suffix, extra in (("pxr", "usdc", "usd"), ("alembic3d", "abc", "abc")):
        monkeypatch.setitem(sys.modules, module, None)
        (tmp_path / f"a.{suffix}").write_bytes(b"nothing")
        for words in (["convert", f"a.{suffix}", "b.hair"], ["sim", "--groom", f"a.{suffix}"], ["sim", "--body", f"a.{suffix}"], ["convert", "a.hair", f"b.{suffix}"]):
            code, _, err = run(capfd, *words)
            assert code == 1 and f"pip install 'strandline[{extra}]'" in err, (words, err)


def test_errors_name_the_file_and_not_its_copy(tmp_path, capfd):
    (tmp_path / "a.abc").write_bytes(b"Ogawa\xff" + bytes(40))
    code, _, err = run(capfd, "convert", tmp_path / "a.abc", tmp_path / "b.hair")
    assert code == 1 and str(tmp_path / "a.abc") in err
    Groom(np.zeros((1, 2, 3))).save(tmp_path / "b.abc")
    with pytest.raises(Error, match="b.abc"):
        strandline.load(tmp_path / "b.abc", strict=True)
    code, _, err = run(capfd, "convert", tmp_path / "b.abc", tmp_path / "b.hair")
    assert code == 1 and str(tmp_path / "b.abc") in err and ".npz" not in err
