//! Evidence of how strands lie on a head: where roots are, how strands hang, a free face.

use std::f32::consts::TAU;

use glam::{DMat3, DVec3, Vec3};
use strandline_base::math;

use super::skull::Skull;
use crate::groom::Groom;

/// Strands whose points are looked at, points of each, and roots that are looked at.
const STRANDS: usize = 150;
const POINTS: usize = 8;
const ROOTS: usize = 800;
/// Directions that roots of a head of hair lie in, and the shares of them that are those of a full head of hair: more
/// than a beard and less than fur. Around a ball through them the roots of a beard may cover as much as those of little
/// hair.
const DIRECTIONS: usize = 120;
const FULL: std::ops::Range<f32> = 0.18..0.85;
const SURELY_FULL: f32 = 0.3;
/// Volume of roots over the cube of their size below which they lie in a plane.
const FLAT: f64 = 1e-5;
/// Depth below the crown over the width of a skull: of its middle, and of the brows.
const MIDDLE: f32 = 0.7;
const BROWS: f32 = 0.5;
/// Width of a face and its depth before the middle, over those of the skull.
const FACE: [f32; 2] = [0.35, 0.25];
/// Weights of what speaks for a pose: strands hang, roots lie high, roots leave the face free, hair lies at the back.
const HANG: f32 = 3.0;
const HIGH: f32 = 2.0;
const FREE: f32 = 5.0;
const BEHIND: f32 = 3.0;
/// Length over the width of the skull from which on hair surely hangs.
const LONG: f32 = 0.5;

/// Some strands of a groom.
#[derive(Clone)]
pub(super) struct Hair {
    /// Points of some strands, from the root to the tip.
    pub strands: Vec<Vec<Vec3>>,
    /// Roots of more strands.
    roots: Vec<Vec3>,
}

impl Hair {
    /// Of all strands of some grooms, in units of their files.
    pub fn new(grooms: &[&Groom]) -> Self {
        let count: usize = grooms.iter().map(|groom| groom.strand_count()).sum();
        let all =
            || grooms.iter().flat_map(|groom| (0..groom.strand_count()).map(|strand| groom.strand(strand)));
        let few = |strand: &[Vec3]| {
            let last = strand.len() - 1;
            let count = last.clamp(1, POINTS - 1);
            (0..=count).map(|point| strand[point * last / count]).collect()
        };
        Self {
            strands: all().step_by(count.div_ceil(STRANDS).max(1)).map(few).collect(),
            roots: all().step_by(count.div_ceil(ROOTS).max(1)).map(|strand| strand[0]).collect(),
        }
    }

    /// The same strands at other places.
    pub fn placed(&self, place: impl Fn(Vec3) -> Vec3) -> Self {
        let strands = self.strands.iter().map(|strand| strand.iter().map(|point| place(*point)).collect());
        Self { strands: strands.collect(), roots: self.roots.iter().map(|root| place(*root)).collect() }
    }

    /// Every n-th of the strands whose points are looked at.
    pub fn fewer(&self, every: usize) -> Self {
        Self { strands: self.strands.iter().step_by(every).cloned().collect(), roots: self.roots.clone() }
    }

    /// Roots of the strands whose points are looked at.
    pub fn roots(&self) -> impl Iterator<Item = Vec3> {
        self.strands.iter().map(|strand| strand[0])
    }

    /// All roots that are looked at.
    pub fn many_roots(&self) -> &[Vec3] {
        &self.roots
    }

    /// Distance of roots from their middle, or a part of the strands' length where that is larger.
    pub fn size(&self) -> f32 {
        let middle = mean(self.roots.iter().copied());
        let spread = mean_of(self.roots.iter().map(|root| root.distance_squared(middle))).sqrt();
        spread.max(0.25 * self.length())
    }

    /// Mean distance of tips from roots.
    pub fn length(&self) -> f32 {
        mean_of(self.strands.iter().map(|strand| way(strand).length()))
    }

    /// Mean share of the way from root to tip that leads down: 1 hangs, -1 stands.
    pub fn hangs(&self) -> f32 {
        mean_of(self.strands.iter().map(|strand| -way(strand).normalize_or_zero().y))
    }

    /// True where roots lie around a middle as those of a full head of hair do; the middle is that of a ball through
    /// them where it is not known.
    pub fn is_full(&self, middle: Option<Vec3>) -> bool {
        FULL.contains(&self.covered(middle))
    }

    /// True where roots lie around the middle of a ball through them as those of no beard do, in whatever axes.
    pub fn is_surely_full(&self) -> bool {
        (SURELY_FULL..FULL.end).contains(&self.covered(None))
    }

