//! `strandline groom`, `convert`, `info` and `scene`: files without motion.

use strandline::groom::{
    Groom, StyleSettings,
    format::{self, LoadOptions},
};

use crate::arguments::{self, ConvertOptions, GroomOptions, InfoOptions, SceneOptions};

/// Grows a style and writes it.
pub fn groom(options: &GroomOptions) -> anyhow::Result<()> {
    let settings = StyleSettings {
        strand_count: options.strands as usize,
        seed: options.seed,
        ..StyleSettings::new(options.style)
    };
    write(&settings.grow()?, &options.out)
}

/// Reads one format and writes another.
pub fn convert(options: &ConvertOptions) -> anyhow::Result<()> {
    let loaded = format::load(&options.input, &LoadOptions { strict: false, ..LoadOptions::default() })?;
    for problem in &loaded.report.problems {
        eprintln!("note: {problem}");
    }
    let groom = match options.points {
        Some(points) => loaded.groom.resampled(points as usize)?,
        None => loaded.groom,
    };
    write(&groom, &options.output)
}

fn write(groom: &Groom, path: &std::path::Path) -> anyhow::Result<()> {
    for part in groom.save(path)?.left_out {
        eprintln!("note: the format cannot hold {part}: left out");
    }
    println!("wrote {} strands, {} points to {}", groom.strand_count(), groom.points.len(), path.display());
    Ok(())
}

/// Says what a file holds.
pub fn info(options: &InfoOptions) -> anyhow::Result<()> {
    let report =
        format::load(&options.file, &LoadOptions { strict: false, ..LoadOptions::default() })?.report;
    if options.json {
        println!("{}", serde_json::to_string(&report)?);
        return Ok(());
    }
    println!("{}: {}", options.file.display(), report.format);
    println!("strands   {}", report.strands);
    println!(
        "points    {} ({} to {} a strand)",
        report.points, report.points_per_strand.min, report.points_per_strand.max
    );
    let length = &report.length_m;
    println!("lengths   {:.4} to {:.4} m, mean {:.4} m", length.min, length.max, length.mean);
    println!("bounds    {:?} m", report.bounds_m);
    for problem in &report.problems {
        println!("problem   {problem}");
    }
    Ok(())
}

/// Prints a scene with every key.
pub fn scene(options: &SceneOptions) -> anyhow::Result<()> {
    print!("{}", arguments::scene(&options.scene)?.to_toml());
    Ok(())
}
