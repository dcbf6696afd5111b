//! The page's files: the switches of "How it works", and the content policy.

#![allow(clippy::disallowed_methods)] // compared values may be rounded

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use glam::Vec3;
use strandline::Picture;
use strandline_web::Page;

const SIZE: [u32; 2] = [80, 100];
/// Frames after a change of the motion: a head that turns has begun to stop.
const FRAMES: usize = 40;

type Settings = Vec<(String, String)>;

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("site").join(name)
}

fn file(name: &str) -> String {
    fs::read_to_string(path(name)).unwrap()
}

/// Values of an attribute, in their order.
fn attributes(html: &str, name: &str) -> Vec<String> {
    let begin = format!("{name}=\"");
    let parts = html.split(&begin).skip(1);
    parts.map(|part| part.split('"').next().unwrap().to_owned()).collect()
}

fn settings(text: &str) -> Settings {
    let pairs = text.split(';').map(|pair| pair.split_once('=').unwrap());
    pairs.map(|(key, value)| (key.to_owned(), value.to_owned())).collect()
}

/// A stage with its settings when it is on and off.
struct Switch {
    stage: String,
    on: Settings,
    off: Settings,
}

fn switches() -> Vec<Switch> {
    let html = file("how.html");
    let [stages, on, off] = ["data-stage", "data-on", "data-off"].map(|name| attributes(&html, name));
    assert!(stages.len() == on.len() && on.len() == off.len());
    let parts = stages.into_iter().zip(on.iter().zip(&off));
    parts.map(|(stage, (on, off))| Switch { stage, on: settings(on), off: settings(off) }).collect()
}

/// Settings under all switches, as the script lists them.
fn base() -> Settings {
    let script = file("how.js");
    let rows = script.lines().filter_map(|line| line.strip_prefix("  [\"")?.strip_suffix("\"],"));
    let rows: Vec<_> = rows.map(|row| row.split_once("\", \"").unwrap()).collect();
    assert!(rows.len() > 4, "{rows:?}");
    rows.into_iter().map(|(key, value)| (key.to_owned(), value.to_owned())).collect()
}

/// Picture and points after the first frames of the motion.
fn shown(page: &mut Page) -> (Picture, Vec<Vec3>) {
    page.reset().unwrap();
    (0..FRAMES).for_each(|_| _ = page.frame().unwrap());
    (page.picture(None).unwrap(), page.points().unwrap().unwrap())
}

fn farthest(one: &[Vec3], other: &[Vec3]) -> f32 {
    one.iter().zip(other).map(|(one, other)| one.distance(*other)).fold(0.0, f32::max)
}

/// Mean difference of two pictures, of 255.
fn apart(one: &Picture, other: &Picture) -> f32 {
    let sum: u32 = one.pixels.iter().zip(&other.pixels).map(|(a, b)| u32::from(a.abs_diff(*b))).sum();
    sum as f32 / one.pixels.len() as f32
}

#[test]
fn each_switch_shows_its_stage_and_takes_it_back() {
    let switches = switches();
    let all = switches.iter().flat_map(|switch| switch.on.clone());
    let mut page = Page::open(base().into_iter().chain(all).collect(), SIZE).unwrap();
    let (picture, points) = shown(&mut page);
    // Stages of a picture move nothing; those of a step do.
    let of_a_step = ["springs", "lengths", "volume"];
    let mut seen = BTreeMap::new();
    for Switch { stage, on, off } in &switches {
        off.iter().for_each(|(key, value)| page.set(key, value).unwrap());
        let (other, moved) = shown(&mut page);
        let (look, way) = (apart(&picture, &other), farthest(&points, &moved));
        seen.insert(stage.as_str(), (look, way));
        if of_a_step.contains(&&**stage) {
            assert!(way > 2e-3, "{stage}: {way} m");
        } else if stage != "guides" {
            assert_eq!(way, 0.0, "{stage} moves hair");
        }
        assert!(look > 0.2, "{stage}: {look} of 255");
        on.iter().for_each(|(key, value)| page.set(key, value).unwrap());
        let (again, back) = shown(&mut page);
        assert!(again == picture && back == points, "{stage}: {}", farthest(&points, &back));
    }
    assert_eq!(seen.len(), 8, "{seen:?}");
}

/// Beside a poster that is narrower than the window lies the background of the pictures.
#[test]
fn the_stage_has_the_background_of_the_pictures() {
    let few = [("style.strand_count", "8"), ("groom.bound", "0")];
    let few = few.map(|(key, value)| (key.to_owned(), value.to_owned()));
    // Wide, so that hair and body leave a part of each row free.
    let picture = Page::open(few.to_vec(), [3 * SIZE[1], SIZE[1]]).unwrap().picture(None).unwrap();
    let css = file("style.css");
    let gradient = css.split_once("linear-gradient(").unwrap().1.split_once(");").unwrap().0;
    let stops: Vec<Vec<i32>> = gradient
        .split("rgb(")
        .skip(1)
        .map(|color| color.split_once(')').unwrap().0.split(", ").map(|part| part.parse().unwrap()).collect())
        .collect();
    assert_eq!(stops.len(), 5, "{gradient}");
    let last = picture.height as usize - 1;
    for (index, stop) in stops.iter().enumerate() {
        let row = index * last / 4;
        let width = picture.width as usize;
        let pixels = picture.pixels[3 * width * row..][..3 * width].chunks(3);
        let apart = |pixel: &[u8]| {
            pixel.iter().zip(stop).map(|(one, other)| (i32::from(*one) - other).abs()).max().unwrap()
        };
        let nearest = pixels.map(apart).min().unwrap();
        assert!(nearest <= 2, "row {row}: {nearest} of 255 from {stop:?}");
    }
}

#[test]
fn the_poster_is_small() {
    let bytes = fs::read(path("poster.webp")).unwrap();
    assert!(bytes.len() <= 60_000 && bytes.starts_with(b"RIFF"), "{} bytes", bytes.len());
}

/// Scripts and styles are files of the page, so that its content policy can forbid all others.
#[test]
fn no_page_has_a_script_or_a_style_of_its_own() {
    for name in ["index.html", "how.html"] {
        let html = file(name);
        let policy =
            attributes(&html, "content").into_iter().find(|text| text.contains("default-src")).unwrap();
        assert!(policy.starts_with("default-src 'none'"), "{name}: {policy}");
        assert!(!policy.contains("unsafe-inline") && !policy.contains("http"), "{name}: {policy}");
        for (index, _) in html.match_indices("<script") {
            let tag = html[index..].split_once('>').unwrap();
            assert!(tag.0.contains("src=\"") && tag.1.starts_with("</script>"), "{name}: {}", tag.0);
        }
        assert!(!html.contains("<style") && !html.contains(" style=\""), "{name}");
        let handlers = html.split(" on").skip(1).filter(|rest| {
            rest.split_once('=')
                .is_some_and(|(word, _)| word.chars().all(|letter| letter.is_ascii_lowercase()))
        });
        assert_eq!(handlers.count(), 0, "{name}");
        for link in attributes(&html, "href").into_iter().chain(attributes(&html, "src")) {
            assert!(!link.contains("//") && fs::metadata(path(&link)).unwrap().len() > 0, "{name}: {link}");
        }
    }
}
