//! Answers of a strand to the forces of others: Newton steps with what holds its points, and rounds with their factors
//! kept.

use super::front::{ALL, ROWS, UNKNOWNS, substitute};
use super::pull::Pull;
use super::real::{Real, Vector};
use super::rod::{Node, StepSettings, Work};

/// Effect of other strands on a node.
#[derive(Clone, Copy, Debug)]
pub struct Push<R> {
    /// Force \[N\].
    pub force: Vector<R>,
    /// Stiffness \[N/m\] that holds the node where it is.
    pub own: R,
    /// Stiffness \[N/m\] by which it holds the next one.
    pub next: R,
}

impl<R: Real> Push<R> {
    /// No effect.
    pub fn zero() -> Self {
        Self { force: Vector::zero(), own: R::of(0.0), next: R::of(0.0) }
    }
}

/// Result of a Newton step.
#[derive(Clone, Copy, Debug)]
pub struct Turned<R> {
    /// Largest force \[N\] of a solid on a strand.
    pub pressed: R,
    /// Largest turn of a segment \[rad\].
    pub turn: R,
    /// 1 for strands whose whole step was taken, else 0.
    pub whole: R,
}

/// Largest turn of a segment \[rad\] in a step after which tensions are kept.
const CALM: f64 = 0.1;

/// Moments of strands with pairs that turn with the sections, over those of inertia. Larger ones may keep a system from
/// being positive; the stiffness that holds nodes hides this, and rounds with such factors grow.
const SMALL: f64 = 0.3;

impl<R: Real> Work<R> {
    /// A Newton step of the strands with `open` above 0, under the pushes. Those with `meets` above 0 keep
    /// tensions, and those that a solid presses hard.
    #[inline(always)]
    pub fn push(
        &mut self,
        rod: &[Node<R>],
        (pulls, pushes): (&mut [Pull<R>], &[Push<R>]),
        settings: &StepSettings<R>,
        first: bool,
        (open, meets): (R, R),
    ) -> Turned<R> {
        let stiffer = R::of(1.0) + settings.viscous;
        let step = settings.time_step;
        let turns = meets.choose(R::of(SMALL), R::of(ALL));
        let (pressed, mut sound) = self.factorise(rod, (&*pulls, pushes), stiffer, step, first, turns);
        if open.choose(R::of(1.0) - sound, R::of(0.0)).any_positive() {
            let turns = sound.choose(turns, R::of(0.0));
            (_, sound) = self.factorise(rod, (&*pulls, pushes), stiffer, step, first, turns);
        }
        substitute(&self.factors, &mut self.step);
        self.sums.fill([R::of(0.0); UNKNOWNS]);
        let hard = self.pressed_hard(rod, pressed, first);
        let keeps = sound.choose(hard.choose(R::of(1.0), meets), R::of(0.0));
        // Strands without pairs forget theirs as alone.
        self.begin_tensions(rod, meets.choose(sound.choose(open, R::of(0.0)), open), keeps);
        self.bound_tensions(rod, meets.choose(R::of(0.0), self.calm));
        let was_loaded = self.loaded;
        self.loaded = open.choose(hard.choose(self.calm, R::of(0.0)), was_loaded);
        let (turn, whole) = self.take_whole_step(open, sound);
        if was_loaded.or_more(self.loaded).any_positive() {
            self.load(rod, pulls, open);
        }
        self.hold();
        Turned { pressed, turn, whole }
    }

    /// The displacements in `step` are those that the next round holds.
    #[inline(always)]
    fn hold(&mut self) {
        for (held, step) in self.held.iter_mut().zip(&self.step) {
            let [x, y, z, _] = *step;
            *held = Vector::new(x, y, z);
        }
    }

    /// Force \[N\] with which the displacements of the last round are held at a node.
    #[inline(always)]
    fn held(&self, pushes: &[Push<R>], index: usize) -> Vector<R> {
        let mut held = self.held[index] * pushes[index].own;
        if index + 1 < pushes.len() {
            held += self.held[index + 1] * pushes[index].next;
        }
        if index > 0 {
            held += self.held[index - 1] * pushes[index - 1].next;
        }
        held
    }

    /// A round: the displacements by which the system of the last Newton step, with its factors, answers forces \[N\] and what
    /// holds the last displacements, of the strands with `whole` above 0: into `step`.
    #[inline(always)]
    pub fn round(&mut self, rod: &[Node<R>], pushes: &[Push<R>], forces: &[Vector<R>], whole: R) {
        let mut right = [R::of(0.0); ROWS];
        for index in 0..rod.len() {
            let force = forces[index] + self.held(pushes, index);
            let [x, y, z] = Vector::choose(whole, force, Vector::zero()).array();
            (right[0], right[1], right[2]) = (right[0] + x, right[1] + y, right[2] + z);
            self.step[index] = self.factors[index].solve(&mut right);
            for row in 0..ROWS - UNKNOWNS {
                right[row] = right[row + UNKNOWNS];
            }
            right[ROWS - UNKNOWNS..].fill(R::of(0.0));
        }
        substitute(&self.factors, &mut self.step);
        self.hold();
        for index in 0..rod.len() {
            for row in 0..UNKNOWNS {
                self.sums[index][row] += self.step[index][row];
            }
        }
        self.tighten(rod);
    }

    /// Tensions of the strands with `open` above 0 after a Newton step, to first order: with them the next system finds
    /// lengths that are exact, whatever the strand carries. Strands that turn far have none, nor those without `keeps`.
    #[inline(always)]
    pub(super) fn begin_tensions(&mut self, rod: &[Node<R>], open: R, keeps: R) {
        let keeps = open.choose(keeps, R::of(0.0));
        self.calm = keeps.choose((R::of(CALM) - self.turn()).choose(R::of(1.0), R::of(0.0)), R::of(0.0));
        for index in 0..rod.len() - 1 {
            let (segment, node) = (&self.segments[index], &rod[index]);
            self.tangents[index] = segment.tangent;
            let strained = node.stretch / node.length * (segment.length - node.length);
            let forgotten = open.choose(R::of(-0.0), self.tensions[index]);
            self.tensions[index] = self.calm.choose(self.tensions[index] + strained, forgotten);
        }
        self.tighten(rod);
    }

    /// Adds what the displacements in `step` change.
    #[inline(always)]
    fn tighten(&mut self, rod: &[Node<R>]) {
        for index in 0..rod.len() - 1 {
            let ([x, y, z, _], [u, v, w, _]) = (self.step[index], self.step[index + 1]);
            let longer = self.tangents[index].dot(Vector::new(u - x, v - y, w - z));
            let tension = rod[index].stretch / rod[index].length * longer;
            self.tensions[index] += self.calm.choose(tension, R::of(-0.0));
        }
    }

    /// Takes the displacements of all rounds for the strands with `open` above 0, shortened where a segment would turn too
    /// far.
    #[inline(always)]
    pub fn settle(&mut self, open: R) {
        self.step.copy_from_slice(&self.sums);
        self.take_whole_step(open, R::of(1.0));
    }
}
