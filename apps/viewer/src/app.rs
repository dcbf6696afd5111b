use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use eframe::egui;
use glam::Vec3;
use strandline::{
    Backend, Camera, Change, Error, Live, PictureSettings, Scene,
    edit::{History, is_look, load_look, mends},
    format::{Format, endings},
    live::{Command, Overlay, Shown},
    mesh::MeshFormat,
    settings::{SettingError, Stroke},
};

use crate::{
    clip_names, compared, export, files, found, notes, playback, recent, rescue, saves, stages, typed,
    watched,
};

/// The window's state: the scene that plays, and the changes of the user.
pub struct App {
    pub(crate) live: Live,
    /// The window, once it is there: the scene is loaded before.
    pub(crate) context: Arc<OnceLock<egui::Context>>,
    /// The scene as shown; it can be saved at any time.
    pub(crate) scene: Scene,
    /// The scene as it was loaded: the defaults of the controls.
    pub(crate) base: Scene,
    pub(crate) camera: Camera,
    /// True while the view follows the keyframes of the camera, and the number of the last command that moved it by hand.
    pub(crate) follows: bool,
    pub(crate) looked: u64,
    /// The view of the scene.
    pub(crate) home: Camera,
    /// Middle of hair and body at rest \[m\].
    pub(crate) center: Vec3,
    pub(crate) playing: bool,
    /// Action of the mouse without a key.
    pub(crate) tool: Tool,
    /// Position of a drag in the picture at the last pass.
    pub(crate) dragged_to: Option<egui::Pos2>,
    /// True while the mouse holds hair, and the radius \[m\] of the hand.
    pub(crate) grabs: bool,
    pub(crate) radius: f32,
    /// The brush in hand, and the place where its stroke began.
    pub(crate) stroke: Stroke,
    pub(crate) brushed_from: Option<egui::Pos2>,
    /// True while a scene loads that is seen from where the last one was.
    pub(crate) keeps_view: bool,
    /// The scene that is on its way, and the number of its command.
    pub(crate) pending: Option<(u64, Box<Scene>)>,
    pub(crate) error: Option<String>,
    /// The mends that the last error names.
    pub(crate) mended: notes::Mended,
    pub(crate) notes: notes::Notes,
    /// The overlay over the picture.
    pub(crate) overlay: Option<Overlay>,
    /// The stage of the scene that is on its way.
    pub(crate) loading: Option<stages::Loading>,
    pub(crate) watch: watched::Watch,
    pub(crate) shown: Option<Shown>,
    pub(crate) texture: Option<egui::TextureHandle>,
    /// Pictures a second, smoothed.
    pub(crate) rate: f32,
    pub(crate) last: Option<Instant>,
    pub(crate) typed: typed::Typed,
    /// True if pictures may be simpler while the hair moves.
    pub(crate) adapts: bool,
    /// True while a video is recorded, and the number of videos that are being finished.
    pub(crate) recording: bool,
    pub(crate) finishing: u32,
    /// Number of the load that the scene comes from.
    pub(crate) loaded: u64,
    pub(crate) saves: saves::Saves,
    /// The scene as shown, for a window that stops in an error, and the time when it was kept.
    pub(crate) kept: rescue::Kept,
    pub(crate) kept_at: Option<Instant>,
    /// Number of the last step requested by dragging while nothing plays, and whether another one
    /// is wanted once its picture is there.
    pub(crate) stepped: u64,
    pub(crate) wants_step: bool,
    pub(crate) dialog: Option<files::Dialog>,
    /// Moving hair that is being written, and its part of the film.
    pub(crate) exporting: Option<export::Export>,
    pub(crate) export_wanted: export::Wanted,
    /// Steps that can be undone, and true while an undone scene is loaded.
    pub(crate) history: History,
    pub(crate) restoring: bool,
    /// True until the first scene is there.
    pub(crate) loads_first: bool,
    pub(crate) playback: playback::Playback,
    pub(crate) finding: found::Finding,
    pub(crate) recent: recent::Recent,
    pub(crate) compare: Option<compared::Compare>,
    /// Clips of the files of the body, by the setting that chooses one.
    pub(crate) clips: BTreeMap<String, clip_names::Clips>,
    /// Folder of the next picture and scene.
    pub folder: PathBuf,
}

