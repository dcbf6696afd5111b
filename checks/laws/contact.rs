//! Solids: friction on a slope, no point inside after settling.

use glam::{Quat, Vec3};
use strandline_body::{Carrier, Collider, Mannequin, Motion, Shape};
use strandline_checks::{On, Rig, law};
use strandline_groom::{Guides, RestShape, Style, StyleSettings};
use strandline_sim::{Drive, Model, Settings, VolumeSettings};

use crate::strands::{ball_of_hair, bare, first, line, one_strand, skull};

/// Distance \[m\] that a loose strand slides in a second down a slope of so many degrees.
fn slide(on: &On, degrees: f32, friction: f32) -> f32 {
    // A ball so large that it is a plane: its top is the origin.
    let radius = 50.0;
    let slope = Quat::from_rotation_z(degrees.to_radians());
    let floor = Collider {
        shape: Shape::Sphere { center: slope * Vec3::NEG_Y * radius, radius },
        carrier: Carrier::World,
        friction,
    };
    let across = line(Vec3::new(0.0, 1e-3, -0.1), Vec3::new(0.0, 1e-3, 0.1), 8);
    let points: Vec<Vec3> = across.into_iter().map(|point| slope * point).collect();
    let guides = one_strand(&points);
    let settings = Settings { collision_margin: 1e-3, ..bare(1.0 / 60.0, 20) };
    let rest = RestShape::new(&guides, 6.5e-6);
    let model = Model::with_rest(&guides, rest, |_, _| false, &settings, vec![floor]).unwrap();
    let mut rig = Rig::new(on, model);
    rig.steps(&vec![Drive::default(); 60]);
    first(rig.state())[4].distance(points[4])
}

law! {
    fn friction_holds_below_its_angle_and_gives_way_above(on) {
        // tan 26.6 degrees = 0.5. A ball of 50 m is rounded to 4e-6 m, so a strand that sticks creeps.
        assert!(slide(on, 20.0, 0.5) < 2e-3, "{}", slide(on, 20.0, 0.5));
        let expected = 0.5 * 9.81 * (35.0_f32.to_radians().sin() - 0.5 * 35.0_f32.to_radians().cos());
        let found = slide(on, 35.0, 0.5);
        assert!((found / expected - 1.0).abs() < 0.05, "slid {found} m, expected {expected} m");
        assert!(slide(on, 20.0, 0.2) > 0.1, "less friction is not noticed");
    }
}

/// Strands by solver, without a volume: rods, constraints with exact lengths, constraints without.
fn ways() -> [Settings; 3] {
    let mut loose = Settings::constrained();
    loose.strands.constrain.length_pass.enabled = false;
    [Settings::default(), Settings::constrained(), loose].map(|settings| Settings {
        volume: VolumeSettings { enabled: false, ..VolumeSettings::default() },
        ..settings
    })
}

/// Deepest point \[m\] in the second half of 4 s (on a software adapter 2 s) under a motion.
fn depth(on: &On, collider: Option<Collider>, hair: &Guides, motion: &Motion, settings: &Settings) -> f32 {
    let inside = collider.clone().unwrap_or_else(|| skull(0.3));
    depth_below(on, &inside, collider, hair, motion, settings)
}

/// The same, measured in one solid and held out of another.
fn depth_below(
    on: &On,
    inside: &Collider,
    collider: Option<Collider>,
    hair: &Guides,
    motion: &Motion,
    settings: &Settings,
) -> f32 {
    let model = Model::new(hair, settings, collider.into_iter().collect()).unwrap();
    let mut rig = Rig::new(on, model);
    let mut deepest = 0.0_f32;
    let steps = on.either(240, 120);
    for step in 1..=steps {
        let world_from_head = motion.pose(f64::from(step) / 60.0, Vec3::NEG_Y * 0.1);
        let report = rig.step(&Drive::of(world_from_head));
        assert_eq!(report.non_finite, 0);
        if step < steps / 2 {
            continue;
        }
        let head_from_world = world_from_head.inverse();
        for block in rig.state().positions.chunks(hair.points_per_strand()) {
            for point in &block[2..] {
                let here = head_from_world.point(point.get(0));
                deepest = deepest.max(-inside.shape.distance_and_gradient(here).0);
            }
        }
    }
    deepest
}

law! {
    long fn no_hair_is_inside_a_ball_after_settling(on) {
        let hair = ball_of_hair(400, 12, 0.25);
        let [rods, exact, loose] = ways();
        for motion in [Motion::Still, Motion::Shake] {
            let found = depth(on, Some(skull(0.3)), &hair, &motion, &exact);
            // The rest pose keeps 2 mm; planes on a ball of 0.1 m err by less than 0.1 mm.
            assert!(found < 1e-4, "{motion:?}: {found} m deep");
            let found = depth(on, Some(skull(0.3)), &hair, &motion, &rods);
            assert!(found < 1e-4, "{motion:?}, rods: {found} m deep");
            let found = depth(on, Some(skull(0.3)), &hair, &motion, &loose);
            assert!(found < 1e-3, "{motion:?}, no length pass: {found} m deep");
        }
        let through = depth(on, None, &hair, &Motion::Still, &exact);
        assert!(through > 1e-3, "a head that is not there is not noticed: {through} m");
    }
}

law! {
    long fn hair_that_rests_inside_a_ball_is_put_out_of_it(on) {
        // Straight down past the ball, 4 mm inside where it is nearest; the file says so, a head does not.
        let hair = one_strand(&line(Vec3::new(0.096, 0.14, 0.0), Vec3::new(0.096, -0.14, 0.0), 20));
        let [rods, exact, loose] = ways();
        let found = depth(on, Some(skull(0.3)), &hair, &Motion::Still, &exact);
        // Planes on a ball of 0.1 m err by less than 0.1 mm.
        assert!(found < 1e-4, "{found} m deep");
        let found = depth(on, Some(skull(0.3)), &hair, &Motion::Still, &rods);
        assert!(found < 1e-4, "rods: {found} m deep");
        let found = depth(on, Some(skull(0.3)), &hair, &Motion::Still, &loose);
        assert!(found < 1e-3, "no length pass: {found} m deep");
    }
}

law! {
    long fn no_hair_is_inside_the_mannequin_after_settling(on) {
        let settings = StyleSettings { strand_count: 300, ..StyleSettings::new(Style::Bob) };
        let hair = Guides::resample(&settings.grow().unwrap(), 16).unwrap();
        let shape = Shape::Mannequin(Mannequin::new());
        let resting =
            hair.positions().chunks(16).flat_map(|block| &block[2..]).map(|point| {
                (0..8).map(|lane| -shape.distance_and_gradient(point.get(lane)).0).fold(0.0, f32::max)
            });
        let resting = resting.fold(0.0, f32::max);
        let collider = Collider { shape, carrier: Carrier::HEAD, friction: 0.3 };
        // At rest what planes on the ears err by, which curve within 5 mm; shaken also what is left in
        // the creases of ears and neck, where two planes and a length cannot all be kept.
        let [rods, exact, _] = ways();
        for (motion, bound) in [(Motion::Still, 5e-4), (Motion::Shake, 3e-3)] {
            for settings in [&rods, &exact] {
                let found = depth(on, Some(collider.clone()), &hair, &motion, settings);
                let method = settings.strands.method;
                assert!(found < resting + bound, "{motion:?}, {method:?}: {found} m deep, {resting} m at rest");
            }
        }
        let through = depth_below(on, &collider, None, &hair, &Motion::Still, &exact);
        assert!(through > 1e-2, "a head that is not there is not noticed: {through} m");
    }
}
