//! Sources of a scene: what stands behind the names in it.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::Vec3;
use strandline_base::SettingError;

use super::map::Map;
use super::placing::Defined;
use crate::{
    Error, Scene,
    body::{Mesh, MeshFormat, VertexMotion},
    groom::{
        Groom,
        format::{self, Cleaning, Format, LoadOptions, Scale, Up},
    },
    render::Picture,
    scene::TeleportSection,
};

/// Grooms, meshes and maps in memory, each under a name.
///
/// A scene names its grooms, meshes and maps. A name that is listed here stands for the entry of this list, any other
/// name for a file. Both kinds are placed, fitted and checked alike: units, axes and front are guessed from the same
/// properties, and the sections `[groom]` and `[body]` overrule the guesses. `look.surroundings` is given to the scene
/// itself.
///
/// ```
/// # fn main() -> Result<(), strandline::Error> {
/// # let mut groom = strandline::Groom::empty(8e-5);
/// # groom.push((0..16).map(|point| glam::Vec3::new(0.0, 0.01 * point as f32, 0.0)));
/// use strandline::{Hair, Scene, Sources};
///
/// let mut scene = Scene::default();
/// scene.groom.file = Some("mine".into());
/// let sources = Sources::default().with_groom("mine", groom);
/// let hair = Hair::from_sources(&scene, &sources)?;
/// # assert_eq!(hair.guides().strand_count(), 1);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Default)]
pub struct Sources {
    grooms: BTreeMap<PathBuf, Arc<Groom>>,
    meshes: BTreeMap<PathBuf, Arc<Mesh>>,
    motions: BTreeMap<PathBuf, VertexMotion>,
    maps: BTreeMap<PathBuf, Arc<Map>>,
}

/// A body, its motion where it has one, and notes.
type Body = (Mesh, Option<VertexMotion>, Vec<String>);

impl Sources {
    /// True for the name of a mesh in memory.
    pub(super) fn has_mesh(&self, name: &Path) -> bool {
        self.meshes.contains_key(name)
    }

    /// True where nothing is in memory.
    pub(super) fn is_empty(&self) -> bool {
        let Self { grooms, meshes, motions, maps } = self;
        grooms.is_empty() && meshes.is_empty() && motions.is_empty() && maps.is_empty()
    }

    /// Adds a groom, in its own units and axes: for `groom.file` and `groom.parts[..].file`.
    #[must_use]
    pub fn with_groom(mut self, name: impl Into<PathBuf>, groom: impl Into<Arc<Groom>>) -> Self {
        self.grooms.insert(name.into(), groom.into());
        self
    }

    /// Adds a mesh, in its own units and axes: for `body.file`, `body.parts[..].file`, `body.collider_file`, and for
    /// `body.scalp` where the body is in memory too.
    #[must_use]
    pub fn with_mesh(mut self, name: impl Into<PathBuf>, mesh: impl Into<Arc<Mesh>>) -> Self {
        self.meshes.insert(name.into(), mesh.into());
        self
    }

    /// Adds the motion of the vertices of the mesh for `body.file`, by the name of that mesh, in its units and axes; the
    /// mesh may be in memory or in a file.
    #[must_use]
    pub fn with_motion(mut self, name: impl Into<PathBuf>, motion: VertexMotion) -> Self {
        self.motions.insert(name.into(), motion);
        self
    }

    /// Adds a picture over the scalp, sRGB, the first row at v = 1: for `look.color_map` and `look.width_map`, and those
    /// of groups.
    ///
    /// # Errors
    /// A picture without pixels, with more than [`Scene::MAX_MAP_SIDE`] on a side, or of another length than its size.
    pub fn with_map(mut self, name: impl Into<PathBuf>, picture: &Picture) -> Result<Self, Error> {
        let name = name.into();
        let map = Map::of_picture(picture).map_err(|message| Error::map(&name, message))?;
        self.maps.insert(name, Arc::new(map));
        Ok(self)
    }

