use glam::Vec3;
use strandline_base::{Group, Invalidates, Row, SettingError, Value, choices, settings};
use strandline_gpu::Backend;

use crate::SimError;
use crate::strands::constrain::settings::{Angles, ConstrainSettings, LengthPass, Springs};
use crate::strands::rods::settings::{GroupSettings, Rest, RodSettings};
use crate::wisps::settings::ContactSettings;

settings! {
    /// Motion of hair.
    pub struct Settings {
        /// Length of a step.
        time_step: f32 = 1.0 / 60.0, in [1e-5, 0.1] "s", slider [0.002, 0.05],
            more "faster, softer and less exact";
        /// Gravity, world space.
        gravity: Vec3 = Vec3::new(0.0, -9.81, 0.0), in [-1000.0, 1000.0] "m/s^2", slider [-20.0, 5.0];
        /// Steps after which a GPU's state is read. Where the GPU fails the CPU resumes from the last one and makes
        /// the steps since then again.
        checkpoint_every: u32 = 120, in [1.0, 10_000.0] "steps",
            more "fewer waits for the GPU, a longer one where it fails";
        /// Share of the velocity that is lost per second.
        damping: f32 = 0.0, in [0.0, 1000.0] "1/s", slider [0.0, 20.0], more "calmer, slower hair";
        /// Distance that strands keep from solids. A point that rests nearer may come as near as it
        /// rests, but not inside.
        collision_margin: f32 = 0.001, in [0.0, 0.1] "m", slider [0.0, 0.01],
            more "less skin that shows through, hair that floats over it";
        /// Drag of the air.
        drag: Drag = Drag::default();
        /// Mechanics of strands within a step.
        strands: StrandSettings = StrandSettings::default();
        /// Groups of the groom whose hair, as rods, is made of something else, at most 1,024. A setting that a group does
        /// not give is that of `[simulation.strands.rods]`, or of its own `hair`. A shear modulus that is not given keeps
        /// its share of Young's modulus, or follows from Poisson's ratio where that is given.
        groups: Vec<GroupSettings> = Vec::new(), in [0.0, 1024.0], invalidates masses;
        /// Strands that push each other apart.
        contact: ContactSettings = ContactSettings::default();
        /// The fluid volume.
        volume: VolumeSettings = VolumeSettings::default();
        moved {
            backend: Backend => "devices.simulation",
            iterations: u32 => "simulation.strands.constrain.iterations",
            mass_per_length: f32 => "simulation.strands.constrain.mass_per_length",
            springs: <Springs as Value>::Given => "simulation.strands.constrain.springs",
            angles: <Angles as Value>::Given => "simulation.strands.constrain.angles",
            length_pass: <LengthPass as Value>::Given => "simulation.strands.constrain.length_pass",
        }
    }
    prepare Settings::take_moved;
}

impl Settings {
    /// Mass of hair per length \[kg/m\]: that of the material of rods, or `mass_per_length`.
    pub fn line_density(&self) -> f32 {
        match self.strands.method {
            StrandMethod::Constrain => self.strands.constrain.mass_per_length,
            StrandMethod::Rods => self.strands.rods.mass_per_length(),
        }
    }

    /// Parts of a model, a runner and its state that a change to other settings invalidates.
    pub fn change_to(&self, other: &Self) -> Invalidates {
        // A shape that is an equilibrium carries its gravity.
        let carries = other.has_rods() && other.strands.rods.rest != Rest::Unstressed;
        let rest_shape = carries && self.gravity != other.gravity;
        let change = Value::change_to(self, other, &Row::NONE);
        change.and(Invalidates { rest_shape, ..Invalidates::NOTHING })
    }

    /// True if strands are rods.
    pub(crate) fn has_rods(&self) -> bool {
        self.strands.method == StrandMethod::Rods
    }

    /// True where hair and solids hold back the air.
    pub(crate) fn has_shelter(&self) -> bool {
        self.has_rods() && self.drag.factor > 0.0 && self.drag.shelter
    }

    /// True where strands push each other apart.
    pub(crate) fn has_contact(&self) -> bool {
        self.has_rods() && self.contact.enabled
    }

    /// Strands of springs and rounds of constraints in place of rods [Chen2011 §4], with bends toward the groom's
    /// and exact lengths, which the thesis has not.
    pub fn constrained() -> Self {
        let mut settings = Self::default();
        settings.strands.method = StrandMethod::Constrain;
        settings
    }

