//! The page of grown styles, docs/styles.md, its pictures, and the small pictures of styles and looks in the window.
//! `cargo run --release -p strandline --example styles`

use std::fmt::Write;
use std::path::Path;

use glam::Vec3;
use image::{RgbImage, imageops};
use strandline::{
    Backend, Camera, Hair, Picture, Prepared, Scene, Style, look::Preset, scene::View, settings::Kind,
};

const ASSETS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../apps/viewer/assets");
/// Side of a small picture \[pixel\].
const SMALL: u32 = 64;
/// Pictures of styles with settings of their own: name, style, the settings, a heading and a sentence.
const OTHERS: [(&str, Style, &[&str], [&str; 2]); 3] = [
    (
        "fringe",
        Style::Bob,
        &["fringe = 0.05"],
        ["With a fringe", "Hair that falls from a parting or is tied may have a fringe: a bob to the brows."],
    ),
    (
        "behind_ears",
        Style::Wavy,
        &["behind_ears = true"],
        ["Behind the ears", "Hair that falls from a parting may be led behind the ears."],
    ),
    (
        "face",
        Style::Pixie,
        &["beard = true", "brows = true", "lashes = true"],
        [
            "With hair of the face",
            "A beard, brows and lashes grow beside any style, each a group of its name (`look.group`).",
        ],
    ),
];
/// A place before the eyes \[m\] and the place that is seen from there.
const EYES: [Vec3; 2] = [Vec3::new(0.11, 0.0, 0.43), Vec3::new(0.008, -0.012, 0.085)];
/// A place above the head \[m\] and the place that is seen from there.
const ABOVE: [Vec3; 2] = [Vec3::new(0.0, 0.9, -0.2), Vec3::new(0.0, 0.0, -0.01)];
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/styles.md");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let quick = std::env::var_os("STRANDLINE_QUICK").is_some();
    let page = page()?;
    if quick {
        let found = std::fs::read_to_string(PAGE)?;
        assert!(
            found == page,
            "docs/styles.md is of before: `cargo run --release -p strandline --example styles`"
        );
    } else {
        std::fs::write(PAGE, page)?;
    }
    let folder = Path::new(if quick { "out/examples" } else { "docs/gallery" });
    std::fs::create_dir_all(folder)?;
    let mut small = Vec::new();
    for style in Style::ALL {
        small.push(drawn(style, &[], quick)?);
        small[small.len() - 1].save(folder.join(format!("style_{}.png", style.name())))?;
    }
    for (name, style, settings, _) in OTHERS {
        drawn(style, settings, quick)?.save(folder.join(format!("style_{name}.png")))?;
    }
    all_sides(quick)?.save(folder.join("styles_all_sides.jpg"))?;
    let assets = if quick { folder } else { Path::new(ASSETS) };
    row(&small).save(assets.join("styles.jpg"))?;
    let (mut hair, camera) = grown(Style::Bob, &[], quick)?;
    let mut looks = Vec::new();
    for preset in Preset::ALL.into_iter().step_by(if quick { 6 } else { 1 }) {
        let mut look = hair.look().clone();
        look.dress(preset);
        looks.push(hair.picture(&camera, &look)?);
    }
    row(&looks).save(assets.join("looks.jpg"))?;
    Ok(())
}

/// The picture of a style with settings of its own.
fn drawn(style: Style, settings: &[&str], quick: bool) -> Result<Picture, Box<dyn std::error::Error>> {
    let (mut hair, camera) = grown(style, settings, quick)?;
    let look = hair.look().clone();
    let picture = hair.picture(&camera, &look)?;
    assert!(!picture.is_blank(), "{}", style.name());
    Ok(picture)
}

/// A style on the built-in head, and the camera that sees the most of it.
fn grown(style: Style, settings: &[&str], quick: bool) -> Result<(Hair, Camera), strandline::Error> {
    let mut scene = Scene::demo();
    scene.set_style(style);
    for (key, value) in settings.iter().filter_map(|setting| setting.split_once(" = ")) {
        scene.set(&format!("style.{key}"), value)?;
    }
    let side = if quick { 48 } else { 300 };
    (scene.picture.width, scene.picture.height) = (side, side);
    if quick {
        (scene.style.strand_count, scene.body.spacing) = (40, 0.01);
        scene.look.follow_strands = 4;
    }
    if matches!(style.name(), "bun" | "braid") {
        scene.camera.view = View::Side;
    }
    if matches!(style.name(), "brows" | "lashes") {
        (scene.camera.position, scene.camera.target) = (Some(EYES[0]), Some(EYES[1]));
        scene.camera.field_of_view = Some(20.0);
    }
    let prepared = Prepared::new(&scene)?;
    let camera = prepared.camera(1.0);
    Ok((Hair::from_prepared(prepared, Backend::Cpu)?, camera))
}

