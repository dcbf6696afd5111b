use glam::Vec4;

use crate::body::{Material, Materials};
use crate::render::fibre::chiang::Chiang;

use super::*;

/// Four strands of three points, two of each of the groups 3 and 5, with roots at the corners of the scalp.
fn groom() -> Groom {
    let mut groom = Groom::empty(1e-4);
    for strand in 0..4 {
        let root = Vec3::X * strand as f32;
        groom.push([root, root + Vec3::Y, root + Vec3::Y * 2.0]);
    }
    groom.groups = Some(vec![3, 3, 5, 5]);
    groom.group_names.insert(3, "hair".to_owned());
    groom.root_uvs = Some(vec![Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE]);
    groom
}

fn group(name: &str) -> GroupLook {
    GroupLook { name: name.to_owned(), ..GroupLook::default() }
}

#[test]
fn groups_have_colours_and_widths_of_their_own() {
    let (mut scene, mut groom) = (Scene::default(), groom());
    scene.look.variation = 0.0;
    scene.look.group = vec![
        GroupLook { root_color: Some(Vec3::X), tip_color: Some(Vec3::Y), ..group("5") },
        GroupLook { width_scale: 2.0, ..group("hair") },
    ];
    dress(&scene, &Sources::default(), &mut groom).unwrap();
    let colors = groom.colors.as_ref().unwrap();
    let melanin = scene.look.fibre.chiang;
    assert_eq!([colors[0], colors[2]], melanin.reflectances(1.0).map(|color| color.to_array()), "the look's");
    for (own, of_color) in
        melanin.absorption(Vec3::ONE).iter().zip(melanin.absorption_of_color(colors[0].into()))
    {
        // Rounding of the reflectance in single precision.
        assert!((of_color / own - 1.0).abs() < 1e-5, "{of_color} for {own}");
    }
    assert_eq!(colors[6..9], [[0.99, 0.0, 0.0], [0.495, 0.495, 0.0], [0.0, 0.99, 0.0]]);
    assert_eq!(groom.widths, Widths::PerStrand(vec![2e-4, 2e-4, 1e-4, 1e-4]));
}

#[test]
fn strands_have_the_colours_of_the_body_at_their_roots() {
    let (mut look, groom) = (Look::brown(), groom());
    look.variation = 0.0;
    // A strip below the roots at x = 0 to 2: a red half, then one without a colour.
    let corner = |at: usize| Vec3::new((at / 2) as f32 * 1.5 - 0.5, -0.1, (at % 2) as f32 - 0.5);
    let triangles = vec![[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]];
    let mut mesh = Mesh::new((0..6).map(corner).collect(), triangles).unwrap();
    assert_eq!(of_body(&look, &groom, Some(&mesh)), None);
    let red = Material { color: Some(Vec4::new(0.8, 0.1, 0.05, 1.0)), ..Material::default() };
    let materials = Materials {
        list: vec![red, Material::default()],
        of_triangles: vec![0, 0, 1, 1],
        coordinates: vec![[Vec2::ZERO; 3]; 4],
        ..Materials::default()
    };
    mesh.materials = Some(materials.into());
    let colors = of_body(&look, &groom, Some(&mesh)).unwrap();
    assert!(colors[..3].iter().all(|color| *color == [0.8, 0.1, 0.05]), "{colors:?}");
    assert_eq!(colors[6..9], colors_along(&look, &groom.starts)[6..9], "the look's");
}

#[test]
fn groups_have_pigments_of_their_own() {
    let (mut scene, mut groom) = (Scene::default(), groom());
    scene.look.variation = 0.0;
    scene.look.group = vec![
        GroupLook { eumelanin: Some(8.0), tip_pigment: Some(0.5), ..group("5") },
        GroupLook { grey: Some(1.0), ..group("hair") },
    ];
    dress(&scene, &Sources::default(), &mut groom).unwrap();
    let colors = groom.colors.as_ref().unwrap();
    let black = Chiang { eumelanin: 8.0, tip_pigment: 0.5, ..scene.look.fibre.chiang };
    assert_eq!([colors[6], colors[8]], black.reflectances(1.0).map(|color| color.to_array()));
    let white = scene.look.fibre.chiang.reflectances(WHITE).map(|color| color.to_array());
    assert_eq!([colors[0], colors[2]], white);
    // A colour wins.
    scene.look.group[0].root_color = Some(Vec3::X);
    dress(&scene, &Sources::default(), &mut groom).unwrap();
    assert_eq!(groom.colors.unwrap()[6], [0.99, 0.0, 0.0]);
}

#[test]
fn white_strands_stay_white_beside_a_group_with_a_colour() {
    let mut scene = Scene::default();
    let mut groom = Groom::empty(1e-4);
    (0..200).for_each(|strand| groom.push([Vec3::X * strand as f32, Vec3::Y]));
    groom.groups = Some((0..200).map(|strand| u32::from(strand == 0)).collect());
    (scene.look.grey, scene.look.variation) = (0.5, 0.0);
    scene.look.group = vec![GroupLook { root_color: Some(Vec3::X), ..group("1") }];
    dress(&scene, &Sources::default(), &mut groom).unwrap();
    let [root, _] = scene.look.fibre.chiang.reflectances(WHITE).map(|color| color.to_array());
    let white = groom.colors.unwrap().iter().step_by(2).filter(|color| **color == root).count();
    // Five standard deviations of 200 throws of a coin.
    assert!((65..136).contains(&white), "{white} of 200");
}

#[test]
fn a_group_that_is_not_there_is_refused_by_name() {
    let (mut scene, mut groom) = (Scene::default(), groom());
    scene.look.group = vec![group("hair"), group("beard")];
    let error = dress(&scene, &Sources::default(), &mut groom).unwrap_err().to_string();
    assert!(error.contains("look.group[1].name") && error.contains("`hair`, 5"), "{error}");
    groom.groups = None;
    assert!(
        dress(&scene, &Sources::default(), &mut groom).unwrap_err().to_string().contains("this one has none")
    );
}

#[test]
fn maps_are_read_over_the_scalp() {
    let folder = tempfile::tempdir().unwrap();
    let (colors, shares) = (folder.path().join("colors.png"), folder.path().join("shares.png"));
    // Red and green above, blue and white below.
    let pixels = vec![255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255];
    image::RgbImage::from_raw(2, 2, pixels).unwrap().save(&colors).unwrap();
    image::GrayImage::from_raw(2, 1, vec![51, 255]).unwrap().save(&shares).unwrap();
    let (mut scene, mut groom) = (Scene::default(), groom());
    (scene.look.color_map, scene.look.width_map) = (Some(colors.clone()), Some(shares));
    dress(&scene, &Sources::default(), &mut groom).unwrap();
    let at = |strand: usize| groom.colors.as_ref().unwrap()[3 * strand];
    assert_eq!([at(0), at(1), at(2), at(3)], [[0.0, 0.0, 1.0], [1.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(groom.widths, Widths::PerStrand(vec![2e-5, 1e-4, 2e-5, 1e-4]));
    let middle = Map::load(&colors).unwrap().color(Vec2::splat(0.5));
    assert!((middle - Vec3::splat(0.5)).abs().max_element() < 1e-6, "{middle}");
    groom.root_uvs = None;
    assert!(
        dress(&scene, &Sources::default(), &mut groom).unwrap_err().to_string().contains("root coordinates")
    );
    std::fs::write(&colors, b"GIF89a").unwrap();
    assert!(
        dress(&scene, &Sources::default(), &mut self::groom())
            .unwrap_err()
            .to_string()
            .contains("expected a .png")
    );
}