    /// The same with a change of springs and constraints.
    pub fn with_constrain(mut self, change: impl FnOnce(&mut ConstrainSettings)) -> Self {
        change(&mut self.strands.constrain);
        self
    }

    /// The thesis as printed: 20 rounds of distance constraints, springs, no shape and no length
    /// pass [Chen2011 §4, §6].
    pub fn thesis() -> Self {
        let mut settings = Self::constrained();
        settings.strands.constrain = ConstrainSettings::thesis();
        settings
    }

    /// Files of older versions have the settings of constrained strands beside those of all.
    fn take_moved(&mut self, given: &mut <Self as Value>::Given) {
        if let Some(packing) = given.contact.as_ref().and_then(|contact| contact.packing) {
            // A kind of hair, which is taken later, has a share of its own.
            let rods = given.strands.get_or_insert_default().rods.get_or_insert_default();
            rods.packing.get_or_insert(packing);
        }
        let constrain = &mut self.strands.constrain;
        constrain.iterations = given.iterations.unwrap_or(constrain.iterations);
        constrain.mass_per_length = given.mass_per_length.unwrap_or(constrain.mass_per_length);
        given.springs.clone().into_iter().for_each(|springs| constrain.springs.take(springs));
        given.angles.clone().into_iter().for_each(|angles| constrain.angles.take(angles));
        given.length_pass.clone().into_iter().for_each(|pass| constrain.length_pass.take(pass));
    }

    /// Checks that every setting lies in its range.
    ///
    /// # Errors
    /// The first setting that does not.
    pub fn check(&self) -> Result<(), SimError> {
        Ok(self.check_as("simulation")?)
    }
}

settings! {
    /// Motion of a strand within a step.
    pub struct StrandSettings: Copy {
        /// Solver of strands.
        method: StrandMethod = StrandMethod::default(), invalidates buffers;
        /// Material and solve of rods.
        rods: RodSettings = RodSettings::default();
        /// Springs and constraints of strands that are no rods.
        constrain: ConstrainSettings = ConstrainSettings::default();
    }
}

choices! {
    /// Solver of strands.
    pub enum StrandMethod as "simulation.strands.method" {
        /// Springs and rounds of constraints [Chen2011 §4].
        Constrain = "constrain",
        /// Rods, which bend and twist by physics and keep their style.
        Rods = "rods",
    }
    default Rods
}

settings! {
    /// Drag of the air.
    ///
    /// Rods feel the force of a flow on a cylinder as thin as their hair [Cheng2013, Collis1959]; that of a wisp is at most the
    /// force on a cylinder as thick as the wisp. Hair and solids take the wind from the hair behind them (`shelter`). Without
    /// `factor` hair takes the velocity of the wind at two rates, `across` and `along` the strand, as strands of springs and
    /// constraints do. A file that gives a rate and no `factor` has a `factor` of 0.
    pub struct Drag: Copy {
        /// Rate at which hair takes the velocity of wind across the strand.
        across: f32 = 1.5, in [0.0, 1000.0] "1/s", slider [0.0, 20.0],
            more "hair that follows the wind sooner and swings less in still air";
        /// Rate at which hair takes the velocity of wind along the strand.
        along: f32 = 0.75, in [0.0, 1000.0] "1/s", slider [0.0, 20.0],
            more "hair that follows the wind sooner and falls more slowly";
        /// Force of the air on rods over that of physics: 1 is physics. 0 leaves the two rates in its place.
        factor: f32 = 1.0, in [0.0, 1000.0], slider [0.0, 5.0],
            more "rods that follow the wind sooner and swing less in still air", invalidates stages;
        /// Under `factor`: hair and solids hold back the wind from the hair behind them, and the air in a lock moves along
        /// with it.
        shelter: bool = true, invalidates stages;
        /// Hairs that a guide stands for in the air under `factor`: a wisp whose outer hairs shelter the inner ones. Without it
        /// those of the look over the guides in a scene, else `strands.rods.wisp_hairs`.
        hairs: Option<f32> = None, in [1.0, 1e6], slider [1.0, 200.0],
            more "wisps that the air moves less, which swing longer";
    }
    prepare Drag::prepare;
}

