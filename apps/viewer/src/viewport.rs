//! The picture, and its mouse and keys.

use eframe::egui::{self, Key, Modifiers, PointerButton, Rect};
use glam::Vec2;
use strandline::{Camera, Change, PictureSettings, live::Command, scene::MotionSection, settings::Group};

use crate::{
    App, Tool, brushing, compare,
    controls::button,
    files::Wanted,
    loading, messages, overlays,
    sight::{points_of, ray},
    wind,
};

/// Turn of the view or the head for a point that the mouse moves \[radians\].
const ORBIT: f32 = 0.008;
/// Pictures have sides of whole multiples of this \[pixel\], so that they do not change with every point.
const GRAIN: f32 = 16.0;

/// Runs the action of a key: the panel lists them.
pub fn keys(app: &mut App, ui: &egui::Ui) {
    if ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    // The modifiers are those of the moment of the press, however long a pass takes.
    let pressed = |modifiers, key| ui.input_mut(|input| input.consume_key(modifiers, key));
    // The longer one first: the shorter would take it too.
    if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || pressed(Modifiers::COMMAND, Key::Y) {
        app.redo();
    }
    if pressed(Modifiers::COMMAND, Key::Z) {
        app.undo();
    }
    file_keys(app, ui, |key| pressed(Modifiers::COMMAND, key));
    for (key, way) in [
        (Key::ArrowLeft, Vec2::NEG_X),
        (Key::ArrowRight, Vec2::X),
        (Key::ArrowUp, Vec2::Y),
        (Key::ArrowDown, Vec2::NEG_Y),
    ] {
        let camera = app.camera;
        if pressed(Modifiers::SHIFT, key) {
            look(app, pan(&camera, 0.1 * way));
        } else if pressed(Modifiers::ALT, key) {
            look(app, camera.orbit(0.1 * way.x, 0.1 * way.y));
        }
    }
    time_keys(app, |key| pressed(Modifiers::NONE, key));
    plain_keys(app, |key| pressed(Modifiers::NONE, key));
}

fn time_keys(app: &mut App, pressed: impl Fn(Key) -> bool) {
    for (key, frames) in
        [(Key::ArrowLeft, -1), (Key::ArrowRight, 1), (Key::ArrowDown, -10), (Key::ArrowUp, 10)]
    {
        if pressed(key) {
            app.move_by(frames);
        }
    }
    for (key, frame) in [(Key::Home, 0), (Key::End, u32::MAX)] {
        if pressed(key) {
            app.seek(frame);
        }
    }
    for (key, end) in [(Key::I, 0), (Key::O, 1)] {
        if pressed(key) {
            app.mark(end);
        }
    }
}

fn file_keys(app: &mut App, ui: &egui::Ui, pressed: impl Fn(Key) -> bool) {
    if pressed(Key::O) {
        app.ask(Wanted::Open, ui.ctx());
    }
    if pressed(Key::S) {
        app.save_scene(None);
    }
    if pressed(Key::P) {
        app.save_picture(None);
    }
}

fn plain_keys(app: &mut App, pressed: impl Fn(Key) -> bool) {
    if pressed(Key::Space) {
        app.play(!app.playing);
    }
    if pressed(Key::Period) {
        app.play(false);
        app.live.send(Command::Step);
    }
    if pressed(Key::R) {
        app.live.send(Change::Reset);
    }
    if pressed(Key::G) {
        app.tool = if app.tool == Tool::Grab { Tool::Orbit } else { Tool::Grab };
    }
    if pressed(Key::L) {
        app.next_overlay();
    }
    if pressed(Key::V) {
        app.record();
    }
    if pressed(Key::Plus) || pressed(Key::Equals) {
        zoom(app, 0.9);
    }
    if pressed(Key::Minus) {
        zoom(app, 1.0 / 0.9);
    }
    if pressed(Key::F) {
        look(app, app.home);
    }
}

pub fn look(app: &mut App, camera: Camera) {
    (app.camera, app.follows) = (camera, false);
    app.looked = app.live.send(Change::Camera(camera));
}

/// The camera moved across, in half heights of the picture.
fn pan(camera: &Camera, halves: Vec2) -> Camera {
    // A point of the picture is as far at the target as it looks.
    let scale = camera.position.distance(camera.target) / camera.focal();
    let world_from_view = camera.view_from_world().inverse();
    let shift = world_from_view.transform_vector3(halves.extend(0.0) * scale);
    Camera { position: camera.position + shift, target: camera.target + shift, ..*camera }
}

fn zoom(app: &mut App, share: f32) {
    let camera = app.camera;
    let offset = ((camera.position - camera.target) * share).clamp_length(0.05, 20.0);
    look(app, Camera { position: camera.target + offset, ..camera });
}

/// Shows the picture, as large as the room allows.
pub fn show(app: &mut App, ui: &mut egui::Ui) {
    let room = ui.available_rect_before_wrap();
    fit(app, room.size(), ui.ctx().pixels_per_point());
    messages::show(app, ui, room);
    let Some(texture) = &app.texture else { return loading::show(app, ui, room) };
    // A picture whose size stays, as a video's does, keeps its shape too.
    let shape = texture.size_vec2();
    let share = (room.width() / shape.x).min(room.height() / shape.y);
    let place =
        Rect::from_center_size(room.center(), if app.recording { shape * share } else { room.size() });
    let own = texture.id();
    let image = egui::Image::new(texture).fit_to_exact_size(place.size()).sense(egui::Sense::drag());
    let response = ui.put(place, image);
    compare::show(app, ui, place, own);
    overlays::show(app, ui, place, room);
    mouse(app, ui, &response);
    if response.hovered() {
        let scroll = ui.input(|input| input.smooth_scroll_delta().y);
        if scroll != 0.0 {
            zoom(app, (-0.002 * scroll).exp());
        }
    }
    tools(app, ui, room);
    wind::show(app, ui, room);
}

