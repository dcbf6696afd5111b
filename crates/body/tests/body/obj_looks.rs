//! Materials of .mtl files beside an OBJ, and colours of vertices of OBJ and PLY files.

use std::path::Path;

use glam::{Vec2, Vec3, Vec4};
use strandline_body::{Materials, Mesh, Wrap};

/// A square, a pentagon and a triangle of materials in turn, whose texture coordinates are x and y of the vertices.
const SHAPE: &str = "o one\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl skin\nf 1/1 2/2 3/3 4/4\n\
                     v 2 0 0\nv 3 0 0\nv 3 1 0\nv 2.5 2 0\nv 2 1 0\nvt 2 0\nvt 3 0\nvt 3 1\nvt 2.5 2\nvt 2 1\nusemtl eye\n\
                     f -5/-5 -4/-4 -3/-3 -2/-2 -1/-1\nusemtl skin\ng two\nf 3/3 2/2 5/5\nusemtl unknown\nf 1 2 3\n";

/// Writes a body beside its materials and a picture of two texels, red over blue; returns what is read.
fn read(folder: &Path, obj: &str, mtl: &str) -> (Mesh, Vec<String>) {
    let mut picture = image::RgbaImage::new(1, 2);
    picture.put_pixel(0, 0, image::Rgba([255, 0, 0, 255]));
    picture.put_pixel(0, 1, image::Rgba([0, 0, 255, 255]));
    std::fs::create_dir_all(folder.join("maps")).unwrap();
    picture.save(folder.join("maps/two texels.png")).unwrap();
    std::fs::write(folder.join("body.mtl"), mtl).unwrap();
    std::fs::write(folder.join("body.obj"), obj).unwrap();
    Mesh::load_noted(&folder.join("body.obj"), 1.0).unwrap()
}

fn with_library(mtl: &str) -> (Mesh, Vec<String>) {
    read(tempfile::tempdir().unwrap().path(), &format!("mtllib body.mtl\n{SHAPE}"), mtl)
}

fn materials(mesh: &Mesh) -> &Materials {
    let materials = mesh.materials.as_deref().expect("materials");
    assert!(materials.fit(mesh.positions.len(), mesh.triangles.len()));
    materials
}

#[test]
fn triangles_have_the_materials_and_the_texture_coordinates_of_their_faces() {
    let (mesh, notes) = with_library(
        "newmtl eye\nKd 0.1 0.2 0.3\nNs 250\nnewmtl skin\nmap_Kd maps/two texels.png\nKd 0 0 0\n",
    );
    assert!(notes.is_empty(), "{notes:?}");
    let materials = materials(&mesh);
    let name = |triangle: usize| materials.list[materials.of_triangles[triangle] as usize].name.as_deref();
    let (skin, eye) = (Some("skin"), Some("eye"));
    let names: Vec<_> = (0..mesh.triangles.len()).map(name).collect();
    assert_eq!(names, [skin, skin, eye, eye, eye, skin, None]);
    for (triangle, corners) in mesh.triangles.iter().enumerate().take(6) {
        for (corner, vertex) in corners.iter().enumerate() {
            let place = mesh.positions[*vertex as usize];
            let wanted = Vec2::new(place.x, 1.0 - place.y);
            assert_eq!(materials.coordinates[triangle][corner], wanted, "triangle {triangle}");
        }
    }
    let eye = &materials.list[materials.of_triangles[2] as usize];
    assert_eq!((eye.color, eye.texture), (Some(Vec4::new(0.1, 0.2, 0.3, 1.0)), None));
    assert_eq!(eye.roughness, Some(0.5));
    // A picture takes the place of the colour.
    let skin = &materials.list[materials.of_triangles[0] as usize];
    assert_eq!((skin.color, skin.roughness), (Some(Vec4::ONE), None));
    assert_eq!(materials.textures[skin.texture.unwrap()].texels, [[255, 0, 0, 255], [0, 0, 255, 255]]);
}

#[test]
fn options_masks_and_paths_of_other_machines_are_read() {
    let mtl = "newmtl skin\nmap_Kd -s 2 3 1 -o 0.5 0.25 -clamp on C:\\artist\\maps\\two texels.png\nmap_d maps/two texels.png\n\
               Pr 0.7\nPm 1\nnewmtl eye\nTr 0.75\nKd 1 1 1\n";
    let folder = tempfile::tempdir().unwrap();
    let obj = format!("mtllib body.mtl\n{SHAPE}");
    read(folder.path(), &obj, mtl);
    std::fs::copy(folder.path().join("maps/two texels.png"), folder.path().join("two texels.png")).unwrap();
    let (mesh, notes) = read(folder.path(), &obj, mtl);
    let materials = materials(&mesh);
    let skin = &materials.list[materials.of_triangles[0] as usize];
    assert!(skin.texture.is_some() && skin.wraps == [Wrap::Clamp; 2], "{notes:?}");
    assert_eq!((skin.roughness, skin.metallic), (Some(0.7), 1.0));
    assert_eq!(materials.coordinates[0][2], Vec2::new(2.5, 1.0 - 3.25));
    let eye = &materials.list[materials.of_triangles[2] as usize];
    assert_eq!((eye.color, eye.cutoff), (Some(Vec4::new(1.0, 1.0, 1.0, 0.25)), Some(0.5)));
    // The mask is the picture under another name.
    assert!(notes.len() == 1 && notes[0].contains("the mask `maps/two texels.png` of `skin`"), "{notes:?}");
    assert_eq!(skin.cutoff, None);
}

