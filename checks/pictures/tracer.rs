//! A path tracer of hair on a ball that shares nothing with the renderer but the lobes of a fibre: light by how often it
//! was scattered.
//!
//! A hair is a ribbon that faces each ray, and is met at a random offset across its width. Each scattering adds the
//! straight light that reaches it, and picks the next direction as the fibre shows it. Only red light is traced.

use std::f64::consts::{PI, TAU};

use glam::{IVec3, Vec3};
use rayon::prelude::*;
use strandline_body::Random;
use strandline_render::fibre::Chiang;
use strandline_render::fibre::chiang::{LOBES, Lobes};

use crate::light::Scene;

/// Most scatterings of a path.
pub const ORDERS: usize = 400;
/// Paths that share random numbers.
const RUN: u32 = 2048;
/// Radius of the ball, of a hair's root, and size of a cell of hairs \[m\].
const BALL: f32 = 0.09;
const ROOT: f32 = 2e-4;
const CELL: f32 = 0.003;
/// Distance \[m\] within which a ray meets nothing.
const NEAR: f32 = 1e-5;
/// Irradiance of the light on a surface that faces it.
const IRRADIANCE: f64 = 3.0;

/// A piece of a hair: its ends and radius \[m\].
struct Piece {
    start: Vec3,
    end: Vec3,
    radius: f32,
}

/// Hairs on a ball, in cells.
struct Hairs {
    pieces: Vec<Piece>,
    low: Vec3,
    counts: IVec3,
    /// First number of each cell in `list`, and the pieces in the cells.
    first: Vec<usize>,
    list: Vec<usize>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Met {
    Piece(usize),
    Ball,
}

#[derive(Clone, Copy)]
struct Ray {
    start: Vec3,
    way: Vec3,
    /// The piece that it leaves: it and its neighbours are not met.
    from: Option<usize>,
}

impl Hairs {
    fn new(scene: &Scene) -> Self {
        let (strands, count) = (scene.guides.strand_count(), scene.guides.points_per_strand());
        let piece = |strand: usize, point: usize| {
            let along = (point as f32 + 0.5) / (count - 1) as f32;
            let [start, end] = [point, point + 1].map(|point| scene.guides.position(strand, point));
            Piece { start, end, radius: ROOT * (1.0 - 0.5 * along.powi(3)) }
        };
        let pieces: Vec<Piece> =
            (0..strands).flat_map(|strand| (0..count - 1).map(move |point| piece(strand, point))).collect();
        let low = pieces.iter().fold(Vec3::MAX, |low, piece| low.min(piece.start).min(piece.end)) - CELL;
        let high = pieces.iter().fold(Vec3::MIN, |high, piece| high.max(piece.start).max(piece.end)) + CELL;
        let counts = ((high - low) / CELL).ceil().as_ivec3();
        let mut cells = vec![Vec::new(); counts.element_product() as usize];
        for (index, piece) in pieces.iter().enumerate() {
            let cell = |place: Vec3| ((place - low) / CELL).as_ivec3().clamp(IVec3::ZERO, counts - 1);
            let first = cell(piece.start.min(piece.end) - piece.radius);
            let last = cell(piece.start.max(piece.end) + piece.radius);
            for z in first.z..=last.z {
                for y in first.y..=last.y {
                    (first.x..=last.x).for_each(|x| cells[number(IVec3::new(x, y, z), counts)].push(index));
                }
            }
        }
        let mut first = vec![0];
        first.extend(cells.iter().scan(0, |sum, cell| {
            *sum += cell.len();
            Some(*sum)
        }));
        Self { pieces, low, counts, first, list: cells.concat() }
    }

    /// The nearest thing that a ray meets, and its distance \[m\].
    fn met(&self, ray: &Ray) -> Option<(f32, Met)> {
        let mut best = ball(ray);
        let high = self.low + self.counts.as_vec3() * CELL;
        let inverse = ray.way.recip();
        let (one, other) = ((self.low - ray.start) * inverse, (high - ray.start) * inverse);
        let begin = one.min(other).max_element().max(0.0);
        if begin >= one.max(other).min_element() {
            return best;
        }
        let place = ray.start + ray.way * begin;
        let mut cell = ((place - self.low) / CELL).as_ivec3().clamp(IVec3::ZERO, self.counts - 1);
        let step = ray.way.signum().as_ivec3();
        let border = self.low + (cell + step.max(IVec3::ZERO)).as_vec3() * CELL;
        let mut exits = (border - ray.start) * inverse;
        loop {
            let at = number(cell, self.counts);
            for &index in &self.list[self.first[at]..self.first[at + 1]] {
                let near = self.meets(ray, index).filter(|at| best.is_none_or(|(best, _)| *at < best));
                best = near.map(|at| (at, Met::Piece(index))).or(best);
            }
            let exit = exits.min_element();
            if best.is_some_and(|(best, _)| best <= exit) {
                return best;
            }
            let axis = if exits.x == exit { 0 } else { 1 + usize::from(exits.y != exit) };
            cell[axis] += step[axis];
            exits[axis] += (CELL * inverse[axis]).abs();
            if !(0..self.counts[axis]).contains(&cell[axis]) {
                return best;
            }
        }
    }

