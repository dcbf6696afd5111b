//! Small grooms for the checks.

use glam::Vec3;
use strandline_groom::Groom;

/// Numbers 0 to 1, 1 excluded, from a counter (the generator of PCG).
pub struct Random(pub u64);

impl Random {
    /// The next number.
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / 16_777_216.0
    }

    /// A number between two.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }
}

/// Strands 15 to 25 cm long that leave a ball of 9 cm on its upper half and bend down in waves.
pub fn arcs(strand_count: usize) -> Groom {
    let mut random = Random(11);
    let mut groom = Groom::empty(8e-5);
    let mut normals = Vec::new();
    for _ in 0..strand_count {
        let height = random.unit();
        let turn = random.unit() * std::f32::consts::TAU;
        let flat = (1.0 - height * height).sqrt();
        let normal = Vec3::new(flat * turn.cos(), height, flat * turn.sin());
        let step = random.between(0.15, 0.25) / 20.0;
        let (phase, wave) = (random.unit() * 6.0, random.between(0.0, 0.3));
        let mut point = normal * 0.09;
        let mut points = vec![point];
        for index in 0..20 {
            let share = index as f32 / 20.0;
            let side = normal.cross(Vec3::Y) * (wave * (phase + 9.0 * share).sin());
            point += (normal * (1.0 - share) + Vec3::NEG_Y * 1.5 * share + side).normalize() * step;
            points.push(point);
        }
        groom.push(points);
        normals.push(normal);
    }
    groom.root_normals = Some(normals);
    groom
}
