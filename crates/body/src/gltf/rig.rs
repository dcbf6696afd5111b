//! A glTF mesh in motion: nodes, skins and morph targets at any time of a clip.

mod placed;

use ::gltf::mesh::Primitive;
use ::gltf::scene::Transform;
use ::gltf::{Node, Semantic};
use glam::{DMat4, DQuat, DVec3, DVec4, Mat4, Vec3};
use strandline_base::{Tally, memory::Need};

use super::buffers::Buffers;
use super::nodes::Nodes;
use super::track::{Property, Track, unit};
use super::vertices::{Influences, default_weights, joints_of};
use crate::parsing::Refusal;
use crate::teleports::Teleports;

/// Most keys at which a clip is searched for mirror images.
const MOST_KEYS: usize = 4096;
/// Most spans between keys that are searched for jumps, and the most of them times tracks and nodes that are sampled in each.
const MOST_SPANS: usize = 1 << 16;
const MOST_SAMPLED: usize = 2 << 20;
/// Share of one node from which on a vertex moves rigidly with it.
const RIGID: f32 = 0.99;

/// A mesh that a clip moves.
#[derive(Debug)]
pub(crate) struct Rig {
    /// Names and transforms at rest of all nodes.
    names: Vec<Option<String>>,
    rest: Vec<Local>,
    /// Nodes and the nodes above them, those above first.
    order: Vec<(usize, Option<usize>)>,
    /// Weights of morph targets at rest, by node.
    weights: Vec<Vec<f64>>,
    /// Joints with their inverse bind matrices, by skin; read where a part asks for them.
    skins: Vec<Option<Vec<(usize, DMat4)>>>,
    parts: Vec<Part>,
    tracks: Vec<Track>,
    /// Marks of the clip.
    teleports: Teleports,
    /// Vertices placed so far.
    placed: Tally,
}

/// Transform of a node in the space of the node above.
#[derive(Clone, Copy, Debug)]
enum Local {
    Matrix(DMat4),
    Parts { translation: DVec3, rotation: DQuat, scale: DVec3 },
}

/// Vertices of a primitive, in their order in the mesh.
#[derive(Debug)]
struct Part {
    node: usize,
    /// A place amid the positions, space of the mesh: far from the origin of the mesh single precision holds the way from it.
    middle: DVec3,
    /// Positions before morphing, from the middle.
    base: Vec<Vec3>,
    /// Number of a morph target, and the vertices that it moves.
    targets: Vec<(usize, Vec<(u32, Vec3)>)>,
    /// Skin and joints of the vertices; none where the node carries them.
    skin: Option<(usize, Influences)>,
}

/// Nodes at a time.
struct Pose {
    world_from_node: Vec<DMat4>,
    weights: Vec<Vec<f64>>,
}

