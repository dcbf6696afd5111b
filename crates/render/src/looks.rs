//! Looks by name.

use glam::Vec3;
use strandline_base::{Group, Value};

use crate::fibre::{FibreModel, Scheuermann, chiang::Pigment};
use crate::light_field::{self, Field};
use crate::{Environment, Light, LightRig, Look, Preset, RenderError, Shadow};

/// Pigment of hair that a dye covers, and what it is if `pigment` is melanin again: that of brown hair.
const PLAIN: [f32; 3] = [1.3, 0.1, 1.0];

impl Preset {
    /// True for a colour that no hair has by itself: the look's colours decide in the place of melanin.
    pub const fn is_dyed(self) -> bool {
        matches!(self, Self::Blue | Self::Pink | Self::Violet | Self::Green)
    }
}

impl Look {
    /// Lights that shine from the surroundings.
    pub(crate) fn suns(&self) -> &[Light] {
        self.surroundings.as_ref().map_or(&[], |surroundings| surroundings.suns())
    }

    /// Brown hair, the default.
    pub fn brown() -> Self {
        Self::default()
    }

    /// Black hair.
    pub fn black() -> Self {
        Self::named(Preset::Black)
    }

    /// Blonde hair, lighter toward the tips.
    pub fn blonde() -> Self {
        Self::named(Preset::Blonde)
    }

    /// Red hair.
    pub fn red() -> Self {
        Self::named(Preset::Red)
    }

    /// Grey hair: white strands among dark ones.
    pub fn grey() -> Self {
        Self::named(Preset::Grey)
    }

    /// Brown hair as [Chen2011 §3.4] lights it, with the fibre of \[Scheuermann2004\].
    pub fn thesis() -> Self {
        Self::named(Preset::Thesis)
    }

    /// Light red hair.
    pub fn copper() -> Self {
        Self::named(Preset::Copper)
    }

    /// White hair.
    pub fn white() -> Self {
        Self::named(Preset::White)
    }

    /// A look by its name.
    pub fn named(preset: Preset) -> Self {
        let mut look = Self::default();
        look.dress(preset);
        look
    }

    /// Takes what light meets from a named look: colours and pigment, fibre, highlights, layers of shadow, surroundings
    /// and how roots taper. How strands lie and how many there are stays.
    pub fn dress(&mut self, preset: Preset) {
        let base = Self::default();
        self.preset = preset;
        self.fibre = base.fibre;
        self.highlight_noise = base.highlight_noise;
        self.shadow.layers = base.shadow.layers;
        self.environment = base.environment;
        self.root_width = base.root_width;
        let (root, tip, melanin, grey) = match preset {
            Preset::Brown | Preset::Thesis => (base.root_color, base.tip_color, [1.3, 0.1, 1.0], 0.0),
            Preset::Black => {
                (Vec3::new(0.016, 0.013, 0.012), Vec3::new(0.026, 0.021, 0.019), [8.0, 0.0, 1.0], 0.0)
            }
            Preset::Blonde => {
                (Vec3::new(0.46, 0.31, 0.165), Vec3::new(0.68, 0.51, 0.31), [0.3, 0.0, 0.7], 0.0)
            }
            Preset::Red => {
                (Vec3::new(0.17, 0.042, 0.015), Vec3::new(0.24, 0.065, 0.024), [0.25, 1.6, 0.9], 0.0)
            }
            Preset::Copper => {
                (Vec3::new(0.34, 0.10, 0.035), Vec3::new(0.46, 0.165, 0.06), [0.0, 0.9, 1.0], 0.0)
            }
            Preset::Grey => (Vec3::new(0.17, 0.16, 0.15), Vec3::new(0.22, 0.21, 0.20), [2.0, 0.0, 1.0], 0.6),
            Preset::White => (Vec3::new(0.72, 0.69, 0.64), Vec3::new(0.76, 0.74, 0.70), [2.0, 0.0, 1.0], 1.0),
            Preset::Blue => (Vec3::new(0.020, 0.055, 0.30), Vec3::new(0.035, 0.11, 0.42), PLAIN, 0.0),
            Preset::Pink => (Vec3::new(0.62, 0.13, 0.27), Vec3::new(0.80, 0.30, 0.44), PLAIN, 0.0),
            Preset::Violet => (Vec3::new(0.13, 0.030, 0.26), Vec3::new(0.24, 0.075, 0.42), PLAIN, 0.0),
            Preset::Green => (Vec3::new(0.018, 0.20, 0.085), Vec3::new(0.050, 0.36, 0.17), PLAIN, 0.0),
        };
        (self.root_color, self.tip_color, self.grey) = (root, tip, grey);
        let fibre = &mut self.fibre.chiang;
        [fibre.eumelanin, fibre.pheomelanin, fibre.tip_pigment] = melanin;
        if preset.is_dyed() {
            fibre.pigment = Pigment::Color;
        }
        if preset == Preset::Black {
            // Straight, thick hair has flat scales: its ring of light is narrow and even.
            (fibre.roughness_along, self.highlight_noise) = (0.18, 0.8);
        }
        if preset == Preset::Thesis {
            self.fibre.model = FibreModel::Scheuermann;
            self.highlight_noise = 4.0;
            self.root_width = 1.0;
            self.shadow.layers = Shadow::default().layers;
            self.environment =
                Environment { sky: Vec3::new(0.26, 0.29, 0.33), ground: Vec3::new(0.13, 0.11, 0.10) };
        }
    }

