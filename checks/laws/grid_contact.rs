//! Solids that are sampled: hair that leaves their box and comes back, violent shakes, a report that sees.

use std::f32::consts::PI;

use glam::{Vec3, vec3};
use strandline_body::{Aabb, Carrier, Collider, DistanceGrid, Pose, Shape, SignedDistance};
use strandline_checks::{On, Rig, law};
use strandline_groom::{Groom, Guides, RestShape};
use strandline_sim::{Drive, Model, Settings, VolumeSettings};

use crate::strands::{ball_of_hair, line, one_strand};

/// An exact ball.
struct Ball {
    center: Vec3,
    radius: f32,
}

impl SignedDistance for Ball {
    fn distance(&self, point: Vec3) -> f32 {
        point.distance(self.center) - self.radius
    }

    fn distance_and_gradient(&self, point: Vec3) -> (f32, Vec3) {
        (self.distance(point), (point - self.center).normalize_or(Vec3::Y))
    }

    fn bounds(&self) -> Aabb {
        Aabb { min: self.center - self.radius, max: self.center + self.radius }
    }
}

/// The ball sampled every 4 mm in a box with 2 cm of air, as scenes do: on the ball itself wrong by 0.04 mm.
fn sampled(ball: &Ball, carrier: Carrier) -> Collider {
    let grid = DistanceGrid::from_field(ball, 0.004, 0.02).unwrap();
    Collider { shape: Shape::Grid(grid.into()), carrier, friction: 0.3 }
}

/// A square of strands that hang 25 cm down from the plane y = 0, one nearly over the middle.
fn curtain() -> Guides {
    let mut groom = Groom::empty(8e-5);
    for strand in 0..25 {
        let root = vec3((strand % 5) as f32 - 2.0, 0.0, (strand / 5) as f32 - 2.0) * 0.04 + Vec3::X * 2e-3;
        groom.push(line(root, root + Vec3::NEG_Y * 0.25, 20));
    }
    Guides::resample(&groom, 16).unwrap()
}

/// Depth \[m\] of the free points of a rig inside a ball that stays or that the head carries.
fn depth(rig: &mut Rig, ball: &Ball, head: Pose, carrier: Carrier) -> f32 {
    let points = rig.model().points_per_strand();
    let from_world = if carrier == Carrier::HEAD { head.inverse() } else { Pose::IDENTITY };
    let blocks = rig.state().positions.chunks(points);
    let free = blocks.flat_map(|block| &block[Model::ROOTED_POINTS..]);
    let lanes = free.flat_map(|lanes| (0..8).map(|lane| lanes.get(lane)));
    lanes.map(|point| -ball.distance(from_world.point(point))).fold(0.0, f32::max)
}

/// Deepest point \[m\] of hair that is lowered onto a ball, taken away and lowered again, and how far the
/// report was off.
fn lowered(on: &On, ball: &Ball, colliders: Vec<Collider>, settings: &Settings) -> (f32, f32) {
    let mut rig = Rig::new(on, Model::new(&curtain(), settings, colliders).unwrap());
    let (mut deepest, mut unseen) = (0.0_f32, 0.0_f32);
    let away = vec3(0.0, 0.0, 0.0);
    let onto = vec3(0.0, -0.5, 0.0);
    let aside = vec3(0.4, 0.2, 0.1);
    for (from, to, steps) in [(away, onto, 40), (onto, aside, 40), (aside, onto, 40)] {
        for step in 1..=steps {
            let head = Pose { translation: from.lerp(to, step as f32 / steps as f32), ..Pose::IDENTITY };
            let report = rig.step(&Drive::of(head));
            let found = depth(&mut rig, ball, head, Carrier::World);
            deepest = deepest.max(found);
            unseen = unseen.max((report.penetration_max - found).abs());
        }
    }
    (deepest, unseen)
}

