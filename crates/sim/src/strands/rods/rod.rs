//! What a strand is made of, and one implicit step of it.

use super::front::{Factors, Front, ROWS, UNKNOWNS, substitute};
use super::joint::{Joint, Segment, Slope};
use super::real::{Real, Vector};

/// A node of a rod: a point, the segment from it to the next, and the joint at it.
///
/// The first and the last point have no joint, the last no segment; what they lack is 0.
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
    /// Tension of the segment over its strain \[N\].
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
}

/// A plane or a pin that pulls at a point: energy stiffness / 2 (normal . displacement - reach)^2.
#[derive(Clone, Copy, Debug)]
pub struct Pull<R> {
    /// Node.
    pub node: usize,
    /// Unit direction.
    pub normal: Vector<R>,
    /// Displacement \[m\] along the direction at which nothing pulls.
    pub reach: R,
    /// Force over displacement \[N/m\]; 0 in lanes without.
    pub stiffness: R,
    /// Whether it only pushes, as a solid does: while the displacement is less than the reach.
    pub one_sided: bool,
    /// Coulomb friction coefficient of what only pushes.
    pub friction: R,
    /// Displacement \[m\] with which the node sticks to it.
    pub stuck: Vector<R>,
}

/// How a step is made.
#[derive(Clone, Copy, Debug)]
pub struct StepSettings {
    /// Length of the step \[s\].
    pub time_step: f64,
    /// Most Newton steps.
    pub newton_steps: u32,
    /// A strand is solved when a Newton step turns none of its segments farther than this \[rad\].
    pub tolerance: f64,
    /// Relaxation time \[s\] of bends and twists: moment over stiffness and strain rate, as of Kelvin and Voigt.
    pub damping: f64,
}

/// What a step works in.
pub struct Work<R> {
    /// Displacement of each point \[m\] and angle of each segment \[rad\] since the start.
    pub moved: Vec<[R; UNKNOWNS]>,
    /// Segments as they are now; the last is unused.
    pub segments: Vec<Segment<R>>,
    edges: Vec<Vector<R>>,
    wanted: Vec<[R; UNKNOWNS]>,
    rest: Vec<[R; 3]>,
    factors: Vec<Factors<R>>,
    step: Vec<[R; UNKNOWNS]>,
}

