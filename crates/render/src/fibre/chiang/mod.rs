//! The rough dielectric fibre of \[Chiang2016\], seen from afar: what is thinner than a pixel shows the mean over
//! its width.

mod around;
mod lobes;
mod moments;
mod ring;
mod table;

use glam::{DVec3, Vec3};
use strandline_base::math;
use strandline_base::{choices, settings};

pub(crate) use around::PigmentTerms;
pub use lobes::{LOBES, Lobes};
pub use moments::MOMENTS;
pub(crate) use table::terms_along;
pub use table::{AROUND, ENTRIES, EyeRow, LEVELS, Met, Pigments, Table};

/// Absorption per fibre radius of one unit of eumelanin and of pheomelanin \[d'Eon2011\].
const EUMELANIN: DVec3 = DVec3::new(0.419, 0.697, 1.37);
const PHEOMELANIN: DVec3 = DVec3::new(0.187, 0.4, 1.05);

/// Absorption per fibre radius of the tables of hair that has a colour for each point.
pub(crate) const INK: f64 = 1.2;
/// Darkest colour that hair is taken to have.
const LEAST_COLOR: f32 = 1e-4;

settings! {
    /// The rough dielectric fibre [Chiang2016]. Its paths: R is reflected, TT goes through, TRT comes back from
    /// inside.
    pub struct Chiang: Copy {
        /// Source of the hair's colour.
        pigment: Pigment = Pigment::default();
        /// Brown to black pigment: 0.3 blonde, 1.3 brown, 8 black.
        eumelanin: f32 = 1.3, in [0.0, 100.0], slider [0.0, 8.0], more "darker hair";
        /// Red to yellow pigment.
        pheomelanin: f32 = 0.1, in [0.0, 100.0], slider [0.0, 4.0], more "redder hair";
        /// Pigment at the tip as a share of that at the root, for `pigment = "melanin"`.
        tip_pigment: f32 = 1.0, in [0.0, 2.0], more "darker tips";
        /// Roughness along the fibre.
        roughness_along: f32 = 0.3, in [0.05, 1.0], more "a wider, duller highlight";
        /// Roughness around the fibre.
        roughness_around: f32 = 0.3, in [0.05, 1.0], more "softer light through hair";
        /// Tilt of the scales of the fibre: the white highlight moves toward the root, the coloured one
        /// toward the tip.
        tilt: f32 = 2.0, in [-10.0, 10.0] "degrees", more "highlights further apart";
        /// Index of refraction.
        index: f32 = 1.55, in [1.05, 3.0], more "a brighter surface";
        /// Number of times that light is scattered from hair to hair, at most: dark hair needs few.
        scatterings: u32 = 64, in [0, 64], slider [0, 64], more "brighter light hair, at a cost";
        /// Cells that scattered light is carried through, along the longest side of the hair.
        cells: u32 = MOST_CELLS, in [8, MOST_CELLS], more "sharper scattered light, at a cost";
        plain {
            /// Share of the pigment that a coat adds to it.
            further_pigment: f32,
        }
    }
}

choices! {
    /// Source of the hair's colour.
    pub enum Pigment as "look.fibre.chiang.pigment" {
        /// `eumelanin` and `pheomelanin`.
        Melanin = "melanin",
        /// As much as gives lit hair the hue and saturation of `look.root_color` and `look.tip_color`, or of the colours
        /// that the strands of a file have; 1 is white hair.
        Color = "color",
    }
    default Melanin
}

/// Cells along the longest side of the box around the hair, at most.
pub(crate) const MOST_CELLS: u32 = 39;

/// Pigment of white hair, as a multiple of that of the others.
pub const WHITE: f32 = 0.008;

impl Chiang {
    /// Colours that hair shows at root and tip, linear RGB, for a multiple of the melanin.
    pub fn reflectances(&self, multiple: f32) -> [Vec3; 2] {
        let melanin = Self { pigment: Pigment::Melanin, ..*self };
        let sigma = melanin.absorption(Vec3::ONE);
        let of = |share: f32| {
            let root = |sigma: f64| (sigma * f64::from(multiple * share)).sqrt();
            Vec3::from(sigma.map(|sigma| math::exp(-self.color_scale() * root(sigma)) as f32))
        };
        [of(1.0), of(self.tip_pigment)]
    }

    /// The fibre's lobes.
    pub fn lobes(&self) -> Lobes {
        let [along, around] = [self.roughness_along, self.roughness_around].map(f64::from);
        Lobes::new(along, around, f64::from(self.tilt).to_radians(), f64::from(self.index))
    }

    /// Absorption per fibre radius at the root of the three channels; `color` is the colour that hair shows, for
    /// [`Pigment::Color`].
    pub fn absorption(&self, color: Vec3) -> [f64; 3] {
        match self.pigment {
            Pigment::Melanin => {
                let [eumelanin, pheomelanin] = [self.eumelanin, self.pheomelanin].map(f64::from);
                (self.pigment_times() * (eumelanin * EUMELANIN + pheomelanin * PHEOMELANIN)).to_array()
            }
            Pigment::Color => self.absorption_of_color(color),
        }
    }

    /// Absorption per fibre radius of the three channels of hair that shows a colour, linear RGB.
    pub fn absorption_of_color(&self, color: Vec3) -> [f64; 3] {
        color
            .to_array()
            .map(|c| (math::ln(f64::from(c.clamp(LEAST_COLOR, 1.0))) / self.color_scale()).powi(2))
            .map(|sigma| self.pigment_times() * sigma)
    }

    /// Multiple of the pigment by the coat.
    fn pigment_times(&self) -> f64 {
        1.0 + f64::from(self.further_pigment)
    }

    /// Divisor of the logarithm of a colour that gives the root of its pigment under the coat.
    pub(crate) fn ink_scale(&self) -> f64 {
        self.color_scale() / self.pigment_times().sqrt()
    }

    /// Divisor of the logarithm of such a colour.
    ///
    /// [Chiang2016 §4.2] fits the albedo of a block of fibres. Hair as it lies on a head lets light out sooner: beside
    /// white hair in the same light it shows the square root of that albedo. Path tracing of 40,000 strands shows 0.15,
    /// 0.30, 0.57 and 0.72 of white hair for albedos of 0.02, 0.1, 0.3 and 0.45; half of the divisor makes a colour what
    /// hair shows.
    pub(crate) fn color_scale(&self) -> f64 {
        let b = f64::from(self.roughness_around);
        0.5 * (5.969 + b * (-0.215 + b * (2.532 + b * (-10.73 + b * (5.574 + b * 0.245)))))
    }

    /// Albedo of a block of hair of this pigment: the square of what hair shows.
    pub(crate) fn block_albedo(&self, of_look: Vec3) -> Vec3 {
        let albedo = |sigma: f64| math::exp(-2.0 * self.color_scale() * sigma.sqrt()) as f32;
        Vec3::from(self.absorption(of_look).map(albedo))
    }

    /// Multiples of [`INK`] of hair that shows a colour.
    pub(crate) fn inks(&self, color: Vec3) -> Vec3 {
        let inverse = (1.0 / self.ink_scale()) as f32;
        let roots = color.clamp(Vec3::splat(LEAST_COLOR), Vec3::ONE).map(|c| math::ln(c) * inverse);
        roots * roots * (1.0 / INK as f32)
    }
}
