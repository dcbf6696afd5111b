//! A strand's nodes and edges, and one implicit step of it.

use super::front::{ALL, Factors, UNKNOWNS, substitute};
use super::joint::{Joint, Segment};
use super::pull::Pull;
use super::real::{Real, Vector};

/// A node of a rod: a point, the segment from it to the next, and the joint at it.
///
/// The first and the last point have no joint, the last has no segment: their numbers are 0, but for `stretch`.
#[derive(Clone, Copy, Debug)]
pub struct Node<R> {
    /// Mass of the point \[kg\].
    pub mass: R,
    /// Moment of inertia of the segment about itself \[kg m^2\].
    pub inertia: R,
    /// 1 for a point that moves, 0 for one that is held.
    pub free: R,
    /// 1 for a segment whose section may turn, 0 for one that is held.
    pub free_angle: R,
    /// Length \[m\] at which the segment is without tension.
    pub length: R,
    /// Tension of the segment over its strain \[N\]. Of the last point: least stiffness \[N/m\] with which a solid presses
    /// the strand, 0 where that follows from masses alone.
    pub stretch: R,
    /// Moments over strains \[N m\] of the joint: of the two bends, and of the twist.
    pub stiffness: [R; 3],
    /// Strains of the joint without moments.
    pub rest: [R; 3],
}

impl<R: Real> Node<R> {
    /// A node without mass that is held.
    pub fn zero() -> Self {
        let zero = R::of(0.0);
        Self {
            mass: zero,
            inertia: zero,
            free: zero,
            free_angle: zero,
            length: R::of(1.0),
            stretch: zero,
            stiffness: [zero; 3],
            rest: [zero; 3],
        }
    }

    /// The node with each of its numbers taken for another.
    #[inline(always)]
    pub fn map<S: Real>(&self, to: impl Fn(R) -> S) -> Node<S> {
        Node {
            mass: to(self.mass),
            inertia: to(self.inertia),
            free: to(self.free),
            free_angle: to(self.free_angle),
            length: to(self.length),
            stretch: to(self.stretch),
            stiffness: self.stiffness.map(&to),
            rest: self.rest.map(&to),
        }
    }
}

/// Settings of a step.
#[derive(Clone, Copy, Debug)]
pub struct StepSettings<R> {
    /// Length of the step \[s\].
    pub time_step: f64,
    /// Most Newton steps.
    pub newton_steps: u32,
    /// Largest turn of a segment \[rad\] in the last Newton step of a solved strand.
    pub tolerance: f64,
    /// Kelvin-Voigt relaxation time of bends and twists (moment over stiffness and strain rate), over the length of the
    /// step.
    pub viscous: R,
}

/// Scratch of a step.
#[derive(Clone)]
pub struct Work<R> {
    /// Displacement of each point \[m\] and angle of each segment \[rad\] since the start.
    pub moved: Vec<[R; UNKNOWNS]>,
    /// Segments as they are now; the last is unused.
    pub segments: Vec<Segment<R>>,
    pub(super) edges: Vec<Vector<R>>,
    pub(super) wanted: Vec<[R; UNKNOWNS]>,
    /// Displacement of each point \[m\] with the air, and force over displacement \[N/m\].
    pub(super) air: Vec<[R; 4]>,
    pub(super) rest: Vec<[R; 3]>,
    pub(super) factors: Vec<Factors<R>>,
    /// Tension of each segment \[N\] beside that of its strain, and its tangent in the last system.
    pub(crate) tensions: Vec<R>,
    pub(super) tangents: Vec<Vector<R>>,
    /// 1 for strands whose last step turned no segment far, else 0.
    pub(super) calm: R,
    /// 1 for strands that a solid presses hard: they have tensions, and their pulls have loads. Else 0.
    pub(crate) loaded: R,
    pub(crate) step: Vec<[R; UNKNOWNS]>,
    /// Displacements \[m\] of a round, and the sum of those of all rounds since the last Newton step.
    pub(super) held: Vec<Vector<R>>,
    pub(super) sums: Vec<[R; UNKNOWNS]>,
}

