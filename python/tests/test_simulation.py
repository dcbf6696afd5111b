"""Simulations: time, the view of points, bodies that move, pictures, files and threads."""

import gc
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import shake

import strandline
from strandline import Body, Camera, Error, Groom, Motion, Scene, Simulation


def test_frames_move_and_report(groom):
    with shake(groom) as simulation:
        start = simulation.points.copy()
        assert start.shape == (64, simulation.points_per_strand, 3)
        times = []
        for frame in simulation.frames(4):
            times.append(frame.time)
            assert np.isfinite(frame.points).all()
            assert all(report.non_finite == 0 and report.stretch_max < 0.05 for report in frame.reports)
        assert np.allclose(times, np.arange(1, 5) / 30)
        assert np.abs(simulation.points - start).max() > 1e-3
        assert len(list(simulation.frames())) == 2, "the rest of the film"


def test_points_are_a_read_only_view_that_outlives_the_simulation(groom):
    simulation = shake(groom)
    view = simulation.points
    assert view is simulation.points, "no copy is made"
    with pytest.raises(ValueError):
        view[0, 0, 0] = 1
    before = view.copy()
    list(simulation.frames(3))
    assert np.shares_memory(view, simulation.points)
    assert np.abs(view - before).max() > 1e-4
    now = view.copy()
    simulation.close()
    del simulation
    gc.collect()
    assert np.array_equal(view, now)


def test_a_closed_simulation_says_so(groom):
    with shake(groom) as simulation:
        pass
    for act in (lambda: simulation.step(0.1), simulation.picture, lambda: next(simulation.frames(1)), simulation.reports):
        with pytest.raises(Error, match="the simulation is closed"):
            act()


def test_a_head_carries_hair_by_matrices(groom):
    with shake(groom, motion="still") as simulation:
        roots = simulation.points[:, 0].copy()
        there = np.eye(4)
        there[:3, 3] = [0.05, 0, 0]
        simulation.step(0.1, head=there)
        assert np.allclose(simulation.points[:, 0], roots + [0.05, 0, 0], atol=1e-5)
        assert np.allclose(simulation.head, there, atol=1e-6)
        simulation.step(0.1)
        assert np.allclose(simulation.head, there, atol=1e-6), "what is not given stays"
        for wrong in (2 * np.eye(4), np.eye(3), np.full((4, 4), np.nan), np.diag([-1.0, 1, 1, 1])):
            with pytest.raises(Error, match="head "):
                simulation.step(0.1, head=wrong)


def test_wrong_arguments_of_a_step_are_refused_by_what_is_wrong(groom, ball):
    with shake(groom, body=ball) as simulation:
        for given, words in {
            "seconds": ({"seconds": -1.0}, "seconds is -1"),
            "seconds more": ({"seconds": float("nan")}, "seconds is nan"),
            "wind": ({"wind": (1.0, 2.0)}, "wind has 2 numbers"),
            "wind more": ({"wind": (float("inf"), 0, 0)}, "wind is not a finite"),
            "vertices": ({"vertices": np.zeros((3, 3))}, r"vertices has the shape \(3, 3\)"),
        }.values():
            with pytest.raises(Error, match=words):
                simulation.step(**({"seconds": 0.01} | given))
        for act, words in (
            (lambda: simulation.step("a"), "seconds is 'a'"),
            (lambda: simulation.step(0.01, wind="east"), "wind is a str"),
            (lambda: simulation.step(0.01, head=[[1, 2], [3]]), r"head is a list .*\(4, 4\)"),
            (lambda: simulation.settle(float("inf")), "seconds is inf, expected 0 to 1,000,000 s"),
            (lambda: simulation.drape(float("nan")), "seconds is nan"),
            (lambda: simulation.frames(-1), "count is -1"),
            (lambda: simulation.frames(2.5), "count is 2.5, expected a whole number"),
            (lambda: simulation.film(2, every=0), "every is 0"),
            (lambda: simulation.picture(3), "camera is a int, expected a Camera or a side"),
            (lambda: simulation.picture("top"), "top"),
            (lambda: simulation.picture(Camera(position=(0, 1))), r"camera.position has the shape \(2,\)"),
            (lambda: simulation.picture(Camera(near="a")), "camera.near is 'a'"),
        ):
            with pytest.raises(Error, match=words):
                act()
    with pytest.raises(Error, match="body is a int, expected a Body or a path"):
        shake(groom, body=3)
    with shake(groom) as simulation, pytest.raises(Error, match="expected Simulation\\(body="):
        simulation.step(0.01, vertices=np.zeros((3, 3)))


