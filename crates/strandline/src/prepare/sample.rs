//! Units and axes of a groom and its body, estimated from roots, tips and vertices.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec3};
use strandline_base::math;

use super::placing::{Placing, diagonal};
use crate::{
    body::{Aabb, Mesh, Random},
    groom::{Groom, format::UNITS},
};

/// Units that a file may have where none of `UNITS` fits: feet, decimetres, tenths of millimetres.
pub(super) const FURTHER: [f32; 3] = [0.3048, 0.1, 1e-4];
/// Roots and vertices that are looked at.
const ROOTS: usize = 200;
const VERTICES: usize = 3000;
/// Distance of roots from the body as a share of its size that needs no other guess, and how much nearer another
/// one has to bring them.
pub(super) const NEAR: f32 = 0.03;
pub(super) const NEARER: f32 = 0.5;
/// Share of the head by which hair has to grow and lead to one side of it for that to be its back.
const BEHIND: f32 = 0.08;

/// Hair is that of a head where roots lie as high on the body as this share of it, and lie around as much of what is
/// there: not the fur of an animal, nor its mane.
const ON_TOP: f32 = 0.3;
/// Height over the width of what may be a scalp: no fur, no brow and no beard.
pub(super) const HEIGHTS: std::ops::RangeInclusive<f32> = 0.4..=1.6;
const AROUND: f32 = 0.6;

/// Some roots, tips and vertices of a groom and its body, in units of their files.
pub(super) struct Sample {
    roots: Vec<Vec3>,
    tips: Vec<Vec3>,
    vertices: Vec<Vec3>,
    /// Places on the body's triangles too: of a box vertices alone are far from most of it.
    skin: Vec<Vec3>,
    bounds: Aabb,
}

impl Sample {
    pub fn new(grooms: &[&Groom], mesh: &Mesh) -> Self {
        let count: usize = grooms.iter().map(|groom| groom.strand_count()).sum();
        let every = (count / ROOTS).max(1);
        let all =
            || grooms.iter().flat_map(|groom| (0..groom.strand_count()).map(|strand| groom.strand(strand)));
        let strands = || all().step_by(every);
        let vertices = (mesh.positions.len() / VERTICES).max(1);
        let mut skin: Vec<Vec3> = mesh.positions.iter().step_by(vertices).copied().collect();
        skin.extend(on_triangles(mesh, VERTICES));
        let nothing = Aabb { min: Vec3::ZERO, max: Vec3::ZERO };
        Self {
            roots: strands().map(|strand| strand[0]).collect(),
            tips: strands().map(|strand| strand[strand.len() - 1]).collect(),
            vertices: mesh.positions.iter().step_by(vertices).copied().collect(),
            skin,
            bounds: mesh.bounds().unwrap_or(nothing),
        }
    }

    /// Middle distance of roots from the nearest place on the body, as a share of the body's size.
    pub fn apart(&self, groom_unit: f32, groom_turn: Quat, body_unit: f32, body_turn: Quat) -> f32 {
        let skin: Vec<Vec3> = self.skin.iter().map(|place| body_turn * (body_unit * *place)).collect();
        let mut apart: Vec<f32> = self
            .roots
            .iter()
            .map(|root| {
                let root = groom_turn * (groom_unit * *root);
                skin.iter().map(|place| place.distance_squared(root)).fold(f32::INFINITY, f32::min)
            })
            .collect();
        apart.sort_by(f32::total_cmp);
        let middle = apart.get(apart.len() / 2).copied().unwrap_or(0.0).sqrt();
        middle / (body_unit * diagonal(self.bounds)).max(f32::MIN_POSITIVE)
    }

    /// Evidence for an axis to point up, each -1 to 1: roots lie high on the body, and strands hang.
    pub fn upness(&self, axis: Vec3) -> [f32; 2] {
        let count = self.roots.len() as f32;
        let extent = (self.bounds.max - self.bounds.min).dot(axis).max(f32::MIN_POSITIVE);
        let middle = 0.5 * (self.bounds.min + self.bounds.max);
        let high =
            self.roots.iter().map(|root| (*root - middle).dot(axis) / (0.5 * extent)).sum::<f32>() / count;
        let ways = self.roots.iter().zip(&self.tips).map(|(root, tip)| (*root - *tip).normalize_or_zero());
        let hangs = ways.map(|way| way.dot(axis)).sum::<f32>() / count;
        [high.clamp(-1.0, 1.0), hangs]
    }

