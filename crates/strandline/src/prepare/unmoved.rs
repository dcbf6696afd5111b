//! Notes on settings of a motion where nothing moves.

use std::path::Path;

use super::Sources;
use crate::{Scene, scene::TeleportSection};

/// Clips that a note lists.
const LISTED: usize = 20;

/// Settings of a motion: the first time \[s\], the speed, whether it begins again, and marks.
type Settings<'a> = (f64, f64, bool, &'a [TeleportSection]);

/// Names settings of the body's motion where the body does not move, and those of a part's clip where it has none.
pub(super) fn notes(sources: &Sources, scene: &Scene, moves: bool) -> Vec<String> {
    let body = &scene.body;
    let own: Settings<'_> = (body.start, body.speed, body.r#loop, &body.teleports);
    let file = body.file.as_deref();
    let of_body = given("body", own).filter(|_| !moves).map(|keys| {
        let mend = match (file, clips(sources, scene, file)) {
            (None, _) => "body.file and body.clip name a body and its motion".to_owned(),
            (Some(_), None) => "body.clip or body.vertices names its motion".to_owned(),
            (Some(_), Some(clips)) => format!("body.clip plays one of its clips: {clips}"),
        };
        format!("{keys} not used, as the body does not move by itself: {mend}")
    });
    let of_parts = body.parts.iter().enumerate().filter(|(_, part)| part.clip.is_none());
    let of_parts = of_parts.filter_map(|(index, part)| {
        let key = format!("body.parts[{index}]");
        let keys = given(&key, (part.start, part.speed, part.r#loop, &part.teleports))?;
        let clips = clips(sources, scene, Some(&part.file));
        let clips = clips.unwrap_or_else(|| "its file has none".to_owned());
        Some(format!(
            "{keys} not used, as the part rides the head: {key}.clip plays one of its clips: {clips}"
        ))
    });
    of_body.into_iter().chain(of_parts).collect()
}

/// The keys of a section that are not at their defaults, with a verb; `None` where all are.
fn given(section: &str, (start, speed, is_loop, teleports): Settings<'_>) -> Option<String> {
    let changed = [
        ("start", start != 0.0),
        ("speed", speed != 1.0),
        ("loop", is_loop),
        ("teleports", !teleports.is_empty()),
    ];
    let keys = changed.iter().filter(|(_, is_changed)| *is_changed);
    let keys: Vec<String> = keys.map(|(key, _)| format!("{section}.{key}")).collect();
    let verb = if keys.len() == 1 { "is" } else { "are" };
    (!keys.is_empty()).then(|| format!("{} {verb}", keys.join(", ")))
}

/// Clips of a file, human-readable; `None` without any.
fn clips(sources: &Sources, scene: &Scene, file: Option<&Path>) -> Option<String> {
    let file = file.filter(|file| !sources.has_mesh(file))?;
    let names = crate::body::Mesh::clip_names(&scene.path(file)).ok()?;
    let listed: Vec<String> = names.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
    let more = if names.len() > LISTED { " and more" } else { "" };
    (!names.is_empty()).then(|| listed.join(", ") + more)
}
