//! Strands of a groom that stand for the others: spread over the scalp, and alike in shape.

mod roots;

use glam::Vec3;
use strandline_base::par::prelude::*;

pub(crate) use roots::Roots;

use crate::Groom;
use crate::arcs::equal_arcs;

/// Places along a strand at which shapes are compared, as shares of its length.
const PLACES: usize = 3;
/// Weight of a difference in shape relative to a distance of roots: strands a centimetre apart that end three
/// centimetres apart are as far from each other as parallel ones 1.3 cm apart.
const SHAPE: f32 = 0.3;
/// Distance \[m\] added between strands of different groups: more than a body is large.
const GROUP: f32 = 10.0;

/// A strand as a point of a space in which near strands are alike: its root, and vectors from there to places along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Feature {
    root: Vec3,
    shape: [Vec3; PLACES],
    group: u32,
}

impl Feature {
    /// The root \[m\].
    pub fn root(&self) -> Vec3 {
        self.root
    }

    /// Square of the distance \[m^2\].
    pub fn distance_squared(&self, other: &Self) -> f32 {
        let apart: f32 =
            (0..PLACES).map(|place| self.shape[place].distance_squared(other.shape[place])).sum();
        let group = if self.group == other.group { 0.0 } else { GROUP * GROUP };
        self.root.distance_squared(other.root) + SHAPE * SHAPE * apart + group
    }

    fn mean(features: impl Iterator<Item = Self>) -> Self {
        let mut mean = Self { root: Vec3::ZERO, shape: [Vec3::ZERO; PLACES], group: 0 };
        let mut count = 0.0;
        for feature in features {
            mean.root += feature.root;
            (0..PLACES).for_each(|place| mean.shape[place] += feature.shape[place]);
            mean.group = feature.group;
            count += 1.0;
        }
        Self { root: mean.root / count, shape: mean.shape.map(|place| place / count), group: mean.group }
    }
}

/// Every strand as a feature, shape `[strand]`.
pub(crate) fn features(groom: &Groom) -> Vec<Feature> {
    let feature = |strand: usize| {
        let points = groom.strand(strand);
        let mut places = equal_arcs(points, PLACES + 1).skip(1);
        Feature {
            root: points[0],
            shape: std::array::from_fn(|_| places.next().unwrap_or(points[0]) - points[0]),
            group: groom.groups.as_ref().map_or(0, |groups| groups[strand]),
        }
    };
    (0..groom.strand_count()).into_par_iter().map(feature).collect()
}

impl Groom {
    /// `count` strands that stand for all, by their indices in rising order: spread evenly over the scalp and
    /// over shapes, so that each strand has one near it that is alike; every group has some. All strands when
    /// there are no more.
    ///
    /// Each new one is the strand farthest from those chosen \[Gonzalez1985\]; then each gives its place to the
    /// strand in the middle of those nearest to it.
    pub fn representatives(&self, count: usize) -> Vec<usize> {
        if count >= self.strand_count() {
            return (0..self.strand_count()).collect();
        }
        if count == 0 {
            return Vec::new();
        }
        let features = features(self);
        let middle = Feature::mean(features.iter().copied());
        let nearest = |target: &Feature, among: &mut dyn Iterator<Item = usize>| {
            let distance = |strand: usize| features[strand].distance_squared(target);
            among.min_by(|one, two| distance(*one).total_cmp(&distance(*two)))
        };
        let mut next = nearest(&middle, &mut (0..features.len())).unwrap_or(0);
        let roots = Roots::new(&features);
        // The square of the distance to the nearest that is chosen, and which one it is; the farthest of a cell.
        let mut nearby: Vec<(f32, u32)> = vec![(f32::INFINITY, 0); features.len()];
        let mut farthest: Vec<(f32, usize)> = vec![(f32::NEG_INFINITY, 0); roots.cell_count()];
        let occupied = roots.occupied();
        let mut reach = f32::MAX;
        for chosen in 0..count as u32 {
            let center = features[next];
            for cell in roots.cells_around(center.root, reach) {
                let mut of_cell = (f32::NEG_INFINITY, 0);
                for strand in roots.members(cell).iter().map(|strand| *strand as usize) {
                    let distance = features[strand].distance_squared(&center);
                    if distance < nearby[strand].0 {
                        nearby[strand] = (distance, chosen);
                    }
                    if nearby[strand].0 > of_cell.0 {
                        of_cell = (nearby[strand].0, strand);
                    }
                }
                farthest[cell] = of_cell;
            }
            // The first of equals.
            let start = (f32::NEG_INFINITY, 0);
            let cells = occupied.iter().map(|cell| farthest[*cell]);
            let most = cells.fold(start, |most, cell| if cell.0 > most.0 { cell } else { most });
            // No strand is farther from those chosen than that: a new one is near to none beyond.
            (reach, next) = (most.0.max(0.0).sqrt(), most.1);
        }
        let mut members = vec![Vec::new(); count];
        for (strand, (_, chosen)) in nearby.iter().enumerate() {
            members[*chosen as usize].push(strand);
        }
        let mut chosen: Vec<usize> = members
            .into_par_iter()
            .filter(|members| !members.is_empty())
            .filter_map(|members| {
                let mean = Feature::mean(members.iter().map(|strand| features[*strand]));
                nearest(&mean, &mut members.into_iter())
            })
            .collect();
        chosen.sort_unstable();
        chosen.dedup();
        chosen
    }

