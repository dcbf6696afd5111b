//! Strands that are written, and their attributes. The one place to add an
//! attribute: fill it in [`Shape::new`]; the writers take all that is there.

use glam::Vec3;
use strandline_base::{choices, in_strand_order};

use crate::{
    BoundStrands, Error, Scene,
    body::BodyFrame,
    groom::{Guides, MOST_INFLUENCES, Vec3Lanes, format::MAX_POINTS},
    render::{DetailLevel, Growth, Look},
    strands::tags::Tags,
};

choices! {
    /// Strands that are written.
    pub enum What as "what" {
        /// Those that are simulated.
        Guides = "guides",
        /// All that pictures draw, in full detail.
        Strands = "strands",
    }
    default Guides
}

choices! {
    /// For whom units and axes are chosen, where a format leaves the choice.
    pub enum Target as "for" {
        /// Metres, y up.
        Any = "any",
        /// Centimetres, z up, groom_* attributes.
        Unreal = "unreal",
        /// Metres, z up.
        Blender = "blender",
    }
    default Any
}

/// Attributes of the strands of a file; each where the groom has it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Attributes {
    /// Diameters \[m\], shape `[point]`.
    pub widths: Option<Vec<f32>>,
    /// Linear RGB, shape `[point]`.
    pub colors: Option<Vec<[f32; 3]>>,
    /// Coordinates of each root on the scalp, 0 to 1, shape `[strand]`.
    pub root_uvs: Option<Vec<[f32; 2]>>,
    /// The group of each strand, shape `[strand]`, and the groups' names.
    pub groups: Option<Vec<u16>>,
    pub group_names: Vec<String>,
    /// True for strands that are guides, shape `[strand]`, where others hang on them.
    pub guide_flags: Option<Vec<bool>>,
    /// The strands that guides carry.
    pub binding: Option<Binding>,
}

/// Binding of strands to guides: in a file of guides of those that are not in it, in a file of all strands of each.
/// Guides are strands of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Binding {
    /// Guides of a strand.
    pub guides_per_strand: usize,
    /// Shape `[bound strand][guide]`.
    pub indices: Vec<u32>,
    pub weights: Vec<f32>,
    /// The bound strands at rest \[m\], head space, and the first point of each; none in a file of all strands.
    pub points: Vec<Vec3>,
    pub starts: Vec<u32>,
}

/// The strands that are written.
pub(crate) struct Shape {
    pub what: What,
    /// First point of each strand, then the number of points.
    pub starts: Vec<u32>,
    pub attributes: Attributes,
    source: Source,
}

/// Source of points.
enum Source {
    Guides { points_per_strand: usize },
    Strands(Box<GrownStrands>),
}

/// Strands as pictures grow them.
struct GrownStrands {
    growth: Growth,
    look: Look,
    level: DetailLevel,
}

/// The hair of a scene that may leave.
#[derive(Clone, Copy)]
pub(crate) struct Leaving<'a> {
    /// The simulated strands.
    pub guides: &'a Guides,
    /// All strands, where some are not simulated.
    pub bound: Option<&'a BoundStrands>,
    pub tags: &'a Tags,
    /// Body at the beginning of the film.
    pub body: &'a BodyFrame,
}

impl Shape {
    /// The strands of a scene.
    ///
    /// # Errors
    /// More points than a file may have. (The memory of drawn strands was asked for with the scene.)
    pub fn new(what: What, scene: &Scene, leaving: Leaving) -> Result<Self, Error> {
        match what {
            What::Guides => Ok(Self::of_guides(leaving)),
            What::Strands => Self::of_strands(scene, leaving),
        }
    }

    fn of_guides(Leaving { guides, bound, tags, .. }: Leaving) -> Self {
        let (strands, points) = (guides.strand_count(), guides.points_per_strand());
        let share = |point: usize| guides.profiles().map_or(1.0, |profiles| profiles[point]);
        let widths = (0..strands * points).map(|point| guides.widths()[point / points] * share(point));
        let attributes = Attributes {
            widths: Some(widths.collect()),
            colors: guides.colors().map(<[_]>::to_vec),
            binding: bound.map(|bound| carried(bound, tags)),
            ..Attributes::default()
        };
        Self {
            what: What::Guides,
            starts: starts(strands, points),
            attributes: attributes.with(tags.of_guides()),
            source: Source::Guides { points_per_strand: points },
        }
    }

