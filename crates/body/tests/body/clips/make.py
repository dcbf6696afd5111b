"""Writes rig.glb, a small glTF that uses most of what skins, morph targets and clips may have, and expected.txt: its
vertices at times of each clip, evaluated from the file in double precision with numpy alone.

    python3 crates/body/tests/body/clips/make.py

Vertices are in the order of nodes, primitives and vertices of the file. glTF 2.0, 3.7.3 and appendix C.
"""

import json
import struct
from pathlib import Path

import numpy

HERE = Path(__file__).parent
RANDOM = numpy.random.default_rng(7)
KINDS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
TIMES = [-1.0, 0.0, 0.3, 0.5, 0.77, 1.0, 1.6, 2.5, 9.0]


class Writer:
    def __init__(self):
        self.bytes, self.views, self.accessors = bytearray(), [], []

    def view(self, data, stride=None):
        self.bytes += bytes(-len(self.bytes) % 4)
        view = {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)}
        if stride:
            view["byteStride"] = stride
        self.views.append(view)
        self.bytes += data
        return len(self.views) - 1

    def add(self, values, kind, shape, normalized=False, padded=None, **more):
        values = numpy.asarray(values).astype(KINDS[kind])
        rows = values.reshape(-1, SIZES[shape])
        data = rows.tobytes()
        if padded:
            size = rows.shape[1] * rows.itemsize
            data = b"".join(row.tobytes() + b"\x7f" * (padded - size) for row in rows)
        accessor = {"bufferView": self.view(data, padded), "componentType": kind, "count": len(rows), "type": shape}
        if normalized:
            accessor["normalized"] = True
        if shape == "VEC3":
            accessor |= {"min": rows.min(0).tolist(), "max": rows.max(0).tolist()}
        self.accessors.append(accessor | more)
        return len(self.accessors) - 1

    def sparse(self, count, indices, values):
        self.accessors.append({
            "componentType": 5126, "count": count, "type": "VEC3",
            "sparse": {
                "count": len(indices),
                "indices": {"bufferView": self.view(numpy.array(indices, "<u2").tobytes()), "componentType": 5123},
                "values": {"bufferView": self.view(numpy.array(values, "<f4").tobytes())},
            },
        })
        return len(self.accessors) - 1


def quaternion(axis, degrees):
    axis = numpy.array(axis, float) / numpy.linalg.norm(axis)
    half = numpy.radians(degrees) / 2
    return [*(numpy.sin(half) * axis), numpy.cos(half)]


def build():
    out = Writer()
    count = 12
    places = RANDOM.uniform(-60, 60, (count, 3))
    weights = RANDOM.uniform(0, 1, (count, 8))
    weights[3] = 0  # a vertex that nothing carries
    weights[4, 1:] = 0
    weights /= numpy.maximum(weights.sum(1, keepdims=True), 1e-9)
    # Weights whose sum is not 1 are normalised.
    weights[5] *= 0.5
    first = {
        "attributes": {
            "POSITION": out.add(places, 5126, "VEC3", padded=20),
            "JOINTS_0": out.add(RANDOM.integers(0, 3, (count, 4)), 5121, "VEC4"),
            "WEIGHTS_0": out.add(numpy.round(255 * weights[:, :4]), 5121, "VEC4", True),
            "JOINTS_1": out.add(RANDOM.integers(0, 3, (count, 4)), 5123, "VEC4"),
            "WEIGHTS_1": out.add(weights[:, 4:], 5126, "VEC4"),
        },
        "targets": [
            {"POSITION": out.add(RANDOM.uniform(-9, 9, (count, 3)), 5126, "VEC3")},
            {"POSITION": out.sparse(count, [2, 5, 9], RANDOM.uniform(-9, 9, (3, 3)))},
        ],
    }
    few = 6
    second = {
        "attributes": {
            "POSITION": out.add(RANDOM.integers(-32768, 32768, (few, 3)), 5122, "VEC3", True, padded=8),
            "JOINTS_0": out.add(RANDOM.integers(0, 3, (few, 4)), 5121, "VEC4"),
            "WEIGHTS_0": out.add(RANDOM.integers(0, 65536, (few, 4)), 5123, "VEC4", True),
        },
        "targets": [
            {"POSITION": out.add(RANDOM.integers(-128, 128, (few, 3)), 5120, "VEC3", True, padded=4)},
            {"POSITION": out.add(RANDOM.uniform(-1, 1, (few, 3)), 5126, "VEC3")},
        ],
    }
    hat = {
        "attributes": {"POSITION": out.add(RANDOM.integers(0, 4000, (few, 3)), 5123, "VEC3", padded=8)},
        "targets": [{"POSITION": out.add(RANDOM.uniform(-900, 900, (few, 3)), 5126, "VEC3")}],
    }
    inverse = [numpy.eye(4) + RANDOM.uniform(-0.2, 0.2, (4, 4)) * [[1, 1, 1, 40]] * 3 + [[0, 0, 0, 0]] * 1 for _ in range(3)]
    for matrix in inverse:
        matrix[3] = [0, 0, 0, 1]
    inverse = out.add([matrix.T for matrix in inverse], 5126, "MAT4")
    shear = numpy.diag([0.01, 0.012, 0.01, 1.0])
    shear[0, 1], shear[:3, 3] = 0.002, [0.3, 0.9, -0.1]
    nodes = [
        {"name": "root", "matrix": [float(numpy.float32(x)) for x in shear.T.flatten()], "children": [1, 4]},
        {"name": "hips", "translation": [1, 2, 3], "rotation": quaternion([1, 1, 0], 20), "children": [2]},
        {"name": "neck", "translation": [0, 30, 0], "rotation": quaternion([0, 1, 0], -40), "scale": [1, 1.5, 1],
         "children": [3]},
        {"name": "head", "translation": [0, 20, 4], "scale": [-1.2, 1, 1], "children": [5]},
        {"name": "body", "mesh": 0, "skin": 0, "translation": [500, 0, 0], "weights": [0.25, -0.5]},
        {"name": "hat", "mesh": 1, "translation": [0, 10, 0], "scale": [0.01, 0.01, 0.01]},
        {"name": "elsewhere", "mesh": 1},
    ]
    return out, {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes,
        "extensionsUsed": ["KHR_mesh_quantization", "KHR_animation_pointer"],
        "extensionsRequired": ["KHR_mesh_quantization"],
        "skins": [{"joints": [1, 2, 3], "inverseBindMatrices": inverse}],
        "meshes": [{"primitives": [first, second]}, {"primitives": [hat], "weights": [0.75]}],
        "animations": clips(out),
    }