#[test]
fn materials_share_a_picture_and_a_mask_that_is_the_picture_cuts() {
    let picture = "map_Kd maps/two texels.png\n";
    let (mesh, notes) =
        with_library(&format!("newmtl skin\n{picture}map_d maps/two texels.png\nnewmtl eye\n{picture}"));
    let materials = materials(&mesh);
    assert!(notes.is_empty() && materials.textures.len() == 1, "{notes:?}");
    let of = |triangle: usize| &materials.list[materials.of_triangles[triangle] as usize];
    assert_eq!([of(0).texture, of(2).texture], [Some(0); 2]);
    assert_eq!([of(0).cutoff, of(2).cutoff], [Some(0.5), None]);
    let none = "map_Kd none.png\n";
    let (_, notes) = with_library(&format!("newmtl skin\n{none}newmtl eye\n{none}"));
    assert_eq!(notes.len(), 1, "a picture is missed once: {notes:?}");
}

#[test]
fn looks_that_are_missing_or_lie_elsewhere_become_notes_and_the_shape_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let below = folder.path().join("below");
    std::fs::create_dir(&below).unwrap();
    std::fs::write(folder.path().join("secret.mtl"), "newmtl skin\nKd 1 0 0\n").unwrap();
    for (library, words) in
        [("../secret.mtl", "no file"), ("none.mtl", "no file"), ("/etc/passwd", "no file")]
    {
        let (mesh, notes) = read(&below, &format!("mtllib {library}\n{SHAPE}"), "");
        assert!(mesh.materials.is_none() && mesh.triangles.len() == 7, "{library}");
        assert!(notes.len() == 1 && notes[0].contains(words) && notes[0].contains(library), "{notes:?}");
    }
    let (mesh, notes) = read(&below, &format!("mtllib body.mtl\n{SHAPE}"), "newmtl skin\nKd 1 red\n");
    assert!(mesh.materials.is_none() && notes[0].contains("invalid line"), "{notes:?}");
    let mtl = "newmtl skin\nKd 0.5 0.5 0.5\nmap_Kd none.png\n";
    let (mesh, notes) = read(&below, &format!("mtllib body.mtl\n{SHAPE}"), mtl);
    assert!(notes[0].contains("none.png"), "{notes:?}");
    assert_eq!(materials(&mesh).list[0].color, Some(Vec4::new(0.5, 0.5, 0.5, 1.0)));
    // Several libraries of a line.
    std::fs::write(below.join("more.mtl"), "newmtl eye\nKd 0 1 0\n").unwrap();
    let (mesh, notes) =
        read(&below, &format!("mtllib body.mtl more.mtl\n{SHAPE}"), "newmtl skin\nKd 1 0 0\n");
    assert!(notes.is_empty() && materials(&mesh).list.len() == 3, "{notes:?}");
    // A file without materials says nothing.
    assert!(read(&below, SHAPE, "").1.is_empty());
}

#[test]
fn vertices_have_the_linear_light_of_their_colours() {
    let folder = tempfile::tempdir().unwrap();
    // The fourth vertex comes first in the faces.
    let obj = "v 0 0 0 1 1 1\nv 1 0 0 0.5 0 0\nv 1 1 0 0 1 0\nv 0 1 0 0 0 1\nf 4 1 2\nf 4 2 3\n";
    let (mesh, notes) = read(folder.path(), obj, "");
    assert!(notes.is_empty(), "{notes:?}");
    let of = |mesh: &Mesh, place: Vec3| {
        let vertex = mesh.positions.iter().position(|own| *own == place).unwrap();
        materials(mesh).colors[vertex]
    };
    assert_eq!(of(&mesh, Vec3::new(0.0, 1.0, 0.0)), Vec4::new(0.0, 0.0, 1.0, 1.0));
    // ((0.5 + 0.055) / 1.055)^2.4 [IEC 61966-2-1].
    assert!((of(&mesh, Vec3::X).x - 0.214_041).abs() < 1e-5);
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n\
               property uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
               0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 188\n3 0 1 2\n";
    let path = folder.path().join("scan.ply");
    std::fs::write(&path, ply).unwrap();
    let scan = Mesh::load(&path, 1.0).unwrap();
    assert_eq!(of(&scan, Vec3::ZERO), Vec4::new(1.0, 0.0, 0.0, 1.0));
    assert!((of(&scan, Vec3::Y).z - 0.502_886).abs() < 1e-5);
    // A vertex without a colour: none is drawn.
    let (mesh, _) = read(folder.path(), "v 0 0 0 1 1 1\nv 1 0 0\nv 0 1 0 1 1 1\nf 1 2 3\n", "");
    assert!(mesh.materials.is_none());
}
