//! The place of a groom on a body: the axes and the unit of its file with which its roots lie on the skin.

use glam::{Quat, Vec3};
use strandline_base::math;

use super::evidence::Hair;
use super::head::{Pose, turns};
use super::placing::{Placing, place_mesh, upright};
use super::sample::FURTHER;
use super::skull::Skull;
use crate::{
    Scene,
    body::{Aabb, Mesh, NearestSurface},
    groom::format::{Scale, UNITS, Up},
};

/// Distance of roots from the skin over their size with which they lie on it, and over that of others below which a
/// place is surely better.
pub(super) const ON_SKIN: f32 = 0.03;
const SURER: f32 = 0.4;
/// Distance of roots from the skin over their size up to which they float above it and belong to it.
const FLOATING: f32 = 0.15;
/// Share of the distance of the farther roots that counts.
const FARTHER: f32 = 0.25;
/// Distance of roots over their size that counts as one piece of evidence, and most pieces.
pub(super) const PIECE: f32 = 0.02;
pub(super) const MOST: f32 = 6.0;
/// Evidence against axes of a full head of hair: of a standard other than the body's own, turned round, and any others.
const OTHER: f32 = 0.5;
const ROUND: f32 = 1.5;
const STRANGE: f32 = 3.0;
/// Evidence against axes of a patch for each step from its body's own: y or z up, -y up, turned round, and any others.
/// Roots on the skin show nothing more by lying nearer to it.
const STEP_OF_PATCH: f32 = ON_SKIN / PIECE + 0.75;
/// Evidence against units that are not usual.
const ODD_UNIT: f32 = 1.0;
/// Advantage of other axes over those of the body's file with which they are taken, where both fit.
const CLEAR: f32 = 1.5;
/// Step between units that are tried, their number, the smallest size of roots over that of the skull, and how far how
/// many of them may reach out of the body's box over its size.
const STEP: f32 = 1.1;
const STEPS: usize = 50;
const SMALLEST: f32 = 0.15;
const OUT: f32 = 0.1;
const MOST_ROOTS: f32 = 0.8;
/// Every n-th strand that is tried with all units, and axes that are then tried with finer ones.
const FEWER: usize = 4;
const AXES: usize = 6;
/// Deviation from a unit up to which a scale found by fitting is taken for it.
const ALIKE: f32 = 0.015;
/// Sizes of hair over that of its body's unit in which it is of another head and of no other unit.
const OTHER_HEADS: std::ops::Range<f32> = 0.75..1.33;

/// A body in head space that hair is brought to.
pub(super) struct Head {
    pub surface: NearestSurface,
    pub bounds: Option<Aabb>,
    pub skull: Option<Skull>,
    pub pose: Pose,
    /// Placement of the body's file.
    pub placing: Placing,
}

impl Head {
    /// A body at its place, turned and moved as a scene says.
    pub fn new(scene: &Scene, mesh: &Mesh, placing: Placing, pose: Pose) -> Self {
        let mut mesh = mesh.clone();
        place_mesh(&mut mesh, placing, scene.body.rotation, scene.body.translation);
        let surface = NearestSurface::new(&mesh);
        Self { surface, bounds: mesh.bounds(), skull: Skull::of_body(&mesh), pose, placing }
    }
}

/// Placing of a groom that a search found.
#[derive(Clone, Copy, Debug)]
pub(super) struct FoundPlacing {
    pub placing: Placing,
    /// Distance of roots from the skin over their size.
    pub fit: f32,
    /// Evidence beyond that of the next place, and that place where there is one.
    pub margin: f32,
    pub next: Option<Placing>,
    /// True where it is fitted to another head than its own.
    pub is_foreign: bool,
}

/// A search for the place of a groom.
#[derive(Clone, Copy)]
pub(super) struct Search<'a> {
    pub scene: &'a Scene,
    /// Strands in units and axes of their file.
    pub hair: &'a Hair,
    /// True where the format of their file defines metres and y up.
    pub is_defined: bool,
    pub head: &'a Head,
}

