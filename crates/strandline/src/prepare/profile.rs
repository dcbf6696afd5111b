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
    [0.82808447, 0.7749148, 0.69684505, 0.57977426, 0.5586571, 0.5870604, 0.5910753, 0.5923026, 0.55719995, 0.588239, 0.6823578, 0.771539],
    [0.7222515, 0.64449555, 0.5882867, 0.5764284, 0.5064258, 0.5277644, 0.5408614, 0.5257111, 0.50732833, 0.5745437, 0.5865395, 0.6513197],
    [0.7102135, 0.56950563, 0.52146554, 0.56324714, 0.548498, 0.54407567, 0.5469225, 0.5415449, 0.50456923, 0.5665878, 0.5417602, 0.565699],
    [0.58900535, 0.5402334, 0.49874058, 0.5319005, 0.51135767, 0.5497112, 0.5531776, 0.5502201, 0.51540637, 0.5327103, 0.49685407, 0.5448415],
    [0.5677412, 0.5645706, 0.4933036, 0.45995829, 0.5305848, 0.5744197, 0.57774335, 0.57101685, 0.52809864, 0.4580781, 0.48935038, 0.56530184],
    [0.57882166, 0.5709634, 0.5320699, 0.50655967, 0.55125445, 0.5979675, 0.6069758, 0.59755397, 0.5620569, 0.5022563, 0.52392524, 0.5750336],
    [0.606332, 0.6022651, 0.57665896, 0.5677087, 0.5864896, 0.61296237, 0.61775315, 0.6127101, 0.589102, 0.5663009, 0.5776502, 0.60127985],
    [0.608575, 0.60595715, 0.6007489, 0.5994473, 0.599346, 0.6078572, 0.61503005, 0.6085847, 0.6000608, 0.60032666, 0.60053587, 0.6052538],
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
