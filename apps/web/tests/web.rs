//! Hair of a page, without a browser.

#![allow(clippy::disallowed_methods)] // compared values may be rounded

use glam::Vec2;
use strandline::math::Random;
use strandline_web::{Page, bits};

const SIZE: [u32; 2] = [48, 60];

/// Grabs at a place; true where the hand holds hair.
fn grab(page: &mut Page, place: Vec2, radius: f32) -> bool {
    page.grab(place, radius).unwrap();
    page.grabbed().unwrap().expect("the CPU answers at once")
}

/// Points of a page on the CPU.
fn points(page: &mut Page) -> Vec<glam::Vec3> {
    page.points().unwrap().unwrap()
}

/// A page of few strands on a head that rests, with further settings.
fn page(further: &[(&str, &str)]) -> Result<Page, String> {
    let few = [("style.strand_count", "32"), ("motion.name", "still")];
    let given = few.iter().chain(further).map(|(key, value)| ((*key).to_owned(), (*value).to_owned()));
    Page::open(given.collect(), SIZE)
}

#[test]
fn scenes_are_told_apart_and_a_scene_has_the_same_bits_twice() {
    let pixie = bits::line("pixie").unwrap();
    assert_eq!(pixie, bits::line("pixie").unwrap());
    let bob = bits::line("bob").unwrap();
    let words = |line: &str| line.split(' ').map(str::to_owned).collect::<Vec<_>>();
    let (pixie, bob) = (words(&pixie), words(&bob));
    assert!(pixie.len() == 3 && (0..3).all(|word| pixie[word] != bob[word]), "{pixie:?} {bob:?}");
    assert!(bits::line("mohawk").is_err());
}

#[test]
fn a_link_makes_the_page_that_its_settings_made() {
    let changes = [
        ("look.tip_color", "#ff2000"),
        ("look.preset", "blonde"),
        ("look.light_rig", "all_sides"),
        ("page.light", "90"),
        ("page.view", "-30"),
        ("page.color", "#ffc0a0"),
        ("motion.rotation", "[5, 20, 0]"),
        ("groom.length", "0.8"),
        ("style.style", "bob"),
    ];
    let mut changed = page(&[]).unwrap();
    let plain = changed.picture(None).unwrap();
    for (key, value) in changes {
        changed.set(key, value).unwrap();
    }
    let mut linked = Page::open(changed.given().to_vec(), SIZE).unwrap();
    assert_eq!(linked.get("look.preset").unwrap(), "\"blonde\"");
    for page in [&mut changed, &mut linked] {
        page.reset().unwrap();
        (0..3).for_each(|_| _ = page.frame().unwrap());
    }
    let picture = linked.picture(None).unwrap();
    assert_eq!(changed.picture(None).unwrap(), picture);
    assert_ne!(plain, picture);
}

#[test]
fn what_is_refused_leaves_the_page_as_it_was() {
    let mut page = page(&[]).unwrap();
    let given = page.given().to_vec();
    let refusals = [
        ("style.stile", "bob", "style.stile"),
        ("style.strand_count", "0", "strand_count"),
        ("look.tip_width", "2", "tip_width"),
        ("page.light", "east", "page.light"),
        ("page.lights", "1", "page.lights"),
        ("page.color", "red", "page.color"),
        ("groom.file", "secret.hair", "drop them"),
        ("simulation.time_step", "-1", "time_step"),
        ("style.strand_count", "1000000", "expected 20000 at most in a page"),
        ("groom.guides", "20001", "groom.guides: found 20001"),
        ("groom.bound", "1000000", "groom.bound"),
    ];
    for (key, value, named) in refusals {
        let error = page.set(key, value).unwrap_err();
        assert!(error.contains(named), "{key}: {error}");
    }
    for (name, bytes) in [("cat.jpg", &b"JFIF"[..]), ("no ending", b""), ("a.hair", b"PK"), ("a.glb", b"PK")]
    {
        let error = page.drop_file(name, bytes).unwrap_err();
        assert!(error.contains(name), "{error}");
    }
    assert_eq!(page.given(), given);
    assert_eq!(page.strand_count(), 32);
    assert!(Page::open(vec![("style.stile".into(), "bob".into())], SIZE).is_err());
}

#[test]
fn a_hand_takes_hair_where_there_is_some() {
    let mut page = page(&[("style.style", "bob")]).unwrap();
    assert!(!grab(&mut page, Vec2::new(0.01, 0.01), 0.01));
    let places = (1..20).flat_map(|x| (1..20).map(move |y| Vec2::new(x as f32, y as f32) / 20.0));
    let held = places.into_iter().find(|place| grab(&mut page, *place, 0.02)).expect("hair in the picture");
    let before = points(&mut page);
    page.drag(held + Vec2::new(0.2, 0.0)).unwrap();
    (0..5).for_each(|_| _ = page.frame().unwrap());
    let pulled = before.iter().zip(points(&mut page)).map(|(one, other)| one.distance(other));
    assert!(pulled.fold(0.0, f32::max) > 0.02);
    page.release().unwrap();
}

