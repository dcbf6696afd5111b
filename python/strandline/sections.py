"""Types of the sections of a scene, one setting a line. Written by python/write_sections.py from the settings table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypedDict


class Devices(TypedDict, total=False):
    """Devices of the simulation and of pictures. When both are on one GPU, points stay there."""

    simulation: str
    """Device of the simulation. Allowed: auto, cpu, gpu, or gpu:0 and so on for one of several."""

    pictures: str
    """Device of the pictures. Allowed: auto, cpu, gpu, or gpu:0 and so on for one of several."""


class GroomParts(TypedDict, total=False):
    """Strands of a further file: brows, a beard."""

    file: str
    """A file as `groom.file`. Allowed: the path of a file."""

    name: str
    """Name of the group that its strands are, where the file has no named groups of its own; without one that of the
    file. Allowed: a name."""

    scale: float | str
    """Metres per unit of the file; "auto" takes that of `groom.file`, or what brings the roots to the body. Allowed:
    "auto" or 1e-6 to 1,000,000 m."""

    up: str
    """The file's axis that points up; "auto" as for its units. Allowed: one of auto, y, z, x, -y, -z, -x."""

    per_strand: int
    """Points of each strand, for files that do not say which points make a strand. Allowed: 1 to 4096."""

    rotation: Sequence[float]
    """Turns these strands: pitch (about x), yaw (about y), roll (about z). Allowed: 3 numbers of -360 to 360
    degrees."""

    translation: Sequence[float]
    """Moves these strands, head space. Allowed: 3 numbers of -10,000 to 10,000 m."""


class Groom(TypedDict, total=False):
    """Strands from a file, and how guides are made of strands."""

    file: str
    """A file of any of the formats that `strandline convert --help` lists; without one the `[style]` is grown.
    Allowed: the path of a file."""

    scale: float | str
    """Metres per unit of the file; "auto" takes that of the body where the roots then lie on its skin, or else the
    unit that brings them there: 1, 0.01, 0.001, 0.0254, 0.00254, or any for a full head of hair; without a body the
    first that makes the groom as large as a head of hair can be. Allowed: "auto" or 1e-6 to 1,000,000 m."""

    up: str
    """The file's axis that points up; "auto" takes the axes of the body's file, unless others alone bring the roots
    to the skin, or a full head of hair then hangs and leaves the face free. A given axis gives the front too, and
    nothing is turned. Allowed: one of auto, y, z, x, -y, -z, -x."""

    per_strand: int
    """Points of each strand, for files that hold points and do not say which of them make a strand. Allowed: 1 to
    4096."""

    frame: int
    """The frame of moving hair that is read of a file, from 0, in USD a time code; without it the first. Strands are
    taken where they lie in the world. Allowed: 0 to 10,000,000."""

    root_end: str
    """The end of each strand at which its root is; "auto" turns strands whose last point lies on the body and whose
    first does not, and without a body those that taper the other way or end among the roots of all others. Allowed:
    one of auto, first, last."""

    find_ties: bool
    """Ties strands where they come together in a knot, as those of a ponytail do, unless the scene has `[[ties]]`.
    Allowed: true or false."""

    bands: bool
    """Draws a band just behind each place where hair is tied, as a part of the body; without it where a style is,
    grown or read as it was written. Allowed: true or false."""

    band_color: Sequence[float]
    """Colour of bands, linear RGB. Allowed: 3 numbers of 0 to 1."""

    own_look: bool
    """Draws colours and widths of the file in place of the look's. Allowed: true or false."""

    rotation: Sequence[float]
    """Turns the strands of a file: pitch (about x), yaw (about y), roll (about z). Where a scene turns neither and
    the body shows no face, a full head of hair shows the front of both. Allowed: 3 numbers of -360 to 360 degrees."""

    translation: Sequence[float]
    """Moves the strands of a file, head space. Allowed: 3 numbers of -10,000 to 10,000 m."""

    parts: Sequence[GroomParts]
    """Further files with strands of the same hair, at most 64. Allowed: 0 to 64."""

    guides: int
    """Strands that are simulated: so many, spread over the scalp and alike in shape to the others, which are bound to
    them. Without it they are those that a file marks as guides; without such marks all, or 2,000 of a file of more
    than 3,000. All strands are drawn. Allowed: 1 to 8,000,000."""

    guide_every: int
    """Simulate every n-th strand; the others are bound to them. `guides` comes before it. Allowed: 1 to 1,000,000."""

    bound: int
    """Strands that a style grows in all, of which `style.strand_count` are simulated and the others bound to them;
    not more than those, all are simulated. Without it eight for each that is simulated. `look.follow_strands` counts
    for each of them: a file that names it and was written before this key draws eight times as many strands, unless
    it has `bound = 0`. Allowed: 0 to 8,000,000."""

    points_per_strand: int
    """Points on each guide. Without a groom file the default is that of the style. Allowed: 4 to 64."""

    length: float
    """Length of every strand over its own. Allowed: 0.05 to 2."""

    attributes: str
    """A file with masses and first velocities of the simulated points: tensors of the safetensors format, 32-bit
    floats, `masses` [kg], shape [strand, point], and `velocities` [m/s], head space, shape [strand, point, 3]; either
    may be missing. Without masses `mass_per_length` counts. Velocities are those of the first step: with `settle`
    above 0 they have died down before the first picture. Allowed: the path of a file."""

    pose: str
    """A file with first positions and motion of the simulated points and of the body, as the window and
    `Hair::save_pose` save it: a snapshot in a .npz (docs/cache.md), by itself or in a moving cache of guides. Files
    of earlier builds, with tensors of the safetensors format, are read too. The film then begins with hair and body
    as they are there. Without it hair begins at rest. Allowed: the path of a file."""


class Ties(TypedDict, total=False):
    """A band about hair: the head holds every strand that passes through it, by two points."""

    position: Sequence[float]
    """Middle of the band, head space. Allowed: 3 numbers of -10,000 to 10,000 m."""

    radius: float
    """Distance within which strands are held. Allowed: 0.001 to 1 m."""


class Strokes(TypedDict, total=False):
    """A stroke of a brush over hair at rest."""

    tool: str
    """The tool. Allowed: one of comb, cut, lengthen, clump, curl."""

    position: Sequence[float]
    """Middle of the brush, near the skin, head space. Allowed: 3 numbers of -10,000 to 10,000 m."""

    radius: float
    """Distance from the middle within which strands have their roots. Allowed: 1e-4 to 100 m."""

    strength: float
    """Share of the whole effect; toward the rim of the brush it falls to 0, but for `cut`. Allowed: 0 to 1."""

    motion: Sequence[float]
    """Way of the tips under `comb`, head space. Allowed: 3 numbers of -10 to 10 m."""

    length: float
    """Length that `cut` leaves, or that `lengthen` adds. Allowed: 0.001 to 10 m."""

    curl: float
    """Radius of the turns of `curl`. Allowed: 0 to 0.5 m."""

    pitch: float
    """Length of hair in a turn of `curl`; a turn has six points of a strand at least. Allowed: 0.001 to 10 m."""

    symmetric: bool
    """Repeats the stroke on the other side of the head (x to -x). Allowed: true or false."""


