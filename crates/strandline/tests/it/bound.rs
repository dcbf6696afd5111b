//! Strands that are bound to simulated ones, from a scene to a picture.
#![allow(clippy::disallowed_methods)] // compared values may be rounded

use strandline::{
    Backend, Cache, Devices, Event, Groom, OutSettings, Picture, Player, Prepared, Scene, What,
    format::{Attribute, Scale},
    look::Preset,
    scene::{BodyPart, GroomPart, MotionName},
};

/// A style of 900 strands of which 90 are simulated, drawn small.
fn scene() -> Scene {
    let mut scene = Scene::demo();
    (scene.style.strand_count, scene.groom.bound) = (90, Some(900));
    scene.body.spacing = 0.01;
    scene.simulation.volume.cells = [12; 3];
    scene.motion.name = MotionName::Shake;
    (scene.film.frames, scene.film.settle) = (3, 0.1);
    (scene.look.follow_strands, scene.look.hair_count, scene.look.width_scale) = (1, 0, 8.0);
    (scene.picture.width, scene.picture.height) = (96, 96);
    // Small pictures of all strands.
    scene.level_of_detail.by_pixel = false;
    // Light that is scattered many times takes a software adapter long.
    scene.look.dress(Preset::Thesis);
    scene
}

/// The last picture of a scene, and how many strands and guides it has.
fn last(scene: &Scene, pictures: Backend) -> (Picture, usize, usize) {
    let devices = Devices { simulation: Backend::Cpu, pictures };
    let mut player = Player::new(scene, devices, true).unwrap();
    let mut last = None;
    for event in player.by_ref() {
        if let Event::Drawn { picture, report, .. } = event.unwrap() {
            last = Some((picture, report.strands));
        }
    }
    let (picture, strands) = last.unwrap();
    (picture, strands, player.guides().strand_count())
}

fn difference(one: &Picture, other: &Picture) -> f64 {
    let sum: u64 =
        one.pixels.iter().zip(&other.pixels).map(|(one, other)| u64::from(one.abs_diff(*other))).sum();
    sum as f64 / one.pixels.len() as f64
}

#[test]
#[allow(clippy::print_stderr)] // it tells what is not tested
fn all_strands_of_a_style_are_drawn_alike_on_both_backends() {
    let (on_cpu, strands, guides) = last(&scene(), Backend::Cpu);
    assert_eq!(strands, 900);
    assert!((80..=90).contains(&guides), "{guides}");
    let mut few = scene();
    few.groom.bound = Some(0);
    let (without, strands, _) = last(&few, Backend::Cpu);
    assert_eq!(strands, 90);
    assert!(difference(&on_cpu, &without) > 2.0, "the comparison can fail");
    if let Err(error) = strandline::device::Gpu::any() {
        return eprintln!("not tested on a GPU: {error}");
    }
    let (on_gpu, strands, _) = last(&scene(), Backend::Gpu(Some(0)));
    assert_eq!(strands, 900);
    let off = difference(&on_cpu, &on_gpu);
    // Half floats, and the order of segments within a step of depth, on thick strands: found 0.63. Nine of ten
    // strands left out make more than 2.
    assert!(off < 1.0, "{off} of 255");
}

/// A lawn of 200 strands with colours, of which every fourth is marked as a guide.
fn lawn(path: &std::path::Path) {
    let mut groom = Groom::empty(1e-4);
    for strand in 0..200 {
        let root = glam::Vec3::new(0.01 * (strand % 20) as f32, 0.0, 0.01 * (strand / 20) as f32);
        groom.push((0..6).map(|point| root + glam::Vec3::Y * 0.02 * point as f32));
    }
    groom.colors = Some((0..1200).map(|point| [0.2, 0.1 + 0.0005 * point as f32, 0.3]).collect());
    groom.guide_flags = Some((0..200).map(|strand| strand % 4 == 0).collect());
    groom.save(path).unwrap();
}

