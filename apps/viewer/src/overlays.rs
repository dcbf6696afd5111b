//! Overlays over the picture: the guides, coloured by a number of the hair.

use eframe::egui::{self, Align2, Color32, FontId, Mesh, Pos2, Rect, Shape, Ui, Vec2, lerp};
use strandline::{
    Camera,
    live::{Command, Overlaid, Overlay},
};

use crate::{App, compared::Split};

/// Half of the width of a line, and radius of a root \[point\].
const HALF: f32 = 0.7;
const ROOT: f32 = 1.8;
/// Lines that are drawn at most: of more guides every n-th.
const MOST: usize = 60_000;
/// Colours from the least to the largest number, and those of numbers about 0.
const RISING: [Color32; 4] = [
    Color32::from_rgb(40, 70, 190),
    Color32::from_rgb(60, 200, 200),
    Color32::from_rgb(250, 220, 60),
    Color32::from_rgb(230, 50, 30),
];
const SIGNED: [Color32; 3] =
    [Color32::from_rgb(50, 110, 255), Color32::from_rgb(235, 235, 235), Color32::from_rgb(255, 60, 40)];
/// Colour of guides and roots without a number.
const PLAIN: Color32 = Color32::from_rgb(255, 200, 60);

impl App {
    /// Shows an overlay over the picture, or none.
    pub fn overlay(&mut self, overlay: Option<Overlay>) {
        self.overlay = overlay;
        self.live.send(Command::Overlay(overlay));
    }

    /// Goes to the next overlay; after the last there is none.
    pub(crate) fn next_overlay(&mut self) {
        let at = self.overlay.and_then(|now| Overlay::ALL.iter().position(|other| *other == now));
        self.overlay(Overlay::ALL.get(at.map_or(0, |at| at + 1)).copied());
    }
}

/// The menu of overlays.
pub fn menu(app: &mut App, ui: &mut Ui) {
    let mut wanted = app.overlay;
    let name = |overlay: Option<Overlay>| overlay.map_or("none", Overlay::name);
    let list = egui::ComboBox::from_label("overlay").width(80.0).selected_text(name(wanted));
    let list = list.show_ui(ui, |ui| {
        ui.selectable_value(&mut wanted, None, "none").on_hover_text("the picture alone");
        for overlay in Overlay::ALL {
            ui.selectable_value(&mut wanted, Some(overlay), overlay.name()).on_hover_text(overlay.sentence());
        }
    });
    list.response
        .on_hover_text("the guides over the picture, coloured by a number of the hair: L\ndefault none");
    if wanted != app.overlay {
        app.overlay(wanted);
    }
}

/// Draws the overlay of the shown picture, with the legend of its colours.
pub fn show(app: &App, ui: &Ui, picture: Rect, room: Rect) {
    let Some(shown) = &app.shown else { return };
    let (Some(overlaid), Some(camera)) = (&shown.overlaid, &shown.camera) else { return };
    let clip = match &app.compare {
        Some(compare) if compare.split == Split::Beside => return,
        Some(compare) => picture.with_min_x(picture.left() + compare.at * picture.width()),
        None => picture,
    };
    lines(overlaid, camera, &ui.painter().with_clip_rect(clip), picture);
    legend(overlaid, ui, room);
}

/// Draws the lines of an overlay into a picture's rectangle.
pub fn lines(overlaid: &Overlaid, camera: &Camera, painter: &egui::Painter, picture: Rect) {
    let view = camera.view_from_world();
    let scale = 0.5 * picture.height() * camera.focal();
    let seen = |index: usize| {
        let place = view.transform_point3(overlaid.points[index]);
        let is_seen = -place.z > camera.near && !overlaid.hidden[index];
        is_seen.then(|| picture.center() + egui::vec2(place.x, -place.y) * (scale / -place.z))
    };
    let each = overlaid.points_per_strand.max(1);
    let strands = overlaid.points.len() / each;
    let step = (strands * each).div_ceil(MOST).max(1);
    let mut mesh = Mesh::default();
    for strand in (0..strands).step_by(step) {
        let mut before = None;
        for index in strand * each..(strand + 1) * each {
            let now = seen(index).map(|place| (place, colour(overlaid, index)));
            match (before, now) {
                (_, Some((place, colour))) if each == 1 => quad(&mut mesh, dot(place), [colour; 4]),
                (Some((from, first)), Some((to, second))) => {
                    quad(&mut mesh, line(from, to), [first, first, second, second]);
                }
                _ => {}
            }
            before = now;
        }
    }
    painter.add(Shape::mesh(mesh));
}

/// Corners of a line of even width.
fn line(from: Pos2, to: Pos2) -> [Pos2; 4] {
    let aside = HALF * (to - from).normalized().rot90();
    [from - aside, from + aside, to + aside, to - aside]
}

fn dot(place: Pos2) -> [Pos2; 4] {
    [Vec2::new(-ROOT, 0.0), Vec2::new(0.0, -ROOT), Vec2::new(ROOT, 0.0), Vec2::new(0.0, ROOT)]
        .map(|way| place + way)
}

