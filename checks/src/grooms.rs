//! Grooms and heads as artists make them, which are not part of the project.

use std::path::{Path, PathBuf};

use strandline::{Prepared, Scene};

/// Sintel's hair on her head, in a scene that is changed first; none, with a word, where the folder of grooms
/// (`STRANDLINE_GROOMS`) is not.
///
/// # Panics
/// The files are there and are not read.
#[allow(clippy::print_stderr)] // it tells what is not tested
pub fn sintel(change: impl FnOnce(&mut Scene)) -> Option<Prepared> {
    let folder = std::env::var_os("STRANDLINE_GROOMS")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/grooms"), PathBuf::from);
    let hair = folder.join("sintel/SintelHairOriginal-sintel_hair.16points.tfx");
    let head = folder.join("sintel/sintel.obj");
    if !hair.is_file() || !head.is_file() {
        eprintln!("not tested on Sintel: no grooms folder");
        return None;
    }
    let mut scene = Scene::default();
    scene.groom.file = Some(hair);
    scene.body.file = Some(head);
    change(&mut scene);
    Some(Prepared::new(&scene).unwrap())
}
