//! `strandline groom`, `convert`, `info` and `scene`: files without motion.

use strandline::groom::{
    Groom, StyleSettings,
    format::{self, LoadOptions},
};

use crate::arguments::{self, ConvertOptions, GroomOptions, InfoOptions, SceneOptions};
use crate::output::{self, print_line};
use crate::progress::Waiting;

/// Grows a style and writes it.
pub fn groom(options: &GroomOptions) -> anyhow::Result<()> {
    let settings = StyleSettings {
        strand_count: options.strands as usize,
        seed: options.seed,
        ..StyleSettings::new(options.style)
    };
    let waiting = Waiting::begin("growing strands");
    let groom = settings.grow()?;
    drop(waiting);
    write(&groom, &options.out)
}

/// Reads one format and writes another.
pub fn convert(options: &ConvertOptions) -> anyhow::Result<()> {
    let loaded = format::load(&options.input, &LoadOptions { strict: false, ..LoadOptions::default() })?;
    for problem in &loaded.report.problems {
        output::note(problem);
    }
    let groom = match options.points {
        Some(points) => loaded.groom.resampled(points as usize)?,
        None => loaded.groom,
    };
    write(&groom, &options.output)
}

fn write(groom: &Groom, path: &std::path::Path) -> anyhow::Result<()> {
    for part in groom.save(path)?.left_out {
        output::note(&format!("the format cannot hold {part}: left out"));
    }
    print_line!(
        "wrote {} strands, {} points to {}",
        groom.strand_count(),
        groom.points.len(),
        path.display()
    );
    Ok(())
}

/// Says what a file holds.
pub fn info(options: &InfoOptions) -> anyhow::Result<()> {
    let report =
        format::load(&options.file, &LoadOptions { strict: false, ..LoadOptions::default() })?.report;
    if options.json {
        output::program(&format!("{}\n", serde_json::to_string(&report)?));
        return Ok(());
    }
    print_line!("{}: {}", options.file.display(), report.format);
    print_line!("strands   {}", report.strands);
    print_line!(
        "points    {} ({} to {} a strand)",
        report.points,
        report.points_per_strand.min,
        report.points_per_strand.max
    );
    let length = &report.length_m;
    print_line!("lengths   {:.4} to {:.4} m, mean {:.4} m", length.min, length.max, length.mean);
    print_line!("bounds    {:?} m", report.bounds_m);
    for problem in &report.problems {
        print_line!("problem   {problem}");
    }
    Ok(())
}

/// Prints a scene with every key.
pub fn scene(options: &SceneOptions) -> anyhow::Result<()> {
    output::program(&arguments::scene(&options.scene)?.to_toml());
    Ok(())
}
