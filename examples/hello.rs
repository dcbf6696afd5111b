//! The README's code: grow a style on the built-in head, shake it for a second, save a picture.
//! `cargo run --release -p strandline --example hello`

use strandline::{Camera, Error, Hair, Scene, Style};

fn hello() -> Result<(), Error> {
    let mut scene = Scene::demo(); // or Scene::load("scene.toml".as_ref())?
    scene.set_style(Style::Wavy); // or scene.groom.file = Some("own.hair".into())
    let mut hair = Hair::open(&scene)?;
    let (head, look) = (hair.head().clone(), hair.look().clone());
    for frame in 1..=60 {
        let seconds = 1.0 / 60.0;
        hair.step(seconds, head.pose(seconds * f64::from(frame)))?;
    }
    hair.picture(&Camera::three_quarter(), &look)?.save("wavy.png")?;
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    std::fs::create_dir_all("out/examples")?;
    std::env::set_current_dir("out/examples")?;
    hello()?;
    // The head without hair is some 130 kB, with it 185.
    assert!(std::fs::metadata("wavy.png")?.len() > 155_000, "no hair in wavy.png");
    Ok(())
}
