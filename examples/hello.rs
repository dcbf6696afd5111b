//! Grow a style, let it hang for a second, save a picture.
//! `cargo run --release -p strandline --example hello`

use strandline::{Backend, Camera, Hair, Look, Pose, Settings, Style, groom::StyleSettings};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let quick = std::env::var_os("STRANDLINE_QUICK").is_some();
    let strand_count = if quick { 50 } else { 2000 };
    let groom = StyleSettings { strand_count, ..StyleSettings::new(Style::Bob) }.grow()?;
    let mut hair = Hair::new(Backend::auto(), &groom, &Settings::default())?;
    for _ in 0..60 {
        hair.step(1.0 / 60.0, &Pose::IDENTITY)?;
    }
    std::fs::create_dir_all("out/examples")?;
    hair.picture(&Camera::three_quarter(), &Look::brown())?.save("out/examples/hello.png")?;
    Ok(())
}
