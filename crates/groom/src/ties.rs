//! Ties: bands that hold strands together at a place of the head, and the knots of a groom where there must be one.

use std::collections::{BTreeMap, BTreeSet};

use glam::{IVec3, Vec3};

use crate::Guides;

/// A band about hair at a place of the head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tie {
    /// Its middle \[m\], head space.
    pub position: Vec3,
    /// Distance \[m\] within which strands are held.
    pub radius: f32,
}

/// Points of a strand that a tie holds: two, so that hair leaves it in the direction of the groom.
const HELD: usize = 2;
/// Hair \[m\] before a knot, at least. Behind it there may be none: some grooms root the tail in the knot, as strands of its
/// own.
const BEFORE: f32 = 0.03;
/// Half of the edge \[m\] of the box in which strands meet.
const REACH: f32 = 0.02;
/// Share of all strands that meet in a knot, at least, and their number.
const SHARE: f32 = 0.25;
const FEWEST: usize = 20;
/// Times that roots lie farther apart than the strands in the knot, at least.
const GATHERED: f32 = 3.5;
/// Times that strands of a knot lie farther apart that far before it, at least: 2.7 to 3.5 in tails and buns, 1.3 in a lock that
/// hair swept back gathers in.
const NARROWS: f32 = 2.0;
/// Share of the most strands of a place that the knot, the first such place from the roots, has at least.
const NEARLY_ALL: f32 = 0.9;
/// Most strands that are looked at.
const LOOKED_AT: usize = 1000;
/// Most knots of a groom.
const MOST_KNOTS: usize = 4;

impl Guides {
    /// Has the head hold every strand that comes within a tie, by the point nearest its middle and the next one. Returns
    /// the number of strands in each tie. The two points at the root are held already.
    pub fn tie(&mut self, ties: &[Tie]) -> Vec<usize> {
        let mut held = BTreeSet::new();
        let mut counts = Vec::new();
        for tie in ties {
            let mut count = 0;
            for strand in 0..self.strand_count() {
                let apart = |point: &usize| self.position(strand, *point).distance_squared(tie.position);
                let nearest = (HELD..self.points_per_strand()).min_by(|a, b| apart(a).total_cmp(&apart(b)));
                let Some(point) = nearest.filter(|_| self.passes(strand, tie)) else { continue };
                count += 1;
                let last = (point + HELD).min(self.points_per_strand());
                held.extend((point..last).map(|point| (strand as u32, point as u32)));
            }
            counts.push(count);
        }
        self.set_held(held);
        counts
    }

    /// True if a segment of a strand behind its root passes within a tie.
    pub(crate) fn passes(&self, strand: usize, tie: &Tie) -> bool {
        (HELD..self.points_per_strand()).any(|end| {
            let (start, end) = (self.position(strand, end - 1), self.position(strand, end));
            let across = end - start;
            let share = (tie.position - start).dot(across) / across.length_squared().max(1e-30);
            (start + across * share.clamp(0.0, 1.0)).distance(tie.position) <= tie.radius
        })
    }

    /// The knots of a groom: places where a quarter of all strands or more come together from roots that lie 3.5 times as
    /// far apart, within a few centimetres. Curtains and locks of hair are none. The largest comes first.
    pub fn knots(&self) -> Vec<Tie> {
        let every = self.strand_count().div_ceil(LOOKED_AT);
        let mut left: BTreeSet<usize> = (0..self.strand_count()).step_by(every).collect();
        let fewest = ((SHARE * left.len() as f32) as usize).max(FEWEST);
        let mut knots = Vec::new();
        while knots.len() < MOST_KNOTS && left.len() >= fewest {
            let Some(knot) = Meetings::new(self, &left).knot(self, fewest) else { break };
            left.retain(|strand| !self.passes(*strand, &knot));
            knots.push(knot);
        }
        knots
    }
}

/// A point of a strand that may lie in a knot.
struct Meeting {
    strand: usize,
    place: Vec3,
    /// Hair \[m\] before it.
    before: f32,
    /// Place of the strand [`BEFORE`] it.
    earlier: Vec3,
}

