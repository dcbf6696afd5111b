//! Points that lie in strands of one length, though nothing joins them.

use glam::Vec3;

/// Step over the middle one from which on it leads to another strand.
const LEAP: f32 = 5.0;
/// Share of the ends of strands that leap, and share of leaps that are ends.
const MOST: f32 = 0.9;

/// Number of points of a strand where the steps from each point to the next are long behind each such number, and short
/// else: strands that were written one behind the other. None where they show no number.
pub(super) fn points_of_a_row(points: &[Vec3]) -> Option<usize> {
    let steps: Vec<f32> = points.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
    let mut sorted = steps.clone();
    sorted.sort_by(f32::total_cmp);
    let middle = *sorted.get(sorted.len() / 2)?;
    let ends: Vec<usize> = (1..points.len()).filter(|end| steps[end - 1] > LEAP * middle).collect();
    let mut lengths: Vec<usize> =
        ends.windows(2).map(|pair| pair[1] - pair[0]).chain(ends.first().copied()).collect();
    lengths.sort_unstable();
    let each = *lengths.get(lengths.len() / 2)?;
    if each < 2 || !points.len().is_multiple_of(each) {
        return None;
    }
    let regular = ends.iter().filter(|end| end.is_multiple_of(each)).count() as f32;
    let rows = (points.len() / each - 1) as f32;
    (regular >= MOST * rows && regular >= MOST * ends.len() as f32).then_some(each)
}

/// The points of a strand that a message asks for, with those that the points themselves show.
pub(super) fn asked(points: &[Vec3]) -> String {
    match points_of_a_row(points) {
        Some(each) => format!(
            "the points of a strand (`--per-strand {each}`, in Python `points_per_strand={each}`: these lie in {} rows of \
             {each})",
            points.len() / each
        ),
        None => "the points of a strand (`--per-strand N`, in Python `points_per_strand=N`)".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of points that wander a little, far from each other.
    fn rows(count: usize, each: usize, apart: f32) -> Vec<Vec3> {
        let point = |row: usize, at: usize| {
            Vec3::new(apart * (0.618_034 * row as f32).fract(), apart * (row % 3) as f32, 0.01 * at as f32)
        };
        (0..count).flat_map(|row| (0..each).map(move |at| point(row, at))).collect()
    }

    #[test]
    fn rows_of_points_are_seen_by_the_leaps_between_them() {
        assert_eq!(points_of_a_row(&rows(60, 100, 1.0)), Some(100));
        assert_eq!(points_of_a_row(&rows(2, 7, 1.0)), Some(7));
        // Nothing leaps, strands differ, and the last one is cut off.
        assert_eq!(points_of_a_row(&rows(1, 100, 1.0)), None);
        let uneven = [rows(20, 10, 1.0), rows(20, 13, 1.0)].concat();
        assert_eq!(points_of_a_row(&uneven), None);
        assert_eq!(points_of_a_row(&rows(60, 100, 1.0)[..5950]), None);
        assert_eq!(points_of_a_row(&[]), None);
        assert_eq!(points_of_a_row(&[Vec3::ONE; 50]), None);
    }

    #[test]
    fn the_message_names_the_number() {
        assert!(asked(&rows(60, 100, 1.0)).contains("`--per-strand 100`"));
        assert!(asked(&[Vec3::ONE; 50]).contains("`--per-strand N`"));
    }
}
