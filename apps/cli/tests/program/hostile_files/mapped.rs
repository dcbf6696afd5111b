//! A scene with a map over the scalp.

use std::path::Path;

/// A scene whose groom takes its colours from a picture.
pub fn write_mapped(folder: &Path, name: &str) {
    let mut groom = strandline::Groom::empty(8e-5);
    for x in 0..8 {
        groom.push((0..4).map(|point| glam::Vec3::new(0.01 * x as f32, -0.02 * point as f32, 0.1)));
    }
    groom.root_uvs = Some(vec![glam::Vec2::splat(0.5); 8]);
    strandline::format::save(&groom, &folder.join("mapped.npz")).unwrap();
    let scene = format!(
        "film = {{ frames = 1, settle = 0.0 }}\npicture = {{ width = 16, height = 16 }}\nlook.color_map = \"{name}\"\n\
         groom.file = \"mapped.npz\"\n[devices]\nsimulation = \"cpu\"\npictures = \"cpu\"\n"
    );
    std::fs::write(folder.join("mapped.toml"), scene).unwrap();
}