#[test]
fn guides_are_those_that_a_file_marks_or_a_scene_asks_for() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lawn.npz");
    lawn(&path);
    let prepared = |change: fn(&mut Scene)| {
        let mut scene = Scene::default();
        scene.groom.file = Some(path.clone());
        scene.groom.scale = Scale::Factor(1.0);
        change(&mut scene);
        Prepared::new(&scene).unwrap()
    };
    let marked = prepared(|_| {});
    assert_eq!(marked.guides.strand_count(), 50);
    let bound = marked.bound.unwrap();
    assert_eq!(bound.strands().strand_count(), 200);
    assert!(bound.strands().colors().is_some(), "{}", Attribute::Colors.name());
    assert!(marked.notes.iter().any(|note| note.contains("50 strands are simulated (marked in the file)")));
    let asked = prepared(|scene| scene.groom.guides = Some(20));
    assert!((18..=20).contains(&asked.guides.strand_count()));
    let every = prepared(|scene| scene.groom.guide_every = 10);
    assert_eq!((every.guides.strand_count(), every.bound.unwrap().strands().strand_count()), (20, 200));
    let all = prepared(|scene| scene.groom.guides = Some(200));
    assert_eq!((all.guides.strand_count(), all.bound.is_none()), (200, true));
    let plain = prepared(|scene| scene.groom.own_look = false);
    assert!(plain.guides.colors().is_none());
}

/// A film of one frame of a lawn of which 50 of 200 strands are simulated, with groups and root coordinates.
fn film(path: &std::path::Path) -> Scene {
    lawn(path);
    let mut groom = Groom::load(path).unwrap();
    groom.groups = Some((0..200).map(|strand| strand / 100).collect());
    groom.group_names = [(1, "back".to_owned())].into();
    groom.root_uvs = Some((0..200).map(|strand| glam::Vec2::new(0.005 * strand as f32, 0.5)).collect());
    groom.save(path).unwrap();
    let mut scene = Scene::default();
    scene.groom.file = Some(path.to_owned());
    scene.groom.scale = Scale::Factor(1.0);
    (scene.film.frames, scene.film.settle) = (1, 0.0);
    scene.motion.name = MotionName::Still;
    scene.look.follow_strands = 1;
    scene.devices = Backend::Cpu.into();
    scene
}

/// Writes a film as a cache; returns its path.
fn written(
    scene: &Scene,
    path: &std::path::Path,
    what: What,
) -> strandline::low_level::base::npz::Npz<std::fs::File> {
    let mut player = Player::new(scene, scene.devices, false).unwrap();
    player.set_out(&OutSettings { what, ..OutSettings::new(path) }).unwrap();
    player.by_ref().for_each(|event| drop(event.unwrap()));
    player.close_out().unwrap().unwrap();
    assert_eq!(Cache::open(path).unwrap().what(), what);
    strandline::low_level::base::npz::Npz::new(std::fs::File::open(path).unwrap()).unwrap()
}

#[test]
fn strands_that_guides_carry_leave_with_what_the_groom_says_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let scene = film(&folder.path().join("lawn.npz"));
    let rows = |npz: &mut strandline::low_level::base::npz::Npz<_>, name: &str| {
        npz.open(name).unwrap().map_or(0, |rows| rows.shape()[0])
    };
    let all = &mut written(&scene, &folder.path().join("all.npz"), What::Strands);
    let points = rows(all, "colors");
    assert_eq!([rows(all, "starts"), rows(all, "root_uv"), rows(all, "groups")], [201, 200, 200]);
    assert_eq!(rows(all, "widths"), points);
    assert_eq!(
        [rows(all, "guide_indices"), rows(all, "guide_flags"), rows(all, "bound_starts")],
        [200, 200, 0]
    );
    let guides = &mut written(&scene, &folder.path().join("guides.npz"), What::Guides);
    assert_eq!([rows(guides, "starts"), rows(guides, "root_uv"), rows(guides, "groups")], [51, 50, 50]);
    // Those that are carried: by which guides, and where they rest.
    assert_eq!([rows(guides, "guide_indices"), rows(guides, "bound_starts")], [150, 151]);
    assert_eq!(rows(guides, "colors"), rows(guides, "widths"));
    // Frames from one on.
    let mut longer = scene.clone();
    longer.film.frames = 5;
    let (path, whole) = (folder.path().join("late.npz"), folder.path().join("whole.npz"));
    let mut player = Player::new(&longer, longer.devices, false).unwrap();
    player.set_out(&OutSettings { first: 2, every: 2, ..OutSettings::new(&path) }).unwrap();
    player.by_ref().for_each(|event| drop(event.unwrap()));
    assert_eq!(player.close_out().unwrap().unwrap().frames, 2);
    let cache = Cache::open(&path).unwrap();
    assert_eq!((cache.first(), cache.every()), (2, 2));
    written(&longer, &whole, What::Guides);
    let whole = Cache::open(&whole).unwrap();
    assert!(whole.times().len() == 5 && whole.times().is_sorted_by(|one, next| one < next));
    assert_eq!(cache.times(), [whole.times()[2], whole.times()[4]]);
}

