//! Forces on a point that solids and hands have.

use super::real::{Real, Vector};

/// A plane or a pin that pulls at a point: energy stiffness / 2 (normal . displacement - reach)^2.
#[derive(Clone, Copy, Debug)]
pub struct Pull<R> {
    /// Node.
    pub node: usize,
    /// Unit direction.
    pub normal: Vector<R>,
    /// Displacement \[m\] along the direction at which the force is 0.
    pub reach: R,
    /// Force over displacement \[N/m\]; 0 in lanes without.
    pub stiffness: R,
    /// True if it only pushes, as a solid does: while the displacement is less than the reach.
    pub one_sided: bool,
    /// Coulomb friction coefficient, where it only pushes.
    pub friction: R,
    /// Displacement \[m\] with which the node sticks to it.
    pub stuck: Vector<R>,
    /// Force with which it begins, over its stiffness \[m\], where it only pushes.
    pub load: Vector<R>,
}

impl<R: Real> Pull<R> {
    /// Distance of a displacement \[m\] from the place where the node sticks, across the direction.
    #[inline(always)]
    pub(super) fn slip(&self, displacement: Vector<R>) -> Vector<R> {
        let slip = displacement - self.stuck - self.load;
        slip - self.normal * self.normal.dot(slip)
    }

    /// Way \[m\] by which a displacement falls short of the reach, with what the load adds.
    #[inline(always)]
    pub(super) fn missing(&self, displacement: Vector<R>) -> R {
        self.reach - self.normal.dot(displacement) + self.normal.dot(self.load)
    }
}