impl<R: Real> Work<R> {
    /// Scratch for rods of a number of points.
    pub fn new(points: usize) -> Self {
        let zero = Vector::zero();
        let segment = Segment { length: R::of(1.0), tangent: zero, across: zero };
        let unknowns = vec![[R::of(0.0); UNKNOWNS]; points];
        Self {
            moved: unknowns.clone(),
            segments: vec![segment; points],
            edges: vec![zero; points],
            wanted: unknowns.clone(),
            air: vec![[R::of(0.0); 4]; points],
            rest: vec![[R::of(0.0); 3]; points],
            factors: vec![Factors::zero(); points],
            // A sum with -0 keeps its bits.
            tensions: vec![R::of(-0.0); points],
            tangents: vec![zero; points],
            calm: R::of(0.0),
            loaded: R::of(0.0),
            step: unknowns.clone(),
            held: vec![zero; points],
            sums: unknowns,
        }
    }

    /// Begins at a shape: the edges between its points \[m\] and the first axes of its sections.
    #[inline(always)]
    pub fn begin(&mut self, edge: impl Fn(usize) -> Vector<R>, across: impl Fn(usize) -> Vector<R>) {
        for index in 0..self.moved.len() - 1 {
            let (edge, axis) = (edge(index), across(index));
            let length = edge.length();
            let tangent = edge * (R::of(1.0) / length);
            let upright = axis - tangent * axis.dot(tangent);
            let across = upright * (R::of(1.0) / upright.length());
            self.edges[index] = edge;
            self.segments[index] = Segment { length, tangent, across };
        }
        self.moved.fill([R::of(0.0); UNKNOWNS]);
    }

    /// Sets the inertial target of each node, its place without elastic forces: displacement \[m\] and angle \[rad\].
    #[inline(always)]
    pub fn want(&mut self, node: usize, unknowns: [R; UNKNOWNS]) {
        self.wanted[node] = unknowns;
    }

    /// Sets the place to which the air takes each node, displacement \[m\], and its force over the distance from there
    /// \[N/m\].
    #[inline(always)]
    pub fn blow(&mut self, node: usize, goal: Vector<R>, stiffness: R) {
        let [x, y, z] = goal.array();
        self.air[node] = [x, y, z, stiffness];
    }

    /// Displacement \[m\] to which the air takes a node, and its force over the distance from there \[N/m\].
    #[inline(always)]
    pub fn blown(&self, node: usize) -> (Vector<R>, R) {
        let [x, y, z, stiffness] = self.air[node];
        (Vector::new(x, y, z), stiffness)
    }

    /// Sets where Newton's method begins: displacement \[m\] and angle \[rad\] of a node, 0 for what is held. Without,
    /// it begins at the shape.
    #[inline(always)]
    pub fn guess(&mut self, node: usize, unknowns: [R; UNKNOWNS]) {
        self.step[node] = unknowns;
    }

    /// An implicit Euler step: minimises inertia and elastic energy over all displacements and angles
    /// of the strand by Newton's method. A solved strand keeps its numbers while the others of its block go on.
    #[inline(always)]
    pub fn solve(&mut self, rod: &[Node<R>], pulls: &mut [Pull<R>], settings: &StepSettings<R>) -> Solved<R> {
        self.prepare(rod, settings.viscous);
        let stiffer = R::of(1.0) + settings.viscous;
        let mut unsolved = R::of(1.0);
        let (mut residual, mut touched) = (R::of(0.0), R::of(0.0));
        let mut steps = 0;
        while steps < settings.newton_steps && unsolved.any_positive() {
            let (pressed, mut sound) =
                self.factorise(rod, (&*pulls, &[]), stiffer, settings.time_step, steps == 0, R::of(ALL));
            if unsolved.choose(R::of(1.0) - sound, R::of(0.0)).any_positive() {
                let turns = sound.choose(R::of(ALL), R::of(0.0));
                (_, sound) =
                    self.factorise(rod, (&*pulls, &[]), stiffer, settings.time_step, steps == 0, turns);
            }
            touched = unsolved.choose(pressed, touched);
            substitute(&self.factors, &mut self.step);
            let hard = sound.choose(self.pressed_hard(rod, pressed, steps == 0), R::of(0.0));
            let loads = self.load_tensions(rod, unsolved, hard);
            let turn = self.take_step(unsolved, sound);
            if loads {
                self.load(rod, pulls, unsolved);
            }
            residual = unsolved.choose(turn, residual);
            let open = if steps == 0 {
                // Friction is not decided yet for a touching point.
                pressed.choose(R::of(1.0), turn - R::of(settings.tolerance))
            } else {
                turn - R::of(settings.tolerance)
            };
            unsolved = unsolved.choose(open, R::of(0.0));
            steps += 1;
        }
        self.step.fill([R::of(0.0); UNKNOWNS]);
        Solved { steps, unsolved, residual, pressed: touched }
    }

