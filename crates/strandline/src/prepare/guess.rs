//! Units and axes of a groom and its body, guessed from both together where a scene leaves them open.

use glam::{Quat, Vec3};
use strandline_base::math;

use super::{
    head,
    placing::{Placing, Placings, diagonal, upright},
    sample::{NEAR, NEARER, Sample, UNITS},
    skull::Skull,
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
/// Distance from ear to ear \[m\] of the roots on a head: that of a doll to that of a giant, and that of a person, which a
/// head that no unit brings there is given.
const SCALPS: std::ops::RangeInclusive<f32> = 0.09..=0.3;
const SCALP: f32 = 0.15;

fn units(scale: Scale) -> Option<f32> {
    match scale {
        Scale::Auto => None,
        Scale::Factor(factor) => Some(factor),
    }
}

fn first_of(diagonal: f32, sizes: &std::ops::RangeInclusive<f32>) -> f32 {
    UNITS.into_iter().find(|unit| sizes.contains(&(unit * diagonal))).unwrap_or(1.0)
}

/// Placements of the files of a groom, which share theirs, and of a body's files, where there are some of each.
pub(super) fn placings(scene: &Scene, grooms: &[&Groom], mesh: Option<&Mesh>) -> Placings {
    let (of_groom, of_body) = (&scene.groom, &scene.body);
    let body_diagonal = mesh.and_then(Mesh::bounds).map_or(0.0, diagonal);
    let body_unit = units(of_body.scale).unwrap_or_else(|| first_of(body_diagonal, &BODIES));
    let Some(mesh) = mesh.filter(|_| !grooms.is_empty()) else {
        return each_alone(scene, grooms, mesh, body_unit);
    };
    let sample = Sample::new(grooms, mesh);
    let [groom_up, body_up] = agreed(scene, &sample, body_unit);
    let mut groom =
        Placing { scale: unit_of(scene, &sample, body_unit, [groom_up, body_up]), turn: upright(groom_up) };
    let mut body = Placing { scale: body_unit, turn: upright(body_up) };
    let is_free = of_groom.rotation == Vec3::ZERO && of_body.rotation == Vec3::ZERO;
    let turn = if is_free { sample.to_front(&groom, &body) } else { Quat::IDENTITY };
    (groom.turn, body.turn) = (turn * groom.turn, turn * body.turn);
    let is_open = of_groom.scale == Scale::Auto && of_body.scale == Scale::Auto;
    let scalp = sample.scalp(&groom, &body).filter(|width| is_open && !SCALPS.contains(width));
    if let Some(width) = scalp {
        let scale = as_written(body.scale * SCALP / width);
        groom.scale *= scale / body.scale;
        body.scale = scale;
    }
    let mut note = noted(scene, groom, body, true, turn);
    note_strange(&mut note, scalp);
    Placings { groom, body, note }
}

/// The places of a groom without a body, or of a body without one: a style grows on its head.
fn each_alone(scene: &Scene, grooms: &[&Groom], mesh: Option<&Mesh>, body_unit: f32) -> Placings {
    let (of_groom, of_body) = (&scene.groom, &scene.body);
    let bounds = grooms.iter().map(|groom| groom.bounds());
    let bounds = bounds.reduce(|one, two| Aabb { min: one.min.min(two.min), max: one.max.max(two.max) });
    let alone = bounds.map_or(1.0, |bounds| first_of(diagonal(bounds), &GROOMS));
    let groom = Placing { scale: units(of_groom.scale).unwrap_or(alone), turn: upright(of_groom.up) };
    let Some(mesh) = mesh else {
        let body = Placing { scale: body_unit, turn: upright(of_body.up) };
        return Placings { groom, body, note: noted(scene, groom, body, false, Quat::IDENTITY) };
    };
    let up = if of_body.up == Up::Auto { head::up(&mesh.positions) } else { of_body.up };
    let body = Placing { scale: body_unit, turn: upright(up) };
    let is_free = of_body.rotation == Vec3::ZERO;
    let placed: Vec<Vec3> = mesh.positions.iter().map(|place| body.turn * (body.scale * *place)).collect();
    let turn = if is_free { head::front(&placed) } else { None }.unwrap_or(Quat::IDENTITY);
    let mut body = Placing { turn: turn * body.turn, ..body };
    // From ear to ear: a quarter turn makes that of x what was that of z.
    let placed: Vec<Vec3> = placed.iter().map(|place| turn * *place).collect();
    let strange = Skull::of(&placed)
        .map(|skull| skull.size.x)
        .filter(|width| of_body.scale == Scale::Auto && !SCALPS.contains(width));
    if let Some(width) = strange {
        body.scale = as_written(body.scale * SCALP / width);
    }
    let mut note = noted(scene, groom, body, true, turn);
    note_strange(&mut note, strange);
    Placings { groom, body, note }
}

/// A scale of two digits, as a person would write it.
fn as_written(scale: f32) -> f32 {
    let digit = math::powf(10.0, math::log10(scale).floor() - 1.0);
    (scale / digit).round() * digit
}

/// Says of a head of which width \[m\] no usual unit makes that of a person.
fn note_strange(note: &mut Option<String>, width: Option<f32>) {
    if let (Some(width), Some(note)) = (width, note) {
        note.push_str(&format!(
            " (in no usual unit is it the head of a person: the scalp would be {width:.2} m wide)"
        ));
    }
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

/// Metres of a unit of the groom: given, or what brings its roots to the body.
fn unit_of(scene: &Scene, sample: &Sample, body_unit: f32, [groom_up, body_up]: [Up; 2]) -> f32 {
    units(scene.groom.scale).unwrap_or_else(|| sample.unit(body_unit, groom_up, body_up))
}

/// The axes that point up: given, or those that agree with each other.
fn agreed(scene: &Scene, sample: &Sample, body_unit: f32) -> [Up; 2] {
    let open = |up: Up| if up == Up::Auto { vec![Up::Y, Up::Z] } else { vec![up] };
    let (of_groom, of_body) = (open(scene.groom.up), open(scene.body.up));
    let pairs: Vec<[Up; 2]> =
        of_groom.iter().flat_map(|one| of_body.iter().map(move |two| [*one, *two])).collect();
    let apart = |pair: &[Up; 2]| {
        let unit = unit_of(scene, sample, body_unit, *pair);
        sample.apart(unit, upright(pair[0]), body_unit, upright(pair[1]))
    };
    let mut best = pairs[0];
    let mut least = apart(&best);
    for pair in &pairs[1..] {
        let found = apart(pair);
        if found < NEARER * least && least > NEAR {
            (best, least) = (*pair, found);
        }
    }
    // Which of the two axes that both share is up shows in how hair grows and hangs.
    let may_turn = pairs.contains(&[Up::Z, Up::Z]) && best == [Up::Y, Up::Y];
    let ([high_y, hangs_y], [high_z, hangs_z]) = (sample.upness(Vec3::Y), sample.upness(Vec3::Z));
    // Fur that is combed along z hangs down z, but grows no higher there.
    let is_z = high_z > high_y + HIGHER && high_z + hangs_z > high_y + hangs_y + SURER;
    if may_turn && is_z { [Up::Z, Up::Z] } else { best }
}

/// One line of what was chosen; none where nothing was open, or all is as it stands in the files.
fn noted(scene: &Scene, groom: Placing, body: Placing, has_body: bool, turn: Quat) -> Option<String> {
    let mut words = Vec::new();
    let mut say = |what: &str, placing: Placing, open: bool, up: Up| {
        if open && placing.scale != 1.0 {
            words.push(format!("a unit of the {what} is {} m", placing.scale));
        }
        if up == Up::Auto && (turn.inverse() * placing.turn).angle_between(upright(Up::Z)) < 0.1 {
            words.push(format!("z points up in the {what}"));
        }
    };
    if scene.groom.file.is_some() {
        say("groom", groom, scene.groom.scale == Scale::Auto, scene.groom.up);
    }
    if has_body {
        say("body", body, scene.body.scale == Scale::Auto, scene.body.up);
    }
    if turn != Quat::IDENTITY {
        let what = if scene.groom.file.is_some() { "both are" } else { "the body is" };
        let front = turn * Vec3::Z;
        // Half a turn has no sign.
        let degrees = if front.z < -0.999 { 180.0 } else { math::atan2(front.x, front.z).to_degrees() };
        words.push(format!("{what} turned by {degrees:.0} degrees to look along +z"));
    }
    let keys = "`scale`, `up`, `rotation` and `translation` of [groom] and [body] say otherwise";
    (!words.is_empty()).then(|| format!("taken from the files: {}; {keys}", words.join(", ")))
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
