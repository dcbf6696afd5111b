//! Third stage of loading: settings that a scene leaves open, chosen to fit a groom: points of strands, drawn strands
//! about each, their widths and colours.

use std::collections::BTreeMap;

use glam::Vec3;

use super::loading::Loading;
use crate::{
    Scene,
    body::Mesh,
    groom::{Groom, format::Attribute},
    render::{GroupLook, LevelOfDetail},
};

/// Hair that is drawn when a groom has fewer strands, about \[strand\].
const DRAWN: usize = 40_000;
/// Most strands that are drawn about each.
const MOST_FOLLOW: usize = 32;
/// Number of segments that a CPU draws in a second or two.
const SEGMENTS: usize = 2_200_000;
/// Radius of a clump as a share of the distance between strands, at the roots and the tips; and the amplitude of
/// waves of its own that a drawn strand has.
const ROOT_SHARE: f32 = 0.35;
const TIP_SHARE: f32 = 0.22;
const WAVE_SHARE: f32 = 0.13;
/// Numbers of points of a strand to choose from, and the allowed distance of such a polyline from it, \[m\] and as a share
/// of its length.
const POINTS: [u32; 7] = [8, 12, 16, 24, 32, 48, 64];
const ASTRAY: f32 = 3e-4;
const ASTRAY_SHARE: f32 = 0.002;
/// Samples of a body's distance along its diagonal, and the farthest that they may be apart \[m\].
const CELLS: f32 = 250.0;
const COARSEST: f32 = 0.1;
/// Distance up to which all is drawn, over the diagonal of the body: a picture that it fills.
const NEAR: f32 = 2.5;
/// Hairs for which a strand stands at least: one hair alone is thinner than can be seen.
const SHOWN: u64 = 6;
/// Strands that are looked at.
const LOOKED_AT: usize = 400;
/// Groups that are examined: least number of strands, number of groups, and distance of their roots over that of all.
const FEWEST: usize = 20;
const MOST_GROUPS: usize = 64;
const CLOSER: f32 = 0.7;
/// Diameter of a hair over the distance of hairs on a head of a hundred thousand, and the share of it with which strands
/// of a file are all of its hair; thinner ones are guides.
pub(super) const DENSITY: f32 = 0.095;
const ALL_HAIR: f32 = 0.5;

/// Chooses settings that the scene leaves open, to fit a body's materials and motion and a groom from a source.
pub(super) fn fit(loading: &mut Loading) {
    loading.scene.choose_body_colors();
    if loading.motion.is_some() {
        loading.scene.rest_under_moving_body();
    }
    if let Loading { scene, groom: Some(groom), mesh, notes, .. } = loading {
        if !loading.is_grown {
            notes.extend(choose(scene, groom));
        }
        notes.extend(fit_body(scene, mesh.as_ref()));
    }
}

/// True for a setting of the level of detail that no file gives and that has one of its defaults.
pub(super) fn is_open(given: bool, value: u32, of: fn(&LevelOfDetail) -> u32) -> bool {
    !given
        && [Scene::default().level_of_detail, LevelOfDetail::default()].iter().any(|level| of(level) == value)
}

/// Chooses settings that a scene leaves open. Returns a note of the choices.
///
/// A setting is open where no file gives it and it still has its default: that of the demo or of a groom file.
fn choose(scene: &mut Scene, groom: &Groom) -> Option<String> {
    let (given, default) = (scene.given, Scene::default());
    let strands = groom.strand_count();
    let mut chosen = Vec::new();
    if !given.points_per_strand && scene.groom.points_per_strand == default.groom.points_per_strand {
        scene.groom.points_per_strand = points(groom);
        chosen.push(format!("groom.points_per_strand = {}", scene.groom.points_per_strand));
    }
    let spacing = spacing(groom);
    fit_widths(scene, groom, spacing, &default, &mut chosen);
    let look = &mut scene.look;
    if !given.follow_strands && look.follow_strands == default.look.follow_strands {
        look.follow_strands = DRAWN.div_ceil(strands).clamp(1, MOST_FOLLOW) as u32;
        if look.hair_count > 0 && (strands as u64).pow(2) < u64::from(default.look.hair_count) {
            // Few strands stand for few hairs, each drawn once.
            look.follow_strands = look.follow_strands.min(look.hair_count.div_ceil(strands as u32));
        }
        chosen.push(format!("look.follow_strands = {}", look.follow_strands));
    }
    let level = &mut scene.level_of_detail;
    if is_open(given.segments_per_span, level.segments_per_span, |level| level.segments_per_span) {
        let spans = strands * look.follow_strands as usize * (scene.groom.points_per_strand as usize - 1);
        level.segments_per_span = (SEGMENTS / spans.max(1)).clamp(1, 3) as u32;
        chosen.push(format!("level_of_detail.segments_per_span = {}", level.segments_per_span));
    }
    let are_open = !given.root_radius && !given.tip_radius && look.clump == default.look.clump;
    let clump = &mut look.clump;
    let of_default = default.look.clump;
    let mut radius = |value: &mut f32, given: bool, default: f32, share: f32, key: &str| {
        if !given && *value == default {
            *value = (share * spacing).min(*value);
            chosen.push(format!("look.clump.{key} = {value:.5}"));
        }
    };
    radius(&mut clump.root_radius, given.root_radius, of_default.root_radius, ROOT_SHARE, "root_radius");
    radius(&mut clump.tip_radius, given.tip_radius, of_default.tip_radius, TIP_SHARE, "tip_radius");
    let (waves, of_waves) = (given.wave_amplitude, of_default.wave_amplitude);
    radius(&mut clump.wave_amplitude, waves, of_waves, WAVE_SHARE, "wave_amplitude");
    if are_open {
        fit_clumps(scene, groom, spacing, &mut chosen);
    }
    (!chosen.is_empty()).then(|| format!("chosen to fit the groom: {}", chosen.join(", ")))
}

