use std::convert::Infallible;
use std::sync::Arc;

use glam::{Vec2, Vec3, Vec4};
use strandline_base::{Recent, par::prelude::*};

use super::eyeball::eyeball;
use super::model::Mannequin;
use super::person::{Build, Eyes};
use super::surface::settle;
use super::{paint, refine};
use crate::scalp_place::uv;
use crate::{Material, Materials, Mesh};

/// Balls \[m\] within which the skin is drawn with finer triangles: centre on the side of positive x, radius, and how
/// many times its edges are split.
const FINE: [(Vec3, f32, u32); 6] = [
    // The head; eyes and brows, nose, mouth, ears.
    (Vec3::new(0.0000, -0.0100, 0.0100), 0.1300, 1),
    (Vec3::new(0.0310, -0.0165, 0.0780), 0.0190, 3),
    (Vec3::new(0.0320, 0.0025, 0.0860), 0.0245, 3),
    (Vec3::new(0.0000, -0.0500, 0.1030), 0.0240, 3),
    (Vec3::new(0.0000, -0.0780, 0.0950), 0.0310, 3),
    (Vec3::new(0.0850, -0.0340, -0.0100), 0.0400, 2),
];
/// Rounds in which edges are split, the margins of the lids in the last one too.
const ROUNDS: u32 = 4;
/// The skin is finest this near \[m\] to the margins of the lids.
const FINEST: f32 = 0.0015;
/// Roughness of the wet eye.
const WET: f32 = 0.2;

impl Mannequin {
    /// The bust as it is drawn: the skin, finer where the face has details, with its colours as factors of the body's
    /// colour and the scalp's coordinates, and two eyeballs with colours of their own.
    ///
    /// Materials: `skin` has no colour of its own, `eyes` have. Coordinates are those of [`crate::Root::uv`], v down.
    ///
    /// The process keeps the last two.
    pub fn figure(&self) -> Mesh {
        static FIGURES: Recent<(Build, Eyes), Mesh, 2> = Recent::new();
        let Ok(figure) = FIGURES.get(self.kind(), || Ok::<_, Infallible>(self.drawn()));
        (*figure).clone()
    }

