use std::path::PathBuf;

use glam::Vec3;
use serde::{Deserialize, Serialize};
use strandline_base::{Group, Key, Kind, Row, SettingError, Table, Value, Word, choices, settings};

use super::{KeyframeSection, TeleportSection};
use crate::{
    Error,
    body::{Build, Carrier, Collider, Eyes, Shape},
    groom::format::{Scale, Up},
};

choices! {
    /// Body that is used when no file is named.
    pub enum Model as "body.model" {
        /// The mannequin under a grown style, also one from a file with its guides; nothing under another groom from a file.
        Auto = "auto",
        /// The built-in bust.
        Mannequin = "mannequin",
        /// No body.
        None = "none",
    }
    default Auto
}

settings! {
    /// A further mesh of the body: eyes, teeth, a collar, a hat.
    pub struct BodyPart {
        /// An .obj, .gltf, .glb, .vrm, .ply or .stl file.
        file: PathBuf = PathBuf::new(), required true;
        /// Metres per unit of the file; "auto" takes that of `body.file`.
        scale: Scale = Scale::default(), in [1e-6, 1e6] "m";
        /// The file's axis that points up; "auto" takes that of `body.file`.
        up: Up = Up::default();
        /// Turns the mesh: pitch (about x), yaw (about y), roll (about z).
        rotation: Vec3 = Vec3::ZERO, in [-360.0, 360.0] "degrees", slider [-180.0, 180.0];
        /// Moves the mesh, head space.
        translation: Vec3 = Vec3::ZERO, in [-1e4, 1e4] "m";
        /// Draws it.
        visible: bool = true;
        /// Makes it solid; without this a closed mesh is solid, and one with an open rim, such as lashes, is
        /// not.
        solid: Option<bool> = None;
        /// Presses hair that starts under it beneath it; without this a part does that covers as many roots as a hat.
        covers: Option<bool> = None;
        /// Clip of the part's glTF file that moves it, by its name, in the space that it shares with the body's file: clothes
        /// with a skin of their own. Without one the part rides the head.
        clip: Option<String> = None;
        /// Time of the part's clip at the time 0 of the scene; the clip is held before its beginning and after its end.
        start: f64 = 0.0, in [-1e6, 1e6] "s", slider [0.0, 10.0];
        /// Seconds of the part's clip in a second of the scene.
        speed: f64 = 1.0, in [-1000.0, 1000.0], slider [0.0, 4.0], more "a faster motion";
        /// Begins the part's clip again after its end.
        r#loop: bool = false;
        /// Marks at which the part is elsewhere at once, beside `extras.teleports` of its clip, times of the clip: hair is
        /// carried with the head over them.
        teleports: Vec<TeleportSection> = Vec::new(), in [0, 100_000];
    }
}

settings! {
    /// The body that hair grows on and hits.
    pub struct BodySection {
        /// The body when no file is named.
        model: Model = Model::default();
        /// Build of the mannequin: its neck, shoulders, cheeks and jaw.
        build: Build = Build::default();
        /// Eyes of the mannequin.
        eyes: Eyes = Eyes::default();
        /// An .obj, .gltf, .glb, .vrm, .ply or .stl file; or a body in motion: an .npz with `vertices` over time and
        /// `faces`, a folder of .obj files with the same faces, or such files by a pattern, `walk%04d.obj`.
        file: Option<PathBuf> = None;
        /// Part of the body on which a style grows, by its name in the body's files: an object, a group or a material
        /// of an .obj, a node, a mesh or a material of a glTF. Without it the built-in scalp is brought onto the skull.
        scalp: Option<String> = None;
        /// Clip of the body's glTF file that moves it, by its name: skins, morph targets and nodes. The head is where the
        /// roots of the hair are; without a clip the body rests in its default pose.
        clip: Option<String> = None;
        /// The body's vertices over time, in the units, axes and order of `file`: a .npy or .npz file of an array
        /// `[frame, vertex, 3]`, named vertices, verts, positions or v, with `times` or `fps` beside it.
        vertices: Option<PathBuf> = None;
        /// Rate of files, and of arrays without times.
        frames_per_second: f64 = 24.0, in [0.001, 10_000.0] "1/s";
        /// Time of the motion at the time 0 of the scene; the motion is held before its beginning and after its end.
        start: f64 = 0.0, in [-1e6, 1e6] "s", slider [0.0, 10.0];
        /// Seconds of the motion in a second of the scene.
        speed: f64 = 1.0, in [-1000.0, 1000.0], slider [0.0, 4.0], more "a faster motion";
        /// Begins the motion again after its end.
        r#loop: bool = false;
        /// Marks at which the body is elsewhere at once, beside those of its file: `extras.teleports` of a glTF's clip and
        /// the array `teleports` of an .npz, times of the motion. A `loop` jumps at its beginning where 0 is marked.
        teleports: Vec<TeleportSection> = Vec::new(), in [0, 100_000];
        /// A closed mesh that hair hits in place of the drawn one.
        collider_file: Option<PathBuf> = None;
        /// Metres per unit of the body's files; "auto" takes 1 for a glTF, which is in metres, and else that of 1, 0.01,
        /// 0.001, 0.0254 and 0.00254 that makes the head most like that of a person, or a body without such a head as
        /// large as a doll to a bear.
        scale: Scale = Scale::default(), in [1e-6, 1e6] "m";
        /// The files' axis that points up; "auto" takes y for a glTF, whose face looks along +z, and else the axis that
        /// the body shows: the head of a person, the four feet of an animal, or the flat base of a statue. A given axis gives
        /// the front too.
        up: Up = Up::default();
        /// Turns the body of a file: pitch (about x), yaw (about y), roll (about z).
        rotation: Vec3 = Vec3::ZERO, in [-360.0, 360.0] "degrees", slider [-180.0, 180.0];
        /// Moves the body of a file, head space.
        translation: Vec3 = Vec3::ZERO, in [-1e4, 1e4] "m";
        /// Further meshes of the same body, at most 64. They need a `file`.
        parts: Vec<BodyPart> = Vec::new(), in [0, 64];
        /// Draws the body.
        visible: bool = true;
        /// Makes the body solid.
        solid: bool = true;
        /// Distance between the samples of the body's signed distance.
        spacing: f32 = 0.004, in [5e-4, 0.1] "m", slider [0.002, 0.02],
            more "a coarser surface for hair, at less time and memory";
        /// Uses the exact mannequin as the solid in place of samples of it; slower.
        exact: bool = false;
        /// Coulomb friction coefficient of hair on the solid. It acts once a step, by how deep gravity and
        /// motion alone would take a point: neither the number of rounds nor the pull of the strand changes it.
        friction: f32 = 0.3, in [0.0, 10.0], slider [0.0, 2.0], more "hair that slides less";
    }
}

