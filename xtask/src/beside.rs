//! Lints and documentation of our crates from the dependencies that are built for the tests. `cargo clippy` and
//! `cargo doc` check all dependencies once more, which takes as long as everything that they say of our crates. Lints
//! without GPUs and window run here too, with the features that other crates have for the whole program. Tests and
//! examples are compiled by clippy itself, which is rustc with lints: they are read once.
//!
//! Cargo calls [`compile`] in place of rustc for crates of the workspace (`RUSTC_WORKSPACE_WRAPPER`). Cargo keeps what
//! was compiled this way apart from what rustc compiled alone: this is for a fresh checkout, as in CI.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use crate::bare;
use crate::cargo::{compile_through, root, wrapper};

/// Crates in whose loops the tests spend their time. As one unit they compile 1.4 times as long and run up to a quarter
/// faster: nothing is inlined across units. That pays where all tests run once, not where somebody edits them.
const LOOPS: [&str; 3] = ["strandline_body", "strandline_sim", "strandline_render"];

/// Crates whose own tests run for less time than it takes to optimise them.
const SHORT: [&str; 3] = ["strandline_checks", "strandline_cli", "strandline_viewer"];

/// Set for the copy of this program that cargo calls.
const CALLED: &str = "STRANDLINE_COMPILES_AND_LINTS";
/// Folder of what is made here, and in it the list of builds.
const FOLDER: &str = "target/beside";
const KNOWN: &str = "built.txt";

/// Lets each following call of cargo lint and document our crates; false where that is not possible, and where a plain
/// build is there already, as in a checkout that somebody works in: ours would be compiled twice.
pub fn begin() -> bool {
    let folder = root().join(FOLDER);
    let known = std::fs::read_to_string(folder.join(KNOWN)).unwrap_or_default();
    let mut known = known.lines();
    let settings = known.next() == Some(&lints());
    let known: Vec<&str> = known.collect();
    if libraries().iter().any(|name| !settings || !known.contains(&name.as_str())) {
        return false;
    }
    // Cargo builds this program anew while it runs.
    let copy = folder.join("xtask");
    // Other versions of the tools wrote files that these do not read.
    let _ = std::fs::remove_dir_all(folder.join("out"));
    // Crates that are not compiled again find the ones that they depend on here.
    if libraries().is_empty() {
        let _ = std::fs::remove_dir_all(folder.join("bare"));
    }
    let made = std::fs::create_dir_all(folder.join("out"))
        .and_then(|()| std::fs::create_dir_all(folder.join("bare")))
        .and_then(|()| std::fs::copy(std::env::current_exe()?, &copy));
    if let Err(error) = &made {
        println!("lints are not run beside the build: {error}");
    }
    made.is_ok() && compile_through(copy, CALLED)
}

/// Notes what was built, so that the next run tells it from a plain build.
pub fn end() {
    let built = [vec![lints()], libraries()].concat().join("\n");
    let written = wrapper().map(|copy| std::fs::write(copy.with_file_name(KNOWN), built));
    if let Some(Err(error)) = written {
        println!("the next run will build anew: {error}");
    }
}

/// The settings of the lints on one line: cargo does not know that a build depends on them.
fn lints() -> String {
    std::fs::read_to_string(root().join("clippy.toml")).unwrap_or_default().replace('\n', " ")
}

/// Names of the builds of the library that are there.
fn libraries() -> Vec<String> {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    let files = std::fs::read_dir(target.join("debug/deps")).into_iter().flatten().flatten();
    let names = files.filter_map(|file| file.file_name().into_string().ok());
    names.filter(|name| name.starts_with("libstrandline-") && name.ends_with(".rlib")).collect()
}

/// Name of the step that builds.
pub fn step() -> &'static str {
    if wrapper().is_some() { "build, lints and documentation" } else { "build" }
}

/// True where cargo calls this program in place of rustc.
pub fn is_called() -> bool {
    std::env::var_os(CALLED).is_some()
        && std::env::args().nth(1).is_some_and(|word| Path::new(&word).file_stem() == Some("rustc".as_ref()))
}

