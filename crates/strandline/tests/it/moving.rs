//! Bodies that move by themselves: clips, vertices in memory and files of vertices.
#![allow(clippy::disallowed_methods)] // compared values may be rounded

mod misplayed;
mod solids;
mod told;

use std::path::{Path, PathBuf};

use glam::{Quat, Vec3};
use strandline::{
    Backend, Event, Hair, Mesh, Picture, Player, Pose, Prepared, Scene, Sources, Style,
    low_level::body::BodyFrame,
    mesh::VertexMotion,
    scene::{BodyPart, MotionName, TeleportSection},
};

fn bust() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/bust.glb")
}

/// A few strands of a bob on the sample bust, which nothing but a clip moves.
fn scene(clip: &str) -> Scene {
    let mut scene = Scene::demo();
    scene.set_style(Style::Bob);
    (scene.style.strand_count, scene.body.spacing) = (40, 0.01);
    scene.groom.bound = Some(0);
    (scene.body.file, scene.body.clip) = (Some(bust()), Some(clip.to_owned()));
    scene.motion.name = MotionName::Still;
    (scene.devices.simulation, scene.devices.pictures) = (Backend::Cpu, Backend::Cpu);
    (scene.look.follow_strands, scene.look.hair_count, scene.look.width_scale) = (1, 0, 10.0);
    // Scattered light costs as much for few strands as for many.
    scene.look.dress(strandline::look::Preset::Thesis);
    (scene.picture.width, scene.picture.height) = (64, 48);
    (scene.film.frames, scene.film.settle) = (4, 0.0);
    scene
}

/// The skin in the world.
fn in_world(frame: &BodyFrame) -> Vec<Vec3> {
    let pose = frame.world_from_head();
    frame.skin().unwrap().iter().map(|place| pose.point(*place)).collect()
}

#[test]
fn the_head_carries_the_skin_of_a_clip() {
    let prepared = Prepared::new(&scene("look")).unwrap();
    let mesh = prepared.mesh.as_ref().unwrap();
    let (_, motion, _) = Mesh::load_moving(&bust(), "look").unwrap();
    let rest = prepared.head.frame(0.0);
    assert_eq!(rest.world_from_head(), Pose::IDENTITY);
    assert_eq!(rest.skin().unwrap()[..], mesh.positions[..], "the clip begins at rest, to the bit");
    for time in [0.2, 0.7, 1.0, 1.9, 9.0] {
        let frame = prepared.head.frame(time);
        let expected = motion.positions(time);
        for ((found, expected), rest) in in_world(&frame).iter().zip(&expected).zip(&mesh.positions) {
            assert!(found.distance(*expected) < 1e-5, "{found} {expected}");
            if rest.y < -0.25 {
                assert!(found.distance(*rest) < 1e-5, "the chest stays: {rest}");
            }
        }
        // The scalp stays in head space.
        let skin = frame.skin().unwrap();
        let scalp = mesh.positions.iter().zip(skin.iter()).filter(|(rest, _)| rest.y > 0.03);
        let worst = scalp.map(|(rest, now)| rest.distance(*now)).fold(0.0, f32::max);
        assert!(worst < 1e-5, "{worst}");
    }
    let turned = prepared.head.pose(1.0).direction(Vec3::Z);
    assert!(turned.x > 0.85, "the face looks over the left shoulder: {turned}");
}

