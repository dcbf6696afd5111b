//! A small glTF body with materials, written as a file: a ball with a checker, an eye, two boards and a wall.

use std::io::Cursor;

use glam::{Vec2, Vec3};
use image::{DynamicImage, ImageFormat, RgbImage, Rgba, RgbaImage};

/// A part of the body: positions, texture coordinates and triangles.
struct Part {
    positions: Vec<Vec3>,
    places: Vec<Vec2>,
    triangles: Vec<[u16; 3]>,
}

/// A ball with texture coordinates by longitude and latitude.
fn ball(middle: Vec3, radius: f32) -> Part {
    let (rows, columns) = (24, 36);
    let at = |row: u16, column: u16| {
        let (down, around) = (f32::from(row) / f32::from(rows), f32::from(column) / f32::from(columns));
        let (sine, cosine) = (std::f32::consts::PI * down).sin_cos();
        let (side, front) = (std::f32::consts::TAU * around).sin_cos();
        (middle + radius * Vec3::new(-sine * side, cosine, -sine * front), Vec2::new(around, down))
    };
    let all = (0..=rows).flat_map(|row| (0..=columns).map(move |column| at(row, column)));
    let (positions, places) = all.unzip();
    let cell = |row: u16, column: u16| {
        let [first, below] = [row, row + 1].map(|row| row * (columns + 1) + column);
        [[first, below, first + 1], [first + 1, below, below + 1]]
    };
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| cell(row, column)));
    Part { positions, places, triangles: cells.flatten().collect() }
}

/// A square that faces +z; the picture's first row is at its top.
fn square(middle: Vec3, side: f32) -> Part {
    let places = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(Vec2::from);
    let corner = |place: &Vec2| middle + side * Vec3::new(place.x - 0.5, 0.5 - place.y, 0.0);
    Part {
        positions: places.iter().map(corner).collect(),
        places: places.to_vec(),
        triangles: vec![[0, 2, 1], [1, 2, 3]],
    }
}

/// Stored colours of the board's texture, row by row.
pub const BOARD: [[u8; 3]; 4] = [[230, 40, 40], [40, 200, 40], [40, 60, 220], [220, 210, 90]];
/// Factor of their red.
pub const RED: f32 = 0.5;

fn file_of(picture: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Vec::new();
    picture.into().write_to(&mut Cursor::new(&mut bytes), format).unwrap();
    bytes
}

/// Skin in a checker of two tones, 32 x 32.
fn checker() -> Vec<u8> {
    let tone =
        |x: u32, y: u32| if (x / 16 + y / 16).is_multiple_of(2) { [224, 172, 140] } else { [150, 96, 72] };
    file_of(RgbImage::from_fn(32, 32, |x, y| tone(x, y).into()), ImageFormat::Jpeg)
}

/// An eye: its iris in the middle of the picture.
fn eye() -> Vec<u8> {
    let tone = |x: u32, y: u32| match Vec2::new(x as f32 - 63.5, 2.0 * (y as f32 - 31.5)).length() {
        away if away < 7.0 => [8, 6, 6],
        away if away < 16.0 => [70, 110, 60],
        _ => [236, 232, 226],
    };
    file_of(RgbImage::from_fn(128, 64, |x, y| tone(x, y).into()), ImageFormat::Png)
}

fn board() -> Vec<u8> {
    file_of(RgbImage::from_fn(2, 2, |x, y| BOARD[(2 * y + x) as usize].into()), ImageFormat::Png)
}

/// The right half of a picture, and nothing on the left.
fn half() -> Vec<u8> {
    let texel = |x: u32, _: u32| Rgba([90, 60, 30, if x < 8 { 0 } else { 255 }]);
    file_of(RgbaImage::from_fn(16, 16, texel), ImageFormat::Png)
}

/// A file while it is written.
#[derive(Default)]
struct Writer {
    bin: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
    meshes: Vec<String>,
}

