use std::sync::Arc;

use strandline_base::memory;
use strandline_body::{BodyFrame, Collider, Pose};
use strandline_groom::{Guides, LANES, Lanes, RestShape, Vec3Lanes};
use wide::f32x8;

use crate::at_rest::{by_lane, check_rest, clearance, directions, velocities};
use crate::cells::packing::rest_density;
use crate::strands::rods::hairs::Hairs;
use crate::strands::rods::model::{Rods, RodsAtRest};
use crate::strands::rods::other_lengths::Lengthened;
use crate::strands::rods::rod::Node;
use crate::strands::rods::settings::Rest;
use crate::wisps::radii::AtRest;
use crate::{Settings, SimError, Stiffening, StrandMethod};

/// All that stages read and that time does not change: rest shape, masses, material, colliders, settings.
#[derive(Clone)]
pub struct Model {
    pub(crate) settings: Settings,
    pub(crate) rest: Arc<RestShape>,
    pub(crate) colliders: Vec<Collider>,
    pub(crate) strand_count: usize,
    pub(crate) points_per_strand: usize,
    /// Rest positions \[m\], head space, shape `[block][point]` of lanes.
    pub(crate) positions: Vec<Vec3Lanes>,
    /// Rest direction from point i to i + 1, head space, shape `[block][point]` of lanes.
    pub(crate) directions: Vec<Vec3Lanes>,
    /// 1 over the mass \[1/kg\], 0 for a rooted point, shape `[block][point]` of lanes. Lanes
    /// beyond the last strand hold what the last strand has.
    pub(crate) inverse_mass: Vec<Lanes>,
    /// Distance \[m\] from the colliders that the head carries at rest, 0 inside them, shape as above.
    pub(crate) rest_clearance: Vec<Lanes>,
    /// Masses as they were compiled, from which every change of the mass per length starts, so that one
    /// there and back leaves every bit as it was.
    compiled: Compiled,
    /// True if the guides have masses of their own, which no setting changes.
    weighed: bool,
    /// Material of each strand.
    hairs: Hairs,
    /// Velocities at the beginning \[m/s\], head space, shape `[block][point]` of lanes; empty at rest.
    pub(crate) velocities: Vec<Vec3Lanes>,
    /// None with another strand solver.
    pub(crate) rods: Option<Rods>,
    /// Radius \[m\] of each segment's wisp, shape `[block][point]` of lanes; empty without contact of strands.
    pub(crate) radii: Vec<Lanes>,
    /// Density \[kg/m^3\] around each point at rest; empty without a one-sided volume.
    rest_density: Vec<Lanes>,
}

/// Masses at the mass per length that a model was compiled with.
#[derive(Clone)]
struct Compiled {
    /// \[kg/m\].
    mass_per_length: f32,
    /// \[kg\], shape `[block][point]` of lanes.
    mass: Vec<Lanes>,
    /// \[1/kg\], shape as above.
    inverse_mass: Vec<Lanes>,
}

impl Model {
    /// Points of a strand that the head carries, so that hair leaves the skin in its own direction.
    pub const ROOTED_POINTS: usize = 2;

    /// Compiles a model of hair: the head carries the first two points of every strand and those that ties hold.
    ///
    /// # Errors
    /// A setting outside its range; more memory than may be taken.
    pub fn new(guides: &Guides, settings: &Settings, colliders: Vec<Collider>) -> Result<Self, SimError> {
        let rest = RestShape::new(guides, settings.line_density());
        let rooted = |strand, point| point < Self::ROOTED_POINTS || guides.is_held(strand, point);
        Self::with_rest(guides, rest, rooted, settings, colliders)
    }

