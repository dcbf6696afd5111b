import sys
from pathlib import Path

import numpy as np
import pytest

import strandline


@pytest.fixture(scope="session")
def points():
    """Straight strands on a sphere of 0.1 m, shape (64, 8, 3)."""
    generator = np.random.default_rng(5)
    roots = generator.normal(size=(64, 3))
    roots[:, 1] = np.abs(roots[:, 1])
    roots /= np.linalg.norm(roots, axis=1, keepdims=True)
    lengths = np.linspace(0.1, 0.24, 8)
    return (roots[:, None] * lengths[None, :, None]).astype(np.float32)


@pytest.fixture(scope="session")
def groom(points):
    return strandline.Groom(points)


@pytest.fixture(scope="session")
def ball():
    """A sphere of 0.098 m: vertices and triangles."""
    rings, sides = 12, 24
    up, around = np.meshgrid(np.linspace(0, np.pi, rings), np.arange(sides) / sides * 2 * np.pi, indexing="ij")
    vertices = 0.098 * np.stack([np.sin(up) * np.cos(around), np.cos(up), np.sin(up) * np.sin(around)], axis=2)
    at = lambda ring, side: ring * sides + side % sides  # noqa: E731
    faces = []
    for ring in range(rings - 1):
        for side in range(sides):
            corners = [at(ring, side), at(ring, side + 1), at(ring + 1, side), at(ring + 1, side + 1)]
            faces += [[corners[0], corners[1], corners[2]], [corners[1], corners[3], corners[2]]]
    return strandline.Body(vertices.reshape(-1, 3), faces)


def shake(groom, **more):
    """A small simulation on the CPU."""
    settings = {"backend": "cpu", "motion": "shake", "film": {"frames": 6}, "body": None} | more
    return strandline.Simulation(groom=groom, **settings)


sys.path.insert(0, str(Path(__file__).parent))
