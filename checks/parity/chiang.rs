//! Light that hair scatters many times, on both backends.

use glam::Vec3;
use strandline_groom::Style;
use strandline_render::Look;
use strandline_render::cpu::{
    Curves, Lit, Occlusion, Scattering, ShadowBody, SkinColor, interpolate, opacity_depth, opacity_layers,
    root_densities, tessellate,
};
use strandline_render::fibre::Pigment;
use strandline_render::{OwnColors, Shadows, Strands};

use crate::picture::{Both, drawn_on_gpu};

impl Both {
    /// The strands on the CPU with light that is scattered many times.
    fn scattered_on_cpu(
        &self,
        positions: &[strandline_groom::Vec3Lanes],
        body: Option<ShadowBody>,
    ) -> Strands {
        let (mut curves, mut strands, mut shadows) =
            (Curves::default(), Strands::default(), Shadows::default());
        let level = self.level();
        tessellate(positions, &self.guides, &self.body.world_from_head(), &level, &mut curves);
        interpolate(&curves, &self.guides, &self.body.world_from_head(), &self.look, &level, &mut strands);
        let settings = self.look.hair_shadow();
        opacity_depth(&strands, body, &self.lights, self.middle(), &settings, &mut shadows);
        opacity_layers(&strands, &mut shadows);
        let mut occlusion = Occlusion::default();
        occlusion.set_grid(self.middle(), self.look.fibre.chiang.cells);
        let own_colors = OwnColors::of(&self.guides);
        let (body_look, own) = (self.input(positions).body_look, own_colors.as_ref().map(|own| own.mean));
        let skin = SkinColor::new(body_look.color, body_look, &self.look, own);
        let lit = Lit {
            lights: &self.lights,
            shadows: &shadows,
            body: body.map(|body| (body, skin)),
            look: &self.look,
            own_colors: own_colors.as_ref(),
            eye: self.camera.position,
        };
        Scattering::default().shade(&mut strands, &lit, &mut occlusion);
        strands
    }
}

#[test]
fn the_fibre_of_chiang_agrees_point_by_point() {
    for (pigment, body) in [(Pigment::Melanin, false), (Pigment::Melanin, true), (Pigment::Color, true)] {
        let mut both = Both::new(Style::Wavy, 16);
        both.look = Look { grey: 0.2, ..Look::brown() };
        both.look.fibre.chiang.pigment = pigment;
        both.look.fibre.chiang.tip_pigment = 0.7;
        // Colours of the groom are compared in all cells.
        both.look.fibre.chiang.cells = 12;
        agree(both, body);
    }
}

#[test]
fn colours_of_the_groom_agree_point_by_point() {
    let mut both = Both::colored();
    both.look = Look::brown();
    // The plain stages here have no guides to choose texels by, as the renderer does for light colours.
    both.look.shadow.map_size = 512;
    agree(both, true);
}

#[test]
fn fewer_cells_of_scattered_light_agree_point_by_point() {
    let mut both = Both::new(Style::Wavy, 16);
    both.look = Look::brown();
    both.look.fibre.chiang.cells = 16;
    agree(both, true);
}

/// Compares a GPU's result with the CPU's.
fn agree(mut both: Both, body: bool) {
    // As many as a software adapter does in a short time.
    both.look.fibre.chiang.scatterings = 3;
    let positions = both.positions();
    let Some(renderer) = drawn_on_gpu(&both, &positions, body) else { return };
    let found = renderer.strands().unwrap().radiances;
    let placed: Vec<Vec3> =
        both.mesh.positions.iter().map(|&point| both.body.world_from_head().point(point)).collect();
    let roots = root_densities(&both.mesh.positions, &both.guides);
    assert!(roots.iter().any(|density| *density > 0.5), "skin among roots is darker");
    let triangles = &both.mesh.triangles;
    let shape = body.then_some(ShadowBody { positions: &placed, triangles, roots: &roots, cuts: None });
    let strands = both.scattered_on_cpu(&positions, shape);
    let all: f32 = strands.radiances.iter().map(|radiance| radiance.element_sum()).sum();
    let pairs = strands.radiances.iter().zip(&found);
    let off: f32 = pairs.map(|(one, other)| (*one - *other).abs().element_sum()).sum();
    // Half floats round by 1.2e-4 in the mean, sums of cells by 1e-6 of a face's area; some hair lies between two
    // known directions of the lattice and takes one here, the other there.
    assert!(off <= 5e-3 * all, "{body}: {off} of {all}");
    assert!(all > 0.01 * found.len() as f32, "{all} on {} points", found.len());
}