    fn of_strands(scene: &Scene, Leaving { guides, bound, tags, .. }: Leaving) -> Result<Self, Error> {
        let level =
            DetailLevel::full(scene.level_of_detail.segments_per_span, scene.look.follow_strands.max(1));
        let all = bound.map_or(guides, BoundStrands::strands);
        let points = level.segment_count(all.points_per_strand()) + 1;
        let strands = all.strand_count() * level.strand_count();
        if (strands as u64).saturating_mul(points as u64) > MAX_POINTS {
            let found = format!("{} strands on each of {}", level.strand_count(), all.strand_count());
            let expected = "268435456 points in all at most: take fewer look.follow_strands";
            return Err(strandline_base::SettingError::new("what = strands", found, expected).into());
        }
        let growth = match bound {
            Some(bound) => Growth::bound(bound.binding(), bound.solids()),
            None => Growth::new(guides),
        };
        let mut drawn = GrownStrands { growth, look: scene.look.clone(), level };
        let grown = drawn.growth.at(guides.positions(), &BodyFrame::REST, &drawn.look, &level);
        // The strands of a clump share their colours.
        let colors = grown.colors.chunks_exact(points).flat_map(|colors| {
            std::iter::repeat_n(colors, level.strand_count()).flatten().map(|color| color.to_array())
        });
        let attributes = Attributes {
            widths: Some(grown.widths.clone()),
            colors: (!grown.colors.is_empty()).then(|| colors.collect()),
            ..hanging(bound, tags, level.strand_count())
        };
        Ok(Self {
            what: What::Strands,
            starts: starts(strands, points),
            attributes: attributes.with(tags.repeated(level.strand_count())),
            source: Source::Strands(drawn.into()),
        })
    }

    /// Number of strands.
    pub fn strand_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of points.
    pub fn point_count(&self) -> usize {
        self.starts.last().map_or(0, |points| *points as usize)
    }

    /// Fills `points` \[m\] with the strands of guides that are somewhere, shape `[block][point]` of lanes.
    pub fn place(&mut self, positions: &[Vec3Lanes], body: &BodyFrame, points: &mut Vec<Vec3>) {
        points.clear();
        let strand_count = self.strand_count();
        match &mut self.source {
            Source::Guides { points_per_strand: each } => {
                points.extend(in_strand_order(positions, strand_count, *each));
            }
            Source::Strands(drawn) => {
                let GrownStrands { growth, look, level } = &mut **drawn;
                let grown = growth.at(positions, body, look, level);
                points.extend_from_slice(&grown.positions);
            }
        }
    }
}

impl Attributes {
    fn with(self, tags: Tags) -> Self {
        let Tags { root_uvs, groups, group_names, guides: _ } = tags;
        Self { root_uvs, groups, group_names, ..self }
    }
}

/// Guides and weights of all strands, of which each stands for `clump` of the file, itself the first.
fn hanging(bound: Option<&BoundStrands>, tags: &Tags, clump: usize) -> Attributes {
    let Some((bound, guides)) = bound.zip(tags.guides.as_ref()) else { return Attributes::default() };
    let influences = bound.binding().influences();
    let each = || influences.iter().flat_map(|one| std::iter::repeat_n(one, clump)).flatten();
    let mut flags = vec![false; influences.len() * clump];
    guides.iter().for_each(|guide| flags[guide * clump] = true);
    Attributes {
        guide_flags: Some(flags),
        binding: Some(Binding {
            guides_per_strand: MOST_INFLUENCES,
            indices: each().map(|one| (guides[one.guide as usize] * clump) as u32).collect(),
            weights: each().map(|one| one.weight).collect(),
            ..Binding::default()
        }),
        ..Attributes::default()
    }
}

/// The strands that are not simulated, at rest, and the guides that carry each.
fn carried(bound: &BoundStrands, tags: &Tags) -> Binding {
    let (strands, binding) = (bound.strands(), bound.binding());
    let points = strands.points_per_strand();
    let is_guide =
        |strand: &usize| tags.guides.as_ref().is_some_and(|guides| guides.binary_search(strand).is_ok());
    let others: Vec<usize> = (0..strands.strand_count()).filter(|strand| !is_guide(strand)).collect();
    let influences = || others.iter().flat_map(|strand| binding.influences()[*strand]);
    let rest = others.iter().flat_map(|strand| (0..points).map(|point| strands.position(*strand, point)));
    Binding {
        guides_per_strand: MOST_INFLUENCES,
        indices: influences().map(|one| one.guide).collect(),
        weights: influences().map(|one| one.weight).collect(),
        points: rest.collect(),
        starts: starts(others.len(), points),
    }
}

fn starts(strands: usize, points: usize) -> Vec<u32> {
    (0..=strands).map(|strand| (strand * points) as u32).collect()
}
