//! Hair in a loop of the host.

use glam::{Vec2, Vec3};
use strandline::{Backend, Change, FrameLoop, Look, Prepared, Ray, Scene};

fn opened() -> FrameLoop {
    let mut scene = Scene::demo();
    scene.style.strand_count = 48;
    // A hand holds guides: of so few none may lie near a drawn strand.
    scene.groom.bound = Some(0);
    (scene.picture.width, scene.picture.height) = (48, 60);
    // Scattered light costs as much for few strands as for many.
    scene.look.dress(strandline::look::Preset::Thesis);
    FrameLoop::open(Prepared::new(&scene).unwrap(), Backend::Cpu).unwrap()
}

/// A line of sight that meets hair.
fn ray(hair: &mut FrameLoop) -> Ray {
    let camera = *hair.camera();
    let points = hair.points().unwrap().to_vec();
    // Near the tips, which can be led away, and the nearest: no part of the body lies before it.
    let lowest = points.iter().map(|point| point.y).fold(f32::INFINITY, f32::min);
    let apart = |point: &Vec3| point.distance(camera.position);
    let low = points.iter().copied().filter(|point| point.y < lowest + 0.1);
    let near = low.min_by(|one, other| apart(one).total_cmp(&apart(other))).unwrap();
    let view = camera.view_from_world().transform_point3(near);
    Ray::new(&camera, Vec2::new(view.x, view.y) * camera.focal() / -view.z)
}

#[test]
fn a_hand_holds_hair_while_frames_pass_and_lets_it_go() {
    let (mut hair, mut free) = (opened(), opened());
    let ray = ray(&mut hair);
    hair.change(Change::Grab(ray, 0.02)).unwrap();
    assert!(hair.grabbed() > 0);
    let away = Ray { origin: ray.origin + Vec3::X * 0.1, ..ray };
    hair.change(Change::Drag(away)).unwrap();
    for _ in 0..6 {
        hair.frame().unwrap();
        free.frame().unwrap();
    }
    let farthest = |one: &mut FrameLoop, other: &mut FrameLoop| {
        let points = other.points().unwrap().to_vec();
        let pairs = one.points().unwrap().iter().zip(points).map(|(one, other)| one.distance(other));
        pairs.fold(0.0, f32::max)
    };
    assert!(farthest(&mut hair, &mut free) > 0.05);
    hair.change(Change::Release).unwrap();
    assert_eq!(hair.grabbed(), 0);
    hair.change(Change::Reset).unwrap();
    free.change(Change::Reset).unwrap();
    assert_eq!(farthest(&mut hair, &mut free), 0.0);
}

#[test]
fn a_coarse_picture_is_smaller_and_a_refused_change_leaves_all() {
    let mut hair = opened();
    let (full, _) = hair.picture(None).unwrap();
    let (coarse, _) = hair.picture(Some(9)).unwrap();
    assert!(coarse.width < full.width && !coarse.is_blank());
    let look = Look { tip_width: 2.0, ..hair.look().clone() };
    assert!(hair.change(Change::Look(look.into())).is_err());
    assert_eq!(hair.picture(None).unwrap().0, full);
}
