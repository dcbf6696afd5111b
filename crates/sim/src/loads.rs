//! Forces of solids that press strands hard, from step to step.

use strandline_groom::{LANES, Lanes, Vec3Lanes};

/// Holds of solids that press hard on the points of rods.
#[derive(Clone, Debug, Default)]
pub(crate) struct Loads {
    /// Forces \[N\], world space, shape `[block][point]` of lanes; empty before a first step with solids.
    pub forces: Vec<Vec3Lanes>,
    /// Strands of each block that have any, a bit each.
    pub lanes: Vec<u8>,
}

impl Loads {
    /// Forces of blocks of strands with a number of points; those that are no number are none.
    pub fn new(mut forces: Vec<Vec3Lanes>, points: usize) -> Self {
        let mut lanes = Vec::with_capacity(forces.len() / points.max(1));
        for block in forces.chunks_mut(points.max(1)) {
            let mut loaded = 0;
            for lane in 0..LANES {
                let sound = block.iter().all(|force| force.get(lane).is_finite());
                for force in block.iter_mut().filter(|_| !sound) {
                    force.set(lane, glam::Vec3::ZERO);
                }
                let is_loaded = block.iter().any(|force| force.get(lane) != glam::Vec3::ZERO);
                loaded |= u8::from(is_loaded) << lane;
            }
            lanes.push(loaded);
        }
        Self { forces, lanes }
    }

    /// Makes room for blocks of strands with a number of points, and for the tensions of their segments.
    pub fn fit(&mut self, tensions: &mut Vec<Lanes>, blocks: usize, points: usize) {
        if self.lanes.len() != blocks {
            *self = Self { forces: vec![Vec3Lanes::default(); blocks * points], lanes: vec![0; blocks] };
        }
        tensions.resize(blocks * points, Lanes::default());
    }
}