class Style(TypedDict, total=False):
    """Settings of a grown style. The default of every number but the first two is that of the style."""

    style: str
    """The style. Allowed: one of bob, long, wavy, curly, pixie, ponytail, buzz, side_swept, afro, coils, bun, braid,
    beard, brows, lashes."""

    strand_count: int
    """Number of strands: guides for the renderer's follow strands. Allowed: 1 to 8,000,000."""

    seed: int
    """Seed of every random choice. Allowed: a finite number."""

    length: float
    """Greatest length of a strand before curls. Allowed: 0.01 to 2 m."""

    length_variation: float
    """Share by which lengths differ from strand to strand. Allowed: 0 to 0.9."""

    cut_height: float
    """Height, head space, at which falling hair is cut level. Allowed: -10 to 1 m."""

    layering: float
    """Height over which the cut is spread, hair from the crown ending highest; 0 cuts level. Allowed: 0 to 0.5 m."""

    turn_under: float
    """Turn of the ends under, toward the neck. Allowed: 0 to 2."""

    parting: float
    """Place of the parting, positive on the head's left. Allowed: -0.07 to 0.07 m."""

    fringe: float
    """Way below the hairline at which hair from above the forehead is cut that falls over it; 0 leaves the forehead
    free, and 0.05 reaches the brows. For hair that falls from a parting or is tied. Allowed: 0 to 0.3 m."""

    behind_ears: bool
    """Leads hair from the front and the sides behind the ears. For hair that falls from a parting. Allowed: true or
    false."""

    beard: bool
    """Grows a beard beside the hair: the group `beard`, as the style of that name. Allowed: true or false."""

    brows: bool
    """Grows eyebrows beside the hair: the group `brows`. Allowed: true or false."""

    lashes: bool
    """Grows eyelashes beside the hair: the group `lashes`. Allowed: true or false."""

    swirl: float
    """Turn of the hair around the whorl. Allowed: -3 to 3 rad."""

    volume: float
    """Thickness of the hair that lies on the skull. Allowed: 0.001 to 0.1 m."""

    clump_width: float
    """Width of a clump at the roots. Allowed: 0.002 to 0.2 m."""

    clump_share: float
    """Share of the way to the middle of its clump that a strand is drawn at the tip. Allowed: 0 to 1."""

    wave_amplitude: float
    """Amplitude of waves. Allowed: 0 to 0.1 m."""

    wave_length: float
    """Length of a wave. Allowed: 0.005 to 2 m."""

    curl_radius: float
    """Radius of curls. Allowed: 0 to 0.1 m."""

    curl_length: float
    """Length of hair for one turn of a curl. Allowed: 0.005 to 2 m."""

    noise: float
    """Amplitude of each strand's own disorder at the tip. Allowed: 0 to 0.1 m."""

    lock_share: float
    """Share of the way to the middle of its small lock, eight neighbours, that a strand between the guides is drawn
    at the tip. Allowed: 0 to 1."""

    frizz: float
    """Mean amplitude of the waves that each strand between the guides has of its own. Allowed: 0 to 0.05 m."""

    strays: float
    """Share of the strands between the guides that leave their lock. Allowed: 0 to 1."""

    thinning: float
    """Share of the length by which the ends of locks and of strands between the guides differ. Allowed: 0 to 0.9."""

    hairline: float
    """Breadth of the hairline, along which hair grows denser, longer and thicker. Allowed: 0 to 0.05 m."""


class BodyTeleports(TypedDict, total=False):
    """A mark of a motion: there the body is elsewhere at once, and hair is carried with it instead of being
    pulled."""

    time: float
    """Time of the motion. Between its samples on both sides of a mark nothing is interpolated. Allowed: -1,000,000 to
    1,000,000 s."""


class BodyPartsTeleports(TypedDict, total=False):
    """A mark of a motion: there the body is elsewhere at once, and hair is carried with it instead of being
    pulled."""

    time: float
    """Time of the motion. Between its samples on both sides of a mark nothing is interpolated. Allowed: -1,000,000 to
    1,000,000 s."""


class BodyParts(TypedDict, total=False):
    """A further mesh of the body: eyes, teeth, a collar, a hat."""

    file: str
    """An .obj, .gltf, .glb, .vrm, .ply or .stl file. Allowed: the path of a file."""

    scale: float | str
    """Metres per unit of the file; "auto" takes that of `body.file`. Allowed: "auto" or 1e-6 to 1,000,000 m."""

    up: str
    """The file's axis that points up; "auto" takes that of `body.file`. Allowed: one of auto, y, z, x, -y, -z, -x."""

    rotation: Sequence[float]
    """Turns the mesh: pitch (about x), yaw (about y), roll (about z). Allowed: 3 numbers of -360 to 360 degrees."""

    translation: Sequence[float]
    """Moves the mesh, head space. Allowed: 3 numbers of -10,000 to 10,000 m."""

    visible: bool
    """Draws it. Allowed: true or false."""

    solid: bool
    """Makes it solid; without this a closed mesh is solid, and one with an open rim, such as lashes, is not. Allowed:
    true or false."""

    covers: bool
    """Presses hair that starts under it beneath it; without this a part does that covers as many roots as a hat.
    Allowed: true or false."""

    clip: str
    """Clip of the part's glTF file that moves it, by its name, in the space that it shares with the body's file:
    clothes with a skin of their own. Without one the part rides the head. Allowed: a name."""

    start: float
    """Time of the part's clip at the time 0 of the scene; the clip is held before its beginning and after its end.
    Allowed: -1,000,000 to 1,000,000 s."""

    speed: float
    """Seconds of the part's clip in a second of the scene. Allowed: -1000 to 1000."""

    loop: bool
    """Begins the part's clip again after its end. Allowed: true or false."""

    teleports: Sequence[BodyPartsTeleports]
    """Marks at which the part is elsewhere at once, beside `extras.teleports` of its clip, times of the clip: hair is
    carried with the head over them. Allowed: 0 to 100,000."""


class Body(TypedDict, total=False):
    """The body that hair grows on and hits."""

    model: str
    """The body when no file is named. Allowed: one of auto, mannequin, none."""

    build: str
    """Build of the mannequin: its neck, shoulders, cheeks and jaw. Allowed: one of slender, medium, broad."""

    eyes: str
    """Eyes of the mannequin. Allowed: one of open, closed."""

    file: str
    """An .obj, .gltf, .glb, .vrm, .ply or .stl file; or a body in motion: an .npz with `vertices` over time and
    `faces`, a folder of .obj files with the same faces, or such files by a pattern, `walk%04d.obj`. Allowed: the path
    of a file."""

    scalp: str
    """Part of the body on which a style grows, by its name in the body's files: an object, a group or a material of
    an .obj, a node, a mesh or a material of a glTF. Without it the built-in scalp is brought onto the skull. Allowed:
    a name."""

    clip: str
    """Clip of the body's glTF file that moves it, by its name: skins, morph targets and nodes. The head is where the
    roots of the hair are; without a clip the body rests in its default pose. Allowed: a name."""

    vertices: str
    """The body's vertices over time, in the units, axes and order of `file`: a .npy or .npz file of an array `[frame,
    vertex, 3]`, named vertices, verts, positions or v, with `times` or `fps` beside it. Allowed: the path of a
    file."""

    frames_per_second: float
    """Rate of files, and of arrays without times. Allowed: 0.001 to 10,000 1/s."""

    start: float
    """Time of the motion at the time 0 of the scene; the motion is held before its beginning and after its end.
    Allowed: -1,000,000 to 1,000,000 s."""

    speed: float
    """Seconds of the motion in a second of the scene. Allowed: -1000 to 1000."""

    loop: bool
    """Begins the motion again after its end. Allowed: true or false."""

    teleports: Sequence[BodyTeleports]
    """Marks at which the body is elsewhere at once, beside those of its file: `extras.teleports` of a glTF's clip and
    the array `teleports` of an .npz, times of the motion. A `loop` jumps at its beginning where 0 is marked. Allowed:
    0 to 100,000."""

    collider_file: str
    """A closed mesh that hair hits in place of the drawn one. Allowed: the path of a file."""

    scale: float | str
    """Metres per unit of the body's files; "auto" takes 1 for a glTF, which is in metres, and else that of 1, 0.01,
    0.001, 0.0254 and 0.00254 that makes the head most like that of a person, or a body without such a head as large
    as a doll to a bear. Allowed: "auto" or 1e-6 to 1,000,000 m."""

    up: str
    """The files' axis that points up; "auto" takes y for a glTF, whose face looks along +z, and else the axis that
    the body shows: the head of a person, the four feet of an animal, or the flat base of a statue. A given axis gives
    the front too. Allowed: one of auto, y, z, x, -y, -z, -x."""

    rotation: Sequence[float]
    """Turns the body of a file: pitch (about x), yaw (about y), roll (about z). Allowed: 3 numbers of -360 to 360
    degrees."""

    translation: Sequence[float]
    """Moves the body of a file, head space. Allowed: 3 numbers of -10,000 to 10,000 m."""

    parts: Sequence[BodyParts]
    """Further meshes of the same body, at most 64. They need a `file`. Allowed: 0 to 64."""

    visible: bool
    """Draws the body. Allowed: true or false."""

    solid: bool
    """Makes the body solid. Allowed: true or false."""

    spacing: float
    """Distance between the samples of the body's signed distance. Allowed: 5e-4 to 0.1 m."""

    exact: bool
    """Uses the exact mannequin as the solid in place of samples of it; slower. Allowed: true or false."""

    friction: float
    """Coulomb friction coefficient of hair on the solid. It acts once a step, by how deep gravity and motion alone
    would take a point: neither the number of rounds nor the pull of the strand changes it. Allowed: 0 to 10."""


