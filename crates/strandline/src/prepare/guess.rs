//! Units and axes of a groom and its body, taken from both where a scene leaves them open.

use glam::{Quat, Vec3};
use strandline_base::math;

use super::{
    doubts::{Doubt, doubts, note_of_size, refusal, refusal_of_body},
    evidence::Hair,
    foreign,
    noted::noted,
    placing::{Defined, Placing, Placings, diagonal, upright},
    relation::{FoundPlacing, Head, Search},
    sample::{NEAR, NEARER, Sample},
    shown::{Body, SHAPELESS, Shown},
    units::{SCALPS, given_unit, unit_of_width},
};
use crate::{
    Scene,
    body::{Aabb, Mesh},
    groom::{
        Groom,
        format::{GROOMS, Scale, UNITS, Up, unit_alone},
    },
    scene::GroomPart,
};

/// Least advantage of another axis over y in the height of roots for it to be up, and in all evidence.
const HIGHER: f32 = 0.15;
const SURER: f32 = 0.3;
/// Evidence beyond that for the axes of a file with which others are taken for a groom without a body.
const SURE_ALONE: f32 = 2.5;
/// Distance of roots over their size at which nothing is left of the confidence in their place, and for those that are
/// fitted to another head than their own.
const ASTRAY: f32 = 0.2;
const ASTRAY_FOREIGN: f32 = 0.3;
/// Confidence in hair that is fitted to another head than its own, in the axes of a patch that are not the body's, and in
/// hair away from the body.
const FOREIGN: f32 = 0.8;
const PATCH: f32 = 0.55;
const AWAY: f32 = 0.1;
/// Distance of roots over their size from which on a patch floats above no skin.
const FAR_OFF: f32 = 0.5;
/// Evidence by which the best place is better than the next, below which that is named.
const CLOSE: f32 = 0.7;
/// Share of the confidence that a doubt leaves.
const DOUBTED: f32 = 0.3;

/// Placements of the files of a groom, which share theirs, and of a body's files, where there are some of each.
pub(super) fn placings(scene: &Scene, strands: Strands, body: Option<Body>) -> Placings {
    match body {
        None => hair_alone(scene, strands),
        Some(body) if strands.grooms.is_empty() => body_alone(scene, body.shown),
        Some(body) => together(scene, strands, body),
    }
}

/// The files of a groom.
#[derive(Clone, Copy)]
pub(super) struct Strands<'a> {
    pub grooms: &'a [&'a Groom],
    /// True where the format of the first defines metres and y up.
    pub is_defined: bool,
}

/// The place of a groom without a body.
fn hair_alone(scene: &Scene, Strands { grooms, is_defined }: Strands) -> Placings {
    if is_defined && scene.groom.scale == Scale::Auto && scene.groom.up == Up::Auto {
        return Placings::new(1.0);
    }
    let given = &scene.groom;
    let hair = Hair::new(grooms);
    let is_free = given.up == Up::Auto && given.rotation == Vec3::ZERO;
    let shown = if is_free && hair.is_full(None) { shown_alone(&hair) } else { None };
    let turn = shown.unwrap_or_else(|| upright(given.up));
    let scale = given_unit(given.scale).unwrap_or_else(|| unit_alone(grooms));
    let groom = Placing { scale, turn };
    let placings = Placings { groom, ..Placings::new(if given.up == Up::Auto { SHAPELESS } else { 1.0 }) };
    Placings { notes: noted(scene, &placings, false, None), ..placings }
}

/// The axes that strands alone show surely: they hang, and roots lie high.
fn shown_alone(hair: &Hair) -> Option<Quat> {
    let upright = |turn: Quat| hair.placed(|point| turn * point).upright();
    let own = upright(Quat::IDENTITY);
    let others = [Up::Z, Up::MinusY, Up::MinusZ, Up::X, Up::MinusX].map(|up| up.rotation());
    let best = others.into_iter().map(|turn| (upright(turn), turn));
    let (best, turn) = best.fold((own, Quat::IDENTITY), |best, one| if one.0 > best.0 { one } else { best });
    (best > own + SURE_ALONE).then_some(turn)
}

/// The place of a body that a style grows on.
fn body_alone(scene: &Scene, shown: &Shown) -> Placings {
    let placings = Placings { body: shown.placing, ..Placings::new(shown.confidence) };
    let refusal = refusal_of_body(shown);
    Placings { notes: noted(scene, &placings, true, shown.strange), refusal, ..placings }
}

