//! A scene: everything that one run needs, as one TOML file. docs/scene.md lists every key.

mod air;
mod body;
mod builtin;
pub(crate) mod camera_motion;
mod colors;
pub(crate) mod devices;
mod film;
mod given;
mod groom;
pub(crate) mod head;
mod keys;
mod motion;
pub(crate) mod origin;
pub(crate) mod solid_motion;
mod surroundings;
mod teleport;
mod timeline;

use std::path::{Path, PathBuf};

use strandline_base::{Group, SettingError, Value, printable, read_plain, settings};

pub(crate) use air::Air;
pub use body::{BodyPart, BodySection, CapsuleSection, CarrierName, ColliderSection, Model, SphereSection};
pub(crate) use builtin::segments_per_span;
pub use colors::hex_color;
pub use devices::Devices;
pub use film::{CameraKeyframe, CameraSection, FilmSection, KeptView, View};
pub(crate) use given::Given;
pub(crate) use groom::filling;
pub use groom::{GroomPart, GroomSection, TieSection};
pub use head::HeadMotion;
pub use motion::{KeyframeSection, MotionName, MotionSection, WindKeyframe, WindSection, WindSource};
pub use surroundings::SurroundingsSection;
pub use teleport::TeleportSection;
pub use timeline::TimelineSection;

pub use crate::body::Interpolation;
use crate::{
    Backend, Error,
    groom::{Stroke, StyleSettings},
    render::{BodyLook, LevelOfDetail, Light, Look, PictureSettings, Preset, memory::MAX_LIGHTS},
    sim::Settings,
};

/// Largest file that is read \[bytes\]: unknown keys take some 30 times as much memory, and a scene of ten
/// thousand keyframes takes a tenth.
pub const MAX_FILE_BYTES: u64 = 8 << 20;

settings! {
    /// One run: groom, body, motion, colliders, simulation, look, camera, lights, picture and film.
    ///
    /// Every key has a default; unknown keys are refused by name. Paths are relative to the file. Without a
    /// groom file, [`Scene::set_style`] says what the style sets beside strands.
    pub struct Scene {
        /// Devices of simulation and pictures.
        devices: Devices = Devices::default();
        /// Strands from a file, and how guides are made of strands.
        groom: GroomSection = GroomSection::default();
        /// Bands about hair; none named means those of the knots that are found, see `groom.find_ties`.
        ties: Vec<TieSection> = Vec::new(), in [0, 64];
        /// Strokes of a brush over the hair at rest, one after the other: comb, cut, lengthen, clump, curl.
        strokes: Vec<Stroke> = Vec::new(), in [0, 4096];
        /// The style that is grown when no groom file is named. The default of every number but
        /// `strand_count` and `seed` is that of the style; those of "long" are shown.
        style: StyleSettings = StyleSettings::default();
        /// The body that hair grows on and hits.
        body: BodySection = BodySection::default();
        /// Motion of the head.
        motion: MotionSection = MotionSection::default();
        /// Motion of the air.
        wind: WindSection = WindSection::default();
        /// Solids beside the body, at most 1,024.
        colliders: Vec<ColliderSection> = Vec::new();
        /// Motion of the hair.
        simulation: Settings = Settings::default();
        /// Colour and shape of the drawn hair. Without a groom file the default of `follow_strands` makes 16 drawn
        /// strands for each guide.
        look: Look = Look { follow_strands: 2, ..Look::default() };
        /// Colour of the drawn body.
        body_look: BodyLook = BodyLook::default();
        /// Detail by distance and the size of a pixel. Without a groom file the default of
        /// `segments_per_span` is that of the style.
        level_of_detail: LevelOfDetail = LevelOfDetail::default();
        /// View of the pictures.
        camera: CameraSection = CameraSection::default();
        /// The lights, at most 64; none named means a soft box before the head, a strip behind it and a weak fill
        /// beside it, or three lights of the look "thesis".
        lights: Vec<Light> = Vec::new();
        /// Surroundings as a picture.
        surroundings: SurroundingsSection = SurroundingsSection::default();
        /// Size and finish of a picture.
        picture: PictureSettings = PictureSettings::default();
        /// Number and rate of the pictures.
        film: FilmSection = FilmSection::default();
        /// Frames that a window keeps.
        timeline: TimelineSection = TimelineSection::default();
        plain {
            /// The folder that relative paths start from; not part of the file.
            folder: PathBuf,
            /// Settings that the file gives and a groom would else choose.
            given: Given,
        }
    }
    prepare Scene::prepare;
}

