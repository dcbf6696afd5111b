//! Memory of a picture, and limits of what can be drawn.

use glam::Vec3;
use strandline_base::{
    SettingError,
    memory::{self, Need},
};

use crate::lights::shadow_places;
use crate::scatter::ways::{DIRECTIONS, SETS, TANGENTS};
use crate::shadow::part_count;
use crate::{DetailLevel, LevelOfDetail, Light, Look, PictureSettings, RenderError};

/// Most lights of a picture: each point that is drawn asks every one of them.
pub const MAX_LIGHTS: usize = 64;

/// Most points that the segments of a picture can name on the CPU.
pub(crate) const MOST_POINTS: usize = 1 << 26;
/// Points left to segments that are cut by the near plane.
const CUT_POINTS: u64 = 1 << 22;
/// Bytes of a drawn point: position, tangent, width, radiance, and that with those beside it; its place on the screen;
/// its segment, sorted and listed in tiles.
const POINT_BYTES: u64 = 60 + 16 + 80;
/// Bytes of a guide's point: the smooth curve with its frame.
const CURVE_BYTES: u64 = 36;
/// Bytes of a shadow map's texel: layers and the body's depth, and the sums and depths that each of the threads fills.
const TEXEL_BYTES: u64 = 20;
const PART_BYTES: u64 = 20;
/// Cells of the grid of scattered light that are filled, half of all since hair lies about a body, and bytes of one: along
/// the directions of each set what hair shows, its share of direct light, what leaves the cell and the cell before;
/// effects of cells along half of them; sums and fields.
const GRID_CELLS: u64 = 43 * 43 * 43 / 2;
const CELL_BYTES: u64 = (SETS * DIRECTIONS * (3 * 16 + 4 + 8)) as u64 + 640;
/// Bytes of what two kinds of hair show between directions.
const LATTICE_BYTES: u64 = (2 * SETS * TANGENTS * DIRECTIONS * DIRECTIONS * 16) as u64;

/// Everything of a drawn groom that takes memory.
#[derive(Clone, Copy, Debug)]
pub struct DrawnGroom<'a> {
    /// Number of guides.
    pub guide_count: usize,
    /// Points on each.
    pub points_per_strand: usize,
    /// The hair's look.
    pub look: &'a Look,
    /// The lights as they are given, without their places and without those of the surroundings.
    pub lights: &'a [Light],
    /// Size of the picture.
    pub picture: &'a PictureSettings,
    /// Mean of the colours that the hair has of its own, linear RGB; `None` for those of the look.
    pub own_color: Option<Vec3>,
}

impl DrawnGroom<'_> {
    /// Memory of drawing close up, an upper estimate.
    pub fn memory(&self, level_of_detail: &LevelOfDetail) -> Vec<Need> {
        let of = [self.guide_count, self.points_per_strand];
        self.needs(&level_of_detail.level_of([0.0; 2], self.look.follow_strands, of))
    }

    fn points(&self, level: &DetailLevel) -> u64 {
        let strands = (self.guide_count as u64).saturating_mul(level.strand_count() as u64);
        strands.saturating_mul(level.segment_count(self.points_per_strand) as u64 + 1)
    }

    fn needs(&self, level: &DetailLevel) -> Vec<Need> {
        let curve_points = level.segment_count(self.points_per_strand) as u64 + 1;
        let follow_strands = self.look.follow_strands;
        let drawn = format!("look.follow_strands = {follow_strands} on each of {} guides", self.guide_count);
        let shadows = shadow_places(self.lights, self.look.suns());
        let size = u64::from(self.look.map_size(shadows, self.own_color, None));
        let maps = format!("look.shadow.map_size = {size} for each of {shadows} lights with shadow");
        let texel = TEXEL_BYTES + PART_BYTES * part_count() as u64;
        let PictureSettings { width, height, supersampling, .. } = self.picture;
        let picture = format!("a picture of {width} x {height} pixels at supersampling {supersampling}");
        let scatters = self.look.fibre.model.scatters_many_times();
        let (cells, known) = if scatters { (GRID_CELLS, shadows) } else { (0, 0) };
        vec![
            Need::new("scattered light (look.fibre.model = \"chiang\")", cells, CELL_BYTES),
            Need::new("scattering between directions", u64::from(scatters), LATTICE_BYTES),
            Need::new("light that reaches points", self.points(level), 4 * known),
            Need::new(drawn, self.points(level), POINT_BYTES),
            Need::new("curves", (self.guide_count as u64).saturating_mul(curve_points), CURVE_BYTES),
            Need::new(maps, shadows * size * size, texel),
            Need::new(picture, self.picture.memory(), 1),
        ]
    }

    /// Refuses more than can be drawn on the CPU.
    pub(crate) fn check(&self, level: &DetailLevel) -> Result<(), RenderError> {
        let most = MOST_POINTS as u64 - CUT_POINTS;
        let points = self.points(level);
        if points > most {
            let found = format!("{}, which makes {points} points", self.look.follow_strands);
            let expected = "62914560 points in all at most";
            return Err(SettingError::new("look.follow_strands", found, expected).into());
        }
        memory::check(&self.needs(level))?;
        Ok(())
    }
}

