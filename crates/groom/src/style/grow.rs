//! Grows strands step by step from their roots over the skull and down.

use std::sync::Arc;

use glam::Vec3;
use strandline_base::math;
use strandline_base::memory::{self, Need};
use strandline_base::par::prelude::*;
use strandline_body::{Mannequin, Random, Root, Scalp, SignedDistance};

use super::comb::{Combed, StrandEnd, TIE_RADIUS, fringe_end, smooth};
use super::face;
use super::hair;
use super::locks::{self, Shaped};
use super::skin::Skin;
use super::strand::{CLEARANCE, Strand, WIDTH, beside_parting};
use super::{Style, StyleSettings, finish};
use crate::arcs::equal_arcs;
use crate::{Groom, GroomError, Widths};

/// Length of a step \[m\].
const STEP: f32 = 0.004;
/// Share of the old direction kept in each step: hair is stiff.
const STIFFNESS: f32 = 0.72;
/// The same of hair that is wound or plaited.
const WOUND: f32 = 0.35;
/// Way \[m\] over which hair rises from its root to the full thickness of the hair.
const RISE: f32 = 0.10;

/// A dome over the ear: centre on the side of positive x and half axes \[m\].
const EAR_DOME: (Vec3, Vec3) = (Vec3::new(0.062, -0.026, -0.012), Vec3::new(0.033, 0.056, 0.050));
/// Height \[m\] over which the cut of a fringe is spread.
const FRINGE_UNEVEN: f32 = 0.006;
/// Blend of the dome and the skin \[m\].
const DOME_REACH: f32 = 0.016;

impl StyleSettings {
    /// Grows the style on the built-in mannequin: `strand_count` strands.
    ///
    /// # Errors
    /// A setting outside its range; more memory than may be taken.
    pub fn grow(&self) -> Result<Groom, GroomError> {
        self.grow_hair(self.strand_count)
    }

    /// Grows the style with `drawn` strands of hair. The first `strand_count` are those of [`StyleSettings::grow`] and
    /// marked as guides; the others lie between them, each with a curve of its own. Strands beside the hair come on top.
    ///
    /// # Errors
    /// As [`StyleSettings::grow`].
    pub fn grow_hair(&self, drawn: usize) -> Result<Groom, GroomError> {
        self.grow_on(Mannequin::new(), drawn)
    }

    /// As [`StyleSettings::grow_hair`], on a mannequin of another build or with closed eyes: beards and lashes differ there.
    /// Behind the `drawn` strands follow those of [`StyleSettings::beside`], some of them marked as guides.
    ///
    /// # Errors
    /// As [`StyleSettings::grow`].
    pub fn grow_on(&self, mannequin: Arc<Mannequin>, drawn: usize) -> Result<Groom, GroomError> {
        self.validate()?;
        memory::check(&[self.memory(drawn)])?;
        let mut groom = self.grow_own(&mannequin, drawn);
        self.grow_beside(&mannequin, drawn.max(self.strand_count), &mut groom);
        Ok(groom)
    }

    /// The hair alone.
    fn grow_own(&self, mannequin: &Arc<Mannequin>, drawn: usize) -> Groom {
        let more = drawn.saturating_sub(self.strand_count);
        if self.style.is_of_face() {
            let grown = face::strands(self, &Skin::new(mannequin.clone()), self.strand_count.max(drawn));
            let grown = grown.into_iter().map(|strand| Grown::new(strand, 0));
            let mut groom = groom(grown.collect(), self.strand_count);
            // Beside hair of other files it is named.
            groom.group_names = [(0, self.style.name().to_owned())].into();
            return groom;
        }
        let skin = Skin::new(mannequin.clone());
        let scalp = mannequin.scalp();
        let roots = scalp.roots(self.strand_count, self.seed);
        let combed: Vec<Strand> = roots
            .into_par_iter()
            .enumerate()
            .map(|(index, root)| march(self, &skin, index, beside_parting(self, mannequin, root)))
            .collect();
        let (guides, clumps) = finish::finish(self, &skin, &scalp, &combed);
        let mut grown: Vec<Grown> =
            guides.into_iter().zip(&clumps).map(|(strand, clump)| Grown::new(strand, *clump)).collect();
        if more > 0 {
            for (index, guide) in grown.iter_mut().enumerate() {
                let thick = Random::new(self.seed, 17_000_000_000 + index as u64).unit();
                guide.width = locks::width(thick, hair::density(self, &scalp, &guide.strand.root));
            }
            let hair = hair::between(self, mannequin, &scalp, &combed, more);
            let shaped = locks::shape(self, &skin, &combed, &clumps, &hair);
            grown.extend(hair.into_iter().zip(shaped).map(|(own, Shaped { points, width })| Grown {
                width,
                ..Grown::new(Strand { points, ..own.strand }, clumps[own.guide])
            }));
        }
        // Some were moved after their coordinates were found.
        grown.iter_mut().map(|one| &mut one.strand.root).for_each(|root| root.uv = Scalp::uv(root.position));
        groom(grown, self.strand_count)
    }
}

