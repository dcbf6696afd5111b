//! The tree of nodes of a glTF file.

use ::gltf::{Document, Node};
use glam::Mat4;

use crate::parsing::Refusal;

/// The deepest nesting of nodes.
const DEPTH_LIMIT: usize = 64;

/// The nodes of a file at rest.
pub(super) struct Nodes<'a> {
    /// Nodes of the scene that is shown, by number.
    pub shown: Vec<Node<'a>>,
    /// All nodes, shown or not, by number.
    pub all: Vec<Node<'a>>,
    /// Transforms of all nodes, shape `[node]`.
    pub world_from_node: Vec<Mat4>,
    /// Nodes and the nodes above them, those above first.
    pub order: Vec<(usize, Option<usize>)>,
}

impl<'a> Nodes<'a> {
    /// The nodes of the file's own scene, or else of its first; of a file without scenes all.
    pub fn new(document: &'a Document) -> Result<Self, Refusal> {
        let mut is_child = vec![false; document.nodes().len()];
        for child in document.nodes().flat_map(|node| node.children()) {
            if std::mem::replace(&mut is_child[child.index()], true) {
                return Err((format!("node {} below two others", child.index()), "a tree of nodes"));
            }
        }
        let roots = document.nodes().filter(|node| !is_child[node.index()]);
        let (world_from_node, order) = transforms(document, roots)?;
        let scene = document.default_scene().or_else(|| document.scenes().next());
        let shown = match scene {
            Some(scene) => below(document, scene.nodes())?,
            None => document.nodes().collect(),
        };
        Ok(Self { shown, all: document.nodes().collect(), world_from_node, order })
    }
}

/// Transforms of nodes, and the order in which each follows the node above it.
type Tree = (Vec<Mat4>, Vec<(usize, Option<usize>)>);

/// The tree of all nodes. Every node is below one other at most, so the walk meets each once and ends.
fn transforms<'a>(document: &'a Document, roots: impl Iterator<Item = Node<'a>>) -> Result<Tree, Refusal> {
    let mut world_from_node = vec![Mat4::IDENTITY; document.nodes().len()];
    let mut order = Vec::with_capacity(world_from_node.len());
    let mut waiting: Vec<_> = roots.map(|node| (node, None, 0)).collect();
    while let Some((node, above, depth)) = waiting.pop() {
        if depth > DEPTH_LIMIT {
            return Err((format!("node {} more than {DEPTH_LIMIT} deep", node.index()), "fewer levels"));
        }
        let world_from_above = above.map_or(Mat4::IDENTITY, |above: usize| world_from_node[above]);
        let own = world_from_above * Mat4::from_cols_array_2d(&node.transform().matrix());
        world_from_node[node.index()] = own;
        order.push((node.index(), above));
        waiting.extend(node.children().map(|child| (child, Some(node.index()), depth + 1)));
    }
    Ok((world_from_node, order))
}

/// The nodes below the roots of a scene, by number.
fn below<'a>(document: &Document, roots: impl Iterator<Item = Node<'a>>) -> Result<Vec<Node<'a>>, Refusal> {
    let mut is_met = vec![false; document.nodes().len()];
    let mut waiting: Vec<_> = roots.collect();
    let mut shown = Vec::new();
    while let Some(node) = waiting.pop() {
        if std::mem::replace(&mut is_met[node.index()], true) {
            return Err((format!("node {} twice in a scene", node.index()), "a tree of nodes"));
        }
        waiting.extend(node.children());
        shown.push(node);
    }
    shown.sort_by_key(Node::index);
    Ok(shown)
}