impl Scene {
    /// Most solids beside the body: each point of the hair asks every one of them.
    pub const MAX_COLLIDERS: usize = 1024;
    /// Largest .png that gives strands colours or widths \[bytes\].
    pub const MAX_MAP_BYTES: u64 = 256 << 20;
    /// Its longest side \[pixels\].
    pub const MAX_MAP_SIDE: u32 = 8192;

    /// Sets defaults that depend on the file: a style brings the settings that it needs.
    /// Files that are older than `[devices]` name the devices elsewhere.
    fn prepare(&mut self, given: &<Self as Value>::Given) {
        if given.groom.as_ref().is_none_or(|groom| groom.file.is_none()) {
            let style = given.style.as_ref().and_then(|style| style.style);
            self.set_style(style.unwrap_or(self.style.style));
            let guides = given.style.as_ref().and_then(|style| style.strand_count);
            let bound = given.groom.as_ref().and_then(|groom| groom.bound);
            let guides = guides.unwrap_or(self.style.strand_count);
            self.look.follow_strands = groom::filling(guides, bound);
        } else {
            self.groom.points_per_strand = GroomSection::default().points_per_strand;
            self.level_of_detail.segments_per_span = LevelOfDetail::default().segments_per_span;
        }
        let look = given.look.as_ref();
        if look.is_some_and(|look| look.preset == Some(Preset::Thesis)) {
            self.dress_thesis();
        }
        let clump = look.and_then(|look| look.clump.as_ref());
        let (level, body_look) = (given.level_of_detail.as_ref(), given.body_look.as_ref());
        given.simulation.iter().for_each(|simulation| self.follow_simulation(simulation));
        self.given = Given {
            follow_strands: look.is_some_and(|look| look.follow_strands.is_some()),
            hair_count: look.is_some_and(|look| look.hair_count.is_some()),
            width_scale: look.is_some_and(|look| look.width_scale.is_some()),
            root_radius: clump.is_some_and(|clump| clump.root_radius.is_some()),
            tip_radius: clump.is_some_and(|clump| clump.tip_radius.is_some()),
            wave_amplitude: clump.is_some_and(|clump| clump.wave_amplitude.is_some()),
            points_per_strand: given.groom.as_ref().is_some_and(|groom| groom.points_per_strand.is_some()),
            segments_per_span: level.is_some_and(|level| level.segments_per_span.is_some()),
            full_distance: level.is_some_and(|level| level.full_distance.is_some()),
            spacing: given.body.as_ref().is_some_and(|body| body.spacing.is_some()),
            body_color: body_look.is_some_and(|look| look.color.is_some()),
            body_materials: body_look.is_some_and(|look| look.materials.is_some()),
            motion_name: given.motion.as_ref().is_some_and(|motion| motion.name.is_some()),
        };
        let simulation = given.simulation.as_ref().and_then(|simulation| simulation.backend);
        let pictures = given.picture.as_ref().and_then(|picture| picture.backend);
        self.devices.simulation = simulation.unwrap_or(self.devices.simulation);
        self.devices.pictures = pictures.unwrap_or(self.devices.pictures);
    }

    /// Loads a TOML file, or that of a project's folder.
    ///
    /// # Errors
    /// A file that cannot be read, is not TOML, or has an unknown key or a value of the wrong kind.
    pub fn load(path: &Path) -> Result<Self, Error> {
        let path = &*file_of(path);
        let text = read_plain(path, MAX_FILE_BYTES)
            .and_then(|bytes| String::from_utf8(bytes).map_err(std::io::Error::other))
            .map_err(|source| Error::ReadScene { path: path.to_owned(), source })?;
        let mut scene = Self::parse(&text, &path.display().to_string())?;
        scene.folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Ok(scene)
    }

    /// Reads TOML text; `origin` names it in errors. A colour may be written as `"#rrggbb"`, sRGB.
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn parse(text: &str, origin: &str) -> Result<Self, Error> {
        let scene: Self =
            toml::from_str(&colors::spelled_out(text, &Self::TABLE)).map_err(|error| Error::ParseScene {
                origin: origin.to_owned(),
                // It quotes the file.
                message: printable(error.to_string().trim_end()).into_owned(),
            })?;
        scene.check()?;
        Ok(scene)
    }

