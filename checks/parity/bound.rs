//! Bound strands placed on a GPU against the same on the CPU.

use std::sync::{Arc, LazyLock};

use glam::{Quat, Vec3};
use strandline_body::{
    BodyFrame, Carrier, Collider, DistanceGrid, Mannequin, Pose, Shape, SkinSolid, Solids,
};
use strandline_checks::{Depths, gpu};
use strandline_groom::{Binding, Frames, Guides, LANES, LaneSet, Style, StyleSettings, Surface, Vec3Lanes};
use strandline_render::Strands;
use strandline_render::cpu::{Curves, interpolate, keep_outside, tessellate};
use strandline_render::gpu::GpuRenderer;
use strandline_render::{BodyLook, Camera, FrameInput, LevelOfDetail, Light, Look, PictureSettings};

pub(crate) const POINTS: usize = 12;
const STRANDS: usize = 1200;

/// Strands of a style, of which every thirtieth is a guide: grown once for all tests.
pub(crate) fn binding() -> Arc<Binding> {
    static GROWN: LazyLock<Arc<Binding>> = LazyLock::new(grown);
    GROWN.clone()
}

fn grown() -> Arc<Binding> {
    let groom = StyleSettings { strand_count: STRANDS, ..StyleSettings::new(Style::Long) }.grow().unwrap();
    let chosen: Vec<usize> = (0..groom.strand_count()).step_by(30).collect();
    let resample = |groom| Guides::resample(groom, POINTS).unwrap();
    Binding::new(&groom, &chosen, resample(&groom), resample(&groom.select(&chosen))).unwrap().into()
}

pub(crate) fn pose() -> Pose {
    Pose { rotation: Quat::from_rotation_y(0.5), translation: Vec3::new(0.3, -0.1, 0.2) }
}

/// The guides where the head is, blown aside the more the lower they hang; every fifth is cut to half.
fn blown(guides: &Guides) -> Vec<Vec3Lanes> {
    let mut places = guides.positions().to_vec();
    for (index, lanes) in places.iter_mut().enumerate() {
        for lane in 0..LANES {
            let strand = (index / POINTS * LANES + lane).min(guides.strand_count() - 1);
            let (root, here) = (guides.position(strand, 0), lanes.get(lane));
            let here = if strand.is_multiple_of(5) { root.lerp(here, 0.5) } else { here };
            let drop = (root.y - here.y).max(0.0);
            lanes.set(lane, pose().point(here + Vec3::new(2.0 * drop * drop, 0.3 * drop, -0.5 * drop)));
        }
    }
    places
}

/// A head that is sampled, a ball in it and a bar beside it that stays where it is.
fn solids() -> Solids {
    let grid = DistanceGrid::from_field(&*Mannequin::new(), 0.006, 0.02).unwrap();
    let head = Collider::new(Shape::Grid(grid.into()), Carrier::HEAD, 0.3).unwrap();
    let ball = Shape::Sphere { center: Vec3::new(0.0, -0.1, 0.05), radius: 0.1 };
    let bar =
        Shape::Capsule { start: Vec3::new(0.1, -0.3, 0.1), end: Vec3::new(0.7, -0.3, 0.2), radius: 0.06 };
    let others = [(ball, Carrier::HEAD), (bar, Carrier::World)]
        .map(|(shape, carrier)| (Collider::new(shape, carrier, 0.3).unwrap(), 0.0));
    Solids::new([(head, 0.0015)].into_iter().chain(others))
}

fn on_cpu(binding: &Binding, solids: &Solids) -> Vec<Vec3Lanes> {
    let placed = solids.placed(pose());
    let surface = |point: Vec3| placed.at(point);
    let surface = Surface::of(&surface);
    let surface = (!placed.is_empty()).then_some(&surface);
    let (mut frames, mut places) = (Frames::default(), Vec::new());
    binding.follow(&blown(binding.guides()), &pose().into(), &mut frames);
    binding.place(LaneSet::ALL, &frames, &pose().into(), surface, &mut places);
    places
}

pub(crate) fn look() -> Look {
    Look { follow_strands: 3, ..Look::thesis() }
}

/// Strands and the points drawn of them; `None` without a GPU.
fn on_gpu(binding: &Arc<Binding>, solids: &Solids, body: &BodyFrame) -> Option<(Vec<Vec3Lanes>, Vec<Vec3>)> {
    let settings = PictureSettings::sized(32, 32);
    let mut renderer = GpuRenderer::new(&gpu()?, binding.strands(), None, &settings).unwrap();
    renderer.bind(binding, solids, None).unwrap();
    let look = look();
    let input = FrameInput {
        positions: &blown(binding.guides()),
        body,
        camera: &Camera::front(),
        look: &look,
        body_look: &BodyLook::default(),
        lights: &[Light::default()],
        level_of_detail: &LevelOfDetail::full(),
    };
    let (_, report) = renderer.draw(&input).unwrap();
    assert_eq!(report.strands, 3 * binding.strands().strand_count());
    Some((renderer.places().unwrap(), renderer.strands().unwrap().positions))
}

fn apart(one: &[Vec3Lanes], two: &[Vec3Lanes], strands: usize) -> Vec<f32> {
    let points = (0..strands).flat_map(|strand| (0..POINTS).map(move |point| (strand, point)));
    let mut apart: Vec<f32> = points
        .map(|(strand, point)| {
            let at = |all: &[Vec3Lanes]| all[strand / LANES * POINTS + point].get(strand % LANES);
            at(one).distance(at(two))
        })
        .collect();
    apart.sort_by(f32::total_cmp);
    apart
}

