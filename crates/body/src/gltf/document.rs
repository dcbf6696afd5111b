//! Shape of a glTF file: the document without looks, these and its clips apart, and the bytes behind it.

use ::gltf::Document;
use ::gltf::json::{Root, Value, deserialize};

use strandline_base::utf8_text;

use super::clips::Clips;
use super::materials::Looks;
use crate::parsing::Refusal;

/// A file in its parts.
pub(super) struct Parts {
    /// The document, validated.
    pub document: Document,
    pub clips: Clips,
    pub looks: Looks,
    /// The binary part of the file, where it has one.
    pub blob: Option<Vec<u8>>,
}

/// Parses a file. Looks and clips are left out before the document is validated: they may use any extension.
pub(super) fn document(bytes: &[u8]) -> Result<Parts, Refusal> {
    check_container(bytes)?;
    let refused = |error: ::gltf::Error| (format!("bad glTF ({error})"), "valid glTF 2.0");
    let unread = |error| refused(::gltf::Error::Deserialize(error));
    let (text, blob) = if bytes.starts_with(b"glTF") {
        let parts = ::gltf::Glb::from_slice(bytes).map_err(refused)?;
        (parts.json, parts.bin.map(|bin| bin.into_owned()))
    } else {
        (utf8_text(bytes), None)
    };
    let mut value: Value = deserialize::from_slice(&text).map_err(unread)?;
    check_required(&value)?;
    let clips = Clips::new(value.get_mut("animations").map(Value::take));
    let looks = Looks::take(&mut value);
    hide(&mut value);
    keep_shape(&mut value);
    let root: Root = deserialize::from_value(value).map_err(unread)?;
    check_positions(&root)?;
    Ok(Parts { document: Document::from_json(root).map_err(refused)?, clips, looks, blob })
}

/// A binary file says its own length, which the parser subtracts from without a look.
fn check_container(bytes: &[u8]) -> Result<(), Refusal> {
    if !bytes.starts_with(b"glTF") {
        return Ok(());
    }
    let stated = bytes.get(8..12).and_then(|field| field.try_into().ok()).map(u32::from_le_bytes);
    match stated {
        Some(length) if length >= 12 && length as usize <= bytes.len() => Ok(()),
        Some(length) => {
            Err((format!("a file of {} bytes that says it has {length}", bytes.len()), "the whole file"))
        }
        None => Err((format!("a file of {} bytes", bytes.len()), "a header of 12 bytes")),
    }
}

/// Refuses extensions that the shape depends on, but for quantised vertices.
fn check_required(root: &Value) -> Result<(), Refusal> {
    let required = root.get("extensionsRequired").and_then(Value::as_array);
    let mut names = required.into_iter().flatten().filter_map(Value::as_str);
    names.find(|name| !is_needless(name)).map_or(Ok(()), |name| {
        let found = format!("the extension `{name}`, which the file requires");
        Err((found, "plain data, KHR_mesh_quantization or extensions of looks, lights and clips"))
    })
}

/// Tells extensions that a reader of shapes knows, or that leave the shape at rest alone.
fn is_needless(name: &str) -> bool {
    const KNOWN: [&str; 3] = ["KHR_mesh_quantization", VISIBILITY, "VRM"];
    const BESIDE: [&str; 12] = [
        "_materials_",
        "_texture_",
        "_lights_",
        "_animation_",
        "_audio",
        "_xmp",
        "_physics",
        "_mesh_features",
        "_structural_metadata",
        "_node_selectability",
        "_node_hoverability",
        "_interactivity",
    ];
    KNOWN.contains(&name) || name.starts_with("VRMC_") || BESIDE.iter().any(|part| name.contains(part))
}

/// The extension by which a node hides itself and all below it.
const VISIBILITY: &str = "KHR_node_visibility";

/// Takes the meshes of hidden nodes and of all below them away. The nodes stay: they may be joints.
fn hide(root: &mut Value) {
    let mut nodes = list(root.get_mut("nodes")).collect::<Vec<_>>();
    let says_hidden = |node: &Value| {
        let said = node.get("extensions").and_then(|all| all.get(VISIBILITY)?.get("visible"));
        said.and_then(Value::as_bool) == Some(false)
    };
    let mut waiting: Vec<usize> = (0..nodes.len()).filter(|&index| says_hidden(nodes[index])).collect();
    let mut hidden = vec![false; nodes.len()];
    while let Some(index) = waiting.pop() {
        if hidden.get(index).is_none_or(|&seen| seen) {
            continue;
        }
        hidden[index] = true;
        let children = nodes[index].get("children").and_then(Value::as_array);
        let below = children.into_iter().flatten().filter_map(Value::as_u64);
        waiting.extend(below.filter_map(|child| usize::try_from(child).ok()));
        if let Some(node) = nodes[index].as_object_mut() {
            node.retain(|name, _| name != "mesh" && name != "skin");
        }
    }
}

/// Leaves out all that does not change the shape, names of materials apart.
fn keep_shape(root: &mut Value) {
    drop_additions(root);
    let Some(root) = root.as_object_mut() else { return };
    for beside in ["animations", "textures", "images", "samplers", "cameras", "extensionsRequired"] {
        root.remove(beside);
    }
    for material in list(root.get_mut("materials")) {
        retain(material, &["name"]);
    }
    for node in list(root.get_mut("nodes")) {
        retain(
            node,
            &["name", "children", "mesh", "skin", "matrix", "rotation", "scale", "translation", "weights"],
        );
    }
    for primitive in list(root.get_mut("meshes")).flat_map(|mesh| list(mesh.get_mut("primitives"))) {
        retain(primitive, &["attributes", "indices", "material", "mode", "targets"]);
        if let Some(attributes) = primitive.get_mut("attributes").and_then(Value::as_object_mut) {
            attributes.retain(|name, _| is_shape(name));
        }
    }
}

/// Leaves out extensions and extras everywhere: extras may be any value. The parser limits the depth of values.
fn drop_additions(value: &mut Value) {
    match value {
        Value::Object(members) => {
            members.retain(|name, _| name != "extras" && name != "extensions");
            members.values_mut().for_each(drop_additions);
        }
        Value::Array(values) => values.iter_mut().for_each(drop_additions),
        _ => {}
    }
}

/// Tells attributes of vertices that say where they are.
fn is_shape(attribute: &str) -> bool {
    let is_set = |kind: &str| attribute.strip_prefix(kind).is_some_and(|set| set.parse::<u32>().is_ok());
    matches!(attribute, "POSITION" | "NORMAL") || is_set("JOINTS_") || is_set("WEIGHTS_")
}

fn list(value: Option<&mut Value>) -> impl Iterator<Item = &mut Value> {
    value.and_then(Value::as_array_mut).into_iter().flatten()
}

fn retain(value: &mut Value, names: &[&str]) {
    if let Some(object) = value.as_object_mut() {
        object.retain(|name, _| names.contains(&name.as_str()));
    }
}

/// The parser's own validation looks up the accessor of the positions before it knows that there is one.
fn check_positions(root: &Root) -> Result<(), Refusal> {
    let parts = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    for accessor in parts.flat_map(|part| part.attributes.values()) {
        if accessor.value() >= root.accessors.len() {
            let found = format!("the accessor {} of {}", accessor.value(), root.accessors.len());
            return Err((found, "accessors in range"));
        }
    }
    Ok(())
}
