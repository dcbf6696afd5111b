//! Every style on the mannequin, the pictures of docs/gallery.
//! `cargo run --release -p strandline --example gallery`

use strandline::{Backend, Event, Player, Scene, Style};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let quick = std::env::var_os("STRANDLINE_QUICK").is_some();
    let folder = std::path::Path::new(if quick { "out/examples" } else { "docs/gallery" });
    std::fs::create_dir_all(folder)?;
    for style in Style::ALL {
        let mut scene = Scene::demo();
        scene.set_style(style);
        scene.film.frames = 1;
        (scene.picture.width, scene.picture.height) = (400, 440);
        if quick {
            (scene.style.strand_count, scene.body.spacing) = (50, 0.01);
            (scene.picture.width, scene.picture.height) = (80, 88);
            scene.film.settle = 0.0;
        }
        for event in Player::new(&scene, Backend::auto(), true)? {
            if let Event::Drawn { picture, report, .. } = event? {
                assert!(report.segments > 0 && !picture.is_blank(), "{style:?} shows nothing");
                picture.save(folder.join(format!("{}.png", style.name())))?;
            }
        }
    }
    Ok(())
}