/// Tools of the mouse, in the upper left corner of the picture.
fn tools(app: &mut App, ui: &mut egui::Ui, room: Rect) {
    let corner = Rect::from_min_size(room.min + egui::vec2(8.0, 8.0), egui::vec2(480.0, 24.0));
    let mut row = ui.new_child(egui::UiBuilder::new().max_rect(corner));
    row.horizontal(|ui| {
        let tools = [
            (Tool::Orbit, "Orbit", "drag: around the head; right or middle button: across; wheel: nearer"),
            (Tool::Grab, "Grab", "drag: pulls the hair under the mouse; G, or ctrl with any tool"),
            (Tool::Turn, "Turn head", "drag: turns the head; or shift with any tool"),
        ];
        for (tool, name, tip) in tools {
            ui.selectable_value(&mut app.tool, tool, name).on_hover_text(tip);
        }
        if app.camera != app.home && button(ui, "View", "back to the view of the scene: F") {
            look(app, app.home);
        }
        overlays::menu(app, ui);
    });
}

fn mouse(app: &mut App, ui: &egui::Ui, response: &egui::Response) {
    let modifiers = ui.input(|input| input.modifiers);
    let tool = match app.tool {
        _ if modifiers.command => Tool::Grab,
        _ if modifiers.shift => Tool::Turn,
        tool => tool,
    };
    if response.drag_started_by(PointerButton::Primary)
        && tool == Tool::Grab
        // In a slow pass the mouse has moved on since.
        && let Some(press) = ui.input(|input| input.pointer.press_origin())
    {
        let ray = ray(app, response.rect, press);
        app.grabs = true;
        app.live.send(Change::Grab(ray, app.radius));
    }
    if app.grabs {
        grab(app, ui, response);
    } else if tool == Tool::Brush {
        brushing::mouse(app, ui, response);
        let aside = [PointerButton::Secondary, PointerButton::Middle];
        if aside.iter().any(|button| response.dragged_by(*button)) {
            drag(app, ui, response, tool);
        }
    } else {
        drag(app, ui, response, tool);
    }
}

/// Moves the hand, or lets go.
fn grab(app: &mut App, ui: &egui::Ui, response: &egui::Response) {
    if !response.dragged() {
        app.grabs = false;
        app.live.send(Change::Release);
        return;
    }
    if response.drag_delta() != egui::Vec2::ZERO
        && let Some(pointer) = response.interact_pointer_pos()
    {
        let ray = ray(app, response.rect, pointer);
        app.live.send(Change::Drag(ray));
        app.step_on();
    }
    if let Some(pointer) = response.interact_pointer_pos() {
        let holds = app.shown.as_ref().is_some_and(|shown| shown.grabbed > 0);
        let colour = if holds { egui::Color32::WHITE } else { egui::Color32::GRAY };
        let radius = points_of(app, response.rect, app.radius);
        ui.painter().circle_stroke(pointer, radius, egui::Stroke::new(1.5, colour));
    }
}

/// Distance \[point\] that the mouse was dragged since the last pass, or since the press: movement before the
/// press in the same pass is no drag.
fn dragged(app: &mut App, ui: &egui::Ui, response: &egui::Response) -> egui::Vec2 {
    let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) else {
        app.dragged_to = None;
        return egui::Vec2::ZERO;
    };
    let press = ui.input(|input| input.pointer.press_origin());
    let before = app.dragged_to.replace(pointer).or(press).unwrap_or(pointer);
    pointer - before
}

fn drag(app: &mut App, ui: &egui::Ui, response: &egui::Response, tool: Tool) {
    let moved = dragged(app, ui, response);
    if moved == egui::Vec2::ZERO {
        return;
    }
    let aside = response.dragged_by(PointerButton::Secondary) || response.dragged_by(PointerButton::Middle);
    if aside {
        let halves = 2.0 / response.rect.height().max(1.0) * Vec2::new(-moved.x, moved.y);
        look(app, pan(&app.camera, halves));
    } else if tool == Tool::Turn {
        let most = MotionSection::ROWS.rotation.slider()[1] as f32;
        // An angle of the scene beyond that is not pulled back.
        let turn = |angle: f32, points: f32| {
            (angle + (ORBIT * points).to_degrees()).clamp(angle.min(-most), angle.max(most))
        };
        let rotation = &mut app.scene.motion.rotation;
        (rotation.y, rotation.x) = (turn(rotation.y, moved.x), turn(rotation.x, moved.y));
        app.send_motion();
    } else if tool == Tool::Orbit {
        look(app, app.camera.orbit(-ORBIT * moved.x, ORBIT * moved.y));
    }
}

/// Makes pictures as large as the room for them; those of a video stay as they are.
fn fit(app: &mut App, room: egui::Vec2, pixels_per_point: f32) {
    if app.recording {
        return;
    }
    let side = |points: f32| ((points * pixels_per_point / GRAIN).floor() * GRAIN).clamp(64.0, 4096.0) as u32;
    let (width, height) = (side(room.x), side(room.y));
    let picture = &mut app.scene.picture;
    if (picture.width, picture.height) != (width, height) {
        *picture = PictureSettings { width, height, ..*picture };
        app.send_picture();
    }
}