/// Chooses settings that a scene leaves open, to fit the size of a body. Returns a note of the choices.
fn fit_body(scene: &mut Scene, mesh: Option<&Mesh>) -> Option<String> {
    let (given, default) = (scene.given, Scene::default());
    let mut chosen = Vec::new();
    let size = mesh.and_then(Mesh::bounds).map_or(0.0, |bounds| bounds.min.distance(bounds.max));
    let body = &mut scene.body;
    if !given.spacing && body.spacing == default.body.spacing && size > CELLS * body.spacing {
        body.spacing = (size / CELLS).min(COARSEST);
        chosen.push(format!("body.spacing = {:.4}", body.spacing));
    }
    let level = &mut scene.level_of_detail;
    let is_open = !given.full_distance && level.full_distance == default.level_of_detail.full_distance;
    if is_open && NEAR * size > level.full_distance {
        level.full_distance = NEAR * size;
        chosen.push(format!("level_of_detail.full_distance = {:.1}", level.full_distance));
    }
    (!chosen.is_empty()).then(|| format!("chosen to fit the body: {}", chosen.join(", ")))
}

/// Clumps of groups whose roots stand closer than those of most: brows and lashes beside hair.
fn fit_clumps(scene: &mut Scene, groom: &Groom, of_all: f32, chosen: &mut Vec<String>) {
    let mut groups: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (strand, group) in groom.groups.iter().flatten().enumerate() {
        groups.entry(*group).or_default().push(strand);
    }
    groups.retain(|_, strands| strands.len() >= FEWEST && strands.len() < groom.strand_count());
    for (group, strands) in groups.iter().take(MOST_GROUPS) {
        let ratio = spacing(&groom.select(strands)) / of_all.max(f32::MIN_POSITIVE);
        if ratio > CLOSER || scene.look.group.len() >= MOST_GROUPS {
            continue;
        }
        let name = groom.group_names.get(group).cloned().unwrap_or_else(|| group.to_string());
        let looks = &mut scene.look.group;
        let own = match looks.iter().position(|look| look.name == name) {
            Some(place) => &mut looks[place],
            None => {
                looks.push(GroupLook { name: name.clone(), ..GroupLook::default() });
                let last = looks.len() - 1;
                &mut looks[last]
            }
        };
        if own.clump.is_none() {
            own.clump = Some(ratio);
            chosen.push(format!("clump = {ratio:.2} of `{name}`"));
        }
    }
}

/// Widths and the number of hairs: strands of a file that are as wide as hair is dense are all of its hair; thinner ones
/// and those without widths are guides, which cover as much of the skin as hairs do. Few guides stand for few hairs.
fn fit_widths(scene: &mut Scene, groom: &Groom, spacing: f32, default: &Scene, chosen: &mut Vec<String>) {
    let (look, strands) = (&mut scene.look, groom.strand_count());
    let is_count_open = !scene.given.hair_count && look.hair_count == default.look.hair_count;
    let is_scale_open = !scene.given.width_scale && look.width_scale == default.look.width_scale;
    let (has_widths, width) = (Attribute::Widths.is_in(groom), mean_width(groom));
    if has_widths && width >= ALL_HAIR * DENSITY * spacing {
        if is_count_open {
            look.hair_count = strands as u32;
            chosen.push(format!("look.hair_count = {strands}"));
        }
        return;
    }
    if is_scale_open && look.hair_count > 0 && spacing > 0.0 && width > 0.0 {
        // Hairs are as much denser than strands as they are more.
        let of_hairs = spacing * (strands as f32 / look.hair_count as f32).sqrt();
        look.width_scale = (DENSITY * of_hairs / width).clamp(0.5, 50.0);
        chosen.push(format!("look.width_scale = {:.2}", look.width_scale));
    }
    // A strand stands for no more hairs than there are strands, or than show one alone.
    let each = (strands as u64).max(SHOWN);
    let most = (strands as u64 * each).min(u64::from(look.hair_count)) as u32;
    if is_count_open && most < look.hair_count {
        look.hair_count = most;
        chosen.push(format!("look.hair_count = {most}"));
    } else if has_widths && is_count_open {
        chosen
            .push(format!("look.hair_count = {most} (too thin for all of the hair, the strands are guides)"));
    }
}