/// Delay after which a new picture is shown.
const SOON: Duration = Duration::from_millis(1);

/// Action of the mouse in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Goes around the head.
    #[default]
    Orbit,
    /// Takes hair into a hand.
    Grab,
    /// Turns the head.
    Turn,
    /// Changes hair at rest.
    Brush,
}

/// Asks the window for another pass, once it is there. An immediate one would be two passes, the second one useless.
fn waker(context: Arc<OnceLock<egui::Context>>) -> impl Fn() + Send + 'static {
    move || context.get().into_iter().for_each(|context| context.request_repaint_after(SOON))
}

impl App {
    /// Radius of the hand \[m\] to begin with.
    pub(crate) const RADIUS: f32 = 0.012;

    /// Starts to play a scene.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn new(scene: Scene) -> Result<Self, Error> {
        let context = Arc::new(OnceLock::<egui::Context>::new());
        let live = Live::new(scene.clone(), waker(context.clone()))?;
        live.send(Command::Adapt(true));
        let app = Self {
            history: History::new(&scene),
            restoring: false,
            loads_first: true,
            playback: playback::Playback::default(),
            finding: found::Finding::default(),
            recent: recent::Recent::default(),
            compare: None,
            clips: BTreeMap::new(),
            live,
            context,
            base: scene.clone(),
            scene: scene.clone(),
            camera: Camera::front(),
            follows: false,
            looked: 0,
            home: Camera::front(),
            center: Vec3::ZERO,
            playing: true,
            tool: Tool::default(),
            dragged_to: None,
            grabs: false,
            radius: Self::RADIUS,
            stroke: Stroke::default(),
            brushed_from: None,
            keeps_view: false,
            pending: Some((1, Box::new(scene))),
            error: None,
            mended: notes::Mended::default(),
            notes: notes::Notes::default(),
            overlay: None,
            loading: None,
            watch: watched::Watch::default(),
            shown: None,
            texture: None,
            rate: 0.0,
            last: None,
            typed: typed::Typed::default(),
            adapts: true,
            recording: false,
            finishing: 0,
            loaded: 0,
            saves: saves::Saves::default(),
            kept: rescue::Kept::default(),
            kept_at: None,
            stepped: 0,
            wants_step: false,
            dialog: None,
            exporting: None,
            export_wanted: export::Wanted::default(),
            folder: PathBuf::from("out"),
        };
        app.send_playback();
        Ok(app)
    }

    /// The scene that a file stands for: itself, or `scene` with another groom or body.
    ///
    /// # Errors
    /// A scene that cannot be read; a file of another kind.
    pub fn scene_of(scene: &Scene, file: &Path) -> Result<Scene, Error> {
        if file.is_dir() {
            return Scene::load(file);
        }
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let mut scene = scene.clone();
        let absolute = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
        match ending.as_deref() {
            Some("toml") if is_look(file) => return load_look(&scene, file),
            Some("toml") => return Scene::load(file),
            _ if MeshFormat::is_of(file) => {
                scene.body.file = Some(absolute);
                scene.body.parts.clear();
            }
            _ if Format::is_of(file) => {
                scene.groom.file = Some(absolute);
                scene.groom.parts.clear();
            }
            _ => {
                let grooms = endings(|_| true);
                let expected = format!(
                    "a .toml scene, a {grooms} groom, or an .obj, .gltf, .glb, .vrm, .ply or .stl body"
                );
                return Err(SettingError::new("the file", file.display(), expected).into());
            }
        }
        scene.begin_at_rest();
        Ok(scene)
    }

    pub(crate) fn send_look(&self) {
        self.live.send(Change::Look(Box::new(self.scene.look.clone())));
    }

    /// Goes on, or stands still.
    pub(crate) fn play(&mut self, playing: bool) {
        self.playing = playing;
        self.live.send(Command::Play(playing));
    }

    /// Shows a line for a while.
    pub(crate) fn note(&mut self, text: String) {
        let mends = mends(&text, &self.scene);
        self.notes.add(text, mends);
    }

    /// Has pictures drawn as the scene says, with something behind them.
    pub(crate) fn send_picture(&self) {
        self.live.send(Change::Picture(PictureSettings { transparent: false, ..self.scene.picture }));
    }

    pub(crate) fn send_motion(&mut self) {
        self.live.send(Change::Motion(Box::new(self.scene.motion.clone())));
        self.step_on();
    }

    /// Advances by a frame while nothing plays, so that hair follows a drag; one frame at a time.
    pub(crate) fn step_on(&mut self) {
        let drawn = self.shown.as_ref().map_or(0, |shown| shown.drawn_after_command);
        self.wants_step = !self.playing && self.stepped > drawn;
        if !self.playing && !self.wants_step {
            self.stepped = self.live.send(Command::Step);
        }
    }

    /// The newest picture, if there is one.
    pub fn shown(&self) -> Option<&Shown> {
        self.shown.as_ref()
    }

    /// The last error, until the user dismisses it.
    pub fn error(&self) -> Option<&str> {
        self.error.as_deref()
    }

    /// True while the hair moves.
    pub fn is_playing(&self) -> bool {
        self.playing
    }

    /// True while a scene is loading.
    pub fn is_loading(&self) -> bool {
        self.pending.is_some()
    }

    /// Loads another scene, as if its file had been opened.
    pub fn open_scene(&mut self, scene: Scene) {
        self.load(scene);
    }

    /// Loads another scene; until it is there the old one stays and the controls change it.
    pub(crate) fn load(&mut self, mut scene: Scene) {
        (self.error, self.mended.failed) = (None, None);
        self.watch.note(&scene);
        // The window's size and the devices that the program was started with stay.
        let PictureSettings { width, height, .. } = self.scene.picture;
        (scene.picture.width, scene.picture.height) = (width, height);
        for (new, old) in [
            (&mut scene.devices.simulation, self.scene.devices.simulation),
            (&mut scene.devices.pictures, self.scene.devices.pictures),
        ] {
            if *new == Backend::Auto {
                *new = old;
            }
        }
        let drawn = PictureSettings { transparent: false, ..scene.picture };
        let number = self.live.send(Command::Load(Box::new(Scene { picture: drawn, ..scene.clone() })));
        self.pending = Some((number, Box::new(scene)));
    }

    /// Loads a scene, or another groom or body into the current one.
    pub(crate) fn open_file(&mut self, file: &Path) {
        // A body dropped right after a groom goes with it.
        let onto = match &self.pending {
            Some((_, scene)) => Scene::clone(scene),
            None => self.own_scene(),
        };
        match Self::scene_of(&onto, file) {
            Ok(_) if self.pending.is_none() && is_look(file) => self.load_look(file),
            Ok(scene) => {
                self.recent.add(file);
                if strandline::scene::is_file(file) {
                    let path = file.to_owned();
                    let reload = move || Scene::load(&path).map_err(|error| error.to_string());
                    self.watch.scene_file(&strandline::scene::file_of(file), Box::new(reload));
                }
                self.load(scene);
            }
            Err(error) => self.error = Some(error.to_string()),
        }
    }

    /// The scene, without lights where they are those that the look has about this hair and body: about others they
    /// stand elsewhere.
    pub(crate) fn own_scene(&self) -> Scene {
        let mut scene = self.scene.clone();
        if scene.lights == scene.look.lights(self.center) {
            scene.lights.clear();
        }
        scene
    }

    /// The scene with the current view.
    pub fn seen(&self) -> Scene {
        let mut scene = self.own_scene();
        if !self.follows {
            scene.camera.position = Some(self.camera.position);
            scene.camera.target = Some(self.camera.target);
            scene.camera.field_of_view = Some(self.camera.field_of_view);
        }
        // It may be saved elsewhere.
        for file in scene.paths_mut() {
            let path = self.scene.folder.join(&file);
            *file = std::path::absolute(&path).unwrap_or(path);
        }
        scene
    }
}
