//! The neck of the built-in bust, which bends unless a scene says otherwise.

use strandline::{Pose, Prepared, Scene, scene::MotionName};

/// A scene of few strands.
fn few(mut scene: Scene) -> Prepared {
    scene.style.strand_count = 8;
    scene.groom.bound = Some(0);
    Prepared::new(&scene).unwrap()
}

#[test]
fn shoulders_stay_under_the_motions_of_the_built_in_bust() {
    for name in [MotionName::Shake, MotionName::Nod, MotionName::Turn, MotionName::Keyframes] {
        let mut scene = Scene::demo();
        scene.motion.name = name;
        assert!(scene.motion.bends(), "{name:?}");
        scene.motion.neck = Some(false);
        assert!(!scene.motion.bends(), "{name:?}");
    }
    for name in [MotionName::Still, MotionName::File] {
        let mut scene = Scene::demo();
        scene.motion.name = name;
        assert!(!scene.motion.bends(), "{name:?}: nothing turns, or the joint of a file may walk about");
    }
    let demo = few(Scene::demo());
    let (mesh, frame) = (demo.mesh.as_ref().unwrap(), demo.head.frame(0.3));
    let (head, rest) = (frame.world_from_head(), &mesh.positions);
    assert!(head != Pose::IDENTITY && frame.piece(1) == Pose::IDENTITY && demo.colliders.len() == 8);
    let moved = mesh.positions_in(&frame);
    let low = rest.iter().zip(moved.iter()).filter(|(rest, _)| rest.y < -0.24);
    let farthest = low.map(|(rest, moved)| head.point(*moved).distance(*rest)).fold(0.0, f32::max);
    assert!(farthest < 1e-6, "shoulders move by {farthest} m");
    let thesis = few(Scene::thesis());
    assert!(thesis.mesh.unwrap().neck.is_none() && thesis.colliders.len() == 1, "as printed");
}
