//! Cut hair and let it grow while it moves: one side is shortened to 60 %, the other is half as long again.
//! `cargo run --release -p strandline --example length`

use strandline::{Backend, Camera, Hair, Look, Pose, Settings, Style, settings::StyleSettings};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let quick = std::env::var_os("STRANDLINE_QUICK").is_some();
    let strand_count = if quick { 50 } else { 2000 };
    let groom = StyleSettings { strand_count, ..StyleSettings::new(Style::Long) }.grow()?;
    let mut hair = Hair::new(Backend::auto(), &groom, &Settings::default())?;
    let roots = groom.starts.iter().take(strand_count).map(|start| groom.points[*start as usize]);
    let scales: Vec<f32> = roots.map(|root| if root.x > 0.0 { 0.6 } else { 1.5 }).collect();
    hair.set_length_scale(&scales)?;
    let reports = hair.step(0.25, Pose::IDENTITY)?;
    assert!(reports.iter().all(|report| report.stretch_max < 1e-3), "hair has other lengths than those");
    std::fs::create_dir_all("out/examples")?;
    let picture = hair.picture(&Camera::front(), &Look::red())?;
    assert!(!picture.is_blank(), "no hair in the picture");
    picture.save("out/examples/length.png")?;
    Ok(())
}
