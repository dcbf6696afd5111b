//! The end of the program, and the codes that it ends with; docs/limits.md lists them.

use strandline::file::abandon_unfinished;

/// Everything was done.
pub const SUCCESS: i32 = 0;
/// An input, the machine or the disk stands in the way.
pub const FAILURE: i32 = 1;
/// The command line is wrong.
pub const USAGE: i32 = 2;
/// The run is complete, but some of its points were not finite.
pub const NOT_FINITE: i32 = 3;
/// Pictures are there, but ffmpeg could not make the video.
pub const NO_VIDEO: i32 = 4;
/// A signal of this number ended it: added to it, as shells do.
pub const SIGNAL: i32 = 128;

/// Ends the program at once: files that are not finished are removed.
pub fn end_now(code: i32) -> ! {
    let _abandoned = abandon_unfinished();
    // No other code runs any more, such as destructors of a driver beside its threads.
    signal_hook::low_level::exit(code)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_document_lists_every_code() {
        let text = include_str!("../../../docs/limits.md");
        for code in [SUCCESS, FAILURE, USAGE, NOT_FINITE, NO_VIDEO] {
            assert!(text.contains(&format!("\n| {code} | ")), "{code}");
        }
        use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
        let [hup, int, term] = [SIGHUP, SIGINT, SIGTERM].map(|signal| SIGNAL + signal);
        assert!(text.contains(&format!("\n| {hup}, {int}, {term} | ")));
    }
}
