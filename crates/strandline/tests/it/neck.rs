//! The neck of the built-in bust, which bends where a scene says so.

use strandline::{Backend, Change, Event, FrameLoop, Pose, Prepared, Scene};

/// The demo with few strands and a neck.
fn few(neck: bool) -> Prepared {
    let mut scene = Scene::demo();
    scene.style.strand_count = 8;
    scene.groom.bound = Some(0);
    scene.motion.neck = neck;
    Prepared::new(&scene).unwrap()
}

#[test]
fn shoulders_stay_where_the_neck_bends() {
    let bent = few(true);
    let (mesh, frame) = (bent.mesh.as_ref().unwrap(), bent.head.frame(0.3));
    let (head, rest) = (frame.world_from_head(), &mesh.positions);
    assert!(head != Pose::IDENTITY && frame.piece(1) == Pose::IDENTITY && bent.colliders.len() == 8);
    let moved = mesh.positions_in(&frame);
    let low = rest.iter().zip(moved.iter()).filter(|(rest, _)| rest.y < -0.24);
    let farthest = low.map(|(rest, moved)| head.point(*moved).distance(*rest)).fold(0.0, f32::max);
    assert!(farthest < 1e-6, "shoulders move by {farthest} m");
    let stiff = few(false);
    assert!(stiff.mesh.unwrap().neck.is_none() && stiff.colliders.len() == 1);
}

#[test]
fn a_body_whose_neck_does_not_bend_is_told() {
    let told = |change: fn(&mut Scene)| {
        let mut scene = Scene::demo();
        scene.style.strand_count = 8;
        (scene.groom.bound, scene.motion.neck) = (Some(0), true);
        change(&mut scene);
        Prepared::new(&scene).unwrap().notes.iter().any(|note| note.contains("here the neck stays stiff"))
    };
    let exact = |scene: &mut Scene| scene.body.exact = true;
    let stiff = |scene: &mut Scene| (scene.body.exact, scene.motion.neck) = (true, false);
    assert_eq!([told(|_| {}), told(exact), told(stiff)], [false, true, false]);
}

#[test]
fn a_neck_that_stays_stiff_until_the_next_load_is_told() {
    let told = |loaded: bool, then: bool| {
        let prepared = few(loaded);
        let mut motion = prepared.scene.motion.clone();
        motion.neck = then;
        let mut hair = FrameLoop::open(prepared, Backend::Cpu).unwrap();
        hair.change(Change::Motion(motion.into())).unwrap();
        let notes = std::iter::from_fn(|| hair.next_event());
        notes
            .filter(|event| matches!(event, Event::Note(note) if note.contains("a neck that stays stiff")))
            .count()
    };
    assert_eq!([told(false, true), told(true, true), told(true, false)], [1, 0, 0]);
}