    /// Strains without moments of a step, whose relaxation time over its length is given, and the first guess.
    #[inline(always)]
    pub fn prepare(&mut self, rod: &[Node<R>], viscous: R) {
        let share = R::of(1.0) / (R::of(1.0) + viscous);
        for (index, node) in rod.iter().enumerate().take(rod.len() - 1).skip(1) {
            let strains = Joint::new(&self.segments[index - 1], &self.segments[index]).strains;
            for (axis, strain) in strains.into_iter().enumerate() {
                self.rest[index][axis] = (node.rest[axis] + viscous * strain) * share;
            }
        }
        self.take_guess(rod);
    }

    /// Turns the segments to the guess and keeps their lengths, so that their tensions stay those of the shape carried by
    /// the head: the first Newton step needs these.
    #[inline(always)]
    fn take_guess(&mut self, rod: &[Node<R>]) {
        let share = (R::of(FARTHEST_GUESS) - self.turn()).choose(R::of(1.0), R::of(0.0));
        let [x, y, z, _] = self.step[0];
        let mut here = Vector::new(x, y, z) * (share * rod[0].free);
        [self.moved[0][0], self.moved[0][1], self.moved[0][2]] = here.array();
        for index in 0..self.moved.len() - 1 {
            let ([x, y, z, angle], [u, v, w, _]) = (self.step[index], self.step[index + 1]);
            let angle = angle * share;
            let segment = &self.segments[index];
            let old = self.edges[index];
            let turned = old + Vector::new(u - x, v - y, w - z) * share;
            let turned = turned * (segment.length / turned.length());
            let free = rod[index + 1].free;
            let there = Vector::choose(free, here + (turned - old), Vector::zero());
            self.edges[index] = old + (there - here);
            self.segments[index] = segment.moved(self.edges[index], angle);
            self.moved[index][3] = angle;
            [self.moved[index + 1][0], self.moved[index + 1][1], self.moved[index + 1][2]] = there.array();
            here = there;
        }
    }

    /// Largest turn of a segment in the step \[rad\].
    #[inline(always)]
    pub(super) fn turn(&self) -> R {
        let mut largest = R::of(0.0);
        for index in 0..self.moved.len() - 1 {
            let [x, y, z, _] = self.step[index];
            let [u, v, w, _] = self.step[index + 1];
            let change = Vector::new(u - x, v - y, w - z).length() / self.segments[index].length;
            largest = largest.or_more(change);
        }
        largest
    }

    /// Moves the strands that are not solved by the Newton step, shortened where a segment would turn too
    /// far. A step from a system that is not `sound` (0), or a NaN, is skipped: the strand stays unsolved.
    /// Returns the largest turn of a segment \[rad\].
    #[inline(always)]
    fn take_step(&mut self, unsolved: R, sound: R) -> R {
        self.take_whole_step(unsolved, sound).0
    }

