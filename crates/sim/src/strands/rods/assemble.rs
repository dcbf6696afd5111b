//! Forces on a strand and their derivatives: the system of a Newton step.

use super::front::{ALL, Bends, Front, ROWS, Spring, UNKNOWNS};
use super::joint::{Joint, Slope};
use super::pull::Pull;
use super::real::{Real, Vector};
use super::rod::{Node, Work};
use super::rounds::Push;

/// Distance \[m\] from a solid's plane within which a point touches it.
const ROUNDING: f64 = 1e-6;

impl<R: Real> Work<R> {
    /// Assembles the gradient and the Hessian, and eliminates from root to tip. Moments turn with the sections where they
    /// are less than `turns` of those of inertia: [`ALL`], or with 0 none, which leaves the Hessian's positive part.
    /// Returns the largest force \[N\] of a solid on each strand, at `first` also of solids that may come to press, and 1
    /// where the eliminated matrix is positive definite, else 0.
    #[inline(always)]
    pub(super) fn factorise(
        &mut self,
        rod: &[Node<R>],
        (pulls, pushes): (&[Pull<R>], &[Push<R>]),
        stiffer: R,
        time_step: f64,
        first: bool,
        turns: R,
    ) -> (R, R) {
        let mut pressed = R::of(0.0);
        let mut sound = R::of(1.0);
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
            if let Some(push) = pushes.get(index) {
                add_push(&mut front, push);
            }
            if index + 1 < last {
                let node = &rod[index + 1];
                let inertia = node.mass * per_square * node.length * node.length;
                self.add_joint(&mut front, index + 1, node, stiffer, (turns, inertia));
            } else {
                front.clear_above();
            }
            if index == 0 {
                self.add_stretch(&mut front, 0, node);
            }
            let free = [node.free, node.free, node.free, node.free_angle];
            sound = sound * front.eliminate(&mut self.factors[index], &mut self.step[index], free);
        }
        (pressed, sound)
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
        // A term of its own: still air takes not a bit of the weight of resting hair.
        let [.., stiffness] = self.air[index];
        for row in 0..3 {
            front.add(row, row, stiffness);
            front.add_right(row, stiffness * (self.air[index][row] - self.moved[index][row]));
        }
    }

    /// A solid presses with the force of its spring, at `first` with the force that stops the inertia of a touching point.
    /// Across the normal a second spring acts, as weak as Coulomb's limit asks for the slip so far: it never pushes a
    /// point back beyond its start. Returns the force of a solid \[N\], at `first` also of a solid that the point may only
    /// come to touch, since bends may hold it up.
    #[inline(always)]
    fn add_pull(&self, front: &mut Front<R>, pull: &Pull<R>, inertia: R, first: bool) -> R {
        let vector = |[x, y, z, _]: [R; UNKNOWNS]| Vector::new(x, y, z);
        let (here, normal, none) = (vector(self.moved[pull.node]), pull.normal, R::of(0.0));
        let missing = pull.missing(here);
        let (mut acts, mut holds, mut solid, mut ahead) = (pull.stiffness, none, none, none);
        let mut slip = Vector::zero();
        if pull.one_sided {
            slip = pull.slip(here);
            solid = missing * pull.stiffness;
            let (mut size, mut rate) = (slip.length(), pull.stiffness);
            if first {
                // Inertia and the air take the point there.
                let (air, blows) = self.blown(pull.node);
                let inert = vector(self.wanted[pull.node]);
                let wanted = inert + (air - inert) * (blows / (inertia + blows));
                let inertia = pull.stiffness.choose(inertia + blows, none);
                ahead = pull.missing(wanted) * inertia;
                let guess = solid.or_more((missing + R::of(ROUNDING)).choose(ahead, none));
                // A force from before is no guess.
                let held = normal.dot(pull.load);
                solid = held.choose(solid, guess);
                rate = held.choose(rate, inertia);
                size = held.choose(size, pull.slip(wanted).length());
            }
            solid = solid.or_more(none);
            acts = solid.choose(pull.stiffness, none);
            let limit = pull.friction * solid;
            holds = (limit - rate * size).choose(pull.stiffness, limit / size);
        }
        let (push, normal, slip) = (acts * missing, normal.array(), slip.array());
        // Entries without a pull keep their bits, as do sums with -0.
        let nothing = R::of(-0.0);
        for row in 0..3 {
            let force = normal[row] * push - holds * slip[row];
            front.add_right(row, pull.stiffness.choose(force, nothing));
            for column in 0..=row {
                let mut value = normal[row] * (acts - holds) * normal[column];
                if row == column {
                    value += holds;
                }
                front.add(row, column, pull.stiffness.choose(value, nothing));
            }
        }
        if pull.one_sided && self.loaded.any_positive() {
            release_way(front, pull, here, holds);
        }
        solid.or_more(ahead)
    }

    /// Tension of a segment, and the positive part of its derivative: along the segment, and across it where it
    /// pulls.
    #[inline(always)]
    fn tension(&self, index: usize, node: &Node<R>) -> (Vector<R>, [[R; 3]; 3]) {
        let segment = &self.segments[index];
        let stiffness = node.stretch / node.length;
        let tension = stiffness * (segment.length - node.length) + self.tensions[index];
        let across = (tension / segment.length).or_more(R::of(0.0));
        let tangent = segment.tangent;
        let [x, y, z] = (tangent * (stiffness - across)).array();
        let row = |part: R| [tangent.x * part, tangent.y * part, tangent.z * part];
        let mut square = [row(x), row(y), row(z)];
        (0..3).for_each(|axis| square[axis][axis] += across);
        (tangent * tension, square)
    }

    /// The segment that has no joint below it.
    #[inline(always)]
    fn add_stretch(&self, front: &mut Front<R>, index: usize, node: &Node<R>) {
        let (pull, square) = self.tension(index, node);
        let pull = pull.array();
        for row in 0..3 {
            front.add_right(row, pull[row]);
            front.add_right(row + UNKNOWNS, -pull[row]);
            for column in 0..3 {
                if column <= row {
                    front.add(row, column, square[row][column]);
                    front.add(row + UNKNOWNS, column + UNKNOWNS, square[row][column]);
                }
                front.add(row + UNKNOWNS, column, -square[row][column]);
            }
        }
    }

    /// Moments of bends and twist with the part of their derivative that is positive or turns with the sections, and
    /// the segment above the joint. `inertia` is the moment by which inertia resists a radian.
    #[inline(always)]
    fn add_joint(
        &self,
        front: &mut Front<R>,
        index: usize,
        node: &Node<R>,
        stiffer: R,
        (turns, inertia): (R, R),
    ) {
        let (lower, upper) = (&self.segments[index - 1], &self.segments[index]);
        let joint = Joint::new(lower, upper);
        let [first, second, twist] = joint.slopes(lower, upper);
        let (stiffness, rest, strains) = (&node.stiffness, &self.rest[index], &joint.strains);
        let springs = [
            Spring::new(first, stiffness[0] * stiffer, rest[0] - strains[0]),
            Spring::new(second, stiffness[1] * stiffer, rest[1] - strains[1]),
            Spring::new(twist, stiffness[2] * stiffer, rest[2] - strains[2]),
        ];
        let moments = [springs[0].moment, springs[1].moment];
        let most = moments.into_iter().fold(R::of(0.0), |most, one| most.or_more(one.or_more(-one)));
        let small = (turns * inertia - most).choose(R::of(-1.0), R::of(-0.0));
        let share = (turns - R::of(0.5 * ALL)).choose(R::of(-1.0), small);
        let turnings = joint.turnings(lower, upper, moments.map(|moment| moment * share));
        let (pull, stretch) = self.tension(index, node);
        front.set_joint(&Bends { springs, turnings, stretch, pull });
    }
}