/// Compiles a library or a program as rustc would, then lints and documents it; compiles all else with lints. A crate with
/// features is linted without them first: cargo begins with those that depend on it as soon as rustc knows its items.
pub fn compile() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(2).collect();
    let out = root().join(FOLDER).join("out");
    let rustc = std::env::args().nth(1).unwrap_or_default();
    let with = |mut words: Vec<String>, more: &[&str]| {
        words.extend(more.iter().map(|&word| word.to_owned()));
        words
    };
    let settings = settings(&words);
    if is_crate(&words) && !is_documented(&words) {
        return run([("clippy-driver".to_owned(), with(with(words, settings), &["-D", "warnings"]))]);
    }
    let mut commands = vec![(rustc, with(words.clone(), settings))];
    let is_documented = is_crate(&words);
    if is_documented {
        let metadata = with(elsewhere(&words, &out), &["--emit=metadata", "-D", "warnings"]);
        commands.push(("clippy-driver".to_owned(), metadata));
        let private = if is_program(&words) { &["--document-private-items"][..] } else { &[] };
        let documented = with(with(elsewhere(&words, &out), &["-D", "warnings"]), private);
        commands.push(("rustdoc".to_owned(), documented));
    }
    let bare = is_documented.then(|| without_features(&words, &manifest(), &out.with_file_name("bare")));
    if let Some(bare) = bare.flatten() {
        commands.insert(0, ("clippy-driver".to_owned(), with(bare, &["--emit=metadata", "-D", "warnings"])));
    }
    run(commands)
}

