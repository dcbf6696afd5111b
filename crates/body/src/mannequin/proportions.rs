use glam::{Vec3, vec3};

use super::ear::{Arc, Ear};
use super::eye::Eye;
use super::field::{Ellipsoid, RoundCone, Swelling};
use super::person::{Build, Eyes};
use super::shape::{BustShape, DETAIL_COUNT, MASS_COUNT, THROAT_COUNT};

const fn swelling(center: Vec3, radii: Vec3, height: f32, bend: f32) -> Swelling {
    Swelling::new(center, radii, height, bend)
}

impl BustShape {
    /// The proportions of the built-in bust.
    pub(super) fn of(build: Build, eyes: Eyes) -> Self {
        let breadth = build.breadth();
        // Factors of the neck's lower radii and of the way to the shoulders.
        let (neck, aside) = (1.0 + 0.16 * breadth, 1.0 + 0.10 * breadth);
        Self {
            cranium: Ellipsoid { center: vec3(0.0000, 0.0107, -0.0057), radii: vec3(0.0821, 0.0980, 0.0942) },
            face: Ellipsoid { center: vec3(0.0000, -0.0477, 0.0413), radii: vec3(0.0667, 0.0804, 0.0475) },
            face_reach: 0.0151,
            jaw: cone(
                vec3(0.0458 + 0.0030 * breadth, -0.0724, 0.0198),
                vec3(0.0029, -0.0953, 0.0625),
                [0.0085, 0.0251],
            ),
            jaw_reach: 0.0249,
            chin: Ellipsoid { center: vec3(0.0000, -0.1088, 0.0699), radii: vec3(0.0246, 0.0172, 0.0188) },
            chin_reach: 0.0221,
            nose: cone(vec3(0.0000, -0.0050, 0.0840), vec3(0.0000, -0.0441, 0.1032), [0.0061, 0.0116]),
            nose_reach: 0.0173,
            nostril: Ellipsoid { center: vec3(0.0118, -0.0490, 0.0945), radii: vec3(0.0050, 0.0068, 0.0100) },
            nostril_reach: 0.0060,
            eye: eye(eyes),
            neck: cone(
                vec3(0.0000, -0.0358, 0.0000),
                vec3(0.0000, -0.2072, -0.0349),
                [0.0579, 0.0362 * neck],
            ),
            neck_reach: 0.0301,
            trapezius: cone(
                vec3(0.0290, -0.1722, -0.0541),
                vec3(0.0995 * aside, -0.2192, -0.0866),
                [0.0116 * neck, 0.0127 * neck],
            ),
            trapezius_reach: 0.0621,
            shoulder: cone(
                vec3(0.0401, -0.2409, -0.0539),
                vec3(0.1462 * aside, -0.2533, -0.0421),
                [0.0544, 0.0575 * neck.sqrt()],
            ),
            shoulder_reach: 0.0446,
            chest: Ellipsoid {
                center: vec3(0.0000, -0.2954, -0.0162),
                radii: vec3(0.1529 * aside, 0.0895, 0.0832 * aside),
            },
            chest_reach: 0.0851,
            muscle: cone(vec3(0.0462, -0.0499, -0.0037), vec3(0.0045, -0.1930, 0.0050), [0.0081, -0.0010]),
            muscle_reach: 0.0180,
            collar_bone: cone(
                vec3(0.0200, -0.2115, 0.0075),
                vec3(0.1080 * aside, -0.2060, -0.0320),
                [0.0090, 0.0060],
            ),
            collar_bone_reach: 0.0300,
            throat: throat(),
            ear: ear(),
            masses: masses(breadth),
            details: details(),
        }
    }
}

/// Between two points \[m\], with a radius \[m\] at each.
fn cone(start: Vec3, end: Vec3, [start_radius, end_radius]: [f32; 2]) -> RoundCone {
    RoundCone { start, end, start_radius, end_radius }
}

/// Middle of a nostril \[m\].
pub(super) const NOSTRIL: Vec3 = vec3(0.0068, -0.0552, 0.1050);

