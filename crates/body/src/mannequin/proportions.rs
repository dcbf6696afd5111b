use std::f32::consts::PI;

use glam::{Vec3, vec3};

use super::ear::{Arc, Ear};
use super::field::{Ellipsoid, RoundCone, Swelling};
use super::shape::{BustShape, SWELLING_COUNT};

const fn swelling(center: Vec3, radii: Vec3, height: f32, bend: f32) -> Swelling {
    Swelling { center, radii, height, bend }
}

impl BustShape {
    /// The proportions of the built-in bust.
    pub(super) fn mannequin() -> Self {
        Self {
            cranium: Ellipsoid { center: vec3(0.0, 0.012, -0.004), radii: vec3(0.077, 0.093, 0.096) },
            face: Ellipsoid { center: vec3(0.0, -0.045, 0.028), radii: vec3(0.060, 0.078, 0.062) },
            face_reach: 0.05,
            jaw: RoundCone {
                start: vec3(0.043, -0.075, 0.012),
                end: vec3(0.012, -0.102, 0.066),
                start_radius: 0.020,
                end_radius: 0.018,
            },
            jaw_reach: 0.03,
            chin: Ellipsoid { center: vec3(0.0, -0.106, 0.070), radii: vec3(0.022, 0.017, 0.020) },
            chin_reach: 0.02,
            nose: RoundCone {
                start: vec3(0.0, -0.004, 0.085),
                end: vec3(0.0, -0.046, 0.103),
                start_radius: 0.009,
                end_radius: 0.012,
            },
            nose_reach: 0.012,
            nostril: Ellipsoid { center: vec3(0.012, -0.052, 0.093), radii: vec3(0.007, 0.007, 0.009) },
            nostril_reach: 0.007,
            eyeball: Ellipsoid { center: vec3(0.0305, -0.016, 0.0705), radii: vec3(0.0135, 0.0115, 0.012) },
            eyeball_reach: 0.006,
            neck: RoundCone {
                start: vec3(0.0, -0.075, 0.000),
                end: vec3(0.0, -0.210, -0.042),
                start_radius: 0.048,
                end_radius: 0.052,
            },
            neck_reach: 0.022,
            trapezius: RoundCone {
                start: vec3(0.030, -0.150, -0.045),
                end: vec3(0.120, -0.225, -0.040),
                start_radius: 0.030,
                end_radius: 0.034,
            },
            trapezius_reach: 0.05,
            shoulder: RoundCone {
                start: vec3(0.05, -0.235, -0.02),
                end: vec3(0.145, -0.250, -0.03),
                start_radius: 0.050,
                end_radius: 0.048,
            },
            shoulder_reach: 0.04,
            chest: Ellipsoid { center: vec3(0.0, -0.290, -0.025), radii: vec3(0.150, 0.100, 0.075) },
            chest_reach: 0.05,
            muscle: RoundCone {
                start: vec3(0.050, -0.070, -0.020),
                end: vec3(0.012, -0.195, -0.002),
                start_radius: 0.010,
                end_radius: 0.008,
            },
            muscle_reach: 0.025,
            ear: ear(),
            swellings: swellings(),
        }
    }
}

fn ear() -> Ear {
    let arc = |x: f32, y: f32, z: f32, radius: f32, from: f32, to: f32, tube: f32| Arc {
        center: vec3(x, y, z),
        radius,
        middle: 0.5 * (from + to) * PI / 180.0,
        half_span: 0.5 * (to - from) * PI / 180.0,
        tube,
    };
    Ear {
        origin: vec3(0.0800, -0.0340, -0.0060),
        flare: 0.42,
        lean: 0.22,
        shell: Ellipsoid { center: vec3(0.001, 0.005, -0.0005), radii: vec3(0.014, 0.023, 0.0038) },
        stem: Ellipsoid { center: vec3(-0.004, 0.002, -0.008), radii: vec3(0.010, 0.017, 0.009) },
        lobe: Ellipsoid { center: vec3(-0.002, -0.022, 0.001), radii: vec3(0.0070, 0.0085, 0.0036) },
        tragus: Ellipsoid { center: vec3(-0.011, -0.006, 0.003), radii: vec3(0.0035, 0.006, 0.0035) },
        rim: [
            arc(-0.0050, 0.0130, 0.0015, 0.0080, 180.0, 265.0, 0.0022),
            arc(0.0010, 0.0130, 0.0030, 0.0140, 0.0, 180.0, 0.0026),
            arc(-0.0250, 0.0130, 0.0030, 0.0400, -48.0, 0.0, 0.0026),
        ],
        fold: arc(-0.0220, 0.0090, 0.0015, 0.0285, -38.0, 22.0, 0.0028),
        hollows: [
            swelling(vec3(-0.003, -0.003, 0.003), vec3(0.010, 0.012, 0.008), -0.0045, 0.0),
            swelling(vec3(0.000, 0.018, 0.004), vec3(0.009, 0.008, 0.006), -0.0015, 0.0),
        ],
    }
}

