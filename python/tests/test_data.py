"""Grooms, bodies, scenes and errors as plain data."""

import pickle
import subprocess
import sys

import numpy as np
import pytest

import strandline
from strandline import Error, Groom, Look, Motion, Scene, Settings


def refused(kind, *words):
    return pytest.raises(Error, match="(?s)" + ".*".join(words)), kind


def test_import_is_quick_and_loads_no_gpu_or_window_library():
    code = (
        "import time; begun = time.process_time(); import numpy; between = time.process_time(); import strandline; "
        "spent = time.process_time() - between; maps = open('/proc/self/maps').read(); "
        "print(spent, between - begun, [name for name in ('libvulkan', 'libX11', 'libwayland', 'libGL') if name in maps])"
    )
    printed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    spent, of_numpy, found = printed.split(" ", 2)
    assert found.strip() == "[]"
    # Time of processors. On a machine with busy neighbours numpy takes 0.5 s and strandline 0.17 s.
    assert float(spent) < max(0.15, 0.5 * float(of_numpy)), printed


def test_a_groom_of_an_array_is_a_view_of_shape_strand_point(points):
    groom = Groom(points)
    assert groom.array.shape == points.shape and groom.array.dtype == np.float32
    assert np.shares_memory(groom.array, points)
    assert len(groom) == 64 and groom.is_uniform


def test_ragged_grooms_have_starts():
    groom = Groom(np.arange(21).reshape(7, 3), starts=[0, 3, 7], widths=[1e-4, 2e-4])
    assert [len(strand) for strand in groom.strands()] == [3, 4]
    with pytest.raises(Error, match="different numbers of points"):
        groom.array
    one = groom.selected([1])
    assert np.array_equal(one.points, groom.points[3:]) and np.allclose(one.widths, [2e-4])
    even = groom.resampled(5)
    assert even.array.shape == (2, 5, 3)
    assert np.allclose(even.array[:, 0], groom.points[[0, 3]]) and np.allclose(even.array[:, -1], groom.points[[2, 6]])


def test_attributes_go_in_and_come_out_by_name(points):
    groom = Groom(points, colors=np.full((512, 3), 0.5), root_uvs=np.zeros((64, 2)), groups=np.arange(64) % 2)
    assert groom["groups"].dtype == np.uint32 and "colors" in groom
    groom["guide_flags"] = np.arange(64) % 4 == 0
    with pytest.raises(Error, match="`colour` is no attribute of a groom, expected `colors`"):
        groom["colour"] = np.zeros((512, 3))
    with pytest.raises(Error, match=r"colors has the shape \(5,\)"):
        groom["colors"] = np.zeros(5)
    with pytest.raises(Error, match="groups has 3 rows, expected 64, one for each strand"):
        Groom(points, groups=[0, 1, 2])


