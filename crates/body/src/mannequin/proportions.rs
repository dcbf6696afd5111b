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
            cranium: Ellipsoid { center: vec3(0.0000, 0.0101, -0.0060), radii: vec3(0.0808, 0.0996, 0.0944) },
            face: Ellipsoid { center: vec3(0.0000, -0.0528, 0.0416), radii: vec3(0.0667, 0.0742, 0.0502) },
            face_reach: 0.0194,
            jaw: RoundCone {
                start: vec3(0.0441, -0.0710, 0.0170),
                end: vec3(0.0060, -0.1035, 0.0668),
                start_radius: 0.0082,
                end_radius: 0.0173,
            },
            jaw_reach: 0.0249,
            chin: Ellipsoid { center: vec3(0.0000, -0.1077, 0.0697), radii: vec3(0.0230, 0.0178, 0.0187) },
            chin_reach: 0.0208,
            nose: RoundCone {
                start: vec3(0.0000, -0.0050, 0.0840),
                end: vec3(0.0000, -0.0438, 0.1034),
                start_radius: 0.0060,
                end_radius: 0.0114,
            },
            nose_reach: 0.0141,
            nostril: Ellipsoid { center: vec3(0.0132, -0.0480, 0.0928), radii: vec3(0.0034, 0.0053, 0.0097) },
            nostril_reach: 0.0068,
            eyeball: Ellipsoid { center: vec3(0.0305, -0.0165, 0.0705), radii: vec3(0.0155, 0.0122, 0.0125) },
            eyeball_reach: 0.0070,
            lids: [
                swelling(vec3(0.0305, -0.0230, 0.0820), vec3(0.0175, 0.0024, 0.0130), -0.0013, 13.0),
                swelling(vec3(0.0310, -0.0085, 0.0820), vec3(0.0180, 0.0030, 0.0140), -0.0009, -12.0),
            ],
            neck: RoundCone {
                start: vec3(0.0000, -0.0434, 0.0000),
                end: vec3(0.0000, -0.2085, -0.0371),
                start_radius: 0.0560,
                end_radius: 0.0387,
            },
            neck_reach: 0.0284,
            trapezius: RoundCone {
                start: vec3(0.0271, -0.1729, -0.0521),
                end: vec3(0.1015, -0.2260, -0.0809),
                start_radius: 0.0164,
                end_radius: 0.0215,
            },
            trapezius_reach: 0.0560,
            shoulder: RoundCone {
                start: vec3(0.0411, -0.2399, -0.0547),
                end: vec3(0.1462, -0.2509, -0.0386),
                start_radius: 0.0536,
                end_radius: 0.0537,
            },
            shoulder_reach: 0.0407,
            chest: Ellipsoid { center: vec3(0.0000, -0.2937, -0.0210), radii: vec3(0.1487, 0.0956, 0.0803) },
            chest_reach: 0.0727,
            muscle: RoundCone {
                start: vec3(0.0466, -0.0535, -0.0078),
                end: vec3(0.0080, -0.1900, -0.0020),
                start_radius: 0.0056,
                end_radius: 0.0030,
            },
            muscle_reach: 0.0209,
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
            arc(-0.0050, 0.0130, 0.0015, 0.0080, 180.0, 265.0, 0.0025),
            arc(0.0010, 0.0130, 0.0030, 0.0140, 0.0, 180.0, 0.0029),
            arc(-0.0250, 0.0130, 0.0030, 0.0400, -48.0, 0.0, 0.0029),
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
        swelling(vec3(0.0290, 0.0060, 0.0854), vec3(0.0360, 0.0188, 0.0303), 0.0080, 0.0),
        swelling(vec3(0.0000, 0.0061, 0.0922), vec3(0.0299, 0.0203, 0.0300), 0.0033, 0.0),
        swelling(vec3(0.0000, 0.0252, 0.0820), vec3(0.0908, 0.0537, 0.0582), 0.0117, 0.0),
        swelling(vec3(0.0330, 0.0522, 0.0678), vec3(0.0416, 0.0403, 0.0390), 0.0032, 0.0),
        swelling(vec3(0.0000, 0.1001, -0.0172), vec3(0.0781, 0.0502, 0.0803), -0.0055, 0.0),
        swelling(vec3(0.0000, -0.0052, -0.0958), vec3(0.0690, 0.0627, 0.0596), -0.0039, 0.0),
        swelling(vec3(0.0673, 0.0158, 0.0048), vec3(0.0495, 0.0650, 0.0746), -0.0055, 0.0),
        swelling(vec3(0.0546, -0.0029, 0.0688), vec3(0.0319, 0.0347, 0.0383), 0.0058, 0.0),
        swelling(vec3(0.0216, -0.0585, -0.0745), vec3(0.0432, 0.0401, 0.0441), -0.0067, 0.0),
        swelling(vec3(0.0523, 0.0632, 0.0120), vec3(0.0492, 0.0504, 0.0619), 0.0011, 0.0),
        // Eyes: socket, inner corner, bag below, brow.
        swelling(vec3(0.0300, -0.0150, 0.0860), vec3(0.0270, 0.0180, 0.0300), -0.0072, 0.0),
        swelling(vec3(0.0150, -0.0150, 0.0880), vec3(0.0100, 0.0110, 0.0200), -0.0040, 0.0),
        swelling(vec3(0.0280, -0.0290, 0.0840), vec3(0.0180, 0.0060, 0.0200), -0.0010, 8.0),
        swelling(vec3(0.0362, 0.0040, 0.0879), vec3(0.0260, 0.0090, 0.0300), 0.0015, -6.0),
        // Cheeks.
        swelling(vec3(0.0541, -0.0352, 0.0686), vec3(0.0312, 0.0234, 0.0335), 0.0043, 0.0),
        swelling(vec3(0.0630, -0.0290, 0.0437), vec3(0.0255, 0.0214, 0.0412), 0.0027, 0.0),
        swelling(vec3(0.0340, -0.0500, 0.0880), vec3(0.0300, 0.0300, 0.0300), 0.0002, 0.0),
        swelling(vec3(0.0459, -0.0699, 0.0641), vec3(0.0300, 0.0300, 0.0340), -0.0003, 0.0),
        swelling(vec3(0.0574, -0.0701, 0.0344), vec3(0.0306, 0.0310, 0.0428), -0.0029, 0.0),
        // Nose: side walls, wing groove, nostril, septum, tip.
        swelling(vec3(0.0120, -0.0281, 0.0980), vec3(0.0140, 0.0220, 0.0220), 0.0006, 0.0),
        swelling(vec3(0.0195, -0.0500, 0.0900), vec3(0.0060, 0.0100, 0.0140), -0.0010, 0.0),
        swelling(vec3(0.0065, -0.0585, 0.1020), vec3(0.0050, 0.0050, 0.0075), -0.0035, 0.0),
        swelling(vec3(0.0000, -0.0570, 0.1060), vec3(0.0080, 0.0070, 0.0120), 0.0005, 0.0),
        swelling(vec3(0.0000, -0.0460, 0.1140), vec3(0.0120, 0.0120, 0.0120), 0.0010, 0.0),
        swelling(vec3(0.0000, -0.0200, 0.1000), vec3(0.0120, 0.0240, 0.0200), 0.0008, 0.0),
        // Mouth: its mound, upper and lower lip, bow, lip line, corners, philtrum, crease above the chin.
        swelling(vec3(0.0000, -0.0746, 0.0931), vec3(0.0428, 0.0306, 0.0425), 0.0123, 0.0),
        swelling(vec3(0.0085, -0.0720, 0.0991), vec3(0.0185, 0.0068, 0.0200), 0.0033, -8.0),
        swelling(vec3(0.0000, -0.0841, 0.0959), vec3(0.0245, 0.0080, 0.0200), 0.0034, 7.8),
        swelling(vec3(0.0000, -0.0720, 0.1020), vec3(0.0060, 0.0050, 0.0120), 0.0007, 0.0),
        swelling(vec3(0.0000, -0.0775, 0.0989), vec3(0.0272, 0.0028, 0.0220), -0.0033, -3.7),
        swelling(vec3(0.0245, -0.0785, 0.0880), vec3(0.0100, 0.0080, 0.0160), -0.0007, 0.0),
        swelling(vec3(0.0000, -0.0640, 0.1020), vec3(0.0060, 0.0090, 0.0120), -0.0003, 0.0),
        swelling(vec3(0.0000, -0.0951, 0.0920), vec3(0.0240, 0.0090, 0.0240), -0.0021, 5.9),
        swelling(vec3(0.0300, -0.0660, 0.0880), vec3(0.0160, 0.0220, 0.0240), 0.0003, 0.0),
        // Chin and jaw.
        swelling(vec3(0.0000, -0.1080, 0.0880), vec3(0.0200, 0.0180, 0.0240), 0.0014, 0.0),
        swelling(vec3(0.0242, -0.1066, 0.0744), vec3(0.0223, 0.0195, 0.0302), -0.0025, 0.0),
        swelling(vec3(0.0505, -0.0886, 0.0146), vec3(0.0259, 0.0265, 0.0320), 0.0029, 0.0),
        swelling(vec3(0.0000, -0.1249, 0.0505), vec3(0.0498, 0.0258, 0.0396), -0.0039, 0.0),
        swelling(vec3(0.0664, -0.0536, 0.0101), vec3(0.0262, 0.0319, 0.0320), 0.0055, 0.0),
        swelling(vec3(0.0000, 0.0695, 0.0561), vec3(0.0933, 0.0468, 0.0634), 0.0082, 0.0),
    ]
}