    fn drawn(&self) -> Mesh {
        let mut mesh = self.coarse_mesh(2.0);
        for round in 0..ROUNDS {
            self.refine(&mut mesh, round);
        }
        let colors: Vec<Vec4> = mesh
            .positions
            .par_iter()
            .map(|&position| paint::factor(&self.shape, position).extend(1.0))
            .collect();
        let coordinates = mesh.triangles.iter().map(|corners| {
            corners.map(|corner| {
                let place = uv(mesh.positions[corner as usize]);
                Vec2::new(place.x, 1.0 - place.y)
            })
        });
        let skin = Material { name: Some("skin".to_owned()), ..Material::default() };
        let eyes = Material {
            name: Some("eyes".to_owned()),
            color: Some(Vec4::ONE),
            roughness: Some(WET),
            ..Material::default()
        };
        let mut materials = Materials {
            list: vec![skin, eyes],
            of_triangles: vec![0; mesh.triangles.len()],
            coordinates: coordinates.collect(),
            colors,
            ..Materials::default()
        };
        let sides: &[f32] = if self.has_open_eyes() { &[1.0, -1.0] } else { &[] };
        for &side in sides {
            let ball = eyeball(&self.shape.eye, side);
            let first = mesh.positions.len() as u32;
            materials.of_triangles.resize(mesh.triangles.len() + ball.triangles.len(), 1);
            materials.coordinates.resize(materials.of_triangles.len(), [Vec2::ZERO; 3]);
            materials.colors.extend(ball.colors);
            mesh.positions.extend(ball.positions);
            mesh.normals.extend(ball.normals);
            mesh.triangles.extend(ball.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        }
        mesh.materials = Some(Arc::new(materials));
        mesh
    }

    /// Splits edges where the face has details, and carries the new vertices onto the skin.
    fn refine(&self, mesh: &mut Mesh, round: u32) {
        let is_fine = |middle: Vec3| {
            let half = Vec3::new(middle.x.abs(), middle.y, middle.z);
            let eye = &self.shape.eye;
            let is_margin =
                || half.distance(eye.center) < 1.5 * eye.radius && eye.opening(half).0.abs() < FINEST;
            (round + 1 == ROUNDS && is_margin())
                || FINE
                    .iter()
                    .any(|(center, radius, times)| round < *times && half.distance(*center) < *radius)
        };
        let ends = refine::split(&mesh.positions, &mut mesh.triangles, is_fine);
        let (positions, normals): (Vec<Vec3>, Vec<Vec3>) = ends
            .par_iter()
            .map(|ends| {
                let [a, b] = ends.map(|end| mesh.positions[end as usize]);
                settle(self, 0.5 * (a + b))
            })
            .unzip();
        mesh.positions.extend(positions);
        mesh.normals.extend(normals);
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::{Build, Eyes, SignedDistance};

    fn figure() -> (Mannequin, Mesh) {
        let mannequin = Mannequin::default();
        let mesh = mannequin.figure();
        (mannequin, mesh)
    }

    #[test]
    fn the_figure_is_closed_and_its_materials_fit() {
        let (_, mesh) = figure();
        let materials = mesh.materials.as_deref().unwrap();
        assert!(materials.fit(mesh.positions.len(), mesh.triangles.len()));
        let open = |triangles: &[[u32; 3]]| {
            let mut edges = BTreeMap::new();
            for [a, b, c] in triangles {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    *edges.entry((from.min(to), from.max(to))).or_insert(0) += if from < to { 1 } else { -1 };
                }
            }
            edges.values().filter(|sum| **sum != 0).count()
        };
        assert_eq!(open(&mesh.triangles), 0);
        assert_ne!(open(&mesh.triangles[1..]), 0);
    }

    #[test]
    fn eyeballs_show_between_the_lids_and_nowhere_else() {
        let (mannequin, mesh) = figure();
        let materials = mesh.materials.as_deref().unwrap();
        let eye = &mannequin.shape.eye;
        let (mut bare, mut hidden) = (0, 0);
        for (triangle, _) in mesh.triangles.iter().zip(&materials.of_triangles).filter(|(_, of)| **of == 1) {
            let place = mesh.positions[triangle[0] as usize];
            let (into, _) = eye.opening(Vec3::new(place.x.abs(), place.y, place.z));
            let distance = mannequin.distance(place);
            if place.z > eye.center.z && into > 0.0016 {
                // The ball is drawn 0.3 mm larger than the solid, its cornea 1 mm more.
                assert!((0.0..1.5e-3).contains(&distance), "{place}: {distance}");
                bare += 1;
            } else if place.z < eye.center.z || into < -0.0005 {
                assert!(distance < 0.0, "{place}: {distance}");
                hidden += 1;
            }
        }
        assert!(bare > 2000 && hidden > 2000, "{bare} {hidden}");
        let closed = Mannequin::of(Build::Medium, Eyes::Closed);
        let front = eye.center + Vec3::Z * eye.radius;
        assert!(closed.distance(front) < -0.001 && mannequin.distance(front).abs() < 1e-4);
    }

    #[test]
    fn colours_lie_where_a_face_has_them() {
        let (mannequin, mesh) = figure();
        let materials = mesh.materials.as_deref().unwrap();
        let at = |place: Vec3, of: u32| {
            let vertices = mesh.triangles.iter().zip(&materials.of_triangles).filter(|(_, one)| **one == of);
            let nearest = vertices
                .map(|(corners, _)| corners[0] as usize)
                .min_by(|a, b| {
                    let [a, b] = [a, b].map(|vertex| mesh.positions[*vertex].distance(place));
                    a.total_cmp(&b)
                })
                .unwrap();
            materials.colors[nearest].truncate()
        };
        let eye = mannequin.shape.eye;
        let ahead = |x: f32| eye.center + Vec3::new(x, 0.0, eye.radius);
        let [pupil, iris, white] = [0.0, 0.0038, 0.0080].map(|x| at(ahead(x), 1));
        assert!(pupil.max_element() < 0.01 && white.min_element() > 0.3, "{pupil} {white}");
        assert!(iris.x > 2.0 * iris.z && iris.x > 5.0 * pupil.x && iris.x < 0.5 * white.x, "{iris}");
        let [lip, cheek] =
            [Vec3::new(0.0, -0.083, 0.1), Vec3::new(0.05, -0.07, 0.06)].map(|place| at(place, 0));
        assert!(lip.y < 0.75 * cheek.y && lip.x > 1.2 * lip.y, "{lip} {cheek}");
        let brow = at(Vec3::new(0.033, 0.0058, 0.09), 0);
        assert!(brow.max_element() < 0.7 * cheek.min_element(), "{brow}");
    }

    #[test]
    fn builds_share_skull_and_scalp() {
        let builds = Build::ALL.map(|build| Mannequin::of(build, Eyes::Open));
        let places = builds[1].scalp().roots(500, 1);
        for root in places.iter().filter(|root| root.position.y > -0.03) {
            let [slender, medium, broad] =
                [0, 1, 2].map(|build: usize| builds[build].distance(root.position));
            let most = (slender - medium).abs().max((broad - medium).abs());
            assert!(most < 1e-6, "{} {slender} {medium} {broad}", root.position);
        }
        let side = |build: usize| {
            let side =
                |step: &i32| builds[build].distance(Vec3::new(*step as f32 * 1e-3, -0.24, -0.04)) > 0.0;
            (0..300).find(side).unwrap()
        };
        assert!(side(0) + 8 < side(1) && side(1) + 8 < side(2), "{} {} {}", side(0), side(1), side(2));
        for build in &builds {
            let bounds = build.bounds();
            let fits = |vertex: &Vec3| vertex.cmpge(bounds.min).all() && vertex.cmple(bounds.max).all();
            assert!(build.figure().positions.iter().all(fits));
        }
    }
}
