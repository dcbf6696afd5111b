//! A ring as a mesh.

use std::f32::consts::TAU;
use std::sync::Arc;

use glam::Vec3;
use strandline_base::math;

use crate::{Material, Materials, Mesh};

/// Sides of a ring along it and around it.
const ALONG: u32 = 48;
const AROUND: u32 = 12;

impl Mesh {
    /// A ring of a thickness \[m\] whose inner side lies on an ellipse of half axes \[m\] at right angles about a middle \[m\], matt and
    /// of a colour, linear RGB.
    pub fn ring(middle: Vec3, half_axes: [Vec3; 2], thickness: f32, color: Vec3) -> Self {
        let tube = 0.5 * thickness;
        let [long, short] = half_axes.map(|axis| axis.normalize_or(Vec3::X) * (axis.length() + tube));
        let normal = long.cross(short).normalize_or(Vec3::Z);
        let mut mesh = Self::default();
        for along in 0..ALONG {
            let turn = math::unit_at(TAU * along as f32 / ALONG as f32);
            let place = middle + turn.x * long + turn.y * short;
            let way = turn.x * short - turn.y * long;
            let out = way.cross(normal).normalize_or(Vec3::X);
            for around in 0..AROUND {
                let turn = math::unit_at(TAU * around as f32 / AROUND as f32);
                let out = turn.x * out + turn.y * normal;
                mesh.positions.push(place + tube * out);
                mesh.normals.push(out);
            }
        }
        for along in 0..ALONG {
            for around in 0..AROUND {
                let corner = |a: u32, b: u32| ((along + a) % ALONG) * AROUND + (around + b) % AROUND;
                let [one, ahead, beside, across] = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
                mesh.triangles.extend([[one, ahead, across], [one, across, beside]]);
            }
        }
        let material = Material {
            name: Some("band".to_owned()),
            color: Some(color.extend(1.0)),
            roughness: Some(0.8),
            ..Material::default()
        };
        mesh.materials =
            Some(Arc::new(Materials { list: vec![material], ..Materials::plain(mesh.triangles.len()) }));
        mesh
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec4;

    use super::*;

    #[test]
    fn a_ring_faces_outward_and_lies_about_its_ellipse() {
        let (long, short) = (Vec3::X * 0.02, Vec3::Z * 0.01);
        let ring = Mesh::ring(Vec3::Y, [long, short], 0.004, Vec3::ZERO).checked().unwrap();
        for corners in &ring.triangles {
            let [a, b, c] = corners.map(|corner| ring.positions[corner as usize]);
            let face = (b - a).cross(c - a).normalize();
            for corner in corners {
                assert!(face.dot(ring.normals[*corner as usize]) > 0.8, "{face}");
            }
        }
        let inside = |place: &Vec3| {
            let at = *place - Vec3::Y;
            (at.x / 0.02).powi(2) + (at.z / 0.01).powi(2)
        };
        let least = ring.positions.iter().map(inside).fold(f32::MAX, f32::min);
        // The line at one distance from an ellipse is none: between its axes the ring lies up to .7 % of them within it.
        assert!((0.98..1.01).contains(&least), "{least}: the inner side touches the ellipse");
        assert_eq!(ring.materials.unwrap().list[0].color, Some(Vec4::W));
    }
}
