//! Prints the bits of scenes, to be compared with those of the page's module: `cargo xtask web --test`.

#![allow(clippy::print_stdout, clippy::print_stderr)] // it talks to the command that compares

use std::time::Instant;

use strandline_web::bits;

fn main() -> Result<(), strandline::Error> {
    for name in bits::NAMES {
        let begin = Instant::now();
        println!("{}", bits::line(name)?);
        eprintln!("{name} {:.3} s", begin.elapsed().as_secs_f64());
    }
    Ok(())
}
