//! The end of a strand at which its root is: of strands stored from tip to root the last point.

use glam::Vec3;
use strandline_base::choices;

use super::cleaning::{Cleaning, quantile};
use crate::{Groom, Widths};

choices! {
    /// The end of each strand at which its root is.
    pub enum RootEnd as "root_end" {
        /// The end on the skin; without a body, the end that the other strands show.
        Auto = "auto",
        /// The first point.
        First = "first",
        /// The last point.
        Last = "last",
    }
    default Auto
}

/// Width of the thick end over the thin one of a strand that tapers, and the share of strands that do in a groom whose
/// widths show the roots.
const TAPER: f32 = 1.15;
const TAPERED: f32 = 0.8;
/// Fewest strands of which one can be unlike the others.
const FEWEST: usize = 20;
/// Ends that all others are compared with.
const LOOKED_AT: usize = 2000;
/// Distance to the nearest root, over the median of all, beyond which an end lies apart from the roots, and within which
/// it lies among them.
const APART: f32 = 4.0;
const AMONG: f32 = 2.0;
/// Fewest strands so, and share of all, with which less is asked of the others: the distance of the first point, and over
/// that of the last.
const LEAST_SURE: usize = 3;
const SURE: f32 = 0.005;
const LIKELY_APART: f32 = 3.0;
const LIKELY_RATIO: f32 = 2.0;
/// Largest share of strands that the others can outvote.
const FEW: f32 = 0.35;

impl Groom {
    /// The two ends of a strand, first and last.
    fn ends(&self, strand: usize) -> [Vec3; 2] {
        let points = self.strand(strand);
        [points[0], points[points.len() - 1]]
    }

    /// Turns strands end for end, with everything that their points have; shape of `is_turned` `[strand]`.
    pub fn turn_strands(&mut self, is_turned: &[bool]) {
        let ranges: Vec<_> = (0..self.strand_count())
            .filter(|strand| is_turned.get(*strand) == Some(&true))
            .map(|strand| self.range(strand))
            .collect();
        for range in ranges {
            self.points[range.clone()].reverse();
            if let Widths::PerPoint(widths) = &mut self.widths {
                widths[range.clone()].reverse();
            }
            self.colors.iter_mut().for_each(|all| all[range.clone()].reverse());
            self.transparencies.iter_mut().for_each(|all| all[range.clone()].reverse());
            self.masses.iter_mut().for_each(|all| all[range.clone()].reverse());
            self.velocities.iter_mut().for_each(|all| all[range.clone()].reverse());
        }
    }

    /// True for strands that are stored from tip to root, judged by their widths or by the other strands, in any units;
    /// shape `[strand]`. `None` where there are no signs of such strands.
    pub fn from_tip(&self) -> Option<Vec<bool>> {
        if self.strand_count() < FEWEST
            || (0..self.strand_count()).any(|strand| self.strand(strand).is_empty())
        {
            return None;
        }
        let turned = self.tapered_from_tip().or_else(|| self.rooted_apart())?;
        turned.contains(&true).then_some(turned)
    }

    /// The strands that are thin at their first point and thick at the last, where nearly all strands taper and the thick
    /// ends lie closer together.
    fn tapered_from_tip(&self) -> Option<Vec<bool>> {
        let Widths::PerPoint(widths) = &self.widths else { return None };
        let strands = 0..self.strand_count();
        let ends = |strand: usize| {
            let range = self.range(strand);
            [widths[range.start], widths[range.end - 1]]
        };
        let is_tapered = |[one, two]: [f32; 2]| one > TAPER * two;
        let from_tip = |strand: usize| is_tapered([ends(strand)[1], ends(strand)[0]]);
        let tapered = strands.clone().filter(|strand| is_tapered(ends(*strand)) || from_tip(*strand)).count();
        if (tapered as f32) < TAPERED * self.strand_count() as f32 {
            return None;
        }
        let thick = |strand: usize| self.ends(strand)[usize::from(from_tip(strand))];
        let thin = |strand: usize| self.ends(strand)[usize::from(!from_tip(strand))];
        let is_closer = spread(strands.clone().map(thick)) < spread(strands.clone().map(thin));
        is_closer.then(|| strands.map(from_tip).collect())
    }

