//! The thesis's scene has the thesis's numbers [Chen2011 §6].

use strandline::Scene;
use strandline_groom::Guides;
use strandline_render::Light;
use strandline_sim::Settings;
use strandline_sim::constrain::Angles;

#[test]
fn the_scene_has_as_many_points_segments_and_lights_as_printed() {
    let scene = Scene::thesis();
    let groom = scene.style.grow().unwrap();
    let guides = Guides::resample(&groom, scene.groom.points_per_strand as usize).unwrap();
    let points = guides.strand_count() * guides.points_per_strand();
    assert_eq!((guides.strand_count(), points), (1_750, 10_500));
    // At any distance of the camera.
    for distance in [0.2, 1.0, 3.0, 30.0] {
        let level = scene.level_of_detail.level(distance, scene.look.follow_strands);
        let segments = level.segment_count(guides.points_per_strand());
        assert_eq!((level.strand_count(), segments), (16, 20));
        assert_eq!(guides.strand_count() * level.strand_count() * segments, 560_000);
    }
    // Without lights in the file: the three usual ones.
    assert!(scene.lights.is_empty());
    let lights = Light::three_point(glam::Vec3::ZERO);
    assert_eq!((lights.len(), lights.iter().filter(|light| light.shadow).count()), (3, 2));
    assert_eq!((scene.picture.width, scene.picture.height, scene.picture.supersampling), (800, 600, 2));
}

#[test]
fn the_simulation_is_the_one_printed() {
    let settings = Settings::thesis();
    assert_eq!(Scene::thesis().simulation, settings);
    assert_eq!((settings.strands.constrain.iterations, settings.volume.cells), (20, [32; 3]));
    assert_eq!((settings.volume.enabled, settings.volume.tolerance), (true, 1e-5));
    let springs = [
        settings.strands.constrain.springs.stretch,
        settings.strands.constrain.springs.bend,
        settings.strands.constrain.springs.torsion,
    ];
    assert!(springs.iter().all(|spring| spring.enabled && spring.stiffness > 0.0));
    // Features that the thesis does not have.
    assert!(
        settings.strands.constrain.angles == Angles::OFF && !settings.strands.constrain.length_pass.enabled
    );
}