    /// Width \[m\] of the scalp, where hair is that of a head that looks along z.
    pub fn scalp(&self, groom: &Placing, body: &Placing) -> Option<f32> {
        let placed = |places: &[Vec3], placing: &Placing| -> Vec<Vec3> {
            places.iter().map(|place| placing.turn * (placing.scale * *place)).collect()
        };
        let between = |mut values: Vec<f32>| {
            values.sort_by(f32::total_cmp);
            let at = |percent: usize| values.get(values.len() * percent / 100).copied();
            at(5).zip(at(95))
        };
        let (roots, vertices) = (placed(&self.roots, groom), placed(&self.vertices, body));
        let (lowest, highest) = between(roots.iter().map(|root| root.y).collect())?;
        let ends = vertices.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), vertex| {
            (low.min(vertex.y), high.max(vertex.y))
        });
        let (left, right) = between(roots.iter().map(|root| root.x).collect())?;
        let beside = vertices.iter().filter(|vertex| (lowest..=highest).contains(&vertex.y));
        let (skull_left, skull_right) = between(beside.map(|vertex| vertex.x).collect())?;
        let is_on_top = lowest - ends.0 > ON_TOP * (ends.1 - ends.0);
        // A plate is no head.
        let is_high = HEIGHTS.contains(&((highest - lowest) / (right - left)));
        let is_around = right - left > AROUND * (skull_right - skull_left);
        (is_on_top && is_high && is_around && right > left).then_some(right - left)
    }

    /// The turn about y after which a head looks along +z, where hair lies to one side of it: at its back.
    pub fn to_front(&self, groom: &Placing, body: &Placing) -> Quat {
        let roots: Vec<Vec3> = self.roots.iter().map(|root| groom.turn * (groom.scale * *root)).collect();
        let mut heights: Vec<f32> = roots.iter().map(|root| root.y).collect();
        heights.sort_by(f32::total_cmp);
        // The skull is what lies as high as three of four roots: no shoulders, no nape.
        let low = heights.get(heights.len() / 4).copied().unwrap_or(0.0);
        let vertices = self.vertices.iter().map(|vertex| body.turn * (body.scale * *vertex));
        let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let (min, max) = vertices
            .filter(|vertex| vertex.y >= low)
            .fold(start, |(min, max), vertex| (min.min(vertex), max.max(vertex)));
        if min.x > max.x {
            return Quat::IDENTITY;
        }
        let center = roots.iter().sum::<Vec3>() / roots.len().max(1) as f32;
        let size = (max - min).with_y(0.0).max_element().max(f32::MIN_POSITIVE);
        let tips = self.tips.iter().map(|tip| groom.turn * (groom.scale * *tip));
        let combed = tips.zip(&roots).map(|(tip, root)| tip - root).sum::<Vec3>() / roots.len().max(1) as f32;
        // Hair grows at the back, and is combed there.
        let back = (center - 0.5 * (min + max) + combed) / size;
        if back.z.abs() >= back.x.abs() {
            if back.z > BEHIND { math::rotation(Vec3::Y, PI) } else { Quat::IDENTITY }
        } else if back.x.abs() > BEHIND {
            // The back, at +x or -x, comes to -z.
            math::rotation(Vec3::Y, FRAC_PI_2.copysign(back.x))
        } else {
            Quat::IDENTITY
        }
    }
}

/// Vertices of a mesh and places on its triangles, about as many of each.
pub(super) fn surface(mesh: &Mesh, count: usize) -> Vec<Vec3> {
    let every = mesh.positions.len().div_ceil(count).max(1);
    let mut places: Vec<Vec3> = mesh.positions.iter().step_by(every).copied().collect();
    places.extend(on_triangles(mesh, count));
    places
}

/// Places spread over the triangles of a mesh by their areas.
fn on_triangles(mesh: &Mesh, count: usize) -> Vec<Vec3> {
    let corners = |index: usize| mesh.triangles[index].map(|corner| mesh.positions[corner as usize]);
    let mut total = 0.0;
    let areas: Vec<f64> = (0..mesh.triangles.len())
        .map(|index| {
            let [a, b, c] = corners(index);
            total += f64::from((b - a).cross(c - a).length());
            total
        })
        .collect();
    (0..count)
        .map(|place| {
            let wanted = total * (place as f64 + 0.5) / count as f64;
            let [a, b, c] = corners(areas.partition_point(|area| *area <= wanted).min(areas.len() - 1));
            let mut random = Random::new(0, place as u64);
            let (mut u, mut v) = (random.unit(), random.unit());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            a + (b - a) * u + (c - a) * v
        })
        .collect()
}

/// Metres of a unit of a mesh that strands \[m\] grow on: given, or what brings it to their roots. And how far half of
/// the roots then are from it, as a share of its size.
pub fn mesh_unit(groom: &Groom, mesh: &Mesh, given: Option<f32>) -> (f32, f32) {
    let sample = Sample::new(&[groom], mesh);
    let apart = |unit: f32| sample.apart(1.0, Quat::IDENTITY, unit, Quat::IDENTITY);
    let (mut best, mut least) = (given.unwrap_or(1.0), apart(given.unwrap_or(1.0)));
    for unit in UNITS.into_iter().filter(|_| given.is_none()) {
        let found = apart(unit);
        if found < NEARER * least && least > NEAR {
            (best, least) = (unit, found);
        }
    }
    (best, least)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        body::Mannequin,
        groom::{Style, StyleSettings},
    };

    #[test]
    fn the_unit_of_a_mesh_is_that_which_brings_it_to_the_roots() {
        let groom = StyleSettings { strand_count: 300, ..StyleSettings::new(Style::Bob) }.grow().unwrap();
        for unit in UNITS {
            let mut mesh = Mannequin::new().mesh();
            mesh.positions.iter_mut().for_each(|place| *place /= unit);
            let (found, apart) = mesh_unit(&groom, &mesh, None);
            assert!(found == unit && apart < 0.02, "{unit}: {found}, {apart}");
        }
        let mut far = Mannequin::new().mesh();
        far.positions.iter_mut().for_each(|place| *place += Vec3::X * 3.0);
        assert!(mesh_unit(&groom, &far, None).1 > 1.0);
    }
}
