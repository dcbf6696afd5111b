//! The picture, and what mouse and keys do to it.

use eframe::egui;
use strandline::{Camera, Command, render::PictureSettings};

use crate::App;

/// Turn of the view for a point that the mouse moves \[radians\].
const ORBIT: f32 = 0.008;
/// Pictures have sides of whole multiples of this \[pixel\], so that they do not change with every point.
const GRAIN: f32 = 16.0;

/// Space plays and pauses, the full stop makes one frame, R goes back to rest, arrows orbit.
pub fn keys(app: &mut App, ui: &egui::Ui) {
    if ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    let pressed = |key| ui.input(|input| input.key_pressed(key));
    if pressed(egui::Key::Space) {
        play(app, !app.playing);
    }
    if pressed(egui::Key::Period) {
        play(app, false);
        app.live.tell(Command::Step);
    }
    if pressed(egui::Key::R) {
        app.live.tell(Command::Reset);
    }
    let turns = [
        (egui::Key::ArrowLeft, [-0.1, 0.0]),
        (egui::Key::ArrowRight, [0.1, 0.0]),
        (egui::Key::ArrowUp, [0.0, 0.1]),
        (egui::Key::ArrowDown, [0.0, -0.1]),
    ];
    for (key, [yaw, pitch]) in turns {
        if pressed(key) {
            look(app, app.camera.orbit(yaw, pitch));
        }
    }
}

/// Goes on, or stands still.
pub fn play(app: &mut App, playing: bool) {
    app.playing = playing;
    app.live.tell(Command::Play(playing));
}

fn look(app: &mut App, camera: Camera) {
    app.camera = camera;
    app.live.tell(Command::Camera(camera));
}

/// The picture as large as there is room.
pub fn show(app: &mut App, ui: &mut egui::Ui) {
    let room = ui.available_size();
    fit(app, room, ui.ctx().pixels_per_point());
    let Some(texture) = &app.texture else {
        ui.centered_and_justified(|ui| ui.spinner());
        return;
    };
    let image = egui::Image::new(texture).fit_to_exact_size(room).sense(egui::Sense::drag());
    let response = ui.add(image);
    drag(app, ui, &response);
    if response.hovered() {
        let scroll = ui.input(|input| input.smooth_scroll_delta().y);
        if scroll != 0.0 {
            let (camera, share) = (app.camera, (-0.002 * scroll).exp());
            let offset = (camera.position - camera.target) * share;
            let offset = offset.clamp_length(0.05, 20.0);
            look(app, Camera { position: camera.target + offset, ..camera });
        }
    }
}

fn drag(app: &mut App, ui: &egui::Ui, response: &egui::Response) {
    let moved = response.drag_delta();
    if moved == egui::Vec2::ZERO {
        return;
    }
    let aside = response.dragged_by(egui::PointerButton::Secondary)
        || response.dragged_by(egui::PointerButton::Middle);
    if aside {
        let camera = app.camera;
        let world_from_view = camera.view_from_world().inverse();
        // A point of the picture is as far at the target as it looks.
        let distance = camera.position.distance(camera.target);
        let scale = 2.0 * distance / (camera.focal() * response.rect.height().max(1.0));
        let shift = world_from_view.transform_vector3(glam::Vec3::new(-moved.x, moved.y, 0.0) * scale);
        look(app, Camera { position: camera.position + shift, target: camera.target + shift, ..camera });
    } else if ui.input(|input| input.modifiers.shift) {
        let [yaw, pitch] = app.turn;
        let near = |angle: f32| angle.clamp(-1.2, 1.2);
        app.turn = [near(yaw + ORBIT * moved.x), near(pitch + ORBIT * moved.y)];
        app.live.tell(Command::Turn(app.turn[0], app.turn[1]));
    } else {
        look(app, app.camera.orbit(-ORBIT * moved.x, ORBIT * moved.y));
    }
}

/// Makes pictures as large as the room for them.
fn fit(app: &mut App, room: egui::Vec2, pixels_per_point: f32) {
    let side = |points: f32| ((points * pixels_per_point / GRAIN).floor() * GRAIN).clamp(64.0, 4096.0) as u32;
    let (width, height) = (side(room.x), side(room.y));
    let picture = &mut app.scene.picture;
    if (picture.width, picture.height) != (width, height) {
        *picture = PictureSettings { width, height, transparent: false, ..*picture };
        app.send_picture();
    }
}
