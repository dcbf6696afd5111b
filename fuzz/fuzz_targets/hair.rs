//! Any bytes are read or refused; what was read can be written and read again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use strandline_groom::format::{LoadOptions, hair, prepare};

fuzz_target!(|bytes: &[u8]| {
    let Ok(parsed) = hair::read(bytes) else { return };
    let lenient = LoadOptions { strict: false, ..LoadOptions::default() };
    let Ok(loaded) = prepare(parsed, &lenient) else { return };
    if let Ok(written) = hair::write(&loaded.groom) {
        assert!(hair::read(&written).is_ok());
    }
});