    /// Compiles a model of strands of any mass that are held at any points: ropes, chains.
    ///
    /// `rooted(strand, point)` tells which points the head carries. Rest lengths of 0 are allowed
    /// nowhere but at the ends, where [`RestShape`] has them.
    ///
    /// # Errors
    /// A setting outside its range; more memory than may be taken; a rest shape of another shape than the guides, or with a
    /// length or a mass of a strand that is not above 0.
    pub fn with_rest(
        guides: &Guides,
        rest: RestShape,
        rooted: impl Fn(usize, usize) -> bool + Sync,
        settings: &Settings,
        colliders: Vec<Collider>,
    ) -> Result<Self, SimError> {
        settings.check()?;
        memory::check(&settings.memory(guides.strand_count(), guides.points_per_strand()))?;
        check_rest(guides, &rest)?;
        let hairs = Hairs::new(guides, &settings.strands.rods, &settings.groups)?;
        let points = guides.points_per_strand();
        let last = guides.strand_count() - 1;
        let inverse_mass = by_lane(rest.mass.len(), points, |index, block, point, lane| {
            let strand = (block * LANES + lane).min(last);
            let held = rooted(strand, point);
            let source = if strand == last { last % LANES } else { lane };
            if held { 0.0 } else { 1.0 / rest.mass[index].0[source] }
        });
        let directions = directions(guides, &rest);
        let rest_clearance = by_lane(rest.mass.len(), points, |index, _, _, lane| {
            clearance(&colliders, guides.positions()[index].get(lane))
        });
        let compiled = Compiled {
            mass_per_length: settings.line_density(),
            mass: rest.mass.clone(),
            inverse_mass: inverse_mass.clone(),
        };
        let mut model = Self {
            settings: settings.clone(),
            rest: Arc::new(rest),
            colliders,
            strand_count: guides.strand_count(),
            points_per_strand: points,
            positions: guides.positions().to_vec(),
            directions,
            inverse_mass,
            rest_clearance,
            compiled,
            weighed: guides.masses().is_some(),
            velocities: velocities(guides, &rooted),
            hairs,
            rods: None,
            radii: Vec::new(),
            rest_density: Vec::new(),
        };
        model.weigh();
        model.compile_rods();
        model.pack();
        model.thicken();
        Ok(model)
    }

    /// Sets the masses of points from those that were compiled and the settings, unless the guides have their own.
    fn weigh(&mut self) {
        if self.weighed {
            return;
        }
        let density = self.settings.line_density() / self.compiled.mass_per_length;
        let (points, last, rods) = (self.points_per_strand, self.strand_count - 1, self.settings.has_rods());
        let (hairs, stretch) = (&self.hairs, &self.rest.stretch);
        let factors = by_lane(stretch.len(), points, |index, block, point, lane| {
            let strand = (block * LANES + lane).min(last);
            let lane = if strand == last { last % LANES } else { lane };
            let lengths = |point: usize| stretch[index - index % points + point].0[lane];
            density * if rods { hairs.weight(strand, point, points, lengths) } else { 1.0 }
        });
        let scaled = |from: &[Lanes], scale: &dyn Fn(f32, f32) -> f32| -> Vec<Lanes> {
            let lanes = |(from, factor): (&Lanes, &Lanes)| {
                Lanes(std::array::from_fn(|lane| scale(from.0[lane], factor.0[lane])))
            };
            from.iter().zip(&factors).map(lanes).collect()
        };
        let mass = scaled(&self.compiled.mass, &|mass, factor| mass * factor);
        self.inverse_mass = scaled(&self.compiled.inverse_mass, &|inverse, factor| inverse / factor);
        Arc::make_mut(&mut self.rest).mass = mass;
    }

    /// Tells masses apart: two models of the same key have the same.
    pub(crate) fn mass_key(&self) -> u64 {
        self.hairs.key(self.settings.line_density(), self.settings.has_rods())
    }

    /// Compiles the rods, where the settings ask for them.
    fn compile_rods(&mut self) {
        let settings = &self.settings.strands;
        self.rods = match settings.method {
            StrandMethod::Constrain => None,
            StrandMethod::Rods => Some(Rods::new(&self.rods_at_rest(), &self.hairs, settings.rods.rest)),
        };
    }

