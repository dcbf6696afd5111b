//! Rods against the mechanics of rods: equilibria, modes and thresholds that are known.

use super::lengths::Lengths;
use super::material::{Along, Section, nodes};
use super::real::{Real, Vector};
use super::rest::{sag_free, segments, unstressed};
use super::rod::{Node, StepSettings, Work};
use wide::f32x8;

mod thresholds;

type Point = Vector<f64>;

const GRAVITY: f64 = 9.81;
/// Weight per length of a hair of 40 um \[N/m\].
const WEIGHT: f64 = 6.4e-5;

/// A number that a test can look at: of the first strand.
trait Seen: Real {
    fn seen(self) -> f64;
}

impl Seen for f64 {
    fn seen(self) -> f64 {
        self
    }
}

impl Seen for f32x8 {
    fn seen(self) -> f64 {
        f64::from(self.to_array()[0])
    }
}

/// One rod, in double precision or as a lane of eight.
struct Strand<R> {
    points: Vec<Vector<R>>,
    velocities: Vec<Vector<R>>,
    sections: Vec<Vector<R>>,
    spins: Vec<R>,
    rod: Vec<Node<R>>,
    inverse_mass: Vec<R>,
    length: Vec<R>,
    gravity: Vector<R>,
    work: Work<R>,
    lengths: Lengths<R>,
}

fn vector<R: Real>(vector: Point) -> Vector<R> {
    Vector::new(R::of(vector.x), R::of(vector.y), R::of(vector.z))
}

fn node<R: Real>(node: &Node<f64>) -> Node<R> {
    Node {
        mass: R::of(node.mass),
        inertia: R::of(node.inertia),
        free: R::of(node.free),
        free_angle: R::of(node.free_angle),
        length: R::of(node.length),
        stretch: R::of(node.stretch),
        stiffness: node.stiffness.map(R::of),
        rest: node.rest.map(R::of),
    }
}

impl<R: Seen> Strand<R> {
    /// A rod at its points \[m\], the first two of them held, with rest strains of its own.
    fn new(points: &[Point], rod: &[Node<f64>], gravity: f64) -> Self {
        let count = points.len();
        let across = segments(points, Vector::new(0.0, 1.0, 0.1));
        Self {
            points: points.iter().map(|point| vector(*point)).collect(),
            velocities: vec![Vector::zero(); count],
            sections: across.iter().map(|segment| vector(segment.across)).collect(),
            spins: vec![R::of(0.0); count],
            rod: rod.iter().map(node).collect(),
            inverse_mass: rod
                .iter()
                .map(|node| R::of(node.free * WEIGHT / GRAVITY * 1e-3 / node.mass))
                .collect(),
            length: across.iter().map(|segment| R::of(segment.length)).chain([R::of(0.0)]).collect(),
            gravity: vector(Vector::new(0.0, -gravity, 0.0)),
            work: Work::new(count),
            lengths: Lengths::new(count),
        }
    }

    fn step(&mut self, time_step: f64, newton_steps: u32) {
        let step = R::of(time_step);
        let (points, sections) = (&self.points, &self.sections);
        self.work.begin(|index| points[index + 1] - points[index], |index| sections[index]);
        for point in 0..self.points.len() {
            let [x, y, z] = ((self.velocities[point] + self.gravity * step) * step).array();
            self.work.want(point, [x, y, z, self.spins[point] * step]);
        }
        self.work.solve(
            &self.rod,
            &mut [],
            &StepSettings { time_step, newton_steps, tolerance: 1e-5, viscous: R::of(0.0) },
        );
        let mut moved: Vec<Vector<R>> =
            self.work.moved.iter().map(|[x, y, z, _]| Vector::new(*x, *y, *z)).collect();
        self.lengths.project(&self.points, &mut moved, &self.inverse_mass, &self.length, 1);
        let rate = R::of(1.0 / time_step);
        for point in 0..moved.len() {
            self.velocities[point] = moved[point] * rate;
            self.points[point] += moved[point];
            self.spins[point] = self.work.moved[point][3] * rate;
            if point + 1 < moved.len() {
                self.sections[point] = self.work.segments[point].across;
            }
        }
    }

