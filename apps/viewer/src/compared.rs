//! A scene that the shown one is compared with, and its hair.

use eframe::egui;
use strandline::live::{Command, Shown};
use strandline::{Camera, Change, Live, PictureSettings};

/// The way in which two pictures share the room.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Split {
    /// The other one left of a line that is moved.
    Wipe,
    /// The middle of each in a half of its own.
    Beside,
}

/// The scene that the shown one is compared with, and its hair.
pub struct Compare {
    live: Live,
    shown: Option<Shown>,
    /// Its picture on the screen's device.
    pub texture: Option<egui::TextureHandle>,
    /// The way in which the room is shared.
    pub split: Split,
    /// Place of the line of a wipe, 0 to 1.
    pub at: f32,
    /// Frames by which it is later.
    pub later: i32,
    /// Number of the command that moved it last.
    sent: u64,
    camera: Option<Camera>,
    size: [u32; 2],
}

impl Compare {
    /// Comparison of hair which stands still at its beginning.
    pub fn new(live: Live) -> Self {
        let (split, camera) = (Split::Wipe, None);
        let (shown, texture) = (None, None);
        Self { live, shown, texture, split, at: 0.5, later: 0, sent: 0, camera, size: [0; 2] }
    }

    /// The number of the frame that its picture shows, if it has one.
    pub fn frame(&self) -> Option<u32> {
        self.shown.as_ref().map(|shown| shown.timeline.playhead)
    }

    /// Its picture.
    pub fn picture(&self) -> Option<&strandline::Picture> {
        self.shown.as_ref().map(|shown| &shown.picture)
    }

    /// Follows the frame, the camera and the size of the shown picture.
    pub fn follow(&mut self, playhead: u32, camera: Camera, picture: PictureSettings) {
        // Before its first picture there is no hair yet.
        let Some(shown) = &self.shown else { return };
        if self.camera != Some(camera) {
            self.live.send(Change::Camera(camera));
            self.camera = Some(camera);
        }
        if self.size != [picture.width, picture.height] {
            self.live.send(Change::Picture(PictureSettings { transparent: false, ..picture }));
            self.size = [picture.width, picture.height];
        }
        // One command at a time: the next one follows its picture.
        if shown.drawn_after_command < self.sent {
            return;
        }
        let timeline = shown.timeline;
        let frame = playhead.saturating_add_signed(self.later).max(timeline.first);
        // Frames after the last are simulated.
        if frame > timeline.last && timeline.playhead == timeline.last {
            self.sent = self.live.send(Command::Step);
        } else if frame.min(timeline.last) != timeline.playhead {
            self.sent = self.live.send(Command::Seek(frame.min(timeline.last)));
        }
    }

    /// Takes its newest picture.
    pub fn take(&mut self, context: &egui::Context) {
        let Some(shown) = self.live.take_shown() else { return };
        let size = [shown.picture.width as usize, shown.picture.height as usize];
        let image = egui::ColorImage::from_rgb(size, &shown.picture.pixels);
        match &mut self.texture {
            Some(texture) => texture.set(image, egui::TextureOptions::LINEAR),
            None => {
                self.texture = Some(context.load_texture("compared", image, egui::TextureOptions::LINEAR))
            }
        }
        self.shown = Some(shown);
    }
}