    /// The scene as TOML, every key spelled out.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("every section is plain data")
    }

    /// Checks every value, before anything is loaded or grown.
    ///
    /// # Errors
    /// The first value that is outside its range, by its key; pictures that would take too much memory;
    /// keyframes that are none; what the GPU that it names cannot do.
    pub fn check(&self) -> Result<(), Error> {
        for (key, count, most) in [
            ("colliders", self.colliders.len(), Self::MAX_COLLIDERS),
            ("lights", self.lights.len(), MAX_LIGHTS),
        ] {
            if count > most {
                return Err(SettingError::new(key, count, format!("{most} at most")).into());
            }
        }
        self.check_as("")?;
        self.check_belonging()?;
        self.picture.validate()?;
        self.motion.motion()?;
        self.wind.curve()?;
        camera_motion::curve(&self.camera.keyframes)?;
        solid_motion::solid_motions(&self.colliders, self.motion.interpolation)?;
        if matches!(self.devices.simulation, Backend::Gpu(_)) {
            self.simulation.check_on_gpu()?;
        }
        Ok(())
    }

    /// Checks that what belongs to a file is not given without it.
    fn check_belonging(&self) -> Result<(), Error> {
        let (further, part) = ("further files without a first one", "a part of a body without a file");
        let (no_groom, no_body) = (self.groom.file.is_none(), self.body.file.is_none());
        let no_motion = self.motion.name == MotionName::File && self.motion.file.is_none();
        for (key, missing, found, whole) in [
            ("groom.parts", no_groom && !self.groom.parts.is_empty(), further, "groom.file"),
            ("body.parts", no_body && !self.body.parts.is_empty(), further, "body.file"),
            ("body.scalp", no_body && self.body.scalp.is_some(), part, "body.file"),
            (
                "body.clip",
                no_body && self.body.clip.is_some(),
                "a clip of a body without a file",
                "body.file",
            ),
            (
                "body.teleports",
                no_body && !self.body.teleports.is_empty(),
                "marks without a body that moves",
                "body.file",
            ),
            ("motion.name", no_motion, "\"file\" without one", "motion.file"),
            (
                "motion.teleports",
                self.motion.file.is_none() && !self.motion.teleports.is_empty(),
                "marks without a motion of a file",
                "motion.file",
            ),
            (
                "body.vertices",
                no_body && self.body.vertices.is_some(),
                "a motion without a body",
                "body.file",
            ),
        ] {
            if missing {
                return Err(SettingError::new(key, found, format!("`{whole}` too")).into());
            }
        }
        if self.body.clip.is_some() && self.body.vertices.is_some() {
            let found = "a second motion of the body";
            return Err(SettingError::new("body.clip", found, "either `body.clip` or `body.vertices`").into());
        }
        if let Some(index) =
            self.body.parts.iter().position(|part| part.clip.is_none() && !part.teleports.is_empty())
        {
            let key = format!("body.parts[{index}].teleports");
            return Err(SettingError::new(key, "marks of a part that does not move", "`clip` too").into());
        }
        Ok(())
    }

    /// Lets hair and motion begin at their beginning, not where a saved scene has them: for other hair.
    pub fn begin_at_rest(&mut self) {
        (self.groom.pose, self.film.start, self.timeline.frames) = (None, 0.0, None);
    }

    /// Every path of the scene but those of the hair's pose and of kept frames.
    pub fn paths_mut(&mut self) -> impl Iterator<Item = &mut PathBuf> {
        let Self { groom, body, motion, look, surroundings, .. } = self;
        let named = [
            &mut groom.file,
            &mut groom.attributes,
            &mut body.file,
            &mut body.vertices,
            &mut motion.file,
            &mut body.collider_file,
            &mut surroundings.file,
            &mut look.color_map,
            &mut look.width_map,
        ];
        let of_groups = look.group.iter_mut().flat_map(|group| [&mut group.color_map, &mut group.width_map]);
        let parts = groom.parts.iter_mut().map(|part| &mut part.file);
        let parts = parts.chain(body.parts.iter_mut().map(|part| &mut part.file));
        named.into_iter().chain(of_groups).filter_map(Option::as_mut).chain(parts)
    }

    /// A path of the scene, from the scene's folder.
    pub(crate) fn path(&self, path: &Path) -> PathBuf {
        self.folder.join(path)
    }
}

/// Name of the scene in a project's folder.
pub const PROJECT_SCENE: &str = "scene.toml";

/// True where a path has the ending of a scene file, or is the folder of a project.
pub fn is_file(path: &Path) -> bool {
    let is_toml = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    is_toml && !path.is_dir() || path.join(PROJECT_SCENE).is_file()
}

/// The file of a scene: the path itself, or the file in it where it is a folder.
pub fn file_of(path: &Path) -> std::borrow::Cow<'_, Path> {
    if path.is_dir() { path.join(PROJECT_SCENE).into() } else { path.into() }
}
