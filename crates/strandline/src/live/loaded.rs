//! A scene that plays.

use std::io::Write;
use std::path::{Path, PathBuf};

use std::sync::Arc;

use strandline_base::WholeFile;

use super::messages::LoadStage;
use super::overlaid::{Overlaid, sketch};
use super::project;
use super::timeline::Timeline;
use crate::{
    Camera, Error, Prepared, Scene, Sources,
    body::Solids,
    prepare::Unbrushed,
    session::worker::Worker,
    session::{Session, Simulation},
    snapshot::files::write_pose,
};

/// A scene that plays.
pub(super) struct Loaded {
    pub session: Session<Worker<Simulation>>,
    /// Notes for a person.
    pub notes: Vec<String>,
    /// The frames that are kept.
    pub timeline: Timeline,
    /// True where the hair goes back to its beginning with the tasks that were started.
    pub(super) resets: bool,
    /// The solids that hair hits.
    pub(super) solids: Solids,
}

/// Receiver of the stage that a load comes to, with the hair and its camera once they are there.
pub(super) type Tell<'a> = &'a dyn Fn(LoadStage, Option<(Arc<Overlaid>, Camera)>);

impl Loaded {
    /// Loads a scene; `kept` has what a load of the same scene with other strokes left.
    pub fn new(
        scene: &Scene,
        sources: &Sources,
        kept: &mut Option<Arc<Unbrushed>>,
        tell: Tell,
    ) -> Result<Self, Error> {
        tell(LoadStage::Growing, None);
        let mut prepared = Prepared::after(scene, sources, kept)?;
        let mut notes = std::mem::take(&mut prepared.notes);
        let aspect = scene.picture.width as f32 / scene.picture.height.max(1) as f32;
        let sketched = (Arc::new(sketch(&prepared, aspect)), prepared.camera(aspect));
        tell(LoadStage::Opening, Some(sketched));
        let mut session = Session::open(prepared, scene.devices)?;
        session.keep_frames();
        let film = session.scene().film;
        let last = film.frames - u32::from(session.scene().groom.pose.is_some());
        let mut timeline = Timeline::new(&session.scene().timeline, last);
        if scene.timeline.frames.is_some() {
            tell(LoadStage::Reading, None);
        }
        let (goes_on, told) = project::open(scene, &mut session, &mut timeline);
        notes.extend(told);
        session.begin_without_frames();
        if !goes_on {
            tell(LoadStage::Settling, None);
            session.settle()?;
        }
        notes.extend(session.take_notes());
        session.follow_camera();
        let solids = session.colliders().iter().cloned();
        let solids = Solids::new(solids.map(|solid| (solid, 0.0)));
        let session = session.beside()?;
        let mut loaded = Self { session, notes, timeline, resets: false, solids };
        if goes_on {
            loaded.show(loaded.timeline.playhead)?;
        } else {
            let note = loaded.begin()?;
            loaded.notes.extend(note);
        }
        Ok(loaded)
    }

    /// Saves a scene that begins with the hair as it is, and with the motion at the time that it is at; all
    /// results of the simulation have been taken.
    ///
    /// # Errors
    /// A file cannot be written; then what was there before stays, unless only the last renaming fails.
    pub fn save(&mut self, mut scene: Scene, path: &Path) -> Result<(), Error> {
        self.come_to_playhead()?;
        while self.session.started() > 0 {
            self.session.take()?;
        }
        let pose_path = pose_path(path);
        let pose = write_pose(&self.session.with(Simulation::hair_pose)?, &pose_path)?;
        scene.film.start = self.session.time_shown();
        scene.groom.pose = pose_path.file_name().map(PathBuf::from);
        let text = scene.to_toml();
        let scene = WholeFile::write(path, |file| file.write_all(text.as_bytes()));
        let failed = |path| Error::save("the scene", path);
        let scene = scene.map_err(failed(path))?;
        pose.keep().map_err(Error::save("the hair", &pose_path))?;
        scene.keep().map_err(failed(path))
    }
}

/// Path of the pose of a scene's hair: beside the scene, and not over a file that is not its own.
fn pose_path(scene: &Path) -> PathBuf {
    let folder = scene.parent().unwrap_or(Path::new(""));
    let before = Scene::load(scene).ok().and_then(|before| before.groom.pose).map(|pose| folder.join(pose));
    let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
    let name = |number: u32| match number {
        0 => format!("{stem}_pose.npz"),
        number => format!("{stem}_pose_{number}.npz"),
    };
    let mut paths = (0..).map(|number| folder.join(name(number)));
    paths.find(|path| !path.exists() || Some(path) == before.as_ref()).unwrap_or_default()
}