    /// Measures how dense hair is at rest, where a one-sided volume asks for it.
    fn pack(&mut self) {
        let volume = &self.settings.volume;
        self.rest_density = if volume.enabled && volume.is_one_sided() {
            rest_density(
                volume.cells,
                self.strand_count,
                self.points_per_strand,
                &self.positions,
                &self.rest.mass,
            )
        } else {
            Vec::new()
        };
    }

    /// Finds how thick wisps are, where they push each other.
    fn thicken(&mut self) {
        let contact = &self.settings.contact;
        let rods = self.rods.as_ref().filter(|_| self.settings.has_contact());
        self.radii = rods.map_or_else(Vec::new, |rods| {
            let rest = AtRest {
                strand_count: self.strand_count,
                points_per_strand: self.points_per_strand,
                positions: &self.positions,
                lengths: &self.rest.stretch,
            };
            rest.radii(|strand, share| {
                let traits = &rods.traits[strand];
                let hairs = contact.hairs.unwrap_or(traits.hairs) / traits.packing;
                let taper = self.hairs.section(strand).along.radius(f64::from(share)) as f32;
                0.5 * traits.diameter * hairs.sqrt() * taper
            })
        });
    }

    /// Density \[kg/m^3\] around each point at rest, shape `[block][point]` of lanes; none without a one-sided volume.
    pub fn rest_density(&self) -> Option<&[Lanes]> {
        (!self.rest_density.is_empty()).then_some(&self.rest_density)
    }