#[test]
fn a_body_that_is_placed_moves_where_it_is_placed() {
    let mut placed = scene("nod");
    (placed.body.rotation, placed.body.translation) = (Vec3::new(0.0, 90.0, 0.0), Vec3::new(0.3, 0.0, 0.1));
    placed.body.scale = strandline::format::Scale::Factor(2.0);
    (placed.body.start, placed.body.speed, placed.body.r#loop) = (0.5, 2.0, true);
    let prepared = Prepared::new(&placed).unwrap();
    let (_, motion, _) = Mesh::load_moving(&bust(), "nod").unwrap();
    let turn = Quat::from_rotation_y(90.0_f32.to_radians());
    // The clip of 2 s goes round after 0.75 s of the scene.
    for (time, of_clip) in [(0.0, 0.5), (0.25, 1.0), (1.0, 0.5)] {
        let expected = motion.positions(of_clip);
        for (found, expected) in in_world(&prepared.head.frame(time)).iter().zip(expected) {
            let expected = turn * (2.0 * expected) + placed.body.translation;
            assert!(found.distance(expected) < 1e-5, "{found} {expected} at {time}");
        }
    }
}

#[test]
fn the_motion_of_the_head_carries_a_body_that_moves() {
    let mut turning = scene("smile");
    turning.motion.name = MotionName::Turn;
    let (turns, smiles) = (Prepared::new(&turning).unwrap(), Prepared::new(&scene("smile")).unwrap());
    let (both, alone) = (turns.head.frame(0.8), smiles.head.frame(0.8));
    assert_eq!(alone.world_from_head(), Pose::IDENTITY, "a smile does not move the scalp");
    assert_eq!(both.skin(), alone.skin());
    assert!(both.world_from_head().direction(Vec3::Z).x > 0.8);
    let rest = smiles.mesh.unwrap().positions;
    let corner = rest
        .iter()
        .zip(alone.skin().unwrap().iter())
        .map(|(rest, now)| rest.distance(*now))
        .fold(0.0, f32::max);
    assert!((0.005..0.015).contains(&corner), "the corners of the mouth: {corner} m");
}

fn last_picture(scene: &Scene) -> Picture {
    let player = Player::new(scene, scene.devices, true).unwrap();
    let pictures = player.filter_map(|event| match event.unwrap() {
        Event::Drawn { picture, .. } => Some(picture),
        _ => None,
    });
    pictures.last().unwrap()
}

#[test]
fn a_film_shows_the_clip() {
    let mut rests = scene("shrug");
    rests.film.frames_per_second = 8.0;
    let shrugs = last_picture(&rests);
    rests.body.clip = None;
    let still = last_picture(&rests);
    let changed =
        shrugs.pixels.iter().zip(&still.pixels).filter(|(one, other)| one.abs_diff(**other) > 8).count();
    assert!(changed > 60, "{changed} values of the picture changed");
}

#[test]
fn an_unknown_clip_is_refused_with_those_that_there_are() {
    let error = Prepared::new(&scene("walk")).err().unwrap().to_string();
    assert!(error.contains("glb: `nod`, `look`, `shrug`, `smile`"), "{error}");
    let mut bare = scene("nod");
    bare.body.file = None;
    let error = bare.check().unwrap_err().to_string();
    assert!(error.contains("body.clip is a clip of a body without a file"), "{error}");
    let mut twice = scene("nod");
    twice.body.vertices = Some("nod.npz".into());
    let error = twice.check().unwrap_err().to_string();
    assert!(error.contains("body.clip is a second motion") && error.contains("`body.vertices`"), "{error}");
    let mut frames = twice.clone();
    (frames.body.clip, frames.body.file) = (None, Some("walk%04d.obj".into()));
    let error = Prepared::new(&frames).err().unwrap().to_string();
    assert!(error.contains("body.vertices is a second motion") && error.contains("`body.file`"), "{error}");
}

#[test]
fn hair_on_a_moving_skin_stays_on_its_gpu_and_moves_as_on_the_cpu() {
    let played = |backend: Backend| {
        let mut moving = scene("shrug");
        moving.devices.simulation = backend;
        let mut hair = Hair::open(&moving)?;
        // A software adapter takes a second of processors for a step.
        for frame in 0..8 {
            hair.play(frame)?;
        }
        let points = hair.points()?.to_vec();
        Ok::<_, strandline::Error>((points, hair.take_notes().join("\n")))
    };
    let (expected, _) = played(Backend::Cpu).unwrap();
    let (points, notes) = match played(Backend::Gpu(None)) {
        Ok(played) => played,
        Err(error) => {
            assert!(std::env::var_os("STRANDLINE_REQUIRE_GPU").is_none(), "{error}");
            #[allow(clippy::print_stderr)] // it tells what is not tested
            return eprintln!("not tested on a GPU: {error}");
        }
    };
    assert!(!notes.contains("on the CPU") || notes.contains("for tests"), "{notes}");
    let apart: Vec<f32> = points.iter().zip(&expected).map(|(one, other)| one.distance(*other)).collect();
    // Planes of the CPU ride the skin between looks, those of a GPU are looked up anew. A strand that begins 3 cm above an
    // ear falls behind it on the CPU and over it on a software adapter, 3 cm away at its end.
    let strands = 40;
    let mut farthest: Vec<f32> = apart
        .chunks_exact(apart.len() / strands)
        .map(|points| points.iter().copied().fold(0.0, f32::max))
        .collect();
    farthest.sort_by(f32::total_cmp);
    let [middle, last_but_one] = [farthest[strands / 2], farthest[strands - 2]];
    assert!(middle < 2e-4 && last_but_one < 2e-3, "{farthest:?}");
}

#[test]
fn a_motion_in_memory_moves_a_mesh_in_memory() {
    let mesh = Mesh::load(&bust(), 1.0).unwrap();
    let mut memory = scene("nod");
    (memory.body.file, memory.body.clip) = (Some("bust".into()), None);
    let raised: Vec<Vec3> = mesh.positions.iter().map(|place| *place + Vec3::Y * 0.5).collect();
    let motion = VertexMotion::sampled(vec![0.0, 1.0], vec![mesh.positions.clone(), raised]).unwrap();
    let sources = Sources::default().with_mesh("bust", mesh.clone()).with_motion("bust", motion.clone());
    let prepared = Prepared::from_sources(&memory, &sources).unwrap();
    let frame = prepared.head.frame(0.5);
    assert!(frame.world_from_head().translation.distance(Vec3::Y * 0.25) < 1e-5, "{frame:?}");
    let other = sources.with_motion("bost", motion);
    let error = Prepared::from_sources(&memory, &other).err().unwrap().to_string();
    assert!(error.contains("`bost`"), "{error}");
    memory.body.clip = Some("nod".into());
    let error = Prepared::from_sources(&memory, &Sources::default().with_mesh("bust", mesh)).err().unwrap();
    assert!(error.to_string().contains("a clip of a body in memory"), "{error}");
}

/// A body that moves by 0.3 m in a tenth of a second, slower than any jump by itself.
#[test]
fn a_marked_jump_carries_hair_and_is_reported() {
    let mesh = Mesh::load(&bust(), 1.0).unwrap();
    let beside = mesh.positions.iter().map(|place| *place + Vec3::X * 0.3).collect();
    let motion = VertexMotion::sampled(vec![0.1, 0.2], vec![mesh.positions.clone(), beside]).unwrap();
    let sources = Sources::default().with_mesh("bust", mesh).with_motion("bust", motion);
    let played = |marks: &[f64]| {
        let mut memory = scene("nod");
        (memory.body.file, memory.body.clip) = (Some("bust".into()), None);
        memory.body.teleports = marks.iter().map(|time| TeleportSection { time: *time }).collect();
        let mut hair = Hair::from_sources(&memory, &sources).unwrap();
        let mut fastest = 0.0_f32;
        for frame in 0..12 {
            let reports = hair.play(frame).unwrap();
            fastest = reports.iter().map(|report| report.speed_max).fold(fastest, f32::max);
        }
        (fastest, hair.take_notes().join("\n"))
    };
    let (carried, notes) = played(&[0.2]);
    assert!(notes.contains("jumps by 0.30 m and 0 degrees, as marked: hair is carried with it"), "{notes}");
    let (pulled, notes) = played(&[]);
    assert!(!notes.contains("jumps"), "{notes}");
    assert!(carried < 0.5 && pulled > 2.0, "carried at {carried} m/s, pulled at {pulled} m/s");
}

/// Writes a mesh as an .obj file, raised \[m\].
fn write_obj(path: &Path, mesh: &Mesh, raised: f32) {
    use std::fmt::Write;
    let mut text = String::new();
    for place in &mesh.positions {
        writeln!(text, "v {} {} {}", place.x, place.y + raised, place.z).unwrap();
    }
    for [a, b, c] in mesh.triangles.iter().map(|corners| corners.map(|corner| corner + 1)) {
        writeln!(text, "f {a} {b} {c}").unwrap();
    }
    std::fs::write(path, text).unwrap();
}

#[test]
fn files_of_a_walk_move_the_body_and_its_further_meshes_ride_the_head() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = Mesh::load(&bust(), 1.0).unwrap();
    for frame in 0..3 {
        write_obj(&folder.path().join(format!("walk{frame:04}.obj")), &mesh, 0.1 * frame as f32);
    }
    let mut walks = scene("nod");
    (walks.body.clip, walks.body.file) = (None, Some(folder.path().join("walk%04d.obj")));
    walks.body.frames_per_second = 4.0;
    walks.body.scale = strandline::format::Scale::Factor(1.0);
    let collar = BodyPart { file: bust(), ..BodyPart::default() };
    walks.body.parts = vec![collar];
    let prepared = Prepared::new(&walks).unwrap();
    let rest = &prepared.mesh.as_ref().unwrap().positions;
    assert_eq!(rest.len(), 2 * mesh.positions.len());
    for (time, raised) in [(0.0, 0.0), (0.25, 0.1), (0.375, 0.15), (9.0, 0.2)] {
        let frame = prepared.head.frame(time);
        assert!(frame.check(None, Some(rest.len())).is_ok());
        for (found, rest) in in_world(&frame).iter().zip(rest) {
            assert!(found.distance(*rest + Vec3::Y * raised) < 1e-5, "{found} {rest} at {time}");
        }
    }
}