    /// Distance \[m\] at which a ray meets a piece.
    fn meets(&self, ray: &Ray, index: usize) -> Option<f32> {
        if ray.from.is_some_and(|from| from.abs_diff(index) <= 1) {
            return None;
        }
        let piece = &self.pieces[index];
        let (long, aside) = (piece.end - piece.start, piece.start - ray.start);
        let (slant, ahead) = (ray.way.dot(long), ray.way.dot(aside));
        let across = long.length_squared() - slant * slant;
        if across < 1e-16 {
            return None;
        }
        let share = ((slant * ahead - long.dot(aside)) / across).clamp(0.0, 1.0);
        let at = ahead + share * slant;
        let apart = aside + long * share - ray.way * at;
        (at > NEAR && apart.length_squared() < piece.radius * piece.radius).then_some(at)
    }
}

/// Number of a cell among so many along each axis.
fn number(cell: IVec3, counts: IVec3) -> usize {
    ((cell.z * counts.y + cell.y) * counts.x + cell.x) as usize
}

/// Distance \[m\] at which a ray meets the ball.
fn ball(ray: &Ray) -> Option<(f32, Met)> {
    let ahead = -ray.start.dot(ray.way);
    let square = ahead * ahead - ray.start.length_squared() + BALL * BALL;
    let at = ahead - square.max(0.0).sqrt();
    (square > 0.0 && at > NEAR).then_some((at, Met::Ball))
}

/// A fibre, and how its lobes are picked from.
struct Fibre {
    lobes: Lobes,
    absorption: f64,
    index: f64,
    variances: [f64; LOBES],
    /// Scale of the logistic distribution of the turn.
    scale: f64,
}

impl Fibre {
    fn new(chiang: &Chiang) -> Self {
        // [Chiang2016 §4.1]
        let [along, around] = [chiang.roughness_along, chiang.roughness_around].map(f64::from);
        let root = 0.726 * along + 0.812 * along * along + 3.7 * along.powi(20);
        let turn = 0.265 * around + 1.194 * around * around + 5.372 * around.powi(22);
        Self {
            lobes: chiang.lobes(),
            absorption: chiang.absorption(Vec3::ONE)[0],
            index: f64::from(chiang.index),
            variances: [1.0, 0.25, 4.0, 4.0].map(|times| times * root * root),
            scale: (PI / 8.0).sqrt() * turn,
        }
    }

    /// Inclination \[rad\] and turn of the light that a path of a random kind brings to an eye's inclination, seen at an
    /// offset; none where the fibre takes it.
    fn pick(&self, eye: f64, offset: f64, mut random: impl FnMut() -> f64) -> Option<[f64; 2]> {
        let shares = self.lobes.shares(eye, offset, [self.absorption]);
        let mut left = random();
        let lobe = shares.iter().position(|[share]| {
            left -= share;
            left < 0.0
        })?;
        let (tilted, variance) = (self.lobes.tilted(eye)[lobe], self.variances[lobe]);
        let part = random();
        let cosine = 1.0 + variance * (part + (1.0 - part) * (-2.0 / variance).exp()).ln();
        let aside = (1.0 - cosine * cosine).max(0.0).sqrt() * (TAU * random()).cos();
        let inclination = (aside * tilted.cos() - cosine * tilted.sin()).clamp(-1.0, 1.0).asin();
        if lobe == LOBES - 1 {
            return Some([inclination, TAU * random()]);
        }
        let bent = (self.index * self.index - eye.sin().powi(2)).sqrt() / eye.cos().max(1e-6);
        let kind = lobe as f64;
        let straight = 2.0 * kind * (offset / bent).clamp(-1.0, 1.0).asin() - 2.0 * offset.asin() + kind * PI;
        let least = 1.0 / (1.0 + (PI / self.scale).exp());
        let cumulated = least + random() * (1.0 - 2.0 * least);
        Some([inclination, straight - self.scale * (1.0 / cumulated - 1.0).ln()])
    }
}

/// A picture's hairs in straight light.
struct Lit<'a> {
    hairs: &'a Hairs,
    fibre: Fibre,
    skin: f32,
    to_light: Vec3,
}

