use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use eframe::egui;
use strandline::groom::format::{Format, endings};
use strandline::{
    Backend, Camera, Command, Error, Live, News, Scene, Shown, base::SettingError, body::Aabb,
    render::PictureSettings,
};

use crate::{export, files, messages, panels, rescue, saves, stage, strip};

/// The window's state: what plays, and what a person made of it.
pub struct App {
    pub(crate) live: Live,
    /// The window, once it is there: the scene is loaded before.
    pub(crate) context: Arc<OnceLock<egui::Context>>,
    /// What is seen, as a scene: it can be saved at any time.
    pub(crate) scene: Scene,
    /// The scene as it was loaded: what the controls are set to by default.
    pub(crate) base: Scene,
    pub(crate) camera: Camera,
    /// The view of the scene.
    pub(crate) home: Camera,
    pub(crate) playing: bool,
    /// What the mouse does when no key is held.
    pub(crate) tool: Tool,
    /// Where a drag in the picture was at the last pass.
    pub(crate) dragged_to: Option<egui::Pos2>,
    /// Whether the mouse holds hair, and the radius \[m\] of the hand.
    pub(crate) grabs: bool,
    pub(crate) radius: f32,
    /// The scene that is on its way, and the number of its command.
    pending: Option<(u64, Box<Scene>)>,
    pub(crate) error: Option<String>,
    pub(crate) notes: Vec<messages::Note>,
    pub(crate) shown: Option<Shown>,
    pub(crate) texture: Option<egui::TextureHandle>,
    /// Pictures a second, smoothed.
    pub(crate) rate: f32,
    last: Option<Instant>,
    /// What is typed as the path of a file.
    pub(crate) path: String,
    /// Whether pictures may be simpler while the hair moves.
    pub(crate) adapts: bool,
    /// Whether a video is recorded, and how many are being finished.
    pub(crate) recording: bool,
    pub(crate) finishing: u32,
    /// Number of the load that the scene comes from.
    pub(crate) loaded: u64,
    pub(crate) saves: saves::Saves,
    /// What is seen, for the case that the window stops in an error, and when it was kept last.
    pub(crate) kept: rescue::Kept,
    kept_at: Option<Instant>,
    /// Number of the last step that was asked for by dragging while nothing plays, and whether another one
    /// is wanted once its picture is there.
    stepped: u64,
    wants_step: bool,
    pub(crate) dialog: Option<files::Dialog>,
    /// Moving hair that is being written, and what of it.
    pub(crate) exporting: Option<export::Export>,
    pub(crate) export_wanted: export::Wanted,
    /// Where the next picture and scene are saved.
    pub folder: PathBuf,
}

/// How long a new picture waits to be shown.
const SOON: Duration = Duration::from_millis(1);

/// How often what is seen is kept.
const KEPT_EVERY: Duration = Duration::from_secs(2);