/// Runs commands one after the other as long as they succeed.
fn run(commands: impl IntoIterator<Item = (String, Vec<String>)>) -> ExitCode {
    for (program, words) in commands {
        match Command::new(&program).args(words).status() {
            Ok(status) if status.success() => {}
            Ok(status) => return ExitCode::from(status.code().map_or(1, |code| code.clamp(1, 255) as u8)),
            Err(error) => {
                eprintln!("cannot run {program}: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

/// The manifest of the package that cargo compiles.
fn manifest() -> String {
    let folder = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default();
    std::fs::read_to_string(Path::new(&folder).join("Cargo.toml")).unwrap_or_default()
}

/// Settings of the compiler in place of those of the profile.
fn settings(words: &[String]) -> &'static [&'static str] {
    let is_of = |names: &[&str]| {
        words.windows(2).any(|pair| pair[0] == "--crate-name" && names.contains(&pair[1].as_str()))
    };
    match words.iter().any(|word| word == "--test") {
        false if is_of(&LOOPS) => &["-C", "codegen-units=1"],
        true if is_of(&SHORT) => &["-C", "opt-level=0"],
        _ => &[],
    }
}

/// True where a crate is compiled; cargo also asks rustc about itself.
fn is_crate(words: &[String]) -> bool {
    words.iter().any(|word| word.starts_with("--emit=")) && words.iter().any(|word| word.ends_with(".rs"))
}

/// True for libraries and programs, and not for tests, examples and scripts of builds.
fn is_documented(words: &[String]) -> bool {
    let is_other = |pair: &[String]| match pair[0].as_str() {
        "--crate-name" => pair[1].starts_with("build_script_"),
        "--out-dir" => Path::new(&pair[1]).ends_with("examples"),
        _ => false,
    };
    !words.iter().any(|word| word == "--test") && !words.windows(2).any(is_other)
}

/// True for a program and an example.
fn is_program(words: &[String]) -> bool {
    words.windows(2).any(|pair| pair[0] == "--crate-type" && pair[1] == "bin")
}

/// The same crate without features and what they alone depend on, into a folder of its own from those that lie there;
/// `None` for a crate that has none, and for an example.
fn without_features(words: &[String], manifest: &str, out: &Path) -> Option<Vec<String>> {
    let name = words.windows(2).find(|pair| pair[0] == "--crate-name").map(|pair| pair[1].as_str());
    name.filter(|name| is_bare(name))?;
    let optional: Vec<&str> = manifest
        .lines()
        .filter(|line| line.contains("optional = true"))
        .filter_map(|line| line.split(" =").next())
        .collect();
    let is_optional = |name: &str| optional.iter().any(|other| other.replace('-', "_") == name);
    let mut bare = Vec::new();
    let mut rest = elsewhere(words, out).into_iter();
    while let Some(word) = rest.next() {
        let value = if matches!(word.as_str(), "--cfg" | "--extern") { rest.next() } else { None };
        let Some(value) = value else {
            bare.push(word);
            continue;
        };
        if word == "--cfg" && value.starts_with("feature=") {
            continue;
        }
        let other = value.split('=').next().unwrap_or_default();
        if word == "--extern" && is_optional(other) {
            continue;
        }
        let value = if is_bare(other) { in_folder(&value, out) } else { value };
        bare.extend([word, value]);
    }
    bare.extend(["-L".to_owned(), format!("dependency={}", out.display())]);
    Some(bare)
}

/// True for the name of a crate that has features.
fn is_bare(name: &str) -> bool {
    bare::PACKAGES.contains(&name.replace('_', "-").as_str())
}

/// `NAME=FILE` with the metadata of that name in a folder.
fn in_folder(known: &str, folder: &Path) -> String {
    let Some((name, file)) = known.split_once('=') else { return known.to_owned() };
    let file = folder.join(Path::new(file).with_extension("rmeta").file_name().unwrap_or_default());
    format!("{name}={}", file.display())
}

/// The same crate into another folder: files that cargo keeps are not touched, and no file is announced for which it
/// waits.
fn elsewhere(words: &[String], out: &Path) -> Vec<String> {
    let mut words = words.iter();
    let mut other = Vec::new();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--out-dir" => drop(words.next()),
            "-C" => match words.next() {
                Some(value) if value.starts_with("incremental=") => {}
                value => other.extend([Some(word), value].into_iter().flatten().cloned()),
            },
            word if word.starts_with("--emit=") => {}
            word if word.starts_with("--json=") => {
                let told = word.trim_start_matches("--json=").split(',').filter(|&kind| kind != "artifacts");
                other.push(format!("--json={}", told.collect::<Vec<_>>().join(",")));
            }
            word => other.push(word.to_owned()),
        }
    }
    other.extend(["--out-dir".to_owned(), out.display().to_string()]);
    other
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Vec<String> {
        line.split_whitespace().map(str::to_owned).collect()
    }

    #[test]
    fn a_crate_goes_elsewhere_with_everything_that_shapes_it() {
        let cargo = words(
            "--crate-name strandline --edition=2024 crates/strandline/src/lib.rs --error-format=json \
             --json=diagnostic-rendered-ansi,artifacts,future-incompat --crate-type lib --emit=dep-info,metadata,link \
             -C opt-level=2 -C incremental=/t/i --cfg feature=\"gpu\" --out-dir /t/debug/deps --extern a=/t/liba.rmeta",
        );
        let other = words(
            "--crate-name strandline --edition=2024 crates/strandline/src/lib.rs --error-format=json \
             --json=diagnostic-rendered-ansi,future-incompat --crate-type lib \
             -C opt-level=2 --cfg feature=\"gpu\" --extern a=/t/liba.rmeta --out-dir /o",
        );
        assert_eq!(elsewhere(&cargo, Path::new("/o")), other);
        assert!(is_crate(&cargo) && !is_program(&cargo) && is_documented(&cargo));
    }

    #[test]
    fn a_crate_without_features_sees_none_of_what_they_add() {
        let cargo = words(
            "--crate-name strandline_render src/lib.rs --crate-type lib --emit=metadata,link -C opt-level=2 \
             --cfg feature=\"default\" --cfg feature=\"gpu\" --check-cfg cfg(docsrs) --out-dir /t/debug/deps \
             -L dependency=/t/debug/deps --extern bytemuck=/t/libbytemuck-1.rmeta --extern glam=/t/libglam-2.rmeta \
             --extern strandline_gpu=/t/libstrandline_gpu-3.rlib --extern strandline_base=/t/libstrandline_base-4.rmeta",
        );
        let manifest =
            "[dependencies]\nbytemuck = { workspace = true, optional = true }\nglam.workspace = true\n";
        let bare = words(
            "--crate-name strandline_render src/lib.rs --crate-type lib -C opt-level=2 --check-cfg cfg(docsrs) \
             -L dependency=/t/debug/deps --extern glam=/t/libglam-2.rmeta \
             --extern strandline_gpu=/b/libstrandline_gpu-3.rmeta \
             --extern strandline_base=/t/libstrandline_base-4.rmeta --out-dir /b -L dependency=/b",
        );
        assert_eq!(without_features(&cargo, manifest, Path::new("/b")), Some(bare));
        assert_eq!(
            without_features(&words("--crate-name strandline_base src/lib.rs"), "", Path::new("/b")),
            None
        );
    }

    #[test]
    fn questions_of_cargo_are_no_crates() {
        assert!(!is_crate(&words("-vV")));
        assert_eq!(
            settings(&words("--crate-name strandline_sim --crate-type lib")),
            ["-C", "codegen-units=1"]
        );
        assert_eq!(settings(&words("--crate-name strandline_cli --test")), ["-C", "opt-level=0"]);
        for plain in ["--crate-name strandline_sim --test", "--crate-name strandline_cli", "-vV"] {
            assert!(settings(&words(plain)).is_empty(), "{plain}");
        }
        assert!(!is_crate(&words("- --crate-name ___ --print=file-names --crate-type bin")));
        assert!(is_program(&words("--crate-name xtask src/main.rs --crate-type bin --emit=link")));
        for other in [
            "--crate-name build_script_build b.rs",
            "--crate-name a a.rs --test",
            "--crate-name a a.rs --out-dir /t/examples",
        ] {
            assert!(!is_documented(&words(other)), "{other}");
        }
    }
}
