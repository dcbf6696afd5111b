//! glTF as exporters, packers and rigs write it.

use glam::{Mat4, Quat, Vec3};
use proptest::prelude::*;

use strandline_body::Mesh;

use crate::files::{self, cube_bin, cube_json, load_bytes, scratch};
use crate::mesh_files::{check_cube, check_damaged, damage, damaged, refused};

/// The cube with more accessors, each over bytes behind those of the cube, and its document changed.
struct Glb {
    json: String,
    bin: Vec<u8>,
    accessors: usize,
    views: usize,
}

impl Glb {
    fn new(placing: &str) -> Self {
        Self { json: cube_json(placing, None), bin: cube_bin(), accessors: 2, views: 2 }
    }

    fn replace(mut self, from: &str, to: &str) -> Self {
        assert!(self.json.contains(from), "{from} is not in {}", self.json);
        self.json = self.json.replace(from, to);
        self
    }

    /// Appends a view of bytes; its number.
    fn view(&mut self, bytes: &[u8], members: &str) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = format!(
            r#"{{"buffer": 0, "byteOffset": {}, "byteLength": {}{members}}}"#,
            self.bin.len(),
            bytes.len()
        );
        self.bin.extend(bytes);
        self.json = self.json.replace("],\n\"buffers\"", &format!(", {view}],\n\"buffers\""));
        self.views += 1;
        self.views - 1
    }

    /// Appends an accessor; its number.
    fn accessor(&mut self, members: &str) -> usize {
        self.json = self.json.replace("],\n\"bufferViews\"", &format!(", {{{members}}}],\n\"bufferViews\""));
        self.accessors += 1;
        self.accessors - 1
    }

    fn numbers(&mut self, bytes: &[u8], members: &str) -> usize {
        let view = self.view(bytes, "");
        self.accessor(&format!(r#""bufferView": {view}, {members}"#))
    }

    fn bytes(&self) -> Vec<u8> {
        let length = format!(r#""buffers": [{{"byteLength": {}"#, self.bin.len());
        files::glb(&self.json.replace(r#""buffers": [{"byteLength": 132"#, &length), &self.bin)
    }
}

fn floats(numbers: impl IntoIterator<Item = f32>) -> Vec<u8> {
    numbers.into_iter().flat_map(f32::to_le_bytes).collect()
}

fn required(names: &str) -> Glb {
    Glb::new("{}").replace(r#""scene": 0"#, &format!(r#""extensionsRequired": [{names}], "scene": 0"#))
}

#[test]
fn extensions_of_looks_are_no_obstacle_and_others_are_named() {
    for names in [
        r#""KHR_materials_unlit", "KHR_texture_transform""#,
        r#""KHR_materials_transmission", "KHR_materials_clearcoat", "EXT_texture_webp", "KHR_texture_basisu""#,
        r#""KHR_lights_punctual", "KHR_animation_pointer", "VRM", "VRMC_springBone", "KHR_xmp_json_ld""#,
        r#""EXT_mesh_features", "EXT_structural_metadata", "KHR_node_visibility", "KHR_interactivity""#,
    ] {
        check_cube(&load_bytes("cube.glb", &required(names).bytes()).unwrap(), Vec3::ZERO, 1.0);
    }
    for name in ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_mesh_gpu_instancing"] {
        let error = refused("cube.glb", &required(&format!(r#""{name}""#)).bytes());
        assert!(error.contains(&format!("the extension `{name}`, which the file requires")), "{error}");
    }
    // Textures without a source of the core, attributes of one's own, a channel without a node.
    let odd =
        Glb::new("{}").replace(r#""POSITION": 0"#, r#""POSITION": 0, "_OWN": 0, "COLOR_X": 0"#).replace(
            r#""scene": 0"#,
            r#""textures": [{"extensions": {"EXT_texture_webp": {"source": 0}}}],
               "animations": [{"channels": [{"sampler": 0, "target": {"path": "pointer"}}],
                               "samplers": [{"input": 0, "output": 0}]}], "scene": 0"#,
        );
    check_cube(&load_bytes("cube.glb", &odd.bytes()).unwrap(), Vec3::ZERO, 1.0);
}

#[test]
fn an_avatar_and_a_byte_order_mark_are_read() {
    check_cube(&load_bytes("cube.vrm", &files::cube_glb("{}")).unwrap(), Vec3::ZERO, 1.0);
    let text = cube_json("{}", Some(&files::data_uri()));
    check_cube(&load_bytes("cube.gltf", format!("\u{FEFF}{text}").as_bytes()).unwrap(), Vec3::ZERO, 1.0);
}

#[test]
fn the_scene_of_the_file_alone_is_read() {
    let scenes = r#""scenes": [{"nodes": [0]}]"#;
    let nodes = r#""nodes": [{"children": [1]}, "#;
    let stage = |scene: &str| {
        Glb::new("{}")
            .replace(scenes, r#""scenes": [{"nodes": [2]}, {"nodes": [0]}]"#)
            .replace(nodes, r#""nodes": [{"children": [1]}, "#)
            .replace(
                r#""skin": 0}]"#,
                r#""skin": 0}, {"mesh": 0, "scale": [20, 20, 20], "translation": [5, 0, 0]}]"#,
            )
            .replace(r#""scene": 0"#, scene)
    };
    let load = |scene: &str| load_bytes("cube.glb", &stage(scene).bytes()).unwrap();
    check_cube(&load(r#""scene": 1"#), Vec3::ZERO, 1.0);
    check_cube(&load(r#""scene": 0"#), Vec3::new(5.0, 0.0, 0.0), 20.0);
    // Without a choice the first scene is shown.
    check_cube(&load(r#""extras": 0"#), Vec3::new(5.0, 0.0, 0.0), 20.0);
    let twice = Glb::new("{}").replace(scenes, r#""scenes": [{"nodes": [0, 0]}]"#);
    assert!(refused("cube.glb", &twice.bytes()).contains("node 0 twice in a scene"));
}

#[test]
fn hidden_nodes_and_what_is_below_them_are_not_drawn() {
    let hidden = |visible: &str| {
        let node = format!(
            r#""skin": 0}}, {{"children": [3], "extensions": {{"KHR_node_visibility": {{"visible": {visible}}}}}}},
               {{"mesh": 0, "scale": [20, 20, 20], "translation": [5, 0, 0]}}]"#
        );
        let file = Glb::new("{}")
            .replace(r#""scenes": [{"nodes": [0]}]"#, r#""scenes": [{"nodes": [0, 2]}]"#)
            .replace(r#""skin": 0}]"#, &node)
            .replace(r#""scene": 0"#, r#""extensionsRequired": ["KHR_node_visibility"], "scene": 0"#);
        load_bytes("cube.glb", &file.bytes()).unwrap()
    };
    check_cube(&hidden("false"), Vec3::ZERO, 1.0);
    for visible in ["true", "1", "null"] {
        assert_eq!(hidden(visible).positions.len(), 16, "{visible}");
    }
    // A circle of hidden nodes ends.
    let circle =
        r#"{"nodes": [{"children": [0], "extensions": {"KHR_node_visibility": {"visible": false}}}]}"#;
    assert!(load_bytes("circle.gltf", circle.as_bytes()).is_err());
}

#[test]
fn quantised_vertices_are_read() {
    let corners = |largest: i32| {
        cube_bin()[..96]
            .chunks_exact(4)
            .map(move |n| if n == [0; 4] { 0 } else { largest })
            .collect::<Vec<i32>>()
    };
    let quantised = |component: u32, bytes: Vec<u8>, normalized: bool, stride: usize, scale: f32| {
        let mut file = Glb::new(&format!(r#"{{"scale": [{scale}, {scale}, {scale}]}}"#));
        let view = file.view(&bytes, &format!(r#", "byteStride": {stride}"#));
        let position = file.accessor(&format!(
            r#""bufferView": {view}, "componentType": {component}, "normalized": {normalized}, "count": 8,
               "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]"#
        ));
        let file = file.replace(r#""POSITION": 0"#, &format!(r#""POSITION": {position}"#));
        let file =
            file.replace(r#""scene": 0"#, r#""extensionsRequired": ["KHR_mesh_quantization"], "scene": 0"#);
        load_bytes("cube.glb", &file.bytes()).unwrap()
    };
    let strided = |largest: i32, size: usize| -> Vec<u8> {
        let rows = corners(largest);
        let row = |row: &[i32]| -> Vec<u8> {
            let mut bytes: Vec<u8> =
                row.iter().flat_map(|number| number.to_le_bytes()[..size].to_vec()).collect();
            bytes.resize(4 * size, 7);
            bytes
        };
        rows.chunks_exact(3).flat_map(row).collect()
    };
    check_cube(&quantised(5122, strided(32767, 2), true, 8, 1.0), Vec3::ZERO, 1.0);
    check_cube(&quantised(5123, strided(65535, 2), true, 8, 0.5), Vec3::ZERO, 0.5);
    check_cube(&quantised(5120, strided(127, 1), true, 4, 1.0), Vec3::ZERO, 1.0);
    check_cube(&quantised(5121, strided(200, 1), false, 4, 0.01), Vec3::ZERO, 2.0);
}

/// The cube by a sparse accessor: its corners from 4 on are the changed ones.
fn sparse(base: &str, indices: &[u8], kind: u32) -> Glb {
    let mut file = Glb::new("{}");
    let indices = file.view(indices, "");
    let places = cube_bin();
    let values = file.view(&places[48..96], "");
    let flat = file.view(&[places[..48].to_vec(), vec![0; 48]].concat(), "");
    let base = base.replace("FLAT", &flat.to_string());
    let position = file.accessor(&format!(
        r#"{base}"componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1],
           "sparse": {{"count": 4, "indices": {{"bufferView": {indices}, "componentType": {kind}}},
                       "values": {{"bufferView": {values}}}}}"#
    ));
    file.replace(r#""POSITION": 0"#, &format!(r#""POSITION": {position}"#))
}

#[test]
fn sparse_accessors_are_read() {
    let file = sparse(r#""bufferView": FLAT, "#, &[4, 5, 6, 7], 5121);
    check_cube(&load_bytes("cube.glb", &file.bytes()).unwrap(), Vec3::ZERO, 1.0);
    // Without a view the others are zeros.
    let wide = sparse("", &[4, 0, 5, 0, 6, 0, 7, 0], 5123);
    let mesh = load_bytes("cube.glb", &wide.bytes()).unwrap();
    assert!(mesh.positions[..4].iter().all(|position| *position == Vec3::ZERO));
    assert_eq!(mesh.positions[6], Vec3::ONE);
    let beyond = refused("cube.glb", &sparse("", &[4, 5, 6, 8], 5121).bytes());
    assert!(beyond.contains("a sparse index beyond its elements"), "{beyond}");
    let cut = refused("cube.glb", &sparse("", &[4, 5, 6], 5121).bytes());
    assert!(cut.contains("sparse part lies beyond its buffer"), "{cut}");
    let much = sparse("", &[4, 5, 6, 7], 5121).replace(
        r#""count": 8, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1],
           "sparse""#,
        r#""count": 800000000, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1],
           "sparse""#,
    );
    let much = refused("cube.glb", &much.bytes());
    assert!(much.contains("more than") && much.contains("vertices"), "{much}");
}

/// The cube in centimetres with z up on a skin of two joints; the second carries the corners with z = 1 and is moved.
fn skinned(weights: [f32; 2], is_second_set: bool) -> Glb {
    let world_from_mesh = Mat4::from_scale_rotation_translation(
        Vec3::splat(0.01),
        Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2),
        Vec3::new(0.0, 1.6, 0.0),
    );
    let joint = Mat4::from_translation(Vec3::new(0.0, 1.6, 0.0));
    let inverse = joint.inverse() * world_from_mesh;
    let mut file = Glb::new(r#"{"translation": [7, 8, 9], "scale": [3, 3, 3]}"#);
    let matrices = [inverse; 2].into_iter().flat_map(|matrix| matrix.to_cols_array());
    let matrices = file.numbers(&floats(matrices), r#""componentType": 5126, "count": 2, "type": "MAT4""#);
    let joints = (0..8).flat_map(|corner| [u8::from(corner >= 4), 0, 0, 0]).collect::<Vec<_>>();
    let joints = file.numbers(&joints, r#""componentType": 5121, "count": 8, "type": "VEC4""#);
    let first = (0..8).flat_map(|_| [weights[0], 0.0, 0.0, 0.0]);
    let first = file.numbers(&floats(first), r#""componentType": 5126, "count": 8, "type": "VEC4""#);
    let mut attributes = format!(r#""POSITION": 0, "JOINTS_0": {joints}, "WEIGHTS_0": {first}"#);
    if is_second_set {
        let second = (0..8).flat_map(|_| [(weights[1] * 255.0) as u8, 0, 0, 0]).collect::<Vec<_>>();
        let second =
            file.numbers(&second, r#""componentType": 5121, "normalized": true, "count": 8, "type": "VEC4""#);
        attributes += &format!(r#", "JOINTS_1": {joints}, "WEIGHTS_1": {second}"#);
    }
    file.replace(r#""POSITION": 0"#, &attributes)
        .replace(r#""joints": [0]"#, &format!(r#""joints": [2, 3], "inverseBindMatrices": {matrices}"#))
        .replace(r#""skin": 0, "#, r#""skin": 0, "name": "skinned", "#)
        .replace(
            r#""scale": [3, 3, 3]}],"#,
            r#""scale": [3, 3, 3]}, {"translation": [0, 1.6, 0]}, {"translation": [0, 2.6, 0]}],"#,
        )
}

#[test]
fn a_skinned_mesh_stands_in_its_default_pose() {
    // Weights of any sum are shares; a vertex without one is carried by the first joint.
    for (weights, is_second_set) in [([1.0, 0.0], false), ([0.25, 1.0], true)] {
        let mesh = load_bytes("cube.glb", &skinned(weights, is_second_set).bytes()).unwrap();
        for (corner, position) in mesh.positions.iter().enumerate() {
            let place = &cube_bin()[12 * corner..];
            let number = |at: usize| f32::from_le_bytes(place[4 * at..4 * at + 4].try_into().unwrap());
            let lift = if corner >= 4 { 1.0 } else { 0.0 };
            let expected = Vec3::new(0.01 * number(0), 1.6 + lift + 0.01 * number(2), -0.01 * number(1));
            assert!(position.distance(expected) < 1e-6, "{corner}: {position} in place of {expected}");
        }
    }
    let unweighted = load_bytes("cube.glb", &skinned([0.0, 0.0], false).bytes()).unwrap();
    check_cube(&unweighted, Vec3::new(0.0, 1.6, -0.01), 0.01);
    let notes = |weights: [f32; 2]| {
        let (_folder, path) = scratch("cube.glb", &skinned(weights, false).bytes());
        Mesh::load_noted(&path, 1.0).unwrap().1
    };
    let note = "8 of 8 vertices have no weights of joints: the first joint of the skin carries them";
    assert_eq!((notes([0.0, 0.0]), notes([1.0, 0.0])), (vec![note.to_owned()], Vec::new()));
    let file = skinned([1.0, 0.0], false).replace(r#""joints": [2, 3]"#, r#""joints": [2]"#);
    assert!(refused("cube.glb", &file.bytes()).contains("the joint 1 of 1"));
    let file = skinned([1.0, 0.0], false).replace(r#""joints": [2, 3]"#, r#""joints": [2, 3, 3]"#);
    assert!(refused("cube.glb", &file.bytes()).contains("2 inverse bind matrices for 3 joints"));
    // The joints and the weights of the second set are accessors 3 and 5.
    let sets = |last: u32| {
        let set = |set: u32| format!(r#""JOINTS_{set}": 3, "WEIGHTS_{set}": 5, "#);
        let more: String = (2..=last).map(set).collect();
        skinned([0.5, 0.5], true).replace(r#""JOINTS_1""#, &format!(r#"{more}"JOINTS_1""#)).bytes()
    };
    load_bytes("cube.glb", &sets(3)).unwrap();
    assert!(refused("cube.glb", &sets(4)).contains("more than 4 sets of joints"));
}

#[test]
fn morph_targets_move_a_mesh_by_its_default_weights() {
    let morphed = |of_node: &str, of_mesh: &str| {
        let mut file = Glb::new(&format!("{{{of_node}}}"));
        let deltas = floats((0..8).flat_map(|_| [2.0, 0.0, 0.0]));
        let deltas = file.numbers(&deltas, r#""componentType": 5126, "count": 8, "type": "VEC3""#);
        let targets =
            format!(r#""indices": 1, "targets": [{{"POSITION": {deltas}}}, {{"POSITION": {deltas}}}]}}]"#);
        let file = file.replace(r#""indices": 1}]"#, &format!("{targets}{of_mesh}"));
        load_bytes("cube.glb", &file.bytes()).unwrap()
    };
    check_cube(&morphed("", ""), Vec3::ZERO, 1.0);
    check_cube(&morphed("", r#", "weights": [0.5, 1]"#), Vec3::new(3.0, 0.0, 0.0), 1.0);
    // A node's own weights come first.
    check_cube(
        &morphed(r#""weights": [0, 0.25]"#, r#", "weights": [0.5, 1]"#),
        Vec3::new(0.5, 0.0, 0.0),
        1.0,
    );
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn a_damaged_skin_or_sparse_accessor_does_no_harm(damage in damage(), is_skin in any::<bool>()) {
        let file = if is_skin { skinned([1.0, 0.5], true) } else { sparse("", &[4, 5, 6, 7], 5121) };
        check_damaged("cube.glb", &damaged(&file.bytes(), &damage));
    }
}
