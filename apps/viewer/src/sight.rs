//! Lines of sight, and lengths as they are seen.

use eframe::egui::{Pos2, Rect};
use glam::Vec2;
use strandline::Ray;

use crate::App;

/// A length \[m\] as far away as the target, in the picture \[point\].
pub fn points_of(app: &App, room: Rect, length: f32) -> f32 {
    let distance = app.camera.position.distance(app.camera.target);
    length * app.camera.focal() / distance * 0.5 * room.height()
}

/// The line of sight under the mouse.
pub fn ray(app: &App, room: Rect, pointer: Pos2) -> Ray {
    let halves = (pointer - room.center()) / (0.5 * room.height().max(1.0));
    Ray::new(&app.camera, Vec2::new(halves.x, -halves.y))
}
