use glam::{Vec3, vec3};

use super::ear::{Arc, Ear};
use super::field::{Ellipsoid, RoundCone, Swelling};
use super::shape::{BustShape, DETAIL_COUNT, MASS_COUNT};

const fn swelling(center: Vec3, radii: Vec3, height: f32, bend: f32) -> Swelling {
    Swelling::new(center, radii, height, bend)
}

impl BustShape {
    /// The proportions of the built-in bust.
    pub(super) fn mannequin() -> Self {
        Self {
            cranium: Ellipsoid { center: vec3(0.0000, 0.0107, -0.0057), radii: vec3(0.0821, 0.0980, 0.0942) },
            face: Ellipsoid { center: vec3(0.0000, -0.0477, 0.0413), radii: vec3(0.0667, 0.0804, 0.0475) },
            face_reach: 0.0151,
            jaw: cone(vec3(0.0458, -0.0724, 0.0198), vec3(0.0029, -0.0953, 0.0625), [0.0085, 0.0251]),
            jaw_reach: 0.0249,
            chin: Ellipsoid { center: vec3(0.0000, -0.1088, 0.0699), radii: vec3(0.0246, 0.0172, 0.0188) },
            chin_reach: 0.0221,
            nose: cone(vec3(0.0000, -0.0050, 0.0840), vec3(0.0000, -0.0441, 0.1032), [0.0061, 0.0116]),
            nose_reach: 0.0173,
            nostril: Ellipsoid { center: vec3(0.0134, -0.0474, 0.0928), radii: vec3(0.0028, 0.0069, 0.0103) },
            nostril_reach: 0.0072,
            eyeball: Ellipsoid { center: vec3(0.0305, -0.0165, 0.0705), radii: vec3(0.0155, 0.0122, 0.0125) },
            eyeball_reach: 0.0070,
            lids: [
                swelling(vec3(0.0305, -0.0230, 0.0820), vec3(0.0175, 0.0024, 0.0130), -0.0013, 13.0),
                swelling(vec3(0.0310, -0.0085, 0.0820), vec3(0.0180, 0.0030, 0.0140), -0.0009, -12.0),
            ],
            neck: cone(vec3(0.0000, -0.0358, 0.0000), vec3(0.0000, -0.2072, -0.0349), [0.0579, 0.0362]),
            neck_reach: 0.0301,
            trapezius: cone(vec3(0.0290, -0.1722, -0.0541), vec3(0.0995, -0.2192, -0.0866), [0.0116, 0.0127]),
            trapezius_reach: 0.0621,
            shoulder: cone(vec3(0.0401, -0.2409, -0.0539), vec3(0.1462, -0.2533, -0.0421), [0.0544, 0.0575]),
            shoulder_reach: 0.0446,
            chest: Ellipsoid { center: vec3(0.0000, -0.2954, -0.0162), radii: vec3(0.1529, 0.0895, 0.0832) },
            chest_reach: 0.0851,
            muscle: cone(vec3(0.0462, -0.0499, -0.0037), vec3(-0.0002, -0.1865, -0.0034), [0.0081, -0.0049]),
            muscle_reach: 0.0195,
            ear: ear(),
            masses: masses(),
            details: details(),
        }
    }
}

/// Between two points \[m\], with a radius \[m\] at each.
fn cone(start: Vec3, end: Vec3, [start_radius, end_radius]: [f32; 2]) -> RoundCone {
    RoundCone { start, end, start_radius, end_radius }
}

