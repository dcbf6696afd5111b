//! Evidence of how strands lie on a head: where roots are, how strands hang, a free face.

use glam::Vec3;

use super::skull::Skull;
use crate::groom::{
    Groom, RootBall,
    root_ball::{self, covered},
};

/// Strands whose points are looked at, points of each, and roots that are looked at.
const STRANDS: usize = 150;
const POINTS: usize = 8;
const ROOTS: usize = 800;
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
        root_ball::FULL.contains(&self.covered(middle))
    }

    /// True where roots lie around the middle of a ball through them as those of no beard do, in whatever axes.
    pub fn is_surely_full(&self) -> bool {
        (root_ball::SURELY_FULL..root_ball::FULL.end).contains(&self.covered(None))
    }

    /// Share of the directions from a middle in which roots lie; 0 where they lie in a plane.
    fn covered(&self, middle: Option<Vec3>) -> f32 {
        let middle = middle.or_else(|| Some(RootBall::through(&self.roots)?.middle));
        middle.map_or(0.0, |middle| covered(&self.roots, middle))
    }

    /// Evidence for hair alone to stand upright: strands hang and roots lie high on the ball through them.
    pub fn upright(&self) -> f32 {
        let high = RootBall::through(&self.roots).map_or(0.0, |RootBall { middle, radius }| {
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
