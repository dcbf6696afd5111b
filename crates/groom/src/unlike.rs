//! Strands wholly unlike those whose roots lie beside theirs.

use glam::Vec3;
use strandline_base::{counted, par::prelude::*};

use crate::Groom;
use crate::choice::{Roots, features};

/// Strands beside one that it is compared with.
const BESIDE: usize = 8;
/// Length over that of the second longest strand beside one, above which the strand is unlike them.
const LONGER: f32 = 5.0;
/// Length of the mean direction of strands that lead one way, and the cosine between that and a strand against them.
const ONE_WAY: f32 = 0.8;
const AGAINST: f32 = -0.5;
/// Share of all strands up to which those unlike the others are few: more of them are the style.
const FEW: f32 = 0.02;
/// Strands whose roots lie as near to each other as this many, which takes too long to compare.
const CROWDED: usize = 1024;

/// A kind of strand unlike those beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Unlike {
    Longer,
    Against,
}

impl Groom {
    /// Names the few strands that are wholly unlike those beside them, with their number in their file: far longer, or led
    /// against them. Nothing is changed.
    pub fn unlike_beside(&self) -> Vec<String> {
        let found = unlike(self);
        let few = (FEW * self.strand_count() as f32).max(1.0);
        let note = |kind: Unlike, words: &str| {
            let mut strands = (0..found.len()).filter(|strand| found[*strand] == Some(kind));
            let first = strands.next()?;
            let count = 1 + strands.count();
            let strands = counted(count, "strand is", "strands are");
            let first = self.numbered(first);
            (count as f32 <= few)
                .then(|| format!("{strands} {words}, the first is {first}: left as in the file"))
        };
        let longer = note(Unlike::Longer, "over 5 times as long as those beside");
        longer.into_iter().chain(note(Unlike::Against, "led against all those beside")).collect()
    }
}

/// Kinds of strands unlike those beside them, shape `[strand]`.
fn unlike(groom: &Groom) -> Vec<Option<Unlike>> {
    if groom.strand_count() <= BESIDE {
        return Vec::new();
    }
    let (features, lengths) = (features(groom), groom.lengths());
    let roots = Roots::new(&features);
    if roots.occupied().into_iter().any(|cell| roots.members(cell).len() > CROWDED) {
        return Vec::new();
    }
    let is_of_group =
        |one: usize, other: usize| groom.groups.as_ref().is_none_or(|groups| groups[one] == groups[other]);
    let way = |strand: usize| {
        let points = groom.strand(strand);
        (points[points.len() - 1] - points[0]).normalize_or_zero()
    };
    let kind = |strand: usize| {
        let root = features[strand].root();
        let mut beside = [(f32::INFINITY, strand); BESIDE];
        roots.outward(root, |other| {
            let distance = features[other].root().distance(root);
            if other != strand && distance < beside[BESIDE - 1].0 && is_of_group(strand, other) {
                let place = beside.partition_point(|(held, _)| *held <= distance);
                beside[place..].rotate_right(1);
                beside[place] = (distance, other);
            }
            beside[BESIDE - 1].0
        });
        if beside[BESIDE - 1].0.is_infinite() {
            return None;
        }
        let mut of_others = beside.map(|(_, other)| lengths[other]);
        of_others.sort_by(f32::total_cmp);
        if lengths[strand] > LONGER * of_others[BESIDE - 2] {
            return Some(Unlike::Longer);
        }
        let mean = beside.iter().map(|(_, other)| way(*other)).sum::<Vec3>() / BESIDE as f32;
        let own = way(strand);
        let is_against = mean.length() > ONE_WAY
            && own.dot(mean.normalize_or_zero()) < AGAINST
            && beside.iter().all(|(_, other)| own.dot(way(*other)) < 0.0);
        is_against.then_some(Unlike::Against)
    };
    (0..groom.strand_count()).into_par_iter().map(kind).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of strands that hang, 30 x 30 at distances of 5 mm, some of them changed.
    fn lawn(changed: impl Fn(usize, Vec3) -> Vec3) -> Groom {
        let mut groom = Groom::empty(8e-5);
        for strand in 0..900 {
            let root = Vec3::new(0.005 * (strand / 30) as f32, 0.0, 0.005 * (strand % 30) as f32);
            let way = changed(strand, Vec3::new(0.02 * (strand % 7) as f32, -0.2, 0.0));
            groom.push((0..6).map(|point| root + way * (point as f32 / 5.0)));
        }
        groom
    }

    #[test]
    fn a_few_strands_unlike_those_beside_them_are_named_with_their_number() {
        assert_eq!(lawn(|_, way| way).unlike_beside(), Vec::<String>::new());
        let notes = lawn(|strand, way| match strand {
            // Two beside each other.
            411 | 412 => way * 8.0,
            100 | 500 | 700 => -way,
            _ => way,
        })
        .unlike_beside();
        assert_eq!(notes.len(), 2, "{notes:?}");
        assert!(
            notes[0].starts_with("2 strands are over 5 times as long") && notes[0].contains("first is 411:")
        );
        assert!(notes[1].starts_with("3 strands are led against") && notes[1].contains("first is 100"));
    }

    #[test]
    fn many_strands_unlike_the_others_are_a_style() {
        let hedgehog = lawn(|strand, way| if strand % 9 == 0 { -way } else { way });
        assert_eq!(hedgehog.unlike_beside(), Vec::<String>::new());
        let mut grouped = lawn(|strand, way| if strand < 2 { way * 9.0 } else { way });
        assert_eq!(grouped.unlike_beside().len(), 1);
        grouped.groups = Some((0..900).map(|strand| u32::from(strand < 2)).collect());
        assert_eq!(grouped.unlike_beside(), Vec::<String>::new(), "a group is not compared with another");
    }
}
