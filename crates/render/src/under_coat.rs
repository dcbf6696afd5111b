//! The look of hair under its coat.

use std::borrow::Cow;

use glam::Vec3;
use strandline_base::math;

use crate::coat::Coat;
use crate::fibre::FibreModel;
use crate::look::Look;

/// Range of the roughness of a fibre, and of the width of a highlight \[degrees\].
const ROUGHNESS: [f32; 2] = [0.05, 1.0];
const WIDTH: [f32; 2] = [0.5, 60.0];
/// Most noise of highlights.
const MOST_NOISE: f32 = 45.0;

impl Look {
    /// The look of the hair under its coat, without one.
    pub fn under_coat(&self) -> Cow<'_, Self> {
        if self.coat == Coat::NONE {
            return Cow::Borrowed(self);
        }
        let Coat { pigment, roughness, gather } = self.coat;
        let mut look = self.clone();
        look.coat = Coat::NONE;
        let smoother = |own: &mut f32, [least, most]: [f32; 2]| *own = (*own * roughness).clamp(least, most);
        smoother(&mut look.fibre.chiang.roughness_along, ROUGHNESS);
        look.fibre.chiang.further_pigment = pigment - 1.0;
        let highlights = &mut look.fibre.scheuermann;
        smoother(&mut highlights.first_highlight.width, WIDTH);
        smoother(&mut highlights.second_highlight.width, WIDTH);
        look.highlight_noise = (look.highlight_noise * roughness).min(MOST_NOISE);
        if look.fibre.model == FibreModel::Scheuermann {
            // The colour falls with the root of the pigment, as that of the other fibre does.
            let darker = |color: Vec3| color.map(|channel| math::powf(channel, pigment.sqrt()));
            (look.root_color, look.tip_color) = (darker(look.root_color), darker(look.tip_color));
        }
        look.clump.together = gather;
        look.clump.wave_amplitude *= 1.0 - gather;
        Cow::Owned(look)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Preset;

    #[test]
    fn the_default_is_no_coat_and_a_coat_is_taken_off_once() {
        assert_eq!(Coat::default(), Coat::NONE);
        assert!(matches!(Look::brown().under_coat(), Cow::Borrowed(_)));
        let rough = Coat { roughness: 2.0, ..Coat::NONE };
        Look { coat: rough, highlight_noise: 45.0, ..Look::brown() }.under_coat().validate().unwrap();
        let wet = Look { coat: Coat::WATER, ..Look::brown() };
        let under = wet.under_coat().into_owned();
        under.validate().unwrap();
        assert_eq!(*under.under_coat(), under);
    }

    #[test]
    fn hair_under_water_is_darker_and_smoother_for_both_fibres_and_all_sources_of_colour() {
        let luminance = |color: Vec3| color.dot(Vec3::new(0.2126, 0.7152, 0.0722));
        for preset in Preset::ALL {
            let dry = Look::named(preset);
            let wet = Look { coat: Coat::WATER, ..dry.clone() };
            let under = wet.under_coat();
            let shown = |look: &Look| match look.fibre.model {
                FibreModel::Chiang => luminance(look.fibre.chiang.block_albedo(look.root_color)).sqrt(),
                FibreModel::Scheuermann => luminance(look.root_color),
            };
            let share = shown(&under) / shown(&dry);
            assert!(share < 0.95, "{preset:?}: {share}");
            let ratio = under.fibre.chiang.roughness_along / dry.fibre.chiang.roughness_along;
            assert!((ratio - 0.5).abs() < 1e-6, "{preset:?}: {ratio}");
        }
        // A colour of the groom and of the look, as a pigment.
        let wet = Look { coat: Coat::WATER, ..Look::brown() };
        let color = Vec3::new(0.3, 0.2, 0.1);
        let [dry, wet] = [Look::brown().fibre.chiang, wet.under_coat().fibre.chiang];
        assert!((wet.inks(color) / dry.inks(color) - 2.0).abs().max_element() < 1e-5);
        let [dry, wet] = [dry, wet].map(|fibre| fibre.absorption_of_color(color));
        assert!((wet[0] / dry[0] - 2.0).abs() < 1e-9);
    }
}