fn ear() -> Ear {
    let arc = |x: f32, y: f32, z: f32, radius: f32, from: f32, to: f32, tube: f32| {
        Arc::new(vec3(x, y, z), radius, from, to, tube)
    };
    Ear {
        origin: vec3(0.0800, -0.0340, -0.0060),
        head_from_ear: Ear::frame(0.42, 0.22),
        shell: Ellipsoid { center: vec3(0.001, 0.005, -0.0005), radii: vec3(0.014, 0.023, 0.0038) },
        stem: Ellipsoid { center: vec3(-0.004, 0.002, -0.008), radii: vec3(0.010, 0.017, 0.009) },
        lobe: Ellipsoid { center: vec3(-0.002, -0.022, 0.001), radii: vec3(0.0070, 0.0085, 0.0036) },
        tragus: Ellipsoid { center: vec3(-0.011, -0.006, 0.003), radii: vec3(0.0035, 0.006, 0.0035) },
        rim: [
            arc(-0.0050, 0.0130, 0.0015, 0.0080, 180.0, 265.0, 0.0025),
            arc(0.0010, 0.0130, 0.0030, 0.0140, 0.0, 180.0, 0.0029),
            arc(-0.0250, 0.0130, 0.0030, 0.0400, -48.0, 0.0, 0.0029),
        ],
        fold: arc(-0.0220, 0.0090, 0.0015, 0.0285, -38.0, 22.0, 0.0028),
        hollows: [
            swelling(vec3(-0.003, -0.003, 0.003), vec3(0.010, 0.012, 0.008), -0.0040, 0.0),
            swelling(vec3(0.000, 0.018, 0.004), vec3(0.009, 0.008, 0.006), -0.0015, 0.0),
        ],
    }
}

fn masses() -> [Swelling; MASS_COUNT] {
    [
        // Skull: brow ridge, forehead, crown, back of the head, temples, nape.
        swelling(vec3(0.0337, 0.0056, 0.0828), vec3(0.0362, 0.0212, 0.0308), 0.0062, 0.0),
        swelling(vec3(0.0000, 0.0053, 0.0922), vec3(0.0299, 0.0204, 0.0300), 0.0032, 0.0),
        swelling(vec3(0.0000, 0.0220, 0.0793), vec3(0.0937, 0.0565, 0.0580), 0.0100, 0.0),
        swelling(vec3(0.0343, 0.0535, 0.0663), vec3(0.0419, 0.0394, 0.0388), 0.0019, 0.0),
        swelling(vec3(0.0000, 0.0999, -0.0234), vec3(0.0754, 0.0504, 0.0809), -0.0056, 0.0),
        swelling(vec3(0.0000, -0.0005, -0.0966), vec3(0.0680, 0.0636, 0.0593), -0.0033, 0.0),
        swelling(vec3(0.0673, 0.0154, 0.0077), vec3(0.0485, 0.0675, 0.0810), -0.0086, 0.0),
        swelling(vec3(0.0540, -0.0050, 0.0667), vec3(0.0355, 0.0336, 0.0426), 0.0050, 0.0),
        swelling(vec3(0.0200, -0.0618, -0.0748), vec3(0.0416, 0.0379, 0.0435), -0.0065, 0.0),
        swelling(vec3(0.0522, 0.0633, 0.0121), vec3(0.0492, 0.0504, 0.0619), 0.0001, 0.0),
        swelling(vec3(0.0000, 0.0678, 0.0524), vec3(0.0984, 0.0481, 0.0660), 0.0075, 0.0),
        // Eye socket and brow.
        swelling(vec3(0.0300, -0.0150, 0.0860), vec3(0.0270, 0.0180, 0.0300), -0.0072, 0.0),
        swelling(vec3(0.0362, 0.0040, 0.0879), vec3(0.0260, 0.0090, 0.0300), -0.0001, -6.0),
        // Cheeks.
        swelling(vec3(0.0549, -0.0391, 0.0685), vec3(0.0306, 0.0245, 0.0331), 0.0047, 0.0),
        swelling(vec3(0.0627, -0.0266, 0.0449), vec3(0.0253, 0.0221, 0.0410), 0.0024, 0.0),
        swelling(vec3(0.0349, -0.0508, 0.0877), vec3(0.0301, 0.0287, 0.0302), 0.0025, 0.0),
        swelling(vec3(0.0448, -0.0677, 0.0664), vec3(0.0307, 0.0308, 0.0347), 0.0024, 0.0),
        swelling(vec3(0.0546, -0.0719, 0.0368), vec3(0.0303, 0.0316, 0.0456), -0.0043, 0.0),
        // Around the mouth.
        swelling(vec3(0.0000, -0.0691, 0.0929), vec3(0.0405, 0.0322, 0.0425), 0.0142, 0.0),
        swelling(vec3(0.0000, -0.0954, 0.0921), vec3(0.0240, 0.0090, 0.0240), -0.0013, 5.8),
        swelling(vec3(0.0307, -0.0683, 0.0871), vec3(0.0162, 0.0229, 0.0243), 0.0029, 0.0),
        // Chin and jaw.
        swelling(vec3(0.0000, -0.1079, 0.0880), vec3(0.0200, 0.0180, 0.0240), -0.0004, 0.0),
        swelling(vec3(0.0239, -0.1037, 0.0759), vec3(0.0233, 0.0193, 0.0312), -0.0042, 0.0),
        swelling(vec3(0.0505, -0.0895, 0.0154), vec3(0.0262, 0.0265, 0.0322), 0.0032, 0.0),
        swelling(vec3(0.0000, -0.1253, 0.0511), vec3(0.0504, 0.0257, 0.0392), -0.0059, 0.0),
        swelling(vec3(0.0665, -0.0524, 0.0097), vec3(0.0262, 0.0328, 0.0329), 0.0063, 0.0),
    ]
}

