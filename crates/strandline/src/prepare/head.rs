//! The pose of a head estimated from its mesh alone: which way it stands and looks, and how wide it is.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec3};
use strandline_base::math;

use super::skull::Skull;
use crate::groom::format::Up;

/// Share of the head by which a face reaches out, or hair is combed, to one side.
const ASIDE: f32 = 0.04;
/// Heights below the crown, over the width of the skull, between which the face is.
const FACE: [f32; 2] = [1.0, 1.4];
/// Vertices whose mirrored places are looked for, and among how many.
const MIRRORED: usize = 300;
const AMONG: usize = 20_000;
/// Distance of mirrored places from vertices along the axis from left to right, over that along the others.
const ALIKE: f32 = 0.5;
/// Length over height of a body that lies: one whose file has z up.
const LYING: f32 = 1.15;

/// The axis along which both halves of a body are alike; none where no one is surely it.
fn side_axis(places: &[Vec3]) -> Option<usize> {
    let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = places.iter().fold(start, |(low, high), place| (low.min(*place), high.max(*place)));
    let among: Vec<Vec3> = places.iter().step_by(places.len().div_ceil(AMONG).max(1)).copied().collect();
    let every = among.len().div_ceil(MIRRORED).max(1);
    let astray = |axis: usize| {
        let mut apart: Vec<f32> = among
            .iter()
            .step_by(every)
            .map(|place| {
                let mut mirrored = *place;
                mirrored[axis] = low[axis] + high[axis] - place[axis];
                among.iter().map(|other| other.distance_squared(mirrored)).fold(f32::INFINITY, f32::min)
            })
            .collect();
        apart.sort_by(f32::total_cmp);
        apart.get(apart.len() / 2).copied().unwrap_or(0.0).sqrt()
    };
    let found: [f32; 3] = std::array::from_fn(astray);
    (0..3).find(|axis| (0..3).all(|other| other == *axis || found[*axis] < ALIKE * found[other]))
}

/// The axis that points up in the vertices of a body: heads and bodies are higher than deep.
pub(super) fn up(places: &[Vec3]) -> Up {
    let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = places.iter().fold(start, |(low, high), place| (low.min(*place), high.max(*place)));
    let size = high - low;
    match side_axis(places) {
        Some(0) if size.z > LYING * size.y => Up::Z,
        Some(1) => Up::Z,
        _ => Up::Y,
    }
}

/// Turns an upright head so that its face looks along +z: at its height a head reaches out to the front, and has most
/// vertices there. None where there is no head.
pub(super) fn front(vertices: &[Vec3]) -> Option<Quat> {
    let skull = Skull::of(vertices)?;
    let [high, low] = FACE.map(|below| skull.top - below * skull.size.min_element());
    let face = vertices.iter().filter(|vertex| (low..=high).contains(&vertex.y));
    let reach = 0.75 * skull.size.max_element();
    let beside = face.map(|vertex| *vertex - Vec3::new(skull.middle.x, vertex.y, skull.middle.y));
    let near: Vec<Vec3> = beside.filter(|beside| beside.length() < reach).collect();
    let mean = near.iter().sum::<Vec3>() / near.len().max(1) as f32;
    let start = (Vec3::ZERO, Vec3::ZERO);
    let (least, most) = near.iter().fold(start, |(least, most), by| (least.min(*by), most.max(*by)));
    let ahead = (mean + 0.5 * (least + most)) / skull.size.max_element();
    let along_z = match side_axis(vertices) {
        Some(0) => true,
        Some(2) => false,
        _ => is_long(&skull),
    };
    Some(turned_to_z(along_z, ahead))
}

/// True where a head looks along z, or against it: heads are longer from front to back than from ear to ear.
pub(super) fn is_long(skull: &Skull) -> bool {
    skull.size.y >= skull.size.x
}

/// The turn about y after which a head looks along +z, given whether it does so along z or along x, and what reaches
/// out to its front \[share of the head\].
pub(super) fn turned_to_z(along_z: bool, front: Vec3) -> Quat {
    match [along_z, front.x < 0.0, front.z < -ASIDE] {
        [true, _, true] => math::rotation(Vec3::Y, PI),
        [true, _, false] => Quat::IDENTITY,
        [false, is_left, _] => math::rotation(Vec3::Y, if is_left { FRAC_PI_2 } else { -FRAC_PI_2 }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Mannequin;

    #[test]
    fn a_head_in_any_axes_stands_up_and_looks_along_z() {
        let bust = Mannequin::new().mesh().positions;
        let z_up = math::rotation(Vec3::X, FRAC_PI_2);
        for (turn, expected) in [
            (Quat::IDENTITY, Up::Y),
            (math::rotation(Vec3::Y, PI), Up::Y),
            (math::rotation(Vec3::Y, FRAC_PI_2), Up::Y),
            (math::rotation(Vec3::Y, -FRAC_PI_2), Up::Y),
            (z_up, Up::Z),
            (z_up * math::rotation(Vec3::Y, FRAC_PI_2), Up::Z),
            (z_up * math::rotation(Vec3::Y, PI), Up::Z),
        ] {
            let turned: Vec<Vec3> = bust.iter().map(|place| turn * *place).collect();
            assert_eq!(up(&turned), expected, "{turn}");
            let upright =
                if expected == Up::Z { math::rotation(Vec3::X, -FRAC_PI_2) } else { Quat::IDENTITY };
            let upright: Vec<Vec3> = turned.iter().map(|place| upright * *place).collect();
            let front = front(&upright).unwrap();
            // Its middle need not be that of its axes.
            let back = |place: &Vec3| front * *place;
            let astray = upright.iter().map(back).zip(&bust).map(|(one, two)| one.distance(*two));
            assert!(astray.fold(0.0, f32::max) < 1e-4, "{turn}");
        }
    }
}