#[test]
fn the_head_follows_a_joint_of_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("turn.bvh");
    let text = "HIERARCHY ROOT Head { OFFSET 0 0 0 CHANNELS 3 Yrotation Xrotation Zrotation } MOTION Frames: 2 \
                Frame Time: 0.5 10 0 0 50 0 0";
    std::fs::write(&path, text).unwrap();
    let mut turns = scene("nod");
    (turns.body.clip, turns.body.file, turns.motion.name) = (None, None, MotionName::File);
    let error = turns.check().unwrap_err().to_string();
    assert!(error.contains("motion.file"), "{error}");
    turns.motion.file = Some(path);
    let head = Prepared::new(&turns).unwrap().head;
    for (time, degrees) in [(-1.0, 0.0_f32), (0.25, 20.0), (3.0, 40.0)] {
        let pose = head.pose(time);
        assert!(pose.point(head.pivot()).distance(head.pivot()) < 1e-6);
        let face = pose.direction(Vec3::Z);
        assert!((face.x.atan2(face.z).to_degrees() - degrees).abs() < 1e-3, "{face} at {time}");
    }
    (turns.motion.start, turns.motion.speed, turns.motion.r#loop) = (0.2, -0.5, true);
    let Prepared { head, notes, .. } = Prepared::new(&turns).unwrap();
    for (time, degrees) in [(0.0, 16.0_f32), (0.2, 8.0), (0.6, 32.0), (1.3, 4.0), (1.5, 36.0)] {
        let face = head.pose(time).direction(Vec3::Z);
        assert!((face.x.atan2(face.z).to_degrees() - degrees).abs() < 1e-2, "{face} at {time}");
    }
    let notes = notes.join("\n");
    assert!(notes.contains("motion.loop: the motion ends 6.8 cm from where it begins"), "{notes}");
    turns.motion.joint = "Hips".to_owned();
    let error = Prepared::new(&turns).err().unwrap().to_string();
    assert!(error.contains("no joint `Hips` among `Head`"), "{error}");
}