    /// Lets time \[s\] pass in air that takes `drag` \[1/s\] of the velocity: the equilibrium is the same.
    fn settle(&mut self, time_step: f64, newton_steps: u32, seconds: f64, drag: f64) {
        let kept = R::of((-drag * time_step).exp());
        for _ in 0..(seconds / time_step) as usize {
            self.step(time_step, newton_steps);
            self.velocities.iter_mut().for_each(|velocity| *velocity = *velocity * kept);
        }
    }

    fn point(&self, index: usize) -> Point {
        let [x, y, z] = self.points[index].array();
        Vector::new(x.seen(), y.seen(), z.seen())
    }

    fn tip(&self) -> Point {
        self.point(self.points.len() - 1)
    }
}

/// A section with w L^3 / B = gamma.
fn section(gamma: f64, length: f64) -> Section {
    let mass = WEIGHT / GRAVITY;
    let bend = WEIGHT * length.powi(3) / gamma;
    // Poisson's ratio 0.5.
    Section {
        bend: [bend; 2],
        twist: bend / 1.5,
        mass,
        inertia: mass * 40e-6 * 40e-6 / 2.0,
        along: Along::EVEN,
    }
}

/// A straight rod of a held segment and a number of free ones.
fn straight(direction: Point, length: f64, count: usize) -> Vec<Point> {
    (0..count + 2).map(|k| direction * ((k as f64 - 1.0) * length / count as f64)).collect()
}

fn unstressed_rod(points: &[Point], section: &Section) -> Vec<Node<f64>> {
    let mut rod = nodes(points, section, |point| point < 2);
    unstressed(&mut rod, &segments(points, Vector::new(0.0, 1.0, 0.1)));
    rod
}

fn sag_free_rod(points: &[Point], section: &Section) -> (Vec<Node<f64>>, f64) {
    let mut rod = nodes(points, section, |point| point < 2);
    let forces: Vec<Point> = rod.iter().map(|node| Vector::new(0.0, -GRAVITY * node.mass, 0.0)).collect();
    let stiffer = sag_free(&mut rod, points, &segments(points, Vector::new(0.0, 1.0, 0.1)), &forces);
    (rod, stiffer)
}