class MotionTeleports(TypedDict, total=False):
    """A mark of a motion: there the body is elsewhere at once, and hair is carried with it instead of being
    pulled."""

    time: float
    """Time of the motion. Between its samples on both sides of a mark nothing is interpolated. Allowed: -1,000,000 to
    1,000,000 s."""


class MotionKeyframes(TypedDict, total=False):
    """A pose at a time, as a person writes it."""

    time: float
    """Time; each later than the one before. Allowed: -1,000,000 to 1,000,000 s."""

    rotation: Sequence[float]
    """Angles about the pivot: pitch (about x), yaw (about y), roll (about z), applied in the order roll, pitch, yaw;
    each angle is a curve of its own, so 720 degrees are two turns. Allowed: 3 numbers of -36,000 to 36,000
    degrees."""

    translation: Sequence[float]
    """Displacement of the pivot. Allowed: 3 numbers of -10,000 to 10,000 m."""

    interpolation: str
    """The way to the next pose; without it that of `motion.interpolation`. Allowed: one of smooth, linear, hold."""

    cut: bool
    """A jump: the pose before is held until this one. Hair is carried over jumps of the head; where a pose is held
    ("hold") and the next one is more than 15 degrees or 0.1 m away, that is a jump too. Allowed: true or false."""


class Motion(TypedDict, total=False):
    """Motion of the head."""

    name: str
    """The motion; without a name that of a body that moves by itself is "still". Allowed: one of still, shake, nod,
    turn, keyframes, file."""

    pivot: Sequence[float]
    """Point about which the head turns, head space; without one it is the mannequin's neck, or a point low in the
    body's or the groom's box. Allowed: 3 numbers of -10,000 to 10,000 m."""

    rotation: Sequence[float]
    """Rotation of the head added to its motion, about the pivot: pitch (about x), yaw (about y), roll (about z).
    Allowed: 3 numbers of -360 to 360 degrees."""

    neck: bool
    """Bends the neck of the built-in bust, so that its shoulders stay; without this the bust moves as one, which
    costs less. Beyond 75 degrees the shoulders follow. It is a setting of the load: a window keeps the neck that it
    began with, and says so. The exact mannequin never bends. Allowed: true or false."""

    interpolation: str
    """The way from pose to pose, where a pose does not name its own. Allowed: one of smooth, linear, hold."""

    file: str
    """A .bvh, .gltf, .glb or .vrm file with a skeleton; used by "file". Allowed: the path of a file."""

    joint: str
    """The joint of that file that moves as the head does, a node of a glTF. Allowed: a name."""

    clip: str
    """Clip of that file, where it is a glTF; without a name its first. Allowed: a name."""

    scale: float
    """Metres per unit of that file. Allowed: 1e-6 to 1,000,000 m."""

    start: float
    """Time of that file's motion at the time 0 of the scene; the motion is held before its beginning and after its
    end. Allowed: -1,000,000 to 1,000,000 s."""

    speed: float
    """Seconds of that file's motion in a second of the scene. Allowed: -1000 to 1000."""

    loop: bool
    """Begins that file's motion again after its end. Allowed: true or false."""

    teleports: Sequence[MotionTeleports]
    """Marks at which the joint is elsewhere at once, beside `extras.teleports` of a glTF's clip, times of the file's
    motion. A `loop` jumps at its beginning where 0 is marked. Allowed: 0 to 100,000."""

    keyframes: Sequence[MotionKeyframes]
    """Poses, in the order of their times; used by "keyframes"."""


class WindSources(TypedDict, total=False):
    """A place from which air blows: a fan with a direction, else a source to all sides. Rods under
    `simulation.drag.factor` feel it."""

    position: Sequence[float]
    """Place, world space. Allowed: 3 numbers of -10,000 to 10,000 m."""

    direction: Sequence[float]
    """Direction in which a fan blows, of any length: a jet that widens by a tenth of its way. Without it air blows to
    all sides. Allowed: 3 numbers of -10,000 to 10,000."""

    speed: float
    """Speed of the air where a fan begins, else at `radius`. Allowed: 0 to 100 m/s."""

    radius: float
    """Radius of the source. Allowed: 0.001 to 100 m."""


class WindKeyframes(TypedDict, total=False):
    """Mean velocity of the air at a time."""

    time: float
    """Time; each later than the one before. Allowed: -1,000,000 to 1,000,000 s."""

    velocity: Sequence[float]
    """Mean velocity, world space. Allowed: 3 numbers of -100 to 100 m/s."""

    interpolation: str
    """The way to the next keyframe; "smooth" without it. Allowed: one of smooth, linear, hold."""

    cut: bool
    """A jump: the velocity before is held until this one. Allowed: true or false."""


class Wind(TypedDict, total=False):
    """Motion of the air."""

    velocity: Sequence[float]
    """Mean velocity, world space. Allowed: 3 numbers of -100 to 100 m/s."""

    rise: float
    """Time in which the wind rises from calm at the beginning. Allowed: 0 to 1000 s."""

    gust: float
    """Share of the velocity that comes and goes. Allowed: 0 to 1."""

    gust_period: float
    """Time from gust to gust. Allowed: 0.05 to 1000 s."""

    turbulence: float
    """Speed of turbulence over that of the wind: eddies of many sizes that ride along with it. Rods under
    `simulation.drag.factor` feel it. Allowed: 0 to 2."""

    turbulence_size: float
    """Length of the largest eddies; the smallest have a quarter of it. Allowed: 0.02 to 100 m."""

    seed: int
    """Seed of the turbulence. Allowed: 0 to 4,294,967,295."""

    sources: Sequence[WindSources]
    """Places from which air blows. Allowed: 0 to 8."""

    keyframes: Sequence[WindKeyframes]
    """Mean velocities in the order of their times, in the place of `velocity`. Allowed: 0 to 100,000."""


class CollidersKeyframes(TypedDict, total=False):
    """A pose at a time, as a person writes it."""

    time: float
    """Time; each later than the one before. Allowed: -1,000,000 to 1,000,000 s."""

    rotation: Sequence[float]
    """Angles about the pivot: pitch (about x), yaw (about y), roll (about z), applied in the order roll, pitch, yaw;
    each angle is a curve of its own, so 720 degrees are two turns. Allowed: 3 numbers of -36,000 to 36,000
    degrees."""

    translation: Sequence[float]
    """Displacement of the pivot. Allowed: 3 numbers of -10,000 to 10,000 m."""

    interpolation: str
    """The way to the next pose; without it that of `motion.interpolation`. Allowed: one of smooth, linear, hold."""

    cut: bool
    """A jump: the pose before is held until this one. Hair is carried over jumps of the head; where a pose is held
    ("hold") and the next one is more than 15 degrees or 0.1 m away, that is a jump too. Allowed: true or false."""


