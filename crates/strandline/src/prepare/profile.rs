//! The profile of a head: how far its surface reaches in every direction, compared with that of the built-in head.

use std::f32::consts::TAU;

use glam::Vec3;
use strandline_base::math;

use super::skull::Skull;

/// Directions around the vertical axis, and sines of the heights between which they are taken together.
const AROUND: usize = 12;
const HEIGHTS: [f32; 9] = [-0.8, -0.6, -0.4, -0.2, 0.0, 0.25, 0.55, 0.8, 1.0];
/// Depth of the middle below the crown over the mean of width and depth, and the distance up to which a place counts.
const MIDDLE: f32 = 0.6;
const FAR: f32 = 1.0;
/// Difference in a direction in which there is nothing, and the largest.
const NOTHING: f32 = 0.15;
const MOST: f32 = 0.3;
/// Share of the directions that counts: those most alike. Ears and hair stand out in the others.
const ALIKE: f32 = 0.9;
/// Depth of a head over its width.
const DEPTH: f32 = 1.3;
/// Heights below the crown over the width between which a nose is looked for, the steps, and half a step's reach.
const NOSE: std::ops::Range<f32> = 0.5..1.35;
const STEP: f32 = 0.05;
const REACH: f32 = 0.06;
/// Distance from the middle, over the width, up to which there is a nose, and those between which there are cheeks.
const RIDGE: f32 = 0.07;
const CHEEKS: std::ops::Range<f32> = 0.14..0.26;
/// Reach of a nose before the cheeks, over the width of the skull, that shows a face, and the weights of a missing one
/// and of another depth in the difference.
const A_NOSE: f32 = 0.12;
const WEIGHT: f32 = 0.1;

/// Reach of the built-in head in every direction \[mean of width and depth\]. Making that head takes a fifth of a second.
#[rustfmt::skip]
const PERSON: [[f32; AROUND]; HEIGHTS.len() - 1] = [
    [0.8311434, 0.77187526, 0.6755872, 0.5822593, 0.5614228, 0.58840114, 0.588802, 0.58496404, 0.55372787, 0.60149056, 0.6901132, 0.78656363],
    [0.7229603, 0.6526748, 0.5752019, 0.5688431, 0.509855, 0.5296721, 0.5389398, 0.52673614, 0.51000077, 0.57642925, 0.593239, 0.6487995],
    [0.7107555, 0.56673574, 0.54200673, 0.5700567, 0.54365474, 0.54383737, 0.5474182, 0.5455975, 0.5499768, 0.5700693, 0.5498007, 0.56369483],
    [0.58284014, 0.5410556, 0.4938338, 0.5443241, 0.53271043, 0.5495196, 0.5536287, 0.5540028, 0.5165555, 0.5454453, 0.49482265, 0.5351998],
    [0.5680296, 0.56542546, 0.48630184, 0.45725697, 0.5253862, 0.5742911, 0.57794064, 0.5708489, 0.53010684, 0.46472958, 0.49281862, 0.5644124],
    [0.579289, 0.5734574, 0.5121208, 0.4961627, 0.5514068, 0.6007457, 0.6070316, 0.6002423, 0.56267595, 0.49939317, 0.53047085, 0.5765437],
    [0.6059843, 0.60037327, 0.57980204, 0.5653681, 0.5924022, 0.6115382, 0.61774576, 0.61295, 0.59296674, 0.5648684, 0.57055396, 0.60022277],
    [0.6081058, 0.6037722, 0.5999695, 0.598266, 0.59885967, 0.6075676, 0.6144425, 0.6118304, 0.59933233, 0.599575, 0.5994669, 0.60525465],
];

/// Reach of a head in every direction \[mean of width and depth\]; none where nothing is.
pub(super) struct Profile {
    reach: [[Option<f32>; AROUND]; HEIGHTS.len() - 1],
    /// Depth over width.
    depth: f32,
    /// Reach of a ridge in the middle before its sides, in front beyond that at the back and the other way \[width\].
    pub noses: [f32; 2],
}