fn swellings() -> [Swelling; SWELLING_COUNT] {
    [
        // Skull: brow ridge, forehead, crown, back of the head, temples, nape.
        swelling(vec3(0.020, 0.004, 0.090), vec3(0.030, 0.016, 0.030), 0.0030, 0.0),
        swelling(vec3(0.000, 0.006, 0.092), vec3(0.030, 0.020, 0.030), 0.0020, 0.0),
        swelling(vec3(0.000, 0.045, 0.085), vec3(0.070, 0.050, 0.060), 0.0030, 0.0),
        swelling(vec3(0.030, 0.050, 0.072), vec3(0.040, 0.040, 0.040), 0.0020, 0.0),
        swelling(vec3(0.000, 0.100, -0.010), vec3(0.080, 0.050, 0.080), 0.0010, 0.0),
        swelling(vec3(0.000, -0.010, -0.095), vec3(0.070, 0.060, 0.060), 0.0020, 0.0),
        swelling(vec3(0.070, 0.020, -0.020), vec3(0.050, 0.060, 0.060), 0.0010, 0.0),
        swelling(vec3(0.062, -0.002, 0.060), vec3(0.030, 0.035, 0.035), -0.0020, 0.0),
        swelling(vec3(0.035, -0.055, -0.075), vec3(0.040, 0.045, 0.045), 0.0010, 0.0),
        swelling(vec3(0.055, 0.060, 0.010), vec3(0.050, 0.050, 0.060), 0.0010, 0.0),
        // Eyes: socket, inner corner, lid line, fold above, bag below, brow.
        swelling(vec3(0.030, -0.014, 0.086), vec3(0.026, 0.017, 0.030), -0.0080, 0.0),
        swelling(vec3(0.015, -0.015, 0.088), vec3(0.010, 0.011, 0.020), -0.0040, 0.0),
        swelling(vec3(0.0305, -0.0225, 0.082), vec3(0.017, 0.0022, 0.016), -0.0010, 14.0),
        swelling(vec3(0.031, -0.0040, 0.082), vec3(0.018, 0.0030, 0.020), -0.0008, -10.0),
        swelling(vec3(0.028, -0.0290, 0.084), vec3(0.018, 0.0060, 0.020), -0.0010, 8.0),
        swelling(vec3(0.036, 0.0040, 0.088), vec3(0.026, 0.0090, 0.030), 0.0015, -6.0),
        // Cheeks.
        swelling(vec3(0.048, -0.030, 0.074), vec3(0.032, 0.022, 0.034), 0.0040, 0.0),
        swelling(vec3(0.064, -0.030, 0.040), vec3(0.026, 0.020, 0.040), 0.0030, 0.0),
        swelling(vec3(0.034, -0.050, 0.088), vec3(0.030, 0.030, 0.030), 0.0030, 0.0),
        swelling(vec3(0.046, -0.070, 0.064), vec3(0.030, 0.030, 0.034), -0.0020, 0.0),
        swelling(vec3(0.058, -0.070, 0.030), vec3(0.030, 0.030, 0.040), 0.0010, 0.0),
        // Nose: side walls, wing groove, nostril, septum, tip.
        swelling(vec3(0.012, -0.028, 0.098), vec3(0.014, 0.022, 0.022), 0.0010, 0.0),
        swelling(vec3(0.0195, -0.050, 0.090), vec3(0.006, 0.010, 0.014), -0.0010, 0.0),
        swelling(vec3(0.0065, -0.0585, 0.102), vec3(0.0050, 0.0050, 0.0075), -0.0035, 0.0),
        swelling(vec3(0.000, -0.057, 0.106), vec3(0.008, 0.007, 0.012), 0.0010, 0.0),
        swelling(vec3(0.000, -0.046, 0.114), vec3(0.012, 0.012, 0.012), 0.0005, 0.0),
        swelling(vec3(0.000, -0.020, 0.100), vec3(0.012, 0.024, 0.020), 0.0010, 0.0),
        // Mouth: its mound, upper and lower lip, bow, lip line, corners, philtrum, crease above the chin.
        swelling(vec3(0.000, -0.075, 0.090), vec3(0.044, 0.034, 0.040), 0.0050, 0.0),
        swelling(vec3(0.008, -0.0720, 0.099), vec3(0.016, 0.0065, 0.018), 0.0028, -8.0),
        swelling(vec3(0.000, -0.0840, 0.096), vec3(0.022, 0.0080, 0.018), 0.0035, 8.0),
        swelling(vec3(0.000, -0.0720, 0.102), vec3(0.006, 0.0050, 0.012), 0.0005, 0.0),
        swelling(vec3(0.000, -0.0775, 0.099), vec3(0.027, 0.0028, 0.022), -0.0028, -3.0),
        swelling(vec3(0.026, -0.0790, 0.086), vec3(0.009, 0.0080, 0.016), -0.0020, 0.0),
        swelling(vec3(0.000, -0.0640, 0.102), vec3(0.006, 0.0090, 0.012), -0.0010, 0.0),
        swelling(vec3(0.000, -0.0950, 0.092), vec3(0.024, 0.0090, 0.024), -0.0025, 6.0),
        swelling(vec3(0.030, -0.066, 0.088), vec3(0.016, 0.022, 0.024), -0.0010, 0.0),
        // Chin and jaw.
        swelling(vec3(0.000, -0.108, 0.088), vec3(0.020, 0.018, 0.024), 0.0020, 0.0),
        swelling(vec3(0.024, -0.108, 0.074), vec3(0.022, 0.020, 0.030), -0.0010, 0.0),
        swelling(vec3(0.050, -0.088, 0.014), vec3(0.026, 0.026, 0.032), 0.0020, 0.0),
        swelling(vec3(0.000, -0.125, 0.050), vec3(0.050, 0.026, 0.040), 0.0005, 0.0),
        swelling(vec3(0.066, -0.055, 0.010), vec3(0.026, 0.030, 0.030), 0.0005, 0.0),
        swelling(vec3(0.000, 0.070, 0.060), vec3(0.080, 0.045, 0.060), 0.0005, 0.0),
    ]
}