class Colliders(TypedDict, total=False):
    """Solids beside the body."""

    shape: str
    """Form of the solid. Allowed: one of sphere, capsule."""

    center: Sequence[float]
    """Centre of a sphere. Allowed: 3 numbers of -10,000 to 10,000 m."""

    start: Sequence[float]
    """One end of a capsule. Allowed: 3 numbers of -10,000 to 10,000 m."""

    end: Sequence[float]
    """The other end of a capsule. Allowed: 3 numbers of -10,000 to 10,000 m."""

    radius: float
    """Radius. Allowed: 1e-6 to 1000 m."""

    carrier: str
    """Carrier that it moves with. Allowed: one of head, world."""

    friction: float
    """Coulomb friction coefficient of hair on the solid. It acts once a step, by how deep gravity and motion alone
    would take a point: neither the number of rounds nor the pull of the strand changes it. Allowed: 0 to 10."""

    keyframes: Sequence[CollidersKeyframes]
    """Displacements and turns about the middle of the solid, in the order of their times; it rests before the first
    and after the last. Allowed: 0 to 100,000."""


class SimulationDrag(TypedDict, total=False):
    """Drag of the air. Rods feel the force of a flow on a cylinder as thin as their hair [Cheng2013, Collis1959];
    that of a wisp is at most the force on a cylinder as thick as the wisp. Hair and solids take the wind from the
    hair behind them (`shelter`). Without `factor` hair takes the velocity of the wind at two rates, `across` and
    `along` the strand, as strands of springs and constraints do. A file that gives a rate and no `factor` has a
    `factor` of 0."""

    across: float
    """Rate at which hair takes the velocity of wind across the strand. Allowed: 0 to 1000 1/s."""

    along: float
    """Rate at which hair takes the velocity of wind along the strand. Allowed: 0 to 1000 1/s."""

    factor: float
    """Force of the air on rods over that of physics: 1 is physics. 0 leaves the two rates in its place. Allowed: 0 to
    1000."""

    shelter: bool
    """Under `factor`: hair and solids hold back the wind from the hair behind them, and the air in a lock moves along
    with it. Allowed: true or false."""

    hairs: float
    """Hairs that a guide stands for in the air under `factor`: a wisp whose outer hairs shelter the inner ones.
    Without it those of the look over the guides in a scene, else `strands.rods.wisp_hairs`. Allowed: 1 to
    1,000,000."""


class SimulationStrandsRods(TypedDict, total=False):
    """Hair as rods: bending and twisting follow from what a hair is made of. Stiffness goes with the fourth power of
    the radius, weight with its square. `hair` sets the defaults of what hair is made of, `radius` to `damping`, of
    `rubbing`, and of the groom's shape where hair is wet."""

    hair: str
    """Kind of hair. Allowed: one of fine, medium, coarse, wet, sprayed."""

    radius: float
    """Radius of a hair. Allowed: 1 to 1000 um."""

    youngs_modulus: float
    """Young's modulus. Allowed: 0.001 to 100,000 GPa."""

    poisson_ratio: float
    """Poisson's ratio: twisting stiffness over bending stiffness is 1 over 1 plus it. Allowed: 0 to 0.5."""

    shear_modulus: float
    """Shear modulus; without it that of Young's modulus and Poisson's ratio. Allowed: 0.001 to 100,000 GPa."""

    density: float
    """Density. Allowed: 1 to 20,000 kg/m^3."""

    load: float
    """Mass of what hair carries, water or lacquer, over its own. Allowed: 0 to 20."""

    wisp_hairs: int
    """Hairs that a guide stands for: they weigh and resist together. Allowed: 1 to 10,000."""

    cohesion: float
    """Sharing of load among the hairs of a guide: 0 lets each bend by itself, so that n hairs are n times as stiff as
    one; 1 glues them to one, n^2 times; between, n^(1 + cohesion). Allowed: 0 to 1."""

    packing: float
    """Share of the section of a wisp that its hairs fill: the air meets no more of them than a cylinder as wide as
    the wisp. Allowed: 0.01 to 1."""

    damping: float
    """Relaxation time of bends and twists: what they lag behind their rest. Allowed: 0 to 10 s."""

    ellipticity: float
    """Second axis of the section over the first; 1 is round. The first axis, the radius, lies across the root in the
    direction of the coordinate axis that the root is farthest from. Allowed: 0.1 to 1."""

    tip_radius: float
    """Radius at the tip over that at the root: it falls evenly from `taper_start` on. Allowed: 0.05 to 1."""

    taper_start: float
    """Share of the length where hair begins to taper. Allowed: 0 to 0.99."""

    profile: Sequence[float]
    """Stiffness at the root, in the middle and at the tip over that of the material, evenly between. Allowed: 3
    numbers of 0.01 to 100."""

    rubbing: float
    """Deceleration by hairs that rub against each other, relative to the head. A shape at rest among other hair may
    be off by what this much gravity bends it; of a strand without others beside it by a twentieth of that, and while
    slow it loses 4 of its speed in a second at most. Allowed: 0 to 100 m/s^2."""

    rest: str
    """Meaning of the groom's shape. Allowed: one of sag_free, unstressed, dry."""

    substeps: int
    """Parts of a step that are solved one after the other. Allowed: 1 to 64."""

    newton_steps: int
    """Most Newton steps of each part; strands that move gently need one or two. With one, hair that comes down onto a
    solid is put out of it without friction. Allowed: 1 to 64."""

    tolerance: float
    """A strand is solved when a Newton step turns none of its segments farther. The angle that is left is a tenth to
    a hundredth of it; hair that rubs comes to the same rest. Allowed: 1e-5 to 1 rad."""


class SimulationStrandsConstrainSpringsStretch(TypedDict, total=False):
    """A damped elastic spring."""

    enabled: bool
    """Enables the spring. Allowed: true or false."""

    stiffness: float
    """Force over extension. Allowed: 0 to 1e30 N/m."""

    damping: float
    """Force over speed of extension. Allowed: 0 to 1e30 N s/m."""


class SimulationStrandsConstrainSpringsBend(TypedDict, total=False):
    """A damped elastic spring."""

    enabled: bool
    """Enables the spring. Allowed: true or false."""

    stiffness: float
    """Force over extension. Allowed: 0 to 1e30 N/m."""

    damping: float
    """Force over speed of extension. Allowed: 0 to 1e30 N s/m."""


class SimulationStrandsConstrainSpringsTorsion(TypedDict, total=False):
    """A damped elastic spring."""

    enabled: bool
    """Enables the spring. Allowed: true or false."""

    stiffness: float
    """Force over extension. Allowed: 0 to 1e30 N/m."""

    damping: float
    """Force over speed of extension. Allowed: 0 to 1e30 N s/m."""


class SimulationStrandsConstrainSprings(TypedDict, total=False):
    """Elastic springs along a strand [Chen2011 §4]. They are integrated explicitly, so a step cannot carry more
    stiffness than `m / (12 dt^2)` nor more damping than `m / (12 dt)`, where m is the smaller mass of the two ends;
    what is above is cut off there."""

    stretch: SimulationStrandsConstrainSpringsStretch
    """A damped elastic spring."""

    bend: SimulationStrandsConstrainSpringsBend
    """A damped elastic spring."""

    torsion: SimulationStrandsConstrainSpringsTorsion
    """A damped elastic spring."""


