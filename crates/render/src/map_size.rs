//! Texels of shadow maps where a look leaves them open.

use std::borrow::Cow;

use glam::Vec3;
use strandline_groom::Guides;

use crate::fibre::Pigment;
use crate::lights::shadow_places;
use crate::strands::clump::widening;
use crate::{Light, Look, OwnColors, Shadow};

/// Texels along a side of most maps.
const USUAL: u32 = 512;
/// Most and fewest texels along a side of the maps of dense light hair, and between sizes: the lights share the room.
const FINEST: u32 = 1536;
const COARSEST: u32 = 1024;
const STEP: u32 = 64;
/// Most texels of all fine maps: a GPU within WebGPU's default limits holds as many, a browser page a quarter.
const MOST_TEXELS: u64 = if usize::BITS < 64 { 1 << 21 } else { 1 << 23 };
/// Fewest texels along a side.
const LEAST: u32 = 16;
/// Absorption per fibre radius of a channel below which hair is light: blonde has 0.1, copper 0.17, a light brown 0.29.
const LIGHT_BELOW: f64 = 0.25;
/// Share of white strands from which on hair is light.
const LIGHT_GREY: f32 = 0.5;
/// Hairs one behind another from which on hair is dense: a bob has 20 of them, the ball of the references 2. A
/// coarse texel hides hair behind the nearest one in it, and hair in sparse mass lies farther apart than that.
const DENSE: f32 = 6.0;
/// Most strands that are looked at.
const LOOKED_AT: usize = 1024;

impl Shadow {
    /// Texels along each side of a light's maps; the usual number where the settings leave them open.
    pub fn size(&self) -> u32 {
        if self.map_size == 0 { USUAL } else { self.map_size.max(LEAST) }
    }
}

