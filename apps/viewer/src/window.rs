//! A pass of the window: it takes the events since the last pass, then draws everything.

use std::time::{Duration, Instant};

use eframe::egui;
use strandline::{
    Camera, ErrorKind, Scene,
    edit::History,
    live::{Command, LiveEvent, Shown},
    mesh::Aabb,
};

use crate::{App, panels, status_bar, timeline_bar, viewport};

/// Widest panel \[point\].
const MOST_PANEL: f32 = 400.0;
/// Interval at which the scene is kept.
const KEPT_EVERY: Duration = Duration::from_secs(2);

impl App {
    /// Loads files dropped on the window.
    fn take_files(&mut self, ui: &egui::Ui) {
        let dropped = ui.input(|input| input.raw.dropped_files.clone());
        dropped.iter().for_each(|file| self.open_file(file.path()));
    }

    fn take_events(&mut self) {
        for news in self.live.take_events() {
            match news {
                LiveEvent::Loaded(number, scene, camera, bounds, notes) => {
                    self.take_scene(number, *scene, camera, bounds);
                    notes.into_iter().for_each(|note| self.note(note));
                }
                LiveEvent::Loading(number, stage, hair) => self.take_stage(number, stage, hair),
                LiveEvent::Note(note) => self.note(note),
                LiveEvent::NotLoaded(number, kind, error) => {
                    // The previous scene still plays.
                    self.mended.failed =
                        self.pending.take_if(|(pending, _)| *pending == number).map(|(_, scene)| scene);
                    (self.restoring, self.keeps_view) = (false, false);
                    self.error = Some(with_remedy(kind, error));
                    if self.shown.is_none() {
                        self.give_up_pictures();
                    }
                }
                LiveEvent::Error(kind, error) => {
                    self.saves.project = None;
                    self.error = Some(with_remedy(kind, error));
                }
                LiveEvent::Paused => {
                    self.playing = false;
                    self.give_up_pictures();
                }
                LiveEvent::Saved(path) => self.tell_saved(&path),
                LiveEvent::Saving(share) => self.saves.project = Some(share),
                LiveEvent::Recorded if self.finishing > 0 => self.finishing -= 1,
                LiveEvent::Recorded => self.recording = false,
                LiveEvent::Touched(touched) => self.brush(touched),
                LiveEvent::Exported(written) => self.tell_written(&written),
            }
        }
    }

    /// Hands the loaded scene to the controls.
    fn take_scene(&mut self, number: u64, scene: Scene, camera: Camera, bounds: Aabb) {
        if self.pending.take_if(|(pending, _)| *pending == number).is_none() {
            return;
        }
        (self.scene, self.loaded) = (scene, number);
        self.center = 0.5 * (bounds.min + bounds.max);
        if self.scene.lights.is_empty() && self.scene.look.surroundings.is_none() {
            // Those that it is lit with, for the panel to change.
            self.scene.lights = self.scene.look.lights(self.center);
        }
        if self.loads_first {
            self.history = History::new(&self.scene);
        } else if std::mem::take(&mut self.restoring) {
            self.history.settle(&self.scene);
        } else {
            self.remember_now();
        }
        self.loads_first = false;
        self.base = self.scene.clone();
        let before = self.camera;
        (self.camera, self.home, self.grabs) = (camera, camera, false);
        if std::mem::take(&mut self.keeps_view) && !self.follows {
            viewport::look(self, before);
        }
        self.notes.clear();
        self.watch.reloads.take().into_iter().for_each(|note| self.note(note));
        self.live.send(Command::Play(self.playing));
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
        self.follows = shown.follows_camera && shown.drawn_after_command >= self.looked;
        if let Some(camera) = shown.camera.filter(|_| self.follows) {
            self.camera = camera;
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

    /// Keeps the shown scene at intervals: an error may end the window.
    fn keep_scene(&mut self) {
        if self.kept_at.is_none_or(|last| last.elapsed() > KEPT_EVERY) {
            self.kept.keep(self.seen());
            self.kept_at = Some(Instant::now());
        }
    }

    /// Draws the window.
    pub fn show(&mut self, ui: &mut egui::Ui) {
        self.context.get_or_init(|| ui.ctx().clone());
        self.take_events();
        self.take_files(ui);
        self.take_picture(ui.ctx());
        self.follow_compared(ui.ctx());
        self.take_answer();
        self.take_saved();
        self.take_exported();
        self.keep_scene();
        self.follow_files(ui.ctx());
        viewport::keys(self, ui);
        egui::Panel::bottom("status_bar").show(ui, |ui| status_bar::show(self, ui));
        // Long names beside sliders, which take what room there is, would push the panel over the picture.
        let side = egui::Panel::left("panels").default_size(290.0).max_size(MOST_PANEL);
        side.show(ui, |ui| panels::show(self, ui));
        egui::Panel::bottom("timeline").show(ui, |ui| timeline_bar::show(self, ui));
        egui::CentralPanel::default().show(ui, |ui| viewport::show(self, ui));
        self.remember(ui);
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        self.show(ui);
    }
}

/// The text of an error with what a person may do about it in the window.
fn with_remedy(kind: ErrorKind, error: String) -> String {
    match kind {
        ErrorKind::DeviceLost | ErrorKind::OutOfMemory | ErrorKind::Refused => {
            format!("{error}\nThe CPU can continue: `--backend cpu`.")
        }
        _ => error,
    }
}