/// The places of a groom and a body.
fn together(scene: &Scene, strands: Strands, Body { mesh, shown }: Body) -> Placings {
    let Strands { grooms, is_defined } = strands;
    let Shown { mut placing, pose, mut strange, confidence: sure, .. } = *shown;
    let (hair, sample) = (Hair::new(grooms), Sample::new(grooms, mesh));
    let mut other = None;
    let is_open = !pose.is_sure || pose.has_base;
    let shown_up = if is_open && scene.groom.up == Up::Auto { shown_up(&sample) } else { None };
    if let Some(up) = shown_up {
        placing.turn = upright(up);
        other = Some(Head::new(scene, mesh, placing, pose));
    }
    let (body, head) = (placing, other.as_ref().unwrap_or(&shown.head));
    let search = Search { scene, hair: &hair, is_defined, head };
    let mut placings = found(&search, grooms, Placings { body, ..Placings::new(sure) });
    let is_faceless = (pose.is_person == pose.is_sure || pose.has_base) && !pose.shows_front;
    if placings.groom.turn == body.turn && is_faceless && search.may_turn_both() {
        let turn = sample.to_front(&placings.groom, &body);
        let turned = |placing: Placing| Placing { turn: turn * placing.turn, ..placing };
        let (groom, body) = (turned(placings.groom), turned(body));
        if sample.scalp(&groom, &body).is_some() {
            (placings.groom, placings.body) = (groom, body);
        }
    }
    let is_open = scene.groom.scale == Scale::Auto && scene.body.scale == Scale::Auto;
    let is_guessed = is_open && shown.defined == Defined::Nothing && !pose.is_person && !placings.is_foreign;
    let scalp = sample.scalp(&placings.groom, &placings.body);
    if let Some(width) = scalp.filter(|width| is_guessed && !SCALPS.contains(width)) {
        let (scale, odd) = unit_of_width(width / body.scale);
        placings.groom.scale *= scale / body.scale;
        (placings.body.scale, strange) = (scale, odd);
    }
    placings.is_against = is_defined && !placings.is_foreign && placings.groom.differs(&search.same());
    let mut notes = noted(scene, &placings, true, strange);
    let (found, size) = checked(&search, &placings, body);
    placings.confidence *= math::powf(DOUBTED, found.len() as f32);
    notes.extend(found.iter().map(Doubt::note));
    if let Some(note) = note_of_size(is_defined, size) {
        placings.confidence *= DOUBTED;
        notes.push(note);
    }
    let refusal = refusal_of_body(shown).or_else(|| refusal(scene, &placings, &found));
    Placings { notes, refusal, ..placings }
}

/// Properties of the placed groom that no hair of a head has, and its size over that of its file's units.
fn checked(search: &Search, placings: &Placings, body: Placing) -> (Vec<Doubt>, f32) {
    if placings.is_foreign {
        let Some((hair, size)) = foreign::fitted(search, &placings.groom) else { return (Vec::new(), 1.0) };
        return (doubts(&hair, search.head), size * placings.groom.scale);
    }
    if placings.body != body {
        return (Vec::new(), 1.0);
    }
    (doubts(&search.placed(&placings.groom), search.head), 1.0)
}

/// Placements with the place of the groom that is found, given that of the body and the confidence in it.
fn found(search: &Search, grooms: &[&Groom], of_body: Placings) -> Placings {
    let sure = of_body.confidence;
    let Some(found) = search.found().or_else(|| foreign::found(search, unit_alone(grooms))) else {
        let groom = away(search, grooms);
        let is_away = search.hair.is_surely_full() || search.fits(&[groom])[0] > FAR_OFF;
        return Placings { groom, confidence: AWAY, is_away, ..of_body };
    };
    let FoundPlacing { placing, fit, margin, next, is_foreign } = found;
    let astray = if is_foreign { ASTRAY_FOREIGN } else { ASTRAY };
    let fitting = (1.0 - fit / astray).clamp(AWAY, 1.0) * (1.0 - 0.5 * math::exp(-margin));
    let is_turned_patch = !search.hair.is_surely_full() && placing.is_turned_from(&search.same());
    let known = match (is_foreign, is_turned_patch) {
        (true, _) => FOREIGN,
        (_, true) => PATCH,
        _ => 1.0,
    };
    Placings {
        groom: placing,
        is_foreign,
        confidence: sure * fitting * known,
        rival: next.filter(|_| margin < CLOSE),
        ..of_body
    }
}