impl Drag {
    /// No air.
    pub const OFF: Self = Self { across: 0.0, along: 0.0, factor: 0.0, shelter: true, hairs: None };

    /// A rate that is given would do nothing beside the force.
    fn prepare(&mut self, given: &<Self as Value>::Given) {
        if given.across.is_some() || given.along.is_some() {
            self.factor = 0.0;
        }
    }

    /// The rates of rods, across and along: none where they feel the force of physics.
    pub(crate) fn rates_of_rods(&self) -> [f32; 2] {
        if self.factor > 0.0 { [0.0; 2] } else { [self.across, self.along] }
    }
}

settings! {
    /// The fluid volume, which keeps the density of hair [Chen2011 §4.2, McAdams2009].
    pub struct VolumeSettings: Copy {
        /// Keeps the density of hair: pressed hair spreads again. Single locks still pass through each other.
        enabled: bool = true, invalidates stages;
        /// Flow that the volume holds back.
        method: VolumeMethod = VolumeMethod::default(), invalidates stages;
        /// Cells along x, y and z.
        cells: [u32; 3] = [32; 3], in [4, 512], slider [8, 128],
            more "a finer volume at a cost that grows with the cells that hold hair", invalidates stages;
        /// FLIP share of the velocity update in a step of 1/60 s, 0 is PIC and 1 is FLIP
        /// [Chen2011 eq. 5]. A step of another length takes as much of PIC in a second, and no more than
        /// all. In a one-sided volume of packed hair alone.
        flip_share: f32 = 0.95, in [0.0, 1.0], more "livelier hair, with more noise";
        /// Relative residual at which the pressure solve stops.
        tolerance: f32 = 1e-5, in [1e-12, 1.0], more "a faster, less exact solve";
        /// Most iterations of the pressure solve; on a GPU at most 2,000.
        max_iterations: u32 = 200, in [1, 100_000], slider [1, 500], more "a solve that gives up later";
        /// Preconditioner of the conjugate gradients.
        preconditioner: Preconditioner = Preconditioner::default(), invalidates stages;
    }
}

impl VolumeSettings {
    /// FLIP share of the velocity update in a step of a length \[s\].
    ///
    /// A PIC step smooths by the same amount however long it is, so its share is a rate: that of
    /// 1/60 s for each 1/60 s.
    pub(crate) fn flip_share_in(&self, time_step: f32) -> f32 {
        1.0 - ((1.0 - self.flip_share) * 60.0 * time_step).min(1.0)
    }

    /// Share that a step of a length \[s\] takes of what the pressure would change.
    ///
    /// All of it, however short the step, would let hair close up again only by what it gains within a step: the
    /// slower, the shorter. So it is a rate too: all in 1/60 s.
    pub(crate) fn pressure_share_in(time_step: f32) -> f32 {
        (60.0 * time_step).min(1.0)
    }

    /// True if pressure acts against compression alone.
    pub(crate) fn is_one_sided(&self) -> bool {
        self.method == VolumeMethod::OneSided
    }
}

choices! {
    /// Flow that a volume holds back.
    pub enum VolumeMethod as "simulation.volume.method" {
        /// Density, by pressure where hair is denser than it rests or is about to be: hair that parts, shears or swings
        /// without being compressed moves as without a volume \[Narain2009\].
        OneSided = "one_sided",
        /// Volume, everywhere that hair is, with FLIP and PIC [Chen2011 §4.2, McAdams2009].
        Incompressible = "incompressible",
    }
    default Incompressible
}

choices! {
    /// Preconditioner of the conjugate gradients.
    pub enum Preconditioner as "simulation.volume.preconditioner" {
        /// The fastest of the backend: mic0 on the CPU, chebyshev on a GPU.
        Auto = "auto",
        /// Modified incomplete Cholesky, level zero: a chain from cell to cell, for the CPU only.
        Mic0 = "mic0",
        /// The diagonal.
        Jacobi = "jacobi",
        /// A Chebyshev polynomial of the system scaled by its diagonal \[Saad2003\].
        Chebyshev = "chebyshev",
        /// Plain conjugate gradients.
        None = "none",
    }
    default Auto
}

/// Most iterations of a solve: one kernel may have to run them all.
const MOST_ITERATIONS: u32 = 2000;
/// Most rounds and Newton steps of strands that push each other in a step: each is two kernels or three.
const MOST_ROUNDS: u32 = 1000;

