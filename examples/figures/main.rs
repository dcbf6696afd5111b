//! Our version of each picture of [Chen2011] and sheets of hair in motion, the pictures of docs/gallery/figures.
//! `cargo run --release -p strandline --example figures [auto|cpu|gpu|gpu:N] [NAME...]`
#![allow(clippy::print_stdout)]

mod geometry;
mod motion;
mod motions;
mod setup;
mod shading;
mod strip;

use std::time::Instant;

use setup::{Figure, Setup};
use strandline::{Backend, Style};

/// Draws a figure.
type Draw = fn(&Setup) -> Figure;

/// Every figure by the name of its file, with its number in the thesis where it has one.
const FIGURES: [(&str, &str, Draw); 20] = [
    ("layers", "8", shading::layers),
    ("opacity_map", "9", shading::opacity_map),
    ("head_shake", "34", motion::head_shake),
    ("level_of_detail", "37", geometry::level_of_detail),
    ("supersampling", "38", geometry::supersampling),
    ("tessellation", "39", geometry::tessellation),
    ("follow_strands", "40", geometry::follow_strands),
    ("follow_counts", "41", geometry::follow_counts),
    ("light_directions", "42", shading::light_directions),
    ("colors", "43", shading::colors),
    ("highlights", "44", shading::highlights),
    ("lengths", "45", motion::lengths),
    ("front", "46", motion::front),
    ("back", "47", motion::back),
    ("motion_bob", "", |setup| motions::sheet(setup, Style::Bob)),
    ("motion_long", "", |setup| motions::sheet(setup, Style::Long)),
    ("motion_wavy", "", |setup| motions::sheet(setup, Style::Wavy)),
    ("motion_curly", "", |setup| motions::sheet(setup, Style::Curly)),
    ("motion_pixie", "", |setup| motions::sheet(setup, Style::Pixie)),
    ("motion_ponytail", "", |setup| motions::sheet(setup, Style::Ponytail)),
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let backend: Backend = arguments.next().as_deref().unwrap_or("auto").parse()?;
    let wanted: Vec<String> = arguments.collect();
    let setup = Setup { backend, quick: std::env::var_os("STRANDLINE_QUICK").is_some() };
    let folder =
        std::path::Path::new(if setup.quick { "out/examples/figures" } else { "docs/gallery/figures" });
    std::fs::create_dir_all(folder)?;
    for (name, number, draw) in FIGURES {
        if !wanted.is_empty() && !wanted.iter().any(|wanted| wanted == name) {
            continue;
        }
        let start = Instant::now();
        let picture = draw(&setup)?;
        assert!(!picture.is_blank(), "{name} shows nothing");
        picture.save(folder.join(format!("{name}.png")))?;
        let of = if number.is_empty() { String::new() } else { format!("[Chen2011 fig. {number}]") };
        println!("{name:<18} {of:<19} {:>6.1} s", start.elapsed().as_secs_f64());
    }
    Ok(())
}