impl<R: Real> Work<R> {
    /// For rods of so many points.
    pub fn new(points: usize) -> Self {
        let zero = Vector::zero();
        let segment = Segment { length: R::of(1.0), tangent: zero, across: zero };
        let unknowns = vec![[R::of(0.0); UNKNOWNS]; points];
        Self {
            moved: unknowns.clone(),
            segments: vec![segment; points],
            edges: vec![zero; points],
            wanted: unknowns.clone(),
            rest: vec![[R::of(0.0); 3]; points],
            factors: vec![Factors::zero(); points],
            step: unknowns,
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

    /// Sets where each node would be without elastic forces: displacement \[m\] and angle \[rad\].
    #[inline(always)]
    pub fn want(&mut self, node: usize, unknowns: [R; UNKNOWNS]) {
        self.wanted[node] = unknowns;
    }

    /// An implicit Euler step: minimises inertia and elastic energy over all displacements and angles
    /// of the strand by Newton's method. A strand that is solved
    /// stays, whatever the others of its block need.
    pub fn solve(&mut self, rod: &[Node<R>], pulls: &[Pull<R>], settings: &StepSettings) -> Solved<R> {
        let viscous = R::of(settings.damping / settings.time_step);
        let share = R::of(1.0) / (R::of(1.0) + viscous);
        for (index, node) in rod.iter().enumerate().take(rod.len() - 1).skip(1) {
            let strains = Joint::new(&self.segments[index - 1], &self.segments[index]).strains;
            for (axis, strain) in strains.into_iter().enumerate() {
                self.rest[index][axis] = (node.rest[axis] + viscous * strain) * share;
            }
        }
        let stiffer = R::of(1.0) + viscous;
        let mut unsolved = R::of(1.0);
        let mut residual = R::of(0.0);
        let mut steps = 0;
        while steps < settings.newton_steps && unsolved.any_positive() {
            let pressed = self.factorise(rod, pulls, stiffer, settings.time_step, steps == 0);
            substitute(&self.factors, &mut self.step);
            let turn = self.take_step(unsolved);
            residual = unsolved.choose(turn, residual);
            let open = if steps == 0 {
                // What touches a solid has not yet said whether it sticks.
                pressed.choose(R::of(1.0), turn - R::of(settings.tolerance))
            } else {
                turn - R::of(settings.tolerance)
            };
            unsolved = unsolved.choose(open, R::of(0.0));
            steps += 1;
        }
        Solved { steps, unsolved, residual }
    }

    /// Assembles the gradient and the positive part of the Hessian, and eliminates from root to tip. Above 0 for
    /// strands that a solid presses.
    fn factorise(
        &mut self,
        rod: &[Node<R>],
        pulls: &[Pull<R>],
        stiffer: R,
        time_step: f64,
        first: bool,
    ) -> R {
        let mut pressed = R::of(0.0);
        let per_square = R::of(1.0 / (time_step * time_step));
        let mut front = Front::default();
        let mut pulls = pulls.iter().peekable();
        let last = rod.len() - 1;
        for index in 0..=last {
            let node = &rod[index];
            self.add_inertia(&mut front, index, node, per_square);
            while let Some(pull) = pulls.next_if(|pull| pull.node == index) {
                let force = self.add_pull(&mut front, pull, node.mass * per_square, first);
                pressed = pressed.or_more(force);
            }
            if index < last {
                self.add_stretch(&mut front, index, node);
            }
            if index + 1 < last {
                self.add_joint(&mut front, index + 1, &rod[index + 1], stiffer);
            }
            let free = [node.free, node.free, node.free, node.free_angle];
            front.eliminate(&mut self.factors[index], free);
        }
        pressed
    }

    #[inline(always)]
    fn add_inertia(&self, front: &mut Front<R>, index: usize, node: &Node<R>, per_square: R) {
        let mass = node.mass * per_square;
        let inertia = node.inertia * per_square;
        for row in 0..UNKNOWNS {
            let weight = if row < 3 { mass } else { inertia };
            front.add(row, row, weight);
            front.add_right(row, weight * (self.wanted[index][row] - self.moved[index][row]));
        }
    }

    /// A solid presses with the force that its spring has, at `first` with the one that would stop the inertia
    /// of its point. Across the normal it holds with a spring too, as weak as Coulomb's limit asks for the
    /// slip that there was: it never pushes a point farther back than it came from. Returns the force of
    /// a solid \[N\].
    #[inline(always)]
    fn add_pull(&self, front: &mut Front<R>, pull: &Pull<R>, inertia: R, first: bool) -> R {
        let vector = |[x, y, z, _]: [R; UNKNOWNS]| Vector::new(x, y, z);
        let (here, normal, none) = (vector(self.moved[pull.node]), pull.normal, R::of(0.0));
        let missing = pull.reach - normal.dot(here);
        let (mut acts, mut holds, mut solid) = (pull.stiffness, none, none);
        let mut slip = Vector::zero();
        if pull.one_sided {
            let along = |place: Vector<R>| {
                let slip = place - pull.stuck;
                slip - normal * normal.dot(slip)
            };
            slip = along(here);
            solid = missing * pull.stiffness;
            let (mut size, mut rate) = (slip.length(), pull.stiffness);
            if first {
                let wanted = vector(self.wanted[pull.node]);
                rate = pull.stiffness.choose(inertia, none);
                solid = solid.or_more((pull.reach - normal.dot(wanted)) * rate);
                size = along(wanted).length();
            }
            solid = solid.or_more(none);
            acts = solid.choose(pull.stiffness, none);
            let limit = pull.friction * solid;
            holds = (limit - rate * size).choose(pull.stiffness, limit / size);
        }
        let (push, normal, slip) = (acts * missing, normal.array(), slip.array());
        for row in 0..3 {
            front.add_right(row, normal[row] * push - holds * slip[row]);
            for column in 0..=row {
                let mut value = normal[row] * (acts - holds) * normal[column];
                if row == column {
                    value += holds;
                }
                front.add(row, column, value);
            }
        }
        solid
    }

    /// Tension, and the positive part of its derivative: along the segment, and across it where it pulls.
    #[inline(always)]
    fn add_stretch(&self, front: &mut Front<R>, index: usize, node: &Node<R>) {
        let segment = &self.segments[index];
        let stiffness = node.stretch / node.length;
        let tension = stiffness * (segment.length - node.length);
        let across = (tension / segment.length).or_more(R::of(0.0));
        let along = stiffness - across;
        let tangent = segment.tangent.array();
        for row in 0..3 {
            front.add_right(row, tension * tangent[row]);
            front.add_right(row + UNKNOWNS, -(tension * tangent[row]));
            let weight = along * tangent[row];
            for column in 0..3 {
                let mut value = weight * tangent[column];
                if row == column {
                    value += across;
                }
                if column <= row {
                    front.add(row, column, value);
                    front.add(row + UNKNOWNS, column + UNKNOWNS, value);
                }
                front.add(row + UNKNOWNS, column, -value);
            }
        }
    }

    /// Moments of bends and twist with the Gauss-Newton part of their derivative.
    #[inline(always)]
    fn add_joint(&self, front: &mut Front<R>, index: usize, node: &Node<R>, stiffer: R) {
        let (lower, upper) = (&self.segments[index - 1], &self.segments[index]);
        let joint = Joint::new(lower, upper);
        let slopes = joint.slopes(lower, upper);
        let rows = [row(&slopes[0]), row(&slopes[1]), row(&slopes[2])];
        let stiffness = node.stiffness.map(|stiffness| stiffness * stiffer);
        front.add_squares(&rows, stiffness);
        let [a, b, c] =
            std::array::from_fn(|axis| stiffness[axis] * (self.rest[index][axis] - joint.strains[axis]));
        for place in 0..ROWS {
            front.add_right(place, a * rows[0][place] + b * rows[1][place] + c * rows[2][place]);
        }
    }

    /// Moves the strands that are not solved by the Newton step, shortened where a segment would turn too
    /// far. Returns how far one turns at most \[rad\].
    fn take_step(&mut self, unsolved: R) -> R {
        let last = self.moved.len() - 1;
        let mut largest = R::of(0.0);
        for index in 0..last {
            let [x, y, z, _] = self.step[index];
            let [u, v, w, _] = self.step[index + 1];
            let change = Vector::new(u - x, v - y, w - z).length() / self.segments[index].length;
            largest = largest.or_more(change);
        }
        let share = R::of(1.0).or_less(R::of(LONGEST_TURN) / (largest + R::of(1e-30)));
        let share = unsolved.choose(share, R::of(0.0));
        for index in 0..=last {
            for row in 0..UNKNOWNS {
                self.step[index][row] = self.step[index][row] * share;
                self.moved[index][row] += self.step[index][row];
            }
        }
        for index in 0..last {
            let [x, y, z, angle] = self.step[index];
            let [u, v, w, _] = self.step[index + 1];
            self.edges[index] = self.edges[index] + Vector::new(u - x, v - y, w - z);
            let angle = angle.or_less(R::of(LONGEST_TURN)).or_more(R::of(-LONGEST_TURN));
            self.segments[index] = self.segments[index].moved(self.edges[index], angle);
        }
        largest
    }
}

/// How a step was solved.
#[derive(Clone, Copy, Debug)]
pub struct Solved<R> {
    /// Newton steps that were made.
    pub steps: u32,
    /// Above 0 for strands that were not solved by them.
    pub unsolved: R,
    /// How far a segment turned at most in the last Newton step of its strand \[rad\].
    pub residual: R,
}

/// Most that an end of a segment moves beside the other in a Newton step, over the segment's length, and most
/// that a section turns \[rad\]: beyond, the linearised bends say nothing.
const LONGEST_TURN: f64 = 1.0;

/// The derivative of a strain by the eleven unknowns of a joint: displacement and angle of the point
/// before, of the joint, and displacement of the point after.
#[inline(always)]
pub(super) fn row<R: Real>(slope: &Slope<R>) -> [R; ROWS] {
    let [a, b, c] = slope.lower.array();
    let [d, e, f] = slope.upper.array();
    [-a, -b, -c, slope.lower_angle, a - d, b - e, c - f, slope.upper_angle, d, e, f]
}