class SimulationStrandsConstrainAngles(TypedDict, total=False):
    """Bends at the points of a strand, measured from the rest direction that frames carry from the head along the
    strand."""

    limit: float
    """Largest bend away from rest at a point; pi is no limit. Allowed: 0 to 3.1415927 rad."""

    stiffness: float
    """Angular frequency at which a lone bent segment would swing back to rest; 0 is off. Allowed: 0 to 10,000 1/s."""


class SimulationStrandsConstrainLengthPass(TypedDict, total=False):
    """The pass from root to tip that makes lengths exact [Mueller2012]."""

    enabled: bool
    """Makes lengths exact; without it strands stretch as in the thesis. Allowed: true or false."""

    correction: float
    """Share of the correction of a point that the next prediction of the point before it gives back [Mueller2012 eq.
    9]. It is the same share in a step of any length: what the pass corrects is an acceleration times the square of
    the step, so that what it keeps back adds up to as much velocity in a second. Allowed: 0 to 1."""


class SimulationStrandsConstrain(TypedDict, total=False):
    """Strands of springs and rounds of constraints [Chen2011 §4]."""

    iterations: int
    """Rounds of the constraints in a step [Chen2011 §6]. Allowed: 1 to 10,000."""

    mass_per_length: float
    """Mass of hair per length; the default is that of a hair 80 um thick. Points with masses of their own keep them.
    Allowed: 1e-9 to 1 kg/m."""

    springs: SimulationStrandsConstrainSprings
    """Elastic springs along a strand [Chen2011 §4]."""

    angles: SimulationStrandsConstrainAngles
    """Bends at the points of a strand, measured from the rest direction that frames carry from the head along the
    strand."""

    length_pass: SimulationStrandsConstrainLengthPass
    """The pass from root to tip that makes lengths exact [Mueller2012]."""


class SimulationStrands(TypedDict, total=False):
    """Motion of a strand within a step."""

    method: str
    """Solver of strands. Allowed: one of constrain, rods."""

    rods: SimulationStrandsRods
    """Hair as rods: bending and twisting follow from what a hair is made of."""

    constrain: SimulationStrandsConstrain
    """Strands of springs and rounds of constraints [Chen2011 §4]."""


class SimulationGroups(TypedDict, total=False):
    """Hair of a group of the groom that is made of something else than the rest. Values that it does not give are
    those of `[simulation.strands.rods]`."""

    group: str
    """The group: its name in the groom, or its number. Allowed: a name."""

    hair: str
    """Kind of hair. Allowed: one of fine, medium, coarse, wet, sprayed."""

    radius: float
    """Radius of a hair. Allowed: 1 to 1000 um."""

    youngs_modulus: float
    """Young's modulus. Allowed: 0.001 to 100,000 GPa."""

    poisson_ratio: float
    """Poisson's ratio: twisting stiffness over bending stiffness is 1 over 1 plus it. Allowed: 0 to 0.5."""

    shear_modulus: float
    """Shear modulus; without it that of Young's modulus and Poisson's ratio. Allowed: 0.001 to 100,000 GPa."""

    density: float
    """Density. Allowed: 1 to 20,000 kg/m^3."""

    load: float
    """Mass of what hair carries, water or lacquer, over its own. Allowed: 0 to 20."""

    wisp_hairs: int
    """Hairs that a guide stands for: they weigh and resist together. Allowed: 1 to 10,000."""

    cohesion: float
    """Sharing of load among the hairs of a guide: 0 lets each bend by itself, so that n hairs are n times as stiff as
    one; 1 glues them to one, n^2 times; between, n^(1 + cohesion). Allowed: 0 to 1."""

    packing: float
    """Share of the section of a wisp that its hairs fill: the air meets no more of them than a cylinder as wide as
    the wisp. Allowed: 0.01 to 1."""

    damping: float
    """Relaxation time of bends and twists: what they lag behind their rest. Allowed: 0 to 10 s."""

    ellipticity: float
    """Second axis of the section over the first; 1 is round. The first axis, the radius, lies across the root in the
    direction of the coordinate axis that the root is farthest from. Allowed: 0.1 to 1."""

    tip_radius: float
    """Radius at the tip over that at the root: it falls evenly from `taper_start` on. Allowed: 0.05 to 1."""

    taper_start: float
    """Share of the length where hair begins to taper. Allowed: 0 to 0.99."""

    profile: Sequence[float]
    """Stiffness at the root, in the middle and at the tip over that of the material, evenly between. Allowed: 3
    numbers of 0.01 to 100."""


class SimulationContact(TypedDict, total=False):
    """Contact of strands with each other, of rods. A guide is the wisp of the hairs that it stands for: a chain of
    capsules of radius r sqrt(hairs / `strands.rods.packing`), at most half of the room to the nearest strand at rest,
    so that nothing presses at rest."""

    enabled: bool
    """Strands push each other apart and rub. A step takes four to six times as long. Allowed: true or false."""

    hairs: float
    """Hairs that a guide stands for. Without it those of the look over the guides in a scene, else
    `strands.rods.wisp_hairs`. Allowed: 1 to 1,000,000."""

    friction: float
    """Coulomb coefficient of strands that stick to each other. Allowed: 0 to 10."""

    sliding_friction: float
    """Coulomb coefficient of strands that slide, no more than `friction`. Allowed: 0 to 10."""

    pull: float
    """Force with which water or lacquer holds strands that touch before they part, over the length of the shorter of
    both segments. It keeps strands where it takes hold of them, and draws none closer. Allowed: 0 to 10 N/m."""

    rounds: int
    """Rounds of each part of a step in which strands and forces between them answer each other. A GPU takes at most
    1000 in a step. Allowed: 1 to 1000."""


class SimulationVolume(TypedDict, total=False):
    """The fluid volume, which keeps the density of hair [Chen2011 §4.2, McAdams2009]."""

    enabled: bool
    """Keeps the density of hair: pressed hair spreads again. Single locks still pass through each other. Allowed:
    true or false."""

    method: str
    """Flow that the volume holds back. Allowed: one of one_sided, incompressible."""

    cells: Sequence[int]
    """Cells along x, y and z. Allowed: 3 whole numbers of 4 to 512."""

    flip_share: float
    """FLIP share of the velocity update in a step of 1/60 s, 0 is PIC and 1 is FLIP [Chen2011 eq. 5]. A step of
    another length takes as much of PIC in a second, and no more than all. In a one-sided volume of packed hair alone.
    Allowed: 0 to 1."""

    tolerance: float
    """Relative residual at which the pressure solve stops. Allowed: 1e-12 to 1."""

    max_iterations: int
    """Most iterations of the pressure solve; on a GPU at most 2,000. Allowed: 1 to 100,000."""

    preconditioner: str
    """Preconditioner of the conjugate gradients. Allowed: one of auto, mic0, jacobi, chebyshev, none."""


class Simulation(TypedDict, total=False):
    """Motion of hair."""

    time_step: float
    """Length of a step. Allowed: 1e-5 to 0.1 s."""

    gravity: Sequence[float]
    """Gravity, world space. Allowed: 3 numbers of -1000 to 1000 m/s^2."""

    checkpoint_every: int
    """Steps after which a GPU's state is read. Where the GPU fails the CPU resumes from the last one and makes the
    steps since then again. Allowed: 1 to 10,000 steps."""

    damping: float
    """Share of the velocity that is lost per second. Allowed: 0 to 1000 1/s."""

    collision_margin: float
    """Distance that strands keep from solids. A point that rests nearer may come as near as it rests, but not inside.
    Allowed: 0 to 0.1 m."""

    drag: SimulationDrag
    """Drag of the air."""

    strands: SimulationStrands
    """Motion of a strand within a step."""

    groups: Sequence[SimulationGroups]
    """Groups of the groom whose hair, as rods, is made of something else, at most 1,024. A setting that a group does
    not give is that of `[simulation.strands.rods]`, or of its own `hair`. A shear modulus that is not given keeps its
    share of Young's modulus, or follows from Poisson's ratio where that is given. Allowed: 0 to 1024."""

    contact: SimulationContact
    """Contact of strands with each other, of rods."""

    volume: SimulationVolume
    """The fluid volume, which keeps the density of hair [Chen2011 §4.2, McAdams2009]."""


