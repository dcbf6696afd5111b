//! The wind as an arrow in the corner of the picture, which can be dragged.

use eframe::egui::{self, Align2, Color32, Rect, Sense, Stroke, Vec2};
use glam::Vec3;
use strandline::Change;

use crate::App;

/// Radius of the dial \[point\], and the wind that reaches its rim \[m/s\].
const RADIUS: f32 = 44.0;
const STRONGEST: f32 = 10.0;

/// Rectangle of the dial in the picture's area.
pub fn dial(room: Rect) -> Rect {
    let corner = room.right_bottom() - Vec2::splat(12.0 + 2.0 * RADIUS);
    Rect::from_min_size(corner - egui::vec2(0.0, 16.0), Vec2::splat(2.0 * RADIUS))
}

/// Draws the dial and handles its mouse.
pub fn show(app: &mut App, ui: &egui::Ui, room: Rect) {
    let rect = dial(room);
    let response = ui.interact(rect, ui.scope_id().with("wind"), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Canvas, true, "wind"));
    let view = app.camera.view_from_world();
    let mut seen = view.transform_vector3(app.scene.wind.velocity);
    let scroll = if response.hovered() { ui.input(|input| input.smooth_scroll_delta().y) } else { 0.0 };
    if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
        let place = (pointer - rect.center()) / RADIUS * STRONGEST;
        (seen.x, seen.y) = (place.x, -place.y);
    }
    // The wheel blows into the picture and out of it.
    seen.z += 0.02 * scroll;
    if response.double_clicked() {
        seen = Vec3::ZERO;
    }
    // Untouched components keep their value, however large.
    if response.dragged() || response.double_clicked() || scroll != 0.0 {
        let wind = view.inverse().transform_vector3(seen);
        app.scene.wind.velocity = wind.clamp_length_max(STRONGEST);
        app.live.send(Change::Wind(app.scene.wind.clone()));
    }
    response.on_hover_text(
        "the wind [m/s], seen from the camera\ndrag its tip; the wheel blows into the picture; a double click stops it\ndefault 0",
    );
    draw(ui, rect, view.transform_vector3(app.scene.wind.velocity));
}

fn draw(ui: &egui::Ui, rect: Rect, seen: Vec3) {
    let painter = ui.painter();
    let (middle, dark) = (rect.center(), Color32::from_black_alpha(90));
    painter.circle(middle, RADIUS, dark, Stroke::new(1.0, Color32::from_white_alpha(90)));
    let tip = middle + RADIUS / STRONGEST * egui::vec2(seen.x, -seen.y);
    let tip = middle + (tip - middle).normalized() * (tip - middle).length().min(RADIUS);
    let bright = Color32::from_rgb(190, 220, 255);
    painter.arrow(middle, tip - middle, Stroke::new(2.0, bright));
    painter.circle_filled(tip, 4.0, bright);
    let depth = match seen.z {
        z if z > 0.05 => format!(", {z:.1} toward you"),
        z if z < -0.05 => format!(", {:.1} away", -z),
        _ => String::new(),
    };
    let text = format!("wind {:.1} m/s{depth}", seen.length());
    let below = rect.right_bottom() + egui::vec2(0.0, 14.0);
    painter.text(below, Align2::RIGHT_BOTTOM, text, egui::FontId::proportional(11.0), bright);
}
