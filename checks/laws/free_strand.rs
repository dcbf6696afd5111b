//! Free strands: free fall, momentum, springs at rest.

use glam::Vec3;
use strandline_body::Pose;
use strandline_checks::{On, Rig, law};
use strandline_groom::RestShape;
use strandline_sim::constrain::{Angles, LengthPass, Spring, Springs};
use strandline_sim::{Drag, Drive, Model, Settings, State};

use crate::strands::{bare, first, line, one_strand};

fn loose(on: &On, points: &[Vec3], settings: &Settings) -> Rig {
    let guides = one_strand(points);
    let rest = RestShape::new(&guides, 6.5e-6);
    let model = Model::with_rest(&guides, rest, |_, _| false, settings, Vec::new()).unwrap();
    Rig::new(on, model)
}

/// A helix: three-dimensional, so that every spring has work to do.
fn helix(points: usize) -> Vec<Vec3> {
    let turn = |index: usize| index as f32 * 0.9;
    (0..points)
        .map(|index| Vec3::new(0.02 * turn(index).cos(), -0.01 * index as f32, 0.02 * turn(index).sin()))
        .collect()
}

fn steps(rig: &mut Rig, count: usize) {
    rig.steps(&vec![Drive::default(); count]);
}

fn momentum(rig: &mut Rig) -> Vec3 {
    let masses = rig.model().rest().mass.clone();
    rig.state().velocities.iter().zip(masses).map(|(velocity, mass)| velocity.get(0) * mass.0[0]).sum()
}

fn fallen(on: &On, settings: &Settings) -> f32 {
    let mut rig = loose(on, &line(Vec3::ZERO, Vec3::NEG_Y * 0.3, 8), settings);
    steps(&mut rig, 60);
    -first(rig.state())[0].y
}

law! {
    fn a_loose_strand_falls_freely(on) {
        // n steps of the semi-implicit Euler rule fall g dt^2 n (n + 1) / 2.
        let expected = 9.81 / 3600.0 * 60.0 * 61.0 / 2.0;
        let settings = bare(1.0 / 60.0, 20);
        // Positions of 5 m are rounded to 5e-7 m, 60 times, and so are the velocities that follow.
        assert!((fallen(on, &settings) / expected - 1.0).abs() < 1e-4);
        let dragged = fallen(on, &Settings { drag: Drag::default(), ..settings });
        assert!((dragged / expected - 1.0).abs() > 0.1, "drag is not noticed");
    }
}

law! {
    fn wind_carries_a_loose_strand_along(on) {
        let settings = Settings { gravity: Vec3::ZERO, drag: Drag::default(), ..bare(1.0 / 60.0, 20) };
        let mut rig = loose(on, &line(Vec3::ZERO, Vec3::NEG_Y * 0.3, 8), &settings);
        rig.steps(&vec![Drive { wind: Vec3::new(2.0, 2.0, 0.0), ..Drive::default() }; 60]);
        let velocity = rig.state().velocities[4].get(0);
        // Across the strand 1 - exp(-1.5), along it 1 - exp(-0.75), for 1 s; rounding of 60 steps.
        assert!((velocity.x - 2.0 * (1.0 - (-1.5_f32).exp())).abs() < 1e-3, "{velocity}");
        assert!((velocity.y - 2.0 * (1.0 - (-0.75_f32).exp())).abs() < 1e-3, "{velocity}");
    }
}

/// All that acts within a strand, kicked.
fn drift(on: &On, settings: &Settings) -> f32 {
    let settings = Settings { gravity: Vec3::ZERO, ..settings.clone() };
    let mut rig = loose(on, &helix(12), &settings);
    rig.change(|state| {
        for (index, velocity) in state.velocities.iter_mut().enumerate() {
            velocity.set(0, Vec3::new(0.3 * (index as f32).sin(), 0.2, 0.4 * (index as f32 * 2.0).cos()));
        }
    });
    let before = momentum(&mut rig);
    steps(&mut rig, 30);
    (momentum(&mut rig) - before).length() / before.length()
}

law! {
    fn what_acts_within_a_strand_keeps_its_momentum(on) {
        let all = bare(1.0 / 60.0, 20).with_constrain(|constrain| {
constrain.springs = Springs::default();
constrain.angles = Angles::default();
});
        // Velocities are differences of rounded positions: 2e-8 m * 60 / 0.3 m/s, summed over 30 steps.
        let drifted = drift(on, &all);
        assert!(drifted < 2e-4, "{drifted}");
        let pass = LengthPass { enabled: true, correction: 0.0 };
        let one_sided = all.with_constrain(|constrain| {
constrain.length_pass = pass;
constrain.iterations = 1;
});
        assert!(drift(on, &one_sided) > 1e-2, "a pass that pushes one end only is not noticed");
    }
}

law! {
    fn springs_and_bends_at_rest_stay_at_rest(on) {
        let stiff = Spring { enabled: true, stiffness: 1e3, damping: 0.0 };
        let settings = Settings { gravity: Vec3::ZERO, ..bare(1.0 / 60.0, 20) }.with_constrain(|constrain| {
constrain.springs = Springs { stretch: stiff, bend: stiff, torsion: stiff };
constrain.angles = Angles { limit: 0.1, stiffness: 100.0 };
});
        let model = Model::new(&one_strand(&helix(12)), &settings, Vec::new()).unwrap();
        let mut rig = Rig::new(on, model);
        let before = first(rig.state());
        steps(&mut rig, 600);
        let moved = |state: &State| {
            first(state).iter().zip(&before).map(|(now, then)| now.distance(*then)).fold(0.0, f32::max)
        };
        // Rounding of 600 steps.
        assert!(moved(rig.state()) < 1e-4, "{}", moved(rig.state()));
        rig.change(|state| {
            let stretched = state.positions[5].get(0) + Vec3::X * 1e-2;
            state.positions[5].set(0, stretched);
        });
        steps(&mut rig, 10);
        assert!(moved(rig.state()) > 1e-3, "springs do not act");
    }
}

law! {
    long fn springs_of_any_stiffness_stay_stable(on) {
        let stiff = Spring { enabled: true, stiffness: 1e30, damping: 1e30 };
        let settings =
            bare(1.0 / 60.0, 20).with_constrain(|constrain| constrain.springs = Springs { stretch: stiff, bend: stiff, torsion: stiff });
        let guides = one_strand(&helix(16));
        let model = Model::new(&guides, &settings, Vec::new()).unwrap();
        let mut rig = Rig::new(on, model);
        for _ in 0..1200 {
            let report = rig.step(&Drive::default());
            assert_eq!(report.non_finite, 0);
            let fastest = rig.state().velocities.iter().map(|v| v.get(0).length()).fold(0.0, f32::max);
            // A fall over the length of the strand reaches 1.7 m/s.
            assert!(fastest < 4.0, "{fastest} m/s");
        }
    }
}

law! {
    fn what_is_no_number_is_reported(on) {
        let guides = one_strand(&helix(16));
        let mut rig = Rig::new(on, Model::new(&guides, &bare(1.0 / 60.0, 20), Vec::new()).unwrap());
        let report = rig.step(&Drive::default());
        assert!(report.stretch_max.is_finite() && report.non_finite == 0, "{report:?}");
        let nowhere = Pose { translation: Vec3::NAN, ..Pose::IDENTITY };
        rig.change(|state| state.body = nowhere.into());
        let report = rig.step(&Drive::of(nowhere));
        // Every point, by each of the stages that look.
        assert!(report.non_finite >= 16, "{report:?}");
        assert!(report.stretch_max.is_nan() && report.stretch_mean.is_nan(), "{report:?}");
    }
}