impl Profile {
    /// Of places all over the surface of a body that stands upright; none where there is no head.
    pub fn of(places: &[Vec3]) -> Option<Self> {
        let skull = Skull::without_ears(places)?;
        let unit = 0.5 * skull.size.element_sum();
        let middle = Vec3::new(skull.middle.x, skull.top - MIDDLE * unit, skull.middle.y);
        let mut reach = [[None::<f32>; AROUND]; HEIGHTS.len() - 1];
        for place in places {
            let beside = (*place - middle) / unit;
            let far = beside.length();
            let height = HEIGHTS.partition_point(|height| *height <= beside.y / far);
            if far >= FAR || height == 0 || far == 0.0 {
                continue;
            }
            let around = math::atan2(beside.x, beside.z) / TAU + 0.5 / AROUND as f32;
            let around = (around.rem_euclid(1.0) * AROUND as f32) as usize % AROUND;
            let held = &mut reach[(height - 1).min(HEIGHTS.len() - 2)][around];
            *held = Some(held.map_or(far, |held| held.max(far)));
        }
        Some(Self { reach, depth: skull.size.y / skull.size.x, noses: noses(places, &skull) })
    }

    /// Mean difference of the directions that are most alike from those of the built-in head.
    pub fn unlike(&self) -> f32 {
        let pairs = self.reach.iter().flatten().zip(PERSON.iter().flatten());
        let mut apart: Vec<f32> =
            pairs.map(|(own, person)| own.map_or(NOTHING, |own| (own - person).abs().min(MOST))).collect();
        apart.sort_by(f32::total_cmp);
        let count = (ALIKE * apart.len() as f32) as usize;
        apart[..count].iter().sum::<f32>() / count.max(1) as f32
    }

    /// Evidence against a head of a person: the difference from one, no nose in front, another depth.
    pub fn strange(&self) -> f32 {
        let nose = A_NOSE - self.noses[0].clamp(0.0, A_NOSE);
        self.unlike() + WEIGHT * (nose + math::ln(self.depth / DEPTH).abs())
    }
}

/// Reaches of ridges in the middle of front and back, each beyond the other.
fn noses(places: &[Vec3], skull: &Skull) -> [f32; 2] {
    let width = skull.size.x;
    let mut found = [0.0_f32; 2];
    let steps = ((NOSE.end - NOSE.start) / STEP) as usize;
    for step in 0..=steps {
        let height = skull.top - (NOSE.start + STEP * step as f32) * width;
        let mut ridges = [[f32::NEG_INFINITY; 2]; 2];
        for place in places.iter().filter(|place| (place.y - height).abs() < REACH * width) {
            let (aside, ahead) = ((place.x - skull.middle.x).abs() / width, place.z - skull.middle.y);
            let [ridge, cheeks] = &mut ridges[usize::from(ahead < 0.0)];
            let ahead = ahead.abs() / width;
            if ahead > 0.9 {
                continue;
            }
            if aside < RIDGE {
                *ridge = ridge.max(ahead);
            } else if CHEEKS.contains(&aside) {
                *cheeks = cheeks.max(ahead);
            }
        }
        let [front, back] = ridges.map(|[ridge, cheeks]| {
            let reach = ridge - cheeks;
            if reach.is_finite() { reach } else { 0.0 }
        });
        found = [found[0].max(front - back), found[1].max(back - front)];
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{body::Mannequin, prepare::sample::surface};

    #[test]
    fn what_is_known_of_the_built_in_head_is_its_own() {
        let head = Profile::of(&surface(&Mannequin::new().mesh(), 4000)).unwrap();
        assert_eq!(head.reach, PERSON.map(|ring| ring.map(Some)));
        assert_eq!((head.unlike(), head.noses[0] > A_NOSE), (0.0, true));
        assert_eq!(Skull::of(&Mannequin::new().mesh().positions), Some(Skull::BUILT_IN));
    }
}