RAGGED = [[[0, 0, 0]], [[0, 0, 0], [1, 1, 1]]]


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Groom("strands"), r"points is a str, expected numbers of the shape \(strand, point, 3\)"),
        (lambda: Groom(RAGGED), "points is a list with rows of different lengths"),
        (lambda: Groom(np.zeros((2, 3)), starts=[0, -1]), "starts has the number -1, expected 0 to"),
        (lambda: Groom(np.zeros((2, 3)), starts=[0, 1.5, 2]), "starts has numbers that are not whole"),
        (lambda: Groom(np.zeros((2, 2, 3)), widths=-1.0), "widths has numbers that are negative"),
        (lambda: Groom(np.zeros((2, 2, 3)), widths="thin"), "widths is a str"),
        (lambda: Groom(np.zeros((2, 2, 3)), groups=[-1, 0]), "groups has the number -1"),
        (lambda: Groom(np.zeros((2, 2, 3)), guide_indices=[[0], [1]]), r"guide_indices has the shape \(2, 1\) and guide_weights None"),
        (lambda: Groom(np.zeros((2, 2, 3)), guide_indices=[[0], [2]], guide_weights=[[1], [1]]), "guide_indices has the strand 2, expected 0 to 1"),
        (lambda: Groom(np.zeros((2, 2, 3)))[0], "`0` is no attribute of a groom"),
        (lambda: Groom(np.zeros((2, 2, 3))).selected([5]), "strands is no index or mask of 2 strands"),
        (lambda: Groom(np.zeros((2, 2, 3))).resampled(1), "points_per_strand is 1, expected 2 or more"),
        (lambda: Groom(np.zeros((2, 2, 3))).resampled(2.5), "points_per_strand is 2.5, expected a whole number"),
        (lambda: strandline.load("a.hair", scale="big"), "scale is 'big', expected \"auto\" or a number above 0"),
        (lambda: strandline.load("a.hair", scale=-1), "scale is -1.0"),
        (lambda: strandline.load("a.hair", turn=(1, 2)), r"turn has the shape \(2,\), expected \(3,\)"),
        (lambda: strandline.load("a.hair", frame=-1), "frame is -1, expected 0 or more"),
        (lambda: strandline.load("a.ply", points_per_strand=0), "points_per_strand is 0"),
        (lambda: strandline.Body(np.zeros((3, 2)), [[0, 1, 2]]), r"vertices has the shape \(3, 2\), expected \(n, 3\)"),
        (lambda: strandline.Body(np.zeros((3, 3)), [[0, 1, 3]]), "faces has the index 3, expected 0 to 2"),
        (lambda: strandline.Body(np.zeros((3, 3)), [[0, 1, 0.5]]), "faces has numbers that are not whole"),
        (lambda: strandline.Body(np.zeros((3, 3)), [[0, 1, 2]], motion=np.zeros((0, 3, 3))), r"motion has the shape \(0, 3, 3\)"),
        (lambda: strandline.Body(np.zeros((3, 3)), [[0, 1, 2]], frames_per_second=float("nan")), "frames_per_second is nan"),
        (lambda: strandline.Body.load("a.obj", scale=0), "scale is 0.0"),
        (lambda: strandline.Camera.framing(np.zeros((0, 3))), r"points has the shape \(0, 3\)"),
        (lambda: strandline.Camera().clip_from_view(0), "aspect is 0.0"),
        (lambda: strandline.Picture(np.zeros((2, 2))).png(), r"pixels has the shape \(2, 2\)"),
        (lambda: Motion.keyframes([3]), "a keyframe is 3, expected"),
        (lambda: Motion("nod").matrices([0], pivot=(0, 0)), r"pivot has the shape \(2,\)"),
        (lambda: Motion("nod").matrices("soon"), "times is a str"),
        (lambda: Scene().save("none/a.toml"), "cannot write the scene: No such file or directory: none/a.toml"),
        (lambda: strandline.sweeps.random({"a": (0, 1)}, -1), "count is -1"),
        (lambda: strandline.sweeps.sobol({"a": 3}, 2), "a has the range 3"),
        (lambda: strandline.sweeps.grid({"a": 3}), "a has the values 3"),
        (lambda: strandline.sweep("scene.toml", [{}], "out"), "scene is a str, expected a Scene"),
        (lambda: strandline.sweep(Scene(), [{}], "out", keep="guides"), "keep is `guides`, expected a list"),
        (lambda: strandline.sweep(Scene(), [{}], "out", workers=-1), "workers is -1"),
        (lambda: strandline.window.words_of(3, "."), "what is a int, expected a Simulation"),
    ],
)
def test_wrong_arguments_are_errors_that_name_them(make, words):
    with pytest.raises(Error, match=words) as caught:
        make()
    assert caught.value.kind in ("value", "file")


@pytest.mark.parametrize("suffix", ["hair", "npz", "bin", "ply", "data", "tfx", "obj", "npy"])
def test_every_format_of_the_engine_is_written_and_read(tmp_path, points, suffix):
    groom = Groom(points)
    groom.save(tmp_path / f"one.{suffix}")
    back = strandline.load(tmp_path / f"one.{suffix}", scale=1)
    assert len(back) == 64
    assert np.allclose(back.points, groom.points, atol=1e-6)