/// Asserts that a quarter of the strands, each the first of a clump, are guides, and that all follow guides alone.
fn follows(groom: &Groom, clump: usize) {
    let (flags, influences) = (groom.guide_flags.as_ref().unwrap(), groom.influences.as_ref().unwrap());
    let guides: Vec<usize> = (0..groom.strand_count()).filter(|strand| flags[*strand]).collect();
    assert_eq!((groom.strand_count(), guides.len()), (200 * clump, 50));
    assert!(guides.iter().all(|guide| guide % clump == 0));
    for strand in 0..groom.strand_count() {
        let of = |strand| influences.of(strand).filter(|(_, weight)| *weight > 0.0).collect::<Vec<_>>();
        let sum: f32 = of(strand).iter().map(|(_, weight)| weight).sum();
        assert!((sum - 1.0).abs() < 1e-6 && of(strand).iter().all(|(guide, _)| flags[*guide]), "{strand}");
        assert_eq!(of(strand), of(strand / clump * clump), "one clump follows the same");
        assert!(!flags[strand] || of(strand) == [(strand, 1.0)], "a guide follows itself: {strand}");
    }
}

#[test]
fn all_strands_leave_with_the_guides_that_they_follow() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = film(&folder.path().join("lawn.npz"));
    for clump in [1, 3] {
        scene.look.follow_strands = clump;
        let at = folder.path().join(format!("all{clump}.npz"));
        written(&scene, &at, What::Strands);
        let groom = Groom::load(&at).unwrap();
        follows(&groom, clump as usize);
        let files = folder.path().join(format!("{clump}.%d.ply"));
        let mut player = Player::new(&scene, scene.devices, false).unwrap();
        player.set_out(&OutSettings { what: What::Strands, ..OutSettings::new(&files) }).unwrap();
        player.by_ref().for_each(|event| drop(event.unwrap()));
        player.close_out().unwrap();
        let one = Groom::load(folder.path().join(format!("{clump}.0.ply"))).unwrap();
        assert_eq!((&one.guide_flags, &one.influences), (&groom.guide_flags, &groom.influences));
    }
    let at = folder.path().join("all.usda");
    let settings =
        OutSettings { what: What::Strands, target: strandline::Target::Unreal, ..OutSettings::new(&at) };
    let mut player = Player::new(&scene, scene.devices, false).unwrap();
    player.set_out(&settings).unwrap();
    player.by_ref().for_each(|event| drop(event.unwrap()));
    player.close_out().unwrap();
    let text = std::fs::read_to_string(&at).unwrap();
    let line = |name: &str| {
        let found =
            text.lines().find(|line| line.contains(name)).unwrap_or_else(|| panic!("{name} is missing"));
        found
            .split_once('[')
            .map(|(_, values)| values.split_once('[').map_or(values, |(_, values)| values).to_owned())
            .unwrap()
    };
    assert_eq!(line("groom_guide =").matches('1').count(), 50);
    assert_eq!(line("groom_closest_guides").matches("), (").count(), 599);
    assert_eq!(line("groom_guide_weights").matches("), (").count(), 599);
}

