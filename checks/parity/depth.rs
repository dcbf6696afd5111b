//! Depths that a device reports on a skin that moves by itself.

use std::path::Path;
use std::sync::Arc;

use glam::{Vec3, vec3};
use strandline_body::{BodyFrame, Carrier, Collider, DistanceGrid, Mesh, PosedSkin, Shape, SkinSolid};
use strandline_checks::gpu;
use strandline_groom::{Groom, Guides, LANES};
use strandline_sim::gpu::{GpuRunner, Probe};
use strandline_sim::{Drive, Model, Settings, Stage};

const POINTS: usize = 8;
/// Deepest of the points that lie inside \[m\].
const SHALLOW: f32 = 2e-3;

/// Points \[m\] about the ears of the sample bust in a shrug, with their depths by their nearest triangles: those that lie
/// outside folds that cross themselves though these have them inside, and a few that lie little below the skin.
fn about_folds(mesh: &Mesh, posed: &PosedSkin, skin: &[Vec3]) -> Vec<(Vec3, f32, f32)> {
    let ears = (0..skin.len()).filter(|index| mesh.positions[*index].x.abs() > 0.07);
    let ears = ears.filter(|index| mesh.positions[*index].y > -0.1).step_by(3);
    let places = ears.flat_map(|index| (0..26).map(move |way| (index, way))).map(|(index, way)| {
        let step = vec3((way % 3) as f32, (way / 3 % 3) as f32, (way / 9) as f32) - 1.0;
        skin[index] + step.normalize_or(Vec3::ONE.normalize()) * (0.001 * (1 + way) as f32)
    });
    let found = places.map(|place| {
        let by_faces = -posed.nearest(place, PosedSkin::UNKNOWN).distance;
        (place, by_faces, posed.depth(place, PosedSkin::UNKNOWN))
    });
    found.filter(|(_, by_faces, depth)| *by_faces > 1e-4 && *depth < SHALLOW).collect()
}

/// Sides are those of the CPU: no point outside a fold counts, and those inside do.
#[test]
fn advance_reports_the_same_depth_outside_a_fold_that_crosses_itself() {
    let Some(gpu) = gpu() else { return };
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/bust.glb");
    let (mesh, motion, _) = Mesh::load_moving(&path, "shrug").unwrap();
    let grid = DistanceGrid::of_mesh(&mesh, 0.01, 0.02).unwrap();
    let solid = Arc::new(SkinSolid::new(&mesh, grid.into()).unwrap());
    let skin: Arc<[Vec3]> = motion.positions(0.45).into();
    let posed = PosedSkin::new(&solid, [Some(&skin), Some(&skin)]).unwrap();
    let points = about_folds(&mesh, &posed, &skin);
    let deepest = |depth: fn(&(Vec3, f32, f32)) -> f32| points.iter().map(depth).fold(0.0, f32::max);
    let (by_faces, exact) = (deepest(|point| point.1), deepest(|point| point.2));
    assert!(by_faces > exact + 2e-3 && exact > 5e-4, "nothing to see: {by_faces} m, {exact} m");
    let mut groom = Groom::empty(8e-5);
    let strands = points.len().div_ceil(POINTS - 2);
    (0..strands).for_each(|_| groom.push((0..POINTS).map(|point| Vec3::Y * (0.3 + 0.01 * point as f32))));
    let guides = Guides::resample(&groom, POINTS).unwrap();
    let collider = Collider::new(Shape::Skin(solid), Carrier::HEAD, 0.3).unwrap();
    let model = Model::new(&guides, &Settings::default(), vec![collider]).unwrap();
    let body = BodyFrame::REST.with_skin(skin);
    let state = model.rest_state(body.clone());
    let mut places = state.positions.clone();
    for (index, (place, ..)) in points.iter().enumerate() {
        let (strand, point) = (index / (POINTS - 2), 2 + index % (POINTS - 2));
        places[strand / LANES * POINTS + point].set(strand % LANES, *place);
    }
    let mut probe = Probe::new(&GpuRunner::new(&gpu, model).unwrap(), &state).unwrap();
    probe.set_predicted(&places).unwrap();
    probe.run(&Drive::of(body), &[Stage::Advance]).unwrap();
    let found = probe.report().unwrap().penetration_max;
    assert!((found - exact).abs() < 1e-5, "{found} m on the device, {exact} m, {by_faces} m by faces alone");
}