fn quad(mesh: &mut Mesh, corners: [Pos2; 4], colours: [Color32; 4]) {
    let first = mesh.vertices.len() as u32;
    corners.into_iter().zip(colours).for_each(|(corner, colour)| mesh.colored_vertex(corner, colour));
    mesh.add_triangle(first, first + 1, first + 2);
    mesh.add_triangle(first, first + 2, first + 3);
}

/// Colour of a point.
fn colour(overlaid: &Overlaid, index: usize) -> Color32 {
    let Some(value) = overlaid.values.get(index) else { return PLAIN };
    let [low, high] = overlaid.range;
    let share = ((value - low) / (high - low)).clamp(0.0, 1.0);
    share_colour(overlaid.overlay, if share.is_finite() { share } else { 0.0 }, *value)
}

/// Colour of a number at a share of its range.
fn share_colour(overlay: Overlay, share: f32, value: f32) -> Color32 {
    match overlay {
        Overlay::Guides | Overlay::Roots => PLAIN,
        Overlay::Speed | Overlay::Stiffness => along(&RISING, share),
        Overlay::Contact => along(&RISING, 1.0 - share),
        Overlay::Stretch => along(&SIGNED, share),
        // Numbers beside each other have colours far apart.
        Overlay::Group => egui::ecolor::Hsva::new((0.61803 * value).fract(), 0.8, 0.95, 1.0).into(),
    }
}

fn along(colours: &[Color32], share: f32) -> Color32 {
    let place = share * (colours.len() - 1) as f32;
    let index = (place as usize).min(colours.len() - 2);
    colours[index].lerp_to_gamma(colours[index + 1], place - index as f32)
}

/// The meaning of the colours, under the tools of the mouse.
fn legend(overlaid: &Overlaid, ui: &Ui, room: Rect) {
    const BAR: Vec2 = Vec2::new(160.0, 8.0);
    let (overlay, painter) = (overlaid.overlay, ui.painter());
    let corner = room.min + egui::vec2(10.0, 42.0);
    let back = Rect::from_min_size(corner - Vec2::splat(5.0), egui::vec2(360.0, 44.0));
    let words = |place: Pos2, align: Align2, text: String| {
        painter.text(place, align, text, FontId::proportional(11.5), Color32::WHITE)
    };
    painter.rect_filled(back.intersect(room), 3.0, Color32::from_black_alpha(150));
    words(corner, Align2::LEFT_TOP, overlay.sentence().to_owned());
    let line = corner + egui::vec2(0.0, 20.0);
    if overlaid.values.is_empty() {
        let text = match overlay {
            Overlay::Guides | Overlay::Roots => {
                format!("{} guides", overlaid.points.len() / overlaid.points_per_strand.max(1))
            }
            _ => format!("this hair has no {}", overlay.name()),
        };
        words(line, Align2::LEFT_TOP, text);
        return;
    }
    let [low, high] = overlaid.range;
    if overlay == Overlay::Group {
        let mut groups: Vec<u32> = overlaid.values.iter().map(|group| *group as u32).collect();
        groups.sort_unstable();
        groups.dedup();
        for (index, group) in groups.iter().take(10).enumerate() {
            let place = line + egui::vec2(34.0 * index as f32, 0.0);
            let box_ = Rect::from_min_size(place + egui::vec2(0.0, 3.0), Vec2::splat(8.0));
            painter.rect_filled(box_, 1.0, share_colour(overlay, 0.0, *group as f32));
            words(place + egui::vec2(11.0, 0.0), Align2::LEFT_TOP, group.to_string());
        }
        return;
    }
    let number = |value: f32| crate::controls::number(f64::from(value));
    let low_end = words(line, Align2::LEFT_TOP, number(low));
    let bar = Rect::from_min_size(egui::pos2(low_end.right() + 6.0, line.y + 4.0), BAR);
    let mut mesh = Mesh::default();
    for part in 0..16 {
        let [from, to] = [part, part + 1].map(|at| at as f32 / 16.0);
        let [left, right] = [from, to].map(|share| lerp(bar.left()..=bar.right(), share));
        let [first, second] = [from, to].map(|share| share_colour(overlay, share, 0.0));
        let corners = [bar.left_bottom(), bar.left_top(), bar.left_top(), bar.left_bottom()];
        let corners = [0, 1, 2, 3].map(|at| egui::pos2(if at < 2 { left } else { right }, corners[at].y));
        quad(&mut mesh, corners, [first, first, second, second]);
    }
    painter.add(Shape::mesh(mesh));
    words(
        egui::pos2(bar.right() + 6.0, line.y),
        Align2::LEFT_TOP,
        format!("{} {}", number(high), overlay.unit()),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_run_from_end_to_end_and_groups_differ() {
        assert_eq!(share_colour(Overlay::Speed, 0.0, 0.0), RISING[0]);
        assert_eq!(share_colour(Overlay::Speed, 1.0, 0.0), RISING[3]);
        assert_eq!(share_colour(Overlay::Contact, 0.0, 0.0), RISING[3], "what touches is red");
        assert_eq!(share_colour(Overlay::Stretch, 0.5, 0.0), SIGNED[1]);
        let groups: Vec<Color32> =
            (0..8).map(|group| share_colour(Overlay::Group, 0.0, group as f32)).collect();
        assert!((0..8).all(|one| (0..one).all(|other| groups[one] != groups[other])));
    }
}