/// A grown strand with its diameter \[m\] and its lock.
struct Grown {
    strand: Strand,
    width: f32,
    clump: u32,
}

impl Grown {
    fn new(strand: Strand, clump: u32) -> Self {
        Self { strand, width: WIDTH, clump }
    }
}

/// The groom of strands; the first are guides, and marked where there are others.
fn groom(grown: Vec<Grown>, guide_count: usize) -> Groom {
    let mut groom = Groom::empty(WIDTH);
    groom.starts.reserve_exact(grown.len());
    groom.points.reserve_exact(grown.iter().map(|one| one.strand.points.len()).sum());
    for one in &grown {
        groom.push(one.strand.points.iter().copied());
    }
    groom.widths = Widths::Constant(WIDTH);
    if grown.len() > guide_count {
        groom.widths = Widths::PerStrand(grown.iter().map(|one| one.width).collect());
        groom.guide_flags = Some((0..grown.len()).map(|strand| strand < guide_count).collect());
    }
    groom.root_uvs = Some(grown.iter().map(|one| one.strand.root.uv).collect());
    groom.root_normals = Some(grown.iter().map(|one| one.strand.root.normal).collect());
    groom.groups = Some(grown.iter().map(|one| one.clump).collect());
    groom
}

impl StyleSettings {
    /// Upper estimate of the memory for growing a number of strands: each as marched, as shaped, and as part of the groom.
    pub fn memory(&self, drawn: usize) -> Need {
        let marched = 2 * (self.length / STEP).ceil() as u64;
        let each = 12 * (marched + 2 * self.points() as u64) + 3 * size_of::<Strand>() as u64;
        let own = drawn.max(self.strand_count);
        let count = own + self.strands_beside(own);
        let key = if drawn > self.strand_count { "groom.bound" } else { "style.strand_count" };
        Need::new(format!("{key} = {own}"), count as u64, each)
    }
}

/// One strand, from its root to where it is cut.
fn march(settings: &StyleSettings, skin: &Skin, index: usize, root: Root) -> Strand {
    let mut random = Random::new(settings.seed, 1000 + index as u64);
    let [chance, variation, depth, cut] = std::array::from_fn(|_| random.unit());
    let place = math::unit_at(std::f32::consts::TAU * random.unit()) * random.unit().sqrt();
    let mut combed = Combed::new(root, settings, place, chance);
    let length =
        settings.length * (1.0 - settings.length_variation * variation) * style_length(settings, &root);
    let crown = smooth(-0.06, 0.10, root.position.y);
    let cut_height = match combed.is_fringe() {
        true => fringe_end(settings) + FRINGE_UNEVEN * cut,
        false => settings.cut_height + settings.layering * (0.6 * crown + 0.4 * cut),
    };
    // Hair from higher up lies over hair from below, and every hair has its depth in its layer.
    let lies = if combed.is_fringe() { 0.5 } else { 1.0 };
    let thickness = lies * settings.volume * (0.25 + 0.75 * depth) * (0.7 + 3.0 * root.position.y.max(0.0));
    let (mut points, mut point) = (vec![root.position], root.position);
    let mut direction = leaving(settings, &combed);
    let mut passed_tie = 0.0;
    let steps = (length / STEP).ceil() as usize;
    let mut above = covered(settings, point, skin.mannequin().distance_and_gradient(point));
    for step in 1..=steps {
        let (distance, out) = above;
        let place = StrandEnd { point, distance, out, passed: passed_tie };
        let wanted = combed.direction(settings, place).normalize_or(Vec3::NEG_Y);
        let kept = if combed.tied && settings.style != Style::Ponytail { WOUND } else { STIFFNESS };
        direction = (direction * kept + wanted * (1.0 - kept)).normalize_or(wanted);
        let rise = smooth(0.0, RISE, step as f32 * STEP);
        let clearance = if combed.tied { CLEARANCE } else { CLEARANCE + thickness * rise };
        // A direction into the skin is turned along it before the hair comes too near.
        let into = -direction.dot(out);
        if distance < clearance + STEP && into > 0.0 {
            direction = (direction + out * into).normalize_or(wanted);
        }
        let before = point;
        let least = clearance.min(distance + 0.5 * STEP).max(CLEARANCE);
        (point, above) = uncovered(settings, skin, point + direction * STEP, least);
        direction = (point - before).normalize_or(direction);
        points.push(point);
        combed.pass(point);
        if settings.style.is_tied() {
            let left = combed.tie().distance(point);
            combed.tied |= left < 1.2 * TIE_RADIUS;
            passed_tie += if combed.tied { STEP } else { 0.0 };
        }
        if point.y < cut_height && points.len() > 4 {
            break;
        }
    }
    smooth_out(&mut points, skin);
    let points = equal_arcs(&points, settings.points()).collect();
    Strand { root, side: combed.side, points }
}