fn eye(eyes: Eyes) -> Eye {
    let (middle, margins, crease) = match eyes {
        Eyes::Open => (0.0, [0.0047, 0.0050], 0.0040),
        Eyes::Closed => (-0.0042, [0.0005, 0.0004], 0.0115),
    };
    Eye {
        center: vec3(0.0315, -0.0165, 0.0725),
        radius: 0.0120,
        lid: 0.0016,
        half_width: 0.0140,
        middle,
        margins,
        crease,
        tilt: 0.0016,
        reach: 0.0095,
    }
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
        tragus: Ellipsoid { center: vec3(-0.0115, -0.0055, 0.0015), radii: vec3(0.0042, 0.0055, 0.0034) },
        rim: [
            arc(-0.0050, 0.0130, 0.0010, 0.0080, 180.0, 285.0, 0.0022),
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

fn masses(breadth: f32) -> [Swelling; MASS_COUNT] {
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
        swelling(vec3(0.0549, -0.0391, 0.0685), vec3(0.0306, 0.0245, 0.0331), 0.0047 - 0.0006 * breadth, 0.0),
        swelling(vec3(0.0627, -0.0266, 0.0449), vec3(0.0253, 0.0221, 0.0410), 0.0024, 0.0),
        swelling(vec3(0.0349, -0.0508, 0.0877), vec3(0.0301, 0.0287, 0.0302), 0.0025, 0.0),
        swelling(vec3(0.0448, -0.0677, 0.0664), vec3(0.0307, 0.0308, 0.0347), 0.0024 + 0.0030 * breadth, 0.0),
        swelling(
            vec3(0.0546, -0.0719, 0.0368),
            vec3(0.0303, 0.0316, 0.0456),
            -0.0043 + 0.0035 * breadth,
            0.0,
        ),
        // Around the mouth.
        swelling(vec3(0.0000, -0.0722, 0.0929), vec3(0.0405, 0.0322, 0.0425), 0.0130, 0.0),
        swelling(vec3(0.0000, -0.0954, 0.0921), vec3(0.0240, 0.0090, 0.0240), -0.0013, 5.8),
        swelling(vec3(0.0307, -0.0683, 0.0871), vec3(0.0162, 0.0229, 0.0243), 0.0029, 0.0),
        // Chin and jaw.
        swelling(vec3(0.0000, -0.1079, 0.0880), vec3(0.0200, 0.0180, 0.0240), -0.0004, 0.0),
        swelling(vec3(0.0239, -0.1037, 0.0759), vec3(0.0233, 0.0193, 0.0312), -0.0042, 0.0),
        swelling(vec3(0.0505, -0.0895, 0.0154), vec3(0.0262, 0.0265, 0.0322), 0.0032 + 0.0030 * breadth, 0.0),
        swelling(vec3(0.0000, -0.1253, 0.0511), vec3(0.0504, 0.0257, 0.0392), -0.0059, 0.0),
        swelling(vec3(0.0665, -0.0524, 0.0097), vec3(0.0262, 0.0328, 0.0329), 0.0063, 0.0),
    ]
}

/// Hollows of the throat: between the collar bones, above them, and the larynx.
fn throat() -> [Swelling; THROAT_COUNT] {
    [
        swelling(vec3(0.0000, -0.1990, 0.0200), vec3(0.0290, 0.0280, 0.0340), -0.0022, 0.0),
        swelling(vec3(0.0550, -0.1870, -0.0080), vec3(0.0460, 0.0280, 0.0380), -0.0008, 0.0),
        swelling(vec3(0.0000, -0.1480, 0.0260), vec3(0.0130, 0.0210, 0.0200), 0.0010, 0.0),
    ]
}

fn details() -> [Swelling; DETAIL_COUNT] {
    [
        // Eyes: inner corner, bag.
        swelling(vec3(0.0150, -0.0150, 0.0880), vec3(0.0100, 0.0110, 0.0200), -0.0020, 0.0),
        swelling(vec3(0.0280, -0.0290, 0.0840), vec3(0.0180, 0.0060, 0.0200), -0.0010, 8.0),
        // Nose: side walls, wing groove, nostril, septum, tip, ridge.
        swelling(vec3(0.0120, -0.0281, 0.0979), vec3(0.0140, 0.0220, 0.0220), 0.0004, 0.0),
        swelling(vec3(0.0195, -0.0500, 0.0900), vec3(0.0060, 0.0100, 0.0140), -0.0006, 0.0),
        swelling(NOSTRIL, vec3(0.0044, 0.0060, 0.0072), -0.0040, 0.0),
        swelling(vec3(0.0000, -0.0570, 0.1060), vec3(0.0080, 0.0070, 0.0120), 0.0010, 0.0),
        swelling(vec3(0.0000, -0.0460, 0.1140), vec3(0.0120, 0.0120, 0.0120), 0.0013, 0.0),
        swelling(vec3(0.0000, -0.0199, 0.1000), vec3(0.0120, 0.0240, 0.0200), 0.0008, 0.0),
        // Mouth: upper and lower lip, bow, lip line, corners, philtrum.
        swelling(vec3(0.0086, -0.0724, 0.0990), vec3(0.0185, 0.0070, 0.0200), 0.0018, -6.0),
        swelling(vec3(0.0000, -0.0836, 0.0958), vec3(0.0245, 0.0082, 0.0200), 0.0050, 7.6),
        swelling(vec3(0.0000, -0.0720, 0.1020), vec3(0.0060, 0.0050, 0.0120), 0.0006, 0.0),
        swelling(vec3(0.0000, -0.0775, 0.0989), vec3(0.0272, 0.0030, 0.0220), -0.0018, -2.5),
        swelling(vec3(0.0245, -0.0786, 0.0880), vec3(0.0100, 0.0080, 0.0160), -0.0008, 0.0),
        swelling(vec3(0.0000, -0.0640, 0.1020), vec3(0.0060, 0.0090, 0.0120), 0.0002, 0.0),
    ]
}
