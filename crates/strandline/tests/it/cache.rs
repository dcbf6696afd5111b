//! Hair that moved, in files: the same pictures, the same bits when a run resumes, and what is refused.

use std::path::Path;

use strandline::{
    Backend, Cache, Event, OutSettings, Picture, Player, Scene, Target, What, scene::MotionName,
    settings::StrandMethod,
};

const FRAMES: u32 = 14;

fn scene() -> Scene {
    let mut scene = Scene::demo();
    scene.style.strand_count = 60;
    scene.groom.bound = Some(0);
    scene.body.spacing = 0.01;
    scene.simulation.volume.cells = [12; 3];
    scene.motion.name = MotionName::Shake;
    scene.film.frames = FRAMES;
    scene.film.settle = 0.05;
    // Some frames have no step, so that what is shown lies between the last two.
    scene.film.frames_per_second = 100.0;
    scene.film.start = 0.5;
    scene.groom.length = 0.9;
    (scene.look.follow_strands, scene.look.hair_count, scene.look.width_scale) = (2, 0, 10.0);
    // Scattered light costs as much for few strands as for many.
    scene.look.dress(strandline::look::Preset::Thesis);
    (scene.picture.width, scene.picture.height) = (64, 48);
    scene.devices = Backend::Cpu.into();
    scene
}

fn rods() -> Scene {
    let mut scene = scene();
    scene.groom.length = 1.0;
    scene.simulation.strands.method = StrandMethod::Rods;
    scene
}

fn player(scene: &Scene, settings: &OutSettings) -> Player {
    let mut player = Player::new(scene, scene.devices, false).unwrap();
    player.set_out(settings).unwrap();
    player
}

fn whole(scene: &Scene, settings: &OutSettings) {
    let mut player = player(scene, settings);
    player.by_ref().for_each(|event| drop(event.unwrap()));
    let written = player.close_out().unwrap().unwrap();
    assert_eq!(written.place, settings.path);
    assert_eq!(written.frames as u32, scene.film.frames.div_ceil(settings.every));
}

fn pictures(player: &mut Player) -> Vec<Picture> {
    let drawn = |event| match event {
        Ok(Event::Drawn { picture, .. }) => Some(picture),
        Ok(_) => None,
        Err(error) => panic!("{error}"),
    };
    player.filter_map(drawn).collect()
}

#[test]
fn pictures_of_a_cache_are_those_of_the_live_run() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npz");
    let scene = scene();
    whole(&scene, &OutSettings::new(&path));
    let live = pictures(&mut Player::new(&scene, Backend::Cpu, true).unwrap());
    let cache = Cache::open(&path).unwrap();
    assert_eq!((cache.len() as u32, cache.what(), cache.starts().len()), (FRAMES, What::Guides, 61));
    assert!((cache.times()[0] - 1.0 / 100.0).abs() < 1e-12);
    let own = cache.scene().unwrap();
    assert_eq!(own.to_toml(), scene.to_toml());
    let shown = pictures(&mut Player::showing(&own, Backend::Cpu, cache).unwrap());
    assert_eq!(shown.len(), live.len());
    assert!(shown == live);
    assert!(live[0] != live[13], "nothing moved");
}

#[test]
fn a_cache_of_drawn_strands_is_drawn_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = scene();
    // Strands of more points than a simulation has.
    (scene.groom.points_per_strand, scene.level_of_detail.segments_per_span) = (28, 3);
    scene.look.variation = 0.0;
    let settings = OutSettings { what: What::Strands, ..OutSettings::new(folder.path().join("a.npz")) };
    whole(&scene, &settings);
    let live = pictures(&mut Player::new(&scene, Backend::Cpu, true).unwrap());
    let cache = Cache::open(&settings.path).unwrap();
    let own = cache.scene().unwrap();
    let mut player = Player::showing(&own, Backend::Cpu, cache).unwrap();
    assert!(
        player.notes().iter().any(|note| note.contains("the cache's 120 strands")),
        "{:?}",
        player.notes()
    );
    let shown = pictures(&mut player);
    assert_eq!(shown.len(), live.len());
    let apart = |one: &Picture, two: &Picture| {
        let each = one.pixels.iter().zip(&two.pixels).map(|(one, two)| f64::from(one.abs_diff(*two)));
        each.sum::<f64>() / one.pixels.len() as f64
    };
    let moved = apart(&live[0], &live[13]);
    for (shown, live) in shown.iter().zip(&live) {
        // Of 255: 64 points of 82, tapers at roots and tips that are drawn twice.
        assert!(apart(shown, live) < 0.15 * moved, "{} of {moved}", apart(shown, live));
    }
}

