mod limits;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::Backend;

/// Everything about the motion that a person may set, in SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Where a scene is simulated: auto (default), cpu, gpu, or gpu:0 and so on for one of several.
    /// A [`Solver`](crate::Solver) itself runs where it is made.
    pub backend: Backend,
    /// Length of a step \[s\], 1e-5 to 0.1; default 1/60.
    pub time_step: f32,
    /// Rounds of the constraints in a step, 1 to 10,000; default 20 [Chen2011 §6].
    pub iterations: u32,
    /// Gravity \[m/s^2\], world space; default (0, -9.81, 0).
    pub gravity: Vec3,
    /// Mass of hair per length \[kg/m\], 1e-9 to 1; default 6.5e-6, a hair 80 um thick.
    pub mass_per_length: f32,
    /// Share of the velocity lost per second \[1/s\], 0 to 1000; default 0.
    pub damping: f32,
    /// Distance \[m\] that strands keep from solids, 0 to 0.1; default 0.001. A point that rests
    /// nearer may come as near as it rests, so that a rest pose is never pushed.
    pub collision_margin: f32,
    /// Drag of the air.
    pub drag: Drag,
    /// Elastic springs, each can be off.
    pub springs: Springs,
    /// Bends at the points of a strand.
    pub angles: Angles,
    /// The pass that makes lengths exact.
    pub length_pass: LengthPass,
    /// The fluid volume.
    pub volume: VolumeSettings,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            backend: Backend::Auto,
            time_step: 1.0 / 60.0,
            iterations: 20,
            gravity: Vec3::new(0.0, -9.81, 0.0),
            mass_per_length: 6.5e-6,
            damping: 0.0,
            collision_margin: 0.001,
            drag: Drag::default(),
            springs: Springs::default(),
            angles: Angles::default(),
            length_pass: LengthPass::default(),
            volume: VolumeSettings::default(),
        }
    }
}

impl Settings {
    /// Share that a rate \[1/s\] takes in a step.
    pub(crate) fn taken(&self, rate: f32) -> f32 {
        -(-rate * self.time_step).exp_m1()
    }

    /// The thesis as printed: 20 rounds of distance constraints, springs, no shape and no length
    /// pass [Chen2011 §4, §6].
    pub fn thesis() -> Self {
        Self {
            angles: Angles::OFF,
            length_pass: LengthPass { enabled: false, ..LengthPass::default() },
            ..Self::default()
        }
    }
}

/// Drag of the air: the rate at which hair takes the velocity of the wind.
///
/// A hair is pushed along by air across it about twice as strongly as by air along it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Drag {
    /// Rate \[1/s\] for wind across the strand, 0 to 1000; default 1.5.
    pub across: f32,
    /// Rate \[1/s\] for wind along the strand, 0 to 1000; default 0.75.
    pub along: f32,
}

impl Drag {
    /// No air.
    pub const OFF: Self = Self { across: 0.0, along: 0.0 };
}

impl Default for Drag {
    fn default() -> Self {
        Self { across: 1.5, along: 0.75 }
    }
}

/// Elastic springs along a strand [Chen2011 §4].
///
/// They are integrated explicitly, so a step cannot carry more stiffness than `m / (12 dt^2)` nor
/// more damping than `m / (12 dt)`, where m is the smaller mass of the two ends; what is above is
/// cut off there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Springs {
    /// From point i to i + 1; default 2e-5 N/m.
    pub stretch: Spring,
    /// From point i to i + 2; default 1e-5 N/m.
    pub bend: Spring,
    /// From point i to i + 3; default 5e-6 N/m.
    pub torsion: Spring,
}

impl Springs {
    /// No springs.
    pub const OFF: Self = Self { stretch: Spring::OFF, bend: Spring::OFF, torsion: Spring::OFF };
}

impl Default for Springs {
    fn default() -> Self {
        let spring = |stiffness| Spring { enabled: true, stiffness, damping: 2e-7 };
        Self { stretch: spring(2e-5), bend: spring(1e-5), torsion: spring(5e-6) }
    }
}

/// A damped elastic spring.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Spring {
    /// False leaves the spring out; default true.
    pub enabled: bool,
    /// Force over extension \[N/m\], 0 or more; default 1e-5.
    pub stiffness: f32,
    /// Force over speed of extension \[N s/m\], 0 or more; default 2e-7.
    pub damping: f32,
}