class LookFibreChiang(TypedDict, total=False):
    """The rough dielectric fibre [Chiang2016]. Its paths: R is reflected, TT goes through, TRT comes back from
    inside."""

    pigment: str
    """Source of the hair's colour. Allowed: one of melanin, color."""

    eumelanin: float
    """Brown to black pigment: 0.3 blonde, 1.3 brown, 8 black. Allowed: 0 to 100."""

    pheomelanin: float
    """Red to yellow pigment. Allowed: 0 to 100."""

    tip_pigment: float
    """Pigment at the tip as a share of that at the root, for `pigment = "melanin"`. Allowed: 0 to 2."""

    roughness_along: float
    """Roughness along the fibre. Allowed: 0.05 to 1."""

    roughness_around: float
    """Roughness around the fibre. Allowed: 0.05 to 1."""

    tilt: float
    """Tilt of the scales of the fibre: the white highlight moves toward the root, the coloured one toward the tip.
    Allowed: -10 to 10 degrees."""

    index: float
    """Index of refraction. Allowed: 1.05 to 3."""

    scatterings: int
    """Number of times that light is scattered from hair to hair, at most: dark hair needs few. Allowed: 0 to 64."""

    cells: int
    """Cells that scattered light is carried through, along the longest side of the hair. Allowed: 8 to 39."""


class LookFibreScheuermannFirstHighlight(TypedDict, total=False):
    """A highlight on the hair [Scheuermann2004]."""

    shift: float
    """Angle by which it is moved toward the tip; below 0 toward the root. Allowed: -45 to 45 degrees."""

    width: float
    """Its standard deviation along the strand. Allowed: 0.5 to 60 degrees."""

    strength: float
    """Share of the light that goes into it. Allowed: 0 to 0.5."""


class LookFibreScheuermannSecondHighlight(TypedDict, total=False):
    """A highlight on the hair [Scheuermann2004]."""

    shift: float
    """Angle by which it is moved toward the tip; below 0 toward the root. Allowed: -45 to 45 degrees."""

    width: float
    """Its standard deviation along the strand. Allowed: 0.5 to 60 degrees."""

    strength: float
    """Share of the light that goes into it. Allowed: 0 to 0.5."""


class LookFibreScheuermann(TypedDict, total=False):
    """Light about the strand and two highlights from shifted tangents [Scheuermann2004]."""

    first_highlight: LookFibreScheuermannFirstHighlight
    """A highlight on the hair [Scheuermann2004]."""

    second_highlight: LookFibreScheuermannSecondHighlight
    """A highlight on the hair [Scheuermann2004]."""

    sparkle: float
    """Break-up of the second highlight into sparkles by a second noise. Allowed: 0 to 1."""

    translucency: float
    """Extra reach of light through bright hair, relative to black hair. Allowed: 0 to 1."""


class LookFibre(TypedDict, total=False):
    """Scattering by one hair."""

    model: str
    """The model. Allowed: one of scheuermann, chiang."""

    chiang: LookFibreChiang
    """The rough dielectric fibre [Chiang2016]. Its paths: R is reflected, TT goes through, TRT comes back from
    inside."""

    scheuermann: LookFibreScheuermann
    """Light about the strand and two highlights from shifted tangents [Scheuermann2004]."""


class LookClump(TypedDict, total=False):
    """Shape of follow strands about their guide [Chen2011 §3.2]."""

    root_radius: float
    """Radius of the clump at the roots. Allowed: 0 to 1 m."""

    tip_radius: float
    """Radius of the clump at the tips. Allowed: 0 to 1 m."""

    taper: float
    """Exponent of the way from root to tip radius; above 1 the clump closes late. Allowed: 0.1 to 10."""

    lift: float
    """Lift of hair combed along the skin, from 0 (half of the strands inside) to 1 (the guide is the innermost).
    Allowed: 0 to 1."""

    shorter: float
    """Greatest share by which a follow strand is shorter than its guide. Allowed: 0 to 0.9."""

    wave_amplitude: float
    """Amplitude of each strand's own waves at the tip; there are none at the root. Allowed: 0 to 1 m."""

    wave_length: float
    """Mean length of those waves. Allowed: 0.001 to 10 m."""


class LookCoat(TypedDict, total=False):
    """Water or lacquer on hair: it darkens hair, smooths its scales and draws strands together.
    `simulation.strands.rods.hair` brings it along, whatever the look. Under the thesis's fibre the colours of strands
    of a file, a map or a group stay."""

    pigment: float
    """Multiple of the pigment that light meets: the surface of a film throws light back into the hair. Allowed: 0.1
    to 10."""

    roughness: float
    """Multiple of the roughness of hair along it, and of the noise of its highlights: a film fills the steps between
    scales. Allowed: 0.1 to 2."""

    gather: float
    """Share by which strands come together on their way to the tips, each toward its guide. A scene takes it in for
    strands that follow guides when it is loaded. Allowed: 0 to 1."""


class LookShadow(TypedDict, total=False):
    """Shadows of hair and body [Yuksel2008]."""

    map_size: int
    """Texels along each side of a light's maps; on a GPU at most 2,048 with two shadow lights, 1,024 with eight. 0
    chooses them by the hair: 512, and for dense light hair, which 512 draw up to 0.2 darker than path tracing does,
    1,536 with up to three places of lights with shadow, then fewer, 1,408 with four, 1,152 with six and 1,024 with
    eight; a browser page has 1,408 with one and 1,024 with two. Fewer than 16 count as 16. Allowed: 0 to 4096."""

    layers: Sequence[float]
    """Distances behind the first hair at which the three layers end, rising; hair farther behind it casts no shadow.
    Allowed: 3 numbers of 1e-6 to 1000 m."""

    opacity: float
    """Share of the light that one hair takes away where it is crossed: most of what meets a hair goes on, scattered
    forward. Allowed: 0 to 0.99."""

    body_bias: float
    """Depth under the body's surface at which its shadow begins. Allowed: 0 to 1 m."""

    body_softness: float
    """Depth over which that shadow grows to its full. Allowed: 1e-6 to 1 m."""

    rays: int
    """Rays from a place of skin at the edge of a shadow to a light with an area, shared out among its samples: each
    gets one at least. Allowed: 1 to 256."""


class LookEnvironment(TypedDict, total=False):
    """Light from all around: a sky above and a ground below, even between."""

    sky: Sequence[float]
    """Radiance from straight above, linear RGB. Allowed: 3 numbers of 0 to 1000."""

    ground: Sequence[float]
    """Radiance from straight below, linear RGB. Allowed: 3 numbers of 0 to 1000."""