def clips(out):
    def times(values):
        return out.add(values, 5126, "SCALAR", min=[min(values)], max=[max(values)])

    def turns(count):
        all_turns = RANDOM.normal(size=(count, 4))
        return all_turns / numpy.linalg.norm(all_turns, axis=1, keepdims=True)

    every = times([0.25, 0.5, 1.25, 2.0])
    once = times([0.5])

    def clip(name, way, parts):
        def values(width, size):
            return size * RANDOM.normal(size=(4 * parts, width))

        cubic = turns(4)[:, None, :] * [[[0], [1], [0]]] + RANDOM.normal(size=(4, 3, 4)) * [[[1], [0], [1]]]
        rotations = turns(4) if parts == 1 else cubic.reshape(-1, 4)
        channels = [
            ({"node": 1, "path": "translation"}, out.add(values(3, 9), 5126, "VEC3")),
            ({"node": 2, "path": "rotation"}, out.add(rotations, 5126, "VEC4")),
            ({"node": 3, "path": "scale"}, out.add(1 + values(3, 0.3), 5126, "VEC3")),
            ({"node": 4, "path": "weights"}, out.add(values(2, 0.5), 5126, "SCALAR")),
            ({"node": 5, "path": "weights"}, out.add(values(1, 0.5), 5126, "SCALAR")),
        ]
        return {
            "name": name,
            "channels": [{"sampler": i, "target": target} for i, (target, _) in enumerate(channels)],
            "samplers": [{"input": every, "output": output} | ({"interpolation": way} if way else {})
                         for _, output in channels],
        }

    short = numpy.round(32767 * turns(4))
    packed = {
        "channels": [
            {"sampler": 0, "target": {"node": 3, "path": "rotation"}},
            {"sampler": 1, "target": {"node": 4, "path": "weights"}},
            {"sampler": 2, "target": {"path": "translation"}},
            {"sampler": 2, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/nodes/1"}}}},
            {"sampler": 2, "target": {"node": 1, "path": "translation"}},
        ],
        "samplers": [
            {"input": every, "output": out.add(short, 5122, "VEC4", True)},
            {"input": every, "output": out.add(RANDOM.integers(0, 256, 8), 5121, "SCALAR", True)},
            {"input": once, "output": out.add([[4, 5, 6]], 5126, "VEC3")},
        ],
    }
    return [clip("step", "STEP", 1), clip("linear", None, 1), clip("spline", "CUBICSPLINE", 3), packed]


class Reader:
    def __init__(self, data):
        length = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20:20 + length])
        self.bin = data[28 + length:]

    def raw(self, view, offset, count, size, dtype):
        view = self.json["bufferViews"][view]
        stride = view.get("byteStride", size * dtype.itemsize)
        start = view.get("byteOffset", 0) + offset
        return numpy.array([numpy.frombuffer(self.bin, dtype, size, start + i * stride) for i in range(count)])

    def accessor(self, index):
        accessor = self.json["accessors"][index]
        dtype, size = numpy.dtype(KINDS[accessor["componentType"]]), SIZES[accessor["type"]]
        count = accessor["count"]
        values = numpy.zeros((count, size), dtype)
        if "bufferView" in accessor:
            values = self.raw(accessor["bufferView"], accessor.get("byteOffset", 0), count, size, dtype)
        if "sparse" in accessor:
            sparse = accessor["sparse"]
            at = self.raw(sparse["indices"]["bufferView"], 0, sparse["count"], 1,
                          numpy.dtype(KINDS[sparse["indices"]["componentType"]]))
            values[at[:, 0]] = self.raw(sparse["values"]["bufferView"], 0, sparse["count"], size, dtype)
        values = values.astype(float)
        if accessor.get("normalized"):
            values = numpy.maximum(values / numpy.iinfo(dtype).max, -1.0)
        return values


