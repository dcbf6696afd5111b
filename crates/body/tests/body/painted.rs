//! Materials of glTF files.

use std::io::Cursor;

use glam::Vec2;
use strandline_body::{Mesh, Wrap};

use crate::files::scratch;
use crate::painted_file::{BOARD, painted};

/// The mesh of a file, and the notes about it.
fn load(bytes: &[u8]) -> (Mesh, Vec<String>) {
    let (_folder, path) = scratch("painted.glb", bytes);
    Mesh::load_noted(&path, 1.0).unwrap()
}

/// The file with a text in its document changed for one of the same length.
fn changed(from: &str, to: &str) -> Vec<u8> {
    assert_eq!(from.len(), to.len());
    let mut bytes = painted();
    let place = bytes.windows(from.len()).position(|window| window == from.as_bytes());
    let place = place.unwrap_or_else(|| panic!("{from} is not in the file"));
    bytes[place..place + to.len()].copy_from_slice(to.as_bytes());
    bytes
}

#[test]
fn colours_textures_and_cut_outs_of_each_part_are_read() {
    let (mesh, notes) = load(&painted());
    let materials = mesh.materials.as_deref().unwrap();
    assert!(materials.fit(mesh.positions.len(), mesh.triangles.len()));
    let names: Vec<_> = materials.list.iter().map(|material| material.name.as_deref()).collect();
    assert_eq!(names, [Some("skin"), Some("eye"), Some("board"), Some("half"), Some("glass"), None]);
    let of_last = |part: usize| {
        let before = [1728, 1728, 2, 2, 2, 2][..=part].iter().sum::<usize>();
        let material = materials.of_triangles[before - 1] as usize;
        (&materials.list[material], materials.coordinates[before - 1])
    };
    assert_eq!(mesh.triangles.len(), 3464);
    let texture = |part: usize| of_last(part).0.texture.map(|texture| &materials.textures[texture]);
    // KHR_texture_transform scales, and nobody says how rough it is: wholly, as glTF has it, and no metal.
    let (skin, [_, below, _]) = of_last(0);
    assert_eq!((below, skin.roughness, skin.metallic), (Vec2::new(8.0 * 35.0 / 36.0, 4.0), Some(1.0), 0.0));
    assert_eq!(skin.wraps, [Wrap::Repeat; 2]);
    let checker = texture(0).unwrap();
    assert_eq!((checker.width, checker.height), (32, 32));
    // A .jpeg is exact but for a few steps.
    assert!(checker.texels[0].iter().zip([224, 172, 140, 255]).all(|(one, other)| one.abs_diff(other) < 6));
    let (eye, _) = of_last(1);
    assert_eq!((eye.roughness, eye.wraps), (Some(0.1), [Wrap::Clamp; 2]));
    assert_eq!(texture(1).unwrap().texels[32 * 128 + 64], [8, 6, 6, 255]);
    let (board, coordinates) = of_last(2);
    assert_eq!(coordinates, [Vec2::X, Vec2::Y, Vec2::ONE], "shares of 65535 of the second set");
    assert_eq!(board.color.unwrap().x, 0.5);
    let expected = BOARD.map(|[red, green, blue]| [red, green, blue, 255]);
    assert_eq!(texture(2).unwrap().texels, expected);
    assert_eq!((of_last(3).0.cutoff, of_last(2).0.cutoff), (Some(0.4), None));
    assert_eq!(texture(3).unwrap().texels[7..9].iter().map(|texel| texel[3]).collect::<Vec<_>>(), [0, 255]);
    assert_eq!((of_last(4).0.cutoff, of_last(4).0.color.unwrap().w), (Some(0.5), 0.2));
    assert_eq!(materials.colors.last().unwrap().to_array(), [0.4, 0.6, 0.8, 0.0]);
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(notes[0].contains("half transparent") && notes[0].ends_with("`glass`"), "{notes:?}");
}

#[test]
fn a_look_that_is_wrong_is_noted_and_the_shape_is_read() {
    let shape = load(&painted()).0;
    for (from, to, said) in [
        (r#""sampler": 0}, "#, r#""sampler": 9}, "#, None),
        (r#"{"source": 0}"#, r#"{"source": 9}"#, Some("the picture 9 is not read: the file has no image")),
        (r#"{"source": 0}"#, r#"{"sourve": 0}"#, Some("a texture of no picture is not read")),
        ("data:image/png;base64,i", "data:image/png;base64,!", Some("`iris` is not read: data that are not")),
        (
            "data:image/png;base64,iVBOR",
            "data:image/png;base64,iVBOx",
            Some("`iris` is not read: no picture"),
        ),
        (r#""uri": "data"#, r#""uri": "../x"#, Some("`iris` is not read: no file beside the body")),
        (r#""baseColorTexture": {"index": 2"#, r#""baseColorTexture": {"index": 7"#, None),
        (r#""texCoord": 1"#, r#""texCoord": 5"#, None),
        (r#""scale": [8, 4]"#, r#""scale": [8e9 ]"#, None),
        (r#""baseColorFactor": [1, 1, 1, 0.2]"#, r#""baseColorFactor": {"a":1, "b":2}"#, None),
        (r#""alphaCutoff": 0.4"#, r#""alphaCutoff": "a""#, None),
    ] {
        let bytes = changed(from, to);
        let (mesh, notes) = load(&bytes);
        assert_eq!(mesh.positions, shape.positions, "{to}");
        assert!(said.is_none_or(|said| notes.iter().any(|note| note.contains(said))), "{to}: {notes:?}");
    }
}

#[test]
fn a_large_picture_is_scaled_down_and_said_so() {
    let mut png = Vec::new();
    let picture = image::RgbImage::from_pixel(4100, 4, image::Rgb([200, 100, 50]));
    picture.write_to(&mut Cursor::new(&mut png), image::ImageFormat::Png).unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("wide.png"), png).unwrap();
    let from = r#"{"bufferView": 19, "mimeType": ""}"#;
    let bytes = changed(from, &format!("{:<1$}}}", r#"{"uri": "wide.png""#, from.len() - 1));
    let path = folder.path().join("painted.glb");
    std::fs::write(&path, bytes).unwrap();
    let (mesh, notes) = Mesh::load_noted(&path, 1.0).unwrap();
    let textures = &mesh.materials.unwrap().textures;
    let wide = textures.iter().find(|texture| texture.width == 1025).unwrap();
    assert_eq!((wide.height, wide.texels[0]), (1, [200, 100, 50, 255]));
    assert!(
        notes.iter().any(|note| note.contains("`wide.png` of 4100 x 4 texels is scaled down to 1025 x 1"))
    );
}
