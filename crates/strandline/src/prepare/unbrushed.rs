//! Hair and body before the strokes of a brush, kept from one load to the next: a stroke reads no files and grows nothing.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use glam::Vec3;

use super::{Sources, loading::Loading, placing::Placings};
use crate::{
    Error, Scene,
    body::{Collider, Mesh, Shape},
    groom::Groom,
    render::Look,
};

/// Path, time of the last change and size of a file.
type Stamp = (PathBuf, Option<(SystemTime, u64)>);

/// A scene loaded up to its strokes.
pub(crate) struct Unbrushed {
    scene: Scene,
    files: Vec<Stamp>,
    notes: Vec<String>,
    groom: Option<Groom>,
    mesh: Option<Mesh>,
    part_starts: Vec<Option<usize>>,
    placings: Placings,
    is_grown: bool,
    shape: Option<Shape>,
    colliders: Vec<Collider>,
    pivot: Option<Vec3>,
}

impl Unbrushed {
    /// Keeps a scene before its strokes; `None` of a body that moves by itself, whose frames are many, and of sources in
    /// memory. `files` are those of the scene before it was read.
    pub(super) fn of(loading: &Loading, files: Vec<Stamp>) -> Option<Self> {
        let moves = loading.motion.is_some() || loading.part_motions.iter().any(Option::is_some);
        (loading.sources.is_empty() && !moves).then(|| Self {
            scene: loading.scene.clone(),
            files,
            notes: loading.notes.clone(),
            groom: loading.groom.clone(),
            mesh: loading.mesh.clone(),
            part_starts: loading.part_starts.clone(),
            placings: loading.placings.clone(),
            is_grown: loading.is_grown,
            shape: loading.shape.clone(),
            colliders: loading.colliders.clone(),
            pivot: loading.pivot,
        })
    }

    /// The state of loading a scene before its strokes, where that is the same as of the scene that was kept.
    ///
    /// # Errors
    /// As [`Loading::new`].
    pub(super) fn begin<'a>(
        &self,
        scene: &Scene,
        sources: &'a Sources,
        files: &[Stamp],
    ) -> Result<Option<Loading<'a>>, Error> {
        if !sources.is_empty() || files != self.files || !is_same_before_strokes(&self.scene, scene) {
            return Ok(None);
        }
        Ok(Some(Loading {
            notes: self.notes.clone(),
            groom: self.groom.clone(),
            mesh: self.mesh.clone(),
            part_starts: self.part_starts.clone(),
            placings: self.placings.clone(),
            is_grown: self.is_grown,
            shape: self.shape.clone(),
            colliders: self.colliders.clone(),
            pivot: self.pivot,
            ..Loading::new(scene, sources)?
        }))
    }
}

/// The files of a scene as they are now, and those that a .gltf or .obj may name in turn: .bin and .mtl beside it.
pub(super) fn stamps(scene: &Scene) -> Vec<Stamp> {
    let mut named = scene.clone();
    let paths: Vec<PathBuf> = named.paths_mut().map(|path| scene.path(path)).collect();
    let mut beside: Vec<PathBuf> = paths.iter().flat_map(|path| named_in_turn(path)).collect();
    beside.sort_unstable();
    beside.dedup();
    let stamp = |path: PathBuf| {
        let about = path.metadata().ok().and_then(|about| Some((about.modified().ok()?, about.len())));
        (path, about)
    };
    paths.into_iter().chain(beside).map(stamp).collect()
}

/// Files that one may name.
fn named_in_turn(path: &Path) -> Vec<PathBuf> {
    let is_of =
        |path: &Path, ending: &str| path.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending));
    let wanted = match path {
        path if is_of(path, "gltf") => "bin",
        path if is_of(path, "obj") => "mtl",
        _ => return Vec::new(),
    };
    let all = path.parent().and_then(|folder| folder.read_dir().ok()).into_iter().flatten().flatten();
    all.map(|entry| entry.path()).filter(|path| is_of(path, wanted)).collect()
}