impl Look {
    /// The look that is drawn with lights, whose places are counted, on a groom with colours of its own or none: under its
    /// coat, with the texels of shadow maps chosen.
    pub(crate) fn drawn(&self, lights: &[Light], own: Option<&OwnColors>, guides: &Guides) -> Cow<'_, Self> {
        let mut look = self.under_coat();
        let places = shadow_places(lights, look.suns());
        let size = look.map_size(places, own.map(|own| own.mean), Some(guides));
        if size != look.shadow.map_size {
            look.to_mut().shadow.map_size = size;
        }
        look
    }

    /// Texels along each side of the maps of so many places of lights with shadow, of hair with a mean of its own colours or
    /// none; hair without guides is taken as dense.
    pub(crate) fn map_size(&self, places: u64, own: Option<Vec3>, guides: Option<&Guides>) -> u32 {
        if self.shadow.map_size > 0 || !self.is_light(own) {
            return self.shadow.size();
        }
        if guides.is_some_and(|guides| self.layers(guides) < DENSE) {
            return USUAL;
        }
        let most = (MOST_TEXELS / places.max(1)).isqrt() as u32;
        let size = (most - most % STEP).min(FINEST);
        if size < COARSEST { USUAL } else { size }
    }

    /// True for hair that is light in a channel as a whole: most of what it shows has been scattered often.
    fn is_light(&self, own: Option<Vec3>) -> bool {
        let fibre = &self.fibre.chiang;
        let absorption = match (own, fibre.pigment) {
            _ if !self.fibre.model.scatters_many_times() => return false,
            (Some(own), _) => fibre.absorption_of_color(own),
            (None, _) if self.grey >= LIGHT_GREY => return true,
            (None, Pigment::Color) => fibre.absorption_of_color(0.5 * (self.root_color + self.tip_color)),
            (None, Pigment::Melanin) => {
                let share = 0.5 * (1.0 + f64::from(fibre.tip_pigment));
                fibre.absorption(self.root_color).map(|sigma| share * sigma)
            }
        };
        absorption.into_iter().any(|sigma| sigma < LIGHT_BELOW)
    }

    /// Hairs one behind another: the area of all drawn strands over the largest side of the box around them, by some of them.
    fn layers(&self, guides: &Guides) -> f32 {
        let (strands, points) = (guides.strand_count(), guides.points_per_strand());
        let every = strands.div_ceil(LOOKED_AT).max(1);
        let (mut min, mut max, mut area) = (Vec3::MAX, Vec3::MIN, 0.0);
        for strand in (0..strands).step_by(every) {
            let places = (0..points).map(|point| guides.position(strand, point));
            let segments = places.clone().zip(places.clone().skip(1));
            area += guides.widths()[strand] * segments.map(|(one, two)| one.distance(two)).sum::<f32>();
            (min, max) = places.fold((min, max), |(min, max), place| (min.min(place), max.max(place)));
        }
        let sides = max - min;
        let largest = (sides.x * sides.y).max(sides.y * sides.z).max(sides.z * sides.x);
        let drawn = every as f32 * self.follow_strands as f32 * widening(self, guides.hair_strands());
        drawn * area / largest.max(f32::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use strandline_groom::Groom;

    use super::*;
    use crate::{LightKind, Preset};

    /// A lawn of 900 hairs of 20 cm on 30 x 20 cm.
    fn lawn() -> Guides {
        let mut groom = Groom::empty(8e-5);
        for strand in 0..900 {
            let root = Vec3::new(0.01 * (strand % 30) as f32, 0.0, 0.2 / 30.0 * (strand / 30) as f32);
            groom.push([root, root + 0.2 * Vec3::Y]);
        }
        Guides::resample(&groom, 4).unwrap()
    }

    /// Texels along a side of the maps of a look with so many spots with shadow.
    fn size(look: &Look, spots: usize, own: Option<Vec3>) -> u32 {
        let own = own.map(|mean| OwnColors { mean, darkest: Vec3::ZERO, lightest: Vec3::ONE });
        look.drawn(&vec![Light::default(); spots], own.as_ref(), &lawn()).shadow.map_size
    }

    #[test]
    fn maps_of_light_hair_are_finer_where_lights_leave_room() {
        for preset in Preset::ALL {
            let look = Look::named(preset);
            let is_dark = matches!(preset, Preset::Black | Preset::Brown | Preset::Red | Preset::Thesis);
            assert_eq!(size(&look, 1, None), if is_dark { 512 } else { 1536 }, "{preset:?}");
        }
        let blonde = Look::blonde();
        let sizes = [0, 3, 4, 6, 8, 9, 64].map(|count| size(&blonde, count, None));
        assert_eq!(sizes, [1536, 1536, 1408, 1152, 1024, 512, 512]);
        // Light that casts no shadow has no map; a soft box has one for each place.
        let none = Light { shadow: false, ..Light::default() };
        let soft = Light { kind: LightKind::Disc, samples: 3, ..Light::default() };
        let sizes =
            [[none; 9], [soft; 9]].map(|lights| blonde.drawn(&lights[..1], None, &lawn()).shadow.map_size);
        assert_eq!(sizes, [1536, 512]);
    }

    #[test]
    fn colours_of_a_groom_and_given_texels_decide() {
        let (light, dark) = (Vec3::new(0.6, 0.4, 0.2), Vec3::splat(0.05));
        assert_eq!([light, dark].map(|own| size(&Look::brown(), 1, Some(own))), [1536, 512]);
        assert_eq!(size(&Look::white(), 1, Some(dark)), 512);
        let mut given = Look::white();
        for (texels, expected) in [(300, 300), (512, 512), (3, LEAST)] {
            given.shadow.map_size = texels;
            assert_eq!(size(&given, 1, None), expected);
        }
    }

    #[test]
    fn sparse_hair_keeps_coarse_maps() {
        // 100,000 hairs of 0.08 mm and 20 cm before 30 x 20 cm.
        let mut look = Look::blonde();
        let layers = look.layers(&lawn());
        assert!((layers / 27.6 - 1.0).abs() < 0.05, "{layers}");
        (look.follow_strands, look.hair_count) = (1, 0);
        let layers = look.layers(&lawn());
        assert!((layers / (27.6 * 900.0 / 100_000.0) - 1.0).abs() < 0.05, "{layers}");
        assert_eq!(size(&look, 1, None), 512);
    }
}
