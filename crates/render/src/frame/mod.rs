//! A picture as a list of stages, the same on both backends [Chen2011 §3].

pub(crate) mod channels;
pub(crate) mod edges;
pub(crate) mod filter;
mod input;
pub(crate) mod known;
pub(crate) mod motion;
pub(crate) mod projection;
pub(crate) mod samples;

pub use input::FrameInput;

use std::sync::Arc;

use glam::Vec3;
use strandline_body::Aabb;
use strandline_groom::Guides;

use crate::Layers;

/// Names the stages, in the order of a frame, each with the frames that it is there for.
macro_rules! stages {
    ($($(#[$sentence:meta])* $stage:ident = $name:literal, $is_in:ident;)*) => {
        /// A stage of a frame. One stem each: its files, the timer label, the check in checks/parity and the row in
        /// ARCHITECTURE.md carry its name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Stage {
            $($(#[$sentence])* $stage,)*
        }

        impl Stage {
            /// All, in the order of a frame.
            pub const ALL: &[Self] = &[$(Self::$stage,)*];

            /// Its name.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$stage => $name,)*
                }
            }

            /// True if a frame of such strands has it.
            fn is_in(self, strands: DrawnStrands) -> bool {
                match self {
                    $(Self::$stage => $is_in(strands),)*
                }
            }
        }
    };
}

stages! {
    /// Strands that guides carry, placed about them.
    Bind = "bind", carried;
    /// Smooth curves through the strands that are given.
    Tessellate = "tessellate", always;
    /// Follow strands about the curves, out of solids.
    Interpolate = "interpolate", always;
    /// The first hair and the body, as each light sees them.
    OpacityDepth = "opacity_depth", always;
    /// Hair behind the first, in three layers.
    OpacityLayers = "opacity_layers", always;
    /// Light that reaches hair and is scattered by it.
    Shade = "shade", always;
    /// Background, body and ribbons of hair, as samples.
    Draw = "draw", always;
    /// Samples to pixels.
    Resolve = "resolve", always;
}

/// Drawn strands, by what moves them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DrawnStrands {
    /// The guides themselves.
    Guides,
    /// Strands that guides carry.
    Carried,
}

fn always(_: DrawnStrands) -> bool {
    true
}

fn carried(strands: DrawnStrands) -> bool {
    strands == DrawnStrands::Carried
}

/// The stages of a frame of such strands, in order.
pub(crate) fn stages(strands: DrawnStrands) -> impl Iterator<Item = Stage> {
    Stage::ALL.iter().copied().filter(move |stage| stage.is_in(strands))
}

/// Cost of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameReport {
    /// Strands drawn, guides among them.
    pub strands: usize,
    /// Segments drawn.
    pub segments: usize,
    /// Wall-clock seconds of each stage, in order.
    pub seconds: Vec<(&'static str, f64)>,
    /// Linear light and more, where `picture.layers` asks for it.
    pub layers: Option<Arc<Layers>>,
}

/// Middle of a box \[m\].
pub(crate) fn middle(bounds: Aabb) -> Vec3 {
    0.5 * (bounds.min + bounds.max)
}

/// The box around all guide points \[m\].
pub(crate) fn bounds(guides: &Guides) -> Aabb {
    let points = (0..guides.strand_count())
        .flat_map(|strand| (0..guides.points_per_strand()).map(move |point| guides.position(strand, point)));
    let (min, max) =
        points.fold((Vec3::MAX, Vec3::MIN), |(min, max), point| (min.min(point), max.max(point)));
    Aabb { min, max }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_carried_strands_are_bound_and_all_else_is_in_every_frame() {
        let of = |strands| stages(strands).map(Stage::name).collect::<Vec<_>>();
        assert_eq!(
            of(DrawnStrands::Carried).split_first(),
            Some((&"bind", of(DrawnStrands::Guides).as_slice()))
        );
        assert_eq!(of(DrawnStrands::Guides)[..2], ["tessellate", "interpolate"]);
        assert_eq!(of(DrawnStrands::Guides).last(), Some(&"resolve"));
    }
}