/// Breaks a film off after some events, resumes it, and compares the files.
fn goes_on(scene: &Scene, every: u32, folder: &Path) {
    let at = |name: &str| OutSettings { every, ..OutSettings::new(folder.join(name)) };
    let bytes = |name: &str| std::fs::read(folder.join(name)).unwrap();
    whole(scene, &at("whole.npz"));
    for (events, frames) in [(3, FRAMES), (6, FRAMES), (1000, 8)] {
        let short = Scene { film: strandline::scene::FilmSection { frames, ..scene.film }, ..scene.clone() };
        let mut part = player(&short, &at("part.npz"));
        part.by_ref().take(events).for_each(|event| drop(event.unwrap()));
        let left = part.close_out().unwrap().unwrap();
        assert!(left.frames > 0 && left.frames < FRAMES as usize, "{}", left.frames);
        drop(part);
        let mut cache = Cache::open(&left.place).unwrap();
        assert_eq!(cache.len(), left.frames);
        let mut rest = player(scene, &at("rest.npz"));
        rest.resume(&mut cache).unwrap();
        rest.by_ref().for_each(|event| drop(event.unwrap()));
        assert_eq!(rest.close_out().unwrap().unwrap().frames as u32, FRAMES.div_ceil(every));
        assert!(bytes("rest.npz") == bytes("whole.npz"), "after {events} events, every {every}");
        std::fs::remove_file(left.place).unwrap();
    }
    assert!(bytes("whole.npz").len() > 60 * 16 * 12 * 3);
}

#[test]
fn a_film_that_goes_on_makes_the_same_file_as_one_that_never_stopped() {
    let folder = tempfile::tempdir().unwrap();
    goes_on(&scene(), 1, folder.path());
    goes_on(&scene(), 3, folder.path());
}

#[test]
fn pictures_of_a_resumed_film_keep_their_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, path) = (scene(), folder.path().join("short.npz"));
    let film = strandline::scene::FilmSection { frames: 8, ..scene.film };
    whole(&Scene { film, ..scene.clone() }, &OutSettings::new(&path));
    let mut rest = Player::new(&scene, Backend::Cpu, true).unwrap();
    rest.resume(&mut Cache::open(&path).unwrap()).unwrap();
    let number = |event| match event {
        Ok(Event::Drawn { frame, .. }) => Some(frame),
        Ok(_) => None,
        Err(error) => panic!("{error}"),
    };
    assert_eq!(rest.filter_map(number).collect::<Vec<u32>>(), (8..FRAMES).collect::<Vec<u32>>());
}

#[test]
fn rods_go_on_too() {
    let folder = tempfile::tempdir().unwrap();
    goes_on(&rods(), 1, folder.path());
}

#[test]
fn what_does_not_fit_is_refused_with_its_mend() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npz");
    let scene = scene();
    whole(&scene, &OutSettings::new(&path));
    let other = Scene {
        style: strandline::settings::StyleSettings { strand_count: 61, ..scene.style.clone() },
        ..scene.clone()
    };
    let mut player = Player::new(&other, Backend::Cpu, true).unwrap();
    let show = |scene, cache| Player::showing(scene, Backend::Cpu, cache).err().unwrap();
    let refused = |error: strandline::Error, words: &[&str]| {
        let error = error.to_string();
        assert!(words.iter().all(|word| error.contains(word)) && error.ends_with(".npz"), "{error}");
    };
    let open = || Cache::open(&path).unwrap();
    refused(show(&other, open()), &["60 strands, 960 points", "61 strands of 16 points"]);
    refused(player.resume(&mut open()).unwrap_err(), &["61 strands of 16 points"]);
    let mut over = Player::new(&scene, Backend::Cpu, false).unwrap();
    refused(over.resume(&mut open()).unwrap_err(), &["made 14 frames", "--frames"]);
    let strands = OutSettings { what: What::Strands, ..OutSettings::new(folder.path().join("s.npz")) };
    whole(&scene, &strands);
    assert_eq!(Cache::open(&strands.path).unwrap().starts().len(), 121);
    let name = OutSettings::new("a.abc").check().unwrap_err().to_string();
    assert!(name.contains("`abc`") && name.contains("%04d") && name.ends_with("a.abc"), "{name}");
    std::fs::write(folder.path().join("no.npz"), b"PK\x05\x06").unwrap();
    for (name, words) in [("no.npz", "no directory at the end"), ("none.npz", "No such file")] {
        let error = Cache::open(&folder.path().join(name)).err().unwrap().to_string();
        assert!(error.contains(words) && error.ends_with(name), "{error}");
    }
}

#[test]
fn every_frame_becomes_a_groom_file() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene();
    let mut player =
        player(&scene, &OutSettings { every: 5, ..OutSettings::new(folder.path().join("f/%03d.hair")) });
    player.by_ref().for_each(|event| drop(event.unwrap()));
    let written = player.close_out().unwrap().unwrap();
    assert_eq!((written.frames, written.place), (3, folder.path().join("f")));
    whole(&scene, &OutSettings::new(folder.path().join("a.npz")));
    let mut cache = Cache::open(&folder.path().join("a.npz")).unwrap();
    let mut points = Vec::new();
    for frame in [0, 5, 10] {
        let groom = strandline::Groom::load(folder.path().join(format!("f/{frame:03}.hair"))).unwrap();
        cache.read(frame, &mut points).unwrap();
        assert!(groom.points == points, "frame {frame}");
    }
    assert_eq!(std::fs::read_dir(folder.path().join("f")).unwrap().count(), 3);
}

