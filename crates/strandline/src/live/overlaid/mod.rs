//! Overlays: guides with a number of each point, to be drawn over a picture by a window.

pub(super) mod hidden;

use glam::Vec3;

use crate::{
    Prepared,
    groom::Guides,
    sim::{Settings, StrandMethod, rods::RodSettings},
};
use hidden::Silhouette;

/// A number of each point of the guides that is shown over a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlay {
    /// The guides alone.
    Guides,
    /// The roots of the guides.
    Roots,
    /// Length of each segment over its length at rest, less 1.
    Stretch,
    /// Speed over the last frame.
    Speed,
    /// Group of the strand.
    Group,
    /// Distance to the nearest solid.
    Contact,
    /// Bending stiffness.
    Stiffness,
}

impl Overlay {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Guides, Self::Roots, Self::Stretch, Self::Speed, Self::Group, Self::Contact, Self::Stiffness];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Guides => "guides",
            Self::Roots => "roots",
            Self::Stretch => "stretch",
            Self::Speed => "speed",
            Self::Group => "group",
            Self::Contact => "contact",
            Self::Stiffness => "stiffness",
        }
    }

    /// Its meaning, in a sentence.
    pub fn sentence(self) -> &'static str {
        match self {
            Self::Guides => "the strands that are simulated",
            Self::Roots => "the places where the guides grow",
            Self::Stretch => "length of each segment over its length at rest, less 1",
            Self::Speed => "speed of each point over the last frame",
            Self::Group => "group of each strand, by its number",
            Self::Contact => "distance of each point to the nearest solid: 0 touches it",
            Self::Stiffness => "bending stiffness of the hairs that a guide stands for, of rods alone",
        }
    }

    /// Unit of its numbers.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Guides | Self::Roots | Self::Group => "",
            Self::Stretch => "%",
            Self::Speed => "m/s",
            Self::Contact => "mm",
            Self::Stiffness => "nN m^2",
        }
    }
}

/// The guides of a picture with the numbers of an overlay.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlaid {
    /// The overlay.
    pub overlay: Overlay,
    /// Points \[m\], world space, shape `[strand][point]`.
    pub points: Vec<Vec3>,
    /// Points of each strand; one of roots.
    pub points_per_strand: usize,
    /// True for points behind the body, seen from the picture's camera; shape of `points`.
    pub hidden: Vec<bool>,
    /// Numbers in [`Overlay::unit`], shape of `points`; empty where the hair has none.
    pub values: Vec<f32>,
    /// The numbers of the two ends of the colours.
    pub range: [f32; 2],
}

/// Distances \[mm\] over which the colours of contacts run.
pub(super) const NEAR: f32 = 5.0;

/// Stretch \[%\] of the segment before each point of guides that are scaled in length; roots have that of their segment.
pub(super) fn stretches(world: &[Vec3], guides: &Guides, scale: f32) -> Vec<f32> {
    let each = guides.points_per_strand();
    let of = |index: usize| {
        let (strand, point) = (index / each, (index % each).max(1));
        let rest = guides.position(strand, point).distance(guides.position(strand, point - 1)) * scale;
        let now = world[strand * each + point].distance(world[strand * each + point - 1]);
        if rest > 0.0 { 100.0 * (now / rest - 1.0) } else { 0.0 }
    };
    (0..world.len()).map(of).collect()
}

/// Bending stiffnesses \[nN m^2\] of the points of guides, those of groups by their own settings; none without rods.
pub(super) fn stiffnesses(settings: &Settings, guides: &Guides) -> Vec<f32> {
    if settings.strands.method != StrandMethod::Rods {
        return Vec::new();
    }
    let each = guides.points_per_strand();
    let along = |rods: &RodSettings| -> Vec<f32> {
        let share = |point: usize| point as f32 / (each - 1).max(1) as f32;
        (0..each).map(|point| 1e9 * rods.bend_stiffness(share(point))).collect()
    };
    let (all, rods) = (along(&settings.strands.rods), &settings.strands.rods);
    let names = guides.group_names();
    let is_of = |name: &str, number: u32| match names.get(&number) {
        Some(own) if own == name => true,
        _ => !names.values().any(|own| own == name) && name.parse() == Ok(number),
    };
    let own: Vec<(&str, Vec<f32>)> =
        settings.groups.iter().map(|group| (&*group.group, along(&rods.of_group(group)))).collect();
    let of = |strand: usize| {
        let number = guides.groups().map(|groups| groups[strand]);
        let found = number.and_then(|number| own.iter().find(|(name, _)| is_of(name, number)));
        found.map_or(&all, |(_, along)| along)
    };
    (0..guides.strand_count()).flat_map(|strand| of(strand).iter().copied()).collect()
}