#[test]
fn dropped_files_take_the_place_of_the_style_and_of_each_other() {
    let lines = |strands: usize| {
        let mut text = String::new();
        for strand in 0..strands {
            for point in 0..8 {
                let (x, y) = (0.004 * strand as f32 - 0.08, 0.12 - 0.03 * point as f32);
                text.push_str(&format!("v {x} {y} 0.1\n"));
            }
        }
        for strand in 0..strands {
            let corners: Vec<String> = (1..=8).map(|point| (8 * strand + point).to_string()).collect();
            text.push_str(&format!("l {}\n", corners.join(" ")));
        }
        text.into_bytes()
    };
    let mut page = page(&[]).unwrap();
    page.drop_file("a.obj", &lines(40)).unwrap();
    assert_eq!(page.strand_count(), 40);
    page.drop_file("b.obj", &lines(24)).unwrap();
    assert_eq!(page.strand_count(), 24);
    page.frame().unwrap();
    assert!(!page.picture(Some(3)).unwrap().is_blank());
    // A style takes their place.
    page.set("style.style", "wavy").unwrap();
    assert_eq!(page.strand_count(), 32);
}

/// An action of a visitor at random: hands, settings in and out of their range, sizes, files, frames and pictures.
fn act(page: &mut Page, random: &mut Random) {
    let place = Vec2::new(random.unit(), random.unit());
    let share = random.unit();
    let mut below = |bound: u32| (random.unit() * bound as f32) as u32;
    // A refusal is a message; the page goes on.
    let set = |page: &mut Page, key: &str, value: String| drop(page.set(key, &value));
    match below(100) {
        0..25 => _ = page.frame().unwrap(),
        25..40 => page.grab(place, 0.05 * share).unwrap(),
        40..55 => page.drag(2.0 * place - 0.5).unwrap(),
        55..62 => page.release().unwrap(),
        62..67 => page.reset().unwrap(),
        67..71 => set(page, "wind.velocity", format!("[{}, 0, {}]", 20.0 * share - 10.0, 5.0 * place.x)),
        71..75 => set(page, "groom.length", format!("{}", 3.0 * share)),
        75..78 => set(page, "simulation.gravity", format!("[0, {}, 0]", -30.0 * share)),
        78..81 => set(page, "simulation.volume.enabled", (share < 0.5).to_string()),
        81..84 => set(page, "look.preset", ["blonde", "black", "purple", "plaid"][below(4) as usize].into()),
        84..87 => set(page, "look.tip_width", format!("{}", 2.0 * share)),
        87..89 => set(page, "page.light", format!("{}", 1000.0 * share - 500.0)),
        89..91 => set(page, "motion.name", ["still", "shake", "nod", "dance"][below(4) as usize].into()),
        91..93 => set(page, "simulation.time_step", format!("{}", 0.05 * share - 0.01)),
        // Of one shape: what is loaded is framed for the shape of the picture.
        93..95 => {
            let size = 4 + below(12);
            page.resize([4 * size, 5 * size]).unwrap();
        }
        95..96 => drop(page.drop_file("a.hair", b"HAIR and nothing")),
        96..97 => set(page, "style.style", ["bob", "buzz", "mohawk"][below(3) as usize].into()),
        _ => assert!(page.picture(Some(3)).unwrap().width > 0),
    }
}

#[test]
fn a_thousand_random_changes_leave_the_page_that_its_link_makes() {
    let mut page = page(&[("style.strand_count", "8"), ("groom.bound", "0")]).unwrap();
    page.resize([0, 0]).unwrap();
    page.resize([u32::MAX, 1]).unwrap();
    page.resize(SIZE).unwrap();
    let mut random = Random::new(40, 0);
    for action in 0..1000 {
        act(&mut page, &mut random);
        if action % 20 == 0 {
            assert!(points(&mut page).iter().all(|point| point.is_finite()), "action {action}");
        }
    }
    page.resize(SIZE).unwrap();
    // A page keeps its view while hair grows; its link frames the hair that it loads.
    page.set("groom.length", "1").unwrap();
    let mut linked = Page::open(page.given().to_vec(), SIZE).unwrap();
    for page in [&mut page, &mut linked] {
        page.release().unwrap();
        page.reset().unwrap();
        (0..3).for_each(|_| _ = page.frame().unwrap());
    }
    assert_eq!(points(&mut page), points(&mut linked));
    assert!(page.picture(None).unwrap() == linked.picture(None).unwrap(), "the pictures differ");
}
