//! The lights. Each has a ball on which the light stands as the camera sees it: to be dragged around what
//! it points at.

use eframe::egui::{self, Color32, Sense, Stroke, Ui, Vec2};
use glam::Vec3;
use strandline::{
    Camera, Change, Light, Look,
    look::{LightKind, LightRig},
    settings::Group,
};

use crate::{
    App,
    controls::{button, choose, colour, slide, slide_in, tick},
};

/// Radius of a ball \[point\].
const BALL: f32 = 28.0;
/// Lights that a person may add; a scene may have more.
const MOST: usize = 8;

pub fn show(app: &mut App, ui: &mut Ui) {
    let (before, rig) = (app.scene.lights.clone(), app.scene.look.light_rig);
    let (look, base) = (&mut app.scene.look, &app.base.look);
    choose(ui, (&mut look.light_rig, base.light_rig), &LightRig::ALL, &Look::ROWS.light_rig, "all lights");
    if app.scene.look.light_rig != rig {
        app.send_look();
        // A picture of the surroundings comes before them.
        if app.scene.look.surroundings.is_none() {
            app.scene.lights = app.scene.look.lights(app.center);
        }
    }
    let (lights, camera) = (&mut app.scene.lights, &app.camera);
    let mut gone = None;
    // A scene without lights is lit by those of its look.
    let is_last = lights.len() == 1;
    for (index, light) in lights.iter_mut().enumerate() {
        let base = app.base.lights.get(index).copied().unwrap_or_default();
        ui.push_id(index, |ui| {
            if one(light, &base, camera, (index, is_last), ui) {
                gone = Some(index);
            }
        });
    }
    if let Some(index) = gone {
        lights.remove(index);
        // The others keep their own defaults.
        if index < app.base.lights.len() {
            app.base.lights.remove(index);
        }
    }
    if lights.len() < MOST && button(ui, "Add", "a spot with shadow that stands where you look from") {
        let (position, target) = (camera.position, camera.target);
        lights.push(Light { kind: LightKind::Spot, position, target, ..Light::default() });
    }
    if *lights != before {
        app.live.send(Change::Lights(app.scene.lights.clone()));
    }
}

/// The controls of a light; true if it is to be removed.
fn one(
    light: &mut Light,
    base: &Light,
    camera: &Camera,
    (index, is_last): (usize, bool),
    ui: &mut Ui,
) -> bool {
    let mut gone = false;
    ui.horizontal(|ui| {
        ball(light, camera, ui);
        ui.vertical(|ui| {
            ui.horizontal(|ui| {
                ui.strong(format!("light {}", index + 1));
                gone = !is_last && button(ui, "x", "removes this light");
            });
            choose(ui, (&mut light.kind, base.kind), &LightKind::ALL, &Light::ROWS.kind, "kind");
            tick(ui, (&mut light.shadow, base.shadow), &Light::ROWS.shadow, "shadow");
            if button(ui, "From here", "puts the light where you look from") {
                light.position = camera.position;
            }
        });
    });
    let rows = &Light::ROWS;
    colour(ui, (&mut light.color, base.color), &rows.color, "colour");
    slide(ui, (&mut light.intensity, base.intensity), &rows.intensity, "intensity");
    let offset = light.position - light.target;
    let (mut distance, default) = (offset.length(), (base.position - base.target).length());
    if slide_in(ui, (&mut distance, default), 0.2..=5.0, "distance", "from what it points at [m]") {
        light.position = light.target + offset.normalize_or(Vec3::Y) * distance;
    }
    if light.kind == LightKind::Spot {
        slide(ui, (&mut light.cone_angle, base.cone_angle), &rows.cone_angle, "cone");
    }
    if matches!(light.kind, LightKind::Rectangle | LightKind::Disc) {
        slide(ui, (&mut light.width, base.width), &rows.width, "width");
        if light.kind == LightKind::Rectangle {
            slide(ui, (&mut light.height, base.height), &rows.height, "height");
        }
        slide(ui, (&mut light.samples, base.samples), &rows.samples, "places");
    }
    ui.separator();
    gone
}

/// The light on its ball: a disc before, a ring behind what it points at.
fn ball(light: &mut Light, camera: &Camera, ui: &mut Ui) {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(2.0 * BALL), Sense::drag());
    let response = response.on_hover_text(
        "where the light stands, seen from the camera: drag it; beyond the rim it goes behind the hair",
    );
    let view = camera.view_from_world();
    let offset = light.position - light.target;
    if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
        let place = (pointer - rect.center()) / BALL;
        let direction = view.inverse().transform_vector3(on_ball(glam::Vec2::new(place.x, -place.y)));
        light.position = light.target + direction * offset.length();
    }
    let seen = view.transform_vector3(offset.normalize_or(Vec3::Y));
    let spot = rect.center() + BALL * egui::vec2(seen.x, -seen.y);
    let painter = ui.painter();
    painter.circle(rect.center(), BALL, Color32::from_gray(40), Stroke::new(1.0, Color32::GRAY));
    let [red, green, blue] = light.color.to_array().map(|part| (255.0 * part.clamp(0.0, 1.0).sqrt()) as u8);
    let shown = Color32::from_rgb(red, green, blue);
    if seen.z >= 0.0 {
        painter.circle_filled(spot, 5.0, shown);
    } else {
        painter.circle_stroke(spot, 4.0, Stroke::new(2.0, shown));
    }
}

/// The unit direction, view space, of a place on the ball in its radii: on its front, and from the rim on
/// on its back.
fn on_ball(place: glam::Vec2) -> Vec3 {
    let radius = place.length().min(2.0);
    let (aside, behind) = if radius > 1.0 { (2.0 - radius, true) } else { (radius, false) };
    let toward = (1.0 - aside * aside).max(0.0).sqrt();
    (place.normalize_or_zero() * aside).extend(if behind { -toward } else { toward }).normalize_or(Vec3::Z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_on_the_ball_is_a_direction() {
        assert_eq!(on_ball(glam::Vec2::ZERO), Vec3::Z);
        assert!(on_ball(glam::Vec2::X).distance(Vec3::X) < 1e-3);
        assert!(on_ball(glam::Vec2::new(0.0, 0.6)).distance(Vec3::new(0.0, 0.6, 0.8)) < 1e-6);
        assert!(on_ball(glam::Vec2::new(1.4, 0.0)).distance(Vec3::new(0.6, 0.0, -0.8)) < 1e-6);
        assert!(on_ball(glam::Vec2::new(9.0, 0.0)).distance(Vec3::NEG_Z) < 1e-6);
    }
}