/// Mean diameter \[m\] of strands.
pub(super) fn mean_width(groom: &Groom) -> f32 {
    let (mut sum, mut count) = (0.0_f64, 0);
    for strand in some(groom) {
        for point in groom.range(strand) {
            sum += f64::from(groom.widths.at(strand, point));
            count += 1;
        }
    }
    (sum / f64::from(count.max(1))) as f32
}

fn some(groom: &Groom) -> impl Iterator<Item = usize> {
    (0..groom.strand_count()).step_by((groom.strand_count() / LOOKED_AT).max(1))
}

/// Fewest points with which 95 of 100 strands keep their shape; no more than most of them have.
fn points(groom: &Groom) -> u32 {
    let mut counts: Vec<u32> = some(groom).map(|strand| groom.strand(strand).len() as u32).collect();
    counts.sort_unstable();
    let own = counts.get(counts.len() / 2).copied().unwrap_or(0);
    let most = POINTS[POINTS.len() - 1];
    let keeps = |count: u32| count >= own.min(most) || astray(groom, count as usize) <= 1.0;
    POINTS.into_iter().find(|count| keeps(*count)).unwrap_or(most)
}

/// Deviation of strands resampled to `count` points from themselves, over the tolerance, for 95 in 100.
fn astray(groom: &Groom, count: usize) -> f32 {
    let mut found: Vec<f32> = some(groom)
        .map(|strand| {
            let own = groom.strand(strand);
            let few = groom.select(&[strand]).resampled(count).map(|groom| groom.points).unwrap_or_default();
            let length: f32 = own.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            let apart = |point: &Vec3| {
                let ways = few.windows(2).map(|pair| {
                    let way = pair[1] - pair[0];
                    let share = (*point - pair[0]).dot(way) / way.length_squared().max(f32::MIN_POSITIVE);
                    (pair[0] + way * share.clamp(0.0, 1.0)).distance(*point)
                });
                ways.fold(f32::INFINITY, f32::min)
            };
            let farthest = own.iter().map(apart).fold(0.0, f32::max);
            farthest / ASTRAY.max(ASTRAY_SHARE * length)
        })
        .collect();
    found.sort_by(f32::total_cmp);
    found.get(found.len() * 95 / 100).copied().unwrap_or(0.0)
}

