//! The range of every setting.

use std::f32::consts::PI;

use crate::{Settings, SimError};

impl Settings {
    /// Checks that every setting lies in its range.
    ///
    /// # Errors
    /// The first setting that does not.
    pub fn check(&self) -> Result<(), SimError> {
        within("time_step", self.time_step, 1e-5, 0.1, "1e-5 to 0.1 s")?;
        count("iterations", self.iterations, 1, 10_000, "1 to 10000")?;
        if !self.gravity.is_finite() {
            return Err(refused("gravity", self.gravity, "finite numbers"));
        }
        within("mass_per_length", self.mass_per_length, 1e-9, 1.0, "1e-9 to 1 kg/m")?;
        within("damping", self.damping, 0.0, 1e3, "0 to 1000 1/s")?;
        within("collision_margin", self.collision_margin, 0.0, 0.1, "0 to 0.1 m")?;
        within("drag.across", self.drag.across, 0.0, 1e3, "0 to 1000 1/s")?;
        within("drag.along", self.drag.along, 0.0, 1e3, "0 to 1000 1/s")?;
        self.check_springs()?;
        within("angles.limit", self.angles.limit, 0.0, PI, "0 to pi")?;
        within("angles.stiffness", self.angles.stiffness, 0.0, 1e4, "0 to 10000 1/s")?;
        within("angles.hold", self.angles.hold, 0.0, 1e4, "0 to 10000 1/s")?;
        within("length_pass.correction", self.length_pass.correction, 0.0, 1.0, "0 to 1")?;
        self.check_volume()
    }

    fn check_springs(&self) -> Result<(), SimError> {
        let stiffness = "0 N/m or more";
        let damping = "0 N s/m or more";
        let springs = &self.springs;
        within("springs.stretch.stiffness", springs.stretch.stiffness, 0.0, f32::MAX, stiffness)?;
        within("springs.stretch.damping", springs.stretch.damping, 0.0, f32::MAX, damping)?;
        within("springs.bend.stiffness", springs.bend.stiffness, 0.0, f32::MAX, stiffness)?;
        within("springs.bend.damping", springs.bend.damping, 0.0, f32::MAX, damping)?;
        within("springs.torsion.stiffness", springs.torsion.stiffness, 0.0, f32::MAX, stiffness)?;
        within("springs.torsion.damping", springs.torsion.damping, 0.0, f32::MAX, damping)
    }

    fn check_volume(&self) -> Result<(), SimError> {
        for cells in self.volume.cells {
            count("volume.cells", cells, 4, 512, "4 to 512 along each axis")?;
        }
        within("volume.flip_share", self.volume.flip_share, 0.0, 1.0, "0 to 1")?;
        within("volume.tolerance", self.volume.tolerance, 1e-12, 1.0, "1e-12 to 1")?;
        count("volume.max_iterations", self.volume.max_iterations, 1, 100_000, "1 to 100000")
    }
}

fn within(
    name: &'static str,
    found: f32,
    least: f32,
    most: f32,
    expected: &'static str,
) -> Result<(), SimError> {
    if (least..=most).contains(&found) { Ok(()) } else { Err(refused(name, found, expected)) }
}

fn count(
    name: &'static str,
    found: u32,
    least: u32,
    most: u32,
    expected: &'static str,
) -> Result<(), SimError> {
    if (least..=most).contains(&found) { Ok(()) } else { Err(refused(name, found, expected)) }
}

fn refused(name: &'static str, found: impl ToString, expected: &'static str) -> SimError {
    SimError::Setting { name, found: found.to_string(), expected }
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
        assert!(name(|settings| settings.time_step = 0.0).starts_with("simulation.time_step is 0,"));
        assert!(name(|settings| settings.time_step = f32::NAN).contains("NaN"));
        assert!(name(|settings| settings.iterations = 0).contains("iterations"));
        assert!(name(|settings| settings.gravity.y = f32::INFINITY).contains("gravity"));
        assert!(name(|settings| settings.springs.bend.stiffness = -1.0).contains("springs.bend"));
        assert!(name(|settings| settings.angles.limit = 4.0).contains("angles.limit"));
        assert!(name(|settings| settings.volume.cells[1] = 3).contains("volume.cells"));
    }
}