    /// Distance \[m\] of roots from the nearest other root, of about this many strands.
    pub fn nearest_roots(&self, count: usize) -> Vec<f32> {
        let features = features(self);
        let roots = Roots::new(&features);
        let every = (self.strand_count() / count.max(1)).max(1);
        let strands: Vec<usize> = (0..self.strand_count()).step_by(every).collect();
        let nearest = |strand: usize| {
            let (root, mut nearest) = (features[strand].root, f32::INFINITY);
            roots.outward(root, |other| {
                let distance = features[other].root.distance(root);
                // Strands that share a root count as one.
                if other != strand && distance > 0.0 {
                    nearest = nearest.min(distance);
                }
                nearest
            });
            nearest
        };
        let found = strands.into_par_iter().map(nearest);
        found.filter(|distance| distance.is_finite()).collect()
    }

    /// Indices of the strands marked as guides; `None` without marks.
    pub fn marked_guides(&self) -> Vec<usize> {
        let flags = self.guide_flags.as_deref().unwrap_or_default();
        (0..flags.len()).filter(|strand| flags[*strand]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of strands that stand up, 40 x 40 at distances of 5 mm; half of them lean over.
    fn lawn() -> Groom {
        let mut groom = Groom::empty(8e-5);
        for row in 0..40 {
            for column in 0..40 {
                let root = Vec3::new(0.005 * row as f32, 0.0, 0.005 * column as f32);
                let lean = if row < 20 { Vec3::X * 0.05 } else { Vec3::ZERO };
                groom.push((0..5).map(|point| root + (Vec3::Y * 0.02 + lean) * point as f32));
            }
        }
        groom
    }

    #[test]
    fn representatives_are_spread_and_all_strands_have_one_near() {
        let groom = lawn();
        let chosen = groom.representatives(100);
        assert!((95..=100).contains(&chosen.len()), "{}", chosen.len());
        assert!(chosen.is_sorted());
        let features = features(&groom);
        let near = |strand: usize| {
            let distances = chosen.iter().map(|other| features[strand].distance_squared(&features[*other]));
            distances.fold(f32::INFINITY, f32::min).sqrt()
        };
        let farthest = (0..groom.strand_count()).map(near).fold(0.0, f32::max);
        // 16 strands to each: a square of 20 mm, whose corner is 14 mm from its middle.
        assert!(farthest < 0.021, "{farthest} m");
        // Half of them lean: as many of those chosen.
        let leaning = chosen.iter().filter(|strand| **strand < 800).count();
        assert!((40..=60).contains(&leaning), "{leaning}");
        assert_eq!(groom.representatives(1600).len(), 1600);
        assert_eq!(groom.representatives(5000).len(), 1600);
    }

    #[test]
    fn strands_are_visited_from_near_to_far_as_far_as_needed() {
        let features = features(&lawn());
        let roots = Roots::new(&features);
        for (place, wanted) in [(Vec3::new(0.101, 0.0, 0.052), 5), (Vec3::new(-0.3, 0.2, 0.0), 5)] {
            let distance = |strand: usize| features[strand].root().distance(place);
            let mut visited = Vec::new();
            roots.outward(place, |strand| {
                visited.push(strand);
                let mut known: Vec<f32> = visited.iter().map(|strand| distance(*strand)).collect();
                known.sort_by(f32::total_cmp);
                known.get(wanted - 1).copied().unwrap_or(f32::INFINITY)
            });
            let count = visited.len();
            let sorted = |mut strands: Vec<usize>| {
                strands.sort_by(|one, two| distance(*one).total_cmp(&distance(*two)).then(one.cmp(two)));
                strands.truncate(wanted);
                strands
            };
            assert_eq!(sorted(visited), sorted((0..features.len()).collect()));
            assert!(count < 400 || place.x < 0.0, "{count} of 1600");
        }
        let mut all = Vec::new();
        roots.outward(Vec3::ZERO, |strand| {
            all.push(strand);
            f32::INFINITY
        });
        all.sort_unstable();
        assert_eq!(all, (0..1600).collect::<Vec<_>>(), "each once");
    }

    #[test]
    fn every_group_has_a_representative() {
        let mut groom = lawn();
        groom.groups = Some((0..1600).map(|strand| u32::from(strand % 800 == 3)).collect());
        let chosen = groom.representatives(20);
        assert!(chosen.iter().any(|strand| strand % 800 == 3), "{chosen:?}");
    }
}
