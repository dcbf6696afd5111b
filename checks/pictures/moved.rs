//! Detail of hair that root frames move while the head stays.

use glam::{Quat, Vec3};
use strandline_body::{BodyFrame, Pose};
use strandline_groom::{Guides, LANES, Vec3Lanes};
use strandline_render::{BodyLook, Camera, FrameInput, LevelOfDetail, Look, PictureSettings, Renderer};

use crate::grooms::arcs;

/// Strands and segments of a picture of hair that a pose moves with the body of a frame.
fn drawn(guides: &Guides, moved: Pose, body: BodyFrame) -> [usize; 2] {
    let mut positions: Vec<Vec3Lanes> = guides.positions().to_vec();
    for points in &mut positions {
        (0..LANES).for_each(|lane| points.set(lane, moved.point(points.get(lane))));
    }
    let input = FrameInput {
        positions: &positions,
        body: &body,
        camera: &Camera::front(),
        look: &Look::brown(),
        body_look: &BodyLook::default(),
        lights: &[],
        level_of_detail: &LevelOfDetail { full_distance: 1.0, by_pixel: false, ..LevelOfDetail::default() },
    };
    let (_, report) =
        Renderer::new(guides, None, &PictureSettings::sized(32, 32)).unwrap().draw(&input).unwrap();
    [report.strands, report.segments]
}

#[test]
fn root_frames_move_hair_away_from_the_camera_as_the_head_does() {
    let guides = Guides::resample(&arcs(9), 6).unwrap();
    let away = Pose { rotation: Quat::from_rotation_y(0.4), translation: Vec3::new(0.5, 0.0, -6.0) };
    let near = drawn(&guides, Pose::IDENTITY, BodyFrame::REST);
    let head = drawn(&guides, away, away.into());
    let roots = drawn(&guides, away, BodyFrame::REST.with_roots([away; 9]));
    assert_eq!(roots, head);
    assert!(2 * head[1] < near[1], "{head:?} {near:?}");
}
