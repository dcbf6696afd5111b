//! Undo and redo of what the scene holds, and panels that go back to what they were.

use eframe::egui::{self, Ui};
use glam::Vec3;
use strandline::{Change, Look, Scene, edit::changes};

use crate::{App, controls::button};

/// A part of a scene that a panel changes.
#[derive(Clone, Copy)]
pub enum ScenePart {
    Motion,
    Simulation,
    Look,
    Lights,
    Detail,
    Groom,
    Body,
    Surroundings,
    Film,
}

impl ScenePart {
    /// Returns a scene with this part taken from another.
    fn of(self, scene: &Scene, other: &Scene) -> Scene {
        let mut scene = scene.clone();
        match self {
            Self::Motion => {
                scene.motion.clone_from(&other.motion);
                scene.wind.clone_from(&other.wind);
                scene.groom.length = other.groom.length;
                scene.colliders.clone_from(&other.colliders);
            }
            Self::Simulation => scene.simulation.clone_from(&other.simulation),
            Self::Look => scene.look.clone_from(&other.look),
            Self::Lights => {
                scene.lights.clone_from(&other.lights);
                scene.look.light_rig = other.look.light_rig;
                scene.body_look = other.body_look;
            }
            Self::Groom => {
                let length = scene.groom.length;
                scene.groom.clone_from(&other.groom);
                scene.groom.length = length;
                scene.style.clone_from(&other.style);
                scene.ties.clone_from(&other.ties);
            }
            Self::Body => {
                scene.body.clone_from(&other.body);
                scene.body_look = other.body_look;
            }
            Self::Surroundings => {
                scene.surroundings.clone_from(&other.surroundings);
                scene.look.surroundings.clone_from(&other.look.surroundings);
            }
            Self::Film => {
                let kept = std::mem::take(&mut scene.camera.kept);
                (scene.film, scene.camera) = (other.film, other.camera.clone());
                scene.camera.kept = kept;
            }
            Self::Detail => {
                scene.level_of_detail = other.level_of_detail;
                scene.picture = other.picture;
            }
        }
        scene
    }
}

impl App {
    /// Records what was changed as a step, once the mouse lets go: a drag is one step.
    pub(crate) fn remember(&mut self, ui: &Ui) {
        if !ui.input(|input| input.pointer.any_down()) {
            self.remember_now();
        }
    }

    pub(crate) fn remember_now(&mut self) {
        if !self.loads_first && !self.restoring {
            self.history.record(&self.scene);
        }
    }

    /// Undoes the last step.
    pub fn undo(&mut self) {
        self.remember_now();
        let name = self.history.done().checked_sub(1).map(|last| self.history.steps()[last].name.clone());
        match (self.history.undo().cloned(), name) {
            (Some(scene), Some(name)) => {
                self.restore(scene);
                self.note(format!("undone: {name}"));
            }
            _ => self.note("nothing to undo".to_owned()),
        }
    }

    /// Does the step again that was undone last.
    pub fn redo(&mut self) {
        self.remember_now();
        match self.history.redo().cloned() {
            Some(scene) => self.restore(scene),
            None => self.note("nothing to do again".to_owned()),
        }
    }

    /// Goes to where so many steps are done.
    fn go_to(&mut self, done: usize) {
        if let Some(scene) = self.history.go_to(done).cloned() {
            self.restore(scene);
        }
    }

    /// Brings the hair that plays to a scene: by changes, or by loading it.
    pub(crate) fn restore(&mut self, mut scene: Scene) {
        (scene.picture.width, scene.picture.height) = (self.scene.picture.width, self.scene.picture.height);
        let Some(changes) = changes(&self.scene, &scene) else {
            self.restoring = true;
            return self.load(scene);
        };
        self.scene = scene;
        for change in changes {
            match change {
                Change::Picture(_) => self.send_picture(),
                other => {
                    self.live.send(other);
                }
            }
        }
    }

    /// Changes the scene to another as a step: by changes, or by loading it, seen from where it is seen.
    pub(crate) fn apply(&mut self, mut scene: Scene) {
        (scene.picture.width, scene.picture.height) = (self.scene.picture.width, self.scene.picture.height);
        follow_look(&mut scene, &self.scene.look, self.center);
        if changes(&self.scene, &scene).is_some() {
            return self.restore(scene);
        }
        self.keeps_view = true;
        self.load(scene);
    }

    /// Sets a part of the scene to that of another.
    pub(crate) fn reset_part(&mut self, part: ScenePart, to: &Scene) {
        let scene = part.of(&self.scene, to);
        self.apply(scene);
    }
}

/// Gives a scene the lights of its look where it has those of the look before, about the middle of hair and body \[m\].
/// True where they change.
pub fn follow_look(scene: &mut Scene, before: &Look, center: Vec3) -> bool {
    let (old, new) = (before.lights(center), scene.look.lights(center));
    let follows = old != new && !old.is_empty() && scene.lights == old;
    if follows {
        scene.lights = new;
    }
    follows
}

/// Buttons that set a panel back: to before its last change, and to the scene as it was loaded.
pub fn resets(app: &mut App, ui: &mut Ui, part: ScenePart) {
    let before = |scene: &Scene, other: &Scene| part.of(scene, other) != *scene;
    ui.horizontal(|ui| {
        if button(ui, "before", "sets this panel back to before its last change")
            && let Some(scene) = app.history.before(before).cloned()
        {
            app.reset_part(part, &scene);
        }
        if button(ui, "default", "sets this panel back to the scene as it was loaded") {
            let base = app.base.clone();
            app.reset_part(part, &base);
        }
    });
}

/// The list of steps, the last first; those that are undone are grey.
pub fn show(app: &mut App, ui: &mut Ui) {
    ui.horizontal(|ui| {
        if button(ui, "Undo", "the last step: ctrl Z") {
            app.undo();
        }
        if button(ui, "Redo", "the step that was undone last: ctrl shift Z") {
            app.redo();
        }
    });
    let done = app.history.done();
    let mut wanted = None;
    egui::ScrollArea::vertical().id_salt("steps").max_height(140.0).show(ui, |ui| {
        for (index, step) in app.history.steps().iter().enumerate().rev() {
            let text = egui::RichText::new(&step.name);
            let text = if index < done { text } else { text.weak() };
            let chosen = ui.selectable_label(index + 1 == done, text);
            if chosen.on_hover_text("goes to where this step is the last").clicked() {
                wanted = Some(index + 1);
            }
        }
        if ui.selectable_label(done == 0, "beginning").on_hover_text("undoes all steps").clicked() {
            wanted = Some(0);
        }
    });
    if let Some(done) = wanted {
        app.go_to(done);
    }
}

#[cfg(test)]
mod tests {
    use strandline::look::LightRig;

    use super::*;

    #[test]
    fn lights_follow_the_look_until_a_person_changes_one() {
        let mut scene = Scene { lights: Look::default().lights(Vec3::Y), ..Scene::default() };
        let before = scene.look.clone();
        scene.look.light_rig = LightRig::AllSides;
        assert!(follow_look(&mut scene, &before, Vec3::Y) && scene.lights.len() == 4);
        let before = scene.look.clone();
        assert!(!follow_look(&mut scene, &before, Vec3::Y), "the same look");
        scene.lights[0].intensity = 9.0;
        let (before, own) = (scene.look.clone(), scene.lights.clone());
        scene.look.light_rig = LightRig::StudioLights;
        assert!(!follow_look(&mut scene, &before, Vec3::Y) && scene.lights == own);
    }
}