def slerp(a, b, t):
    dot = a @ b
    angle = numpy.arccos(min(abs(dot), 1.0))
    if angle < 1e-9:
        return a
    return (numpy.sin(angle * (1 - t)) * a + numpy.sign(dot) * numpy.sin(angle * t) * b) / numpy.sin(angle)


def sample(file, sampler, path, time):
    keys = file.accessor(sampler["input"])[:, 0]
    way = sampler.get("interpolation", "LINEAR")
    values = file.accessor(sampler["output"]).reshape(len(keys), 3 if way == "CUBICSPLINE" else 1, -1)
    own = values[:, 1] if way == "CUBICSPLINE" else values[:, 0]
    if time <= keys[0] or time >= keys[-1]:
        value = own[0] if time <= keys[0] else own[-1]
    else:
        k = int(numpy.searchsorted(keys, time, side="right")) - 1
        step = keys[k + 1] - keys[k]
        t = (time - keys[k]) / step
        if way == "STEP":
            value = own[k]
        elif way == "LINEAR":
            value = slerp(own[k], own[k + 1], t) if path == "rotation" else own[k] * (1 - t) + own[k + 1] * t
        else:
            value = ((2 * t**3 - 3 * t**2 + 1) * own[k] + step * (t**3 - 2 * t**2 + t) * values[k, 2]
                     + (-2 * t**3 + 3 * t**2) * own[k + 1] + step * (t**3 - t**2) * values[k + 1, 0])
    return value / numpy.linalg.norm(value) if path == "rotation" else value


def local(node, moved):
    if "matrix" in node:
        return numpy.array(node["matrix"]).reshape(4, 4).T
    x, y, z, w = moved.get("rotation", node.get("rotation", [0, 0, 0, 1]))
    matrix = numpy.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, :3] = matrix[:3, :3] * moved.get("scale", node.get("scale", [1, 1, 1]))
    matrix[:3, 3] = moved.get("translation", node.get("translation", [0, 0, 0]))
    return matrix


def vertices(file, clip, time):
    nodes = file.json["nodes"]
    moved = [{} for _ in nodes]
    for channel in clip["channels"]:
        target = channel["target"]
        if "node" in target:
            sampler = clip["samplers"][channel["sampler"]]
            moved[target["node"]][target["path"]] = sample(file, sampler, target["path"], time)
    world = [None] * len(nodes)

    def walk(index, above):
        world[index] = above @ local(nodes[index], moved[index])
        for child in nodes[index].get("children", []):
            walk(child, world[index])

    for root in file.json["scenes"][0]["nodes"]:
        walk(root, numpy.eye(4))
    found = []
    for index, node in enumerate(nodes):
        if "mesh" not in node or world[index] is None:
            continue
        mesh = file.json["meshes"][node["mesh"]]
        for part in mesh["primitives"]:
            places = file.accessor(part["attributes"]["POSITION"])
            weights = moved[index].get("weights", node.get("weights", mesh.get("weights", [])))
            for weight, target in zip(weights, part["targets"]):
                places = places + weight * file.accessor(target["POSITION"])
            places = numpy.hstack([places, numpy.ones((len(places), 1))])
            if "skin" not in node:
                found.append((places @ world[index].T)[:, :3])
                continue
            skin = file.json["skins"][node["skin"]]
            inverse = file.accessor(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
            joints = [world[joint] @ own for joint, own in zip(skin["joints"], inverse)]
            total, sums = 0.0, 0.0
            for n in range(2):
                if f"JOINTS_{n}" in part["attributes"]:
                    at = file.accessor(part["attributes"][f"JOINTS_{n}"]).astype(int)
                    shares = file.accessor(part["attributes"][f"WEIGHTS_{n}"])
                    total = total + shares.sum(1)
                    sums = sums + numpy.einsum("vj,vjab->vab", shares, numpy.array(joints)[at])
            # Vertices without weights are carried by the first joint.
            blend = numpy.where((total > 0)[:, None, None], sums / numpy.maximum(total, 1e-30)[:, None, None], joints[0])
            found.append(numpy.einsum("vab,vb->va", blend, places)[:, :3])
    return numpy.vstack(found)


def main():
    out, document = build()
    document |= {"accessors": out.accessors, "bufferViews": out.views, "buffers": [{"byteLength": len(out.bytes)}]}
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    body = bytes(out.bytes) + bytes(-len(out.bytes) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(body), b"BIN\0") + body
    data = struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
    (HERE / "rig.glb").write_bytes(data)
    file = Reader(data)
    lines = []
    for index, clip in enumerate(file.json["animations"]):
        for time in TIMES:
            lines.append(f"clip {clip.get('name', f'clip {index}')}@{time}")
            lines += [" ".join(f"{x:.7f}" for x in place) for place in vertices(file, clip, time)]
    (HERE / "expected.txt").write_text("\n".join(lines) + "\n")


main()
