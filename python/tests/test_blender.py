"""Blender reads what is written for it. STRANDLINE_BLENDER names a Python with its module bpy; `cargo xtask long` has one."""

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import shake

import strandline
from strandline import Groom

BLENDER = os.environ.get("STRANDLINE_BLENDER")

if BLENDER:

    @pytest.fixture(scope="module")
    def read(tmp_path_factory, points):
        """Curves of each file as Blender has them, the groom, and the frames of the moving cache."""
        folder = tmp_path_factory.mktemp("blender")
        generator = np.random.default_rng(4)
        groom = Groom(points, widths=generator.uniform(5e-5, 1e-4, 512), colors=generator.random((512, 3)), root_uvs=generator.random((64, 2)), groups=np.arange(64) % 3)
        with shake(groom) as simulation:
            simulation.record(folder / "a.npz")
        cache = strandline.Cache(folder / "a.npz")
        for suffix in ("usdc", "abc"):
            groom.save(folder / f"still.{suffix}", for_="blender")
            cache.save(folder / f"moving.{suffix}", for_="blender", velocities=True)
        files = {f"{name}.{suffix}": frames for name, frames in (("still", 1), ("moving", len(cache))) for suffix in ("usdc", "abc")}
        tasks = [{"file": str(folder / name), "frames": frames, "fps": round(cache.frames_per_second)} for name, frames in files.items()]
        script = Path(__file__).parent / "read_in_blender.py"
        # Blender has libraries of its own of the names that are on this path.
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        done = subprocess.run([BLENDER, str(script)], input=json.dumps(tasks), capture_output=True, text=True, env=environment)
        assert done.returncode == 0, done.stderr[-3000:]
        return {name: dict(np.load(folder / f"{name}.npz")) for name in files}, groom, cache

    def up_is_z(points):
        return np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)

    @pytest.mark.parametrize("suffix", ["usdc", "abc"])
    def test_a_groom_stands_upright_in_blender(read, suffix):
        files, groom, _ = read
        own = files[f"still.{suffix}"]
        assert np.array_equal(own["counts"], [8] * 64)
        assert np.allclose(own["points.0"], up_is_z(groom.points), rtol=1e-6, atol=1e-7)
        assert np.allclose(own["radii.0"], groom.widths / 2, rtol=1e-6)
        if suffix == "usdc":
            assert np.array_equal(own["groom_group_id"], groom["groups"])
            assert np.array_equal(own["st"], groom["root_uvs"])
            assert np.allclose(own["displayColor"][:, :3], groom["colors"], atol=1e-6)

    @pytest.mark.parametrize("suffix", ["usdc", "abc"])
    def test_hair_moves_in_blender(read, suffix):
        files, _, cache = read
        own = files[f"moving.{suffix}"]
        assert len(cache) == 6 and np.abs(cache[5] - cache[0]).max() > 1e-3
        for frame in range(6):
            assert np.allclose(own[f"points.{frame}"], up_is_z(cache[frame]), rtol=1e-6, atol=2e-6), frame
            assert np.allclose(own[f"radii.{frame}"], cache.widths() / 2, rtol=1e-6)