/// Droop over reach of the same discrete energy, found in the angles of a plane chain whose lengths
/// cannot change: Newton's method on another set of unknowns than the solver's.
fn droop_of_angles(gamma: f64, count: usize) -> f64 {
    let size = 1.0 / count as f64;
    // B = 1, L = 1, w = gamma; a segment shares its weight with both ends.
    let beyond = |k: usize| gamma * size * ((count - 1 - k) as f64 + 0.5);
    let stiffness = |k: usize| if k == 0 { 2.0 / size } else { 1.0 / size };
    let mut angle = vec![-1e-3_f64; count];
    for load in (1..=40).map(|k| f64::from(k) / 40.0) {
        for _ in 0..60 {
            let (mut below, mut diagonal, mut right) = (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
            for k in 0..count {
                right[k] -= load * beyond(k) * size * angle[k].cos();
                diagonal[k] -= load * beyond(k) * size * angle[k].sin();
                let turn = angle[k] - if k == 0 { 0.0 } else { angle[k - 1] };
                // Energy K/2 (2 tan(turn/2))^2.
                let (tangent, rise) = ((0.5 * turn).tan(), 1.0 / (0.5 * turn).cos().powi(2));
                let moment = stiffness(k) * 2.0 * tangent * rise;
                let slope = stiffness(k) * (rise * rise + 2.0 * tangent * tangent * rise);
                right[k] -= moment;
                diagonal[k] += slope;
                if k > 0 {
                    right[k - 1] += moment;
                    diagonal[k - 1] += slope;
                    below[k] = -slope;
                }
            }
            for k in 1..count {
                let share = below[k] / diagonal[k - 1];
                diagonal[k] -= share * below[k];
                right[k] -= share * right[k - 1];
            }
            let mut change = 0.0;
            let mut largest = 0.0_f64;
            for k in (0..count).rev() {
                let coupling = if k + 1 < count { below[k + 1] } else { 0.0 };
                change = (right[k] - coupling * change) / diagonal[k];
                angle[k] += change;
                largest = largest.max(change.abs());
            }
            if largest < 1e-13 {
                break;
            }
        }
    }
    let reach: f64 = angle.iter().map(|angle| angle.cos()).sum();
    let droop: f64 = angle.iter().map(|angle| -angle.sin()).sum();
    droop / reach
}

/// Droop over reach of a horizontal rod that has come to rest.
fn droop<R: Seen>(gamma: f64, count: usize, time_step: f64, newton_steps: u32) -> f64 {
    let length = 0.2;
    let points = straight(Vector::new(1.0, 0.0, 0.0), length, count);
    let rod = unstressed_rod(&points, &section(gamma, length));
    let mut strand = Strand::<R>::new(&points, &rod, GRAVITY);
    strand.settle(time_step, newton_steps, 12.0, 4.0);
    -strand.tip().y / strand.tip().x
}

#[test]
fn a_cantilever_hangs_as_its_discrete_energy_says() {
    for gamma in [0.1, 1.0, 10.0, 100.0, 1000.0] {
        for count in [16, 32, 64] {
            let expected = droop_of_angles(gamma, count);
            for time_step in [1.0 / 30.0, 1.0 / 60.0, 1.0 / 240.0] {
                let found = droop::<f32x8>(gamma, count, time_step, 8);
                // The bound of the law; found within 4e-5.
                assert!(
                    (found / expected - 1.0).abs() < 1e-3,
                    "gamma {gamma}, {count} segments, 1/{:.0} s: {found} against {expected}",
                    1.0 / time_step
                );
            }
        }
    }
    let soft = droop::<f32x8>(10.0 / 0.98, 32, 1.0 / 60.0, 8) / droop_of_angles(10.0, 32);
    assert!((soft - 1.0).abs() > 1e-3, "two percent of stiffness are not noticed");
}

/// Droop over reach of the elastica, by a boundary value solver in double precision.
const ELASTICA: [(f64, f64); 5] = [
    (0.1, 0.01249955366),
    (1.0, 0.1245617664),
    (10.0, 1.06680232),
    (100.0, 5.888104623),
    (1000.0, 21.3354405),
];

#[test]
fn a_cantilever_nears_the_elastica_in_second_order() {
    for (gamma, exact) in ELASTICA {
        let error = |count| (droop_of_angles(gamma, count) / exact - 1.0).abs();
        // Second order where the bend of a joint is small; the measure 2 tan of half of it tells later.
        let order = (error(32) / error(64)).log2();
        assert!(gamma > 1.0 || (1.95..2.05).contains(&order), "gamma {gamma}: order {order}");
        let (count, bound) = if gamma <= 10.0 {
            (32, 5e-3)
        } else if gamma <= 100.0 {
            (32, 2e-2)
        } else {
            (64, 5e-2)
        };
        assert!(error(count) < bound, "gamma {gamma}: {}", error(count));
    }
}

/// Crossings of zero of a signal, by linear interpolation: the mean period in samples.
fn period(signal: &[f64]) -> f64 {
    let crossings: Vec<f64> = signal
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0] < 0.0 && pair[1] >= 0.0)
        .map(|(index, pair)| index as f64 + pair[0] / (pair[0] - pair[1]))
        .collect();
    (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64
}

#[test]
fn a_beam_and_a_shaft_swing_at_their_frequencies() {
    let (length, count) = (0.1, 32);
    let section = section(10.0, length);
    let points = straight(Vector::new(1.0, 0.0, 0.0), length, count);
    let rod = unstressed_rod(&points, &section);
    // beta_1 L = 1.875104 of a clamped beam.
    let beam = 3.516015 * (section.bend[0] / (section.mass * length.powi(4))).sqrt();
    let shaft = 0.5 * std::f64::consts::PI / length * (section.twist / section.inertia).sqrt();
    for (name, rate, twists) in [("beam", beam, false), ("shaft", shaft, true)] {
        let time_step = std::f64::consts::TAU / rate / 200.0;
        let mut strand = Strand::<f64>::new(&points, &rod, 0.0);
        for k in 2..points.len() {
            let along = (k as f64 - 1.0) / count as f64;
            strand.velocities[k].z = if twists { 0.0 } else { 1e-4 * rate * length * along * along };
            strand.spins[k - 1] =
                if twists { 1e-3 * rate * (std::f64::consts::FRAC_PI_2 * along).sin() } else { 0.0 };
        }
        let mut angle = 0.0;
        let signal: Vec<f64> = (0..1000)
            .map(|_| {
                strand.step(time_step, 3);
                angle += strand.work.moved[count][3];
                if twists { angle } else { strand.tip().z }
            })
            .collect();
        let found = 200.0 / period(&signal);
        assert!((found - 1.0).abs() < 0.02, "{name}: {found} times its frequency");
    }
}