    /// A groom, in its own units and axes, with a note for each problem that was mended.
    pub(super) fn groom(
        &self,
        scene: &Scene,
        name: &Path,
        per_strand: Option<u32>,
    ) -> Result<(Groom, Vec<String>), Error> {
        let options = LoadOptions {
            strict: false,
            scale: Scale::Factor(1.0),
            up: Up::Y,
            turn: Vec3::ZERO,
            per_strand,
            frame: scene.groom.frame,
            root_end: scene.groom.root_end,
            cleaning: Cleaning::Strays,
        };
        let loaded = match self.grooms.get(name) {
            Some(groom) => {
                groom.check_lengths()?;
                format::sieved(Groom::clone(groom), &options)?
            }
            None => format::load(&scene.path(name), &options)?,
        };
        let noted = |problem: &String| format!("{}: {problem}", name.display());
        Ok((loaded.groom, loaded.report.problems.iter().map(noted).collect()))
    }

    /// A mesh, in its own units and axes.
    pub(super) fn mesh(&self, scene: &Scene, name: &Path) -> Result<Mesh, Error> {
        Ok(self.mesh_noted(scene, name)?.0)
    }

    /// A mesh, in its own units and axes, with a note on all that is odd.
    pub(super) fn mesh_noted(&self, scene: &Scene, name: &Path) -> Result<(Mesh, Vec<String>), Error> {
        let (mesh, notes) = match self.meshes.get(name) {
            Some(mesh) => (Mesh::clone(mesh).checked()?, Vec::new()),
            None => Mesh::load_noted(&scene.path(name), 1.0)?,
        };
        let noted = |note: String| format!("{}: {note}", name.display());
        Ok((mesh, notes.into_iter().map(noted).collect()))
    }

    /// The body in its own units and axes, its motion where it has one, and notes.
    pub(super) fn body(&self, scene: &Scene, name: &Path) -> Result<Body, Error> {
        let own = self.motions.get(name).cloned();
        let (body, path) = (&scene.body, scene.path(name));
        let Some(clip) = &body.clip else {
            if !self.meshes.contains_key(name) && Mesh::is_sequence(&path) {
                if body.vertices.is_some() {
                    let found = "a second motion of the body";
                    let expected = "either the frames of `body.file` or `body.vertices`";
                    return Err(SettingError::new("body.vertices", found, expected).into());
                }
                let (mesh, motion, notes) = Mesh::load_sequence_noted(&path, body.frames_per_second)?;
                let noted = |note: String| format!("{}: {note}", name.display());
                return Ok((mesh, Some(motion), notes.into_iter().map(noted).collect()));
            }
            let (mesh, notes) = self.mesh_noted(scene, name)?;
            let file = (!self.meshes.contains_key(name)).then_some(&*path);
            let load = |vertices: &PathBuf| {
                VertexMotion::load(&scene.path(vertices), &mesh, file, body.frames_per_second)
            };
            let motion = body.vertices.as_ref().map(load).transpose()?;
            let own = own.map(|motion| motion.with_rest(&mesh.positions));
            return Ok((mesh, motion.or(own), notes));
        };
        if self.meshes.contains_key(name) {
            let found = "a clip of a body in memory";
            return Err(SettingError::new("body.clip", found, "a motion among the sources").into());
        }
        let (mesh, motion, notes) = moving(&path, clip, "body.clip")?;
        let noted = |note: String| format!("{}: {note}", name.display());
        Ok((mesh, Some(motion), notes.into_iter().map(noted).collect()))
    }

    /// A part of the body in its own units and axes, its motion where it has a clip, and notes.
    pub(super) fn part(&self, scene: &Scene, index: usize) -> Result<Body, Error> {
        let part = &scene.body.parts[index];
        let Some(clip) = &part.clip else {
            let (mesh, notes) = self.mesh_noted(scene, &part.file)?;
            return Ok((mesh, None, notes));
        };
        if self.meshes.contains_key(&part.file) {
            let key = format!("body.parts[{index}].clip");
            return Err(SettingError::new(key, "a clip of a mesh in memory", "a part from a file").into());
        }
        let key = format!("body.parts[{index}].clip");
        let (mesh, motion, mut notes) = moving(&scene.path(&part.file), clip, &key)?;
        let motion = motion.with_teleports(&TeleportSection::times(&part.teleports))?;
        if !part.visible {
            notes.push(format!("the clip `{clip}` is not played: the part is not drawn"));
        }
        let noted = |note: String| format!("{}: {note}", part.file.display());
        Ok((mesh, Some(motion), notes.into_iter().map(noted).collect()))
    }