    /// The same with a change of the thesis's fibre.
    pub fn with_scheuermann(mut self, change: impl FnOnce(&mut Scheuermann)) -> Self {
        change(&mut self.fibre.scheuermann);
        self
    }

    /// Missing keys come from the named look; given colours stay.
    pub(crate) fn prepare(&mut self, given: &<Self as Value>::Given) {
        if let Some(preset) = given.preset {
            self.dress(preset);
        }
        if given.root_color.is_some() || given.tip_color.is_some() {
            self.fibre.chiang.pigment = Pigment::Color;
        }
        // Older files had these beside the settings of all fibres.
        let old = &mut self.fibre.scheuermann;
        given.first_highlight.clone().into_iter().for_each(|highlight| old.first_highlight.take(highlight));
        given.second_highlight.clone().into_iter().for_each(|highlight| old.second_highlight.take(highlight));
        old.sparkle = given.sparkle.unwrap_or(old.sparkle);
        old.translucency = given.translucency.unwrap_or(old.translucency);
    }

    /// Light from all around, and none of its suns.
    pub fn around(&self) -> Field {
        match &self.surroundings {
            Some(surroundings) => surroundings.field,
            None => self.environment.field(),
        }
    }

    /// That light as a gradient from below to above.
    pub(crate) fn gradient(&self) -> Environment {
        match &self.surroundings {
            None => self.environment,
            Some(surroundings) => {
                let from = |way| light_field::radiance(&surroundings.field, way).truncate();
                Environment { sky: from(Vec3::Y), ground: from(Vec3::NEG_Y) }
            }
        }
    }

    /// Factor of the colour of skin among dense roots; hair has its `own` colour, if there is one.
    pub(crate) fn scalp(&self, share: f32, own: Option<Vec3>) -> Vec3 {
        if !self.fibre.model.scatters_many_times() {
            return Vec3::ONE;
        }
        let color = own.map_or_else(|| self.fibre.chiang.block_albedo(self.root_color), |own| own * own);
        // Light comes through few hairs there: paler than a mass of them.
        Vec3::ONE.lerp(color.max(Vec3::ZERO).map(f32::sqrt), share)
    }

    /// The lights that a scene without lights has, about a head at `target` \[m\] that faces +z: none where a picture of
    /// the surroundings lights it.
    pub fn lights(&self, target: Vec3) -> Vec<Light> {
        if self.surroundings.is_some() {
            return Vec::new();
        }
        match self.light_rig {
            LightRig::Auto if self.fibre.model.scatters_many_times() => Light::studio(target).to_vec(),
            LightRig::StudioLights => Light::studio(target).to_vec(),
            LightRig::AllSides => Light::all_sides(target).to_vec(),
            LightRig::Auto | LightRig::ThreePoint => Light::three_point(target).to_vec(),
        }
    }

    /// Shadows of hair and body with this fibre.
    pub fn hair_shadow(&self) -> Shadow {
        Shadow { solid: self.fibre.model.scatters_many_times() || self.shadow.solid, ..self.shadow }
    }

