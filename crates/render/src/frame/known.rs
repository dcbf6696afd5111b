//! Values of each pixel beside its light: the nearest strand, the depth of the body.

use glam::Vec3;

use super::projection::Projection;
use super::samples::Samples;
use crate::Camera;
use crate::strands::Strands;

/// Depth along the view \[m\] of every strand point, 0 where it is nearer than the near plane.
pub(crate) fn depths(strands: &Strands, camera: &Camera, samples: &Samples) -> Vec<f32> {
    let projection = Projection::new(camera, samples);
    let depth = |point: &Vec3| match projection.screen(*point, 0.0).z {
        0.0 => 0.0,
        inverse => 1.0 / inverse,
    };
    strands.positions.iter().map(depth).collect()
}

/// Depth along the view \[m\] of the body's nearest sample in every pixel of `scale` samples a side, 0 where there is
/// none; shape `[row][column]`.
pub(crate) fn body_depths(samples: &Samples, scale: usize) -> Vec<f32> {
    let (width, height) = (samples.width() / scale, samples.height() / scale);
    let nearest = |index: usize| {
        let (column, row) = (index % width * scale, index / width * scale);
        let sample = |at: usize| samples.inverse_depths[samples.index(column + at % scale, row + at / scale)];
        (0..scale * scale).map(sample).fold(0.0, f32::max)
    };
    (0..width * height).map(nearest).map(|inverse| if inverse > 0.0 { 1.0 / inverse } else { 0.0 }).collect()
}

/// Number of the nearest strand among all of the groom, from 1, in every pixel of `scale` samples a side; 0 without one, or where the body hides
/// it. Strands count as lines.
pub(crate) fn nearest_strands(
    strands: &Strands,
    camera: &Camera,
    samples: &Samples,
    scale: usize,
) -> Vec<f32> {
    let projection = Projection::new(camera, samples);
    let (width, height) = (samples.width() / scale, samples.height() / scale);
    // One over the depth, and the strand.
    let mut nearest = vec![(0.0_f32, 0.0_f32); width * height];
    let count = strands.points_per_strand;
    let number = |strand: usize| {
        let (guide, index) = strands.place(strand);
        (guide * strands.strands_per_guide + index + 1) as f32
    };
    for segment in 0..strands.strand_count * count.saturating_sub(1) {
        let (strand, at) = (segment / (count - 1), segment % (count - 1));
        let point = strand * count + at;
        let [start, end] = [point, point + 1].map(|point| projection.screen(strands.positions[point], 0.0));
        let way = (end - start) / scale as f32;
        let longest = way.x.abs().max(way.y.abs());
        if start.z <= 0.0 || end.z <= 0.0 || !(longest < 1e5) {
            continue;
        }
        let steps = longest.ceil().max(1.0);
        for step in 0..=steps as usize {
            let place = start.lerp(end, step as f32 / steps);
            if !(place.x >= 0.0 && place.y >= 0.0) {
                continue;
            }
            let (x, y) = (place.x as usize, place.y as usize);
            let (column, row) = (x / scale, y / scale);
            if column < width && row < height {
                let known = &mut nearest[row * width + column];
                if place.z > known.0 && place.z >= samples.inverse_depths[samples.index(x, y)] {
                    *known = (place.z, number(strand));
                }
            }
        }
    }
    nearest.into_iter().map(|(_, strand)| strand).collect()
}