    /// Definitions that the format of a mesh makes; none for a mesh in memory. Earlier avatars look along -z, later ones
    /// along +z.
    pub(super) fn defined(&self, name: &Path) -> Defined {
        let format = MeshFormat::of(name).ok().filter(|_| !self.meshes.contains_key(name));
        match format {
            Some(format) if !format.defines_space() => Defined::Nothing,
            Some(_) if name.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("vrm")) => {
                Defined::Up
            }
            Some(_) => Defined::All,
            None => Defined::Nothing,
        }
    }

    /// True where the format of a scene's groom defines units and axes, which its reader brings to metres and y up; never
    /// for a groom in memory.
    pub(super) fn defines_groom(&self, scene: &Scene) -> bool {
        let file = scene.groom.file.as_ref().filter(|file| !self.grooms.contains_key(*file));
        file.and_then(|file| Format::of(file).ok()).is_some_and(|format| format.defines_space)
    }

    /// The part of a mesh that has a name: of a mesh in memory the entry of that name.
    pub(super) fn mesh_part(&self, scene: &Scene, mesh: &Path, part: &str) -> Result<Option<Mesh>, Error> {
        if !self.meshes.contains_key(mesh) {
            let path = scene.path(mesh);
            return if Mesh::is_sequence(&path) { Ok(None) } else { Ok(Mesh::load_part(&path, part)?) };
        }
        let part = self.meshes.get(Path::new(part));
        Ok(part.map(|mesh| Mesh::clone(mesh).checked()).transpose()?)
    }

    /// Names of the parts of a mesh: of a mesh in memory those of all entries.
    pub(super) fn part_names(&self, scene: &Scene, mesh: &Path) -> Result<Vec<String>, Error> {
        if !self.meshes.contains_key(mesh) {
            // A body in motion has no parts with names.
            let path = scene.path(mesh);
            return if Mesh::is_sequence(&path) { Ok(Vec::new()) } else { Ok(Mesh::part_names(&path)?) };
        }
        Ok(self.meshes.keys().map(|name| name.display().to_string()).collect())
    }

    /// A map over the scalp.
    pub(super) fn map(&self, scene: &Scene, name: &Path) -> Result<Arc<Map>, Error> {
        match self.maps.get(name) {
            Some(map) => Ok(map.clone()),
            None => Map::load(&scene.path(name)).map(Arc::new),
        }
    }

    /// Refuses entries that the scene does not name: a misspelt name would stand for a file.
    pub(super) fn check(&self, scene: &Scene) -> Result<(), Error> {
        let mut named: Vec<PathBuf> = scene.clone().paths_mut().map(|path| path.clone()).collect();
        named.extend(scene.body.scalp.as_ref().map(PathBuf::from));
        let own = self.grooms.keys().chain(self.meshes.keys()).chain(self.maps.keys());
        let own = own.chain(self.motions.keys());
        let unused = |name: &&PathBuf| !named.contains(name);
        let Some(name) = own.clone().find(unused) else { return Ok(()) };
        let listed = named.iter().map(|name| format!("`{}`", name.display())).collect::<Vec<_>>();
        let expected: &dyn Display =
            if listed.is_empty() { &"none: the scene names none" } else { &listed.join(", ") };
        let found = format!("`{}`", name.display());
        Err(SettingError::new("a source", found, format!("a name of the scene: {expected}")).into())
    }
}

/// Clips that a message lists.
const LISTED: usize = 20;

/// A mesh that a clip moves; `key` names the clip.
fn moving(path: &Path, clip: &str, key: &str) -> Result<(Mesh, VertexMotion, Vec<String>), Error> {
    Mesh::load_moving(path, clip)
        .map_err(|error| unknown(path, clip, key).map_or_else(|| error.into(), Into::into))
}