/// Refuses more lights than a picture may have.
///
/// # Errors
/// More than [`MAX_LIGHTS`]; a light with a setting outside its range.
pub fn check_lights(lights: &[Light]) -> Result<(), RenderError> {
    if lights.len() > MAX_LIGHTS {
        return Err(SettingError::new("lights", lights.len(), "64 at most").into());
    }
    lights.iter().try_for_each(Light::validate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_64_lights_are_refused() {
        check_lights(&[Light::default(); MAX_LIGHTS]).unwrap();
        let error = check_lights(&[Light::default(); MAX_LIGHTS + 1]).unwrap_err().to_string();
        assert_eq!(error, "lights is 65, expected 64 at most");
    }

    #[test]
    fn what_is_too_much_is_named_by_its_key() {
        let look = Look { follow_strands: 1024, ..Look::brown() };
        let maps = crate::Shadow { map_size: 4096, ..look.shadow };
        let lights = [Light::default(); 32];
        let (picture, full) = (PictureSettings::sized(64, 64), LevelOfDetail::full());
        let drawn = |look: &Look, guide_count| {
            let drawn = DrawnGroom {
                guide_count,
                points_per_strand: 16,
                look,
                lights: &lights,
                picture: &picture,
                own_color: None,
            };
            drawn.check(&full.level(0.0, look.follow_strands)).map_err(|error| error.to_string())
        };
        assert_eq!(drawn(&Look::brown(), 2000), Ok(()));
        assert!(drawn(&look, 10_000).unwrap_err().starts_with("look.follow_strands is 1024"));
        // 61 points on each of 1,000 x 1,024 strands are few enough to draw and too many for 8 GiB.
        assert!(drawn(&look, 1000).unwrap_err().starts_with("look.follow_strands = 1024 on each of 1000"));
        let look = Look { shadow: maps, ..Look::brown() };
        assert!(drawn(&look, 10).unwrap_err().starts_with("look.shadow.map_size = 4096 for each of 32"));
    }

    #[test]
    fn light_colors_of_its_own_give_dark_hair_the_texels_of_light_hair() {
        let (look, picture) = (Look::brown(), PictureSettings::sized(64, 64));
        let texels = |own_color| {
            let lights = &[Light::default()];
            let drawn = DrawnGroom {
                guide_count: 100,
                points_per_strand: 16,
                look: &look,
                lights,
                picture: &picture,
                own_color,
            };
            let needs = drawn.memory(&LevelOfDetail::full());
            let maps = needs.iter().map(|need| &need.what).find(|what| what.contains("map_size"));
            maps.unwrap().clone()
        };
        let colors = [None, Some(Vec3::splat(0.05)), Some(Vec3::new(0.6, 0.4, 0.2))];
        let sizes = [512, 512, 1536]
            .map(|size| format!("look.shadow.map_size = {size} for each of 1 lights with shadow"));
        assert_eq!(colors.map(texels), sizes);
    }
}