impl Settings {
    /// Checks what only a GPU cannot do.
    ///
    /// # Errors
    /// A preconditioner that is a chain from cell to cell; more iterations than a driver lets a kernel take.
    pub fn check_on_gpu(&self) -> Result<(), SimError> {
        let refuse = |key, found: String, expected: &str| Err(SettingError::new(key, found, expected).into());
        if self.volume.preconditioner == Preconditioner::Mic0 {
            let found = "mic0, which is a chain from cell to cell".to_owned();
            let expected = "auto, chebyshev, jacobi or none on a GPU";
            return refuse("simulation.volume.preconditioner", found, expected);
        }
        let rods = &self.strands.rods;
        let solves = rods.newton_steps.max(self.contact.rounds).saturating_mul(rods.substeps);
        if self.has_contact() && solves > MOST_ROUNDS {
            let found = format!("{} in each of {} parts of a step", self.contact.rounds, rods.substeps);
            let expected =
                "at most 1000 rounds or Newton steps in a step on a GPU, to which each is a few kernels";
            return refuse("simulation.contact.rounds", found, expected);
        }
        if self.volume.max_iterations > MOST_ITERATIONS {
            let found = self.volume.max_iterations.to_string();
            let expected = "1 to 2000 on a GPU, whose driver ends what takes long";
            return refuse("simulation.volume.max_iterations", found, expected);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_and_the_thesis_are_in_range() {
        Settings::default().check().unwrap();
        Settings::thesis().check().unwrap();
    }

    #[test]
    fn a_setting_out_of_range_is_named() {
        let name = |change: fn(&mut Settings)| {
            let mut settings = Settings::default();
            change(&mut settings);
            settings.check().unwrap_err().to_string()
        };
        let short = "simulation.time_step is 0, expected 1e-5 to 0.1 s";
        assert_eq!(name(|settings| settings.time_step = 0.0), short);
        assert!(name(|settings| settings.time_step = f32::NAN).contains("NaN"));
        assert!(name(|settings| settings.strands.constrain.iterations = 0).contains("iterations"));
        assert!(name(|settings| settings.gravity.y = f32::INFINITY).contains("gravity"));
        assert!(name(|settings| settings.gravity.z = 1e30).contains("gravity"));
        assert!(
            name(|settings| settings.strands.constrain.springs.bend.stiffness = -1.0)
                .contains("springs.bend")
        );
        assert!(name(|settings| settings.strands.constrain.angles.limit = 4.0).contains("angles.limit"));
        assert!(name(|settings| settings.volume.cells[1] = 3).contains("volume.cells"));
    }

    #[test]
    fn each_material_number_compiles_rods_again_and_no_number_of_a_step_does() {
        let read_each_step = ["hair", "rubbing", "substeps", "newton_steps", "tolerance"];
        for row in RodSettings::TABLE.rows {
            let compiles = row.invalidates != Invalidates::NOTHING;
            assert_ne!(compiles, read_each_step.contains(&row.name), "{}", row.name);
        }
    }

    #[test]
    fn a_change_invalidates_what_was_compiled_from_it() {
        let change = |from: &Settings, change: fn(&mut Settings)| {
            let mut to = from.clone();
            change(&mut to);
            from.change_to(&to)
        };
        let rest_shape = Invalidates { rest_shape: true, ..Invalidates::NOTHING };
        let gravity: fn(&mut Settings) = |settings| settings.gravity.y = -1.0;
        let rods = Settings::default();
        assert_eq!(change(&rods, |_| ()), Invalidates::NOTHING);
        assert_eq!(change(&rods, |settings| settings.damping = 1.0), Invalidates::NOTHING);
        assert_eq!(change(&rods, gravity), rest_shape, "an equilibrium carries gravity");
        assert_eq!(change(&Settings::constrained(), gravity), Invalidates::NOTHING);
        let masses = change(&rods, |settings| {
            settings.strands.rods.radius = 60.0;
            settings.volume.enabled = false;
        });
        assert_eq!(masses, Invalidates { masses: true, stages: true, ..Invalidates::NOTHING });
        assert!(change(&rods, |settings| settings.strands.method = StrandMethod::Constrain).buffers);
    }
}
