//! Units and axes of a groom and its body, guessed from both together where a scene leaves them open.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec3};
use strandline_base::math;

use crate::{
    Scene,
    body::{Aabb, Mesh},
    groom::{
        Groom,
        format::{Scale, Up},
    },
    scene::GroomPart,
};

/// Metres that a unit of a file may be, likelier ones first.
const UNITS: [f32; 4] = [1.0, 0.01, 0.001, 0.0254];
/// Diagonal of the box around a body \[m\]: a doll to a bear.
const BODIES: std::ops::RangeInclusive<f32> = 0.15..=4.0;
/// Diagonal of the box around a groom without a body \[m\].
const GROOMS: std::ops::RangeInclusive<f32> = 0.05..=2.0;
/// Roots and vertices that are looked at.
const ROOTS: usize = 200;
const VERTICES: usize = 3000;
/// Distance of roots from the body as a share of its size that needs no other guess, and how much nearer another
/// one has to bring them.
const NEAR: f32 = 0.03;
const NEARER: f32 = 0.5;
/// How much higher roots have to lie along z than along y for z to be up, and how much surer it has to be in all.
const HIGHER: f32 = 0.15;
const SURER: f32 = 0.3;
/// Share of the head by which hair has to grow and lead to one side of it for that to be its back.
const BEHIND: f32 = 0.08;

/// Distance from ear to ear \[m\] of the roots on a head: that of a doll to that of a giant, and that of a person, which a
/// head that no unit brings there is given.
const SCALPS: std::ops::RangeInclusive<f32> = 0.09..=0.3;
const SCALP: f32 = 0.15;
/// Hair is that of a head where roots lie as high on the body as this share of it, and lie around as much of what is
/// there: not the fur of an animal, nor its mane.
const ON_TOP: f32 = 0.3;
const AROUND: f32 = 0.6;

/// How a file's places become those of head space: scaled, then turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placing {
    pub scale: f32,
    pub turn: Quat,
}

/// How a groom and a body are placed, and what is to be said of it.
pub(super) struct Placings {
    pub groom: Placing,
    pub body: Placing,
    pub note: Option<String>,
}

/// What leads from a file with an axis that points up to y up.
pub(super) fn upright(up: Up) -> Quat {
    match up {
        Up::Auto | Up::Y => Quat::IDENTITY,
        Up::Z => math::rotation(Vec3::X, -FRAC_PI_2),
    }
}

fn units(scale: Scale) -> Option<f32> {
    match scale {
        Scale::Auto => None,
        Scale::Factor(factor) => Some(factor),
    }
}

fn first_of(diagonal: f32, sizes: &std::ops::RangeInclusive<f32>) -> f32 {
    UNITS.into_iter().find(|unit| sizes.contains(&(unit * diagonal))).unwrap_or(1.0)
}

fn diagonal(bounds: Aabb) -> f32 {
    bounds.min.distance(bounds.max)
}