/// The refusal of a clip that a file with clips lacks.
fn unknown(path: &Path, clip: &str, key: &str) -> Option<SettingError> {
    let names = Mesh::clip_names(path).ok()?;
    if names.is_empty() || names.iter().any(|name| name.eq_ignore_ascii_case(clip)) {
        return None;
    }
    let listed: Vec<String> = names.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
    let more =
        if names.len() > LISTED { format!(" and {} more", names.len() - LISTED) } else { String::new() };
    let expected = format!("a clip of {}: {}{more}", path.display(), listed.join(", "));
    Some(SettingError::new(key, format!("`{clip}`"), expected))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Prepared, body::Mannequin};

    /// Hair in centimetres on the mannequin in millimetres, as files and in memory.
    fn both(folder: &Path) -> [(Scene, Sources); 2] {
        let mut style = crate::groom::StyleSettings::new(crate::Style::Bob);
        style.strand_count = 60;
        let mut groom = style.grow().unwrap();
        groom.transform(100.0, glam::Quat::IDENTITY, Vec3::ZERO);
        let mut mesh = Mannequin::new().mesh();
        mesh.positions.iter_mut().for_each(|place| *place *= 1000.0);
        let text: String =
            mesh.positions.iter().map(|place| format!("v {} {} {}\n", place.x, place.y, place.z)).collect();
        let faces = mesh.triangles.iter().map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1));
        std::fs::write(folder.join("head.obj"), text + &faces.collect::<String>()).unwrap();
        format::save(&groom, &folder.join("bob.hair")).unwrap();
        let groom = format::load(
            &folder.join("bob.hair"),
            &LoadOptions { scale: Scale::Factor(1.0), ..LoadOptions::default() },
        );
        let mesh = Mesh::load(&folder.join("head.obj"), 1.0).unwrap();
        let scene = |names: [PathBuf; 2]| {
            let [groom, body] = names.map(Some);
            let mut scene = Scene::default();
            (scene.groom.file, scene.body.file, scene.body.spacing) = (groom, body, 0.01);
            scene
        };
        let sources = Sources::default().with_groom("bob", groom.unwrap().groom).with_mesh("head", mesh);
        let files = ["bob.hair", "head.obj"].map(|name| folder.join(name));
        [(scene(files), Sources::default()), (scene(["bob", "head"].map(PathBuf::from)), sources)]
    }

    #[test]
    fn a_scene_in_memory_is_placed_and_fitted_as_one_of_files() {
        let folder = tempfile::tempdir().unwrap();
        let loaded =
            both(folder.path()).map(|(scene, sources)| Prepared::from_sources(&scene, &sources).unwrap());
        let [file, memory] = &loaded;
        assert!(file.guides.positions() == memory.guides.positions(), "other strands");
        assert!(file.bounds.min == memory.bounds.min && file.bounds.max == memory.bounds.max, "another body");
        assert!(memory.bounds.max.y < 1.0, "metres, not {}", memory.bounds.max);
        let [mut of_file, of_memory] = [&file.scene, &memory.scene].map(Scene::clone);
        (of_file.groom.file, of_file.body.file) = (of_memory.groom.file.clone(), of_memory.body.file.clone());
        assert_eq!(of_file, of_memory);
        assert_eq!(file.notes, memory.notes);
        assert!(file.notes.iter().any(|note| note.contains("unit")), "{:?}", file.notes);
    }

    #[test]
    fn sources_that_are_not_named_or_not_sound_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let [_, (scene, sources)] = both(folder.path());
        let refused = |scene: &Scene, sources: &Sources| match Prepared::from_sources(scene, sources) {
            Ok(_) => panic!("it was taken"),
            Err(error) => error.to_string(),
        };
        let mut misspelt = scene.clone();
        misspelt.groom.file = Some("bobb".into());
        let error = refused(&misspelt, &sources);
        assert!(error.contains("`bob`") && error.contains("`bobb`, `head`"), "{error}");
        let mut torn = Groom::empty(8e-5);
        torn.push([Vec3::ZERO, Vec3::Y]);
        torn.starts[1] = 7;
        let error = refused(&scene, &sources.clone().with_groom("bob", torn));
        assert!(error.contains("rising from 0 to 2"), "{error}");
        let mut bare = Groom::empty(8e-5);
        bare.push([Vec3::ZERO, Vec3::Y]);
        bare.colors = Some(vec![[0.5; 3]]);
        let error = refused(&scene, &sources.clone().with_groom("bob", bare));
        assert!(error.contains("groom.colors is 1 entries"), "{error}");
        let flat = Mesh { positions: vec![Vec3::ZERO], triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let error = refused(&scene, &sources.clone().with_mesh("head", flat));
        assert!(error.contains("vertices 0, 1, 2 of 1"), "{error}");
        let picture = Picture { width: 2, height: 2, pixels: vec![0; 11], alpha: None };
        let error = sources.with_map("map", &picture).err().unwrap().to_string();
        assert!(error.contains("2 x 2 pixels in 11 bytes"), "{error}");
    }
}