fn details() -> [Swelling; DETAIL_COUNT] {
    [
        // Eyes: inner corner, bag.
        swelling(vec3(0.0150, -0.0150, 0.0880), vec3(0.0100, 0.0110, 0.0200), -0.0040, 0.0),
        swelling(vec3(0.0280, -0.0290, 0.0840), vec3(0.0180, 0.0060, 0.0200), -0.0010, 8.0),
        // Nose: side walls, wing groove, nostril, septum, tip, ridge.
        swelling(vec3(0.0120, -0.0281, 0.0979), vec3(0.0140, 0.0220, 0.0220), 0.0004, 0.0),
        swelling(vec3(0.0195, -0.0500, 0.0900), vec3(0.0060, 0.0100, 0.0140), -0.0006, 0.0),
        swelling(vec3(0.0065, -0.0585, 0.1020), vec3(0.0050, 0.0050, 0.0075), -0.0035, 0.0),
        swelling(vec3(0.0000, -0.0570, 0.1060), vec3(0.0080, 0.0070, 0.0120), 0.0010, 0.0),
        swelling(vec3(0.0000, -0.0460, 0.1140), vec3(0.0120, 0.0120, 0.0120), 0.0013, 0.0),
        swelling(vec3(0.0000, -0.0199, 0.1000), vec3(0.0120, 0.0240, 0.0200), 0.0008, 0.0),
        // Mouth: upper and lower lip, bow, lip line, corners, philtrum.
        swelling(vec3(0.0086, -0.0721, 0.0990), vec3(0.0185, 0.0068, 0.0200), 0.0030, -8.1),
        swelling(vec3(0.0000, -0.0843, 0.0958), vec3(0.0245, 0.0080, 0.0200), 0.0034, 7.6),
        swelling(vec3(0.0000, -0.0720, 0.1020), vec3(0.0060, 0.0050, 0.0120), 0.0006, 0.0),
        swelling(vec3(0.0000, -0.0775, 0.0989), vec3(0.0272, 0.0028, 0.0220), -0.0031, -4.5),
        swelling(vec3(0.0245, -0.0786, 0.0880), vec3(0.0100, 0.0080, 0.0160), -0.0008, 0.0),
        swelling(vec3(0.0000, -0.0640, 0.1020), vec3(0.0060, 0.0090, 0.0120), 0.0002, 0.0),
    ]
}