impl Rig {
    /// The nodes of a file under the tracks of a clip; the parts of its mesh are added as they are read.
    pub(super) fn new(nodes: &Nodes<'_>, tracks: Vec<Track>) -> Self {
        let is_moved = |node: &Node<'_>| {
            let of_node = |track: &Track| track.node == node.index() && track.property != Property::Weights;
            tracks.iter().any(of_node)
        };
        let rest = nodes.all.iter().map(|node| Local::of(&node.transform(), is_moved(node))).collect();
        let name = |node: &Node<'_>| node.name().map(str::to_owned);
        let weights = |node: &Node<'_>| default_weights(node).iter().copied().map(f64::from).collect();
        Self {
            names: nodes.all.iter().map(name).collect(),
            rest,
            order: nodes.order.clone(),
            weights: nodes.all.iter().map(weights).collect(),
            skins: Vec::new(),
            parts: Vec::new(),
            tracks,
            teleports: Teleports::default(),
            placed: Tally::default(),
        }
    }

    /// Marks the clip.
    pub fn set_teleports(&mut self, teleports: Teleports) {
        self.teleports = teleports;
    }

    /// Marks of the clip.
    pub fn teleports(&self) -> &Teleports {
        &self.teleports
    }

    /// Time of the first key \[s\].
    pub fn begin(&self) -> f64 {
        let first = self.tracks.iter().filter_map(|track| track.times.first().copied());
        first.reduce(f64::min).unwrap_or_default()
    }

    /// Time of the last key \[s\].
    pub fn end(&self) -> f64 {
        self.tracks.iter().filter_map(|track| track.times.last()).fold(0.0, |end, time| time.max(end))
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.parts.iter().map(|part| part.base.len()).sum()
    }

    /// Memory that the keys of the clip take.
    pub(super) fn keys(&self) -> Need {
        let bytes = self.tracks.iter().map(|track| 8 * track.times.len() + 4 * track.values.len());
        Need::new("the keys of the clip of the body", bytes.sum::<usize>() as u64, 1)
    }

    /// Memory that the parts of the shown nodes take at most; parts of more than `limit` vertices are refused later.
    pub(super) fn need(&self, shown: &[Node<'_>], limit: usize) -> Need {
        let of_part = |node: &Node<'_>, part: &Primitive<'_>| {
            let count =
                part.get(&Semantic::Positions).map_or(0, |accessor| accessor.count().min(limit) as u64);
            let sets = (0..).take_while(|set| part.get(&Semantic::Joints(*set)).is_some()).count() as u64;
            let targets = (0..part.morph_targets().count()).filter(|target| self.uses(node.index(), *target));
            // Deltas are read whole before those that are zero are dropped.
            count.saturating_mul(12 + 32 * sets + 28 * targets.count() as u64)
        };
        let of_node = |node: &Node<'_>| {
            let parts = node.mesh().into_iter().flat_map(|mesh| mesh.primitives().collect::<Vec<_>>());
            parts.map(|part| of_part(node, &part)).fold(0, u64::saturating_add)
        };
        Need::new("the clip of the body", shown.iter().map(of_node).fold(0, u64::saturating_add), 1)
    }

    /// True where a morph target of a node's mesh moves vertices at some time.
    fn uses(&self, node: usize, target: usize) -> bool {
        let is_track = |track: &Track| track.node == node && track.property == Property::Weights;
        self.weights[node].get(target).is_some_and(|weight| *weight != 0.0)
            || self.tracks.iter().any(is_track)
    }

    /// Adds the vertices of a part of a node's mesh.
    pub(super) fn add(
        &mut self,
        node: &Node<'_>,
        part: &Primitive<'_>,
        influences: Option<Influences>,
        buffers: &Buffers,
    ) -> Result<(), Refusal> {
        let Some(accessor) = part.get(&Semantic::Positions) else { return Ok(()) };
        let count = accessor.count();
        let base = buffers.vectors(&accessor, count)?;
        let (low, high) = base.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), place| {
            (low.min(place.as_dvec3()), high.max(place.as_dvec3()))
        });
        let middle = Some(0.5 * (low + high)).filter(|middle| middle.is_finite()).unwrap_or_default();
        let base = base.iter().map(|place| (place.as_dvec3() - middle).as_vec3()).collect();
        let mut targets = Vec::new();
        for (index, target) in part.morph_targets().enumerate() {
            let Some(deltas) = target.positions().filter(|_| self.uses(node.index(), index)) else {
                continue;
            };
            let deltas = buffers.vectors(&deltas, count)?;
            let moved = deltas.into_iter().enumerate().filter(|(_, delta)| *delta != Vec3::ZERO);
            targets.push((index, moved.map(|(vertex, delta)| (vertex as u32, delta)).collect()));
        }
        let skin = match node.skin().zip(influences) {
            Some((skin, influences)) => {
                if self.skins.len() <= skin.index() {
                    self.skins.resize(skin.index() + 1, None);
                }
                let slot = &mut self.skins[skin.index()];
                if slot.is_none() {
                    let joints = joints_of(&skin, buffers)?;
                    *slot = Some(joints.into_iter().map(|(joint, own)| (joint, own.as_dmat4())).collect());
                }
                Some((skin.index(), influences))
            }
            None => None,
        };
        self.parts.push(Part { node: node.index(), middle, base, targets, skin });
        Ok(())
    }

    /// Of some vertices those that move rigidly with the node that carries most of them, and that no morph target moves.
    pub fn rigid(&self, vertices: &[u32]) -> Vec<u32> {
        let mut carried = vec![0.0; self.rest.len()];
        let mut shares = Vec::new();
        for vertex in vertices {
            self.carriers(*vertex as usize, &mut shares);
            shares.iter().for_each(|(node, share)| carried[*node] += *share);
        }
        let most =
            (0..carried.len()).fold(0, |best, node| if carried[node] > carried[best] { node } else { best });
        let is_rigid = |vertex: &&u32| {
            self.carriers(**vertex as usize, &mut shares);
            let of_most = shares.iter().filter(|(node, _)| *node == most).map(|(_, share)| share);
            of_most.sum::<f32>() > RIGID
        };
        vertices.iter().filter(is_rigid).copied().collect()
    }

    /// The nodes that carry a vertex with their shares; none where a morph target moves it.
    fn carriers(&self, vertex: usize, shares: &mut Vec<(usize, f32)>) {
        shares.clear();
        let mut first = 0;
        let within = |part: &&Part| {
            let is_within = vertex < first + part.base.len();
            first += if is_within { 0 } else { part.base.len() };
            is_within
        };
        let Some(part) = self.parts.iter().find(within) else { return };
        let own = vertex - first;
        let is_moved = |(_, moved): &(usize, Vec<(u32, Vec3)>)| {
            moved.binary_search_by_key(&(own as u32), |(vertex, _)| *vertex).is_ok()
        };
        if part.targets.iter().any(is_moved) {
            return;
        }
        match &part.skin {
            Some((skin, influences)) => {
                let joints = self.skins[*skin].as_deref().unwrap_or_default();
                shares.extend(influences.shares(own).map(|(joint, share)| (joints[joint].0, share)));
            }
            None => shares.push((part.node, 1.0)),
        }
    }

    /// The first key \[s\] at which what a node carries is a mirror image of what it is at rest, and the node.
    pub(super) fn inside_out(&self) -> Option<(f64, String)> {
        let is_negative = |scale: &[f32]| scale.iter().product::<f32>() < 0.0;
        let scales = || self.tracks.iter().filter(|track| track.property == Property::Scale);
        let changes = |track: &Track| {
            let at_rest = self.rest[track.node].matrix().determinant() < 0.0;
            (0..track.times.len()).any(|key| is_negative(track.value(key)) != at_rest)
        };
        if !scales().any(changes) {
            return None;
        }
        let mut times: Vec<f64> = scales().flat_map(|track| &track.times).copied().collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let of_part = |part: &Part| match &part.skin {
            Some((skin, _)) => self.skins[*skin].iter().flatten().map(|(joint, _)| *joint).collect(),
            None => vec![part.node],
        };
        let carriers: Vec<usize> = self.parts.iter().flat_map(of_part).collect();
        let volumes = |time| self.pose(time, &self.teleports).world_from_node;
        let rest = volumes(None);
        times.iter().step_by(times.len().div_ceil(MOST_KEYS)).find_map(|time| {
            let now = volumes(Some(*time));
            let is_turned = |node: &&usize| now[**node].determinant() * rest[**node].determinant() < 0.0;
            let node = *carriers.iter().find(is_turned)?;
            let name = self.names[node].as_ref();
            Some((*time, name.map_or_else(|| format!("node {node}"), |name| format!("`{name}`"))))
        })
    }

    /// Spans \[s\] between two keys of a node that are far apart, the first ones of many.
    pub fn fast_spans(&self) -> Vec<[f64; 2]> {
        let mut spans = self.all_fast_spans();
        spans.truncate(self.most_spans());
        spans
    }

    /// The note on spans that are too many to be searched for jumps.
    pub(super) fn unsearched(&self) -> Option<String> {
        let (spans, most) = (self.all_fast_spans(), self.most_spans());
        let [from, _] = spans.get(most)?;
        Some(format!(
            "{} of {} spans between keys far apart are not searched for jumps, those from {from:.2} s on: marks in `teleports` \
             carry hair over jumps there",
            spans.len() - most,
            spans.len()
        ))
    }

    /// The number of spans that are searched for jumps.
    fn most_spans(&self) -> usize {
        (MOST_SAMPLED / (self.tracks.len() + self.rest.len()).max(1)).clamp(1, MOST_SPANS)
    }

    fn all_fast_spans(&self) -> Vec<[f64; 2]> {
        let mut spans: Vec<[f64; 2]> = self.tracks.iter().flat_map(Track::fast_spans).collect();
        spans.sort_by(|one, other| one[0].total_cmp(&other[0]).then(one[1].total_cmp(&other[1])));
        spans.dedup();
        spans
    }

    /// The number of the first node of a name.
    pub fn node(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|own| own.as_deref() == Some(name))
    }

    /// True where the clip has keys of a node or of one above it.
    pub fn moves(&self, node: usize) -> bool {
        let above =
            |node: usize| self.order.iter().find(|(own, _)| *own == node).and_then(|(_, above)| *above);
        std::iter::successors(Some(node), |node| above(*node)).any(|node| self.has_keys(node))
    }

    /// True where the clip has keys of the transform of a node.
    fn has_keys(&self, node: usize) -> bool {
        self.tracks.iter().any(|track| track.node == node && track.property != Property::Weights)
    }

    /// The names of nodes that have keys.
    pub fn moved_names(&self) -> impl Iterator<Item = &str> {
        let names = self.names.iter().enumerate().filter(|(node, _)| self.has_keys(*node));
        names.filter_map(|(_, name)| name.as_deref())
    }

    /// The names of nodes.
    pub fn node_names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().flatten().map(String::as_str)
    }

    /// Transform of a node into the world at a time of the clip \[s\]. Nothing is interpolated over marks.
    pub fn world_from_node(&self, node: usize, time: f64, teleports: &Teleports) -> DMat4 {
        self.pose(Some(time), teleports).world_from_node[node]
    }

    fn pose(&self, time: Option<f64>, teleports: &Teleports) -> Pose {
        let (mut locals, mut weights) = (self.rest.clone(), self.weights.clone());
        let mut value = Vec::new();
        for track in time.map_or(&[][..], |_| &self.tracks[..]) {
            track.sample(time.unwrap_or_default(), teleports, &mut value);
            match track.property {
                Property::Weights => weights[track.node].clone_from(&value),
                property => locals[track.node].set(property, &value),
            }
        }
        let mut world_from_node = vec![DMat4::IDENTITY; locals.len()];
        for (node, above) in &self.order {
            let world_from_above = above.map_or(DMat4::IDENTITY, |above| world_from_node[above]);
            world_from_node[*node] = world_from_above * locals[*node].matrix();
        }
        Pose { world_from_node, weights }
    }
}

