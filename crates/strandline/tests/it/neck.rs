//! The neck of the built-in bust, which bends where a scene says so.

use strandline::{
    Backend, Change, Event, FrameLoop, Pose, Prepared, Scene,
    scene::{ColliderSection, Interpolation, KeyframeSection, MotionName, MotionSection, SphereSection},
};

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

/// The notes of a running loop that is given another motion, twice: they are told once.
fn told_live(prepared: Prepared, change: impl FnOnce(&mut MotionSection)) -> Vec<String> {
    let mut motion = prepared.scene.motion.clone();
    change(&mut motion);
    let mut hair = FrameLoop::open(prepared, Backend::Cpu).unwrap();
    for _ in 0..2 {
        hair.change(Change::Motion(motion.clone().into())).unwrap();
    }
    let notes = std::iter::from_fn(|| hair.next_event()).filter_map(|event| match event {
        Event::Note(note) => Some(note),
        _ => None,
    });
    let of_motion = ["stays stiff", "motion.loop", "motion.interpolation"];
    notes.filter(|note| of_motion.iter().any(|words| note.contains(words))).collect()
}

#[test]
fn a_neck_that_stays_stiff_until_the_next_load_is_told() {
    let told = |loaded: bool, then: bool| told_live(few(loaded), |motion| motion.neck = then);
    let stiff = told(false, true);
    assert!(stiff.len() == 1 && stiff[0].contains("with a neck that stays stiff"), "{stiff:?}");
    assert!(told(true, true).is_empty() && told(true, false).is_empty());
    // A body whose neck never bends has the note of the load.
    let mut scene = few(false).scene;
    scene.body.exact = true;
    let never = told_live(Prepared::new(&scene).unwrap(), |motion| motion.neck = true);
    assert!(
        never.len() == 1 && never[0].starts_with("motion.neck bends the built-in bust alone"),
        "{never:?}"
    );
}

#[test]
fn a_loop_that_is_opened_while_hair_moves_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("turn.bvh");
    let text = "HIERARCHY ROOT Head { OFFSET 0 0 0 CHANNELS 3 Yrotation Xrotation Zrotation } MOTION Frames: 2 Frame Time: \
                0.5 0 0 0 20 0 0";
    std::fs::write(&path, text).unwrap();
    let mut scene = few(false).scene;
    (scene.motion.name, scene.motion.file) = (MotionName::File, Some(path));
    let prepared = Prepared::new(&scene).unwrap();
    let told = told_live(prepared, |motion| motion.r#loop = true);
    // 20 degrees of a head of 10 cm.
    assert!(told.len() == 1 && told[0].starts_with("motion.loop: the motion ends 3.5 cm"), "{told:?}");
    scene.motion.r#loop = true;
    let known = told_live(Prepared::new(&scene).unwrap(), |motion| motion.rotation.y = 5.0);
    assert!(known.is_empty(), "the load has told it: {known:?}");
}

#[test]
fn a_motion_that_needs_a_load_is_refused_or_told_while_hair_moves() {
    let mut prepared = few(false);
    let file = MotionSection { name: MotionName::File, ..prepared.scene.motion.clone() };
    let keyframes = vec![KeyframeSection::default()];
    prepared.scene.colliders =
        vec![ColliderSection::Sphere(SphereSection { keyframes, ..SphereSection::default() })];
    let mut hair = FrameLoop::open(few(false), Backend::Cpu).unwrap();
    let error = hair.change(Change::Motion(file.into())).unwrap_err().to_string();
    assert!(error.contains("motion.name is \"file\" without one, expected `motion.file` too"), "{error}");
    let told = told_live(prepared, |motion| motion.interpolation = Interpolation::Linear);
    assert!(told.len() == 1 && told[0].contains("solids go from key to key as before"), "{told:?}");
}