/// The places of a groom's file and a body's, where there is one of each.
pub(super) fn guess(scene: &Scene, groom: Option<&Groom>, mesh: Option<&Mesh>) -> Placings {
    let (of_groom, of_body) = (&scene.groom, &scene.body);
    let body_diagonal = mesh.and_then(Mesh::bounds).map_or(0.0, diagonal);
    let body_unit = units(of_body.scale).unwrap_or_else(|| first_of(body_diagonal, &BODIES));
    let (Some(groom), Some(mesh)) = (groom, mesh) else {
        let alone = groom.map_or(1.0, |groom| first_of(diagonal(groom.bounds()), &GROOMS));
        let groom = Placing { scale: units(of_groom.scale).unwrap_or(alone), turn: upright(of_groom.up) };
        let body = Placing { scale: body_unit, turn: upright(of_body.up) };
        let note = noted(scene, groom, body, mesh.is_some(), Quat::IDENTITY);
        return Placings { groom, body, note };
    };
    let sample = Sample::new(groom, mesh);
    let [groom_up, body_up] = agreed(scene, &sample, body_unit);
    let mut groom =
        Placing { scale: sample.unit(scene, body_unit, groom_up, body_up), turn: upright(groom_up) };
    let mut body = Placing { scale: body_unit, turn: upright(body_up) };
    let is_free = of_groom.rotation == Vec3::ZERO && of_body.rotation == Vec3::ZERO;
    let turn = if is_free { sample.to_front(&groom, &body) } else { Quat::IDENTITY };
    (groom.turn, body.turn) = (turn * groom.turn, turn * body.turn);
    let is_open = of_groom.scale == Scale::Auto && of_body.scale == Scale::Auto;
    let scalp = sample.scalp(&groom, &body).filter(|width| is_open && !SCALPS.contains(width));
    if let Some(width) = scalp {
        // As a person would write it.
        let digit = math::powf(10.0, math::log10(body.scale * SCALP / width).floor() - 1.0);
        let scale = (body.scale * SCALP / width / digit).round() * digit;
        groom.scale *= scale / body.scale;
        body.scale = scale;
    }
    let mut note = noted(scene, groom, body, true, turn);
    if let (Some(width), Some(note)) = (scalp, &mut note) {
        note.push_str(&format!(
            " (in no usual unit is it the head of a person: the scalp would be {width:.2} m wide)"
        ));
    }
    Placings { groom, body, note }
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
    let sample = Sample::new(groom, mesh);
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

/// The axes that point up: given, or those that agree with each other.
fn agreed(scene: &Scene, sample: &Sample, body_unit: f32) -> [Up; 2] {
    let open = |up: Up| if up == Up::Auto { vec![Up::Y, Up::Z] } else { vec![up] };
    let (of_groom, of_body) = (open(scene.groom.up), open(scene.body.up));
    let pairs: Vec<[Up; 2]> =
        of_groom.iter().flat_map(|one| of_body.iter().map(move |two| [*one, *two])).collect();
    let apart = |pair: &[Up; 2]| {
        let unit = sample.unit(scene, body_unit, pair[0], pair[1]);
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

/// Some roots, tips and vertices of a groom and its body, in units of their files.
struct Sample {
    roots: Vec<Vec3>,
    tips: Vec<Vec3>,
    vertices: Vec<Vec3>,
    bounds: Aabb,
}

impl Sample {
    fn new(groom: &Groom, mesh: &Mesh) -> Self {
        let every = (groom.strand_count() / ROOTS).max(1);
        let strands = || (0..groom.strand_count()).step_by(every);
        let vertices = (mesh.positions.len() / VERTICES).max(1);
        let nothing = Aabb { min: Vec3::ZERO, max: Vec3::ZERO };
        Self {
            roots: strands().map(|strand| groom.strand(strand)[0]).collect(),
            tips: strands().map(|strand| groom.strand(strand)[groom.strand(strand).len() - 1]).collect(),
            vertices: mesh.positions.iter().step_by(vertices).copied().collect(),
            bounds: mesh.bounds().unwrap_or(nothing),
        }
    }

    /// Metres of a unit of the groom: given, or what brings its roots to the body; that of the body where it
    /// does not matter.
    fn unit(&self, scene: &Scene, body_unit: f32, groom_up: Up, body_up: Up) -> f32 {
        if let Some(unit) = units(scene.groom.scale) {
            return unit;
        }
        let apart = |unit| self.apart(unit, upright(groom_up), body_unit, upright(body_up));
        let (mut best, mut least) = (body_unit, apart(body_unit));
        for unit in UNITS {
            let found = apart(unit);
            if found < NEARER * least && least > NEAR {
                (best, least) = (unit, found);
            }
        }
        best
    }

    /// Middle distance of roots from the nearest vertex, as a share of the body's size.
    fn apart(&self, groom_unit: f32, groom_turn: Quat, body_unit: f32, body_turn: Quat) -> f32 {
        let vertices: Vec<Vec3> =
            self.vertices.iter().map(|vertex| body_turn * (body_unit * *vertex)).collect();
        let mut apart: Vec<f32> = self
            .roots
            .iter()
            .map(|root| {
                let root = groom_turn * (groom_unit * *root);
                vertices.iter().map(|vertex| vertex.distance_squared(root)).fold(f32::INFINITY, f32::min)
            })
            .collect();
        apart.sort_by(f32::total_cmp);
        let middle = apart.get(apart.len() / 2).copied().unwrap_or(0.0).sqrt();
        middle / (body_unit * diagonal(self.bounds)).max(f32::MIN_POSITIVE)
    }

    /// What speaks for an axis to point up, each -1 to 1: roots lie high on the body, and strands hang.
    fn upness(&self, axis: Vec3) -> [f32; 2] {
        let count = self.roots.len() as f32;
        let extent = (self.bounds.max - self.bounds.min).dot(axis).max(f32::MIN_POSITIVE);
        let middle = 0.5 * (self.bounds.min + self.bounds.max);
        let high =
            self.roots.iter().map(|root| (*root - middle).dot(axis) / (0.5 * extent)).sum::<f32>() / count;
        let ways = self.roots.iter().zip(&self.tips).map(|(root, tip)| (*root - *tip).normalize_or_zero());
        let hangs = ways.map(|way| way.dot(axis)).sum::<f32>() / count;
        [high.clamp(-1.0, 1.0), hangs]
    }

    /// Width \[m\] of the scalp, where hair is that of a head that looks along z.
    fn scalp(&self, groom: &Placing, body: &Placing) -> Option<f32> {
        let placed = |places: &[Vec3], placing: &Placing| -> Vec<Vec3> {
            places.iter().map(|place| placing.turn * (placing.scale * *place)).collect()
        };
        let between = |mut values: Vec<f32>| {
            values.sort_by(f32::total_cmp);
            let at = |percent: usize| values.get(values.len() * percent / 100).copied();
            at(5).zip(at(95))
        };
        let (roots, vertices) = (placed(&self.roots, groom), placed(&self.vertices, body));
        let (lowest, highest) = between(roots.iter().map(|root| root.y).collect())?;
        let ends = vertices.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), vertex| {
            (low.min(vertex.y), high.max(vertex.y))
        });
        let (left, right) = between(roots.iter().map(|root| root.x).collect())?;
        let beside = vertices.iter().filter(|vertex| (lowest..=highest).contains(&vertex.y));
        let (skull_left, skull_right) = between(beside.map(|vertex| vertex.x).collect())?;
        let is_on_top = lowest - ends.0 > ON_TOP * (ends.1 - ends.0);
        let is_around = right - left > AROUND * (skull_right - skull_left);
        (is_on_top && is_around && right > left).then_some(right - left)
    }

    /// The turn about y after which a head looks along +z, where hair lies to one side of it: at its back.
    fn to_front(&self, groom: &Placing, body: &Placing) -> Quat {
        let roots: Vec<Vec3> = self.roots.iter().map(|root| groom.turn * (groom.scale * *root)).collect();
        let mut heights: Vec<f32> = roots.iter().map(|root| root.y).collect();
        heights.sort_by(f32::total_cmp);
        // The skull is what lies as high as three of four roots: no shoulders, no nape.
        let low = heights.get(heights.len() / 4).copied().unwrap_or(0.0);
        let vertices = self.vertices.iter().map(|vertex| body.turn * (body.scale * *vertex));
        let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let (min, max) = vertices
            .filter(|vertex| vertex.y >= low)
            .fold(start, |(min, max), vertex| (min.min(vertex), max.max(vertex)));
        if min.x > max.x {
            return Quat::IDENTITY;
        }
        let center = roots.iter().sum::<Vec3>() / roots.len().max(1) as f32;
        let size = (max - min).with_y(0.0).max_element().max(f32::MIN_POSITIVE);
        let tips = self.tips.iter().map(|tip| groom.turn * (groom.scale * *tip));
        let combed = tips.zip(&roots).map(|(tip, root)| tip - root).sum::<Vec3>() / roots.len().max(1) as f32;
        // Hair grows at the back, and is combed there.
        let back = (center - 0.5 * (min + max) + combed) / size;
        if back.z.abs() >= back.x.abs() {
            if back.z > BEHIND { math::rotation(Vec3::Y, PI) } else { Quat::IDENTITY }
        } else if back.x.abs() > BEHIND {
            // What is at +x comes to -z, or what is at -x.
            math::rotation(Vec3::Y, FRAC_PI_2.copysign(back.x))
        } else {
            Quat::IDENTITY
        }
    }
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
        let front = turn * Vec3::Z;
        // Half a turn has no sign.
        let degrees = if front.z < -0.999 { 180.0 } else { math::atan2(front.x, front.z).to_degrees() };
        words.push(format!("both are turned by {degrees:.0} degrees to look along +z"));
    }
    let keys = "`scale`, `up`, `rotation` and `translation` of [groom] and [body] say otherwise";
    (!words.is_empty()).then(|| format!("taken from the files: {}; {keys}", words.join(", ")))
}

