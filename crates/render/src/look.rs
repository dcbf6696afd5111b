use std::path::PathBuf;
use std::sync::Arc;

use glam::Vec3;
use strandline_base::math;
use strandline_base::{Key, Overrides, SettingError, Value, settings};

use crate::Environment;
use crate::coat::Coat;
use crate::fibre::{Chiang, Fibre, FibreModel, Highlight, chiang::Pigment};
use crate::preset::Preset;
use crate::rigs::LightRig;
use crate::surroundings::Surroundings;

settings! {
    /// Colour and shape of the drawn hair.
    ///
    /// Colours are linear RGB. `root_color` or `tip_color` without `fibre.chiang.pigment` means "color".
    pub struct Look {
        /// The look that what is not given comes from: pigment and colours, fibre, highlights, layers of shadow and
        /// surroundings. "thesis" brings `picture.tone_map`, `picture.background` and lights too.
        preset: Preset = Preset::default();
        /// Lights of a scene that names none, about the middle of hair and body; a picture of surroundings comes before
        /// them.
        light_rig: LightRig = LightRig::default();
        /// Follow strands of each guide, the guide itself among them.
        follow_strands: u32 = 16, in [1, 1024], slider [1, 64],
            more "denser hair of thinner strands, at a cost that grows with it";
        /// Hairs that the drawn strands stand for: each strand is widened so that together they cover as
        /// much as this many hairs; 0 draws every strand as one hair. Those of a beard, brows and lashes that grow
        /// beside the hair come on top.
        hair_count: u32 = 100_000, in [0, 100_000_000], slider [0, 200_000], more "wider strands";
        /// Multiple of the groom's root diameters.
        width_scale: f32 = 1.0, in [0.0, 1000.0], slider [0.1, 5.0], more "wider strands";
        /// Diameter at the tip as a share of that at the root.
        tip_width: f32 = 0.3, in [0.0, 1.0], more "blunter tips";
        /// Diameter where a strand leaves the skin as a share of that 4 mm on; a file's widths are taken as they are.
        root_width: f32 = 0.4, in [0.0, 1.0], more "blunter roots";
        /// Reflectance at the root, linear RGB; with `fibre.chiang.pigment = "color"`, what hair shows beside white hair.
        root_color: Vec3 = Vec3::new(0.115, 0.056, 0.027), in [0.0, 1.0];
        /// Reflectance at the tip, linear RGB, the same way.
        tip_color: Vec3 = Vec3::new(0.22, 0.115, 0.058), in [0.0, 1.0];
        /// Scattering by one hair.
        fibre: Fibre = Fibre::default();
        /// Spread of brightness among strands as a share of it.
        variation: f32 = 0.35, in [0.0, 1.0], more "strands that differ more";
        /// Share of strands that have turned white.
        grey: f32 = 0.0, in [0.0, 1.0], more "whiter hair";
        /// Noise along and among strands by which highlights are moved.
        highlight_noise: f32 = 1.5, in [0.0, 45.0] "degrees", more "more ragged highlights";
        /// Shape of the drawn strands about their guide.
        clump: Clump = Clump::default();
        /// Water or lacquer on the hair.
        coat: Coat = Coat::default();
        /// Shadows of hair and body.
        shadow: Shadow = Shadow { layers: [0.005, 0.015, 0.05], ..Shadow::default() };
        /// Light from all around.
        environment: Environment = Environment::default();
        /// A .png with the colour of each strand, sRGB, over where roots lie on the scalp (the groom's root
        /// coordinates; the first is to the right, the second up). It replaces colours of the groom. A scene takes
        /// maps and groups in when it is loaded.
        color_map: Option<PathBuf> = None;
        /// Colours strands as the body's materials are at their roots, where the groom has no colours: fur of an animal.
        body_colors: bool = false;
        /// A .png with the width of each strand as a share of its own: white is all of it, black none.
        width_map: Option<PathBuf> = None;
        /// Groups of strands that look other than all, at most 256. A setting that a group does not give is that of all
        /// but its tip colour, which is that of its root; a colour or a map of a group wins over its pigment.
        group: Vec<GroupLook> = Vec::new(), in [0, 256];
        /// Seed of every random choice of the look.
        seed: u32 = 0, in [0, u32::MAX];
        plain {
            /// A picture of the surroundings in the place of `environment`.
            surroundings: Option<Arc<Surroundings>>,
        }
        moved {
            first_highlight: <Highlight as Value>::Given => "look.fibre.scheuermann.first_highlight",
            second_highlight: <Highlight as Value>::Given => "look.fibre.scheuermann.second_highlight",
            sparkle: f32 => "look.fibre.scheuermann.sparkle",
            translucency: f32 => "look.fibre.scheuermann.translucency",
        }
    }
    prepare Look::prepare;
}

settings! {
    /// The look of one group of strands; what it does not give is that of all. The first that names a group counts.
    pub struct GroupLook {
        /// Name of the group in the groom, or its number; of files that are brought together each is a group of
        /// its name.
        name: String = String::new(), required true;
        /// Multiple of the groom's root diameters, on top of that of all.
        width_scale: f32 = 1.0, in [0.0, 1000.0], slider [0.1, 5.0], more "wider strands";
        /// Multiple of `look.clump`'s radii and of the waves of drawn strands. Without it one that fits groups whose
        /// roots stand closer than those of most hair, where the radii are fitted too.
        clump: Option<f32> = None, in [0.0, 10.0];
        overrides Look {
            root_color: Vec3,
            tip_color: Vec3,
            variation: f32,
            grey: f32,
            color_map: PathBuf,
            width_map: PathBuf,
        }
        overrides Chiang {
            eumelanin: f32,
            pheomelanin: f32,
            tip_pigment: f32,
        }
    }
}