/// Points that may lie in a knot, by cells of an edge of [`REACH`].
struct Meetings {
    cells: BTreeMap<[i32; 3], Vec<Meeting>>,
}

impl Meetings {
    fn new(guides: &Guides, strands: &BTreeSet<usize>) -> Self {
        let mut cells: BTreeMap<[i32; 3], Vec<Meeting>> = BTreeMap::new();
        for &strand in strands {
            let places: Vec<Vec3> =
                (0..guides.points_per_strand()).map(|point| guides.position(strand, point)).collect();
            let mut before = 0.0;
            for pair in places.windows(2) {
                let way = pair[0].distance(pair[1]);
                // Points lie up to some centimetres apart: no cell is passed over.
                let count = (2.0 * way / REACH).ceil().clamp(1.0, 64.0) as usize;
                for step in 0..count {
                    let share = step as f32 / count as f32;
                    let (place, before) = (pair[0].lerp(pair[1], share), before + share * way);
                    if before > BEFORE && place.abs().max_element() < 1e4 {
                        let cell = (place / REACH).floor().as_ivec3().to_array();
                        let earlier = place_at(&places, before - BEFORE);
                        cells.entry(cell).or_default().push(Meeting { strand, place, before, earlier });
                    }
                }
                before += way;
            }
        }
        Self { cells }
    }

    /// Strands that pass through a cell or one beside it, each by its point nearest the middle of all; none where there are
    /// fewer.
    fn around(&self, cell: IVec3, fewest: usize) -> Vec<&Meeting> {
        let beside =
            (0..27).map(|number| cell + IVec3::new(number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1));
        let all: Vec<&Meeting> =
            beside.filter_map(|cell| self.cells.get(&cell.to_array())).flatten().collect();
        if all.len() < fewest {
            return Vec::new();
        }
        let middle = mean(all.iter().map(|meeting| meeting.place));
        let mut nearest: BTreeMap<usize, &Meeting> = BTreeMap::new();
        for meeting in all {
            let apart = |meeting: &Meeting| meeting.place.distance_squared(middle);
            let kept = nearest.entry(meeting.strand).or_insert(meeting);
            if apart(meeting) < apart(kept) {
                *kept = meeting;
            }
        }
        nearest.retain(|_, meeting| meeting.place.distance(middle) < 1.5 * REACH);
        nearest.into_values().collect()
    }

    /// The first place from the roots at which nearly as many strands meet as anywhere; none without a knot.
    fn knot(&self, guides: &Guides, fewest: usize) -> Option<Tie> {
        let mut found: Vec<(usize, f32, Tie)> = Vec::new();
        for cell in self.cells.keys() {
            let met = self.around(IVec3::from(*cell), fewest);
            if met.len() < fewest {
                continue;
            }
            let middle = mean(met.iter().map(|meeting| meeting.place));
            let apart = spread(met.iter().map(|meeting| meeting.place), middle);
            let roots = || met.iter().map(|meeting| guides.position(meeting.strand, 0));
            if spread(roots(), mean(roots())) < GATHERED * apart {
                continue;
            }
            let earlier = || met.iter().map(|meeting| meeting.earlier);
            if spread(earlier(), mean(earlier())) < NARROWS * apart {
                continue;
            }
            let before = met.iter().map(|meeting| meeting.before).sum::<f32>() / met.len() as f32;
            let farthest = met.iter().map(|meeting| meeting.place.distance(middle)).fold(0.0, f32::max);
            found.push((met.len(), before, Tie { position: middle, radius: farthest + 1e-3 }));
        }
        let most = found.iter().map(|(count, ..)| *count).max()? as f32;
        let near = found.into_iter().filter(|(count, ..)| *count as f32 >= NEARLY_ALL * most);
        near.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(.., tie)| tie)
    }
}

