//! A scene that plays.

use std::io::Write;
use std::path::{Path, PathBuf};

use strandline_base::WholeFile;

use crate::{
    Error, Scene,
    prepare::Prepared,
    session::{Session, Simulation},
    worker::Worker,
};

/// A scene that plays.
pub(super) struct Loaded {
    pub session: Session<Worker<Simulation>>,
    /// The scene as it was loaded, with what it left open.
    pub scene: Box<Scene>,
    /// What a person should read.
    pub notes: Vec<String>,
}

impl Loaded {
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        let mut prepared = Prepared::new(scene)?;
        let mut notes = std::mem::take(&mut prepared.notes);
        let scene = Box::new(prepared.scene.clone());
        let mut session = Session::of_scene(&scene, prepared, scene.devices)?;
        notes.extend(session.take_notes());
        Ok(Self { session: session.beside()?, scene, notes })
    }

    /// Saves a scene that begins with the hair as it is, and with the motion at the time that it is at; all
    /// results of the simulation have been taken.
    ///
    /// # Errors
    /// A file cannot be written; then what was there before stays, unless only the last renaming fails.
    pub fn save(&self, mut scene: Scene, path: &Path) -> Result<(), Error> {
        let pose_path = pose_path(path);
        let mut simulation = self.session.place.work();
        let pose = simulation.hair_pose()?.write(&pose_path)?;
        let step = f64::from(simulation.engine.model().settings().time_step);
        drop(simulation);
        scene.film.start = self.session.direction.time_shown(step);
        scene.groom.pose = pose_path.file_name().map(PathBuf::from);
        let text = scene.to_toml();
        let scene = WholeFile::write(path, |file| file.write_all(text.as_bytes()));
        let failed = |path| Error::save("the scene", path);
        let scene = scene.map_err(failed(path))?;
        pose.keep().map_err(Error::save("the hair", &pose_path))?;
        scene.keep().map_err(failed(path))
    }
}

/// Where the pose of a scene's hair is saved: beside it, and not over a file that is not its own.
fn pose_path(scene: &Path) -> PathBuf {
    let folder = scene.parent().unwrap_or(Path::new(""));
    let before = Scene::load(scene).ok().and_then(|before| before.groom.pose).map(|pose| folder.join(pose));
    let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
    let name = |number: u32| match number {
        0 => format!("{stem}.safetensors"),
        number => format!("{stem}_{number}.safetensors"),
    };
    let mut paths = (0..).map(|number| folder.join(name(number)));
    paths.find(|path| !path.exists() || Some(path) == before.as_ref()).unwrap_or_default()
}
