//! Drawn skin whose vertices move by themselves.

use std::sync::Arc;

use glam::Vec3;
use strandline_body::{BodyFrame, Mannequin};
use strandline_checks::{flip::compare, gpu};
use strandline_groom::Style;
use strandline_render::gpu::GpuRenderer;
use strandline_render::{Picture, PictureSettings, Renderer};

use crate::draw::MEAN;
use crate::picture::Both;

/// Allowed difference of two pictures.
const ONE_IN_A_HUNDRED: f32 = 0.1;

fn scene() -> Both {
    let mut both = Both::new(Style::Pixie, 12);
    both.settings = PictureSettings::sized(192, 192);
    // Normals of skin that moves by itself are those of its triangles: near those of the form where they are small.
    both.mesh = Mannequin::new().coarse_mesh(1.5);
    both
}

/// The vertices with the neck bent aside and the face pushed forward.
fn bent(both: &Both) -> Arc<[Vec3]> {
    let bend = |point: &Vec3| {
        let (below, above) = ((-0.05 - point.y).max(0.0), (point.y + 0.05).max(0.0));
        *point + Vec3::new(0.5 * below, 0.0, if point.z > 0.0 { 0.4 * above } else { 0.0 })
    };
    both.mesh.positions.iter().map(bend).collect()
}

/// Pictures of the CPU and, where there is one, a GPU.
fn pictures(both: &Both, positions: &[strandline_groom::Vec3Lanes]) -> Vec<Picture> {
    let (mesh, input) = (Some(&both.mesh), both.input(positions));
    let mut pictures =
        vec![Renderer::new(&both.guides, mesh, &both.settings).unwrap().draw(&input).unwrap().0];
    if let Some(gpu) = gpu() {
        let mut renderer = GpuRenderer::new(&gpu, &both.guides, mesh, &both.settings).unwrap();
        pictures.push(renderer.draw(&input).unwrap().0);
    }
    pictures
}

fn is_alike(one: &Picture, other: &Picture) -> Result<(), String> {
    compare(one, other, MEAN, ONE_IN_A_HUNDRED)
}

#[test]
fn draw_agrees_on_skin_that_moved() {
    let mut both = scene();
    let positions = both.positions();
    let rest = pictures(&both, &positions);
    both.body = both.body.clone().with_skin(bent(&both));
    let moved = pictures(&both, &positions);
    if let [on_cpu, on_gpu] = &moved[..] {
        is_alike(on_gpu, on_cpu).unwrap();
    }
    for (rest, moved) in rest.iter().zip(&moved) {
        assert!(is_alike(rest, moved).is_err(), "the comparison can fail");
    }
}

/// A skin that is turned and carried in head space looks as one that its head turns and carries: normals, shadows and
/// light that it reflects onto hair among it.
#[test]
fn skin_that_moves_by_itself_is_drawn_as_one_that_its_head_moves() {
    let mut both = scene();
    let (positions, head) = (both.positions(), both.body.world_from_head());
    let by_head = pictures(&both, &positions);
    let skin: Arc<[Vec3]> = both.mesh.positions.iter().map(|point| head.point(*point)).collect();
    let roots = vec![head; both.guides.strand_count()];
    both.body = BodyFrame::REST.with_roots(roots.clone()).with_skin(skin);
    for (wanted, found) in by_head.iter().zip(pictures(&both, &positions)) {
        is_alike(wanted, &found).unwrap();
    }
    both.body = BodyFrame::REST.with_roots(roots);
    for (wanted, found) in by_head.iter().zip(pictures(&both, &positions)) {
        assert!(is_alike(wanted, &found).is_err(), "the law can fail");
    }
}

#[test]
fn vertices_are_written_where_they_moved_and_else_are_not() {
    let Some(gpu) = gpu() else { return };
    let both = scene();
    let positions = both.positions();
    let mut renderer = GpuRenderer::new(&gpu, &both.guides, Some(&both.mesh), &both.settings).unwrap();
    let (rest, moved) = (both.body.clone(), both.body.clone().with_skin(bent(&both)));
    let mut writes = |body: &BodyFrame| {
        renderer.draw(&strandline_render::FrameInput { body, ..both.input(&positions) }).unwrap();
        renderer.skin_writes()
    };
    // At rest, moved, held, the same vertices in other memory, at rest again.
    assert_eq!([writes(&rest), writes(&moved), writes(&moved)], [0, 1, 1]);
    let other: Vec<Vec3> = bent(&both).to_vec();
    assert_eq!([writes(&both.body.clone().with_skin(other)), writes(&rest), writes(&rest)], [1, 2, 2]);
}

#[test]
fn skin_of_another_mesh_is_refused() {
    let mut both = scene();
    let positions = both.positions();
    both.body = both.body.clone().with_skin([Vec3::ZERO; 3]);
    let (mesh, input) = (Some(&both.mesh), both.input(&positions));
    let mut refused =
        vec![Renderer::new(&both.guides, mesh, &both.settings).unwrap().draw(&input).map(|_| ())];
    if let Some(gpu) = gpu() {
        let mut renderer = GpuRenderer::new(&gpu, &both.guides, mesh, &both.settings).unwrap();
        refused.push(renderer.draw(&input).map(|_| ()));
    }
    for refused in refused {
        let message = refused.unwrap_err().to_string();
        assert!(message.contains("the number of skin vertices is 3, for a mesh of"), "{message}");
    }
    // Without a mesh nothing of it is drawn.
    let mut renderer = Renderer::new(&both.guides, None, &both.settings).unwrap();
    assert!(renderer.draw(&input).is_ok());
}