/// Numbers in the brackets behind a word, from a place on.
fn numbers(text: &str, behind: &str) -> Vec<f32> {
    let at = text.find(behind).unwrap_or_else(|| panic!("no {behind}")) + behind.len();
    let end = at + text[at..].find(']').unwrap();
    let split = text[at..end].split(['[', '(', ')', ',', ' ', '\n']);
    split.filter(|word| !word.is_empty()).map(|word| word.parse().unwrap()).collect()
}

#[test]
fn usd_has_every_frame_in_the_units_of_its_reader() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene();
    whole(&scene, &OutSettings::new(folder.path().join("a.npz")));
    let mut cache = Cache::open(&folder.path().join("a.npz")).unwrap();
    let mut points = Vec::new();
    for (target, head) in [
        (
            Target::Any,
            "metersPerUnit = 1\n    startTimeCode = 1                       \n    timeCodesPerSecond = 100\n    upAxis = \"Y\"",
        ),
        (
            Target::Blender,
            "metersPerUnit = 1\n    startTimeCode = 1                       \n    timeCodesPerSecond = 100\n    upAxis = \"Z\"",
        ),
        (
            Target::Unreal,
            "metersPerUnit = 0.01\n    startTimeCode = 1                       \n    timeCodesPerSecond = 100\n    upAxis = \"Z\"",
        ),
    ] {
        let path = folder.path().join(format!("{}.usda", target.name()));
        whole(&scene, &OutSettings { every: 4, target, ..OutSettings::new(&path) });
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.starts_with("#usda 1.0\n") && text.contains(head), "{}", &text[..700]);
        assert!(text.contains("endTimeCode = 13 "), "{}", &text[..700]);
        assert_eq!(numbers(&text, "curveVertexCounts = "), [16.0; 60]);
        // Diameters, in the units of points.
        let units = if target == Target::Unreal { 100.0 } else { 1.0 };
        let guides = player(&scene, &OutSettings::new(folder.path().join("b.npz"))).guides().clone();
        let widths = numbers(&text, "float[] widths = ");
        assert_eq!(widths.len(), 60 * 16);
        let root = guides.widths()[0] * guides.profiles().map_or(1.0, |profiles| profiles[0]);
        assert!((widths[0] - units * root).abs() < 1e-6 * widths[0] && root > 1e-5, "{} m", widths[0]);
        assert_eq!(text.contains("GroomAPI") && text.contains("groom_guide"), target == Target::Unreal);
        let samples = &text[text.find("points.timeSamples").unwrap()..];
        for frame in [0, 4, 8, 12] {
            cache.read(frame, &mut points).unwrap();
            let wanted: Vec<f32> = points
                .iter()
                .flat_map(|point| match target {
                    Target::Any => point.to_array(),
                    Target::Blender => [point.x, -point.z, point.y],
                    Target::Unreal => [100.0 * point.x, -100.0 * point.z, 100.0 * point.y],
                })
                .collect();
            assert!(
                // A time code over codes a second is the time of the frame.
                numbers(samples, &format!("\n            {}: ", frame + 1)) == wanted,
                "frame {frame}"
            );
        }
        assert_eq!(text.matches('{').count(), text.matches('}').count());
    }
}

#[test]
fn a_film_goes_on_on_a_gpu() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = scene();
    scene.film.frames_per_second = 30.0;
    scene.film.start = 0.0;
    scene.film.settle = 0.3;
    scene.devices.simulation = Backend::Gpu(None);
    if let Err(error) = Player::new(&scene, scene.devices, false) {
        assert!(std::env::var_os("STRANDLINE_REQUIRE_GPU").is_none_or(|value| value != "1"), "{error}");
        #[allow(clippy::print_stderr)] // it tells what is not tested
        return eprintln!("not tested on a GPU: {error}");
    }
    let at = |name: &str| OutSettings::new(folder.path().join(name));
    whole(&scene, &at("whole.npz"));
    let mut part = player(&scene, &at("part.npz"));
    part.by_ref().take(9).for_each(|event| drop(event.unwrap()));
    let left = part.close_out().unwrap().unwrap();
    let mut rest = player(&scene, &at("rest.npz"));
    rest.resume(&mut Cache::open(&left.place).unwrap()).unwrap();
    rest.by_ref().for_each(|event| drop(event.unwrap()));
    rest.close_out().unwrap();
    let [mut whole, mut rest] =
        ["whole.npz", "rest.npz"].map(|name| Cache::open(&folder.path().join(name)).unwrap());
    let (mut wanted, mut found) = (Vec::new(), Vec::new());
    for frame in 0..FRAMES as usize {
        whole.read(frame, &mut wanted).unwrap();
        rest.read(frame, &mut found).unwrap();
        // Sums over the points of a cell have one order, so that last bits do not grow.
        let apart = wanted.iter().zip(&found).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        assert!(apart == 0.0 && wanted == found, "frame {frame}: {apart} m");
    }
    assert!(left.frames < FRAMES as usize);
}
