"""Exchange with other libraries, notebooks and processes; the window."""

import os
import pickle
import subprocess
import sys
import zlib

import numpy as np
import pytest
from conftest import shake

import strandline
from strandline import Body, Camera, Error, Groom, Picture, Scene, window


class Tensor:
    """An array of another library, on a CPU (DLPack type 1) or on a device."""

    def __init__(self, array, device=1):
        self.array, self.device = array, device

    def __dlpack__(self, **options):
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self.device, 0


def test_arrays_of_other_libraries_come_in_and_go_out(points, ball):
    groom = Groom(Tensor(points), colors=Tensor(np.full((512, 3), 0.5, dtype=np.float32)))
    assert np.shares_memory(groom.points, points)
    assert np.shares_memory(np.from_dlpack(groom), points)
    with shake(groom, body=Body(Tensor(ball.vertices), Tensor(ball.faces)), motion="still") as simulation:
        simulation.step(1 / 60, vertices=Tensor(ball.vertices), head=Tensor(np.eye(4, dtype=np.float32)))
        out = np.from_dlpack(simulation)
        assert out.shape == simulation.points.shape and np.array_equal(out, simulation.points)
        picture = simulation.picture(width=16, height=8)
        assert np.shares_memory(np.from_dlpack(picture), picture.pixels)
    for name, make in {"points": lambda of: Groom(of), "vertices": lambda of: Body(of, ball.faces), "faces": lambda of: Body(ball.vertices, of)}.items():
        with pytest.raises(Error, match=f"{name} is on a device .DLPack type 2., expected memory of the CPU"):
            make(Tensor(points, device=2))


def test_a_picture_is_an_array_of_any_kind():
    picture = Picture(np.arange(24, dtype=np.uint8).reshape(2, 4, 3))
    assert np.asarray(picture).dtype == np.uint8 and np.asarray(picture, dtype=float)[1, 3, 2] == 23
    assert not np.shares_memory(np.array(picture), picture.pixels)


def test_plain_results_are_pickled_and_simulations_are_not(tmp_path, groom):
    with shake(groom) as simulation:
        simulation.record(tmp_path / "a.npz", frames=2)
        picture = simulation.picture(width=16, height=8, layers=True)
        with pytest.raises(Error, match="a simulation is not pickled"):
            pickle.dumps(simulation)
    back = pickle.loads(pickle.dumps(picture))
    assert np.array_equal(back.pixels, picture.pixels) and np.array_equal(back.depth, picture.depth) and back.camera == picture.camera
    cache = pickle.loads(pickle.dumps(strandline.Cache(tmp_path / "a.npz")))
    assert len(cache) == 2
    assert pickle.loads(pickle.dumps(Camera(field_of_view=20))).field_of_view == 20


def test_a_film_is_a_png_with_frames(tmp_path, groom):
    with shake(groom) as simulation:
        film = simulation.film(6, "front", width=32, height=24, every=2)
    assert len(film) == 3 and film.frames_per_second == 15
    film.save(tmp_path / "a.png")
    content = (tmp_path / "a.png").read_bytes()
    assert content == film._repr_png_()
    chunks, at = [], 8
    while at < len(content):
        length = int.from_bytes(content[at : at + 4])
        name, inner = content[at + 4 : at + 8], content[at + 8 : at + 8 + length]
        assert int.from_bytes(content[at + 8 + length : at + 12 + length]) == zlib.crc32(name + inner)
        chunks.append((name, inner))
        at += 12 + length
    names = [name for name, _ in chunks]
    assert names[:2] == [b"IHDR", b"acTL"] and names.count(b"fcTL") == 3 and names[-1] == b"IEND"
    numbers = [int.from_bytes(inner[:4]) for name, inner in chunks if name in (b"fcTL", b"fdAT")]
    assert numbers == list(range(len(numbers))), "one count for all frames"
    last = zlib.decompress(b"".join(inner[4:] for name, inner in chunks[-1 - (len(names) - 1 - max(at for at, name in enumerate(names) if name == b"fcTL")) :] if name == b"fdAT"))
    assert len(last) == 24 * (1 + 3 * 32), "rows of a whole picture"
    with pytest.raises(Error, match="the film has 0 pictures"):
        strandline.Film([]).png()
    with pytest.raises(Error, match="of the same size"):
        strandline.Film([Picture(np.zeros((2, 2, 3), np.uint8)), Picture(np.zeros((3, 2, 3), np.uint8))]).png()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="displays of Linux")
def test_a_machine_without_a_display_says_so(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(Error, match="there is no display"):
        strandline.view()


def test_the_window_gets_what_is_in_memory(tmp_path, groom, ball):
    """The words of the window, which another command takes too, load the same strands."""
    moving = Body(ball.vertices, ball.faces, motion=np.stack([ball.vertices] * 3), teleports=[0.02])
    for body in (ball, moving):
        with shake(groom, body=body) as simulation:
            words = window.words_of(simulation, str(tmp_path))
            wanted = simulation.record(tmp_path / "own.npz", frames=2)
        run = [sys.executable, "-m", "strandline", "sim", *words, "--frames", "2", "--out", str(tmp_path / "other.npz")]
        done = subprocess.run(run, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        other = strandline.Cache(tmp_path / "other.npz")
        assert len(other) == wanted.frames
        assert np.allclose(other[1], strandline.Cache(tmp_path / "own.npz")[1], atol=1e-6)
    assert np.load(tmp_path / "body.npz")["teleports"] == [0.02]
    assert window.words_of(None, str(tmp_path)) == [] and window.words_of("a.hair", str(tmp_path)) == ["a.hair"]
    assert window.words_of(groom, str(tmp_path))[0] == "--groom" and os.path.exists(tmp_path / "groom.npz")
    assert window.words_of(Scene(film={"frames": 2}), str(tmp_path)) == ["--scene", str(tmp_path / "scene.toml")]