/// What the mouse does in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Goes around the head.
    #[default]
    Orbit,
    /// Takes hair into a hand.
    Grab,
    /// Turns the head.
    Turn,
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
        let known = context.clone();
        // At once would be two passes, the second one for nothing.
        let wake = move || {
            known.get().into_iter().for_each(|context| context.request_repaint_after(SOON));
        };
        let live = Live::new(scene.clone(), wake)?;
        live.tell(Command::Adapt(true));
        Ok(Self {
            live,
            context,
            base: scene.clone(),
            scene: scene.clone(),
            camera: Camera::front(),
            home: Camera::front(),
            playing: true,
            tool: Tool::default(),
            dragged_to: None,
            grabs: false,
            radius: Self::RADIUS,
            pending: Some((1, Box::new(scene))),
            error: None,
            notes: Vec::new(),
            shown: None,
            texture: None,
            rate: 0.0,
            last: None,
            path: String::new(),
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
        })
    }

    /// The scene that a file stands for: itself, or `scene` with another groom or body.
    ///
    /// # Errors
    /// A scene that cannot be read; a file of another kind.
    pub fn scene_of(scene: &Scene, file: &Path) -> Result<Scene, Error> {
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let mut scene = scene.clone();
        let absolute = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
        match ending.as_deref() {
            Some("toml") => return Scene::load(file),
            // Meshes are more common than strands as lines, which `convert` reads.
            Some("obj" | "gltf" | "glb") => {
                scene.body.file = Some(absolute);
                scene.body.parts.clear();
            }
            _ if Format::is_of(file) => {
                scene.groom.file = Some(absolute);
                scene.groom.parts.clear();
            }
            _ => {
                let grooms = endings(|format| format.ending != "obj");
                let expected = format!("a .toml scene, a {grooms} groom, or an .obj, .gltf or .glb body");
                return Err(SettingError::new("the file", file.display(), expected).into());
            }
        }
        scene.begin_at_rest();
        Ok(scene)
    }

    pub(crate) fn send_look(&self) {
        self.live.tell(Command::Look(Box::new(self.scene.look.clone())));
    }

    /// Has pictures drawn as the scene says, with something behind them.
    pub(crate) fn send_picture(&self) {
        self.live.tell(Command::Picture(PictureSettings { transparent: false, ..self.scene.picture }));
    }

    pub(crate) fn send_motion(&mut self) {
        self.live.tell(Command::Motion(Box::new(self.scene.motion.clone())));
        self.step_on();
    }

    /// Lets a frame of time pass where nothing plays, so that hair follows what is dragged; one at a time.
    pub(crate) fn step_on(&mut self) {
        let heard = self.shown.as_ref().map_or(0, |shown| shown.heard);
        self.wants_step = !self.playing && self.stepped > heard;
        if !self.playing && !self.wants_step {
            self.stepped = self.live.tell(Command::Step);
        }
    }

    /// What is seen at the moment, if there is anything.
    pub fn shown(&self) -> Option<&Shown> {
        self.shown.as_ref()
    }

    /// What went wrong last, until it is put away.
    pub fn error(&self) -> Option<&str> {
        self.error.as_deref()
    }

    /// Whether the hair moves.
    pub fn is_playing(&self) -> bool {
        self.playing
    }

    /// Whether a scene is on its way.
    pub(crate) fn is_loading(&self) -> bool {
        self.pending.is_some()
    }

    /// Loads another scene; the old one stays, and is what the controls change, until it is there.
    pub(crate) fn load(&mut self, mut scene: Scene) {
        self.error = None;
        // The window's size and the devices that the program was started with go on.
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
        let number = self.live.tell(Command::Load(Box::new(Scene { picture: drawn, ..scene.clone() })));
        self.pending = Some((number, Box::new(scene)));
    }

    /// Loads what was dropped on the window.
    fn take_files(&mut self, ui: &egui::Ui) {
        let dropped = ui.input(|input| input.raw.dropped_files.clone());
        dropped.iter().for_each(|file| self.open_file(file.path()));
    }

    /// Loads a scene, or another groom or body into the one that is there.
    pub(crate) fn open_file(&mut self, file: &Path) {
        // A body dropped right after a groom goes with it.
        let onto = self.pending.as_ref().map_or(&self.scene, |(_, scene)| scene);
        match Self::scene_of(onto, file) {
            Ok(scene) => self.load(scene),
            Err(error) => self.error = Some(error.to_string()),
        }
    }

    fn take_news(&mut self) {
        for news in self.live.take_news() {
            match news {
                News::Loaded(number, scene, camera, bounds, notes) => {
                    self.take_scene(number, *scene, camera, bounds);
                    notes.into_iter().for_each(|note| self.note(note));
                }
                News::Note(note) => self.note(note),
                News::NotLoaded(number, error) => {
                    // What plays is still what played before.
                    self.pending.take_if(|(pending, _)| *pending == number);
                    self.error = Some(error);
                    if self.shown.is_none() {
                        self.give_up_pictures();
                    }
                }
                News::Error(error) => self.error = Some(error),
                News::Paused => {
                    self.playing = false;
                    self.give_up_pictures();
                }
                News::Saved(path) => self.note(format!("wrote {}", path.display())),
                News::Recorded if self.finishing > 0 => self.finishing -= 1,
                News::Recorded => self.recording = false,
            }
        }
    }

    /// Makes the scene that has come the one that the controls change.
    fn take_scene(&mut self, number: u64, scene: Scene, camera: Camera, bounds: Aabb) {
        if self.pending.take_if(|(pending, _)| *pending == number).is_none() {
            return;
        }
        (self.scene, self.loaded) = (scene, number);
        if self.scene.lights.is_empty() {
            // Those that it is lit with, for the panel to change.
            self.scene.lights = self.scene.look.lights(0.5 * (bounds.min + bounds.max));
        }
        self.base = self.scene.clone();
        (self.camera, self.home, self.grabs) = (camera, camera, false);
        self.notes.clear();
        self.live.tell(Command::Play(self.playing));
    }

    fn take_picture(&mut self, context: &egui::Context) {
        let Some(shown) = self.live.take_shown() else { return };
        let size = [shown.picture.width as usize, shown.picture.height as usize];
        let image = egui::ColorImage::from_rgb(size, &shown.picture.pixels);
        match &mut self.texture {
            Some(texture) => texture.set(image, egui::TextureOptions::LINEAR),
            None => {
                self.texture = Some(context.load_texture("picture", image, egui::TextureOptions::LINEAR));
            }
        }
        let now = Instant::now();
        if let Some(last) = self.last.replace(now) {
            let rate = 1.0 / (now - last).as_secs_f32().max(1e-3);
            self.rate += (rate - self.rate) * if self.rate == 0.0 { 1.0 } else { 0.1 };
        }
        let step = shown.step.clone().or(self.shown.take().and_then(|old| old.step));
        self.shown = Some(Shown { step, ..shown });
        self.save_if_full();
        if self.wants_step {
            self.step_on();
        }
    }

    /// The scene with the view as it is.
    pub fn seen(&self) -> Scene {
        let mut scene = self.scene.clone();
        scene.camera.position = Some(self.camera.position);
        scene.camera.target = Some(self.camera.target);
        scene.camera.field_of_view = Some(self.camera.field_of_view);
        // It may be saved elsewhere.
        for file in scene.paths_mut() {
            let path = self.scene.folder.join(&file);
            *file = std::path::absolute(&path).unwrap_or(path);
        }
        scene
    }

    /// Keeps what is seen, now and then: it may be the last that there is of it.
    fn keep_scene(&mut self) {
        if self.kept_at.is_none_or(|last| last.elapsed() > KEPT_EVERY) {
            self.kept.keep(self.seen());
            self.kept_at = Some(Instant::now());
        }
    }

    /// Draws the window.
    pub fn show(&mut self, ui: &mut egui::Ui) {
        self.context.get_or_init(|| ui.ctx().clone());
        self.take_news();
        self.take_files(ui);
        self.take_picture(ui.ctx());
        files::take_answer(self);
        self.take_saved();
        self.take_exported();
        self.keep_scene();
        stage::keys(self, ui);
        egui::Panel::bottom("strip").show(ui, |ui| strip::show(self, ui));
        egui::Panel::left("panels").default_size(290.0).show(ui, |ui| panels::show(self, ui));
        egui::CentralPanel::default().show(ui, |ui| stage::show(self, ui));
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        self.show(ui);
    }
}