/// Hair of the head in rows, a style each: from the front, between front and side, from the side, from the back and from
/// above.
fn all_sides(quick: bool) -> Result<RgbImage, Box<dyn std::error::Error>> {
    let side = if quick { 32 } else { 200 };
    let styles = Style::ALL.into_iter().filter(|style| !style.is_of_face());
    let styles: Vec<Style> = styles.step_by(if quick { 6 } else { 1 }).collect();
    let mut sheet = RgbImage::new(side * 5, side * styles.len() as u32);
    for (row, style) in (0..).step_by(side as usize).zip(styles) {
        let mut scene = Scene::demo();
        scene.set_style(style);
        (scene.picture.width, scene.picture.height) = (side, side);
        if quick {
            (scene.style.strand_count, scene.body.spacing) = (40, 0.01);
            scene.groom.bound = Some(80);
        }
        let mut prepared = Prepared::new(&scene)?;
        let mut cameras: Vec<Camera> = Vec::new();
        for view in [View::Front, View::ThreeQuarter, View::Side, View::Back] {
            prepared.scene.camera.view = view;
            cameras.push(prepared.camera(1.0));
        }
        cameras.push(Camera { position: ABOVE[0], target: ABOVE[1], ..cameras[0] });
        let mut hair = Hair::from_prepared(prepared, Backend::Cpu)?;
        let look = hair.look().clone();
        for (column, camera) in (0..).step_by(side as usize).zip(&cameras) {
            let picture = hair.picture(camera, &look)?;
            let drawn = RgbImage::from_raw(picture.width, picture.height, picture.pixels);
            imageops::replace(&mut sheet, &drawn.ok_or("a picture of another size")?, column, row);
        }
    }
    Ok(sheet)
}

/// Pictures side by side, small.
fn row(pictures: &[Picture]) -> RgbImage {
    let mut row = RgbImage::new(SMALL * pictures.len() as u32, SMALL);
    for (x, picture) in (0..).step_by(SMALL as usize).zip(pictures) {
        let Some(whole) = RgbImage::from_raw(picture.width, picture.height, picture.pixels.clone()) else {
            continue;
        };
        let small = imageops::resize(&whole, SMALL, SMALL, imageops::FilterType::Lanczos3);
        imageops::replace(&mut row, &small, x, 0);
    }
    row
}

/// The settings of a style in a scene file, key after key.
fn settings(style: Style) -> Vec<String> {
    let mut scene = Scene::demo();
    scene.set_style(style);
    let text = scene.to_toml();
    let section = text.split("[style]").nth(1).unwrap_or_default();
    section.lines().skip(1).take_while(|line| line.contains('=')).map(str::to_owned).collect()
}

fn page() -> Result<String, Box<dyn std::error::Error>> {
    let mut page = String::from(
        "# Styles\n\nWritten by `cargo run --release -p strandline --example styles`.\n\n\
         Styles grow on the built-in head, or on the head of a body: `--style NAME`, `[style]` of a scene, the list `style` of the \
         window. A seed grows other hair of the same style. Each style has other settings; those that differ from \"long\" are listed. \
         [scene.md](scene.md#style) says what each does.\n\n\
         At rest hair stays where it is, to the bit where it was measured. Six seconds after a shake of one second buns, braids, \
         afros, coils, buzz cuts, side-swept hair and hair of the face were back within 0.5 % of their length in the mean \
         (checks/laws/rod_styles.rs, which holds the mean to 3 % and the strand in the middle to 2 %).\n",
    );
    page.push_str("\nEach from the front, between front and side, from the side, from the back and from above:\n\n![all sides](gallery/styles_all_sides.jpg)\n");
    let Kind::Words(words) = Scene::row("style.style")?.kind else { return Err("no list of styles".into()) };
    let plain = settings(Style::default());
    for (style, word) in Style::ALL.into_iter().zip(words) {
        let own: Vec<String> = settings(style).into_iter().filter(|line| !plain.contains(line)).collect();
        write!(page, "\n## {}\n\n![{0}](gallery/style_{0}.png)\n\n{}\n", style.name(), word.about())?;
        if style != Style::default() {
            write!(page, "\n```toml\n[style]\n{}\n```\n", own.join("\n"))?;
        }
    }
    for (name, style, settings, [heading, sentence]) in OTHERS {
        let (style, settings) = (style.name(), settings.join("\n"));
        write!(
            page,
            "\n## {heading}\n\n![{name}](gallery/style_{name}.png)\n\n{sentence}\n\n\
             ```toml\n[style]\nstyle = \"{style}\"\n{settings}\n```\n"
        )?;
    }
    Ok(page)
}
