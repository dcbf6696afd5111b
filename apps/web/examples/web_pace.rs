//! Prints the time of a frame of 2,000 guides on the processor: two steps on one thread, as the page's module makes them
//! (`apps/web/tests/pace.mjs`). `cargo run --release -p strandline-web --example web_pace`, with RAYON_NUM_THREADS=1.

#![allow(clippy::print_stdout)] // it is a measurement

use std::time::Instant;

use strandline_web::Page;

fn main() -> Result<(), String> {
    let settings = [("style.strand_count", "2000"), ("groom.bound", "0"), ("motion.name", "shake")];
    let settings = settings.map(|(key, value)| (key.to_owned(), value.to_owned())).to_vec();
    let mut page = Page::open(settings, [160, 200])?;
    let mut turns = Vec::new();
    for _ in 0..5 {
        let begin = Instant::now();
        for _ in 0..20 {
            page.frame()?;
        }
        turns.push(begin.elapsed().as_secs_f64() * 1e3 / 20.0);
    }
    println!("{:.1} ms a frame at least, {turns:.1?}", turns.iter().copied().fold(f64::INFINITY, f64::min));
    Ok(())
}
