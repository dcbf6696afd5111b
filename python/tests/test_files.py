"""USD and Alembic: what is written is read by the others' own libraries."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest
from conftest import shake

import strandline
from strandline import Body, Error, Groom

pxr = pytest.importorskip("pxr")
pytest.importorskip("alembic3d")


@pytest.fixture
def rich(points):
    generator = np.random.default_rng(2)
    return Groom(
        points,
        widths=generator.uniform(5e-5, 1e-4, 512),
        colors=generator.random((512, 3)),
        root_uvs=generator.random((64, 2)),
        groups=np.arange(64) % 3,
        guide_flags=np.arange(64) % 4 == 0,
    )


@pytest.mark.parametrize("suffix", ["usdc", "abc"])
def test_grooms_come_back(tmp_path, rich, suffix):
    rich.save(tmp_path / f"a.{suffix}")
    back = strandline.load(tmp_path / f"a.{suffix}")
    assert np.allclose(back.points, rich.points, rtol=1e-6, atol=1e-9)
    assert np.allclose(back.widths, rich.widths, rtol=1e-6)
    for name in ("colors", "root_uvs", "groups", "guide_flags"):
        assert np.array_equal(back[name], rich[name]), name


@pytest.mark.parametrize("suffix", ["usdc", "usda", "abc", "npz"])
def test_names_of_groups_come_back(tmp_path, points, suffix):
    names = {0: "brow", 2: "b\u00e4rd"}
    groom = Groom(points, groups=np.arange(64) % 4, group_names=names)
    for for_ in ("any",) if suffix == "npz" else ("any", "unreal"):
        assert groom.save(tmp_path / f"a.{suffix}", for_=for_) == []
        back = strandline.load(tmp_path / f"a.{suffix}", up="z" if (suffix, for_) == ("abc", "unreal") else "y")
        assert back.group_names == names and np.array_equal(back["groups"], groom["groups"])
    groom.group_names = {9: "none"}
    if suffix != "npz":
        assert groom.save(tmp_path / f"b.{suffix}") == [f"b.{suffix} has no group_names of groups without strands"]
        groom.group_names = {1: "a\0b"}
        with pytest.raises(Error, match="zero character"):
            groom.save(tmp_path / f"b.{suffix}")


def test_names_of_groups_go_through_simulations_and_the_program(tmp_path, points):
    groom = Groom(points, groups=np.arange(64) % 4, group_names={0: "brow", 3: "beard"})
    with shake(groom) as simulation:
        simulation.record(tmp_path / "a.npz", frames=2)
    cache = strandline.Cache(tmp_path / "a.npz")
    assert cache.attributes()["group_names"] == groom.group_names
    assert strandline.load(tmp_path / "a.npz").group_names == groom.group_names
    for suffix in ("usdc", "abc"):
        cache.save(tmp_path / f"a.{suffix}")
        assert strandline.load(tmp_path / f"a.{suffix}", frame=1).group_names == groom.group_names
        run = [sys.executable, "-m", "strandline", "convert", str(tmp_path / f"a.{suffix}"), str(tmp_path / f"of_{suffix}.npz")]
        assert subprocess.run(run, capture_output=True).returncode == 0
        assert strandline.load(tmp_path / f"of_{suffix}.npz").group_names == groom.group_names


def test_curves_of_the_engine_s_own_stages_have_their_groups(tmp_path, points):
    from pxr import Usd

    with shake(Groom(points, groups=np.arange(64) % 2, group_names={0: "brow", 1: "beard"})) as simulation:
        simulation.record(tmp_path / "a.usda", frames=2)
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    stage.GetRootLayer().Export(str(tmp_path / "a.usdc"))
    assert strandline.load(tmp_path / "a.usdc").group_names == {0: "brow", 1: "beard"}


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="a file that never ends")
def test_an_archive_that_takes_too_long_is_given_up(tmp_path, rich, monkeypatch):
    from strandline import _archives

    rich.save(tmp_path / "whole.abc")
    assert _archives.time_limit(0) >= 30 and _archives.time_limit(10**9) >= 1000
    os.mkfifo(tmp_path / "a.abc")
    # First bytes, of which nothing more comes: an end for writing stays open, so that a reader meets no end of the file.
    endless = os.open(tmp_path / "a.abc", os.O_RDWR)
    with monkeypatch.context() as context:
        context.setattr(_archives, "time_limit", lambda size: 1.0)
        os.write(endless, b"Ogawa\xff")
        with pytest.raises(Error, match="cannot read the archive: its reader was stopped after 1 s.*a.abc"):
            strandline.load(tmp_path / "a.abc")
    assert len(strandline.load(tmp_path / "whole.abc")) == 64
    # The reader ends by itself where nobody is left to stop it.
    task = {"what": "groom", "file": str(tmp_path / "a.abc"), "out": "", "options": {"frame": None, "scale": 1.0}, "seconds": -9.0}
    words = [sys.executable, "-c", "import strandline._archives as own; own._serve()"]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as child:
        print(json.dumps(task), file=child.stdin, flush=True)
        try:
            assert child.wait(timeout=60) == 1
        finally:
            child.kill()
    # An answer that Ctrl-C left behind is not that of the next file. The program's own handler of signals is in this process.
    code = (
        "import os, signal, sys, threading, strandline\n"
        # A shell's job in the background ignores it.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "os.write(os.open('a.abc', os.O_RDWR), b'Ogawa\\xff')\n"
        "threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()\n"
        "try:\n"
        "    strandline.load('a.abc')\n"
        "except KeyboardInterrupt:\n"
        "    print('stopped', len(strandline.load('whole.abc')))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.stdout.strip() == "stopped 64", done.stderr[-2000:]
    os.close(endless)


@pytest.mark.parametrize("suffix", ["usdc", "abc"])
def test_velocities_of_a_groom_come_back(tmp_path, points, suffix):
    groom = Groom(points, velocities=np.random.default_rng(3).normal(size=(512, 3)))
    for for_, up in (("any", "y"), ("unreal", "y" if suffix == "usdc" else "z")):
        assert groom.save(tmp_path / f"a.{suffix}", for_=for_) == []
        assert np.allclose(strandline.load(tmp_path / f"a.{suffix}", up=up)["velocities"], groom["velocities"], atol=1e-5)


def test_receivers_are_known_before_anything_is_simulated(tmp_path, groom):
    with shake(groom) as simulation:
        for suffix in ("usdc", "abc", "npz"):
            with pytest.raises(Error, match="maya"):
                simulation.record(tmp_path / f"a.{suffix}", for_="maya")
        assert simulation.time == 0
        with pytest.raises(Error, match="frames is 0"):
            simulation.record(tmp_path / "a.npz", frames=0)
        with pytest.raises(Error, match="frames is -1"):
            simulation.record(tmp_path / "a.npz", frames=-1)
    assert not list(tmp_path.iterdir()), "and nothing is left behind"
    with pytest.raises(Error, match="for_ is `unreal` beside .hair"):
        groom.save(tmp_path / "a.hair", for_="unreal")
    for suffix in ("usdc", "abc"):
        with pytest.raises(Error, match="no such folder, or no permission: .*none"):
            groom.save(tmp_path / "none" / f"a.{suffix}")
        (tmp_path / f"a.{suffix}").mkdir()
        with pytest.raises(Error, match=f"cannot write the .*a.{suffix}"):
            groom.save(tmp_path / f"a.{suffix}")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.abc", "a.usdc"]


@pytest.mark.parametrize("for_", ["any", "unreal", "blender"])
def test_a_stage_is_as_its_receiver_wants_it(tmp_path, rich, for_):
    from pxr import Usd, UsdGeom

    from strandline import usd

    usd.save_groom(rich, tmp_path / "a.usdc", for_=for_)
    stage = Usd.Stage.Open(str(tmp_path / "a.usdc"))
    unit, up = {"any": (1.0, "Y"), "unreal": (0.01, "Z"), "blender": (1.0, "Z")}[for_]
    assert (UsdGeom.GetStageMetersPerUnit(stage), UsdGeom.GetStageUpAxis(stage)) == (unit, up)
    curves = UsdGeom.BasisCurves(stage.GetPrimAtPath("/Groom/Hair"))
    assert curves.GetTypeAttr().Get() == "linear" and curves.GetWidthsInterpolation() == "vertex"
    assert "GroomAPI" in str(stage.GetDefaultPrim().GetMetadata("apiSchemas"))
    names = {primvar.GetPrimvarName() for primvar in UsdGeom.PrimvarsAPI(curves).GetPrimvars()}
    wanted = {"groom_color", "groom_root_uv", "groom_group_id", "groom_guide", "groom_width", "groom_id"} if for_ == "unreal" else {"displayColor", "st"}
    assert wanted <= names
    points = np.asarray(curves.GetPointsAttr().Get())
    if up == "Z":
        assert np.allclose(points[:, 2] * unit, rich.points[:, 1], rtol=1e-6, atol=1e-8)
    assert np.allclose(strandline.load(tmp_path / "a.usdc").points, rich.points, rtol=1e-6, atol=1e-7)


@pytest.mark.parametrize("suffix", ["usdc", "abc"])
def test_moving_hair_comes_back_frame_by_frame(tmp_path, groom, suffix):
    with shake(groom) as simulation:
        simulation.record(tmp_path / "a.npz", frames=5)
    with shake(groom) as simulation:
        written = simulation.record(tmp_path / f"a.{suffix}", frames=5)
    assert written.frames == 5
    cache = strandline.Cache(tmp_path / "a.npz")
    for frame in range(5):
        back = strandline.load(tmp_path / f"a.{suffix}", frame=frame)
        assert np.allclose(back.points, cache[frame], rtol=1e-6, atol=1e-8), frame
    with pytest.raises(Error, match=rf"frame is 5, expected 0 to 4, its .*a\.{suffix}"):
        strandline.load(tmp_path / f"a.{suffix}", frame=5)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(["a.npz", f"a.{suffix}"])


def test_the_program_writes_what_extras_write(tmp_path):
    (tmp_path / "a.toml").write_text('[style]\nstyle = "pixie"\nstrand_count = 20\n[film]\nframes = 3\n[devices]\nsimulation = "cpu"\n')
    for suffix in ("usdc", "abc"):
        path = tmp_path / f"a.{suffix}"
        words = [sys.executable, "-m", "strandline", "sim", "--scene", str(tmp_path / "a.toml"), f"--out={path}", "--for", "blender"]
        done = subprocess.run(words, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        lines = [line for line in done.stdout.splitlines() if line.startswith("wrote")]
        assert len(lines) == 1 and lines[0].startswith("wrote 3 frames of 20 strands") and lines[0].endswith(f"0.0 MB to {path}"), lines
        assert "part" not in done.stdout and len(strandline.load(path)) == 20


def test_a_report_as_json_names_the_file(tmp_path):
    words = ["sim", "--style", "pixie", "--set", "style.strand_count=20", "--frames", "2", "--backend", "cpu", "--json", "--out", str(tmp_path / "a.usdc")]
    done = subprocess.run([sys.executable, "-m", "strandline", *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    out = json.loads(done.stdout)["out"]
    assert out["path"] == str(tmp_path / "a.usdc") and out["bytes"] == (tmp_path / "a.usdc").stat().st_size


def test_frames_are_kept_where_their_file_cannot_be_written(tmp_path, groom, monkeypatch):
    from strandline import usd

    def full(*words, **more):
        raise OSError("No space left on device")

    monkeypatch.setattr(usd, "save_cache", full)
    part = tmp_path / "a.usdc.part.npz"
    with shake(groom) as simulation, pytest.raises(Error, match="No space left on device; the frames so far are kept"):
        simulation.record(tmp_path / "a.usdc", frames=3)
    assert len(strandline.Cache(part)) == 3
    monkeypatch.undo()
    assert strandline.Cache(part).save(tmp_path / "a.usdc").frames == 3


def test_a_mesh_over_time_is_a_moving_body(tmp_path):
    from pxr import Gf, Usd, UsdGeom, Vt

    stage = Usd.Stage.CreateNew(str(tmp_path / "a.usdc"))
    UsdGeom.SetStageUpAxis(stage, "Z")
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    stage.SetTimeCodesPerSecond(24)
    UsdGeom.Xform.Define(stage, "/Up").AddTranslateOp().Set(Gf.Vec3d(0, 0, 100))
    mesh = UsdGeom.Mesh.Define(stage, "/Up/Body")
    mesh.CreateFaceVertexCountsAttr([4])
    mesh.CreateFaceVertexIndicesAttr([0, 1, 2, 3])
    square = np.array([[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]], dtype=np.float32)
    for code in range(3):
        mesh.CreatePointsAttr().Set(Vt.Vec3fArray.FromNumpy(square + np.float32([0, 0, code])), code)
    stage.GetRootLayer().Save()
    body = Body.load(tmp_path / "a.usdc")
    assert body.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert body.motion.shape == (3, 4, 3) and body.frames_per_second == 24
    assert np.allclose(body.motion[2][2], [0.1, 1.02, -0.1], atol=1e-6)


def test_joints_carry_a_body(tmp_path):
    from pxr import Gf, Usd, UsdGeom, UsdSkel, Vt

    stage = Usd.Stage.CreateNew(str(tmp_path / "a.usdc"))
    UsdGeom.SetStageUpAxis(stage, "Y")
    UsdGeom.SetStageMetersPerUnit(stage, 1)
    stage.SetTimeCodesPerSecond(24)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(2)
    UsdSkel.Root.Define(stage, "/Root")
    mesh = UsdGeom.Mesh.Define(stage, "/Root/Body")
    mesh.CreateFaceVertexCountsAttr([3])
    mesh.CreateFaceVertexIndicesAttr([0, 1, 2])
    mesh.CreatePointsAttr([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    skeleton = UsdSkel.Skeleton.Define(stage, "/Root/Skeleton")
    skeleton.CreateJointsAttr(["joint"])
    skeleton.CreateBindTransformsAttr([Gf.Matrix4d(1)])
    skeleton.CreateRestTransformsAttr([Gf.Matrix4d(1)])
    animation = UsdSkel.Animation.Define(stage, "/Root/Animation")
    animation.CreateJointsAttr(["joint"])
    for code in range(3):
        animation.CreateTranslationsAttr().Set([Gf.Vec3f(0, code, 0)], code)
    animation.CreateRotationsAttr([Gf.Quatf(1)])
    animation.CreateScalesAttr(Vt.Vec3hArray([Gf.Vec3h(1)]))
    binding = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    binding.CreateSkeletonRel().SetTargets(["/Root/Skeleton"])
    UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().SetTargets(["/Root/Animation"])
    binding.CreateJointIndicesPrimvar(False, 1).Set([0, 0, 0])
    binding.CreateJointWeightsPrimvar(False, 1).Set([1.0, 1.0, 1.0])
    stage.GetRootLayer().Save()
    body = Body.load(tmp_path / "a.usdc")
    assert body.motion.shape == (3, 3, 3)
    assert np.allclose(body.motion[2] - body.motion[0], [0, 2, 0], atol=1e-6)


@pytest.mark.parametrize("suffix", ["usdc", "abc"])
def test_changed_bytes_are_refused_or_read_and_never_crash(tmp_path, rich, suffix):
    rich.save(tmp_path / f"a.{suffix}")
    whole = (tmp_path / f"a.{suffix}").read_bytes()
    generator = np.random.default_rng(7)
    for at in range(200):
        mutant = bytearray(whole)
        for place in generator.integers(0, len(mutant), 1 + at % 8):
            mutant[place] = generator.integers(0, 256)
        if at % 5 == 0:
            mutant = mutant[: generator.integers(0, len(mutant))]
        (tmp_path / f"{at}.{suffix}").write_bytes(mutant)
    code = (
        "import sys, strandline\n"
        "for at in range(200):\n"
        "    try:\n"
        f"        strandline.load(sys.argv[1] + f'/{{at}}.{suffix}')\n"
        "    except strandline.Error as error:\n"
        f"        assert f'{{at}}.{suffix}' in str(error) and error.kind == 'file', (error, error.kind)\n"
        "print('all')\n"
    )
    done = subprocess.run([sys.executable, "-c", code, str(tmp_path)], capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.strip() == "all", done.stderr[-2000:]


def test_a_missing_extra_is_named(tmp_path, rich, monkeypatch):
    for module, suffix, extra in (("pxr", "usdc", "usd"), ("alembic3d", "abc", "abc")):
        monkeypatch.setitem(sys.modules, module, None)
        with pytest.raises(Error, match=rf"pip install 'strandline\[{extra}\]'") as caught:
            rich.save(tmp_path / f"a.{suffix}")
        assert caught.value.kind == "extra"


def test_units_and_axes_of_stages_and_archives(tmp_path, points):
    for suffix in ("usdc", "abc"):
        Groom(points).save(tmp_path / f"a.{suffix}", for_="unreal")
    assert np.allclose(strandline.load(tmp_path / "a.usdc").array, points, atol=1e-6), "a stage says its units and axes"
    assert np.allclose(strandline.load(tmp_path / "a.abc", up="z").array, points, atol=1e-6), "centimetres are found"
    assert np.allclose(strandline.load(tmp_path / "a.abc", up="z", scale=1).array, 100 * points, atol=1e-4)
    Groom(points).save(tmp_path / "b.abc", for_="blender")
    assert np.allclose(strandline.load(tmp_path / "b.abc").array, points, atol=1e-6), "Blender turns archives by itself"


@pytest.fixture
def bound(tmp_path):
    """A moving cache of guides with strands that follow them."""
    film = {"frames": 4}
    with strandline.Simulation(groom=strandline.grow("bob", strand_count=120), backend="cpu", film=film, **{"groom.guides": 20}) as simulation:
        simulation.record(tmp_path / "bound.npz")
    return strandline.Cache(tmp_path / "bound.npz")


def test_unreal_gets_guides_and_the_strands_that_follow_them(tmp_path, bound):
    import alembic3d.Abc as core
    import alembic3d.AbcGeom as geometry
    from pxr import Usd, UsdGeom

    guides, strands = len(bound.starts) - 1, len(bound.attributes()["bound_starts"]) - 1
    assert guides == 20 and strands == 100
    bound.save(tmp_path / "a.usdc", for_="unreal")
    stage = Usd.Stage.Open(str(tmp_path / "a.usdc"))
    moving, still = (UsdGeom.BasisCurves(stage.GetPrimAtPath(f"/Groom/{name}")) for name in ("Guides", "Hair"))
    assert len(moving.GetPointsAttr().GetTimeSamples()) == 4 and not still.GetPointsAttr().GetTimeSamples()
    read = lambda curves, name: np.asarray(UsdGeom.PrimvarsAPI(curves).GetPrimvar(name).Get())  # noqa: E731
    assert read(moving, "groom_guide").all() and not read(still, "groom_guide").any()
    assert np.array_equal(np.concatenate([read(moving, "groom_id"), read(still, "groom_id")]), np.arange(120))
    check_weights(read(still, "groom_closest_guides"), read(still, "groom_guide_weights"), bound)
    unit = np.asarray(still.GetPointsAttr().Get()) * 0.01
    roots = unit[bound.attributes()["bound_starts"][:-1]]
    near = bound[0][bound.starts[:-1]][read(still, "groom_closest_guides")[:, 0]]
    assert np.median(np.linalg.norm(roots[:, [0, 2, 1]] * [1, 1, -1] - near, axis=1)) < 0.05, "where the guides are"

    bound.save(tmp_path / "a.abc", for_="unreal")
    archive = core.IArchive(str(tmp_path / "a.abc"))
    top = archive.getTop()
    curves = {of.getName(): geometry.ICurves(of, core.WrapExistingFlag.kWrapExisting).getSchema() for of in (top.getChild(at) for at in range(2))}
    assert curves["guides"].getNumSamples() == 4 and curves["hair"].getNumSamples() == 1
    arbitrary = curves["hair"].getArbGeomParams()
    closest = np.array(geometry.IV3iGeomParam(arbitrary, "groom_closest_guides").getExpandedValue().getVals()).reshape(-1, 3)
    weights = np.array(geometry.IV3fGeomParam(arbitrary, "groom_guide_weights").getExpandedValue().getVals()).reshape(-1, 3)
    check_weights(closest, weights, bound)
    bound.save(tmp_path / "b.usdc")
    assert not Usd.Stage.Open(str(tmp_path / "b.usdc")).GetPrimAtPath("/Groom/Guides"), "for Unreal alone"


@pytest.mark.parametrize("suffix", ["usdc", "abc"])
def test_guides_and_their_weights_come_back(tmp_path, bound, suffix):
    bound.save(tmp_path / f"a.{suffix}", for_="unreal")
    up = {} if suffix == "usdc" else {"up": "z"}
    back = strandline.load(tmp_path / f"a.{suffix}", **up)
    flags = back["guide_flags"]
    assert flags.sum() == 20 and len(back) == 120
    check_weights(back["guide_indices"][~flags], back["guide_weights"][~flags], bound)
    assert not back["guide_weights"][flags].any(), "a guide follows none"
    with strandline.Simulation(groom=back, backend="cpu", motion="still", film={"frames": 1}) as simulation:
        assert simulation.strand_count == 20, "the guides of the file are those that move"


def test_guides_are_found_by_their_numbers(tmp_path, points):
    """Numbers of strands need not be in order, and a number that no strand has binds nothing."""
    from pxr import Usd, UsdGeom, Vt

    guides = np.arange(64)[:, None] % [8, 7, 6]
    Groom(points, guide_indices=guides, guide_weights=np.full((64, 3), [0.5, 0.3, 0.2])).save(tmp_path / "a.usda", for_="unreal")
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    curves = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/Groom/Hair"))
    ids = 1000 - np.arange(64, dtype=np.int32)
    curves.GetPrimvar("groom_id").Set(Vt.IntArray.FromNumpy(ids))
    closest = ids[guides].astype(np.int32)
    closest[0] = [5, 5, 1000]
    curves.GetPrimvar("groom_closest_guides").Set(Vt.Vec3iArray.FromNumpy(closest))
    stage.GetRootLayer().Export(str(tmp_path / "a.usdc"))
    back = strandline.load(tmp_path / "a.usdc")
    assert np.array_equal(back["guide_indices"][1:], guides[1:])
    assert np.allclose(back["guide_weights"][0], [0, 0, 1]) and back["guide_indices"][0, 2] == 0


def check_weights(closest, weights, bound):
    found = bound.attributes()
    assert closest.shape == weights.shape == (100, 3)
    assert np.allclose(weights.sum(axis=1), 1, atol=1e-6) and (np.diff(weights, axis=1) <= 0).all()
    heaviest = found["guide_weights"].argmax(axis=1)
    assert np.array_equal(closest[:, 0], np.take_along_axis(found["guide_indices"], heaviest[:, None], axis=1)[:, 0])


def test_guides_of_a_groom_are_weighted_for_unreal(tmp_path, points):
    from pxr import Usd, UsdGeom

    groom = Groom(points, guide_indices=np.arange(64)[:, None] % [8, 7], guide_weights=np.full((64, 2), [0.2, 0.6]))
    assert not groom.save(tmp_path / "a.usdc", for_="unreal"), "nothing is left out"
    assert groom.save(tmp_path / "a.abc") == ["a.abc has no guide_indices", "a.abc has no guide_weights"]
    stage = Usd.Stage.Open(str(tmp_path / "a.usdc"))
    curves = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/Groom/Hair"))
    assert np.allclose(np.asarray(curves.GetPrimvar("groom_guide_weights").Get())[5], [0.75, 0.25, 0])
    assert np.array_equal(np.asarray(curves.GetPrimvar("groom_closest_guides").Get())[9], [2, 1, 2])


def test_velocities_are_those_of_the_frames(tmp_path, bound):
    import alembic3d.Abc as core
    import alembic3d.AbcGeom as geometry
    from pxr import Usd, UsdGeom

    wanted = np.gradient(np.stack(list(bound)), axis=0) * 30
    bound.save(tmp_path / "a.usdc", velocities=True)
    stage = Usd.Stage.Open(str(tmp_path / "a.usdc"))
    curves = UsdGeom.BasisCurves(stage.GetPrimAtPath("/Groom/Hair"))
    bound.save(tmp_path / "a.abc", velocities=True)
    archive = core.IArchive(str(tmp_path / "a.abc"))
    schema = geometry.ICurves(archive.getTop().getChild(0), core.WrapExistingFlag.kWrapExisting).getSchema()
    for frame in range(4):
        assert np.allclose(np.asarray(curves.GetVelocitiesAttr().Get(frame)), wanted[frame], atol=1e-4)
        sample = schema.getValue(core.ISampleSelector(frame / 30))
        assert np.allclose(np.array(sample.getVelocities()).reshape(-1, 3), wanted[frame], atol=1e-4)
        for suffix in ("usdc", "abc"):
            assert np.allclose(strandline.load(tmp_path / f"a.{suffix}", frame=frame)["velocities"], wanted[frame], atol=1e-4)
    with strandline.Simulation(style={"strand_count": 8}, backend="cpu") as simulation, pytest.raises(Error, match="velocities"):
        simulation.record(tmp_path / "a.npz", velocities=True)
