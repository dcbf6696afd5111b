//! Messages of the libraries, wgpu's above all, for finding faults.

use std::io::{Write, stderr};

use env_filter::{Builder, Filter};
use log::{LevelFilter, Log, Metadata, Record};
use strandline::file::printable;

use crate::output;

struct ToStderr(Filter);

impl Log for ToStderr {
    fn enabled(&self, metadata: &Metadata) -> bool {
        self.0.enabled(metadata)
    }

    fn log(&self, record: &Record) {
        if self.0.matches(record) {
            let text = record.args().to_string();
            // A closed stderr is no error.
            let _ = writeln!(stderr(), "{} {}: {}", record.level(), record.target(), printable(&text));
        }
    }

    fn flush(&self) {}
}

/// Shows messages of this level and above; without a level, those that `RUST_LOG` names.
pub fn begin(level: Option<LevelFilter>) {
    let mut filter = Builder::new();
    match (level, std::env::var("RUST_LOG")) {
        (Some(level), _) => {
            filter.filter_level(level);
        }
        (None, Ok(text)) => {
            if let Err(error) = filter.try_parse(&text) {
                output::note(&format!("RUST_LOG: {error}"));
            }
        }
        (None, Err(_)) => return,
    }
    let filter = filter.build();
    log::set_max_level(filter.filter());
    // No logger is set before.
    let _ = log::set_boxed_logger(Box::new(ToStderr(filter)));
}
