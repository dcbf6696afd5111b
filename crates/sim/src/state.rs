use glam::Vec3;
use strandline_body::Pose;
use strandline_groom::Vec3Lanes;

/// What the world does to the hair during one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drive {
    /// Pose of the head at the end of the step.
    pub world_from_head: Pose,
    /// Velocity of the air \[m/s\], world space.
    pub wind: Vec3,
}

/// All that changes with time.
#[derive(Clone, Debug)]
pub struct State {
    /// Positions \[m\], world space, shape `[block][point]` of lanes.
    pub positions: Vec<Vec3Lanes>,
    /// Velocities \[m/s\], world space, shape `[block][point]` of lanes.
    pub velocities: Vec<Vec3Lanes>,
    /// Pose of the head now.
    pub world_from_head: Pose,
    /// Time \[s\].
    pub time: f64,
}
