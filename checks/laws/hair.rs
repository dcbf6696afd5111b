//! Materials of hair: groups, wisps, the loads that they carry, and changes from root to tip.

use glam::Vec3;
use strandline_checks::{On, Rig, law};
use strandline_groom::{Groom, Guides};
use strandline_sim::rods::{GroupSettings, HairKind, Rest, RodSettings};
use strandline_sim::{Drive, Model, Settings};

use crate::strands::line;

/// Two level hairs in groups, 3 cm apart.
fn guides(length: f32, points: usize) -> Guides {
    let mut groom = Groom::empty(8e-5);
    for aside in [Vec3::ZERO, Vec3::Z * 0.03] {
        groom.push(line(aside, aside + Vec3::X * length, points - 1));
    }
    groom.groups = Some(vec![3, 7]);
    groom.group_names.insert(7, "fringe".to_owned());
    Guides::resample(&groom, points).unwrap()
}

/// Settings under which hair sags from the groom, slowly.
fn sagging() -> Settings {
    let mut settings = Settings { damping: 12.0, ..Settings::default() };
    settings.strands.rods.rest = Rest::Unstressed;
    settings.volume.enabled = false;
    // The force of the air goes by the thickness of a wisp.
    settings.drag.factor = 0.0;
    settings
}

/// Depth of the tips below the roots \[m\] after a time \[s\].
fn droops(on: &On, guides: &Guides, settings: &Settings, seconds: f32) -> [f32; 2] {
    let model = Model::new(guides, settings, Vec::new()).unwrap();
    let mut rig = Rig::new(on, model);
    rig.steps(&vec![Drive::default(); (seconds * 60.0) as usize]);
    let tip = &rig.state().positions[guides.points_per_strand() - 1];
    [0, 1].map(|lane| -tip.get(lane).y)
}

/// A change of settings.
type Change = fn(&mut Settings);

fn group(group: &str, hair: HairKind) -> GroupSettings {
    GroupSettings { group: group.to_owned(), hair: Some(hair), ..GroupSettings::default() }
}

law! {
    fn a_group_is_made_of_hair_of_its_own(on) {
        let (guides, medium) = (guides(0.06, 12), sagging());
        let mut coarse = medium.clone();
        coarse.strands.rods.set_hair(HairKind::Coarse);
        let expected = [droops(on, &guides, &medium, 1.0)[0], droops(on, &guides, &coarse, 1.0)[1]];
        assert!(expected[0] > 1.5 * expected[1], "they are alike: {expected:?}");
        for name in ["fringe", "7"] {
            let groups = vec![group(name, HairKind::Coarse)];
            let found = droops(on, &guides, &Settings { groups, ..medium.clone() }, 1.0);
            // The same arithmetic, on a device in other lanes beside it.
            let apart = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
            assert!(apart < 1e-5, "{found:?}, expected {expected:?}");
        }
    }
}

/// Settings of a group, as they would be of all hair, and of the group alone.
type Own = (fn(&mut RodSettings), fn(&mut GroupSettings));

/// A level hair that is bent and twisted at rest, so that each of its stiffnesses counts.
fn curled() -> Guides {
    let mut groom = Groom::empty(8e-5);
    for aside in [Vec3::ZERO, Vec3::Z * 0.05] {
        let place = |index: u32| {
            let turn = 0.9 * index as f32;
            aside + Vec3::new(0.006 * index as f32, 0.006 * turn.sin(), 0.006 * (1.0 - turn.cos()))
        };
        groom.push((0..12).map(place));
    }
    groom.groups = Some(vec![3, 7]);
    Guides::resample(&groom, 12).unwrap()
}

law! {
    fn all_that_hair_is_made_of_may_be_a_groups_own(on) {
        let guides = curled();
        let base = Settings { damping: 0.0, ..sagging() };
        // In mid-swing, where damping shows.
        let tips = |settings: &Settings| {
            let mut rig = Rig::new(on, Model::new(&guides, settings, Vec::new()).unwrap());
            rig.steps(&vec![Drive::default(); 5]);
            let tip = &rig.state().positions[guides.points_per_strand() - 1];
            [0, 1].map(|lane| tip.get(lane))
        };
        let own: [Own; 7] = [
            (|all| all.damping = 0.1, |group| group.damping = Some(0.1)),
            (|all| all.poisson_ratio = 0.0, |group| group.poisson_ratio = Some(0.0)),
            (|all| all.shear_modulus = Some(0.2), |group| group.shear_modulus = Some(0.2)),
            (|all| all.ellipticity = 0.5, |group| group.ellipticity = Some(0.5)),
            (
                |all| (all.tip_radius, all.taper_start) = (0.3, 0.1),
                |group| (group.tip_radius, group.taper_start) = (Some(0.3), Some(0.1)),
            ),
            (|all| all.profile = [4.0, 1.0, 0.1], |group| group.profile = Some([4.0, 1.0, 0.1])),
            (|all| all.set_hair(HairKind::Wet), |group| group.hair = Some(HairKind::Wet)),
        ];
        let [first, _] = tips(&base);
        for (index, (of_all, of_group)) in own.into_iter().enumerate() {
            let mut all = base.clone();
            of_all(&mut all.strands.rods);
            // It is no material: a group has that of all.
            all.strands.rods.rubbing = base.strands.rods.rubbing;
            let [_, expected] = tips(&all);
            let mut group = GroupSettings { group: "7".to_owned(), ..GroupSettings::default() };
            of_group(&mut group);
            let [other, found] = tips(&Settings { groups: vec![group], ..base.clone() });
            // The mass of a group is rounded once more, so that a Newton step may be more or less: 3e-6 m.
            let apart = found.distance(expected).max(other.distance(first));
            assert!(apart < 1e-5, "{index}: {found} and {other}, expected {expected} and {first}");
            let changed = found.distance(first + Vec3::Z * 0.05);
            assert!(changed > 1e-4, "{index}: the setting changes nothing, {changed} m");
        }
    }
}

