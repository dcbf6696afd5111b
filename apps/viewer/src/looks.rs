//! Looks as files of their own, views that are kept, and a turntable.

use std::path::Path;

use eframe::egui::Ui;
use strandline::Camera;
use strandline::edit::{load_look, save_look};
use strandline::math::atan2;
use strandline::scene::{CameraKeyframe, Interpolation, KeptView};

use crate::{
    App,
    controls::{button, slide_in},
    files::Wanted,
    viewport,
};

impl App {
    /// Saves the look; into a free file of the folder when no path is given.
    pub fn save_look(&mut self, path: Option<&Path>) {
        let Some(path) = self.path_or_free(path, "look", "toml") else { return };
        match save_look(&self.scene, &path) {
            Ok(()) => self.note(format!("wrote {}", path.display())),
            Err(error) => self.error = Some(error.to_string()),
        }
    }

    /// Dresses the hair with the look of a file.
    pub fn load_look(&mut self, path: &Path) {
        match load_look(&self.scene, path) {
            Ok(scene) => {
                self.recent.add(path);
                self.restore(scene);
            }
            Err(error) => self.error = Some(error.to_string()),
        }
    }

    /// Turns the camera once around the hair in the film, evenly.
    pub(crate) fn turntable(&mut self) {
        let mut scene = self.seen();
        let film = scene.film;
        let seconds = f64::from(film.frames) / f64::from(film.frames_per_second);
        let key = |time: f64, turn: f32| CameraKeyframe {
            time: film.start + time,
            turn,
            interpolation: Some(Interpolation::Linear),
            ..CameraKeyframe::default()
        };
        scene.camera.keyframes = vec![key(0.0, 0.0), key(seconds, 360.0)];
        scene.begin_at_rest();
        self.load(scene);
    }
}

/// Buttons of a look's file.
pub fn files(app: &mut App, ui: &mut Ui) {
    ui.horizontal(|ui| {
        if button(ui, "Save look", "the look alone, of hair and body, as a file into out/") {
            app.save_look(None);
        }
        if button(ui, "save as...", "the same, to a place of your choice") {
            app.ask(Wanted::SaveLook, ui.ctx());
        }
        if button(ui, "Load look...", "a look that was saved; or drop its file on the window") {
            app.ask(Wanted::OpenLook, ui.ctx());
        }
    });
}

/// Height of the film behind a lens \[mm\]: 36 x 24.
const FILM: f32 = 24.0;

/// The lens of the view: its focal length for a field of view, and the other way round.
fn lens(app: &mut App, ui: &mut Ui) {
    let focal = |camera: &Camera| 0.5 * FILM * camera.focal();
    let (mut now, default) = (focal(&app.camera), focal(&app.home));
    let tip = "focal length [mm] on film of 36 x 24 mm; more: a narrower view";
    if slide_in(ui, (&mut now, default), 8.0..=300.0, "lens", tip) {
        let field_of_view = 2.0 * atan2(0.5 * FILM, now.max(2.0)).to_degrees();
        viewport::look(app, Camera { field_of_view, ..app.camera });
    }
}

/// Views that are kept, the lens, and the turntable.
pub fn views(app: &mut App, ui: &mut Ui) {
    lens(app, ui);
    let mut gone = None;
    ui.horizontal_wrapped(|ui| {
        if button(ui, "Keep view", "adds the present view to this list, which the scene keeps") {
            let list = &mut app.scene.camera.kept;
            let Camera { position, target, field_of_view, .. } = app.camera;
            // The first number that none has: one may have been taken off.
            let mut names = (1..).map(|number| format!("view {number}"));
            let name = names.find(|name| list.iter().all(|view| view.name != *name)).unwrap_or_default();
            list.push(KeptView { name, position, target, field_of_view });
        }
        if button(ui, "Turntable", "the camera turns once around the hair in the film, evenly") {
            app.turntable();
        }
        for (index, view) in app.scene.camera.kept.clone().into_iter().enumerate() {
            let response = ui.button(&view.name);
            if response.clicked() {
                let KeptView { position, target, field_of_view, .. } = view;
                viewport::look(app, Camera { position, target, field_of_view, ..app.camera });
            }
            if response.on_hover_text("goes there; a right click takes it off the list").secondary_clicked() {
                gone = Some(index);
            }
        }
    });
    gone.map(|index| app.scene.camera.kept.remove(index));
}
