//! Motion of what pixels show, as channels of a picture.

use glam::{Vec2, Vec3};
use strandline_body::{BodyFrame, Mesh, Pose};
use strandline_checks::{On, law};
use strandline_groom::{Groom, Guides, LANES, Vec3Lanes};
use strandline_render::gpu::GpuRenderer;
use strandline_render::{
    BodyLook, Camera, FrameInput, Layers, LevelOfDetail, Light, Look, PictureSettings, Renderer,
};

use crate::linear::channel;

const SIDE: u32 = 64;

/// Hair and a body as they lie in one picture.
struct Place {
    positions: Vec<Vec3Lanes>,
    head: BodyFrame,
    camera: Camera,
}

/// A wide strand half a metre before the eye.
fn strand() -> Guides {
    let mut groom = Groom::empty(0.05);
    groom.push((0..8).map(|point| Vec3::Y * (0.02 * point as f32 - 0.07)));
    Guides::resample(&groom, 8).unwrap()
}

/// The strand and the body carried by a distance \[m\].
fn place(moved: Vec3) -> Place {
    let mut positions = strand().positions().to_vec();
    for lanes in &mut positions {
        (0..LANES).for_each(|lane| lanes.set(lane, lanes.get(lane) + moved));
    }
    Place {
        positions,
        head: BodyFrame::REST.carried_by(&Pose { translation: moved, ..Pose::IDENTITY }),
        camera: Camera { position: Vec3::Z * 0.5, target: Vec3::ZERO, ..Camera::front() },
    }
}

/// Motion \[pixel\] in each of some pictures, drawn one after the other, with a square a metre before the eye.
fn motions(on: &On, places: &[Place]) -> Vec<Vec<Vec2>> {
    let corners = [[-0.2, -0.2], [0.2, -0.2], [0.2, 0.2], [-0.2, 0.2]];
    let corners = corners.map(|[x, y]| Vec3::new(x, y, -0.5)).to_vec();
    let body = Mesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    let settings = PictureSettings { layers: true, ..PictureSettings::sized(SIDE, SIDE) };
    let at_rest = strand();
    // Light moves nothing.
    let look = Look { follow_strands: 1, hair_count: 0, tip_width: 1.0, ..Look::thesis() };
    let mut on_cpu = Renderer::new(&at_rest, Some(&body), &settings).unwrap();
    let mut on_gpu = match on {
        On::Gpu(gpu) => Some(GpuRenderer::new(gpu, &at_rest, Some(&body), &settings).unwrap()),
        On::Cpu => None,
    };
    let of = |layers: &Layers| {
        let both = channel(layers, "motion.X").iter().zip(channel(layers, "motion.Y"));
        both.map(|(x, y)| Vec2::new(*x, *y)).collect()
    };
    let drawn = |place: &Place| {
        let input = FrameInput {
            positions: &place.positions,
            body: &place.head,
            camera: &place.camera,
            look: &look,
            body_look: &BodyLook::default(),
            lights: &[Light::default()],
            level_of_detail: &LevelOfDetail::default(),
        };
        let report = match &mut on_gpu {
            Some(on_gpu) => on_gpu.draw(&input).unwrap().1,
            None => on_cpu.draw(&input).unwrap().1,
        };
        of(&report.layers.unwrap())
    };
    places.iter().map(drawn).collect()
}

/// Pixels that show hair, skin and nothing.
const HAIR: usize = 32 * SIDE as usize + 33;
const SKIN: usize = 32 * SIDE as usize + 22;
const NOTHING: usize = 0;

law! {
    fn motion_is_displacement_since_the_picture_before(on) {
        let moved = Vec3::new(0.01, 0.02, 0.0);
        let camera = place(Vec3::ZERO).camera;
        let mut aside = place(Vec3::ZERO);
        (aside.camera.position, aside.camera.target) = (camera.position - moved, camera.target - moved);
        let found = motions(on, &[place(Vec3::ZERO), place(moved), place(moved), place(Vec3::ZERO), aside]);
        assert!(found[0].iter().all(|motion| *motion == Vec2::ZERO), "nothing was drawn before");
        // Pixels on a metre at a depth of a metre.
        let focal = 0.5 * SIDE as f32 * camera.focal();
        let expected = |depth: f32| Vec2::new(moved.x, -moved.y) * (focal / depth);
        // A camera that goes the other way shows the same.
        for picture in [&found[1], &found[4]] {
            for (at, depth) in [(HAIR, 0.5), (SKIN, 1.0)] {
                let (motion, expected) = (picture[at], expected(depth));
                assert!((motion - expected).length() < 0.01 * expected.length(), "{motion} {expected}");
            }
            assert_eq!(picture[NOTHING], Vec2::ZERO);
        }
        assert!(found[2].iter().all(|motion| motion.length() < 1e-3), "nothing has moved");
        assert!((found[3][HAIR] + expected(0.5)).length() < 0.01 * expected(0.5).length(), "and back");
    }
}
