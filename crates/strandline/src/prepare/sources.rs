//! Sources of a scene: what stands behind the names in it.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use strandline_base::SettingError;

use super::map::Map;
use crate::{
    Error, Scene,
    body::Mesh,
    groom::{
        Groom,
        format::{self, LoadOptions, Scale, Up},
    },
    render::Picture,
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
    maps: BTreeMap<PathBuf, Arc<Map>>,
}

impl Sources {
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
        let options = LoadOptions { strict: false, scale: Scale::Factor(1.0), up: Up::Y, per_strand };
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
        Ok(match self.meshes.get(name) {
            Some(mesh) => Mesh::clone(mesh).checked()?,
            None => Mesh::load(&scene.path(name), 1.0)?,
        })
    }

    /// The part of a mesh that has a name: of a mesh in memory the entry of that name.
    pub(super) fn mesh_part(&self, scene: &Scene, mesh: &Path, part: &str) -> Result<Option<Mesh>, Error> {
        if !self.meshes.contains_key(mesh) {
            return Ok(Mesh::load_part(&scene.path(mesh), part)?);
        }
        let part = self.meshes.get(Path::new(part));
        Ok(part.map(|mesh| Mesh::clone(mesh).checked()).transpose()?)
    }

    /// Names of the parts of a mesh: of a mesh in memory those of all entries.
    pub(super) fn part_names(&self, scene: &Scene, mesh: &Path) -> Result<Vec<String>, Error> {
        if !self.meshes.contains_key(mesh) {
            return Ok(Mesh::part_names(&scene.path(mesh))?);
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
        let unused = |name: &&PathBuf| !named.contains(name);
        let Some(name) = own.clone().find(unused) else { return Ok(()) };
        let listed = named.iter().map(|name| format!("`{}`", name.display())).collect::<Vec<_>>();
        let expected: &dyn Display =
            if listed.is_empty() { &"none: the scene names none" } else { &listed.join(", ") };
        let found = format!("`{}`", name.display());
        Err(SettingError::new("a source", found, format!("a name of the scene: {expected}")).into())
    }
}
