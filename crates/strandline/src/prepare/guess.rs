//! Units and axes of a groom and its body, taken from both where a scene leaves them open.

use glam::{Quat, Vec3};
use strandline_base::math;

use super::{
    evidence::Hair,
    foreign, head,
    noted::noted,
    placing::{Defined, Placing, Placings, diagonal, place_mesh, upright},
    relation::{Found, Head, Search},
    sample::{NEAR, NEARER, Sample, UNITS},
    skull::Skull,
    units::{SCALPS, unit_of_width},
};
use crate::{
    Scene,
    body::{Aabb, Mesh},
    groom::{
        Groom,
        format::{Scale, Up},
    },
    scene::GroomPart,
};

/// Diagonal of the box around a body \[m\]: a doll to a bear.
const BODIES: std::ops::RangeInclusive<f32> = 0.15..=4.0;
/// Diagonal of the box around a groom without a body \[m\].
const GROOMS: std::ops::RangeInclusive<f32> = 0.05..=2.0;
/// Least advantage of z over y in the height of roots for z to be up, and in all evidence.
const HIGHER: f32 = 0.15;
const SURER: f32 = 0.3;
/// Evidence beyond that for the axes of a file with which others are taken for a groom without a body.
const SURE_ALONE: f32 = 2.5;
/// Distance of roots over their size at which nothing is left of the confidence in their place.
const ASTRAY: f32 = 0.2;
/// Confidence in a body that shows neither face nor feet, in a person whose face does not show, in hair that is fitted to
/// another head than its own, and in hair away from the body.
const SHAPELESS: f32 = 0.75;
const FACELESS: f32 = 0.9;
const FOREIGN: f32 = 0.8;
const AWAY: f32 = 0.1;
/// Share of the confidence that a doubt leaves.
const DOUBTED: f32 = 0.3;

fn units(scale: Scale) -> Option<f32> {
    match scale {
        Scale::Auto => None,
        Scale::Factor(factor) => Some(factor),
    }
}

fn first_of(diagonal: f32, sizes: &std::ops::RangeInclusive<f32>) -> f32 {
    UNITS.into_iter().find(|unit| sizes.contains(&(unit * diagonal))).unwrap_or(1.0)
}

/// Metres of a unit of a groom alone.
pub(super) fn unit_alone(grooms: &[&Groom]) -> f32 {
    let bounds = grooms.iter().map(|groom| groom.bounds());
    let bounds = bounds.reduce(|one, two| Aabb { min: one.min.min(two.min), max: one.max.max(two.max) });
    bounds.map_or(1.0, |bounds| first_of(diagonal(bounds), &GROOMS))
}

/// Placements of the files of a groom, which share theirs, and of a body's files, where there are some of each.
pub(super) fn placings(scene: &Scene, grooms: &[&Groom], mesh: Option<&Mesh>, defined: Defined) -> Placings {
    match mesh {
        None => hair_alone(scene, grooms),
        Some(mesh) if grooms.is_empty() => body_alone(scene, mesh, defined),
        Some(mesh) => together(scene, grooms, mesh, defined),
    }
}