impl Spring {
    /// No spring.
    pub const OFF: Self = Self { enabled: false, stiffness: 0.0, damping: 0.0 };
}

impl Default for Spring {
    fn default() -> Self {
        Self { enabled: true, stiffness: 1e-5, damping: 2e-7 }
    }
}

/// Bends at the points of a strand, measured from the rest direction that frames carry from the
/// head along the strand.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Angles {
    /// Largest bend away from rest at a point \[rad\], 0 to pi; pi is no limit; default 0.6.
    pub limit: f32,
    /// Angular frequency \[1/s\] at which a lone bent segment would swing back to rest, 0 to
    /// 10,000; 0 is off; default 25.
    pub stiffness: f32,
    /// Rate \[1/s\] at which the length pass turns every segment to the direction that it has at
    /// rest from the segment before, 0 to 10,000; 0 is off; default 0. It goes from root to tip, so
    /// that curls of many points hold where the other bends, which work both ways, let them hang.
    pub hold: f32,
}

impl Angles {
    /// Bends are free.
    pub const OFF: Self = Self { limit: std::f32::consts::PI, stiffness: 0.0, hold: 0.0 };

    /// Whether bends are free.
    pub fn is_off(&self) -> bool {
        self.limit >= std::f32::consts::PI && self.stiffness == 0.0 && self.hold == 0.0
    }
}

impl Default for Angles {
    fn default() -> Self {
        Self { limit: 0.6, stiffness: 25.0, hold: 0.0 }
    }
}

/// The pass from root to tip that makes lengths exact \[Mueller2012\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LengthPass {
    /// False leaves it out: strands stretch as in the thesis; default true.
    pub enabled: bool,
    /// Share of the correction of a point that the next prediction of the point before it gives back,
    /// 0 to 1; default 0.9 [Mueller2012 eq. 9]. It is the same share in a step of any length: what
    /// the pass corrects is an acceleration times the square of the step, so that what it keeps back
    /// adds up to as much velocity in a second.
    pub correction: f32,
}

impl Default for LengthPass {
    fn default() -> Self {
        Self { enabled: true, correction: 0.9 }
    }
}

/// The fluid volume that keeps strands apart [Chen2011 §4.2, McAdams2009].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct VolumeSettings {
    /// False leaves the volume out; default true.
    pub enabled: bool,
    /// Cells along x, y and z, each 4 to 512; default 32, 32, 32.
    pub cells: [u32; 3],
    /// FLIP share of the velocity update in a step of 1/60 s, 0 (PIC) to 1 (FLIP); default 0.95
    /// [Chen2011 eq. 5]. A step of another length takes as much of PIC in a second, and no more than
    /// all.
    pub flip_share: f32,
    /// Relative residual at which the pressure solve stops, 1e-12 to 1; default 1e-5.
    pub tolerance: f32,
    /// Most iterations of the pressure solve, 1 to 100,000; default 200.
    pub max_iterations: u32,
    /// Preconditioner of the conjugate gradients: auto (default), mic0 (CPU only), jacobi, chebyshev
    /// or none. Auto is the one that is faster: mic0 on the CPU, chebyshev on a GPU.
    pub preconditioner: Preconditioner,
}

impl VolumeSettings {
    /// FLIP share of the velocity update in a step of a length \[s\].
    ///
    /// A PIC step smooths by the same amount however long it is, so its share is a rate: that of
    /// 1/60 s for each 1/60 s.
    pub(crate) fn flip_share_in(&self, time_step: f32) -> f32 {
        1.0 - ((1.0 - self.flip_share) * 60.0 * time_step).min(1.0)
    }
}

impl Default for VolumeSettings {
    fn default() -> Self {
        Self {
            enabled: true,
            cells: [32; 3],
            flip_share: 0.95,
            tolerance: 1e-5,
            max_iterations: 200,
            preconditioner: Preconditioner::Auto,
        }
    }
}

/// Preconditioner of the conjugate gradients.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Preconditioner {
    /// The fastest of the backend.
    #[default]
    Auto,
    /// Modified incomplete Cholesky, level zero: a chain from cell to cell, for the CPU only.
    Mic0,
    /// The diagonal.
    Jacobi,
    /// A Chebyshev polynomial of the system scaled by its diagonal \[Saad2003\].
    Chebyshev,
    /// None.
    None,
}
