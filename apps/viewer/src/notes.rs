//! Notes that are shown for a while, and the mends of the last error.

use std::time::{Duration, Instant};

use strandline::{Scene, edit::Mend};

/// Time for which a note is shown.
pub const READING: Duration = Duration::from_secs(8);
/// Notes that are shown at once.
const MOST: usize = 5;

/// Time for which a note with a mend is shown.
const MENDING: Duration = Duration::from_secs(40);

/// Something to read, since when, and the mends that it names.
pub struct Note {
    /// Its text.
    pub text: String,
    since: Instant,
    pub mends: Vec<Mend>,
}

impl Note {
    fn is_read(&self) -> bool {
        self.since.elapsed() >= if self.mends.is_empty() { READING } else { MENDING }
    }
}

/// The notes that are shown, oldest first.
#[derive(Default)]
pub struct Notes(Vec<Note>);

impl Notes {
    /// Shows a line for a while, with the mends that it names.
    pub fn add(&mut self, text: String, mends: Vec<Mend>) {
        if self.0.len() == MOST {
            self.0.remove(0);
        }
        self.0.push(Note { text, since: Instant::now(), mends });
    }

    /// Those that are still to be read.
    pub fn unread(&mut self) -> &[Note] {
        self.0.retain(|note| !note.is_read());
        &self.0
    }

    /// Puts all of them away.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}

/// The mends that the last error names, its text, and the scene that could not be loaded for it.
#[derive(Default)]
pub struct Mended {
    pub text: String,
    pub mends: Vec<Mend>,
    pub failed: Option<Box<Scene>>,
}
