//! Scissors: strands end at a length from their roots.

use glam::Vec3;

use crate::{Groom, Widths};

/// A point of the cut groom: a point of the whole one, and the share of the way to the next.
type CutPoint = (usize, f32);

/// Cuts strands to a length \[m\], by a share of what is longer. A strand keeps two points at least, and its points up to
/// the cut keep their bits.
pub(super) fn cut(groom: &mut Groom, strands: &[usize], strength: f32, length: f32) {
    let mut places: Vec<CutPoint> = Vec::with_capacity(groom.points.len());
    let mut starts = vec![0];
    let mut reached = strands.iter().peekable();
    for strand in 0..groom.strand_count() {
        let range = groom.range(strand);
        let points = groom.strand(strand);
        match reached.next_if_eq(&&strand) {
            Some(_) => {
                places.extend(kept(points, strength, length).map(|(at, share)| (range.start + at, share)))
            }
            None => places.extend(range.map(|point| (point, 0.0))),
        }
        starts.push(places.len() as u32);
    }
    groom.points = along(&groom.points, &places, Vec3::lerp);
    let mix = |a: f32, b: f32, share: f32| a + share * (b - a);
    if let Widths::PerPoint(widths) = &mut groom.widths {
        *widths = along(widths, &places, mix);
    }
    let mix_color =
        |a: [f32; 3], b: [f32; 3], share| std::array::from_fn(|part| mix(a[part], b[part], share));
    groom.colors.iter_mut().for_each(|all| *all = along(all, &places, mix_color));
    groom.transparencies.iter_mut().for_each(|all| *all = along(all, &places, mix));
    groom.masses.iter_mut().for_each(|all| *all = along(all, &places, mix));
    groom.velocities.iter_mut().for_each(|all| *all = along(all, &places, Vec3::lerp));
    groom.starts = starts;
}

/// Places of a strand's points up to the cut.
fn kept(points: &[Vec3], strength: f32, length: f32) -> impl Iterator<Item = CutPoint> {
    let whole: f32 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let left = if whole > length { whole - strength * (whole - length) } else { whole };
    let mut passed = 0.0;
    let mut end = (points.len().saturating_sub(1), 0.0);
    if left < whole {
        for (point, pair) in points.windows(2).enumerate() {
            let segment = pair[0].distance(pair[1]);
            if passed + segment > left {
                end = (point, ((left - passed) / segment).clamp(0.0, 1.0));
                break;
            }
            passed += segment;
        }
        // A cut at a point ends the strand there.
        if end.1 == 0.0 && end.0 == 0 && points.len() > 1 {
            end = (0, f32::MIN_POSITIVE);
        }
    }
    let (last, share) = end;
    (0..=last)
        .map(|point| (point, 0.0))
        .take(if points.is_empty() { 0 } else { last + 1 })
        .chain((share > 0.0).then_some((last, share)))
}

fn along<T: Copy>(values: &[T], places: &[CutPoint], mix: impl Fn(T, T, f32) -> T) -> Vec<T> {
    let at = |(point, share): &CutPoint| match *share > 0.0 {
        true => mix(values[*point], values[point + 1], *share),
        false => values[*point],
    };
    places.iter().map(at).collect()
}