/// The place so far \[m\] along a strand.
fn place_at(strand: &[Vec3], mut length: f32) -> Vec3 {
    for pair in strand.windows(2) {
        let way = pair[0].distance(pair[1]);
        if length <= way {
            return pair[0].lerp(pair[1], length / way.max(1e-30));
        }
        length -= way;
    }
    strand.last().copied().unwrap_or_default()
}

fn mean(places: impl Iterator<Item = Vec3>) -> Vec3 {
    let (sum, count) = places.fold((Vec3::ZERO, 0.0), |(sum, count), place| (sum + place, count + 1.0));
    sum / f32::max(count, 1.0)
}

/// Root of the mean square distance \[m\] from a place.
fn spread(places: impl Iterator<Item = Vec3>, middle: Vec3) -> f32 {
    let (sum, count) =
        places.fold((0.0, 0.0), |(sum, count), place| (sum + place.distance_squared(middle), count + 1.0));
    (sum / f32::max(count, 1.0)).sqrt()
}

#[cfg(test)]
mod tests {
    use strandline_base::math::{cos, sin};

    use super::*;
    use crate::{Style, StyleSettings};

    fn grown(style: Style) -> Guides {
        let settings = StyleSettings { strand_count: 400, ..StyleSettings::new(style) };
        Guides::resample(&settings.grow().unwrap(), 20).unwrap()
    }

    #[test]
    fn a_ponytail_has_one_knot_and_loose_hair_none() {
        let mut tail = grown(Style::Ponytail);
        let knots = tail.knots();
        assert_eq!(knots.len(), 1, "{knots:?}");
        // At the tie of the style.
        assert!(knots[0].position.distance(Vec3::new(0.0, 0.038, -0.117)) < 0.025, "{knots:?}");
        let held = tail.tie(&knots)[0];
        assert!(held > 390, "{held} of 400 strands");
        for style in [Style::Long, Style::Wavy, Style::Curly, Style::Bob, Style::Pixie] {
            assert_eq!(grown(style).knots(), [], "{style:?}");
        }
    }

    /// A lock that 200 strands from the whole scalp gather in, in a tube of a radius \[m\] at its end and wider for so far before
    /// it.
    fn lock(radius: f32, over: f32) -> Guides {
        let strand = |index: usize| {
            let (turn, out) = (index as f32 * 2.4, (index as f32 / 200.0).sqrt());
            let aside = out * Vec3::new(cos(turn), 0.0, sin(turn));
            (0..40).map(move |point| {
                let way = point as f32 * 0.01;
                let wider = ((0.25 - way) / over).clamp(0.0, 1.0);
                aside * (radius + (0.12 - radius) * wider) - way * Vec3::Y
            })
        };
        let mut groom = crate::Groom::empty(8e-5);
        (0..200).for_each(|index| groom.push(strand(index)));
        Guides::resample(&groom, 40).unwrap()
    }

    #[test]
    fn tied_hair_narrows_within_centimetres_and_a_swept_lock_does_not() {
        assert_eq!(lock(0.012, 0.05).knots().len(), 1);
        for radius in [0.02, 0.025, 0.03] {
            assert_eq!(lock(radius, 0.25).knots(), [], "{radius} m");
        }
    }

    #[test]
    fn ties_hold_two_points_behind_the_root() {
        let mut tail = grown(Style::Ponytail);
        let tie = Tie { position: tail.position(7, 9), radius: 1e-3 };
        assert!(tail.tie(&[tie])[0] >= 1);
        assert!(tail.is_held(7, 9) && tail.is_held(7, 10) && !tail.is_held(7, 8) && !tail.is_held(7, 11));
        let far = Tie { position: Vec3::splat(9.0), radius: 0.1 };
        assert_eq!((tail.tie(&[far]), tail.held_count()), (vec![0], 0));
        // Roots are held already, and a tie about them leaves them alone.
        let root = Tie { position: tail.position(7, 0), radius: 1e-4 };
        tail.tie(&[root]);
        assert!(!tail.is_held(7, 0) && !tail.is_held(7, 1));
    }
}
