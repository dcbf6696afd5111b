//! Hair under a hat: strands that start beneath a part of the body are pressed under it.

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use strandline_base::math;

use super::sample::surface;
use super::skull::Skull;
use crate::{body::Mesh, groom::Groom};

/// Directions around and above the middle of the skull in which a part's surface is known.
const AROUND: usize = 96;
const HIGH: usize = 48;
/// Places of a part's surface that are looked at.
const PLACES: usize = 60_000;
/// Distance \[m\] of a part from the roots that it covers, and the largest over the width of the skull.
const GAP: f32 = 0.002;
const FAR: f32 = 0.5;
/// Distance \[m\] that pressed hair keeps from the part.
const UNDER: f32 = 0.003;
/// Share of the roots that a part covers to be taken for a hat.
const A_HAT: f32 = 0.15;

/// A part of the body that may cover hair, head space.
pub(super) struct Cover {
    pub mesh: Mesh,
    /// The name of its file.
    pub name: String,
    /// The setting of the scene: true presses hair, false leaves it, none lets the roots under it decide.
    pub covers: Option<bool>,
}

/// Presses the strands of a groom that start under a part beneath it, for each of some parts. Returns notes.
pub(super) fn press(groom: &mut Groom, covers: &[Cover], skull: Option<&Skull>) -> Vec<String> {
    let Some(skull) = skull else { return Vec::new() };
    let mut notes = Vec::new();
    for cover in covers.iter().filter(|cover| cover.covers != Some(false)) {
        let inner = Inner::new(&cover.mesh, skull);
        let is_under = |strand: &usize| inner.covers(groom.strand(*strand)[0]);
        let under: Vec<usize> = (0..groom.strand_count()).filter(is_under).collect();
        let is_hat = under.len() as f32 >= A_HAT * groom.strand_count() as f32;
        if under.is_empty() || !cover.covers.unwrap_or(is_hat) {
            continue;
        }
        for strand in &under {
            let range = groom.range(*strand);
            groom.points[range].iter_mut().for_each(|point| *point = inner.pressed(*point));
        }
        notes.push(format!(
            "{} covers the roots of {} strands, which start under it; in motion and between them hair may come through. \
             `covers = false` of its part of [body] leaves them as they are",
            cover.name,
            under.len()
        ));
    }
    notes
}

/// The inner surface of a part as it is seen from the middle of the skull.
struct Inner {
    middle: Vec3,
    /// The largest distance \[m\] of a part from the roots under it.
    far: f32,
    /// Its least distance \[m\] in each direction; infinite where nothing is.
    reach: Vec<f32>,
}

impl Inner {
    fn new(mesh: &Mesh, skull: &Skull) -> Self {
        let (middle, width) = (skull.center(), skull.size.x);
        let mut reach = vec![f32::INFINITY; AROUND * HIGH];
        for place in surface(mesh, PLACES) {
            let held = &mut reach[direction(place - middle)];
            *held = held.min(place.distance(middle));
        }
        Self { middle, far: FAR * width, reach }
    }

    /// Distance \[m\] of the part from the middle in the direction of a point.
    fn reach(&self, point: Vec3) -> f32 {
        self.reach[direction(point - self.middle)]
    }

    /// True for a root with the part over it.
    fn covers(&self, root: Vec3) -> bool {
        let (own, part) = (root.distance(self.middle), self.reach(root));
        part > own + GAP && part < own + self.far
    }

    /// A point, brought under the part where it lies beyond it.
    fn pressed(&self, point: Vec3) -> Vec3 {
        let (beside, most) = (point - self.middle, self.reach(point) - UNDER);
        if beside.length() > most { self.middle + beside * (most / beside.length()) } else { point }
    }
}

/// The index of a direction.
fn direction(beside: Vec3) -> usize {
    let height = (beside.y / beside.length().max(f32::MIN_POSITIVE)).clamp(-1.0, 1.0);
    let around = (math::atan2(beside.x, beside.z) / TAU).rem_euclid(1.0);
    let high = (math::acos(height) / PI * HIGH as f32) as usize;
    high.min(HIGH - 1) * AROUND + ((around * AROUND as f32) as usize).min(AROUND - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        body::Mannequin,
        groom::{Style, StyleSettings},
    };

    /// The upper part of the built-in head, larger: a cap, open below.
    fn cap(size: f32, skull: &Skull) -> Mesh {
        let head = Mannequin::new().mesh();
        let low = skull.top - 0.45 * skull.size.x;
        let is_high = |corners: &&[u32; 3]| corners.iter().all(|at| head.positions[*at as usize].y > low);
        let triangles = head.triangles.iter().filter(is_high).copied().collect();
        let larger = |place: &Vec3| skull.center() + (*place - skull.center()) * size;
        Mesh::new(head.positions.iter().map(larger).collect(), triangles).unwrap()
    }

    fn cover(size: f32, covers: Option<bool>) -> (Groom, Groom, Mesh, Vec<String>) {
        let skull = Skull::of_body(&Mannequin::new().mesh()).unwrap();
        let style = StyleSettings { strand_count: 500, ..StyleSettings::new(Style::Wavy) };
        let groom = style.grow().unwrap();
        let mesh = cap(size, &skull);
        let mut pressed = groom.clone();
        let part = Cover { mesh: mesh.clone(), name: "hat.obj".to_owned(), covers };
        let notes = press(&mut pressed, &[part], Some(&skull));
        (groom, pressed, mesh, notes)
    }

    #[test]
    fn hair_that_starts_under_a_hat_stays_under_it() {
        let (groom, pressed, hat, notes) = cover(1.18, None);
        let skull = Skull::of_body(&Mannequin::new().mesh()).unwrap();
        let inner = Inner::new(&hat, &skull);
        let through = |groom: &Groom| {
            let covered = (0..groom.strand_count()).filter(|strand| inner.covers(groom.strand(*strand)[0]));
            let points = covered.flat_map(|strand| groom.strand(strand));
            points.filter(|point| point.distance(inner.middle) > inner.reach(**point)).count()
        };
        assert!(through(&groom) > 200 && through(&pressed) == 0, "{} points", through(&groom));
        assert!(notes.len() == 1 && notes[0].contains("covers = false"), "{notes:?}");
        // Roots, and all that hangs below the rim, stay.
        assert!(groom.roots().zip(pressed.roots()).all(|(one, two)| one == two));
        let rim = hat.positions.iter().map(|place| place.y).fold(f32::INFINITY, f32::min);
        let pairs = groom.points.iter().zip(&pressed.points);
        assert!(pairs.clone().filter(|(one, two)| one == two).count() > 500);
        assert!(pairs.filter(|(one, two)| one != two).all(|(one, _)| one.y > rim - 0.3));
    }

    #[test]
    fn what_is_no_hat_presses_nothing() {
        // A scalp on the skin, and a hat that a scene says does not cover hair.
        for (size, covers) in [(1.0, None), (1.18, Some(false))] {
            let (groom, pressed, _, notes) = cover(size, covers);
            assert!(notes.is_empty() && groom.points == pressed.points, "{size}: {notes:?}");
        }
    }
}