impl Writer {
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let (offset, length) = (self.bin.len(), bytes.len());
        self.bin.extend_from_slice(bytes);
        self.views.push(format!(r#"{{"buffer": 0, "byteOffset": {offset}, "byteLength": {length}}}"#));
        self.views.len() - 1
    }

    fn accessor(&mut self, bytes: &[u8], members: &str) -> usize {
        let view = self.view(bytes);
        self.accessors.push(format!(r#"{{"bufferView": {view}, {members}}}"#));
        self.accessors.len() - 1
    }

    /// Adds a part with members of its own and of its attributes. Coordinates are those of a set, floats or, of the
    /// second set, shares of 65535.
    fn part(&mut self, part: &Part, set: usize, attributes: &str, members: &str) {
        let floats =
            |numbers: &mut dyn Iterator<Item = f32>| numbers.flat_map(f32::to_le_bytes).collect::<Vec<_>>();
        let positions = floats(&mut part.positions.iter().flat_map(|place| place.to_array()));
        let [low, high] =
            [Vec3::min, Vec3::max].map(|most| part.positions.iter().copied().reduce(most).unwrap());
        let count = part.positions.len();
        let bounds = format!(r#""min": {:?}, "max": {:?}"#, low.to_array(), high.to_array());
        let positions = self.accessor(
            &positions,
            &format!(r#""componentType": 5126, "count": {count}, "type": "VEC3", {bounds}"#),
        );
        let places = part.places.iter().flat_map(|place| place.to_array());
        let places = if set == 0 {
            let kind = format!(r#""componentType": 5126, "count": {count}, "type": "VEC2""#);
            self.accessor(&floats(&mut { places }), &kind)
        } else {
            let kind =
                format!(r#""componentType": 5123, "normalized": true, "count": {count}, "type": "VEC2""#);
            let shares = places.flat_map(|share| ((share * 65535.0) as u16).to_le_bytes());
            self.accessor(&shares.collect::<Vec<_>>(), &kind)
        };
        let corners = part.triangles.as_flattened();
        let indices: Vec<u8> = corners.iter().flat_map(|corner| corner.to_le_bytes()).collect();
        let count = corners.len();
        let indices =
            self.accessor(&indices, &format!(r#""componentType": 5123, "count": {count}, "type": "SCALAR""#));
        let attributes = format!(r#""POSITION": {positions}, "TEXCOORD_{set}": {places}{attributes}"#);
        self.meshes.push(format!(
            r#"{{"primitives": [{{"attributes": {{{attributes}}}, "indices": {indices}{members}}}]}}"#
        ));
    }
}

/// The materials: checker, eye, board, half, glass.
fn materials() -> String {
    let texture = |index: u32, more: &str| format!(r#""baseColorTexture": {{"index": {index}{more}}}"#);
    let transform = r#", "extensions": {"KHR_texture_transform": {"scale": [8, 4]}}"#;
    [
        format!(
            r#""name": "skin", "pbrMetallicRoughness": {{{}, "metallicFactor": 0}}"#,
            texture(0, transform)
        ),
        format!(
            r#""name": "eye", "pbrMetallicRoughness": {{{}, "roughnessFactor": 0.1, "metallicFactor": 0}}"#,
            texture(1, "")
        ),
        format!(
            r#""name": "board", "pbrMetallicRoughness": {{"baseColorFactor": [{RED}, 1, 1, 1], {}}}"#,
            texture(2, r#", "texCoord": 1"#)
        ),
        format!(
            r#""name": "half", "alphaMode": "MASK", "alphaCutoff": 0.4, "pbrMetallicRoughness": {{{}}}"#,
            texture(3, "")
        ),
        r#""name": "glass", "alphaMode": "BLEND",
            "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.2]}"#
            .to_owned(),
    ]
    .map(|members| format!("{{{members}}}"))
    .join(", ")
}

/// The file, binary glTF: a ball of 10 cm at the origin in a checker, an eye at its right, at z = 15 cm a board at the left
/// with four colours, one at the right whose left half is cut away and one of glass at the top, and a wall at z = -15 cm
/// with colours of its vertices.
pub fn painted() -> Vec<u8> {
    let mut writer = Writer::default();
    let material = |index: u32| format!(r#", "material": {index}"#);
    writer.part(&ball(Vec3::ZERO, 0.1), 0, "", &material(0));
    writer.part(&ball(Vec3::new(0.03, 0.02, 0.08), 0.025), 0, "", &material(1));
    writer.part(&square(Vec3::new(-0.15, 0.0, 0.15), 0.1), 1, "", &material(2));
    writer.part(&square(Vec3::new(0.15, 0.0, 0.15), 0.1), 0, "", &material(3));
    writer.part(&square(Vec3::new(0.0, 0.15, 0.15), 0.1), 0, "", &material(4));
    let colors = writer.accessor(
        &[[102, 153, 204, 0]; 4].concat(),
        r#""componentType": 5121, "normalized": true, "count": 4, "type": "VEC4""#,
    );
    writer.part(&square(Vec3::new(0.0, 0.0, -0.15), 0.8), 0, &format!(r#", "COLOR_0": {colors}"#), "");
    let pictures = [checker(), board(), half()].map(|bytes| writer.view(&bytes));
    let eye = format!("data:image/png;base64,{}", base_64(&eye()));
    let [checker, board, half] = pictures.map(|view| format!(r#"{{"bufferView": {view}, "mimeType": ""}}"#));
    let nodes: Vec<String> = (0..writer.meshes.len()).map(|mesh| format!(r#"{{"mesh": {mesh}}}"#)).collect();
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": {:?}}}], "nodes": [{}],
"meshes": [{}], "materials": [{}], "textures": [{{"source": 0}}, {{"source": 1, "sampler": 0}},
{{"source": 2, "sampler": 0}}, {{"source": 3, "sampler": 0}}], "samplers": [{{"wrapS": 33071, "wrapT": 33071}}],
"images": [{checker}, {{"name": "iris", "uri": "{eye}"}}, {board}, {half}], "accessors": [{}], "bufferViews": [{}],
"buffers": [{{"byteLength": {}}}]}}"#,
        (0..nodes.len()).collect::<Vec<_>>(),
        nodes.join(", "),
        writer.meshes.join(", "),
        materials(),
        writer.accessors.join(", "),
        writer.views.join(", "),
        writer.bin.len()
    );
    glb(json, writer.bin)
}

fn glb(json: String, mut bin: Vec<u8>) -> Vec<u8> {
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    bin.resize(bin.len().next_multiple_of(4), 0);
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((28 + json.len() as u32 + bin.len() as u32).to_le_bytes());
    for (kind, part) in [(b"JSON", json), (b"BIN\0", bin)] {
        bytes.extend((part.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(part);
    }
    bytes
}

/// \[RFC4648 §4\]
fn base_64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let bits = three.iter().fold(0, |bits, byte| bits << 8 | u32::from(*byte)) << (8 * (3 - three.len()));
        for digit in 0..=three.len() {
            text.push(char::from(DIGITS[(bits >> (18 - 6 * digit)) as usize & 63]));
        }
    }
    text
}