law! {
    long fn hair_that_leaves_the_box_of_a_grid_and_comes_back_stays_outside(on) {
        let ball = Ball { center: Vec3::NEG_Y * 0.75, radius: 0.1 };
        let mut settings = Settings::constrained();
        settings.volume.enabled = false;
        let solid = vec![sampled(&ball, Carrier::World)];
        let (deepest, _) = lowered(on, &ball, solid.clone(), &settings);
        // Samples of the ball err by 0.04 mm, planes taken a millimetre away by 0.01 mm.
        assert!(deepest < 1e-4, "{deepest} m deep");
        let rods = Settings { volume: settings.volume, ..Settings::default() };
        let (deepest, unseen) = lowered(on, &ball, solid.clone(), &rods);
        // The same length pass puts rods outside, after both parts of a step.
        assert!(deepest < 1e-4, "rods: {deepest} m deep");
        assert!(unseen < 1e-4, "rods: the report is {unseen} m off");
        let thesis = Settings { volume: settings.volume, ..Settings::thesis() };
        let (deepest, unseen) = lowered(on, &ball, solid, &thesis);
        // Nothing follows the rounds there: planes are taken up to 1 mm away.
        assert!(deepest < 1e-3, "the thesis: {deepest} m deep");
        assert!(unseen < 1e-4, "the report is {unseen} m off");
        let (through, _) = lowered(on, &ball, Vec::new(), &settings);
        assert!(through > 0.05, "a ball that is not there is not noticed: {through} m");
    }
}

law! {
    fn the_report_sees_hair_that_cannot_get_out(on) {
        // Hair of 2 cm that the head carries 3 cm deep into a ball from far outside its box.
        let ball = Ball { center: Vec3::NEG_Y * 0.75, radius: 0.1 };
        let mut groom = Groom::empty(8e-5);
        for strand in 0..9 {
            let root = vec3((strand % 3) as f32 + 2.5, 0.0, (strand / 3) as f32 + 2.5) * 0.03;
            groom.push(line(root, root + Vec3::NEG_Y * 0.02, 8));
        }
        let hair = Guides::resample(&groom, 8).unwrap();
        for settings in [Settings::constrained(), Settings::default()] {
            let method = settings.strands.method;
            let settings = Settings { volume: VolumeSettings { enabled: false, ..settings.volume }, ..settings };
            let model = Model::new(&hair, &settings, vec![sampled(&ball, Carrier::World)]).unwrap();
            let mut rig = Rig::new(on, model);
            for step in 1..=60 {
                let way = vec3(-0.105, -0.7, -0.105) * (step as f32 / 60.0);
                let head = Pose { translation: way, ..Pose::IDENTITY };
                let report = rig.step(&Drive::of(head));
                let found = depth(&mut rig, &ball, head, Carrier::World);
                // Error of the samples, 1.5 cm and more from the middle.
                let off = (report.penetration_max - found).abs();
                assert!(off < 3e-4, "{method:?}, step {step}: {found} m deep, the report is {off} m off");
                assert!(step < 60 || found > 0.02, "{method:?}: nothing is inside: {found}");
            }
        }
    }
}

law! {
    fn the_report_sees_hair_that_is_taut_through_a_solid(on) {
        // Held at both ends, which the head carries past a small ball: nothing can give way. The contacts
        // looked up the ball millimetres away.
        let ball = Ball { center: Vec3::NEG_Y * 0.3, radius: 0.02 };
        let hair = one_strand(&line(Vec3::NEG_X * 0.1, Vec3::X * 0.1, 15));
        let rest = RestShape::new(&hair, 6.5e-6);
        let mut settings = Settings::constrained();
        settings.volume.enabled = false;
        let shape = Shape::Sphere { center: ball.center, radius: ball.radius };
        let solid = Collider { shape, carrier: Carrier::World, friction: 0.3 };
        let held = |_: usize, point: usize| point == 0 || point == 15;
        let model = Model::with_rest(&hair, rest, held, &settings, vec![solid]).unwrap();
        let mut rig = Rig::new(on, model);
        let mut deepest = 0.0_f32;
        for step in 1..=60 {
            let head = Pose { translation: ball.center * (step as f32 / 60.0), ..Pose::IDENTITY };
            let report = rig.step(&Drive::of(head));
            let found = depth(&mut rig, &ball, head, Carrier::World);
            // Rounding of places of some decimetres.
            let off = (report.penetration_max - found).abs();
            assert!(off < 1e-6, "step {step}: {found} m deep, the report is {off} m off");
            deepest = deepest.max(found);
        }
        assert!(deepest > 0.01, "nothing is inside: {deepest}");
    }
}

