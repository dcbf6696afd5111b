//! A curl that hangs keeps its turns.

use glam::{Vec3, vec3};
use strandline_checks::{On, Rig, law};
use strandline_groom::{Groom, Guides};
use strandline_sim::rods::Rest;
use strandline_sim::{Drive, Model, Settings};

/// A curl of eight turns: radius 9 mm, 4 cm of hair a turn, hanging from the origin.
pub fn curl() -> Guides {
    let mut groom = Groom::empty(8e-5);
    let root = [Vec3::ZERO, vec3(0.0, -0.004, 0.0)];
    let turns = (1..=96).map(|step| {
        let (along, angle) = (step as f32 / 96.0, std::f32::consts::TAU * 8.0 * step as f32 / 96.0);
        let radius = 0.009 * (4.0 * along).min(1.0);
        vec3(radius * angle.cos(), -0.004 - 0.12 * along, radius * angle.sin())
    });
    groom.push(root.into_iter().chain(turns));
    Guides::resample(&groom, 64).unwrap()
}

/// Height \[m\] from root to tip and mean distance \[m\] from the axis after two seconds.
fn hung(on: &On, rest: Rest, youngs_modulus: f32) -> (f32, f32) {
    let mut settings = Settings::default();
    let rods = &mut settings.strands.rods;
    (rods.rest, rods.youngs_modulus) = (rest, youngs_modulus);
    settings.volume.enabled = false;
    let guides = curl();
    let model = Model::new(&guides, &settings, Vec::new()).unwrap();
    let mut rig = Rig::new(on, model);
    rig.steps(&vec![Drive::default(); 120]);
    let points: Vec<Vec3> = rig.state().positions.iter().map(|lanes| lanes.get(0)).collect();
    let axis = |point: &Vec3| vec3(point.x, 0.0, point.z).length();
    let radius = points.iter().skip(16).map(axis).sum::<f32>() / (points.len() - 16) as f32;
    (-points[63].y, radius)
}

law! {
    fn a_curl_keeps_its_turns_and_a_soft_one_hangs_straight(on) {
        let (height, radius) = hung(on, Rest::SagFree, 3.5);
        // It is 12.4 cm high at rest; straight it would be some 40 cm.
        assert!((height - 0.124).abs() < 1e-4 && radius > 0.0075, "height {height}, radius {radius}");
        let (soft_height, soft_radius) = hung(on, Rest::Unstressed, 0.02);
        assert!(soft_height > 1.3 * height && soft_radius < radius, "{soft_height}, {soft_radius}: it can fail");
    }
}