def test_a_body_takes_new_vertices_every_step_or_as_a_whole(groom, ball):
    swell = np.stack([ball.vertices * (1 + 0.02 * share) for share in np.linspace(0, 1, 5)])
    with shake(groom, body=ball, motion="still") as simulation:
        for vertices in swell:
            reports = simulation.step(1 / 30, vertices=vertices)
            assert all(report.non_finite == 0 for report in reports)
    moving = Body(ball.vertices, ball.faces, motion=swell, frames_per_second=30)
    with shake(groom, body=moving, motion=None) as simulation:
        assert simulation.scene["motion.name"] == "still"
        for frame in simulation.frames(4):
            assert np.isfinite(frame.points).all()
    with shake(groom, body=moving, motion="shake") as simulation:
        assert simulation.scene["motion.name"] == "shake"
    with shake(groom, body=ball, motion=None) as simulation:
        assert simulation.scene["motion.name"] == "shake"
    assert np.allclose(moving.at(0.5 / 30), 0.5 * (swell[0] + swell[1]))


def test_marks_of_a_body_carry_its_hair_over_a_cut(groom, ball):
    aside = np.stack([ball.vertices, ball.vertices, ball.vertices + (1, 0, 0), ball.vertices + (1, 0, 0)])
    body = Body(ball.vertices, ball.faces, motion=aside, frames_per_second=30, teleports=[1.5 / 30])
    # Vertices are rounded to 32 bits.
    assert np.allclose(body.at(1.4 / 30), aside[1], atol=1e-6) and np.allclose(body.at(1.6 / 30), aside[2], atol=1e-6)
    rest = None
    with shake(groom, body=body, motion=None) as simulation:
        for frame in simulation.frames(4):
            rest = np.array(frame.points) if rest is None else rest
            last = np.array(frame.points)
        assert sum(": hair is carried" in note for note in simulation.take_notes()) == 1
    assert np.abs(last - np.asarray(rest) - (1, 0, 0)).max() < 0.01
    with pytest.raises(Error, match="teleports is no list of finite times"):
        Body(ball.vertices, ball.faces, motion=aside, teleports=[np.nan])
    with pytest.raises(Error, match="marks of a body without a motion"):
        Body(ball.vertices, ball.faces, teleports=[0.5])


def test_hair_and_body_in_memory_stay_where_they_are(groom, ball):
    with shake(groom, body=ball, motion="still") as simulation:
        assert np.allclose(simulation.points[:, 0], groom.array[:, 0], atol=2e-3)


def test_hair_that_is_draped_rests(groom):
    with shake(groom, motion="still", settings=strandline.Settings(strands={"method": "constrain"}), film={"settle": 0}) as simulation:
        before = simulation.points.copy()
        passed = simulation.drape(5.0)
        assert 0 < passed <= 5.2
        draped = simulation.points.copy()
        assert np.abs(draped - before).max() > 1e-3
        simulation.settle(0.1)
        assert np.sqrt(((simulation.points - draped) ** 2).sum(axis=2)).max() < 0.02


def test_settings_change_while_it_runs(groom):
    with shake(groom, motion="still") as simulation:
        simulation.set({"simulation.gravity": (0, 0, 0)}, look={"follow_strands": 2})
        assert np.allclose(simulation.scene["simulation.gravity"], [0, 0, 0])
        with pytest.raises(Error, match="another Simulation"):
            simulation.set({"groom.length": 0.5})
        with pytest.raises(Error, match="`simulation.gravity`"):
            simulation.set({"simulation.gravty": (0, 0, 0)})


def test_lights_follow_the_look(groom, ball):
    with shake(groom, body=ball, motion="still") as simulation:
        before = simulation.picture("back", width=64, height=48).pixels
        simulation.set({"look.light_rig": "all_sides"})
        after = simulation.picture("back", width=64, height=48).pixels
        # Most of both pictures is background.
        assert after.mean() > before.mean() + 2 and np.abs(after.astype(int) - before).max() > 20


def test_pictures_are_arrays(groom, ball, tmp_path):
    with shake(groom, body=ball) as simulation:
        picture = simulation.picture("front", width=64, height=48)
        assert picture.pixels.shape == (48, 64, 3) and picture.pixels.dtype == np.uint8
        assert picture.mask is None and len(np.unique(picture.pixels)) > 8
        clear = simulation.picture(transparent=True)
        assert clear.pixels.shape == (48, 64, 4)
        assert clear.mask.min() == 0 and clear.mask.max() > 200
        clear.save(tmp_path / "a.png")
        assert (tmp_path / "a.png").read_bytes() == clear._repr_png_()
        assert clear._repr_png_().startswith(b"\x89PNG")
        near = Camera(position=(0, 0, 0.4), target=(0, 0, 0))
        assert not np.array_equal(simulation.picture(near).pixels, clear.pixels)
        clip = near.clip_from_view(64 / 48) @ near.view_from_world @ [0, 0, 0, 1]
        assert np.allclose(clip[:2], 0, atol=1e-6)
        with pytest.raises(Error, match="picture.width"):
            simulation.picture(width=0)
        with pytest.raises(Error, match="camera.field_of_view"):
            simulation.picture(Camera(field_of_view=0))
        with pytest.raises(Error, match="create it first"):
            picture.save(tmp_path / "none" / "a.png")


