use std::path::PathBuf;

use glam::Vec3;
use strandline_base::settings;

use crate::groom::Tie;
use crate::groom::format::{RootEnd, Scale, Up};

settings! {
    /// Strands of a further file: brows, a beard.
    pub struct GroomPart {
        /// A file as `groom.file`.
        file: PathBuf = PathBuf::new(), required true;
        /// Name of the group that its strands are, where the file has no named groups of its own; without one that
        /// of the file.
        name: Option<String> = None;
        /// Metres per unit of the file; "auto" takes that of `groom.file`, or what brings the roots to the body.
        scale: Scale = Scale::default(), in [1e-6, 1e6] "m";
        /// The file's axis that points up; "auto" as for its units.
        up: Up = Up::default();
        /// Points of each strand, for files that do not say which points make a strand.
        per_strand: Option<u32> = None, in [1, 4096];
        /// Turns these strands: pitch (about x), yaw (about y), roll (about z).
        rotation: Vec3 = Vec3::ZERO, in [-360.0, 360.0] "degrees", slider [-180.0, 180.0];
        /// Moves these strands, head space.
        translation: Vec3 = Vec3::ZERO, in [-1e4, 1e4] "m";
    }
}

settings! {
    /// A band about hair: the head holds every strand that passes through it, by two points.
    pub struct TieSection: Copy {
        /// Middle of the band, head space.
        position: Vec3 = Vec3::ZERO, in [-1e4, 1e4] "m";
        /// Distance within which strands are held.
        radius: f32 = 0.02, in [1e-3, 1.0] "m", slider [0.005, 0.05], more "a band about more hair";
    }
}

impl TieSection {
    pub(crate) fn tie(&self) -> Tie {
        Tie { position: self.position, radius: self.radius }
    }
}

settings! {
    /// Strands from a file, and how guides are made of strands.
    pub struct GroomSection {
        /// A file of any of the formats that `strandline convert --help` lists; without one the `[style]` is
        /// grown.
        file: Option<PathBuf> = None;
        /// Metres per unit of the file; "auto" takes that of the body where the roots then lie on its skin, or else the
        /// unit that brings them there: 1, 0.01, 0.001, 0.0254, 0.00254, or any for a full head of hair; without a
        /// body the first that makes the groom as large as a head of hair can be.
        scale: Scale = Scale::default(), in [1e-6, 1e6] "m";
        /// The file's axis that points up; "auto" takes the axes of the body's file, unless others alone bring the
        /// roots to the skin, or a full head of hair then hangs and leaves the face free. A given axis gives the front
        /// too, and nothing is turned.
        up: Up = Up::default();
        /// Points of each strand, for files that hold points and do not say which of them make a strand.
        per_strand: Option<u32> = None, in [1, 4096];
        /// The frame of moving hair that is read of a file, from 0, in USD a time code; without it the first. Strands are
        /// taken where they lie in the world.
        frame: Option<u32> = None, in [0, 10_000_000];
        /// The end of each strand at which its root is; "auto" turns strands whose last point lies on the body and
        /// whose first does not, and without a body those that taper the other way or end among the roots of all others.
        root_end: RootEnd = RootEnd::default();
        /// Ties strands where they come together in a knot, as those of a ponytail do, unless the scene has `[[ties]]`.
        find_ties: bool = true;
        /// Draws a band just behind each place where hair is tied, as a part of the body; without it where a style is, grown or
        /// read as it was written.
        bands: Option<bool> = None;
        /// Colour of bands, linear RGB.
        band_color: Vec3 = Vec3::new(0.02, 0.02, 0.022), in [0.0, 1.0];
        /// Draws colours and widths of the file in place of the look's.
        own_look: bool = true;
        /// Turns the strands of a file: pitch (about x), yaw (about y), roll (about z). Where a scene turns neither and
        /// the body shows no face, a full head of hair shows the front of both.
        rotation: Vec3 = Vec3::ZERO, in [-360.0, 360.0] "degrees", slider [-180.0, 180.0];
        /// Moves the strands of a file, head space.
        translation: Vec3 = Vec3::ZERO, in [-1e4, 1e4] "m";
        /// Further files with strands of the same hair, at most 64.
        parts: Vec<GroomPart> = Vec::new(), in [0, 64];
        /// Strands that are simulated: so many, spread over the scalp and alike in shape to the others, which
        /// are bound to them. Without it they are those that a file marks as guides; without such marks all, or
        /// 2,000 of a file of more than 3,000. All strands are drawn.
        guides: Option<u32> = None, in [1, 8_000_000], slider [100, 10_000], more "truer motion at a higher cost";
        /// Simulate every n-th strand; the others are bound to them. `guides` comes before it.
        guide_every: u32 = 1, in [1, 1_000_000], more "fewer simulated strands";
        /// Strands that a style grows in all, of which `style.strand_count` are simulated and the others bound
        /// to them; not more than those, all are simulated. Without it eight for each that is simulated. `look.follow_strands`
        /// counts for each of them: a file that names it and was written before this key draws eight times as
        /// many strands, unless it has `bound = 0`.
        bound: Option<u32> = None, in [0, 8_000_000], slider [0, 100_000], more "hair of its own in place of tufts";
        /// Points on each guide. Without a groom file the default is that of the style.
        points_per_strand: u32 = 16, in [4, 64], more "finer curls at a higher cost";
        /// Length of every strand over its own.
        length: f32 = 1.0, in [0.05, 2.0], more "longer hair";
        /// A file with masses and first velocities of the simulated points: tensors of the safetensors format,
        /// 32-bit floats, `masses` \[kg\], shape \[strand, point\], and `velocities` \[m/s\], head space,
        /// shape \[strand, point, 3\]; either may be missing. Without masses `mass_per_length` counts.
        /// Velocities are those of the first step: with `settle` above 0 they have died down before the first
        /// picture.
        attributes: Option<PathBuf> = None;
        /// A file with first positions and motion of the simulated points and of the body, as the window and
        /// `Hair::save_pose` save it: a snapshot in a .npz (docs/cache.md), by itself or in a moving cache of guides.
        /// Files of earlier builds, with tensors of the safetensors format, are read too. The film then begins with
        /// hair and body as they are there. Without it hair begins at rest.
        pose: Option<PathBuf> = None;
    }
}

/// Strands that a style grows for each guide.
const GROWN: usize = 8;
/// Drawn strands of each guide of a style: its own, and follow strands between them.
const DRAWN: usize = 16;

/// Strands that a style of some guides grows in all.
pub(super) fn grown(guides: usize, bound: Option<u32>) -> usize {
    bound.map_or(GROWN.saturating_mul(guides), |bound| guides.max(bound as usize))
}

/// Follow strands that fill the hair of a style of some guides.
pub(crate) fn filling(guides: usize, bound: Option<u32>) -> u32 {
    let wanted = DRAWN.saturating_mul(guides);
    wanted.div_ceil(grown(guides, bound).max(1)).clamp(1, DRAWN) as u32
}