class LookGroup(TypedDict, total=False):
    """The look of one group of strands; what it does not give is that of all. The first that names a group counts."""

    name: str
    """Name of the group in the groom, or its number; of files that are brought together each is a group of its name.
    Allowed: a name."""

    width_scale: float
    """Multiple of the groom's root diameters, on top of that of all. Allowed: 0 to 1000."""

    clump: float
    """Multiple of `look.clump`'s radii and of the waves of drawn strands. Without it one that fits groups whose roots
    stand closer than those of most hair, where the radii are fitted too. Allowed: 0 to 10."""

    root_color: Sequence[float]
    """Reflectance at the root, linear RGB; with `fibre.chiang.pigment = "color"`, what hair shows beside white hair.
    Allowed: 3 numbers of 0 to 1."""

    tip_color: Sequence[float]
    """Reflectance at the tip, linear RGB, the same way. Allowed: 3 numbers of 0 to 1."""

    variation: float
    """Spread of brightness among strands as a share of it. Allowed: 0 to 1."""

    grey: float
    """Share of strands that have turned white. Allowed: 0 to 1."""

    color_map: str
    """A .png with the colour of each strand, sRGB, over where roots lie on the scalp (the groom's root coordinates;
    the first is to the right, the second up). It replaces colours of the groom. A scene takes maps and groups in when
    it is loaded. Allowed: the path of a file."""

    width_map: str
    """A .png with the width of each strand as a share of its own: white is all of it, black none. Allowed: the path
    of a file."""

    eumelanin: float
    """Brown to black pigment: 0.3 blonde, 1.3 brown, 8 black. Allowed: 0 to 100."""

    pheomelanin: float
    """Red to yellow pigment. Allowed: 0 to 100."""

    tip_pigment: float
    """Pigment at the tip as a share of that at the root, for `pigment = "melanin"`. Allowed: 0 to 2."""


class Look(TypedDict, total=False):
    """Colour and shape of the drawn hair. Colours are linear RGB. `root_color` or `tip_color` without
    `fibre.chiang.pigment` means "color"."""

    preset: str
    """The look that what is not given comes from: pigment and colours, fibre, highlights, layers of shadow and
    surroundings. "thesis" brings `picture.tone_map`, `picture.background` and lights too. Allowed: one of brown,
    black, blonde, red, copper, grey, white, blue, pink, violet, green, thesis."""

    light_rig: str
    """Lights of a scene that names none, about the middle of hair and body; a picture of surroundings comes before
    them. Allowed: one of auto, studio, all_sides, three_point."""

    follow_strands: int
    """Follow strands of each guide, the guide itself among them. Allowed: 1 to 1024."""

    hair_count: int
    """Hairs that the drawn strands stand for: each strand is widened so that together they cover as much as this many
    hairs; 0 draws every strand as one hair. Those of a beard, brows and lashes that grow beside the hair come on top.
    Allowed: 0 to 100,000,000."""

    width_scale: float
    """Multiple of the groom's root diameters. Allowed: 0 to 1000."""

    tip_width: float
    """Diameter at the tip as a share of that at the root. Allowed: 0 to 1."""

    root_width: float
    """Diameter where a strand leaves the skin as a share of that 4 mm on; a file's widths are taken as they are.
    Allowed: 0 to 1."""

    root_color: Sequence[float]
    """Reflectance at the root, linear RGB; with `fibre.chiang.pigment = "color"`, what hair shows beside white hair.
    Allowed: 3 numbers of 0 to 1."""

    tip_color: Sequence[float]
    """Reflectance at the tip, linear RGB, the same way. Allowed: 3 numbers of 0 to 1."""

    fibre: LookFibre
    """Scattering by one hair."""

    variation: float
    """Spread of brightness among strands as a share of it. Allowed: 0 to 1."""

    grey: float
    """Share of strands that have turned white. Allowed: 0 to 1."""

    highlight_noise: float
    """Noise along and among strands by which highlights are moved. Allowed: 0 to 45 degrees."""

    clump: LookClump
    """Shape of follow strands about their guide [Chen2011 §3.2]."""

    coat: LookCoat
    """Water or lacquer on hair: it darkens hair, smooths its scales and draws strands together."""

    shadow: LookShadow
    """Shadows of hair and body [Yuksel2008]."""

    environment: LookEnvironment
    """Light from all around: a sky above and a ground below, even between."""

    color_map: str
    """A .png with the colour of each strand, sRGB, over where roots lie on the scalp (the groom's root coordinates;
    the first is to the right, the second up). It replaces colours of the groom. A scene takes maps and groups in when
    it is loaded. Allowed: the path of a file."""

    body_colors: bool
    """Colours strands as the body's materials are at their roots, where the groom has no colours: fur of an animal.
    Allowed: true or false."""

    width_map: str
    """A .png with the width of each strand as a share of its own: white is all of it, black none. Allowed: the path
    of a file."""

    group: Sequence[LookGroup]
    """Groups of strands that look other than all, at most 256. A setting that a group does not give is that of all
    but its tip colour, which is that of its root; a colour or a map of a group wins over its pigment. Allowed: 0 to
    256."""

    seed: int
    """Seed of every random choice of the look. Allowed: 0 to 4,294,967,295."""


class BodyLook(TypedDict, total=False):
    """Look of the body."""

    materials: bool
    """Draws the colours, textures and gloss that the body's file has; false where `color` is given. Cut-outs stay.
    Allowed: true or false."""

    color: Sequence[float]
    """Colour of all that has none of its own, linear RGB. Allowed: 3 numbers of 0 to 1."""

    wrap: float
    """Reach of light around the edge of shadow; 0 is none. Allowed: 0 to 1."""

    softness: float
    """Light under the skin: how far red light reaches around the edge of shadow beyond `wrap`, green and blue less.
    Parts with a colour of their own have none. Allowed: 0 to 1."""

    oil: float
    """Share of the skin's highlight that oil makes narrower. Parts with a colour of their own have none. Allowed: 0
    to 1."""

    specular: float
    """Reflectance at normal incidence; 0 is no highlight. Allowed: 0 to 1."""

    roughness: float
    """Width of the highlight, from polished to matt. Allowed: 0.05 to 1."""

    scalp: float
    """Share of the hair's colour that skin takes among dense roots; 0 in the look "thesis". Allowed: 0 to 1."""


class LevelOfDetail(TypedDict, total=False):
    """Detail by viewing distance [Chen2011 table 5] and the size of a pixel. Distances are those of a picture of 600
    rows and a field of view of 30 degrees: where more rows or a narrower view make pixels smaller, hair counts as
    nearer (`by_pixel`). Up to `full_distance` everything is drawn, and where the nearest hair is nearer than a third
    of it, segments become more with the square root of the nearness, up to `most_segments`. Beyond it the share of
    follow strands falls in inverse proportion to the distance, and that of segments with its square root (a segment
    strays from the curve by the square of its length, so it strays by the same number of pixels), down to their least
    shares. Both numbers are continuous, so nothing jumps: the last follow strand fades by its width while the others
    widen (their sum stays), and the last segment of a strand shrinks to nothing at the tip. Strands without follow
    strands stand for themselves: of each eight as many are left out, in the same way."""

    segments_per_span: int
    """Segments on each span between two guide points at full detail. Allowed: 1 to 16."""

    full_distance: float
    """Distance from the camera to the hair's middle up to which all is drawn. Allowed: 0.001 to 1,000,000 m."""

    least_strands: float
    """Least share of the strands that is drawn from afar: of follow strands where there are some. Allowed: 0 to 1."""

    least_segments: float
    """Least share of the segments that is drawn from afar. Allowed: 0 to 1."""

    most_segments: float
    """Most segments close up, as a multiple of `segments_per_span`, while all strands together have no more than
    4,000,000 points. Allowed: 1 to 16."""

    by_pixel: bool
    """Relates distances to a picture of 600 rows and a field of view of 30 degrees, so that more rows or a narrower
    view count as nearness; without it distance alone counts. Allowed: true or false."""


class CameraKeyframes(TypedDict, total=False):
    """The camera at a time, about where `[camera]` has it."""

    time: float
    """Time; each later than the one before. Allowed: -1,000,000 to 1,000,000 s."""

    turn: float
    """Turn about a vertical through the target, counter-clockwise as seen from above; whole turns count. Allowed:
    -36,000 to 36,000 degrees."""

    rise: float
    """Rise about the target, up to 89 degrees above it or below. Allowed: -180 to 180 degrees."""

    distance: float
    """Distance from the target over that of `[camera]`. Allowed: 0.01 to 1000."""

    translation: Sequence[float]
    """Displacement of camera and target, world space. Allowed: 3 numbers of -10,000 to 10,000 m."""

    interpolation: str
    """The way to the next keyframe; "smooth" without it. Allowed: one of smooth, linear, hold."""

    cut: bool
    """A jump: the view before is held until this one. Allowed: true or false."""