/// A square of 40 cm in the plane of the lawn, y up.
const GROUND: &str = "v -0.1 0 -0.1\nv 0.3 0 -0.1\nv 0.3 0 0.3\nv -0.1 0 0.3\nf 1 4 3 2\n";

#[test]
fn several_files_are_one_groom_and_one_body() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lawn.npz");
    lawn(&path);
    // The same strands in centimetres, unmarked, without colours.
    let mut weeds = Groom::load(&path).unwrap();
    (weeds.colors, weeds.guide_flags) = (None, None);
    weeds.transform(100.0, glam::Quat::IDENTITY, glam::Vec3::ZERO);
    weeds.save(folder.path().join("weeds.npz")).unwrap();
    let mut scene = Scene::default();
    for name in ["ground.obj", "stone.obj"] {
        std::fs::write(folder.path().join(name), GROUND).unwrap();
    }
    scene.folder = folder.path().to_owned();
    scene.groom.file = Some("lawn.npz".into());
    scene.groom.parts = vec![GroomPart { file: "weeds.npz".into(), ..GroomPart::default() }];
    scene.body.file = Some("ground.obj".into());
    let translation = glam::Vec3::Y;
    scene.body.parts = vec![BodyPart { file: "stone.obj".into(), translation, ..BodyPart::default() }];
    let prepared = Prepared::new(&scene).unwrap();
    let bound = prepared.bound.as_ref().unwrap();
    assert_eq!(bound.strands().strand_count(), 400);
    // A quarter of the second file stands for it, as of the first.
    assert!((90..=110).contains(&prepared.guides.strand_count()), "{}", prepared.guides.strand_count());
    assert_eq!(prepared.tags.group_names, ["lawn", "weeds"]);
    assert!(bound.strands().colors().is_some());
    assert!(
        prepared.notes.iter().any(|note| note.contains("weeds.npz: a unit is 0.01 m")),
        "{:?}",
        prepared.notes
    );
    let bounds = prepared.mesh.as_ref().unwrap().bounds().unwrap();
    assert_eq!((bounds.min.y, bounds.max.y), (0.0, 1.0));
    // Both lie in the same place.
    let apart = bound.strands().position(0, 0).distance(bound.strands().position(200, 0));
    assert!(apart < 1e-4, "{apart} m");
    let mut none = scene.clone();
    none.groom.file = None;
    assert!(Prepared::new(&none).err().unwrap().to_string().contains("groom.parts"));
}

#[test]
fn notes_on_several_files_begin_with_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lawn.npz");
    lawn(&path);
    let mut weeds = Groom::load(&path).unwrap();
    let of = |groom: &mut Groom, strand: usize, change: &dyn Fn(glam::Vec3) -> glam::Vec3| {
        let (range, root) = (groom.range(strand), groom.strand(strand)[0]);
        groom.points[range].iter_mut().for_each(|point| *point = root + change(*point - root));
    };
    of(&mut weeds, 7, &|way| 1e-4 * way);
    weeds.save(folder.path().join("weeds.npz")).unwrap();
    let mut lawn = Groom::load(&path).unwrap();
    of(&mut lawn, 11, &|way| -way);
    lawn.save(&path).unwrap();
    std::fs::write(folder.path().join("ground.obj"), GROUND).unwrap();
    let mut scene = Scene { folder: folder.path().to_owned(), ..Scene::default() };
    (scene.groom.file, scene.body.file) = (Some("lawn.npz".into()), Some("ground.obj".into()));
    let alone = Prepared::new(&scene).unwrap().notes;
    let against = "1 strand is led against all those beside, the first is 11: left as in the file";
    assert!(alone.iter().any(|note| note == against), "{alone:?}");
    scene.groom.parts = vec![GroomPart { file: "weeds.npz".into(), ..GroomPart::default() }];
    let both = Prepared::new(&scene).unwrap().notes;
    let has = |expected: &str| both.iter().any(|note| note == expected);
    assert!(has(&format!("lawn.npz: {against}")), "{both:?}");
    assert!(has("weeds.npz: 1 strand is shorter than 1 mm and than 2 % of the median: left out"), "{both:?}");
}