/// Middle distance \[m\] of roots from their nearest neighbours, as on a grid.
pub(super) fn spacing(groom: &Groom) -> f32 {
    let mut nearest: Vec<f32> = groom.nearest_roots(LOOKED_AT);
    nearest.sort_by(f32::total_cmp);
    // Roots at random are half as far from their nearest as those of a grid of the same density [Clark1954].
    2.0 * nearest.get(nearest.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::groom::{Widths, format::HAIR_WIDTH};
    use crate::scene::Given;

    /// Strands on a square at distances of 2 mm that hang or curl.
    fn groom(turns: f32) -> Groom {
        let mut groom = Groom::empty(8e-5);
        for strand in 0..2500 {
            let root = Vec3::new(0.002 * (strand % 50) as f32, 0.0, 0.002 * (strand / 50) as f32);
            groom.push((0..100).map(|point| {
                let share = point as f32 / 99.0;
                let angle = std::f32::consts::TAU * turns * share;
                root + Vec3::new(0.005 * angle.cos(), -0.2 * share, 0.005 * angle.sin())
            }));
        }
        groom
    }

    #[test]
    fn points_keep_curls() {
        assert_eq!(points(&groom(0.0)), 8);
        let curly = points(&groom(5.0));
        assert!(curly >= 48, "{curly}");
        let spacing = spacing(&groom(0.0));
        assert!((0.0019..0.0041).contains(&spacing), "{spacing}");
    }

    #[test]
    fn clumps_of_brows_are_narrower_than_those_of_hair() {
        let mut groom = groom(0.0);
        // A hundred roots 0.2 mm apart, ten to a row.
        for strand in 0..100 {
            let root = Vec3::new(0.5 + 2e-4 * (strand % 10) as f32, 0.0, 2e-4 * (strand / 10) as f32);
            groom.push([root, root + Vec3::Y * 0.005, root + Vec3::Y * 0.01]);
        }
        groom.groups = Some((0..2600).map(|strand| u32::from(strand >= 2500)).collect());
        groom.group_names = [(0, "hair".to_owned()), (1, "brows".to_owned())].into();
        let mut scene = Scene::default();
        scene.groom.file = Some("a.hair".into());
        let mut given = scene.clone();
        let note = choose(&mut scene, &groom).unwrap();
        let [brows] = &scene.look.group[..] else { panic!("{:?}", scene.look.group) };
        let clump = brows.clump.unwrap();
        assert!(
            brows.name == "brows" && (0.09..0.11).contains(&clump) && note.contains("of `brows`"),
            "{note}"
        );
        let own = GroupLook { name: "brows".to_owned(), clump: Some(0.5), ..GroupLook::default() };
        given.look.group = vec![own.clone()];
        choose(&mut given, &groom);
        assert_eq!(given.look.group, [own]);
    }

    /// Strands on a square of 10 cm, as many on each side.
    fn square(side: usize, widths: Widths) -> Groom {
        let mut groom = Groom::empty(HAIR_WIDTH);
        for strand in 0..side * side {
            let root = Vec3::new((strand % side) as f32, 0.0, (strand / side) as f32) * (0.1 / side as f32);
            groom.push([root, root - Vec3::Y * 0.1, root - Vec3::Y * 0.2]);
        }
        groom.widths = widths;
        groom
    }

    fn chosen(groom: &Groom) -> Scene {
        let mut scene = Scene::default();
        scene.groom.file = Some("a.hair".into());
        choose(&mut scene, groom);
        scene
    }

    #[test]
    fn thin_strands_with_widths_are_drawn_as_those_without() {
        let bare = chosen(&square(50, Widths::Constant(HAIR_WIDTH))).look;
        let same = chosen(&square(50, Widths::PerStrand(vec![HAIR_WIDTH; 2500]))).look;
        let thinner = chosen(&square(50, Widths::PerStrand(vec![0.5 * HAIR_WIDTH; 2500]))).look;
        assert_eq!((same.hair_count, same.width_scale), (bare.hair_count, bare.width_scale));
        assert!(bare.hair_count == 100_000 && (thinner.width_scale - 2.0 * bare.width_scale).abs() < 1e-3);
        // Strands 2 mm apart that are 0.2 mm wide leave no room for others.
        let all = chosen(&square(50, Widths::PerStrand(vec![2e-4; 2500]))).look;
        assert_eq!((all.hair_count, all.width_scale), (2500, 1.0));
    }

    #[test]
    fn few_strands_stand_for_few_hairs() {
        for (side, hairs, follow) in
            [(1, 6, 6), (2, 24, 6), (4, 256, 16), (10, 10_000, 32), (20, 100_000, 32)]
        {
            let look = chosen(&square(side, Widths::Constant(HAIR_WIDTH))).look;
            assert_eq!((look.hair_count, look.follow_strands), (hairs, follow), "{side}");
            let drawn = look.width_scale * look.hair_count as f32
                / (look.follow_strands as usize * side * side) as f32;
            // The width of one that is drawn over that of a hair.
            assert!(drawn < 20.0 && (side > 1 || drawn == 1.0), "{side}: {drawn}");
        }
        let one = chosen(&square(1, Widths::PerStrand(vec![HAIR_WIDTH]))).look;
        // Strands with widths of their own that leave no gaps are all of the hair.
        assert_eq!((one.hair_count, one.width_scale), (1, 1.0));
    }

    #[test]
    fn what_is_given_stays() {
        let mut scene = Scene::default();
        scene.groom.file = Some("a.hair".into());
        let mut own = scene.clone();
        own.given = Given { follow_strands: true, ..Given::default() };
        own.look.clump.tip_radius = 0.002;
        let note = choose(&mut scene, &groom(0.0)).unwrap();
        assert_eq!(scene.look.follow_strands, 16, "40,000 of 2,500");
        assert!(note.contains("look.clump.tip_radius") && !note.contains("simulation"), "{note}");
        let note = choose(&mut own, &groom(0.0)).unwrap();
        assert_eq!((own.look.follow_strands, own.look.clump.tip_radius), (2, 0.002));
        assert!(!note.contains("follow_strands") && !note.contains("tip_radius"), "{note}");
    }
}
