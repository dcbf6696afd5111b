"""Run by a Python that has Blender's module: imports files and keeps the curves of each frame."""

import json
import sys

import bpy
import numpy as np


def main():
    """Imports the files that standard input lists, and writes an .npz beside each."""
    for task in json.load(sys.stdin):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.context.scene.render.fps = task["fps"]
        if task["file"].endswith(".abc"):
            bpy.ops.wm.alembic_import(filepath=task["file"], as_background_job=False)
        else:
            bpy.ops.wm.usd_import(filepath=task["file"])
        np.savez(task["file"] + ".npz", **found(task["frames"]))


def found(frames):
    """Counts of points of the strands, and of each frame points [m], world space, radii and attributes."""
    arrays = {}
    for frame in range(frames):
        bpy.context.scene.frame_set(frame)
        (own,) = [of for of in bpy.data.objects if of.type == "CURVES"]
        curves = own.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        points = read(curves.attributes["position"].data, "vector", 3)
        matrix = np.array(own.matrix_world, dtype=np.float32)
        arrays[f"points.{frame}"] = points @ matrix[:3, :3].T + matrix[:3, 3]
        arrays[f"radii.{frame}"] = read(curves.attributes["radius"].data, "value", 0)
        arrays["counts"] = np.diff(read(curves.curve_offset_data, "value", 0, np.int32))
        for name, field, columns, kind in (("st", "vector", 2, np.float32), ("displayColor", "color", 4, np.float32), ("groom_group_id", "value", 0, np.int32)):
            if name in curves.attributes:
                arrays[name] = read(curves.attributes[name].data, field, columns, kind)
    return arrays


def read(of, field, columns, kind=np.float32):
    """The numbers of a field of all items."""
    numbers = np.empty(len(of) * max(columns, 1), dtype=kind)
    of.foreach_get(field, numbers)
    return numbers.reshape(-1, columns) if columns else numbers


main()