/// A loaded point that slips is held across its way alone: along it friction is the same however far it goes.
#[inline(always)]
fn release_way<R: Real>(front: &mut Front<R>, pull: &Pull<R>, displacement: Vector<R>, holds: R) {
    let none = R::of(0.0);
    let slip = pull.slip(displacement);
    let (size, load) = (slip.length(), pull.normal.dot(pull.load));
    let limit = pull.friction * pull.missing(displacement).or_more(none);
    let free = load.choose((size - limit).choose(holds, none), none);
    let free = pull.stiffness.choose(size.choose(free, none), none);
    let along = Vector::choose(free, slip * (R::of(1.0) / size), Vector::zero()).array();
    for row in 0..3 {
        for column in 0..=row {
            front.add(row, column, -(along[row] * free * along[column]));
        }
    }
}

/// Other strands push a node and hold it, and with it the next one.
#[inline(always)]
fn add_push<R: Real>(front: &mut Front<R>, push: &Push<R>) {
    let force = push.force.array();
    for row in 0..3 {
        front.add_right(row, force[row]);
        front.add(row, row, push.own);
        front.add(row + UNKNOWNS, row, push.next);
    }
}

/// The derivative of a strain by the eleven unknowns of a joint: displacement and angle of the point
/// before, of the joint, and displacement of the point after.
#[inline(always)]
pub(super) fn row<R: Real>(slope: &Slope<R>) -> [R; ROWS] {
    let [a, b, c] = slope.lower.array();
    let [d, e, f] = slope.upper.array();
    [-a, -b, -c, slope.lower_angle, a - d, b - e, c - f, slope.upper_angle, d, e, f]
}