class CameraKept(TypedDict, total=False):
    """A view that was kept."""

    name: str
    """Its name. Allowed: a name."""

    position: Sequence[float]
    """Position, world space. Allowed: 3 numbers of -10,000 to 10,000 m."""

    target: Sequence[float]
    """Target, world space. Allowed: 3 numbers of -10,000 to 10,000 m."""

    field_of_view: float
    """Vertical field of view. Allowed: 1 to 170 degrees."""


class Camera(TypedDict, total=False):
    """View of the pictures."""

    view: str
    """From where it looks when its position is not given; hair and body fill the picture. Allowed: one of front,
    three_quarter, side, back."""

    position: Sequence[float]
    """Position, world space. Allowed: 3 numbers of -10,000 to 10,000 m."""

    target: Sequence[float]
    """Target, world space; without it the middle of hair and body. Allowed: 3 numbers of -10,000 to 10,000 m."""

    field_of_view: float
    """Vertical field of view; without it that of the framing. Allowed: 1 to 170 degrees."""

    keyframes: Sequence[CameraKeyframes]
    """Views of a film, in the order of their times; a window follows them until its view is moved. Allowed: 0 to
    100,000."""

    kept: Sequence[CameraKept]
    """Views that a window lists; no picture of `render` looks from them. Allowed: 0 to 1000."""


class Lights(TypedDict, total=False):
    """A light. Each may cast shadows of hair and body."""

    kind: str
    """Spread of its rays. Allowed: one of directional, spot, point, rectangle, disc."""

    position: Sequence[float]
    """Position, world space. Allowed: 3 numbers of -1,000,000 to 1,000,000 m."""

    target: Sequence[float]
    """Target, world space. Allowed: 3 numbers of -1,000,000 to 1,000,000 m."""

    color: Sequence[float]
    """Colour, linear RGB. Allowed: 3 numbers of 0 to 1000."""

    intensity: float
    """Radiance of a white matte surface at the target that faces the light; spot and point lights fall off from there
    with the square of the distance. Allowed: 0 to 1,000,000."""

    cone_angle: float
    """Angle between the axis and the rim of a spot light's cone. Allowed: 1 to 85 degrees."""

    cone_softness: float
    """Share of that angle over which the rim fades. Allowed: 0 to 1."""

    width: float
    """Width of a rectangle, diameter of a disc. Allowed: 0.001 to 1000 m."""

    height: float
    """Height of a rectangle. Allowed: 0.001 to 1000 m."""

    samples: int
    """Places along each side from which a rectangle or disc is taken to shine, each with shadows of its own; on a GPU
    all lights together have at most eight places with shadow. Allowed: 1 to 4."""

    shadow: bool
    """Makes hair and body cast shadows in it. Allowed: true or false."""


class Surroundings(TypedDict, total=False):
    """A picture of the surroundings that lights hair and body from all around, in the place of `look.environment`.
    Its brightest lights shine with a shadow each."""

    file: str
    """A .hdr or .exr picture of all directions, twice as wide as high, its middle before the face. Without `lights`
    it is all there is. Allowed: the path of a file."""

    rotation: float
    """Turns it about the height, counter-clockwise as seen from above. Allowed: -360 to 360 degrees."""

    strength: float
    """Factor of its light. Allowed: 0 to 1,000,000."""


class PictureBackground(TypedDict, total=False):
    """A vertical gradient, linear RGB before exposure and tone map."""

    top: Sequence[float]
    """At the top of the picture. Allowed: 3 numbers of 0 to 1000."""

    bottom: Sequence[float]
    """At the bottom of the picture. Allowed: 3 numbers of 0 to 1000."""


class Picture(TypedDict, total=False):
    """Size of a picture, and conversion of light to colour."""

    width: int
    """Width. Allowed: 1 to 16,384 pixel."""

    height: int
    """Height. Allowed: 1 to 16,384 pixel."""

    supersampling: int
    """Samples along each axis of a pixel. Allowed: 1 to 2."""

    exposure: float
    """Exposure; one more doubles the light. Allowed: -16 to 16 stops."""

    tone_map: str
    """Mapping of light beyond white. Allowed: one of off, filmic, aces."""

    background: PictureBackground
    """A vertical gradient, linear RGB before exposure and tone map."""

    transparent: bool
    """Leaves the background out and writes opacity instead. Allowed: true or false."""

    layers: bool
    """Keeps linear light, depth, the hair's coverage, its directions and strands too, as for an .exr file. Allowed:
    true or false."""


class Film(TypedDict, total=False):
    """Number and rate of the pictures."""

    frames: int
    """Number of pictures. Allowed: 1 to 1,000,000."""

    frames_per_second: float
    """Pictures per second of the scene's time. Allowed: 1 to 1000 1/s."""

    settle: float
    """Time that passes with the head at rest before the first picture; none does before hair that begins in a pose.
    Rods begin at rest and need none; with `method = "constrain"`, where hair sags at first, the default is 1, and
    with wet hair 2. Allowed: 0 to 3600 s."""

    start: float
    """Time of motion and wind at the beginning. Allowed: 0 to 1,000,000 s."""


class Timeline(TypedDict, total=False):
    """Frames that a window keeps, so that they are shown again and left as a file without simulating them again."""

    frames: str
    """File of kept frames that a window begins with, as it saves them with a project; other programs pass it over.
    Allowed: the path of a file."""

    memory: int
    """Memory for frames. Allowed: 1 to 1,000,000 MB."""

    disk: int
    """Room on the disk, in the folder for temporary files, for frames beyond the memory. Beyond both the first frames
    are forgotten. Allowed: 0 to 10,000,000 MB."""


class SceneSections(TypedDict, total=False):
    """The sections of a scene."""

    devices: Devices
    """Devices of the simulation and of pictures. When both are on one GPU, points stay there."""

    groom: Groom
    """Strands from a file, and how guides are made of strands."""

    ties: Sequence[Ties]
    """Bands about hair; none named means those of the knots that are found, see `groom.find_ties`. Allowed: 0 to
    64."""

    strokes: Sequence[Strokes]
    """Strokes of a brush over the hair at rest, one after the other: comb, cut, lengthen, clump, curl. Allowed: 0 to
    4096."""

    style: Style
    """Settings of a grown style. The default of every number but the first two is that of the style."""

    body: Body
    """The body that hair grows on and hits."""

    motion: Motion
    """Motion of the head."""

    wind: Wind
    """Motion of the air."""

    colliders: Sequence[Colliders]
    """Solids beside the body, at most 1,024."""

    simulation: Simulation
    """Motion of hair."""

    look: Look
    """Colour and shape of the drawn hair."""

    body_look: BodyLook
    """Look of the body."""

    level_of_detail: LevelOfDetail
    """Detail by viewing distance [Chen2011 table 5] and the size of a pixel."""

    camera: Camera
    """View of the pictures."""

    lights: Sequence[Lights]
    """The lights, at most 64; none named means a soft box before the head, a strip behind it and a weak fill beside
    it, or three lights of the look "thesis"."""

    surroundings: Surroundings
    """A picture of the surroundings that lights hair and body from all around, in the place of `look.environment`.
    Its brightest lights shine with a shadow each."""

    picture: Picture
    """Size of a picture, and conversion of light to colour."""

    film: Film
    """Number and rate of the pictures."""

    timeline: Timeline
    """Frames that a window keeps, so that they are shown again and left as a file without simulating them again."""
