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
    [0.83214027, 0.78189623, 0.68932045, 0.5738479, 0.56626505, 0.5876116, 0.59553456, 0.59368145, 0.5506286, 0.59292823, 0.6879654, 0.7735015],
    [0.723585, 0.65407306, 0.59116244, 0.5737048, 0.50784165, 0.52794385, 0.538609, 0.5300538, 0.5106062, 0.58056694, 0.58185256, 0.6524189],
    [0.7107349, 0.56730056, 0.5471857, 0.5702042, 0.5083387, 0.54432464, 0.5473274, 0.543079, 0.55334044, 0.56952107, 0.5390056, 0.57172245],
    [0.58209395, 0.54458123, 0.5022313, 0.54261345, 0.5170774, 0.5518824, 0.5537369, 0.5508182, 0.51636285, 0.5485595, 0.50002855, 0.5416545],
    [0.5688448, 0.56527185, 0.48796624, 0.4618106, 0.5295284, 0.57436, 0.57811767, 0.56522584, 0.52417135, 0.46516827, 0.4916177, 0.5657958],
    [0.57926446, 0.5735874, 0.52407366, 0.49490044, 0.56183463, 0.5977293, 0.60707676, 0.59817266, 0.5626108, 0.50812185, 0.5304501, 0.57465214],
    [0.6051082, 0.60345876, 0.5794743, 0.560988, 0.5908546, 0.6119624, 0.61788607, 0.61280024, 0.5929379, 0.56713045, 0.5789151, 0.6005334],
    [0.6084542, 0.6054391, 0.600427, 0.599711, 0.5998452, 0.61058325, 0.6147513, 0.6100246, 0.59929633, 0.5993031, 0.60029626, 0.6044624],
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