    /// Checks every setting.
    ///
    /// # Errors
    /// The first setting outside its range.
    pub fn validate(&self) -> Result<(), RenderError> {
        Ok(self.check_as("look")?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_look_by_name_is_dressed_anew() {
        for preset in Preset::ALL {
            let mut look = Look::named(preset);
            look.validate().unwrap();
            look.follow_strands = 3;
            look.dress(Preset::Black);
            look.dress(preset);
            assert_eq!(look, Look { follow_strands: 3, ..Look::named(preset) });
        }
        assert_eq!(Look::brown(), Look::named(Preset::Brown));
        assert_ne!(Look::thesis().fibre.model, Look::brown().fibre.model);
    }

    /// Colour of a thick block of hair of a look, linear RGB.
    fn block(preset: Preset) -> Vec3 {
        let look = Look::named(preset);
        look.fibre.chiang.block_albedo(look.root_color)
    }

    /// Luminance of linear RGB.
    fn luminance(color: Vec3) -> f32 {
        color.dot(Vec3::new(0.2126, 0.7152, 0.0722))
    }

    #[test]
    fn looks_have_the_colour_of_their_name() {
        use Preset::{Black, Blonde, Blue, Brown, Copper, Green, Pink, Red, Violet};
        let [black, brown, red, copper, blonde] = [Black, Brown, Red, Copper, Blonde].map(block);
        let rising = [black, brown, copper, blonde].map(luminance);
        assert!(rising.windows(2).all(|pair| 1.2 * pair[0] < pair[1]), "{rising:?}");
        let redness = |color: Vec3| color.x / color.y;
        assert!(redness(red) > 1.25 * redness(brown) && redness(copper) > 1.1 * redness(blonde));
        assert!(luminance(red) < 0.8 * luminance(copper), "{red} {copper}");
        assert!(black.max_element() < 1.6 * black.min_element() + 0.02 && luminance(black) < 0.04, "{black}");
        let [blue, pink, violet, green] = [Blue, Pink, Violet, Green].map(block);
        assert!(blue.z > 3.0 * blue.x && green.y > 2.0 * green.x.max(green.z), "{blue} {green}");
        assert!(pink.x > 1.8 * pink.y && pink.z > pink.y && violet.z > violet.x && violet.x > 2.0 * violet.y);
        assert_eq!([Look::white().grey, Look::grey().grey], [1.0, 0.6]);
    }

    /// Lightness, chroma and hue [degrees] in CIE L*C*h of a colour, linear RGB, in white light (D65).
    fn lightness_chroma_hue(color: Vec3) -> [f32; 3] {
        let rows = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]];
        let [x, y, z] = rows.map(|row| {
            let share = color.dot(Vec3::from(row)) / row.iter().sum::<f32>();
            if share > 0.008_856 { share.cbrt() } else { 7.787 * share + 16.0 / 116.0 }
        });
        let (a, b) = (500.0 * (x - y), 200.0 * (y - z));
        [116.0 * y - 16.0, a.hypot(b), b.atan2(a).to_degrees().rem_euclid(360.0)]
    }

    /// The colour of hair of a look at its root beside white hair in the same light, linear RGB: see `color_scale` of the
    /// fibre.
    fn shown(preset: Preset) -> Vec3 {
        let look = Look::named(preset);
        if preset.is_dyed() {
            look.root_color
        } else {
            block(preset).map(f32::sqrt).lerp(Vec3::ONE, look.grey)
        }
    }

    #[test]
    fn names_read_as_their_names() {
        use Preset::{Black, Blonde, Blue, Brown, Copper, Green, Grey, Pink, Red, Violet, White};
        // Ranges of lightness, chroma and hue [degrees] of docs/methods/looks.md.
        let ranges = [
            (Black, [0.0, 8.0], [0.0, 8.0], [0.0, 360.0]),
            (Brown, [22.0, 40.0], [12.0, 30.0], [50.0, 85.0]),
            (Red, [28.0, 45.0], [28.0, 50.0], [30.0, 73.0]),
            (Copper, [42.0, 58.0], [28.0, 50.0], [40.0, 78.0]),
            (Blonde, [55.0, 82.0], [12.0, 32.0], [76.0, 95.0]),
            (Grey, [60.0, 90.0], [0.0, 5.0], [0.0, 360.0]),
            (White, [90.0, 100.1], [0.0, 3.0], [0.0, 360.0]),
            (Blue, [20.0, 50.0], [35.0, 80.0], [265.0, 310.0]),
            (Pink, [45.0, 75.0], [30.0, 60.0], [340.0, 360.0]),
            (Violet, [20.0, 45.0], [40.0, 70.0], [300.0, 325.0]),
            (Green, [35.0, 65.0], [25.0, 60.0], [140.0, 170.0]),
        ];
        let named = Preset::ALL.iter().filter(|preset| **preset != Preset::Thesis).count();
        assert_eq!(named, ranges.len(), "a look without ranges");
        for (preset, lightness, chroma, hue) in ranges {
            let values = lightness_chroma_hue(shown(preset));
            println!("{preset:?} {values:.1?}");
            for (value, [low, high]) in values.into_iter().zip([lightness, chroma, hue]) {
                assert!((low..=high).contains(&value), "{preset:?}: {values:?}");
            }
        }
        let of = |preset| lightness_chroma_hue(shown(preset));
        assert!(of(Red)[2] < of(Brown)[2] && of(Red)[1] > 1.25 * of(Brown)[1], "red is redder than brown");
    }

    #[test]
    fn looks_are_near_measured_hair() {
        // Hair measured in an integrating sphere, specular light left out [Scanavez2000, tables III, IV]: L* of black and
        // of dark brown hair.
        let from_lightness = |lightness: f32| ((lightness + 16.0) / 116.0).powi(3);
        let [black, brown] = [18.0, 23.6].map(from_lightness);
        let [drawn_black, drawn_brown] =
            [Preset::Black, Preset::Brown].map(|preset| luminance(block(preset)));
        // Black hair sends back what its surface reflects, and brown hair as much beside the light from its inside.
        assert!(drawn_black < 0.1 * black, "{drawn_black} {black}");
        let all = drawn_brown + black;
        assert!((0.7 * brown..1.4 * brown).contains(&all), "{all} {brown}");
    }
}