/// The place of a groom without a body.
fn hair_alone(scene: &Scene, grooms: &[&Groom]) -> Placings {
    let given = &scene.groom;
    let hair = Hair::new(grooms);
    let is_free = given.up == Up::Auto && given.rotation == Vec3::ZERO;
    let shown = if is_free && hair.is_full(None) { shown_alone(&hair) } else { None };
    let turn = shown.unwrap_or_else(|| upright(given.up));
    let scale = units(given.scale).unwrap_or_else(|| unit_alone(grooms));
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
fn body_alone(scene: &Scene, mesh: &Mesh, defined: Defined) -> Placings {
    let (body, pose, width) = of_body(scene, mesh, defined);
    let placings = Placings { body, ..Placings::new(confidence_of(scene, defined, &pose)) };
    Placings { notes: noted(scene, &placings, true, width), ..placings }
}

/// The place of a body, the pose that it shows, and the width \[m\] of a head that no usual unit makes that of a person.
fn of_body(scene: &Scene, mesh: &Mesh, defined: Defined) -> (Placing, head::Pose, Option<f32>) {
    let given = &scene.body;
    let ups = match (given.up, defined) {
        (Up::Auto, Defined::Nothing) => head::UPS.to_vec(),
        (Up::Auto, Defined::Up | Defined::All) => vec![Up::Y],
        (up, _) => vec![up],
    };
    let mut pose = head::pose(mesh, &ups);
    // An axis that is given names the front too, and a turn that is given is that of the file's own axes.
    if given.up != Up::Auto || defined == Defined::All {
        (pose.turn, pose.shows_front, pose.is_sure) = (upright(ups[0]), true, true);
    } else if given.rotation != Vec3::ZERO {
        (pose.turn, pose.shows_front) = (pose.up.rotation(), true);
    }
    let (turn, diagonal) = (pose.turn, mesh.bounds().map_or(0.0, diagonal));
    let given = units(given.scale).or((defined != Defined::Nothing).then_some(1.0));
    let scale = given.unwrap_or_else(|| first_of(diagonal, &BODIES));
    let mut upright = mesh.clone();
    place_mesh(&mut upright, Placing { scale, turn }, Vec3::ZERO, Vec3::ZERO);
    let width = Skull::of_body(&upright).map(|skull| skull.size.x / scale);
    let width = width.filter(|width| given.is_none() && !SCALPS.contains(&(scale * width)));
    match width.filter(|_| pose.is_person) {
        Some(width) => {
            let (scale, strange) = unit_of_width(width, scale);
            (Placing { scale, turn }, pose, strange)
        }
        None => (Placing { scale, turn }, pose, None),
    }
}

/// Confidence in the place of a body.
fn confidence_of(scene: &Scene, defined: Defined, pose: &head::Pose) -> f32 {
    match (scene.body.up, defined) {
        (Up::Auto, Defined::Nothing | Defined::Up) if !pose.is_sure => SHAPELESS,
        (Up::Auto, Defined::Nothing | Defined::Up) if !pose.shows_front => FACELESS,
        _ => 1.0,
    }
}

/// The places of a groom and a body.
fn together(scene: &Scene, grooms: &[&Groom], mesh: &Mesh, defined: Defined) -> Placings {
    let (mut body, pose, mut strange) = of_body(scene, mesh, defined);
    let (hair, sample) = (Hair::new(grooms), Sample::new(grooms, mesh));
    if !pose.is_sure && scene.groom.up == Up::Auto && shows_z(&sample) {
        body.turn = upright(Up::Z);
    }
    let head = Head::new(scene, mesh, body, pose);
    let search = Search { scene, hair: &hair, head: &head };
    let found = search.found();
    let sure = confidence_of(scene, defined, &pose);
    let mut placings = Placings { body, ..Placings::new(sure) };
    match found.or_else(|| foreign::found(&search, unit_alone(grooms))) {
        Some(Found { placing, fit, margin, is_foreign }) => {
            let fitting = (1.0 - fit / ASTRAY).clamp(AWAY, 1.0) * (1.0 - 0.5 * math::exp(-margin));
            let known = if is_foreign { FOREIGN } else { 1.0 };
            (placings.groom, placings.is_foreign) = (placing, is_foreign);
            placings.confidence = sure * fitting * known;
        }
        None => (placings.groom, placings.confidence) = (away(&search, grooms), AWAY),
    }
    let is_faceless = pose.is_person == pose.is_sure && !pose.shows_front;
    if placings.groom.turn == body.turn && is_faceless && search.may_turn_both() {
        let turn = sample.to_front(&placings.groom, &body);
        let turned = |placing: Placing| Placing { turn: turn * placing.turn, ..placing };
        let (groom, body) = (turned(placings.groom), turned(body));
        if sample.scalp(&groom, &body).is_some() {
            (placings.groom, placings.body) = (groom, body);
        }
    }
    let is_open = scene.groom.scale == Scale::Auto && scene.body.scale == Scale::Auto;
    let is_guessed = is_open && defined == Defined::Nothing && !pose.is_person && !placings.is_foreign;
    let scalp = sample.scalp(&placings.groom, &placings.body);
    if let Some(width) = scalp.filter(|width| is_guessed && !SCALPS.contains(width)) {
        let (scale, odd) = unit_of_width(width / body.scale, body.scale);
        placings.groom.scale *= scale / body.scale;
        (placings.body.scale, strange) = (scale, odd);
    }
    let mut notes = noted(scene, &placings, true, strange);
    if !placings.is_foreign && placings.body == body {
        let doubts = search.doubts(&placings.groom);
        placings.confidence *= math::powf(DOUBTED, doubts.len() as f32);
        notes.extend(doubts);
    }
    Placings { notes, ..placings }
}

/// The place of a groom that lies away from the body: in its unit, unless that makes it no hair.
fn away(search: &Search, grooms: &[&Groom]) -> Placing {
    let (same, alone) = (search.same(), unit_alone(grooms));
    let is_hair = grooms.iter().any(|groom| GROOMS.contains(&(same.scale * diagonal(groom.bounds()))));
    let is_given = search.scene.groom.scale != Scale::Auto;
    if is_hair || is_given { same } else { Placing { scale: alone, ..same } }
}

/// True where hair shows that z points up in the file of a body that itself does not show an axis.
fn shows_z(sample: &Sample) -> bool {
    let ([high_y, hangs_y], [high_z, hangs_z]) = (sample.upness(Vec3::Y), sample.upness(Vec3::Z));
    // Fur that is combed along z hangs down z, but grows no higher there.
    high_z > high_y + HIGHER && high_z + hangs_z > high_y + hangs_y + SURER
}

/// The place of a further groom: given, or that of the first unless another unit or axis brings its roots to the
/// body.
pub(super) fn of_part(groom: &Groom, part: &GroomPart, first: Placing, mesh: Option<&Mesh>) -> Placing {
    let given = |scale: f32| units(part.scale).unwrap_or(scale);
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

#[cfg(test)]
#[path = "guess_tests.rs"]
mod tests;
