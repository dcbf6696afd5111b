//! Hair under a hat: strands that start beneath a part of the body are pressed under it.

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use strandline_base::{counted, math};

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
/// Least distance \[m\] that pressed hair keeps from the part, and that over the gap between part and roots: drawn
/// strands lie around those that are pressed.
const UNDER: f32 = 0.003;
const OF_GAP: f32 = 0.6;
/// Rounds in which a segment under the part gets its length back.
const ROUNDS: usize = 4;
/// Share of the roots that a part covers to be taken for a hat.
const A_HAT: f32 = 0.15;

/// A part of the body that may cover hair, head space.
pub(super) struct Cover {
    pub mesh: Mesh,
    /// The name of its file.
    pub name: String,
    /// The setting of the scene: true presses hair, false leaves it, none lets the roots under it decide.
    pub covers: Option<bool>,
    /// True if hair hits it.
    pub is_solid: bool,
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
        let inner = inner.above(under.iter().map(|strand| groom.strand(*strand)[0]));
        for strand in &under {
            let range = groom.range(*strand);
            inner.press(&mut groom.points[range]);
        }
        notes.push(format!(
            "{} covers the roots of {} under it; in motion and between them hair may come through. \
             `covers = false` of its part of [body] leaves them as they are",
            cover.name,
            counted(under.len(), "strand, which starts", "strands, which start")
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
    /// Distance \[m\] that pressed hair keeps from it.
    under: f32,
}

impl Inner {
    fn new(mesh: &Mesh, skull: &Skull) -> Self {
        let (middle, width) = (skull.center(), skull.size.x);
        let mut reach = vec![f32::INFINITY; AROUND * HIGH];
        for place in surface(mesh, PLACES) {
            let held = &mut reach[direction(place - middle)];
            *held = held.min(place.distance(middle));
        }
        Self { middle, far: FAR * width, reach, under: UNDER }
    }

    /// The same surface above some roots, from which pressed hair keeps a share of the gap.
    fn above(self, roots: impl Iterator<Item = Vec3>) -> Self {
        let mut gaps: Vec<f32> = roots.map(|root| self.reach(root) - root.distance(self.middle)).collect();
        gaps.sort_by(f32::total_cmp);
        let gap = gaps.get(gaps.len() / 2).copied().unwrap_or(0.0);
        Self { under: UNDER.max(OF_GAP * gap), ..self }
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
        let (beside, most) = (point - self.middle, self.reach(point) - self.under);
        if beside.length() > most { self.middle + beside * (most / beside.length()) } else { point }
    }

    /// Presses a strand from its root on. Segments keep their lengths, and those beyond the rim their ways.
    fn press(&self, strand: &mut [Vec3]) {
        let mut before = strand[0];
        for index in 1..strand.len() {
            let segment = strand[index] - before;
            before = strand[index];
            let (start, length) = (strand[index - 1], segment.length());
            let mut point = start + segment;
            for _ in 0..ROUNDS {
                let pressed = self.pressed(point);
                if pressed == point {
                    break;
                }
                point = start + self.along(start, pressed - start).normalize_or_zero() * length;
            }
            strand[index] = self.pressed(point);
        }
    }

    /// A way from a place under the part: the way itself, or down along the part where that leads nowhere.
    fn along(&self, place: Vec3, way: Vec3) -> Vec3 {
        let out = (place - self.middle).normalize_or_zero();
        let flat = way - out * way.dot(out);
        if flat.length() > 0.1 * self.under { way } else { way + (out * out.y - Vec3::Y) * self.under }
    }
}

/// The index of a direction. Rings near the poles have fewer cells, so that each cell sees enough places of a surface.
fn direction(beside: Vec3) -> usize {
    let height = (beside.y / beside.length().max(f32::MIN_POSITIVE)).clamp(-1.0, 1.0);
    let around = (math::atan2(beside.x, beside.z) / TAU).rem_euclid(1.0);
    let high = ((math::acos(height) / PI * HIGH as f32) as usize).min(HIGH - 1);
    let ring = math::unit_at((high as f32 + 0.5) / HIGH as f32 * PI);
    let cells = (AROUND as f32 * ring.y).ceil().max(1.0);
    high * AROUND + ((around * cells) as usize).min(cells as usize - 1)
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
        let part = Cover { mesh: mesh.clone(), name: "hat.obj".to_owned(), covers, is_solid: true };
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
        // Roots, and all strands that start beside it, stay.
        assert!(groom.roots().zip(pressed.roots()).all(|(one, two)| one == two));
        let strands = 0..groom.strand_count();
        let beside = strands.clone().filter(|strand| !inner.covers(groom.strand(*strand)[0]));
        assert!(beside.clone().count() > 0, "{} strands", beside.count());
        assert!(beside.clone().all(|strand| groom.strand(strand) == pressed.strand(strand)));
        // Lengths stay, and nothing stands out at the rim: no segment leads from under it to where it was.
        let lengths = groom.lengths().into_iter().zip(pressed.lengths());
        let shorter = lengths.filter(|(one, two)| two / one < 0.95).count();
        assert!(shorter < 25, "{shorter} strands are shorter");
        let segments = |groom: &Groom, strand: usize| -> Vec<f32> {
            groom.strand(strand).windows(2).map(|pair| pair[0].distance(pair[1])).collect()
        };
        let longer = |strand: usize| {
            let pairs = segments(&pressed, strand).into_iter().zip(segments(&groom, strand));
            pairs.map(|(now, own)| now - own).fold(0.0, f32::max)
        };
        let apart = strands.filter(|strand| longer(*strand) > 0.01).count();
        assert!(apart < 25, "segments of {apart} strands are a centimetre longer");
        // Drawn strands have room between these and the hat.
        let near = (0..groom.strand_count()).filter(|strand| inner.covers(groom.strand(*strand)[0]));
        let near = near.flat_map(|strand| pressed.strand(strand));
        let near = near.filter(|point| point.distance(inner.middle) > inner.reach(**point) - 0.006).count();
        assert!(near == 0, "{near} points lie at the hat");
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