    /// The few strands whose first point lies apart from the roots of all others, and whose last lies among them.
    fn rooted_apart(&self) -> Option<Vec<bool>> {
        let count = self.strand_count();
        let every = count.div_ceil(LOOKED_AT).max(1);
        let known: Vec<(usize, Vec3)> =
            (0..count).step_by(every).map(|strand| (strand, self.ends(strand)[0])).collect();
        // The second nearest: of two strands that are turned, the first points may lie together.
        let nearest = |strand: usize, end: Vec3| {
            let mut least = [f32::INFINITY; 2];
            for (_, root) in known.iter().filter(|(other, _)| *other != strand) {
                let found = root.distance_squared(end);
                if found < least[0] {
                    least = [found, least[0]];
                } else if found < least[1] {
                    least[1] = found;
                }
            }
            least[1].sqrt()
        };
        let median = quantile(known.iter().map(|(strand, root)| nearest(*strand, *root)), 0.5);
        let ends = |strand: usize| self.ends(strand).map(|end| nearest(strand, end) / median);
        let is_sure = |[first, last]: [f32; 2]| first > APART && last < AMONG;
        // A sample tells whether there are some.
        known.iter().any(|(strand, _)| is_sure(ends(*strand))).then_some(())?;
        let ends: Vec<[f32; 2]> = (0..count).map(ends).collect();
        let sure = ends.iter().filter(|ends| is_sure(**ends)).count();
        if sure < LEAST_SURE || (sure as f32) < SURE * count as f32 {
            return None;
        }
        let is_turned =
            |[first, last]: &[f32; 2]| *last < AMONG && *first > LIKELY_APART && *first > LIKELY_RATIO * last;
        let turned: Vec<bool> = ends.iter().map(is_turned).collect();
        let found = turned.iter().filter(|turned| **turned).count();
        (found as f32 <= FEW * count as f32).then_some(turned)
    }

    /// Brings roots to the first points as an option of reading asks for; a note on strands that are turned, or that are
    /// named alone with a hint.
    pub(super) fn rooted(&mut self, root_end: RootEnd, cleaning: Cleaning, hint: &str) -> Option<String> {
        if root_end == RootEnd::Last {
            self.turn_strands(&vec![true; self.strand_count()]);
        }
        // A reader of strays alone leaves the rest to one who knows the body.
        if root_end != RootEnd::Auto || cleaning == Cleaning::Strays {
            return None;
        }
        let turned = self.from_tip()?;
        // Of strands that do not taper only those far from the other roots show it.
        let least = if self.tapered_from_tip().is_none() { "at least " } else { "" };
        let note = format!("{least}{}", from_tip_note(&turned));
        if cleaning == Cleaning::Named {
            return Some(format!("{note} ({hint})"));
        }
        self.turn_strands(&turned);
        Some(format!("{note}: turned (`--root-end first` keeps them)"))
    }
}

/// The sentence on strands that are stored from tip to root.
pub fn from_tip_note(turned: &[bool]) -> String {
    let found = turned.iter().filter(|turned| **turned).count();
    match found == turned.len() {
        true => "all strands are stored from tip to root".to_owned(),
        false => {
            let is = if found == 1 { "is" } else { "are" };
            format!("{found} of {} strands {is} stored from tip to root", turned.len())
        }
    }
}

/// Mean distance of places from their middle.
fn spread(places: impl Iterator<Item = Vec3> + Clone) -> f32 {
    let count = places.clone().count().max(1) as f32;
    let middle = places.clone().sum::<Vec3>() / count;
    places.map(|place| place.distance(middle)).sum::<f32>() / count
}

#[cfg(test)]
mod tests;
