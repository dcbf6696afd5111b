//! Data that is too large, or not ours, to be part of the project.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use strandline::{Prepared, Scene};

/// Sintel's hair on her head, in a scene that is changed first; `None`, with a note, if the folder of grooms
/// (`STRANDLINE_GROOMS`) is not.
///
/// # Panics
/// The files are there and are not read, or they are missing and required.
pub fn sintel(change: impl FnOnce(&mut Scene)) -> Option<Prepared> {
    groom(["sintel/SintelHairOriginal-sintel_hair.16points.tfx", "sintel/sintel.obj"], change)
}

/// The groom of a ponytail on its head; else as [`sintel`].
///
/// # Panics
/// The files are there and are not read, or they are missing and required.
pub fn ponytail(change: impl FnOnce(&mut Scene)) -> Option<Prepared> {
    groom(["ponytail/ponytail.tfxproj", "ponytail/ponytail_mesh.obj"], change)
}

/// The groom of a ponytail on a body of another file; else as [`sintel`].
///
/// # Panics
/// The files are there and are not read, or they are missing and required.
pub fn ponytail_on(body: PathBuf, change: impl FnOnce(&mut Scene)) -> Option<Prepared> {
    let files = ["ponytail/ponytail.tfxproj"];
    let hair = folder("STRANDLINE_GROOMS", "grooms", &files)?.join(files[0]);
    let mut scene = Scene::default();
    (scene.groom.file, scene.body.file) = (Some(hair), Some(body));
    change(&mut scene);
    Some(Prepared::new(&scene).unwrap())
}

/// Hair on a head, of the folder of grooms.
fn groom(files: [&str; 2], change: impl FnOnce(&mut Scene)) -> Option<Prepared> {
    let folder = folder("STRANDLINE_GROOMS", "grooms", &files)?;
    let [hair, head] = files.map(|file| Some(folder.join(file)));
    let mut scene = Scene::default();
    (scene.groom.file, scene.body.file) = (hair, head);
    change(&mut scene);
    Some(Prepared::new(&scene).unwrap())
}

/// The folder of references (`STRANDLINE_REFERENCE`) that holds some files; `None`, with a note, if it does not.
///
/// # Panics
/// It does not, and files are required.
pub fn reference(files: &[&str]) -> Option<PathBuf> {
    folder("STRANDLINE_REFERENCE", "reference", files)
}

/// The folder that a variable of the environment names, else the one of a name in `shared` beside the project.
fn folder(variable: &str, name: &str, files: &[&str]) -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared").join(name);
    let folder = std::env::var_os(variable).map_or_else(beside, PathBuf::from);
    let missing = files.iter().find(|file| !folder.join(file).is_file());
    let Some(missing) = missing else { return Some(folder) };
    let found = format!("no {missing} in the folder that {variable} names: {}", folder.display());
    not_tested(&found, std::env::var_os(REQUIRED).as_deref());
    None
}

/// Variable of the environment that makes missing data a failure.
const REQUIRED: &str = "STRANDLINE_REQUIRE_GROOMS";

/// Prints a line to stderr that the running test checks nothing, with the reason. The line is written past the capture of
/// the test runner, which would hide the output of a passing test.
///
/// # Panics
/// Data is required.
fn not_tested(why: &str, required: Option<&OsStr>) {
    let line = line(why);
    assert!(required.is_none(), "{REQUIRED} is set, but {line}");
    print(&line);
}

/// Prints a line to stderr that the running test is one of `cargo xtask long` on this adapter.
pub fn left_to_long() {
    print(&line("a software adapter takes long: `cargo xtask long`"));
}

fn line(why: &str) -> String {
    let thread = std::thread::current();
    format!("NOT TESTED: {}: {why}\n", thread.name().unwrap_or("a test"))
}

fn print(line: &str) {
    // A closed stderr leaves no place for the note.
    std::io::Write::write_all(&mut std::io::stderr(), line.as_bytes()).ok();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[should_panic(expected = "STRANDLINE_REQUIRE_GROOMS is set, but NOT TESTED: ")]
    fn missing_data_fails_where_it_is_required() {
        not_tested("no such file", Some(OsStr::new("1")));
    }
}
