//! Export of the moving hair that is shown.

use std::path::Path;

use strandline::file::counted;
use strandline::{Target, Written, live::Command};

use crate::App;
use crate::export::{Export, numbered};

impl App {
    /// Writes moving hair of the current scene, or ends a running export. The ending of the path chooses
    /// the format: .npz, .usda, or a groom format for a file per frame; without a path, a free name in the folder of
    /// the format that the chosen target takes.
    pub fn export(&mut self, path: Option<&Path>) {
        if self.exporting.take().is_some() {
            self.note("the export was stopped: written frames stay".to_owned());
            return;
        }
        let numbered = path.and_then(numbered);
        let path = numbered.as_deref().or(path);
        let named = path.and_then(Path::extension).map(|ending| ending.eq_ignore_ascii_case("usda"));
        // A cache is in metres with y up, for any.
        let is_usda = named.unwrap_or(self.export_wanted.target != Target::Any);
        let ending = if is_usda { "usda" } else { "npz" };
        let free = || self.path_or_free(path, "hair", ending);
        let Some(path) = numbered.clone().or_else(free) else { return };
        let mut scene = self.seen();
        // The hair begins where the film does, as in a run of the scene.
        scene.begin_at_rest();
        match Export::new(scene, &self.export_wanted, &path, self.context.clone()) {
            Ok(export) => self.exporting = Some(export),
            Err(error) => self.error = Some(error.to_string()),
        }
    }

    /// True while moving hair is being written.
    pub fn is_exporting(&self) -> bool {
        self.exporting.is_some()
    }

    /// Writes the part of the timeline that is played, as it was seen, without simulating it again.
    pub fn export_kept(&mut self, path: Option<&Path>) {
        let timeline = self.timeline();
        let [first, last] = self.playback.marks;
        let first = first.unwrap_or(timeline.first);
        let frames = [first, last.unwrap_or(timeline.good)];
        let is_usda = self.export_wanted.target != Target::Any;
        let ending = if is_usda { "usda" } else { "npz" };
        let Some(path) = self.path_or_free(path, "hair", ending) else { return };
        let mut scene = self.seen();
        scene.begin_at_rest();
        let settings = self.export_wanted.out(&path);
        self.live.send(Command::Export(Box::new(scene), settings, frames));
    }

    /// Tells of moving hair that is written.
    pub(crate) fn tell_written(&mut self, written: &Written) {
        let Written { place, frames, strands, .. } = written;
        let frames = counted(*frames, "frame", "frames");
        self.note(format!(
            "wrote {frames} of {}: {}",
            counted(*strands, "strand", "strands"),
            place.display()
        ));
    }

    /// Tells of moving hair that is written.
    pub(crate) fn take_exported(&mut self) {
        let Some((path, result)) = self.exporting.as_ref().and_then(Export::result) else { return };
        let path = path.to_owned();
        self.exporting = None;
        match result {
            Ok(Some(written)) => self.tell_written(&written),
            Ok(None) => {}
            Err(error) => self.error = Some(format!("cannot export {}: {error}", path.display())),
        }
    }
}