def test_attributes_survive_a_file(tmp_path, points):
    colors = np.linspace(0, 1, 512 * 3, dtype=np.float32).reshape(512, 3)
    groom = Groom(points, widths=np.full(512, 1e-4), colors=colors, root_uvs=np.full((64, 2), 0.25), groups=np.arange(64) % 3)
    groom.save(tmp_path / "one.npz")
    back = strandline.load(tmp_path / "one.npz", scale=1)
    for name in ("colors", "root_uvs", "groups"):
        assert np.array_equal(back[name], groom[name]), name


def test_styles_grow_by_keyword():
    groom = strandline.grow("bob", strand_count=40, seed=3)
    whole = strandline.grow("bob", strand_count=40, seed=3, strands=100)
    assert whole.strand_count == 100 and whole["guide_flags"].sum() == 40 and whole["guide_flags"][:40].all()
    assert np.array_equal(whole.points[: len(groom.points)], groom.points)
    assert len(groom) == 40
    again = strandline.grow("bob", strand_count=40, seed=3)
    assert np.array_equal(groom.points, again.points)
    assert not np.array_equal(groom.points, strandline.grow("bob", strand_count=40, seed=4).points)
    with pytest.raises(Error, match="style.strand_cuont.*`style.strand_count`"):
        strandline.grow("bob", strand_cuont=40)
    with pytest.raises(Error, match="mohawk"):
        strandline.grow("mohawk")


def test_scenes_take_sections_and_keys():
    scene = Scene({"simulation.gravity": (0, -1.6, 0)}, style={"style": "bob", "strand_count": 50}, film={"frames": 3})
    assert scene["simulation.gravity"] == [0, -1.6, 0] or np.allclose(scene["simulation.gravity"], [0, -1.6, 0])
    assert scene["style.strand_count"] == 50
    scene["film.frames"] = 7
    assert scene["film"]["frames"] == 7
    assert "gravity" in scene.explain("simulation.gravity")
    scene["body_look.color"] = "#5a3825"
    for key, words in {"simulation.gravty": "`simulation.gravity`", "film.frame": "`film.frames`", "sytle": "`style`"}.items():
        with pytest.raises(Error, match=words):
            scene[key] = 1
    with pytest.raises(Error, match="film.frames is .*0.*expected 1 to"):
        scene["film.frames"] = 0
    with pytest.raises(Error, match="film.frames is .*many"):
        scene["film.frames"] = "many"
    for wrong, words in {"frmes": "`frames`", "settngs": "`settings`", "sytle": "`style`", "zzzzzzzz": "expected a key of docs/scene.md"}.items():
        with pytest.raises(Error, match=words):
            strandline.Simulation(**{wrong: 1})
    assert scene["film.frames"] == 7, "a refused setting leaves the scene as it was"


def test_sections_are_classes_too():
    assert Settings(gravity=(0, 0, 0)).given == {"gravity": [0, 0, 0]}
    with pytest.raises(Error, match="look.folow_strands.*`look.follow_strands`"):
        Look(folow_strands=4)
    motion = Motion.keyframes([(0, (0, 0, 0)), (0.5, (0, 90, 0))])
    matrices = motion.matrices([0.0, 0.5])
    assert matrices.shape == (2, 4, 4) and np.allclose(matrices[0], np.eye(4), atol=1e-6)
    assert np.allclose(matrices[1][:3, :3] @ [0, 0, 1], [1, 0, 0], atol=1e-5)
    with pytest.raises(Error, match="keyframe"):
        Scene(motion=Motion.keyframes([(1, (0, 0, 0)), (0.5, (0, 90, 0))]))


def test_scene_files_are_read_and_named_in_errors(tmp_path):
    scene = Scene(style={"strand_count": 12}, motion={"name": "nod"})
    scene.save(tmp_path / "a.toml")
    assert Scene.load(tmp_path / "a.toml") == scene
    (tmp_path / "b.toml").write_text("[film]\nframes = 0\n")
    with pytest.raises(Error, match="film.frames.*b.toml") as caught:
        Scene.load(tmp_path / "b.toml")
    assert caught.value.kind == "value"
    with pytest.raises(Error, match="cannot read the scene.*none.toml") as caught:
        Scene.load(tmp_path / "none.toml")
    assert caught.value.kind == "file"


