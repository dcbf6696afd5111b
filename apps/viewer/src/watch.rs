//! Loading of files again that changed on disk.

use std::path::PathBuf;

use crate::{
    App,
    watched::{INTERVAL, Reload},
};

impl App {
    /// Loads the files of the scene again when they change on disk; `scene` is its file with its reader, where it has one.
    pub fn watch(&mut self, scene: Option<(PathBuf, Reload)>) {
        if let Some((file, reload)) = scene {
            self.watch.scene_file(&file, reload);
        }
        self.watch.on = true;
        self.watch.note(&self.scene);
    }

    /// Looks at the watched files, and loads those that changed.
    pub(crate) fn follow_files(&mut self, context: &eframe::egui::Context) {
        if self.watch.on {
            context.request_repaint_after(INTERVAL);
        }
        if self.is_loading() || !self.watch.is_due() {
            return;
        }
        let changed = self.watch.changed();
        let Some(first) = changed.first() else { return };
        let of_scene = self.watch.scene.as_ref().filter(|(file, _)| changed.contains(file));
        let scene = of_scene.map_or_else(|| Ok(self.own_scene()), |(_, reload)| reload());
        match scene {
            Ok(scene) => {
                let name = first.file_name().unwrap_or_default().to_string_lossy().into_owned();
                self.watch.reloads = Some(format!("{name} has changed: loaded again"));
                self.keeps_view = true;
                self.load(scene);
            }
            Err(error) => self.error = Some(error),
        }
    }
}
