//! Forces of solids that press a strand hard, from Newton step to Newton step and from part to part: an augmented
//! Lagrangian [Nocedal2006 ch. 17]. Springs alone would let the strand sink in and shorten, and creep aside.

use super::material::INEXTENSIBLE;
use super::pull::Pull;
use super::real::{Real, Vector};
use super::rod::{Node, Work};

/// Most of the least force that presses hard that is kept: of a light strand a quarter more than Euler's load.
const MOST: f64 = 25.0;

/// Of the same force what is not kept at all: it presses what cannot give way, such as a point beside a root.
const TOO_HARD: f64 = 100.0;

impl<R: Real> Work<R> {
    /// Above 0 for strands that stand upright and that a solid presses with more than would strain them by a ten-thousandth,
    /// which is less than makes them give way. In a `first` Newton step the force is a guess.
    #[inline(always)]
    pub(super) fn pressed_hard(&self, rod: &[Node<R>], pressed: R, first: bool) -> R {
        let least = rod[0].stretch * R::of(1.0 / INEXTENSIBLE);
        let hard = (least * R::of(TOO_HARD) - pressed).choose(pressed - least, R::of(0.0));
        let hard = rod[rod.len() - 1].stretch.choose(hard, R::of(0.0));
        if first { self.loaded.choose(hard, R::of(0.0)) } else { hard }
    }

    /// Tensions of the strands with `hard` above 0 after a Newton step; others that are `unsolved` forget theirs. False if
    /// none has any.
    #[inline(always)]
    pub(super) fn load_tensions(&mut self, rod: &[Node<R>], unsolved: R, hard: R) -> bool {
        let any = unsolved.choose(self.loaded.or_more(hard), R::of(0.0)).any_positive();
        if any {
            self.begin_tensions(rod, unsolved, hard);
            self.bound_tensions(rod, self.calm);
            self.loaded = unsolved.choose(self.calm, self.loaded);
        }
        any
    }

    /// Takes from the tensions of the strands with `which` above 0 what is more than they keep.
    #[inline(always)]
    pub(super) fn bound_tensions(&mut self, rod: &[Node<R>], which: R) {
        let most = rod[0].stretch * R::of(MOST / INEXTENSIBLE);
        for tension in &mut self.tensions {
            *tension = which.choose(tension.or_less(most).or_more(-most), *tension);
        }
    }

    /// The forces that solids have after a Newton step of the strands with `open` above 0: the next one begins with them
    /// where the strand is loaded, elsewhere with none.
    #[inline(always)]
    pub(super) fn load(&self, rod: &[Node<R>], pulls: &mut [Pull<R>], open: R) {
        let most = rod[0].stretch * R::of(MOST / INEXTENSIBLE);
        for pull in pulls.iter_mut().filter(|pull| pull.one_sided) {
            let [x, y, z, _] = self.moved[pull.node];
            let here = Vector::new(x, y, z);
            let missing = pull.missing(here).or_more(R::of(0.0)).or_less(most / pull.stiffness);
            let slip = pull.slip(here);
            let (size, limit) = (slip.length(), pull.friction * missing);
            let share = (limit - size).choose(R::of(1.0), limit / size);
            let load = Vector::choose(self.loaded, pull.normal * missing - slip * share, Vector::zero());
            pull.load = Vector::choose(open, Vector::choose(pull.stiffness, load, Vector::zero()), pull.load);
        }
    }
}