def test_plain_data_is_pickled(points, ball):
    groom = Groom(points, groups=np.arange(64) % 2)
    scene = Scene(film={"frames": 3})
    scene.folder = "there"
    for one in (groom, ball, scene, Settings(gravity=(0, 0, 0)), Motion("nod"), Error("a text", "busy")):
        back = pickle.loads(pickle.dumps(one))
        assert type(back) is type(one)
    back = pickle.loads(pickle.dumps(scene))
    assert back == scene and back.folder == "there"
    assert np.array_equal(pickle.loads(pickle.dumps(groom)).points, groom.points)
    error = pickle.loads(pickle.dumps(Error("a text", "busy")))
    assert (str(error), error.kind) == ("a text", "busy")


def test_errors_have_the_program_s_texts_and_kinds(tmp_path):
    path = tmp_path / "wavy.hair"
    path.write_bytes(b"PK" + bytes(200))
    with pytest.raises(Error, match="HAIR.*wavy.hair") as caught:
        strandline.load(path)
    assert caught.value.kind == "file"
    with pytest.raises(Error, match="none.hair"):
        strandline.load(tmp_path / "none.hair")
    with pytest.raises(Error, match="expected"):
        strandline.load(tmp_path / "none.docx")


@pytest.mark.parametrize("layout", ["usc", "ct2hair", "neural", "positions", "points"])
def test_research_layouts_come_back(tmp_path, points, layout):
    from strandline.research import LAYOUTS

    groom = Groom(points).resampled(100) if layout == "neural" else Groom(points)
    path = tmp_path / f"one{LAYOUTS[layout].suffix}"
    groom.save(path, layout=layout)
    back = strandline.load(path, layout=layout)
    assert back.array.shape == groom.array.shape
    assert np.allclose(back.points, groom.points, atol=1e-6)


def test_bare_points_say_what_they_lack(tmp_path, points):
    Groom(points).resampled(100).save(tmp_path / "a.ply", layout="neural")
    for given in ({}, {"points_per_strand": 7}):
        with pytest.raises(Error, match="points_per_strand="):
            strandline.load(tmp_path / "a.ply", **given)


def test_a_layout_that_nobody_has_is_refused(tmp_path, points):
    with pytest.raises(Error, match="`nueral` is no layout, expected `neural`"):
        strandline.load(tmp_path / "a.ply", layout="nueral")
    with pytest.raises(Error, match="expected .ply for neural"):
        Groom(points).save(tmp_path / "a.obj", layout="neural")
    with pytest.raises(Error, match="`a.npy` has another suffix, expected .data for usc"):
        strandline.load(tmp_path / "a.npy", layout="usc")
    (tmp_path / "a.npy").write_text("v 0 0 0")
    Groom(points).save(tmp_path / "b.npy")
    for name, words in {"a.npy": "no .npy or .npz of numbers: .*a.npy", "none.npy": "No such file or directory: [^:]*none.npy"}.items():
        with pytest.raises(Error, match=f"cannot read root coordinates: {words}$"):
            strandline.load(tmp_path / "b.npy", root_uvs=tmp_path / name)


def test_root_coordinates_come_from_a_second_file(tmp_path, points):
    Groom(points).save(tmp_path / "a.npz", layout="positions")
    np.savez(tmp_path / "uv.npz", uv_coords=np.full((64, 2), 0.5), other=np.zeros(3))
    groom = strandline.load(tmp_path / "a.npz", layout="positions", root_uvs=tmp_path / "uv.npz")
    assert np.array_equal(groom["root_uvs"], np.full((64, 2), 0.5, dtype=np.float32))


def test_gpus_are_listed():
    for gpu in strandline.gpus():
        assert gpu.name and gpu.index >= 0


def test_the_program_runs_through_the_extension(tmp_path):
    run = lambda *words: subprocess.run([sys.executable, "-m", "strandline", *words], capture_output=True, text=True)  # noqa: E731
    assert run("--version").returncode == 0
    wrong = run("sim", "--fames", "3")
    assert wrong.returncode == 2 and "--frames" in wrong.stderr
    missing = run("info", str(tmp_path / "none.hair"))
    assert missing.returncode == 1 and "none.hair" in missing.stderr and "Traceback" not in missing.stderr