impl Local {
    /// The transform of a node, in its parts where a clip moves one of them.
    fn of(transform: &Transform, is_moved: bool) -> Self {
        match transform {
            Transform::Matrix { matrix } if !is_moved => {
                Self::Matrix(Mat4::from_cols_array_2d(matrix).as_dmat4())
            }
            transform => {
                let (translation, rotation, scale) = transform.clone().decomposed();
                Self::Parts {
                    translation: Vec3::from(translation).as_dvec3(),
                    rotation: unit(DVec4::from_array(rotation.map(f64::from))),
                    scale: Vec3::from(scale).as_dvec3(),
                }
            }
        }
    }

    fn set(&mut self, property: Property, value: &[f64]) {
        let (Self::Parts { translation, rotation, scale }, [x, y, z, rest @ ..]) = (self, value) else {
            return;
        };
        match property {
            Property::Translation => *translation = DVec3::new(*x, *y, *z),
            Property::Scale => *scale = DVec3::new(*x, *y, *z),
            Property::Rotation => {
                *rotation = unit(DVec4::new(*x, *y, *z, rest.first().copied().unwrap_or_default()));
            }
            Property::Weights => {}
        }
    }

    fn matrix(&self) -> DMat4 {
        match *self {
            Self::Matrix(matrix) => matrix,
            Self::Parts { translation, rotation, scale } => {
                DMat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }
}
