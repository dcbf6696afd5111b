//! Writes the JavaScript beside a WebAssembly module: `strandline-web-binder MODULE FOLDER`.

#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [module, folder] = &words[..] else {
        eprintln!("usage: strandline-web-binder MODULE FOLDER");
        return ExitCode::from(2);
    };
    let mut binder = wasm_bindgen_cli_support::Bindgen::new();
    binder.input_path(module).typescript(false).remove_name_section(true).remove_producers_section(true);
    match binder.web(true).and_then(|binder| binder.generate(folder)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error:#}");
            ExitCode::FAILURE
        }
    }
}