    fn rods_at_rest(&self) -> RodsAtRest<'_> {
        RodsAtRest {
            strand_count: self.strand_count,
            points_per_strand: self.points_per_strand,
            positions: &self.positions,
            inverse_mass: &self.inverse_mass,
            mass: &self.rest.mass,
            weighed: self.weighed,
            gravity: self.settings.gravity,
        }
    }

    /// The nodes of rods with lengths of segments \[m\] and masses of points \[kg\] of their own; none with another
    /// strand solver.
    pub(crate) fn nodes_with(&self, lengths: &RestShape, mass: &[Lanes]) -> Option<Vec<Node<f32x8>>> {
        let carries = self.settings.strands.rods.rest != Rest::Unstressed;
        let strands = Lengthened {
            points_per_strand: self.points_per_strand,
            positions: &self.positions,
            rest: &self.rest.stretch,
            now: &lengths.stretch,
            mass,
            gravity: carries.then_some(self.settings.gravity),
            hairs: &self.hairs,
        };
        let mut nodes = self.rods.as_ref()?.nodes.clone();
        strands.change(&mut nodes);
        Some(nodes)
    }

    /// Stiffening of the strands for the sake of their shape; none with another strand solver.
    pub fn stiffening(&self) -> Stiffening {
        let (strands, most) = self.rods.as_ref().map_or((0, 1.0), |rods| (rods.stiffened, rods.stiffest));
        Stiffening { strands, of: self.strand_count, most }
    }

    /// The compiled rods; none with another strand solver.
    pub fn rods(&self) -> Option<&Rods> {
        self.rods.as_ref()
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Changes the settings between two steps; states stay as they are. Guides with masses of their own keep
    /// them.
    ///
    /// # Errors
    /// A setting outside its range or more memory than may be taken; then nothing changes.
    pub fn set_settings(&mut self, settings: &Settings) -> Result<(), SimError> {
        settings.check()?;
        memory::check(&settings.memory(self.strand_count, self.points_per_strand))?;
        let hairs = self.hairs.changed(&settings.strands.rods, &settings.groups)?;
        let change = self.settings.change_to(settings);
        self.settings = settings.clone();
        self.hairs = hairs;
        if change.masses || change.buffers {
            self.weigh();
        }
        if change.rest_shape || change.masses || change.buffers {
            self.compile_rods();
        }
        if change.stages || change.rest_shape || change.masses || change.buffers {
            self.pack();
            self.thicken();
        }
        Ok(())
    }

    /// The solids.
    pub fn colliders(&self) -> &[Collider] {
        &self.colliders
    }

    /// Root of the first strand at rest \[m\], head space.
    pub fn first_root(&self) -> glam::Vec3 {
        self.positions[0].get(0)
    }

    /// The rest shape.
    pub fn rest(&self) -> &RestShape {
        &self.rest
    }

    /// 1 over the mass \[1/kg\] of each point, 0 where the head carries it, shape `[block][point]` of
    /// lanes.
    pub fn inverse_mass(&self) -> &[Lanes] {
        &self.inverse_mass
    }

    /// Number of strands.
    pub fn strand_count(&self) -> usize {
        self.strand_count
    }

    /// Strands and the lanes that fill up the last block.
    pub(crate) fn lane_count(&self) -> usize {
        self.positions.len() / self.points_per_strand * LANES
    }

    /// Lanes of a block that hold strands.
    pub(crate) fn live_lanes(&self, block: usize) -> usize {
        (self.strand_count - block * LANES).min(LANES)
    }

    /// Root frames of a block of strands, `world_from_root`; lanes without a strand take that of the last one.
    pub(crate) fn roots(&self, body: &BodyFrame, block: usize) -> [Pose; LANES] {
        std::array::from_fn(|lane| body.root((block * LANES + lane).min(self.strand_count - 1)))
    }

    /// Points on each strand.
    pub fn points_per_strand(&self) -> usize {
        self.points_per_strand
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use strandline_groom::Groom;

    use super::*;

    fn guides() -> Guides {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::NEG_Y * 0.3]);
        Guides::resample(&groom, 6).unwrap()
    }

    #[test]
    fn a_rest_shape_that_does_not_fit_is_refused() {
        let with = |change: fn(&mut RestShape)| {
            let mut rest = RestShape::new(&guides(), 1e-5);
            change(&mut rest);
            Model::with_rest(&guides(), rest, |_, point| point == 0, &Settings::default(), Vec::new())
                .err()
                .map(|error| error.to_string())
        };
        assert_eq!(with(|_| ()), None);
        assert!(with(|rest| rest.mass[2].0[0] = 0.0).unwrap().contains("mass 0 kg in strand 0"));
        assert!(with(|rest| rest.stretch[2].0[0] = f32::NAN).unwrap().contains("length NaN m"));
        assert!(with(|rest| rest.bend.truncate(3)).unwrap().contains("3 blocks of bend"));
    }

    #[test]
    fn settings_change_between_steps_or_not_at_all() {
        let mut model = Model::new(&guides(), &Settings::constrained(), Vec::new()).unwrap();
        let light = model.inverse_mass[3].0[0];
        let settings = Settings::constrained().with_constrain(|constrain| {
            constrain.mass_per_length = 1.3e-5;
            constrain.iterations = 7;
        });
        model.set_settings(&settings).unwrap();
        assert!((model.inverse_mass[3].0[0] / light - 0.5).abs() < 1e-6);
        assert!(
            model
                .set_settings(&settings.clone().with_constrain(|constrain| constrain.iterations = 0))
                .is_err()
        );
        assert_eq!(model.settings(), &settings);
    }

    #[test]
    fn a_mass_that_is_moved_there_and_back_leaves_every_bit() {
        let compiled = Model::new(&guides(), &Settings::constrained(), Vec::new()).unwrap();
        let mut model = compiled.clone();
        for step in 1..40 {
            let mass_per_length = 6.5e-6 * (1.0 + 0.037 * step as f32);
            model
                .set_settings(
                    &Settings::constrained()
                        .with_constrain(|constrain| constrain.mass_per_length = mass_per_length),
                )
                .unwrap();
            assert_ne!(model.rest.mass, compiled.rest.mass);
        }
        model.set_settings(&Settings::constrained()).unwrap();
        assert_eq!(model.rest.mass, compiled.rest.mass);
        assert_eq!(model.inverse_mass, compiled.inverse_mass);
    }
}