/// True where the stages before the strokes do the same for both scenes, the first of which is fitted to its groom: what
/// they read of the second, and what they choose in it, is that of the first.
fn is_same_before_strokes(fitted: &Scene, scene: &Scene) -> bool {
    let mut near = fitted.clone();
    near.strokes.clone_from(&scene.strokes);
    near.groom.pose.clone_from(&scene.groom.pose);
    near.groom.length = scene.groom.length;
    near.film = scene.film;
    near.timeline.clone_from(&scene.timeline);
    near.picture = scene.picture;
    near.camera.clone_from(&scene.camera);
    near.lights.clone_from(&scene.lights);
    near.wind.clone_from(&scene.wind);
    near.simulation.clone_from(&scene.simulation);
    near.devices = scene.devices;
    // Numbers of drawn strands and widths are fitted to the groom.
    let Look { fibre, tip_color, root_color, tip_width, highlight_noise, grey, .. } = scene.look.clone();
    near.look = Look { fibre, tip_color, root_color, tip_width, highlight_noise, grey, ..near.look };
    near == *scene
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{Prepared, groom::Stroke};

    #[test]
    fn a_stroke_after_a_load_makes_the_hair_of_a_whole_load_to_the_bit() {
        let folder = tempfile::tempdir().unwrap();
        let mut scene = Scene::demo();
        (scene.style.strand_count, scene.body.spacing) = (80, 0.02);
        let groom = folder.path().join("hair.hair");
        let mut of_file = scene.clone();
        of_file.style.grow().unwrap().save(&groom).unwrap();
        of_file.groom.file = Some(groom.clone());
        for scene in [scene, of_file] {
            let (sources, mut kept) = (Sources::default(), None);
            let mut now = Prepared::after(&scene, &sources, &mut kept).unwrap().scene;
            let first = kept.clone().unwrap();
            now.look.grey = 0.5;
            let unbrushed = Prepared::after(&now, &sources, &mut kept).unwrap();
            let roots =
                (0..unbrushed.guides.strand_count()).map(|strand| unbrushed.guides.position(strand, 0));
            let position = roots.max_by(|one, other| one.y.total_cmp(&other.y)).unwrap();
            for strength in [1.0, 0.4] {
                let motion = Vec3::new(0.03, 0.0, 0.0);
                now.strokes.push(Stroke { position, motion, radius: 0.06, strength, ..Stroke::default() });
                let found = Prepared::after(&now, &sources, &mut kept).unwrap();
                let whole = Prepared::new(&now).unwrap();
                assert!(found.guides.positions() == whole.guides.positions());
                assert!(found.guides.positions() != unbrushed.guides.positions(), "the stroke does nothing");
                assert_eq!(found.bound.is_some(), whole.bound.is_some());
                assert!(found.scene == whole.scene);
            }
            assert!(Arc::ptr_eq(&first, kept.as_ref().unwrap()), "it was loaded again");
            // Another body is another load.
            now.body.spacing = 0.021;
            Prepared::after(&now, &sources, &mut kept).unwrap();
            assert!(!Arc::ptr_eq(&first, kept.as_ref().unwrap()));
        }
        let mut now = Scene::demo();
        (now.style.strand_count, now.groom.file, now.body.spacing) = (80, Some(groom.clone()), 0.02);
        let (sources, mut kept) = (Sources::default(), None);
        Prepared::after(&now, &sources, &mut kept).unwrap();
        let first = kept.clone().unwrap();
        now.style.grow().unwrap().select(&[1, 2, 3, 4, 5, 6, 7, 8, 9]).save(&groom).unwrap();
        assert_eq!(Prepared::after(&now, &sources, &mut kept).unwrap().guides.strand_count(), 9);
        assert!(!Arc::ptr_eq(&first, kept.as_ref().unwrap()), "a file that changed is read");
    }
}
