//! Settings of strands that push each other.

use strandline_base::settings;

settings! {
    /// Contact of strands with each other, of rods.
    ///
    /// A guide is the wisp of the hairs that it stands for: a chain of capsules of radius r sqrt(hairs / `strands.rods.packing`), at most half
    /// of the room to the nearest strand at rest, so that nothing presses at rest.
    pub struct ContactSettings: Copy {
        /// Strands push each other apart and rub. A step takes four to six times as long.
        enabled: bool = false, invalidates stages;
        /// Hairs that a guide stands for. Without it those of the look over the guides in a scene, else
        /// `strands.rods.wisp_hairs`.
        hairs: Option<f32> = None, in [1.0, 1e6], slider [1.0, 200.0], more "thicker wisps", invalidates stages;
        /// Coulomb coefficient of strands that stick to each other.
        friction: f32 = 0.3, in [0.0, 10.0], slider [0.0, 1.0], more "locks that hold each other";
        /// Coulomb coefficient of strands that slide, no more than `friction`.
        sliding_friction: f32 = 0.25, in [0.0, 10.0], slider [0.0, 1.0], more "locks that slide less far";
        /// Force with which water or lacquer holds strands that touch before they part, over the length of the shorter of both
        /// segments. It keeps strands where it takes hold of them, and draws none closer.
        pull: f32 = 0.0, in [0.0, 10.0] "N/m", slider [0.0, 0.1],
            more "wet or sprayed strands that hold together";
        /// Rounds of each part of a step in which strands and forces between them answer each other. A GPU takes at most 1000
        /// in a step.
        rounds: u32 = 16, in [1, 1000], slider [4, 64], more "hair that sinks in less, at a higher cost";
        moved {
            packing: f32 => "simulation.strands.rods.packing",
        }
    }
}