    /// The same; also returns 1 for strands whose whole step was taken, else 0.
    #[inline(always)]
    pub(super) fn take_whole_step(&mut self, unsolved: R, sound: R) -> (R, R) {
        let last = self.moved.len() - 1;
        // 0 for finite numbers, else not a number.
        let mut nothing = R::of(0.0);
        for index in 0..=last {
            for row in 0..UNKNOWNS {
                nothing += self.step[index][row] * R::of(0.0);
            }
        }
        let sound = (sound - nothing).choose(R::of(1.0), R::of(0.0));
        let largest = sound.choose(self.turn(), R::of(LONGEST_TURN));
        let share = R::of(1.0).or_less(R::of(LONGEST_TURN) / (largest + R::of(1e-30)));
        let moves = unsolved.choose(sound, R::of(0.0));
        for index in 0..=last {
            for row in 0..UNKNOWNS {
                // A solved strand keeps its bits while others of its block go on: adding -0 changes none.
                self.step[index][row] = moves.choose(self.step[index][row] * share, R::of(-0.0));
                self.moved[index][row] += self.step[index][row];
            }
        }
        for index in 0..last {
            let [x, y, z, angle] = self.step[index];
            let [u, v, w, _] = self.step[index + 1];
            self.edges[index] += Vector::new(u - x, v - y, w - z);
            let angle = angle.or_less(R::of(LONGEST_TURN)).or_more(R::of(-LONGEST_TURN));
            let segment = self.segments[index].moved(self.edges[index], angle);
            self.segments[index] = Segment::choose(moves, segment, self.segments[index]);
        }
        (largest, (share - R::of(WHOLE)).choose(moves, R::of(0.0)))
    }
}

/// Quality of the solve.
#[derive(Clone, Copy, Debug)]
pub struct Solved<R> {
    /// Number of Newton steps.
    pub steps: u32,
    /// Above 0 for unsolved strands.
    pub unsolved: R,
    /// Largest turn of a segment in the last Newton step of its strand \[rad\].
    pub residual: R,
    /// Largest force \[N\] of a solid on a strand.
    pub pressed: R,
}

/// Largest relative motion of the ends of a segment in a Newton step, over its length, and largest turn of a section
/// \[rad\]: the linearised bends do not hold beyond.
const LONGEST_TURN: f64 = 1.0;

/// Share of a Newton step that counts as all of it.
const WHOLE: f64 = 0.999_999;

/// Largest turn of a segment in the first guess \[rad\]: faster strands begin at the shape carried by the head.
const FARTHEST_GUESS: f64 = 0.5;

#[cfg(test)]
mod tests {
    use super::*;

    type Change = fn(&mut Vec<Node<f64>>);

    #[test]
    fn a_step_of_a_system_without_a_least_energy_is_not_taken() {
        let settings = StepSettings { time_step: 0.01, newton_steps: 3, tolerance: 1e-3, viscous: 0.0 };
        // Four free points 0.1 m apart behind one that is held, which would fall 1 mm.
        let solved = |change: Change| {
            let moves = Node {
                mass: 1e-3,
                inertia: 1e-6,
                free: 1.0,
                free_angle: 1.0,
                length: 0.1,
                stretch: 10.0,
                ..Node::zero()
            };
            let mut rod = vec![Node { stiffness: [1e-3; 3], ..moves }; 5];
            (rod[0].free, rod[0].free_angle) = (0.0, 0.0);
            change(&mut rod);
            let mut work = Work::new(5);
            work.begin(|_| Vector::new(0.1, 0.0, 0.0), |_| Vector::new(0.0, 1.0, 0.0));
            (1..5).for_each(|node| work.want(node, [0.0, -1e-3, 0.0, 0.0]));
            let solved = work.solve(&rod, &mut [], &settings);
            (solved, work.moved)
        };
        let (sound, moved) = solved(|_| ());
        assert!(sound.unsolved <= 0.0 && moved[4][1] < -5e-4, "{sound:?} {moved:?}");
        // Bends that push, a point without support, and a point with a NaN.
        let spoil: [Change; 3] = [
            |rod| rod[2].stiffness = [-1e3; 3],
            |rod| (rod[4].mass, rod[3].stretch, rod[3].stiffness) = (0.0, 0.0, [0.0; 3]),
            |rod| rod[2].inertia = f64::NAN,
        ];
        for change in spoil {
            let (found, moved) = solved(change);
            assert!(found.unsolved > 0.0 && found.residual == LONGEST_TURN, "{found:?}");
            assert_eq!(moved, vec![[0.0; UNKNOWNS]; 5]);
        }
    }
}