choices! {
    /// Space in which a collider is fixed.
    pub enum CarrierName as "carrier" {
        /// The head: the shape is given in head space.
        Head = "head",
        /// Nothing: the shape is given in world space and stays but for its keyframes.
        World = "world",
    }
    default Head
}

impl From<CarrierName> for Carrier {
    fn from(name: CarrierName) -> Self {
        match name {
            CarrierName::Head => Self::HEAD,
            CarrierName::World => Self::World,
        }
    }
}

settings! {
    /// A ball.
    pub struct SphereSection {
        /// Centre of a sphere.
        center: Vec3 = Vec3::ZERO, required true, in [-1e4, 1e4] "m";
        /// Radius.
        radius: f32 = 0.05, required true, in [1e-6, 1000.0] "m", slider [0.005, 0.3], more "a larger solid";
        /// Carrier that it moves with.
        carrier: CarrierName = CarrierName::default();
        /// Displacements and turns about the middle of the solid, in the order of their times; it rests before the first and
        /// after the last.
        keyframes: Vec<KeyframeSection> = Vec::new(), in [0, 100_000];
        shared BodySection { friction: f32 }
    }
}

settings! {
    /// A segment with a radius.
    pub struct CapsuleSection {
        /// One end of a capsule.
        start: Vec3 = Vec3::ZERO, required true, in [-1e4, 1e4] "m";
        /// The other end of a capsule.
        end: Vec3 = Vec3::ZERO, required true, in [-1e4, 1e4] "m";
        shared SphereSection { radius: f32, carrier: CarrierName, friction: f32, keyframes: Vec<KeyframeSection> }
    }
}

/// `[[colliders]]`: a solid beside the body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "shape", rename_all = "lowercase")]
pub enum ColliderSection {
    /// A ball.
    Sphere(SphereSection),
    /// A segment with a radius.
    Capsule(CapsuleSection),
}

impl ColliderSection {
    /// The solid itself, without keyframes.
    ///
    /// # Errors
    /// A radius that is not positive, a negative friction, a number that is not finite.
    pub fn collider(&self) -> Result<Collider, Error> {
        let (shape, carrier, friction) = match *self {
            Self::Sphere(SphereSection { center, radius, carrier, friction, .. }) => {
                (Shape::Sphere { center, radius }, carrier, friction)
            }
            Self::Capsule(CapsuleSection { start, end, radius, carrier, friction, .. }) => {
                (Shape::Capsule { start, end, radius }, carrier, friction)
            }
        };
        Ok(Collider::new(shape, carrier.into(), friction)?)
    }
}

impl Value for ColliderSection {
    type Given = Self;
    const KIND: Kind = Kind::Group(&Self::TABLE);

    fn take(&mut self, given: Self) {
        *self = given;
    }

    fn check(&self, row: &Row, key: &Key) -> Result<(), SettingError> {
        match self {
            Self::Sphere(sphere) => sphere.check(row, key),
            Self::Capsule(capsule) => capsule.check(row, key),
        }
    }
}

impl Group for ColliderSection {
    type Rows = Row;
    const ROWS: Row = Row {
        name: "shape",
        doc: "Form of the solid.",
        kind: Kind::Words(&[
            Word::new("sphere", SphereSection::TABLE.doc),
            Word::new("capsule", CapsuleSection::TABLE.doc),
        ]),
        required: true,
        ..Row::NONE
    };
    const TABLE: Table = Table {
        doc: "Solids beside the body.",
        rows: &[
            Self::ROWS,
            SphereSection::ROWS.center,
            CapsuleSection::ROWS.start,
            CapsuleSection::ROWS.end,
            SphereSection::ROWS.radius,
            SphereSection::ROWS.carrier,
            SphereSection::ROWS.friction,
            SphereSection::ROWS.keyframes,
        ],
    };
}
