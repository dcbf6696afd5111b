use std::path::PathBuf;

use strandline_base::settings;

settings! {
    /// Frames that a window keeps, so that they are shown again and left as a file without simulating them again.
    pub struct TimelineSection {
        /// File of kept frames that a window begins with, as it saves them with a project; other programs pass it over.
        frames: Option<PathBuf> = None;
        /// Memory for frames.
        memory: u32 = 1000, in [1, 1_000_000] "MB", more "more frames at hand";
        /// Room on the disk, in the folder for temporary files, for frames beyond the memory. Beyond both the
        /// first frames are forgotten.
        disk: u32 = 4000, in [0, 10_000_000] "MB", more "more frames";
    }
}
