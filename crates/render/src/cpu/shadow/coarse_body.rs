//! A body of few triangles that casts shadows and reflects light in the place of a fine one, for simpler pictures.

use glam::Vec3;
use strandline_body::{BodyFrame, CoarseMesh, Mesh};

use super::ShadowBody;
use crate::surfaces::Surfaces;

/// Most triangles: on a bust their sides are about a centimetre long, as the cells of scattered light in simpler pictures.
const MOST: usize = 6000;

/// The body of few triangles, made from the mesh of a fine one when it is first placed.
#[derive(Debug, Default)]
pub(crate) struct CoarseBody {
    mesh: Option<CoarseMesh>,
    is_made: bool,
    /// Vertex positions \[m\], world space.
    positions: Vec<Vec3>,
    /// Density of roots about every vertex, 0 to 1; empty without roots.
    roots: Vec<f32>,
}

impl CoarseBody {
    /// Carries it to the place of a body with its densities of roots. Triangles whose middle materials cut away are left
    /// out.
    pub fn place(&mut self, mesh: &Mesh, surfaces: Option<&Surfaces>, roots: &[f32], frame: &BodyFrame) {
        if !self.is_made {
            let cuts = surfaces.filter(|surfaces| surfaces.cuts);
            let middle = Vec3::splat(1.0 / 3.0);
            let is_cut = |surfaces: &Surfaces, index: usize| surfaces.at(index as u32, middle, 0.0).is_cut();
            let keeps = |index| !cuts.is_some_and(|surfaces| is_cut(surfaces, index));
            self.mesh = CoarseMesh::new(mesh, MOST, keeps);
            self.is_made = true;
        }
        if let Some(coarse) = &self.mesh {
            coarse.place(mesh, frame, &mut self.positions);
            self.roots.clear();
            self.roots.extend(coarse.vertices.iter().filter_map(|vertex| roots.get(*vertex as usize)));
        }
    }

    /// The body in its place; `None` where none of so few triangles was found, and before it was placed.
    pub fn shadow_body(&self) -> Option<ShadowBody<'_>> {
        let coarse = self.mesh.as_ref()?;
        let Self { positions, roots, .. } = self;
        Some(ShadowBody { positions, triangles: &coarse.triangles, roots, cuts: None })
    }
}

#[cfg(test)]
mod tests {
    use strandline_groom::{Groom, Guides};

    use super::*;
    use crate::cpu::{
        Lit, Occlusion, Renderer, Scattering, SkinColor, opacity_depth, opacity_layers, root_densities,
    };
    use crate::shadow::Shadows;
    use crate::{BodyLook, Camera, FrameInput, LevelOfDetail, Light, Look, PictureSettings};

    /// Squares along a side of the body.
    const SIDE: u32 = 150;

    /// A bowl of 0.3 m with waves that few triangles do not have, below hair.
    fn bowl() -> Mesh {
        let place = |at: u32| {
            let [x, z] = [at % (SIDE + 1), at / (SIDE + 1)].map(|at| 0.3 * (at as f32 / SIDE as f32 - 0.5));
            Vec3::new(x, (x * x + z * z) + 1e-3 * (900.0 * x).sin() - 0.005, z)
        };
        let square = |at: u32| {
            let first = at / SIDE * (SIDE + 1) + at % SIDE;
            let [right, below] = [first + 1, first + SIDE + 1];
            [[first, below, right], [right, below, below + 1]]
        };
        let positions = (0..(SIDE + 1) * (SIDE + 1)).map(place).collect();
        Mesh::new(positions, (0..SIDE * SIDE).flat_map(square).collect()).unwrap()
    }

    fn hair() -> Guides {
        let mut groom = Groom::empty(8e-5);
        for strand in 0..40 {
            let x = 0.005 * strand as f32 - 0.1;
            groom.push((0..8).map(|point| Vec3::new(x, 0.01 * point as f32, 0.3 * x)));
        }
        Guides::resample(&groom, 8).unwrap()
    }

    #[test]
    fn simpler_pictures_look_at_few_triangles_of_a_body() {
        let (mesh, guides) = (bowl(), hair());
        let picture = PictureSettings::sized(32, 32);
        let mut look = Look { follow_strands: 2, ..Look::brown() };
        (look.shadow.map_size, look.shadow.simple) = (64, true);
        let lights = [Light { position: Vec3::new(0.3, 1.0, 0.2), target: Vec3::ZERO, ..Light::default() }];
        let (camera, body_look) = (Camera::front(), BodyLook::default());
        let mut renderer = Renderer::new(&guides, Some(&mesh), &picture).unwrap();
        let mut draw = |look: &Look| {
            let input = FrameInput {
                positions: guides.positions(),
                body: &BodyFrame::REST,
                camera: &camera,
                look,
                body_look: &body_look,
                lights: &lights,
                level_of_detail: &LevelOfDetail::full(),
            };
            renderer.draw(&input).unwrap();
            let scratch = &renderer.scratch;
            let reflected = found(&scratch.shadows, &scratch.scattering);
            (scratch.strands.clone(), input.middle(scratch.bounds), reflected)
        };
        let (strands, middle, coarse) = draw(&look);
        let full = draw(&Look { shadow: crate::Shadow { simple: false, ..look.shadow }, ..look.clone() }).2;
        let mut few = CoarseBody::default();
        let roots = root_densities(&mesh.positions, &guides);
        few.place(&mesh, None, &roots, &BodyFrame::REST);
        let few = few.shadow_body().unwrap();
        assert!(few.triangles.len() <= MOST && mesh.triangles.len() > 7 * MOST);
        let of_body = |body: ShadowBody| {
            let mut shadows = Shadows::default();
            opacity_depth(&strands, Some(body), &lights, middle, &look.hair_shadow(), &mut shadows);
            opacity_layers(&strands, &mut shadows);
            let (mut scattering, mut occlusion) = (Scattering::default(), Occlusion::default());
            occlusion.set_grid(middle, look.fibre.grid_cells());
            let body = Some((body, SkinColor::new(body_look.color, &body_look, &look, None)));
            let lit = Lit {
                lights: &lights,
                shadows: &shadows,
                body,
                look: &look,
                own_colors: None,
                eye: camera.position,
            };
            scattering.prepare(&strands, &lit, &mut occlusion);
            found(&shadows, &scattering)
        };
        let Mesh { positions, triangles, .. } = &mesh;
        let all = ShadowBody { positions, triangles, roots: &roots, cuts: None };
        assert!(coarse == of_body(few), "no other triangles cast shadows or reflect light");
        assert!(full == of_body(all));
        assert!(coarse.0 != full.0 && coarse.1 != full.1);
        // They are as bright, but for what waves add to the area.
        for (few, all) in coarse.1.iter().zip(&full.1) {
            assert!((few / all - 1.0).abs() < 0.1, "{few} {all}");
        }
    }

    /// Depths of the body in the first map, and scattered light at some places.
    fn found(shadows: &Shadows, scattering: &Scattering) -> (Vec<f32>, Vec<f32>) {
        let places = (0..9).map(|place| Vec3::new(0.02 * place as f32 - 0.08, 0.0, 0.0));
        let light = places.map(|place| scattering.grid().field(place).0[0].x);
        (shadows.map(0).unwrap().body_depths.clone(), light.collect())
    }
}
