"""Channels of pictures: what is known of each pixel, against the strands and the body themselves."""

import numpy as np
import pytest
from conftest import shake

from strandline import Camera, Error


@pytest.fixture(scope="module")
def drawn(groom, ball):
    """A picture of thick straight hair on a ball from the front, its camera, and the strands."""
    with shake(groom, body=ball, motion="still", look={"width_scale": 60.0, "follow_strands": 1, "hair_count": 0}) as simulation:
        camera = Camera(position=(0, 0.02, 1.0), target=(0, 0.02, 0), field_of_view=30)
        return simulation.picture(camera, width=160, height=120, layers=True), simulation.points.copy()


def test_a_picture_without_layers_says_how_to_get_them(groom):
    with shake(groom) as simulation:
        picture = simulation.picture(width=8, height=8)
    for name in ("depth", "direction", "normals", "strand_ids", "tangents", "light", "hair_mask"):
        with pytest.raises(Error, match="layers=True"):
            getattr(picture, name)


def test_depth_is_that_of_hair_and_body(drawn):
    picture, _ = drawn
    assert np.isinf(picture.depth[0, 0]) and picture.strand_ids[0, 0] == -1
    # The ball's lowest third has no hair: its nearest point there is seen.
    centre = np.array([0, -0.06, np.sqrt(0.098**2 - 0.06**2)])
    row, column = pixel(picture, centre)
    assert picture.hair_mask[row, column] == 0
    assert abs(picture.depth[row, column] - (1.0 - centre[2])) < 3e-3


def test_strands_are_where_their_pixels_say(drawn):
    picture, strands = drawn
    known, right, ways, depths = 0, 0, [], []
    ids, direction, depth = picture.strand_ids, picture.direction, picture.depth
    assert ids.max() < len(strands)
    for row, column in zip(*np.nonzero((picture.hair_mask > 0.5) & (ids >= 0)), strict=True):
        given = strands[ids[row, column]]
        strand = np.stack([np.interp(np.linspace(0, len(given) - 1, 80), np.arange(len(given)), given[:, axis]) for axis in range(3)], axis=1)
        places = np.array([project(picture, point) for point in strand])
        steps = np.linalg.norm(places[:, :2] - [column + 0.5, row + 0.5], axis=1)
        at = min(int(steps.argmin()), len(strand) - 2)
        way = places[at + 1, :2] - places[at, :2]
        known += 1
        right += steps.min() < 1
        depths.append(places[at, 2] - depth[row, column])
        if np.linalg.norm(way) > 0.2:
            ways.append(way / np.linalg.norm(way) @ direction[row, column])
    assert known > 200 and right > 0.99 * known
    assert abs(np.median(depths)) < 1e-3, "depth is the mean of the hair in a pixel, often of one strand"
    assert np.median(ways) > 0.98, "directions point to the tips, rows downward"


def test_normals_face_the_camera(drawn):
    picture, _ = drawn
    normals = picture.normals
    assert not normals[0, 0].any()
    hair = picture.hair_mask >= 0.5
    assert np.abs((normals * picture.tangents).sum(axis=-1)[hair]).max() < 1e-5, "across the strands"
    assert normals[..., 2][hair].min() > 0
    # On the ball they are those of the ball, but for its triangles.
    rows, columns = np.nonzero(np.isfinite(picture.depth) & (picture.hair_mask == 0))
    wanted = places_of(picture)[rows, columns]
    wanted /= np.linalg.norm(wanted, axis=1, keepdims=True)
    inner = wanted[:, 2] > 0.5
    assert inner.sum() > 200
    assert np.median((wanted * normals[rows, columns]).sum(axis=1)[inner]) > 0.97


def project(picture, point):
    """Column and row of a point, and its depth."""
    seen = picture.camera.view_from_world @ [*point, 1]
    clip = picture.camera.clip_from_view(picture.width / picture.height) @ seen
    x, y = clip[:2] / clip[3]
    return (x + 1) / 2 * picture.width, (1 - y) / 2 * picture.height, -seen[2]


def pixel(picture, point):
    column, row, _ = project(picture, point)
    return int(row), int(column)


def places_of(picture):
    """World places of what is drawn, shape (row, column, 3)."""
    places, _ = picture._rays()
    turn = picture.camera.view_from_world
    return (places - turn[:3, 3]) @ turn[:3, :3]
