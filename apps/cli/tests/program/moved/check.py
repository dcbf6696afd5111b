"""Reads what `strandline sim --out` wrote with numpy and usd-core alone: python check.py CACHE.npz [FILE.usda FOR]...

Ends with 0 and a line for each file; with 77 where a package is missing.
"""

import json
import sys

try:
    import numpy as np
    from pxr import Gf, Usd, UsdGeom
except ImportError as error:
    print(f"not checked: {error}")
    sys.exit(77)

# Metres to units, and axes.
TARGETS = {"any": (1.0, "Y"), "unreal": (100.0, "Z"), "blender": (1.0, "Z")}


def cache(path):
    with np.load(path) as file:
        arrays = {name: file[name] for name in file.files}
    meta = json.loads(arrays["meta"].tobytes())
    points, starts, times, head = (arrays[name] for name in ("points", "starts", "times", "world_from_head"))
    frames = len(times)
    assert points.dtype == np.float32 and points.shape == (frames, starts[-1], 3), points.shape
    assert starts.dtype == np.uint32 and starts[0] == 0 and (np.diff(starts.astype(int)) > 1).all()
    assert times.dtype == np.float64 and (np.diff(times) > 0).all()
    assert head.dtype == np.float32 and head.shape == (frames, 7)
    assert np.allclose(np.linalg.norm(head[:, :4], axis=1), 1, atol=1e-5)
    assert np.isfinite(points).all() and arrays["widths"].shape == (starts[-1],)
    assert (meta["layout"], meta["units"], meta["up_axis"]) == (2, "m", "y"), meta
    assert meta["what"] in ("guides", "strands") and "[film]" in meta["scene"]
    assert all(len(column) == frames for name, column in meta["report"].items() if name != "open")
    print(f"{path}: {frames} frames of {len(starts) - 1} strands")
    return arrays, meta


def usd(path, target, arrays, meta):
    scale, up = TARGETS[target]
    stage = Usd.Stage.Open(path)
    assert UsdGeom.GetStageUpAxis(stage) == up
    assert np.isclose(UsdGeom.GetStageMetersPerUnit(stage), 1 / scale)
    assert stage.GetTimeCodesPerSecond() == meta["frames_per_second"]
    prim = stage.GetDefaultPrim()
    assert prim.GetName() == "hair" and prim.IsA(UsdGeom.Xform)
    applied = prim.GetMetadata("apiSchemas")
    assert (target == "unreal") == (applied is not None and "GroomAPI" in applied.GetAddedOrExplicitItems())
    curves = UsdGeom.BasisCurves(prim.GetChild(meta["what"]))
    assert curves.GetTypeAttr().Get() == "linear" and curves.GetWrapAttr().Get() == "nonperiodic"
    counts = np.array(curves.GetCurveVertexCountsAttr().Get())
    assert (counts == np.diff(arrays["starts"])).all()
    assert curves.GetWidthsInterpolation() == "vertex"
    widths = np.array(curves.GetWidthsAttr().Get())
    assert (widths == arrays["widths"] * np.float32(scale)).all()
    codes = curves.GetPointsAttr().GetTimeSamples()
    assert np.allclose(np.array(codes) / stage.GetTimeCodesPerSecond(), arrays["times"], rtol=0, atol=1e-9), codes
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (codes[0], codes[-1])
    head = UsdGeom.Xformable(prim.GetChild("head"))
    turn = (lambda p: np.stack([p[..., 0], -p[..., 2], p[..., 1]], -1)) if up == "Z" else (lambda p: p)
    for frame, code in enumerate(codes):
        found = np.array(curves.GetPointsAttr().Get(code))
        wanted = turn(arrays["points"][frame]) * np.float32(scale)
        assert (found == wanted).all(), (frame, np.abs(found - wanted).max())
        low, high = (np.array(corner) for corner in curves.GetExtentAttr().Get(code))
        half = np.array(UsdGeom.PointBased.ComputeExtent(curves.GetPointsAttr().Get(code)))
        assert (low <= half[0]).all() and (high >= half[1]).all()
        # A point of the head's space where the head is: p' = q p + t.
        x, y, z, w, *shift = (float(number) for number in arrays["world_from_head"][frame])
        point = Gf.Vec3d(0.1, 0.2, 0.3)
        world = Gf.Rotation(Gf.Quaternion(w, Gf.Vec3d(x, y, z))).TransformDir(point) + Gf.Vec3d(shift)
        own = Gf.Vec3d(*(turn(np.array(point)) * scale))
        there = head.ComputeLocalToWorldTransform(code).Transform(own)
        assert np.allclose(there, turn(np.array(world)) * scale, atol=1e-5 * scale), (there, world)
    if target == "unreal":
        guide = UsdGeom.PrimvarsAPI(curves).GetPrimvar("groom_guide")
        if "guide_flags" in arrays:
            # Strands of their own, a few of which are the guides.
            assert guide.GetInterpolation() == "uniform" and 0 < arrays["guide_flags"].sum() < len(counts)
            assert list(guide.Get()) == arrays["guide_flags"].astype(int).tolist()
        else:
            assert guide.GetInterpolation() == "constant" and list(guide.Get()) == [int(meta["what"] == "guides")]
        assert len(UsdGeom.PrimvarsAPI(curves).GetPrimvar("groom_id").Get()) == len(counts)
    print(f"{path}: {len(codes)} frames for {target}")


def main():
    arrays, meta = cache(sys.argv[1])
    for path, target in zip(sys.argv[2::2], sys.argv[3::2]):
        usd(path, target, arrays, meta)


main()