impl Search<'_> {
    /// The axes and the unit of the groom: those of the body's file where roots then lie on the skin and nothing
    /// speaks against it, others where they alone bring them there. None where nothing does.
    pub fn found(&self) -> Option<FoundPlacing> {
        let same = self.same();
        let fit = self.fits(&[same])[0];
        if fit <= ON_SKIN {
            return Some(self.against(same, fit));
        }
        let is_full = self.hair.is_full(None);
        let better = |tried: Vec<Placing>| {
            let fits = self.fits(&tried);
            let better = tried.into_iter().zip(fits).filter(|(_, found)| *found < ON_SKIN.min(SURER * fit));
            self.best(better.collect())
        };
        let is_open = self.hair.is_surely_full() && self.scene.groom.scale == Scale::Auto;
        if let Some(found) = better(self.usual(is_full)) {
            return Some(if is_full { found } else { self.among_turns(found) });
        }
        // Roots may float a little.
        if fit <= FLOATING {
            return Some(self.against(same, fit));
        }
        let is_unit = |found: &FoundPlacing| {
            let ratio = found.placing.scale / same.scale;
            !OTHER_HEADS.contains(&ratio) || UNITS.contains(&found.placing.scale)
        };
        if is_open { better(self.any_unit()).filter(is_unit) } else { None }
    }

    /// The place that the format of the groom's file defines, or else that of the body's file.
    fn own(&self) -> Placing {
        if self.is_defined { Placing::IDENTITY } else { self.head.placing }
    }

    /// The axes and the unit of the body's file or the groom's format, or those that the scene gives.
    pub fn same(&self) -> Placing {
        let groom = &self.scene.groom;
        let body = self.own();
        let turn = if groom.up == Up::Auto { body.turn } else { upright(groom.up) };
        match groom.scale {
            Scale::Auto => Placing { scale: body.scale, turn },
            Scale::Factor(scale) => Placing { scale, turn },
        }
    }

    /// The place that the body's file gives, or other axes that the roots fit as well and that the hair surely shows.
    fn against(&self, same: Placing, fit: f32) -> FoundPlacing {
        let sure = FoundPlacing { placing: same, fit, margin: MOST, next: None, is_foreign: false };
        let placed = self.placed(&same);
        let Some(skull) = &self.head.skull else { return sure };
        let is_fixed = self.is_defined || self.scene.groom.up != Up::Auto || !self.is_free();
        if is_fixed {
            return sure;
        }
        if !placed.is_full(Some(skull.center())) {
            return self.of_patch(sure, skull);
        }
        let tried: Vec<Placing> = turns().map(|turn| Placing { turn, ..same }).collect();
        let fits = self.fits(&tried);
        let fitting = tried.into_iter().zip(fits).filter(|(_, found)| *found < ON_SKIN.max(2.0 * fit));
        let own = self.evidence(&same, fit);
        match self.best(fitting.collect()) {
            Some(best) if self.evidence(&best.placing, best.fit) > own + CLEAR => best,
            Some(best) if best.placing == same => {
                FoundPlacing { margin: best.margin, next: best.next, ..sure }
            }
            Some(best) => FoundPlacing {
                margin: own + CLEAR - self.evidence(&best.placing, best.fit),
                next: Some(best.placing),
                ..sure
            },
            None => sure,
        }
    }

    /// The place of a patch in the axes of its body's file. Where those are no program's and leave it behind the face, the
    /// usual ones that bring it onto the face are the next place, as likely.
    fn of_patch(&self, sure: FoundPlacing, skull: &Skull) -> FoundPlacing {
        let [y, z] = [Up::Y, Up::Z].map(upright);
        let is_near = |turn: Quat| sure.placing.turn.angle_between(turn) < 0.01;
        let is_ahead = |placing: &Placing| self.placed(placing).is_ahead(skull);
        if !self.head.pose.shows_front || is_near(y) || is_near(z) || is_ahead(&sure.placing) {
            return sure;
        }
        let tried = [y, z].map(|turn| Placing { turn, ..sure.placing });
        let fits = self.fits(&tried);
        let next = tried.into_iter().zip(fits).find(|(placing, fit)| *fit < ON_SKIN && is_ahead(placing));
        next.map_or(sure, |(next, _)| FoundPlacing { margin: 0.0, next: Some(next), ..sure })
    }

    /// True where hair may show the front of groom and body: it is a full head of hair, and a scene turns neither.
    pub fn may_turn_both(&self) -> bool {
        let (groom, body) = (&self.scene.groom, &self.scene.body);
        let is_open = groom.up == Up::Auto && body.up == Up::Auto;
        let is_free = groom.rotation == Vec3::ZERO && body.rotation == Vec3::ZERO;
        let middle = self.head.skull.as_ref().map(Skull::center);
        is_open && is_free && self.placed(&self.same()).is_full(middle)
    }

    fn is_free(&self) -> bool {
        self.scene.groom.rotation == Vec3::ZERO && self.scene.groom.translation == Vec3::ZERO
    }

    /// The strands at a place, turned and moved as the scene says.
    pub fn placed(&self, placing: &Placing) -> Hair {
        let groom = &self.scene.groom;
        let turn = math::pitch_yaw_roll(groom.rotation) * placing.turn;
        self.hair.placed(|point| turn * (placing.scale * point) + groom.translation)
    }

    /// Distances of roots from the skin over their size, for each of some places; infinite for those away from the body.
    pub fn fits(&self, tried: &[Placing]) -> Vec<f32> {
        let Some(bounds) = self.head.bounds else { return vec![f32::INFINITY; tried.len()] };
        let is_within: Vec<bool> = tried.iter().map(|placing| self.is_within(placing, bounds)).collect();
        let near = tried.iter().zip(&is_within).filter(|(_, is_within)| **is_within);
        let hair: Vec<Hair> = near.map(|(placing, _)| self.placed(placing)).collect();
        let mut found = fits(&self.head.surface, &hair).into_iter();
        is_within
            .into_iter()
            .map(|is_within| if is_within { found.next() } else { None }.unwrap_or(f32::INFINITY))
            .collect()
    }

    /// Evidence for a place.
    fn evidence(&self, placing: &Placing, fit: f32) -> f32 {
        let near = |one: Quat, two: Quat| one.angle_between(two) < 0.01;
        let [y, z, down] = [Up::Y, Up::Z, Up::MinusY].map(upright);
        let is_near = |turns: &[Quat]| turns.iter().any(|turn| near(placing.turn, *turn));
        let body = self.own();
        let placed = self.placed(placing);
        let lies = self.head.skull.as_ref().filter(|skull| placed.is_full(Some(skull.center())));
        let lies = lies.map(|skull| placed.on(skull, self.head.pose.shows_front));
        let round = math::rotation(Vec3::Y, std::f32::consts::PI);
        let (of_hair, steps) = if near(placing.turn, body.turn) {
            (0.0, 0.0)
        } else if is_near(&[y, z]) {
            (OTHER, 1.0)
        } else if is_near(&[down]) {
            (OTHER, 2.0)
        } else if is_near(&[round * y, round * z, round * down]) {
            (ROUND, 3.0)
        } else {
            (STRANGE, 4.0)
        };
        let against = if lies.is_some() { of_hair } else { STEP_OF_PATCH * steps };
        let is_usual = UNITS.contains(&placing.scale) || placing.scale == body.scale;
        let unit = if is_usual { 0.0 } else { ODD_UNIT };
        lies.unwrap_or(0.0) - (fit / PIECE).min(MOST) - against - unit
    }

    /// The placing with the most evidence.
    fn best(&self, tried: Vec<(Placing, f32)>) -> Option<FoundPlacing> {
        let mut found: Vec<(f32, Placing, f32)> =
            tried.into_iter().map(|(placing, fit)| (self.evidence(&placing, fit), placing, fit)).collect();
        found.sort_by(|one, two| two.0.total_cmp(&one.0));
        let (evidence, placing, fit) = *found.first()?;
        let other = found.iter().find(|one| one.1.differs(&placing));
        let margin = other.map_or(MOST, |other| evidence - other.0);
        Some(FoundPlacing { placing, fit, margin, next: other.map(|other| other.1), is_foreign: false })
    }

    /// The place of a patch, with the next one of all axes that bring it as near to the skin.
    fn among_turns(&self, found: FoundPlacing) -> FoundPlacing {
        if self.scene.groom.up != Up::Auto || !self.is_free() {
            return found;
        }
        let tried: Vec<Placing> = turns().map(|turn| Placing { turn, ..found.placing }).collect();
        let fits = self.fits(&tried);
        let fitting = tried.into_iter().zip(fits).filter(|(_, fit)| *fit < ON_SKIN);
        match self.best(fitting.collect()) {
            Some(best) if best.placing == found.placing => {
                let is_nearer = best.margin < found.margin;
                let (margin, next) =
                    if is_nearer { (best.margin, best.next) } else { (found.margin, found.next) };
                FoundPlacing { margin, next, ..found }
            }
            Some(best) => FoundPlacing { margin: 0.0, next: Some(best.placing), ..found },
            None => found,
        }
    }

    /// Axes that are tried: all for a full head of hair, the usual ones otherwise; one that the scene gives.
    fn axes(&self, is_full: bool) -> Vec<Quat> {
        match self.scene.groom.up {
            Up::Auto if is_full && self.is_free() => turns().collect(),
            Up::Auto => {
                [self.same().turn].into_iter().chain([Up::Y, Up::Z, Up::MinusY].map(upright)).collect()
            }
            given => vec![upright(given)],
        }
    }

    /// Usual units with the axes that are tried.
    fn usual(&self, is_full: bool) -> Vec<Placing> {
        let scales: Vec<f32> = match self.scene.groom.scale {
            Scale::Auto => [self.same().scale].into_iter().chain(UNITS).collect(),
            Scale::Factor(scale) => vec![scale],
        };
        let axes = self.axes(is_full);
        axes.iter()
            .flat_map(|turn| scales.iter().map(|scale| Placing { scale: *scale, turn: *turn }))
            .collect()
    }

    /// The unit with which roots lie nearest to the skin, for the axes with which they lie near it.
    fn any_unit(&self) -> Vec<Placing> {
        let Some(bounds) = self.head.bounds else { return Vec::new() };
        let width = self.head.skull.map_or(bounds.max.distance(bounds.min), |skull| skull.size.x);
        let smallest = SMALLEST * width / self.hair.size().max(f32::MIN_POSITIVE);
        let scales = (0..STEPS).map(|step| smallest * math::powf(STEP, step as f32));
        let scales: Vec<f32> = scales.collect();
        let tried = self
            .axes(true)
            .into_iter()
            .flat_map(|turn| scales.iter().map(move |scale| Placing { scale: *scale, turn }));
        let tried: Vec<Placing> = tried.collect();
        let fewer = self.hair.fewer(FEWER);
        let mut near = nearest(&tried, &Search { hair: &fewer, ..*self }.fits(&tried));
        near.truncate(AXES);
        let around = |best: &Placing| {
            let Placing { scale, turn } = *best;
            (-10..=10).map(move |step| Placing { scale: scale * math::powf(STEP, 0.1 * step as f32), turn })
        };
        let finer: Vec<Placing> = near.iter().flat_map(around).collect();
        let found = nearest(&finer, &self.fits(&finer)).into_iter();
        found.map(|best| Placing { scale: as_unit(best.scale, self.head.placing.scale), ..best }).collect()
    }

    /// True where most roots reach out of a box by little.
    fn is_within(&self, placing: &Placing, bounds: Aabb) -> bool {
        let out = OUT * bounds.max.distance(bounds.min);
        let groom = &self.scene.groom;
        let turn = math::pitch_yaw_roll(groom.rotation) * placing.turn;
        let is_near = |root: &Vec3| {
            let place = turn * (placing.scale * *root) + groom.translation;
            (bounds.min - place).max(place - bounds.max).max_element() < out
        };
        self.hair.roots().filter(is_near).count() as f32 >= MOST_ROOTS * self.hair.strands.len() as f32
    }
}

