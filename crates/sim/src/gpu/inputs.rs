//! The settings of a step as the kernels read them.

use strandline_base::math;
use strandline_body::{BodyFrame, Pose};
use strandline_gpu::{Rigid, mirror};

use super::motion::{has_roots, in_parts, part_count, piece_count};
use crate::constrain::Spring;
use crate::contact::contacts::Care;
use crate::grab::Grab;
use crate::strands::constrain::angles::bend_share;
use crate::wind::{Axes, most_speed_sum, per_area};
use crate::{Drive, Model, Preconditioner, VolumeSettings};

/// Codes of preconditioners, which shaders know from here.
const PLAIN: u32 = 0;
const JACOBI: u32 = 1;
const CHEBYSHEV: u32 = 2;

mirror! {
    /// Settings of a step for rods. Mirrors `RodStep` in common.wesl.
    pub(super) struct RodStep {
        /// Turns what rests on the head through a part of the step.
        pub part_rotation: [f32; 4],
        /// Of the head at the start of the step, and how far a part takes it \[m\].
        pub start_translation: [f32; 3],
        pub part_time: f32,
        pub part_translation: [f32; 3],
        /// A strand is solved when a Newton step turns none of its segments farther \[rad\].
        pub tolerance: f32,
        pub parts: u32,
        pub newton_steps: u32,
        pub head_moves: u32,
        /// Distance removed by rubbing from the path of a part \[m\].
        pub rubbing: f32,
        /// Factor of the force of the air over the length of a part \[1/s\].
        pub air: f32,
        /// Hairs that a guide stands for in the air; 0 takes those that resist together.
        pub air_hairs: f32,
        /// 1 where hair and solids hold back the air.
        pub shelters: u32,
        /// 1 where there are currents beside the wind.
        pub currents: u32,
        /// Axes along the wind, upward from it and aside; whole numbers that speeds of a point sum up to at most, and in
        /// a square metre of drag area.
        pub wind_along: [f32; 3],
        pub speed_sum: f32,
        pub wind_up: [f32; 3],
        pub per_area: f32,
        pub wind_aside: [f32; 3],
        /// Coulomb coefficients of strands that stick to each other, and of those that slide.
        pub sticks: f32,
        pub slides: f32,
        /// Force that holds strands together over the length of a segment \[N/m\].
        pub pull: f32,
        pub unused_b: f32,
        pub unused_c: f32,
    }
}

mirror! {
    /// Mirrors `Step` in common.wesl; the colliders lie behind it.
    pub(super) struct Step {
        pub world_from_head: Rigid,
        pub head_from_world: Rigid,
        /// Carries what rests on the head from the start to the end of the step.
        pub end_from_start: Rigid,
        pub start_from_end: Rigid,
        pub head_rotation: [f32; 4],
        /// Velocity added by gravity in a step, or in a part of one \[m/s\].
        pub gravity: [f32; 3],
        pub time_step: f32,
        pub wind: [f32; 3],
        pub margin: f32,
        /// Stiffness \[N/m\] and damping \[N s/m\]; both 0 for a spring that is off.
        pub stretch_spring: [f32; 2],
        pub bend_spring: [f32; 2],
        pub torsion_spring: [f32; 2],
        pub drag_across: f32,
        pub drag_along: f32,
        pub kept: f32,
        /// A point nearer than its margin and this \[m\] gets a plane.
        pub near: f32,
        pub cos_limit: f32,
        pub sin_limit: f32,
        pub bend_share: f32,
        pub bends: u32,
        pub length_pass: u32,
        pub correction: f32,
        pub iterations: u32,
        pub strand_count: u32,
        /// Strands and what fills up the last block.
        pub lane_count: u32,
        pub points: u32,
        pub collider_count: u32,
        pub flip_share: f32,
        pub tolerance: f32,
        pub max_iterations: u32,
        pub preconditioner: u32,
        /// Slot of the report.
        pub slot: u32,
        /// Share of what the pressure changes that a step takes.
        pub pressure_share: f32,
        /// Pieces of the body up to the last that carries a collider, the head among them.
        pub piece_count: u32,
        /// Position of the hand \[m\].
        pub hand: [f32; 3],
        /// 1 if a hand holds hair.
        pub holds: u32,
        /// 1 where strands have root frames of their own: see roots.wesl.
        pub has_roots: u32,
        /// One more than the row of the header of a skin that moves by itself, 0 without one.
        pub skin: u32,
        /// 1 where pressure acts against compression alone.
        pub one_sided: u32,
        /// Most way \[m\] of a vertex of a skin that moves by itself through the step.
        pub skin_shift: f32,
        pub rods: RodStep,
        then solids: [u32; 4],
    }
}