#[test]
fn bind_places_strands_where_the_cpu_has_them() {
    let binding = binding();
    let Some((on_gpu, _)) = on_gpu(&binding, &Solids::default(), &pose().into()) else { return };
    let on_cpu = on_cpu(&binding, &Solids::default());
    let strands = binding.strands().strand_count();
    let apart_most = *apart(&on_cpu, &on_gpu, strands).last().unwrap();
    // Rotations that are carried along twelve points, as quaternions and as matrices, on strands of 0.4 m.
    assert!(apart_most < 1e-5, "{apart_most} m");
    let (mut frames, mut still) = (Frames::default(), Vec::new());
    binding.follow(binding.guides().positions(), &BodyFrame::REST, &mut frames);
    binding.place(LaneSet::ALL, &frames, &BodyFrame::REST, None, &mut still);
    assert!(apart(&on_cpu, &still, strands)[strands * POINTS / 2] > 0.05, "the comparison can fail");
}

#[test]
fn bind_keeps_strands_out_of_solids_as_on_the_cpu() {
    let (binding, solids) = (binding(), solids());
    let Some((on_gpu, _)) = on_gpu(&binding, &solids, &pose().into()) else { return };
    let on_cpu = on_cpu(&binding, &solids);
    let strands = binding.strands().strand_count();
    let found = apart(&on_cpu, &on_gpu, strands);
    // A few strands that touch a surface take another path after a rounding error.
    let [most, last] = [found.len() * 98 / 100, found.len() - 1].map(|place| found[place]);
    println!("98 of 100 within {most:e} m, all within {last:e} m");
    assert!(most < 1e-4, "{most} m");
    let deep = |places: &[Vec3Lanes]| {
        let points = (0..strands).flat_map(|strand| (1..POINTS).map(move |point| (strand, point)));
        points
            .filter(|(strand, point)| {
                let place = places[strand / LANES * POINTS + point].get(strand % LANES);
                solids.placed(pose()).at(place).0 < -1e-4
            })
            .count()
    };
    let (free, both) = (deep(&self::on_cpu(&binding, &Solids::default())), [deep(&on_cpu), deep(&on_gpu)]);
    println!("inside: {free} of {} without a look at solids, {both:?} with", strands * (POINTS - 1));
    assert!(free > 300, "the comparison can fail: {free}");
    // Points whose segment cannot reach out; as many on both, but for rounding.
    assert!(both[1] <= both[0] + 5 && both[0] < free / 20, "{both:?}");
}

/// Compares what is drawn between the points of strands on a GPU with the same on the CPU, which both keep out of solids.
fn compare_drawn(solids: &Solids, body: &BodyFrame, is_deep: impl Fn(Vec3) -> bool) {
    let binding = binding();
    let Some((places, on_gpu)) = on_gpu(&binding, solids, body) else { return };
    let (strands, placed) = (binding.strands(), solids.placed(body.clone()));
    let level = LevelOfDetail::full().level(1.0, 3);
    let (mut curves, mut drawn) = (Curves::default(), Strands::default());
    let first = level.segments_per_span as usize;
    let deep = |all: &[Vec3], each: usize| {
        let inside = |point: &&Vec3| is_deep(**point);
        all.chunks(each).map(|strand| strand[first..].iter().filter(inside).count()).sum::<usize>()
    };
    tessellate(&places, strands, &pose(), &level, &mut curves);
    interpolate(&curves, strands, &pose(), &look(), &level, &mut drawn);
    let (free, each) = (drawn.positions.clone(), curves.points_per_curve);
    keep_outside(&mut drawn, &curves, strands.points_per_strand(), &placed);
    let kept = drawn.positions;
    let mut apart: Vec<f32> = kept.iter().zip(&on_gpu).map(|(one, two)| one.distance(*two)).collect();
    apart.sort_by(f32::total_cmp);
    let most = apart[apart.len() * 999 / 1000];
    let inside = [&free, &kept, &on_gpu].map(|all| deep(all, each));
    // Between two surfaces at the same distance, rounding decides on which one a point comes out.
    assert!(kept.len() == on_gpu.len() && most < 1e-5, "{most} m");
    assert!(inside[0] > 200 && inside[1..].iter().all(|deep| 20 * deep < inside[0]), "{inside:?}");
}

#[test]
fn what_is_drawn_between_their_points_stays_out_as_on_the_cpu() {
    let (solids, body) = (solids(), pose().into());
    let placed = solids.placed(pose());
    compare_drawn(&solids, &body, |point| placed.at(point).0 < -1e-4);
}

/// A coarse bust whose shoulders rise, by its triangles.
#[test]
fn what_is_drawn_stays_out_of_a_skin_that_moves_as_on_the_cpu() {
    let mesh = Mannequin::new().coarse_mesh(1.5);
    let grid = DistanceGrid::of_mesh(&mesh, 0.006, 0.02).unwrap();
    let skin = Shape::Skin(SkinSolid::new(&mesh, grid.into()).unwrap().into());
    let solids = Solids::new([(Collider::new(skin, Carrier::HEAD, 0.3).unwrap(), 0.0015)]);
    let rises =
        |place: &Vec3| (place.x.abs() - 0.05).clamp(0.0, 0.1) * (-0.1 - place.y).clamp(0.0, 0.1) * 6.0;
    let raised: Vec<Vec3> = mesh.positions.iter().map(|place| *place + Vec3::Y * rises(place)).collect();
    let body = BodyFrame::from(pose()).with_skin(raised.clone());
    let depths = Depths::new(&mesh, raised.iter().map(|place| pose().point(*place)).collect());
    compare_drawn(&solids, &body, |point| depths.of(&[point])[0] > 1e-4);
}