/// Distances of roots from a surface over their size, for each of some places of strands.
pub(super) fn fits(surface: &NearestSurface, hair: &[Hair]) -> Vec<f32> {
    let roots: Vec<Vec3> = hair.iter().flat_map(Hair::roots).collect();
    let mut skin = surface.nearest_places(&roots).into_iter();
    let fit = |hair: &Hair| {
        let mut apart: Vec<f32> =
            hair.roots().zip(skin.by_ref()).map(|(root, skin)| root.distance(skin)).collect();
        apart.sort_by(f32::total_cmp);
        let at = |percent: usize| apart.get(apart.len() * percent / 100).copied().unwrap_or(0.0);
        (at(50) + FARTHER * at(80)) / hair.size().max(f32::MIN_POSITIVE)
    };
    hair.iter().map(fit).collect()
}

/// The nearest place of each of some axes, the nearest first.
fn nearest(tried: &[Placing], fits: &[f32]) -> Vec<Placing> {
    let mut order: Vec<usize> = (0..tried.len()).collect();
    order.sort_by(|one, two| fits[*one].total_cmp(&fits[*two]));
    let mut found: Vec<Placing> = Vec::new();
    for index in order {
        if found.iter().all(|other| other.turn != tried[index].turn) {
            found.push(tried[index]);
        }
    }
    found
}

/// A usual unit near a scale found by fitting, or that in three digits.
fn as_unit(scale: f32, body: f32) -> f32 {
    let units = UNITS.into_iter().chain(FURTHER).chain([body]);
    let near = units.into_iter().find(|unit| (scale / unit - 1.0).abs() < ALIKE);
    near.unwrap_or_else(|| {
        let digits = math::powf(10.0, 2.0 - math::log10(scale).floor());
        (scale * digits).round() / digits
    })
}