#[test]
fn files_of_one_groom_are_placed_together() {
    // A ball of 40 units on a plate, and hair in two files: a tuft in the nape, and the rest, combed to +z. Only both
    // together tell that it is a head, which looks along -z, and how large it is.
    let folder = tempfile::tempdir().unwrap();
    let (mut text, rings, steps) = (String::new(), 24_u32, 32_u32);
    let place = |polar: f32, around: f32| {
        glam::Vec3::new(polar.sin() * around.cos(), polar.cos(), polar.sin() * around.sin()) * 40.0
    };
    for ring in 0..=rings {
        for step in 0..steps {
            let angles = [
                std::f32::consts::PI * ring as f32 / rings as f32,
                std::f32::consts::TAU * step as f32 / steps as f32,
            ];
            let at = place(angles[0], angles[1]);
            text += &format!("v {} {} {}\n", at.x, at.y, at.z);
        }
    }
    for ring in 0..rings {
        for step in 0..steps {
            let corner = |ring: u32, step: u32| 1 + steps * ring + step % steps;
            let corners = [
                corner(ring, step),
                corner(ring, step + 1),
                corner(ring + 1, step + 1),
                corner(ring + 1, step),
            ];
            text += &format!("f {} {} {} {}\n", corners[0], corners[1], corners[2], corners[3]);
        }
    }
    text += "v -40 -60 -40\nv 40 -60 -40\nv 40 -60 40\nv -40 -60 40\nf -4 -1 -2 -3\n";
    std::fs::write(folder.path().join("head.obj"), text).unwrap();
    let [mut nape, mut rest] = [Groom::empty(8e-5), Groom::empty(8e-5)];
    for strand in 0..600 {
        let (polar, around) = (1.4 * ((strand as f32 + 0.5) / 600.0).sqrt(), 2.4 * strand as f32);
        let root = place(polar, around);
        let hair =
            (0..8).map(|point| root * (1.0 + 0.01 * point as f32) + glam::Vec3::Z * 3.0 * point as f32);
        if polar > 1.2 && root.z > 20.0 { nape.push(hair) } else { rest.push(hair) }
    }
    nape.save(folder.path().join("nape.npz")).unwrap();
    rest.save(folder.path().join("rest.npz")).unwrap();
    let mut scene = Scene { folder: folder.path().to_owned(), ..Scene::default() };
    scene.groom.file = Some("nape.npz".into());
    scene.groom.parts = vec![GroomPart { file: "rest.npz".into(), ..GroomPart::default() }];
    scene.body.file = Some("head.obj".into());
    let notes = Prepared::new(&scene).unwrap().notes;
    let said = |words: &str| notes.iter().any(|note| note.contains(words));
    assert!(said("turned by 180 degrees") && said("a unit of the groom is 0.00254 m"), "{notes:?}");
    assert!(said("nape.npz on head.obj: taken from the files"), "{notes:?}");
}

#[test]
fn a_style_grows_on_the_head_of_a_body() {
    let grooms = std::env::var_os("STRANDLINE_GROOMS").map_or_else(
        || std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/grooms"),
        Into::into,
    );
    let bust = grooms.join("bust/hm08_bust_female.obj");
    if !bust.is_file() {
        assert!(std::env::var_os("STRANDLINE_REQUIRE_GROOMS").is_none(), "no grooms folder");
        return println!("skipped: no grooms folder");
    }
    let mut scene = Scene::demo();
    (scene.style.strand_count, scene.body.file) = (400, Some(bust));
    scene.body.spacing = 0.008;
    let prepared = Prepared::new(&scene).unwrap();
    let shape = &prepared.colliders[0].shape;
    let bounds = prepared.mesh.as_ref().unwrap().bounds().unwrap();
    for strand in 0..prepared.guides.strand_count() {
        let root = prepared.guides.position(strand, 0);
        // Samples 8 mm apart.
        assert!(shape.distance(root).abs() < 1e-3, "{root}");
        assert!(root.y > bounds.max.y - 0.25, "{root}");
    }
    assert!(
        prepared.notes.iter().any(|note| note.contains("grows on the highest part")),
        "{:?}",
        prepared.notes
    );
}
