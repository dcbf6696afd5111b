//! Hair in water: a dry groom droops, swings more slowly and for a shorter time, and the wind moves it less.

use glam::Vec3;
use strandline_checks::{On, Rig, law};
use strandline_groom::Guides;
use strandline_sim::rods::{HairKind, Rest};
use strandline_sim::{Drive, Model, Settings};

use crate::air::blown;
use crate::hair::beam;
use crate::rod_mechanics::rods;
use crate::strands::{first, line, one_strand};

/// Settings of a kind of hair without air, which does not rub.
fn of(hair: HairKind, time_step: f32) -> Settings {
    let mut settings = rods(time_step);
    settings.strands.rods.set_hair(hair);
    settings.strands.rods.rubbing = 0.0;
    settings
}

/// A level hair, held by its first segment.
fn level(length: f32, points: usize) -> Guides {
    one_strand(&line(Vec3::ZERO, Vec3::X * length, points - 1))
}

/// Depth of its tip below its root \[m\] after each step.
fn depths(on: &On, guides: &Guides, settings: &Settings, steps: usize) -> Vec<f32> {
    let mut rig = Rig::new(on, Model::new(guides, settings, Vec::new()).unwrap());
    let mut depth = |_| {
        rig.step(&Drive::default());
        -first(rig.state()).last().unwrap().y
    };
    (0..steps).map(&mut depth).collect()
}

law! {
    fn a_dry_groom_droops_when_it_is_wetted(on) {
        let (length, points) = (0.04, 24);
        let guides = level(length, points);
        let drooped = |hair, rest: Option<Rest>| {
            let mut settings = Settings { damping: 20.0, ..of(hair, 1.0 / 60.0) };
            settings.strands.rods.rest = rest.unwrap_or(settings.strands.rods.rest);
            *depths(on, &guides, &settings, 60).last().unwrap()
        };
        // A beam's own weight, less that of dry hair, which the shape carries.
        let [dry, wet] = [HairKind::Medium, HairKind::Wet]
            .map(|hair| beam(length.into(), points, &of(hair, 1.0 / 60.0)) as f32);
        let found = drooped(HairKind::Wet, None);
        assert!((found / (wet - dry) - 1.0).abs() < 0.03, "{found}, expected {wet} - {dry}");
        for rests in [drooped(HairKind::Medium, None), drooped(HairKind::Wet, Some(Rest::SagFree))] {
            assert!(rests < 1e-5, "it rests in its own shape: {rests}");
        }
    }
}

law! {
    fn a_wet_groom_that_is_cut_keeps_its_droop(on) {
        let guides = level(0.06, 16);
        let settings = Settings { damping: 20.0, ..of(HairKind::Wet, 1.0 / 60.0) };
        let model = Model::new(&guides, &settings, Vec::new()).unwrap();
        let mut rig = Rig::new(on, model.clone());
        let second = vec![Drive::default(); 60];
        rig.steps(&second);
        // As one that was grown so short.
        let short = line(Vec3::ZERO, Vec3::X * 0.03, 15);
        let expected = *depths(on, &one_strand(&short), &settings, 60).last().unwrap();
        rig.change(|state| state.set_length_scale(&model, &[0.5]).unwrap());
        rig.steps(&second);
        let found = -first(rig.state()).last().unwrap().y;
        // The hair that is left has half as many segments: 0.81. In equilibrium under its water it would not droop at all.
        assert!((found / expected - 1.0).abs() < 0.3, "{found}, expected {expected}");
    }
}

/// Period \[s\] of a swing about its mean, and the share of its way that is left after a period.
fn swing(depths: &[f32], time_step: f32) -> [f32; 2] {
    let turns: Vec<usize> = (1..depths.len() - 1)
        .filter(|at| (depths[*at] - depths[at - 1]) * (depths[at + 1] - depths[*at]) <= 0.0)
        .collect();
    assert!(turns.len() > 3, "it does not swing: {turns:?}");
    let way = |turn: usize| (depths[turns[turn + 1]] - depths[turns[turn]]).abs();
    [(turns[2] - turns[0]) as f32 * time_step, way(2) / way(0)]
}

law! {
    fn wet_hair_swings_more_slowly_and_for_a_shorter_time(on) {
        let (guides, time_step) = (level(0.06, 16), 1.0 / 960.0);
        let [dry, wet] = [HairKind::Medium, HairKind::Wet].map(|hair| {
            let mut settings = of(hair, time_step);
            settings.strands.rods.rest = Rest::Unstressed;
            settings.gravity *= 0.1;
            swing(&depths(on, &guides, &settings, 600), time_step)
        });
        let firmness = |hair| {
            let section = of(hair, time_step).strands.rods.material().section();
            section.bend[0] / section.mass
        };
        let slower = (firmness(HairKind::Medium) / firmness(HairKind::Wet)).sqrt() as f32;
        let found = wet[0] / dry[0];
        // A step is a hundredth of a swing.
        assert!((found / slower - 1.0).abs() < 0.04, "{found} times as slow, expected {slower}");
        // Of the bends of a swing exp(-2 pi^2 tau / T) is left, less by the step.
        let kept = |tau: f32, period: f32| (-2.0 * std::f32::consts::PI.powi(2) * tau / period).exp();
        let expected = kept(0.008, wet[0]) / kept(0.002, dry[0]);
        let found = wet[1] / dry[1];
        assert!((found / expected - 1.0).abs() < 0.1 && expected < 0.75, "{found}, expected {expected}");
    }
}

law! {
    fn the_wind_moves_wet_hair_less(on) {
        let guides = one_strand(&line(Vec3::ZERO, Vec3::NEG_Y * 0.2, 12));
        let aside = |hair: HairKind, packing: Option<f32>| {
            let mut settings = of(hair, 1.0 / 60.0);
            settings.strands.rods.packing = packing.unwrap_or(settings.strands.rods.packing);
            (settings.drag.factor, settings.drag.hairs, settings.drag.shelter) = (1.0, Some(50.0), false);
            let mut rig = Rig::new(on, Model::new(&guides, &settings, Vec::new()).unwrap());
            rig.steps(&vec![blown(Vec3::X * 3.0); 240]);
            let tip = *first(rig.state()).last().unwrap();
            tip.x / -tip.y
        };
        let [dry, wet, loose] =
            [(HairKind::Medium, None), (HairKind::Wet, None), (HairKind::Wet, Some(0.3))].map(|(hair, packing)| aside(hair, packing));
        // 0.64; wisps as wide as dry ones are blown 0.78 as far.
        assert!((0.5..0.7).contains(&(wet / dry)), "{wet} of {dry}");
        assert!(wet < 0.85 * loose, "wisps are as thin as they are wet: {wet}, {loose}");
    }
}