/// The numbers of the two ends of the colours.
pub(super) fn range(overlay: Overlay, values: &[f32]) -> [f32; 2] {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let most = finite().fold(0.0, f32::max);
    match overlay {
        Overlay::Guides | Overlay::Roots => [0.0, 1.0],
        Overlay::Stretch => {
            let most = finite().map(f32::abs).fold(0.5, f32::max);
            [-most, most]
        }
        Overlay::Speed => [0.0, most.max(0.1)],
        Overlay::Group => [0.0, most.max(1.0)],
        Overlay::Contact => [0.0, NEAR],
        Overlay::Stiffness => [0.0, most.max(1e-3)],
    }
}

/// The guides of loaded hair at rest on a resting body, to be seen until there is a picture of a width over height.
pub(super) fn sketch(prepared: &Prepared, aspect: f32) -> Overlaid {
    let (guides, body) = (&prepared.guides, prepared.head.frame(prepared.scene.film.start));
    let each = guides.points_per_strand();
    let points: Vec<Vec3> = (0..guides.strand_count() * each)
        .map(|index| body.root(index / each).point(guides.position(index / each, index % each)))
        .collect();
    let camera = prepared.camera(aspect);
    let silhouette = prepared.mesh.as_ref().map(|mesh| Silhouette::new(camera, aspect, mesh, &body));
    let hides = |place: &Vec3| silhouette.as_ref().is_some_and(|silhouette| silhouette.hides(*place));
    let hidden = points.iter().map(hides).collect();
    let overlay = Overlay::Guides;
    Overlaid { overlay, points, points_per_strand: each, hidden, values: Vec::new(), range: [0.0, 1.0] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::groom::Groom;

    fn guides() -> Guides {
        let mut groom = Groom::empty(8e-5);
        for strand in 0..3 {
            groom.push((0..5).map(|point| Vec3::new(0.01 * strand as f32, -0.02 * point as f32, 0.0)));
        }
        Guides::resample(&groom, 5).unwrap()
    }

    #[test]
    fn stretch_is_length_over_that_at_rest_at_the_scale_of_the_strands() {
        let guides = guides();
        let longer: Vec<Vec3> =
            (0..15).map(|index| guides.position(index / 5, index % 5) * Vec3::new(1.0, 1.1, 1.0)).collect();
        let values = stretches(&longer, &guides, 1.0);
        assert!(values.iter().all(|value| (value - 10.0).abs() < 0.01), "{values:?}");
        let scaled = stretches(&longer, &guides, 1.1);
        assert!(scaled.iter().all(|value| value.abs() < 0.01), "{scaled:?}");
        let [low, high] = range(Overlay::Stretch, &values);
        assert!((high - 10.0).abs() < 0.01 && low == -high);
    }

    #[test]
    fn a_tip_that_tapers_is_softer_by_the_fourth_power_of_its_radius() {
        let guides = guides();
        let mut settings = Settings::default();
        settings.strands.method = StrandMethod::Rods;
        settings.strands.rods.tip_radius = 0.5;
        settings.strands.rods.profile = [1.0; 3];
        let values = stiffnesses(&settings, &guides);
        assert_eq!(values.len(), 15);
        assert!((values[4] / values[0] - 1.0 / 16.0).abs() < 1e-4, "{values:?}");
        // E I of the root by hand, times the hairs of the guide.
        let rods = &settings.strands.rods;
        let radius = 1e-6 * f64::from(rods.radius);
        let moment = 0.25
            * std::f64::consts::PI
            * radius.powi(4)
            * f64::from(rods.ellipticity.powf(1.0).min(rods.ellipticity.powi(3)));
        let hairs = f64::from(rods.wisp_hairs).powf(1.0 + f64::from(rods.cohesion));
        let expected = 1e9 * 1e9 * f64::from(rods.youngs_modulus) * moment * hairs;
        assert!((f64::from(values[0]) / expected - 1.0).abs() < 1e-4, "{} {expected}", values[0]);
        settings.strands.method = StrandMethod::Constrain;
        assert!(stiffnesses(&settings, &guides).is_empty());
    }
}