/// Deepest point \[m\] in 2 s (on a software adapter 0.4 s) of a shake of 20 g at 5 Hz: the head goes up to 10 cm a step.
fn shaken(on: &On, collider: Collider, settings: &Settings) -> f32 {
    let ball = Ball { center: Vec3::ZERO, radius: 0.1 };
    let hair = ball_of_hair(64, 12, 0.3);
    let mut rig = Rig::new(on, Model::new(&hair, settings, vec![collider]).unwrap());
    let speed = 2.0 * PI * 5.0;
    let amplitude = 20.0 * 9.81 / (speed * speed);
    let mut deepest = 0.0_f32;
    for step in 1..=on.either(120, 24) {
        let aside = Vec3::X * amplitude * (speed * step as f32 / 60.0).sin();
        let head = Pose { translation: aside, ..Pose::IDENTITY };
        let report = rig.step(&Drive::of(head));
        assert_eq!(report.non_finite, 0, "step {step}");
        deepest = deepest.max(depth(&mut rig, &ball, head, Carrier::HEAD));
    }
    deepest
}

law! {
    long fn a_violent_shake_takes_no_hair_into_the_head(on) {
        let ball = Ball { center: Vec3::ZERO, radius: 0.1 };
        let shape = Shape::Sphere { center: Vec3::ZERO, radius: 0.1 };
        let exact = Collider { shape, carrier: Carrier::HEAD, friction: 0.3 };
        for solid in [exact, sampled(&ball, Carrier::HEAD)] {
            let deepest = shaken(on, solid.clone(), &Settings::constrained());
            assert!(deepest < 2e-3, "{deepest} m deep in {:?}", solid.shape);
            let rods = shaken(on, solid.clone(), &Settings::default());
            assert!(rods < 2e-3, "rods: {rods} m deep in {:?}", solid.shape);
            let thesis = shaken(on, solid, &Settings::thesis());
            assert!(thesis < 2e-3, "the thesis: {thesis} m deep");
        }
    }
}

law! {
    fn a_fast_tip_does_not_pass_through_a_solid(on) {
        // 23 and 50 cm in a step, through a ball of 10 cm and beyond it: out of the box of its samples again, the
        // farther the worse if the distance there were too large.
        let speeds = [14.0, 30.0].map(|speed| Vec3::NEG_Y * speed);
        let ball = Ball { center: Vec3::ZERO, radius: 0.05 };
        let points = line(vec3(-0.01, 0.1, 0.01), vec3(0.01, 0.1, 0.01), 7);
        let mut groom = Groom::empty(8e-5);
        groom.push(points);
        let hair = Guides::resample(&groom, 8).unwrap();
        let rest = RestShape::new(&hair, 6.5e-6);
        let shape = Shape::Sphere { center: Vec3::ZERO, radius: 0.05 };
        let exact = Collider { shape, carrier: Carrier::World, friction: 0.3 };
        for (solids, stays) in [(vec![exact], true), (vec![sampled(&ball, Carrier::World)], true), (Vec::new(), false)] {
            let ways = [Settings::constrained(), Settings::thesis()].into_iter();
            for (settings, speed) in ways.flat_map(|settings| speeds.map(|speed| (settings.clone(), speed))) {
                let loose = |_: usize, _: usize| false;
                let model = Model::with_rest(&hair, rest.clone(), loose, &settings, solids.clone()).unwrap();
                let mut rig = Rig::new(on, model);
                rig.change(|state| {
                    for velocity in &mut state.velocities {
                        (0..8).for_each(|lane| velocity.set(lane, speed));
                    }
                });
                rig.step(&Drive::default());
                let above = rig.state().positions.iter().all(|lanes| lanes.get(0).y > 0.0);
                assert_eq!(above, stays, "{:?}", rig.state().positions[4].get(0));
            }
        }
    }
}