/// Direction in which a strand leaves the skin.
fn leaving(settings: &StyleSettings, combed: &Combed) -> Vec3 {
    let normal = combed.root.normal;
    let place = StrandEnd { point: combed.root.position, distance: 0.0, out: normal, passed: 0.0 };
    let flow = combed.direction(settings, place).normalize_or(normal);
    let lift = if settings.style.is_tied() { 0.25 } else { 0.6 };
    // Beside the parting hair rises before it falls to its side, which hides the skin.
    let beside = if settings.style.is_parted() && !combed.is_fringe() {
        smooth(0.012, 0.0, (combed.root.position.x - settings.parting).abs())
            * smooth(-0.02, 0.03, combed.root.position.y)
    } else {
        0.0
    };
    (normal * (lift + 0.45 * beside) + flow * (1.0 - 0.6 * beside)).normalize_or(normal)
}

/// Shorter at the nape and the sides in short styles, the same everywhere else.
fn style_length(settings: &StyleSettings, root: &Root) -> f32 {
    match settings.style {
        Style::Pixie => 0.45 + 0.55 * smooth(-0.06, 0.06, root.position.y),
        _ => 1.0,
    }
}

/// Distance \[m\] and direction away from the skin, ears smoothed over where hair falls across them, from those of the
/// skin itself.
fn covered(settings: &StyleSettings, point: Vec3, (distance, out): (f32, Vec3)) -> (f32, Vec3) {
    if !settings.style.is_parted() || settings.leads_behind_ears() {
        return (distance, out);
    }
    let side = Vec3::new(point.x.signum(), 1.0, 1.0);
    let unit = (point - EAR_DOME.0 * side) / EAR_DOME.1;
    let size = unit.length().max(1e-3);
    let slope = unit / EAR_DOME.1 / size;
    let dome = (size - 1.0) / slope.length();
    let overlap = (1.0 - (dome - distance).abs() / DOME_REACH).max(0.0);
    let share = if dome < distance { 1.0 - 0.5 * overlap * overlap } else { 0.5 * overlap * overlap };
    let joined = distance.min(dome) - DOME_REACH * overlap * overlap * overlap / 6.0;
    (joined, out.lerp(slope.normalize(), share).normalize_or(out))
}

/// Moves a point out of the body and of the domes over the ears: the point, and what [`covered`] says there.
fn uncovered(settings: &StyleSettings, skin: &Skin, point: Vec3, clearance: f32) -> (Vec3, (f32, Vec3)) {
    let above = covered(settings, point, skin.mannequin().distance_and_gradient(point));
    let (distance, out) = above;
    // The domes only come nearer than the skin.
    if distance >= clearance {
        return (point, above);
    }
    let (moved, skin_there) = skin.led_outside(point + out * (clearance - distance), clearance);
    (moved, covered(settings, moved, skin_there))
}

/// Takes the corners out of a strand without drawing it into the body; the root stays.
fn smooth_out(points: &mut [Vec3], skin: &Skin) {
    for pass in 1..=8 {
        let mut before = points[0];
        for index in 1..points.len().saturating_sub(1) {
            let here = points[index];
            let middle = 0.25 * before + 0.5 * here + 0.25 * points[index + 1];
            before = here;
            // A pass moves a point by less than a tenth of a millimetre into the skull.
            points[index] = if pass % 4 == 0 { skin.outside(middle, CLEARANCE) } else { middle };
        }
    }
}