impl GroupLook {
    /// The look of all with the pigment of this group; `None` where the group gives none.
    pub fn own_pigment(&self, all: &Look) -> Option<Look> {
        let mut look = all.clone();
        look.fibre.chiang = self.over(&all.fibre.chiang);
        look.variation = self.variation.unwrap_or(all.variation);
        look.grey = self.grey.unwrap_or(all.grey);
        let has_melanin = [self.eumelanin, self.pheomelanin, self.tip_pigment].iter().any(Option::is_some);
        if has_melanin {
            look.fibre.model = FibreModel::Chiang;
            look.fibre.chiang.pigment = Pigment::Melanin;
        }
        (has_melanin || self.variation.is_some() || self.grey.is_some()).then_some(look)
    }
}

settings! {
    /// Shape of follow strands about their guide [Chen2011 §3.2].
    pub struct Clump: Copy {
        /// Radius of the clump at the roots.
        root_radius: f32 = 0.005, in [0.0, 1.0] "m", slider [0.0, 0.02], more "hair that is spread more evenly";
        /// Radius of the clump at the tips.
        tip_radius: f32 = 0.003, in [0.0, 1.0] "m", slider [0.0, 0.02], more "softer, less pointed locks";
        /// Exponent of the way from root to tip radius; above 1 the clump closes late.
        taper: f32 = 1.5, in [0.1, 10.0], more "clumps that close nearer to the tips";
        /// Lift of hair combed along the skin, from 0 (half of the strands inside) to 1 (the guide is the
        /// innermost).
        lift: f32 = 0.85, in [0.0, 1.0], more "fuller hair that shows less skin";
        /// Greatest share by which a follow strand is shorter than its guide.
        shorter: f32 = 0.12, in [0.0, 0.9], more "softer, more uneven ends";
        /// Amplitude of each strand's own waves at the tip; there are none at the root.
        wave_amplitude: f32 = 0.001, in [0.0, 1.0] "m", slider [0.0, 0.01], more "more disorder";
        /// Mean length of those waves.
        wave_length: f32 = 0.06, in [1e-3, 10.0] "m", slider [0.01, 0.2], more "calmer waves";
        plain {
            /// Share of the radius by which a coat draws the strands together on their way to the tips.
            together: f32,
        }
    }
}

settings! {
    /// Shadows of hair and body \[Yuksel2008\].
    pub struct Shadow: Copy {
        /// Texels along each side of a light's maps; on a GPU at most 2,048 with two shadow lights, 1,024
        /// with eight. 0 chooses them by the hair: 512, and for dense light hair, which 512 draw up to 0.2 darker than path
        /// tracing does, 1,536 with up to three places of lights with shadow, then fewer, 1,408 with four, 1,152 with six and
        /// 1,024 with eight; a browser page has 1,408 with one and 1,024 with two. Fewer than 16 count as 16.
        map_size: u32 = 0, in [0, 4096], slider [0, 2048], more "sharper shadows, at a cost in time and memory";
        /// Distances behind the first hair at which the three layers end, rising; hair farther behind it
        /// casts no shadow.
        layers: [f32; 3] = [0.015, 0.05, 0.15], in [1e-6, 1000.0] "m", slider [0.001, 0.3];
        /// Share of the light that one hair takes away where it is crossed: most of what meets a hair goes
        /// on, scattered forward.
        opacity: f32 = 0.3, in [0.0, 0.99], more "darker shadows within the hair";
        /// Depth under the body's surface at which its shadow begins.
        body_bias: f32 = 0.004, in [0.0, 1.0] "m", slider [0.0, 0.02], more "fewer false shadows on the body";
        /// Depth over which that shadow grows to its full.
        body_softness: f32 = 0.008, in [1e-6, 1.0] "m", slider [0.001, 0.05], more "softer shadows of the body";
        /// Rays from a place of skin at the edge of a shadow to a light with an area, shared out among its samples: each
        /// gets one at least.
        rays: u32 = 64, in [1, 256], slider [8, 128], more "smoother shadows on skin, at a cost in time";
        plain {
            /// True if a hair hides everything behind it, for any `opacity`.
            solid: bool,
            /// True for simpler pictures: a mesh of few triangles stands for the body in shadows and scattered light, and
            /// soft shadows on it are found for one of four pixels. Has an effect on the CPU alone.
            simple: bool,
        }
    }
    also Shadow::rising;
}

impl Shadow {
    /// Rays to each of so many samples of a light.
    pub(crate) fn rays_of(&self, samples: usize) -> usize {
        (self.rays as usize / samples).max(1)
    }

    /// Logarithm of the share of light that one hair lets through.
    pub(crate) fn log_transmission(&self) -> f32 {
        if self.solid { -1.0 } else { math::ln(1.0 - self.opacity) }
    }

    fn rising(&self, key: &Key) -> Result<(), SettingError> {
        let [first, second, third] = self.layers;
        if first < second && second < third {
            return Ok(());
        }
        let expected = "three distances that rise";
        Err(SettingError::new(key.of("layers"), format!("{:?}", self.layers), expected))
    }
}