impl RodStep {
    fn new(model: &Model, start: &Pose, end: &Pose, part_time: f32, drive: &Drive) -> Self {
        let rods = &model.settings.strands.rods;
        let shelters = model.settings.has_shelter();
        let [along, up, aside] = Axes::along(drive.wind).0.map(|axis| axis.to_array());
        let (turn, from, way) = in_parts(start, end, rods.substeps);
        Self {
            part_rotation: turn.to_array(),
            start_translation: from.to_array(),
            part_time,
            part_translation: way.to_array(),
            parts: rods.substeps,
            newton_steps: rods.newton_steps,
            head_moves: u32::from(start != end),
            rubbing: rods.rubbing * part_time * part_time,
            tolerance: rods.tolerance,
            air: model.settings.drag.factor / part_time,
            air_hairs: model.settings.drag.hairs.unwrap_or(0.0),
            shelters: u32::from(shelters),
            currents: u32::from(!drive.currents.is_empty()),
            wind_along: along,
            wind_up: up,
            wind_aside: aside,
            speed_sum: most_speed_sum(model),
            per_area: if shelters { per_area(model) } else { 1.0 },
            sticks: model.settings.contact.friction,
            slides: model.settings.contact.sliding_friction.min(model.settings.contact.friction),
            pull: model.settings.contact.pull,
            ..Self::default()
        }
    }
}

impl Step {
    /// The inputs of a step that starts at a frame of the body.
    pub fn new(model: &Model, before: &BodyFrame, drive: &Drive, grab: &Grab, slot: usize) -> Self {
        let (start, end) = (&before.world_from_head(), drive.body.world_from_head());
        let settings = &model.settings;
        // Forces common to all points act in each part of a step of rods.
        let part_time = settings.time_step / part_count(model) as f32;
        let taken = |rate: f32| -math::exp_m1(-rate * part_time);
        let drag = &settings.drag;
        let rates = if settings.has_rods() { drag.rates_of_rods() } else { [drag.across, drag.along] };
        let is_last = !settings.has_rods() && !settings.strands.constrain.length_pass.enabled;
        let care = if is_last { Care::ROUNDS } else { Care::ROUGH };
        Self {
            world_from_head: Rigid::from(&end),
            head_from_world: Rigid::from(&end.inverse()),
            end_from_start: Rigid::from(&start.motion_to(&end)),
            start_from_end: Rigid::from(&end.motion_to(start)),
            head_rotation: end.rotation.to_array(),
            gravity: (settings.gravity * part_time).to_array(),
            time_step: settings.time_step,
            wind: drive.wind.to_array(),
            margin: settings.collision_margin,
            stretch_spring: spring(&settings.strands.constrain.springs.stretch),
            bend_spring: spring(&settings.strands.constrain.springs.bend),
            torsion_spring: spring(&settings.strands.constrain.springs.torsion),
            drag_across: taken(rates[0]),
            drag_along: taken(rates[1]),
            kept: 1.0 - taken(settings.damping),
            near: care.near,
            cos_limit: math::cos(settings.strands.constrain.angles.limit),
            sin_limit: math::sin(settings.strands.constrain.angles.limit),
            bend_share: bend_share(
                &settings.strands.constrain.angles,
                settings.time_step,
                settings.strands.constrain.iterations,
            ),
            bends: u32::from(!settings.strands.constrain.angles.is_off()),
            length_pass: u32::from(settings.strands.constrain.length_pass.enabled),
            correction: settings.strands.constrain.length_pass.correction,
            iterations: settings.strands.constrain.iterations,
            strand_count: model.strand_count as u32,
            lane_count: model.lane_count() as u32,
            points: model.points_per_strand as u32,
            collider_count: model.colliders.len() as u32,
            flip_share: settings.volume.flip_share_in(settings.time_step),
            tolerance: settings.volume.tolerance,
            max_iterations: settings.volume.max_iterations,
            preconditioner: code(settings.volume.preconditioner),
            slot: slot as u32,
            one_sided: u32::from(settings.volume.is_one_sided()),
            pressure_share: VolumeSettings::pressure_share_in(settings.time_step),
            holds: u32::from(!grab.grips.is_empty()),
            piece_count: piece_count(&model.colliders) as u32,
            has_roots: u32::from(has_roots(before, &drive.body)),
            hand: grab.hand.to_array(),
            rods: RodStep::new(model, start, &end, part_time, drive),
            ..Self::default()
        }
    }
}

fn code(preconditioner: Preconditioner) -> u32 {
    match preconditioner {
        Preconditioner::None => PLAIN,
        Preconditioner::Jacobi => JACOBI,
        Preconditioner::Auto | Preconditioner::Chebyshev | Preconditioner::Mic0 => CHEBYSHEV,
    }
}

fn spring(spring: &Spring) -> [f32; 2] {
    if spring.enabled { [spring.stiffness, spring.damping] } else { [0.0; 2] }
}