def test_a_side_frames_the_body_where_it_is(groom, ball):
    with shake(groom, body=ball, motion="still") as simulation:
        there = np.eye(4)
        there[0, 3] = 1.0
        far = []
        for _ in range(2):
            camera = simulation.picture("front", width=16, height=16).camera
            far.append(np.linalg.norm(np.subtract(camera.position, camera.target)))
            simulation.step(1.0, head=there, vertices=ball.vertices)
        assert far[1] < 1.3 * far[0], "and not where it was too"


def test_python_and_the_program_make_the_same_bits(tmp_path):
    scene = Scene(style={"style": "bob", "strand_count": 40}, film={"frames": 4}, devices={"simulation": "cpu", "pictures": "cpu"}, picture={"width": 32, "height": 32})
    scene.save(tmp_path / "a.toml")
    with Simulation(scene) as simulation:
        written = simulation.record(tmp_path / "own.npz")
    assert written.frames == 4
    words = [sys.executable, "-m", "strandline", "sim", "--scene", str(tmp_path / "a.toml"), "--out", str(tmp_path / "other.npz")]
    done = subprocess.run(words, capture_output=True, text=True, env=os.environ | {"RAYON_NUM_THREADS": "1"})
    assert done.returncode == 0, done.stderr
    with np.load(tmp_path / "own.npz") as own, np.load(tmp_path / "other.npz") as other:
        for name in ("points", "starts", "times", "world_from_head"):
            assert np.array_equal(own[name], other[name]), name


def test_files_of_moving_hair_are_read_frame_by_frame(groom, tmp_path):
    with shake(groom) as simulation:
        kept = []
        simulation._native.begin_file(str(tmp_path / "a.npz"), "guides", "any", 1)
        for frame in simulation.frames():
            kept.append(frame.points.copy())
            simulation._native.write_frame()
        simulation._native.end_file()
    cache = strandline.Cache(tmp_path / "a.npz")
    assert len(cache) == 6 and cache.what == "guides" and cache.frames_per_second == 30
    assert np.array_equal(np.stack([cache.array(at) for at in range(6)]), np.stack(kept))
    assert np.array_equal(cache[-1], cache[5])
    assert cache.scene["motion.name"] == "shake"
    with pytest.raises(IndexError):
        cache[6]
    with pytest.raises(Error, match="cannot read the cache.*none.npz"):
        strandline.Cache(tmp_path / "none.npz")


def test_a_film_longer_than_the_scene_is_recorded(groom, tmp_path):
    with shake(groom) as simulation:
        assert simulation.record(tmp_path / "a.npz", frames=9).frames == 9
        with pytest.raises(Error, match="names no format of moving hair"):
            simulation.record(tmp_path / "a.docx", frames=1)


def test_other_threads_run_while_a_step_does(groom):
    with shake(groom) as simulation:
        done, beats = threading.Event(), []

        def beat():
            while not done.is_set():
                beats.append(time.perf_counter())
                time.sleep(0.001)

        thread = threading.Thread(target=beat)
        thread.start()
        begun = time.perf_counter()
        simulation.step(8.0)
        spent = time.perf_counter() - begun
        done.set()
        thread.join()
        longest = max(np.diff([begun, *beats, begun + spent]), default=spent)
        assert longest < 0.6 * spent + 0.05, f"{longest} s of {spent} s without the other thread"


def test_other_threads_run_while_points_wait_for_a_step(groom):
    with shake(groom) as simulation:
        begun, ended, beats = threading.Event(), threading.Event(), []

        def step():
            begun.set()
            simulation.step(8.0)

        def beat():
            while not ended.is_set():
                beats.append(time.perf_counter())
                time.sleep(0.001)

        threads = [threading.Thread(target=act) for act in (step, beat)]
        for thread in threads:
            thread.start()
        begun.wait()
        time.sleep(0.02)
        # Three threads wait for the same memory.
        waiting = [threading.Thread(target=lambda: simulation.points) for _ in range(2)]
        since = time.perf_counter()
        for thread in waiting:
            thread.start()
        simulation.points
        spent = time.perf_counter() - since
        ended.set()
        for thread in threads + waiting:
            thread.join()
        longest = max(np.diff([since, *[beat for beat in beats if beat > since], since + spent]), default=spent)
        assert longest < 0.6 * spent + 0.05, f"{longest} s of {spent} s without the other thread"


@pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
def test_what_ctrl_c_stopped_goes_on_to_the_same_bits(tmp_path):
    code = (
        "import os, signal, threading, time, numpy as np, strandline\n"
        "from pxr import Gf, Sdf, Usd, UsdGeom, UsdSkel, Vt\n"
        "def begin(**film):\n"
        "    scene = strandline.Scene(style={'strand_count': 60}, film=film)\n"
        "    return strandline.Simulation(scene, backend='cpu', motion='shake')\n"
        "def stop(after):\n"
        "    threading.Timer(after, lambda: os.kill(os.getpid(), signal.SIGINT)).start()\n"
        "with begin(frames=4, settle=0.5) as simulation:\n"
        "    wanted = [frame.points.copy() for frame in simulation.frames()]\n"
        "with begin(frames=4, settle=0.5) as simulation:\n"
        "    try:\n"
        "        stop(0.02)\n"
        "        list(simulation.frames())\n"
        "        time.sleep(60)\n"
        "    except KeyboardInterrupt:\n"
        "        rest = [(frame.index, frame.points.copy()) for frame in simulation.frames()]\n"
        "    assert np.array_equal(simulation.points, wanted[-1])\n"
        "    assert all(np.array_equal(points, wanted[index]) for index, points in rest)\n"
        "with begin(frames=5000) as simulation:\n"
        "    try:\n"
        "        def late():\n"
        "            while simulation._frame < 4: time.sleep(0.01)\n"
        "            stop(0)\n"
        "        threading.Thread(target=late, daemon=True).start()\n"
        "        simulation.record('a.usdc')\n"
        "    except KeyboardInterrupt as stopped:\n"
        "        (note,) = stopped.__notes__\n"
        "    assert note == 'the frames so far are kept: a.usdc.part.npz', note\n"
        "    written = len(strandline.Cache('a.usdc.part.npz'))\n"
        "    assert written > 0 and simulation._frame - written in (0, 1), (written, simulation._frame)\n"
    )
    pytest.importorskip("pxr")
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr[-2000:]


@pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
def test_ctrl_c_stops_between_steps():
    code = (
        "import strandline\n"
        "with strandline.Simulation(strandline.Scene(style={'strand_count': 60}), backend='cpu') as simulation:\n"
        "    print('begun', flush=True)\n"
        "    try:\n"
        "        for frame in simulation.frames(100000): pass\n"
        "    except KeyboardInterrupt:\n"
        "        print('stopped', simulation.points.shape, flush=True)\n"
    )
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline().strip() == "begun"
    time.sleep(0.3)
    child.send_signal(signal.SIGINT)
    out, _ = child.communicate(timeout=60)
    assert out.startswith("stopped") and child.returncode == 0


def test_a_progress_bar_is_drawn(groom, capsys):
    with shake(groom) as simulation:
        list(simulation.frames(3, progress=True))
    shown = capsys.readouterr().err
    assert "simulating: 100%" in shown and "3/3" in shown and "frame/s" in shown


def test_backends_that_are_not_there_are_refused(groom):
    with pytest.raises(Error, match="expected auto, cpu, gpu"):
        shake(groom, backend="tpu")
    with pytest.raises(Error) as caught:
        shake(groom, backend="gpu:999")
    assert caught.value.kind in ("other", "refused", "device_lost", "value")


def test_a_step_of_python_costs_little():
    groom = Groom(np.random.default_rng(1).normal(size=(2000, 1, 3)) * 0.1 + np.linspace(0, 0.2, 16)[None, :, None] * [0, -1.0, 0])
    with Simulation(groom=groom, motion="still", backend="cpu", body=None) as simulation:
        simulation.step(0)
        best = 1e9
        for _ in range(50):
            begun = time.perf_counter()
            simulation.step(0)
            simulation.points
            best = min(best, time.perf_counter() - begun)
        assert best < 1e-3, f"{1e3 * best} ms where no step happens: ten times the bound, for a busy machine"


def test_hair_with_colliders_and_a_style_needs_no_arrays():
    with Simulation(style={"style": "pixie", "strand_count": 30}, motion=Motion("nod"), backend="cpu", film={"frames": 2}) as simulation:
        assert len(list(simulation.frames())) == 2