/// The sample bust again as a part of the body, with a clip of its own.
fn twin(clip: &str) -> BodyPart {
    BodyPart { file: bust(), clip: Some(clip.to_owned()), solid: Some(false), ..BodyPart::default() }
}

#[test]
fn a_part_plays_its_own_clip_beside_the_body() {
    let mut both = scene("nod");
    both.body.parts = vec![BodyPart { start: 0.25, speed: 2.0, r#loop: true, ..twin("shrug") }];
    let prepared = Prepared::new(&both).unwrap();
    let clips = ["nod", "shrug"].map(|clip| Mesh::load_moving(&bust(), clip).unwrap().1);
    let (count, end) = (clips[0].vertex_count(), clips[1].end());
    for time in [0.0, 0.3, 0.9, 1.7] {
        let frame = prepared.head.frame(time);
        let world = in_world(&frame);
        assert_eq!(world.len(), 2 * count);
        let own = clips[1].positions((0.25 + 2.0 * time).rem_euclid(end));
        for (found, expected) in world.iter().zip(clips[0].positions(time).iter().chain(&own)) {
            assert!(found.distance(*expected) < 1e-5, "{found} {expected} at {time}");
        }
    }
    // A body at rest beside a part that moves.
    both.body.clip = None;
    let prepared = Prepared::new(&both).unwrap();
    let frame = prepared.head.frame(0.4);
    assert_eq!(frame.world_from_head(), Pose::IDENTITY);
    let rest = &prepared.mesh.as_ref().unwrap().positions;
    let moved = |range: std::ops::Range<usize>| {
        range.map(|vertex| frame.skin().unwrap()[vertex].distance(rest[vertex])).fold(0.0, f32::max)
    };
    assert_eq!(moved(0..count), 0.0);
    assert!(moved(count..2 * count) > 0.01);
}

#[test]
fn clips_of_parts_that_cannot_be_played_are_refused_or_told() {
    let mut wrong = scene("nod");
    wrong.body.parts = vec![twin("walk")];
    let error = Prepared::new(&wrong).err().unwrap().to_string();
    assert!(error.contains("body.parts[0].clip is `walk`, expected a clip of "), "{error}");
    wrong.body.parts = vec![BodyPart { visible: false, ..twin("shrug") }];
    let notes = Prepared::new(&wrong).unwrap().notes.join("\n");
    assert!(notes.contains("the clip `shrug` is not played: the part is not drawn"), "{notes}");
    let teleports = vec![TeleportSection { time: 0.5 }];
    wrong.body.parts = vec![BodyPart { clip: None, teleports, ..twin("shrug") }];
    let error = wrong.check().unwrap_err().to_string();
    assert!(error.contains("body.parts[0].teleports is marks of a part that does not move"), "{error}");
}

#[test]
fn hair_is_carried_over_marks_of_a_part_and_of_a_joint() {
    let teleports = vec![TeleportSection { time: 0.5 }];
    let mut part = scene("nod");
    part.body.parts = vec![BodyPart { teleports: teleports.clone(), ..twin("shrug") }];
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("turn.bvh");
    let text = "HIERARCHY ROOT Head { OFFSET 0 0 0 CHANNELS 3 Yrotation Xrotation Zrotation } MOTION Frames: 2 \
                Frame Time: 1.0 0 0 0 20 0 0";
    std::fs::write(&path, text).unwrap();
    let mut joint = scene("nod");
    (joint.body.clip, joint.body.file, joint.motion.name) = (None, None, MotionName::File);
    joint.motion.teleports = teleports;
    let error = joint.check().unwrap_err().to_string();
    assert!(error.contains("motion.name") || error.contains("motion.teleports"), "{error}");
    joint.motion.file = Some(path);
    for marked in [part, joint] {
        let head = Prepared::new(&marked).unwrap().head;
        assert!(!head.frame(0.3).jumps_to(&head.frame(0.49)));
        assert!(head.frame(0.49).jumps_to(&head.frame(0.5)));
        let mut hair = Hair::open(&marked).unwrap();
        let mut notes = Vec::new();
        for frame in 0..40 {
            hair.play(frame).unwrap();
            notes.extend(hair.take_notes());
        }
        let jumps = notes.iter().filter(|note| note.contains("as marked: hair is carried")).count();
        assert_eq!(jumps, 1, "{notes:?}");
    }
}

#[test]
fn a_word_of_the_language_is_a_key_like_others() {
    let mut scene = Scene::demo();
    scene.set("body.loop", "true").unwrap();
    assert!(scene.body.r#loop && scene.to_toml().contains("\nloop = true"));
    assert!(Scene::parse("[body]\nloop = true\nspeed = 0.5", "here").unwrap().body.r#loop);
    assert!(scene.explain("body.loop").unwrap().starts_with("body.loop: Begins the motion again"));
}