law! {
    fn wisps_loads_and_profiles_are_stiffness_over_weight(on) {
        let guides = guides(0.06, 12);
        let droop = |change: Change| {
            let mut settings = sagging();
            change(&mut settings);
            droops(on, &guides, &settings, 0.5)[0]
        };
        let alone = droop(|_| ());
        let softer = droop(|settings| settings.strands.rods.density *= 2.0);
        let stiffer = droop(|settings| settings.strands.rods.youngs_modulus *= 4.0);
        assert!(softer > 1.2 * alone && stiffer < 0.7 * alone, "{softer}, {alone}, {stiffer}");
        let pairs: [(f32, Change); 4] = [
            (alone, |settings| settings.strands.rods.wisp_hairs = 16),
            (stiffer, |settings| {
                (settings.strands.rods.wisp_hairs, settings.strands.rods.cohesion) = (16, 0.5);
            }),
            (softer, |settings| settings.strands.rods.load = 1.0),
            (stiffer, |settings| settings.strands.rods.profile = [4.0; 3]),
        ];
        for (expected, change) in pairs {
            let found = droop(change);
            // Sixteen times as heavy numbers are rounded elsewhere.
            assert!((found / expected - 1.0).abs() < 1e-3, "{found}, expected {expected}");
        }
    }
}

/// Droop \[m\] of a hair that bends little, as of a beam: the moment of what lies beyond each place over the
/// stiffness there, twice summed. The first segment is held.
pub fn beam(length: f64, points: usize, settings: &Settings) -> f64 {
    let section = settings.strands.rods.material().section();
    let (start, pieces) = (length / (points - 1) as f64, 4000);
    let piece = (length - start) / f64::from(pieces);
    let (mut shear, mut moment, mut droop) = (0.0, 0.0, 0.0);
    for index in (0..pieces).rev() {
        let place = start + (f64::from(index) + 0.5) * piece;
        let share = place / length;
        let weight = 9.81 * section.mass * section.along.weight(share) * piece;
        moment += (shear + 0.5 * weight) * piece;
        shear += weight;
        droop += moment / (section.bend[0] * section.along.stiffness(share)) * (length - place) * piece;
    }
    droop
}

law! {
    fn tapered_hair_droops_as_a_tapered_beam(on) {
        let (length, points) = (0.05, on.either(48, 24));
        let guides = guides(length, points);
        let shapes: [Change; 3] = [
            |_| (),
            |settings| (settings.strands.rods.tip_radius, settings.strands.rods.taper_start) = (0.4, 0.0),
            |settings| settings.strands.rods.profile = [2.0, 1.0, 0.25],
        ];
        let mut found = Vec::new();
        for change in shapes {
            let mut settings = sagging();
            // Gamma 0.5: it droops by a sixteenth of its length.
            settings.strands.rods.set_hair(HairKind::Coarse);
            change(&mut settings);
            let expected = beam(length.into(), points, &settings) as f32;
            let droop = droops(on, &guides, &settings, on.either(3.0, 1.5))[0];
            // Segments leave a share of 1/N^2, and slopes of a tenth a hundredth.
            assert!((droop / expected - 1.0).abs() < 0.03, "{droop}, expected {expected}");
            found.push(droop);
        }
        assert!(found[1] < 0.9 * found[0] && found[2] < 0.9 * found[0], "shapes are not distinguished: {found:?}");
    }
}

#[test]
fn a_group_that_the_groom_has_not_is_refused_with_those_it_has() {
    let guides = guides(0.1, 8);
    let groups = vec![group("back", HairKind::Wet)];
    let settings = Settings { groups, ..Settings::default() };
    let refused = Model::new(&guides, &settings, Vec::new()).err().unwrap().to_string();
    assert_eq!(refused, "simulation.groups[0].group is `back`, expected a group of the groom: 3, fringe");
    let mut model = Model::new(&guides, &Settings::default(), Vec::new()).unwrap();
    assert!(model.set_settings(&settings).is_err());
    assert_eq!(model.settings(), &Settings::default());
    let mut other = settings.clone();
    other.groups[0].group = "3".to_owned();
    model.set_settings(&other).unwrap();
    let compiled = Model::new(&guides, &other, Vec::new()).unwrap();
    assert_eq!(
        model.inverse_mass(),
        compiled.inverse_mass(),
        "settings that change are those that were compiled"
    );
}