impl Lit<'_> {
    /// True if straight light comes to a place.
    fn open(&self, start: Vec3, from: Option<usize>) -> bool {
        self.hairs.met(&Ray { start, way: self.to_light, from }).is_none()
    }

    /// Follows a path back from the eye, and adds to the light of each order.
    fn follow(&self, mut ray: Ray, random: &mut Random, orders: &mut [f64]) {
        for light in orders {
            let Some((at, met)) = self.hairs.met(&ray) else { return };
            let place = ray.start + ray.way * at;
            let next = match met {
                Met::Ball => self.on_skin(place, random, light),
                Met::Piece(piece) => self.on_hair(piece, place, -ray.way, random, light),
            };
            let Some(next) = next else { return };
            ray = next;
        }
    }

    fn on_skin(&self, place: Vec3, random: &mut Random, light: &mut f64) -> Option<Ray> {
        let normal = place.normalize();
        let start = place + normal * (2.0 * NEAR);
        let facing = normal.dot(self.to_light);
        if facing > 0.0 && self.open(start, None) {
            *light += f64::from(self.skin * facing) * IRRADIANCE / PI;
        }
        let (height, turn) = (random.signed(), random.unit() * TAU as f32);
        let flat = (1.0 - height * height).sqrt();
        let way = (normal + Vec3::new(flat * turn.cos(), flat * turn.sin(), height)).normalize();
        (random.unit() < self.skin).then_some(Ray { start, way, from: None })
    }

    fn on_hair(
        &self,
        piece: usize,
        start: Vec3,
        to_eye: Vec3,
        random: &mut Random,
        light: &mut f64,
    ) -> Option<Ray> {
        let Piece { start: root, end, .. } = self.hairs.pieces[piece];
        let t = (end - root).normalize();
        let u = (to_eye - t * t.dot(to_eye)).normalize();
        let v = t.cross(u);
        let sine = |way: Vec3| f64::from(t.dot(way)).clamp(-1.0, 1.0).asin();
        let (eye, offset) = (sine(to_eye), f64::from(random.signed()));
        if self.open(start, Some(piece)) {
            let turn = f64::from(v.dot(self.to_light)).atan2(f64::from(u.dot(self.to_light)));
            let shown =
                self.fibre.lobes.scatter(eye, offset, sine(self.to_light), turn, [self.fibre.absorption]);
            *light += shown[0] * IRRADIANCE;
        }
        let [inclination, turn] = self.fibre.pick(eye, offset, || f64::from(random.unit()))?;
        let flat = inclination.cos();
        let [along, first, second] =
            [inclination.sin(), flat * turn.cos(), flat * turn.sin()].map(|number| number as f32);
        Some(Ray { start, way: (t * along + u * first + v * second).normalize(), from: Some(piece) })
    }
}

/// Mean red radiance of the picture of hair on a ball, by the number of scatterings less one; `to_light` is a unit direction
/// \[world space\] to a light of irradiance 3.
pub fn light_by_orders(scene: &Scene, to_light: Vec3, paths: u32) -> Vec<f64> {
    let camera = &scene.camera;
    let front = (camera.target - camera.position).normalize();
    let right = front.cross(camera.up).normalize();
    let up = right.cross(front);
    let half = (0.5 * camera.field_of_view).to_radians().tan();
    let hairs = Hairs::new(scene);
    let fibre = Fibre::new(&scene.look.fibre.chiang);
    let lit = Lit { hairs: &hairs, fibre, skin: scene.body_look.color.x, to_light };
    let run = |number: u32| {
        let (mut random, mut orders) = (Random::new(7, u64::from(number)), vec![0.0; ORDERS]);
        for _ in 0..RUN {
            let way = front + (right * random.signed() + up * random.signed()) * half;
            let ray = Ray { start: camera.position, way: way.normalize(), from: None };
            lit.follow(ray, &mut random, &mut orders);
        }
        orders
    };
    let runs = paths.div_ceil(RUN);
    let found: Vec<Vec<f64>> = (0..runs).into_par_iter().map(run).collect();
    let mean = |order: usize| found.iter().map(|run| run[order]).sum::<f64>() / f64::from(runs * RUN);
    (0..ORDERS).map(mean).collect()
}

/// Means of the sine of inclination and of the cosine of the turn of picked light are those of the lobes.
#[test]
fn light_is_picked_as_a_fibre_shows_it() {
    let fibre = Fibre::new(&Chiang { eumelanin: 0.3, pheomelanin: 0.0, ..Chiang::default() });
    let (eye, mut random) = (0.5, Random::new(5, 1));
    let (mut picked, mut expected) = ([0.0; 3], [0.0; 3]);
    let add = |sums: &mut [f64; 3], weight: f64, inclination: f64, turn: f64| {
        let values = [1.0, inclination.sin(), turn.cos()];
        sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
    };
    let count = 40_000;
    for _ in 0..count {
        let offset = f64::from(random.signed());
        if let Some([inclination, turn]) = fibre.pick(eye, offset, || f64::from(random.unit())) {
            add(&mut picked, 1.0 / f64::from(count), inclination, turn);
        }
    }
    let steps = 90;
    let middle = |step: u32, whole: f64| (f64::from(step) + 0.5) / f64::from(steps) * whole;
    for (row, column) in (0..steps).flat_map(|row| (0..steps).map(move |column| (row, column))) {
        let (inclination, turn) = (middle(row, PI) - 0.5 * PI, middle(column, TAU));
        let solid = inclination.cos() * PI * TAU / f64::from(steps * steps);
        for part in 0..8 {
            let offset = (f64::from(part) + 0.5) / 4.0 - 1.0;
            let [shown] = fibre.lobes.scatter(eye, offset, inclination, turn, [fibre.absorption]);
            add(&mut expected, shown * solid / 8.0, inclination, turn);
        }
    }
    for (picked, expected) in picked.into_iter().zip(expected) {
        assert!((picked - expected).abs() < 0.015, "{picked} {expected}");
    }
}
