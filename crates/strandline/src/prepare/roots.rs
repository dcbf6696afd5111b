//! Fifth stage of loading: roots on the skin.

use std::path::Path;

use super::{cover, guess, join, loading::Loading, marked, wrap};
use crate::{Error, groom::Groom};

/// Grows the style where the scene names no groom, leads roots of a style or of another head's hair to the skin, and
/// presses hair under a hat: all before the strokes of a brush.
pub(super) fn roots(loading: &mut Loading) -> Result<(), Error> {
    match &mut loading.groom {
        Some(groom) => {
            if let Some(shape) = loading.shape.as_ref().filter(|_| loading.is_foreign) {
                wrap::lead(groom, shape);
            }
        }
        None => loading.groom = Some(grown(loading)?),
    }
    if let Some(groom) = &mut loading.groom {
        loading.notes.extend(cover::press(groom, &loading.covers, loading.skull.as_ref()));
    }
    Ok(())
}

/// Brushes the hair, and tells of roots that are away from the skin.
pub(super) fn brushed(loading: &mut Loading) {
    brush(loading);
    let pair = loading.groom.as_ref().zip(loading.own_mesh());
    let apart = pair.and_then(|(groom, mesh)| guess::apart(groom, mesh));
    let scene = &loading.scene;
    let files = scene.groom.file.iter().chain(scene.groom.parts.iter().map(|part| &part.file));
    let files = files.map(|file| file.display().to_string()).collect::<Vec<_>>().join(", ");
    loading.notes.extend(join::of_file(scene, Some(Path::new(&files)), apart));
}

/// Strokes of a brush over the hair at rest, in their order.
fn brush(loading: &mut Loading) {
    let Some(groom) = &mut loading.groom else { return };
    for (index, stroke) in loading.scene.strokes.iter().enumerate() {
        let after = stroke.on(groom);
        if after == *groom {
            loading.notes.push(format!(
                "strokes[{index}] changes nothing: no root lies within {} m of its position, or `{}` finds nothing to do there",
                stroke.radius,
                stroke.tool.name()
            ));
        }
        *groom = after;
    }
}

/// The style, on the body of a source or on the mannequin.
fn grown(loading: &mut Loading) -> Result<Groom, Error> {
    let style = &loading.scene.style;
    let unused = style.without_effect().into_iter();
    let notes =
        unused.map(|key| format!("{key} changes nothing: `{}` has no use for it", style.style.name()));
    loading.notes.extend(notes.collect::<Vec<_>>());
    let scene = &loading.scene;
    if loading.own_mesh().is_none() {
        return scene.grow(scene.grown_strands());
    }
    let mut groom = scene.style.grow_hair(scene.grown_strands())?;
    let marked = marked::scalp(loading)?;
    let note = match loading.own_mesh() {
        Some(mesh) => wrap::onto(&mut groom, mesh, marked.as_ref(), loading.shape.as_ref())?,
        None => None,
    };
    loading.notes.extend(note);
    Ok(groom)
}