#[test]
fn a_sag_free_shape_stays_and_an_unstable_one_is_stiffened_until_it_does() {
    for turns in [0.0, 2.0, 10.0] {
        let count = 32;
        let points: Vec<Point> = (0..count + 2)
            .map(|k| {
                let along = (k as f64 - 1.0) / count as f64;
                let angle = turns * along * std::f64::consts::TAU;
                let (sine, cosine) = angle.sin_cos();
                Vector::new(0.01 * cosine, -0.1 * along + 0.03 * along * along, 0.01 * sine + 0.1 * along)
            })
            .collect();
        let (rod, stiffer) = sag_free_rod(&points, &section(30.0, 0.2));
        assert_eq!(stiffer > 1.0, turns == 10.0, "{turns} turns are {stiffer} times stiffer");
        let mut strand = Strand::<f64>::new(&points, &rod, GRAVITY);
        (0..600).for_each(|_| strand.step(1.0 / 60.0, 2));
        let drift = (0..points.len()).map(|k| (strand.point(k) - points[k]).length()).fold(0.0, f64::max);
        assert!(drift < 1e-9, "{turns} turns: {drift} m");
        // Without the load taken off it sags.
        let mut sagging = Strand::<f64>::new(&points, &unstressed_rod(&points, &section(30.0, 0.2)), GRAVITY);
        (0..60).for_each(|_| sagging.step(1.0 / 60.0, 2));
        assert!((sagging.tip() - points[count + 1]).length() > 1e-3, "a load is not noticed");
    }
}

#[test]
fn an_upright_rod_buckles_at_the_known_load() {
    // Greenhill: w L^3 / B = 7.8373. A stiffened rod keeps a tenth to spare.
    for count in [12, 24, 48] {
        let critical = |gamma: f64| {
            let points = straight(Vector::new(0.0, 1.0, 0.0), 0.2, count);
            gamma / sag_free_rod(&points, &section(gamma, 0.2)).1 * 1.1
        };
        assert!((critical(30.0) / 7.8373 - 1.0).abs() < 0.03, "{}", critical(30.0));
        assert!((critical(6.9) - 6.9 * 1.1).abs() < 1e-9, "a stable rod is stiffened");
    }
}

/// Distance \[m\] of a hanging rod of a natural curvature \[1/m\] from its plane after a small push.
fn out_of_plane(curvature: f64, gamma: f64) -> f64 {
    let (length, count) = (0.2, 32);
    let turn = curvature * length / count as f64;
    let points = straight(Vector::new(0.0, -1.0, 0.0), length, count);
    let mut rod = unstressed_rod(&points, &section(gamma, length));
    for (joint, node) in rod.iter_mut().enumerate().take(count + 1).skip(1) {
        // The clamp's cell is half as long.
        node.rest[0] = 2.0 * (0.5 * turn * if joint == 1 { 0.5 } else { 1.0 }).tan();
    }
    let mut strand = Strand::<f64>::new(&points, &rod, GRAVITY);
    // The first strain bends about the second axis.
    let plane = Vector::new(0.0, -1.0, 0.0).cross(strand.sections[0]);
    strand.settle(1.0 / 60.0, 8, 10.0, 4.0);
    let still = (0..count + 2).map(|k| strand.point(k).dot(plane).abs()).fold(0.0, f64::max);
    assert!(still < 1e-9, "{still} m out of its plane before the push");
    strand.velocities.iter_mut().skip(2).for_each(|velocity| *velocity += plane * 1e-3);
    strand.settle(1.0 / 60.0, 8, 20.0, 2.0);
    (0..count + 2).map(|k| strand.point(k).dot(plane).abs()).fold(0.0, f64::max)
}

#[test]
fn a_curved_rod_leaves_its_plane_at_the_known_curvature() {
    // Poisson's ratio 0.5, L = 5 (B/w)^(1/3): k L = 8.104, by an eigenvalue solver.
    let critical = 8.104014 / 0.2;
    let (below, above) = (out_of_plane(0.95 * critical, 125.0), out_of_plane(1.05 * critical, 125.0));
    assert!(below < 1e-9, "{below} m out of its plane below the threshold");
    assert!(above > 1e-2, "{above} m out of its plane above the threshold");
}