    /// Share of the directions from a middle in which roots lie; 0 where they lie in a plane.
    fn covered(&self, middle: Option<Vec3>) -> f32 {
        let Some(middle) = middle.or_else(|| Some(self.ball()?.0)) else { return 0.0 };
        let mut has = [false; DIRECTIONS];
        for root in &self.roots {
            let way = (*root - middle).normalize_or_zero();
            let alike = |index: usize| direction(index).dot(way);
            let nearest =
                (1..DIRECTIONS).fold(0, |best, one| if alike(one) > alike(best) { one } else { best });
            has[nearest] = true;
        }
        has.iter().filter(|has| **has).count() as f32 / DIRECTIONS as f32
    }

    /// Middle and radius of the ball that roots lie on; none where they lie in a plane.
    fn ball(&self) -> Option<(Vec3, f32)> {
        let middle = mean(self.roots.iter().copied()).as_dvec3();
        let count = self.roots.len() as f64;
        let (mut spread, mut pull) = (DMat3::ZERO, DVec3::ZERO);
        for root in &self.roots {
            let beside = root.as_dvec3() - middle;
            spread +=
                DMat3::from_cols(beside * beside.x, beside * beside.y, beside * beside.z) * (1.0 / count);
            pull += beside * (beside.length_squared() / count);
        }
        let size = spread.x_axis.x + spread.y_axis.y + spread.z_axis.z;
        if spread.determinant().abs() <= FLAT * size * size * size {
            return None;
        }
        // The least squares of |p|^2 = 2 c p + k.
        let center = (middle + 0.5 * (spread.inverse() * pull)).as_vec3();
        Some((center, mean_of(self.roots.iter().map(|root| root.distance(center)))))
    }

    /// Evidence for hair alone to stand upright: strands hang and roots lie high on the ball through them.
    pub fn upright(&self) -> f32 {
        let high = self.ball().map_or(0.0, |(middle, radius)| {
            (mean(self.roots.iter().copied()).y - middle.y) / radius.max(f32::MIN_POSITIVE)
        });
        HANG * self.hangs() + HIGH * high.clamp(-1.0, 1.0)
    }

    /// Mean height of roots over the middle of a skull, over half of its width, each from -1 to 1.
    pub fn high(&self, skull: &Skull) -> f32 {
        let half = 0.5 * skull.size.x;
        mean_of(self.roots.iter().map(|root| ((root.y - skull.top) / half + 2.0 * MIDDLE).clamp(-1.0, 1.0)))
    }

    /// Share of roots that lie on the face of a head that looks along +z.
    pub fn on_face(&self, skull: &Skull) -> f32 {
        let [width, depth] = skull.size.to_array();
        let is_face = |root: &&Vec3| {
            root.z - skull.middle.y > FACE[1] * depth
                && root.y < skull.top - BROWS * width
                && (root.x - skull.middle.x).abs() < FACE[0] * width
        };
        self.roots.iter().filter(is_face).count() as f32 / self.roots.len().max(1) as f32
    }

    /// True where roots lie in the front half of the head in the mean.
    pub fn is_ahead(&self, skull: &Skull) -> bool {
        mean(self.roots.iter().copied()).z > skull.middle.y
    }

    /// Evidence for hair to lie on a head as hair does; that of its back counts where the head shows its front.
    pub fn on(&self, skull: &Skull, shows_front: bool) -> f32 {
        let long = (self.length() / (LONG * skull.size.x)).clamp(0.0, 1.0);
        let found = HANG * long * self.hangs() + HIGH * self.high(skull);
        if !shows_front {
            return found;
        }
        let ahead = |point: &Vec3| ((point.z - skull.middle.y) / (0.5 * skull.size.y)).clamp(-1.0, 1.0);
        found - FREE * self.on_face(skull) - BEHIND * mean_of(self.strands.iter().flatten().map(ahead))
    }
}

fn way(strand: &[Vec3]) -> Vec3 {
    strand[strand.len() - 1] - strand[0]
}

fn mean(places: impl Iterator<Item = Vec3>) -> Vec3 {
    let (sum, count) = places.fold((Vec3::ZERO, 0.0_f32), |(sum, count), place| (sum + place, count + 1.0));
    sum / count.max(1.0)
}

fn mean_of(values: impl Iterator<Item = f32>) -> f32 {
    let (sum, count) = values.fold((0.0_f32, 0.0_f32), |(sum, count), value| (sum + value, count + 1.0));
    sum / count.max(1.0)
}

/// One of many directions, spread evenly.
fn direction(index: usize) -> Vec3 {
    let height = 1.0 - (2 * index + 1) as f32 / DIRECTIONS as f32;
    let (flat, around) = ((1.0 - height * height).sqrt(), (0.618_034 * index as f32).fract() * TAU);
    let beside = math::unit_at(around) * flat;
    Vec3::new(beside.x, height, beside.y)
}
