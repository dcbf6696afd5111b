//! A hand that holds hair.

use glam::Vec3;

use super::Hair;
use crate::{Error, Ray};

impl Hair {
    /// Takes hair into a hand in place of the hair that it held: the strands within `radius` \[m\] of `hand` \[m\], world
    /// space, each at its nearest point. Returns the number of strands.
    ///
    /// # Errors
    /// The GPU failed and [`Hair::set_fall_back`] was not asked for.
    pub fn grab(&mut self, hand: Vec3, radius: f32) -> Result<usize, Error> {
        Ok(self.session.simulation_mut().grab(hand, radius)?)
    }

    /// The first hair within `radius` \[m\] of a line of sight, before the body: its place \[m\], world space, for
    /// [`Hair::grab`]. [`Ray::new`] takes the present picture.
    ///
    /// # Errors
    /// As [`Hair::grab`].
    pub fn pick(&mut self, ray: &Ray, radius: f32) -> Result<Option<Vec3>, Error> {
        self.session.show()?;
        Ok(self.session.pick(ray, radius)?.map(|picked| picked.point))
    }

    /// Moves the hand to a place \[m\], world space, at constant velocity during the next [`Hair::step`].
    pub fn move_hand(&mut self, hand: Vec3) {
        self.session.simulation_mut().move_hand(hand);
    }

    /// Lets go of the hair in the hand.
    ///
    /// # Errors
    /// As [`Hair::grab`].
    pub fn release(&mut self) -> Result<(), Error> {
        Ok(self.session.simulation_mut().release()?)
    }
}
