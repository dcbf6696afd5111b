//! The page of grown styles, docs/styles.md, and its pictures. `cargo run --release -p strandline --example styles`

use std::fmt::Write;
use std::path::Path;

use strandline::{Backend, Camera, Hair, Prepared, Scene, Style, settings::Kind};

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
    for style in Style::ALL {
        let mut scene = Scene::demo();
        scene.set_style(style);
        let side = if quick { 48 } else { 300 };
        (scene.picture.width, scene.picture.height) = (side, side);
        if quick {
            scene.style.strand_count = 40;
        }
        let mut hair = Hair::from_prepared(Prepared::new(&scene)?, Backend::Cpu)?;
        let look = hair.look().clone();
        let camera = if style.name() == "bun" || style.name() == "braid" {
            Camera::side()
        } else {
            Camera::three_quarter()
        };
        let picture = hair.picture(&camera, &look)?;
        assert!(!picture.is_blank(), "{}", style.name());
        picture.save(folder.join(format!("style_{}.png", style.name())))?;
    }
    Ok(())
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
         [scene.md](scene.md#style) says what each does.\n",
    );
    let Kind::Words(words) = Scene::row("style.style")?.kind else { return Err("no list of styles".into()) };
    let plain = settings(Style::default());
    for (style, word) in Style::ALL.into_iter().zip(words) {
        let own: Vec<String> = settings(style).into_iter().filter(|line| !plain.contains(line)).collect();
        write!(page, "\n## {}\n\n![{0}](gallery/style_{0}.png)\n\n{}\n", style.name(), word.about())?;
        if style != Style::default() {
            write!(page, "\n```toml\n[style]\n{}\n```\n", own.join("\n"))?;
        }
    }
    Ok(page)
}
