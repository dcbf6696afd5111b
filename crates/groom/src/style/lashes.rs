//! Lashes: single hairs along the margins of both lids, bent away from the eye.

use glam::{Vec2, Vec3};
use strandline_base::math;
use strandline_body::{Random, Root};

use super::StyleSettings;
use super::skin::Skin;
use super::strand::Strand;

/// Lashes of an upper and of a lower lid.
const COUNTS: [usize; 2] = [120, 75];
/// Places in the rows from one lash to the next; it shares no factor with the number of lashes of an eye.
const STRIDE: usize = 73;
/// Ends of the rows, as shares of the way from the middle of an eye to its outer corner.
const ROWS: [[f32; 2]; 2] = [[-0.80, 0.94], [-0.62, 0.92]];
/// Distance \[m\] of the rows from the margin, and how wide they are.
const OFF_MARGIN: f32 = 0.0003;
const ROW_WIDTH: f32 = 0.0009;
/// Length of the lower lid's lashes over that of the upper lid's.
const LOWER: f32 = 0.65;
/// Pitch \[rad\] of a lash at its root and at its tip over that of its lid, for either lid: they bend apart.
const PITCH: [[f32; 2]; 2] = [[-0.35, 0.85], [0.05, -0.75]];
/// Turn \[rad\] toward the side of a lash at the outer end of its row.
const FAN: f32 = 0.75;
/// Radius \[m\] of a lash: the strands that stand for one lie in it.
const RADIUS: f32 = 5e-5;
/// Place \[m\] before the face, along z, from which roots are looked for.
const BEFORE: f32 = 0.16;

/// A lash: its eye, its lid, and its place in the row, from -1 to 1.
struct Lash {
    side: f32,
    lid: usize,
    across: f32,
}

/// One strand. Strands beyond the number of lashes lie in the lashes of the first.
pub(super) fn strand(settings: &StyleSettings, skin: &Skin, index: usize) -> Strand {
    let lash = index % (2 * (COUNTS[0] + COUNTS[1]));
    let mut random = Random::new(settings.seed, 15_000_000_000 + lash as u64);
    let place = place(lash, &mut random);
    let mut own = Random::new(settings.seed, 16_000_000_000 + index as u64);
    let aside = RADIUS * own.unit().sqrt() * math::unit_at(std::f32::consts::TAU * own.unit());
    let (root, pitch) = root(skin, &place, aside, &mut random);
    // Short at the inner corner, longest beyond the middle.
    let profile = 1.0 - 0.3 * (place.across - 0.35).powi(2);
    let of_lid = if place.lid == 0 { 1.0 } else { LOWER };
    let length = settings.length * of_lid * profile * (1.0 - settings.length_variation * random.unit());
    let disorder = settings.noise / settings.length.max(1e-4);
    let yaw = FAN * place.across + 2.0 * disorder * random.signed();
    let [from, to] = PITCH[place.lid].map(|turn| pitch + turn + disorder * random.signed());
    let last = settings.points() - 1;
    let step = length / last as f32;
    let mut points = vec![root.position];
    let mut point = root.position;
    for index in 0..last {
        let share = (index as f32 + 0.5) / last as f32;
        let (up, level) = math::sin_cos(from + (to - from) * share);
        let (across, ahead) = math::sin_cos(yaw);
        // The strands of a lash meet in its tip.
        let closing = aside.extend(0.0) / last as f32;
        point += Vec3::new(place.side * across * level, up, ahead * level) * step - closing;
        points.push(point);
    }
    Strand { root, side: place.side, points }
}

/// The place of a lash: rows are filled evenly, a little out of order.
fn place(lash: usize, random: &mut Random) -> Lash {
    let side = if lash.is_multiple_of(2) { 1.0 } else { -1.0 };
    // The first few reach from end to end of both lids.
    let of_eye = lash / 2 * STRIDE % (COUNTS[0] + COUNTS[1]);
    let (lid, index) = if of_eye < COUNTS[0] { (0, of_eye) } else { (1, of_eye - COUNTS[0]) };
    let share = (index as f32 + 0.5 + 0.45 * random.signed()) / COUNTS[lid] as f32;
    let [inner, outer] = ROWS[lid];
    Lash { side, lid, across: inner + (outer - inner) * share }
}

/// The root of a lash on the margin of its lid, and the pitch \[rad\] of the lid there: it turns about the eyeball.
fn root(skin: &Skin, place: &Lash, aside: Vec2, random: &mut Random) -> (Root, f32) {
    let mannequin = skin.mannequin();
    let margin = mannequin.lid_margin(place.across, place.lid == 0);
    let away = OFF_MARGIN + ROW_WIDTH * random.unit();
    let up = margin.y + if place.lid == 0 { away } else { -away };
    let start = Vec3::new(place.side * margin.x, up, BEFORE) + aside.extend(0.0);
    let eye = mannequin.eye_center() * Vec3::new(place.side, 1.0, 1.0);
    let (position, normal) = mannequin.nearest_skin(skin.first_along(start, Vec3::NEG_Z).unwrap_or(eye));
    let from_eye = position - eye;
    let pitch = math::atan2(from_eye.y, from_eye.z);
    let uv = Vec2::new(0.5 + 2.0 * position.x, 0.5 + 2.0 * position.y).clamp(Vec2::ZERO, Vec2::ONE);
    (Root { position, normal, uv }, pitch)
}