/// The place of a groom that lies away from the body: in its unit, unless that makes it no hair.
fn away(search: &Search, grooms: &[&Groom]) -> Placing {
    let (same, alone) = (search.same(), unit_alone(grooms));
    let is_hair = grooms.iter().any(|groom| GROOMS.contains(&(same.scale * diagonal(groom.bounds()))));
    let is_given = search.scene.groom.scale != Scale::Auto;
    if is_hair || is_given { same } else { Placing { scale: alone, ..same } }
}

/// The axis that points up in the file of a body that itself shows none, where hair shows another than y.
fn shown_up(sample: &Sample) -> Option<Up> {
    let shown = |up: Up| sample.upness(up.rotation().inverse() * Vec3::Y);
    let [high_y, hangs_y] = shown(Up::Y);
    let others = [Up::Z, Up::MinusY].map(|up| (up, shown(up)));
    // Fur that is combed along z hangs down z, but grows no higher there.
    let is_shown =
        |[high, hangs]: [f32; 2]| high > high_y + HIGHER && high + hangs > high_y + hangs_y + SURER;
    let found = others.into_iter().filter(|(_, found)| is_shown(*found));
    let sum = |found: [f32; 2]| found[0] + found[1];
    found.max_by(|one, two| sum(one.1).total_cmp(&sum(two.1))).map(|(up, _)| up)
}

/// The place of a further groom: given, or that of the first unless another unit or axis brings its roots to the
/// body.
pub(super) fn of_part(groom: &Groom, part: &GroomPart, first: Placing, mesh: Option<&Mesh>) -> Placing {
    let given = |scale: f32| given_unit(part.scale).unwrap_or(scale);
    let turned = |up: Up| if part.up == Up::Auto { upright(up) } else { upright(part.up) };
    let start = Placing {
        scale: given(first.scale),
        turn: if part.up == Up::Auto { first.turn } else { upright(part.up) },
    };
    let Some(mesh) = mesh else { return start };
    let sample = Sample::new(&[groom], mesh);
    let apart = |placing: &Placing| sample.apart(placing.scale, placing.turn, 1.0, Quat::IDENTITY);
    let (mut best, mut least) = (start, apart(&start));
    for unit in UNITS {
        for turn in [start.turn, turned(Up::Y), turned(Up::Z)] {
            let placing = Placing { scale: given(unit), turn };
            let found = apart(&placing);
            if found < NEARER * least && least > NEAR {
                (best, least) = (placing, found);
            }
        }
    }
    best
}

/// Describes a groom and a body \[m\], head space, that do not meet.
pub(super) fn apart(groom: &Groom, mesh: &Mesh) -> Option<String> {
    let (of_groom, of_body) = (groom.bounds(), mesh.bounds()?);
    let low = of_groom.min.max(of_body.min);
    let high = of_groom.max.min(of_body.max);
    let text = |bounds: Aabb| format!("{:.3} to {:.3}", bounds.min, bounds.max);
    let far = (low - high).max_element();
    let sample = Sample::new(&[groom], mesh);
    let roots = sample.apart(1.0, Quat::IDENTITY, 1.0, Quat::IDENTITY);
    let size = diagonal(of_body);
    let what = if far > 0.0 {
        format!("groom and body do not meet: they are {far:.3} m apart")
    } else if roots > 0.1 {
        format!("the roots do not lie on the body: half of them are more than {:.3} m away", roots * size)
    } else {
        return None;
    };
    let mend = "`scale`, `up`, `rotation` and `translation` of [groom] and [body] bring them together";
    Some(format!("{what}; the groom lies in {}, the body in {} m; {mend}", text(of_groom), text(of_body)))
}

/// Placements of grooms and a body whose file's format makes some definitions.
#[cfg(test)]
pub(super) fn of_files(scene: &Scene, grooms: &[&Groom], mesh: Option<&Mesh>, defined: Defined) -> Placings {
    let shown = mesh.map(|mesh| Shown::new(scene, mesh, defined));
    placings(
        scene,
        Strands { grooms, is_defined: false },
        mesh.zip(shown.as_ref()).map(|(mesh, shown)| Body { mesh, shown }),
    )
}

#[cfg(test)]
#[path = "guess_tests.rs"]
mod tests;