/// Middle distance of roots from a body, both placed, as a share of the body's size.
pub(super) fn roots_apart(groom: &Groom, mesh: &Mesh, of_groom: &Placing, of_body: &Placing) -> f32 {
    Sample::new(groom, mesh).apart(of_groom.scale, of_groom.turn, of_body.scale, of_body.turn)
}

/// What is wrong with where a groom and a body are \[m\], head space, when they do not meet.
pub(super) fn apart(groom: &Groom, mesh: &Mesh) -> Option<String> {
    let (of_groom, of_body) = (groom.bounds(), mesh.bounds()?);
    let low = of_groom.min.max(of_body.min);
    let high = of_groom.max.min(of_body.max);
    let text = |bounds: Aabb| format!("{:.3} to {:.3}", bounds.min, bounds.max);
    let far = (low - high).max_element();
    let sample = Sample::new(groom, mesh);
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

/// Places a mesh: scaled and turned as guessed, then turned and moved as a scene says.
pub(super) fn place_mesh(mesh: &mut Mesh, placing: Placing, turn: Vec3, translation: Vec3) {
    let turn = math::pitch_yaw_roll(turn) * placing.turn;
    for position in &mut mesh.positions {
        *position = turn * (placing.scale * *position) + translation;
    }
    for normal in &mut mesh.normals {
        *normal = turn * *normal;
    }
}

#[cfg(test)]
#[path = "placing_tests.rs"]
mod tests;
