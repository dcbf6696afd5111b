//! The strands of one prim of curves.

use glam::{Vec2, Vec3};

use super::super::bytes::Source;
use super::super::{MAX_POINTS, MAX_POINTS_PER_STRAND, MAX_STRANDS};
use super::text::{Prim, Value};
use crate::{Groom, GroomError, Widths};

/// Kind of the curve by which control points become points of strands.
#[derive(Clone, Copy, PartialEq)]
enum Curve {
    /// Each control point is one: linear, and Catmull-Rom with pinned ends.
    Points,
    /// Each but the first and the last: Catmull-Rom.
    Inner,
    /// Cubic pieces of four, each next one from the last point of the one before.
    Bezier,
    /// Means of three neighbours, with the ends where they are.
    PinnedSpline,
    /// Means of three neighbours, without ends.
    Spline,
}

impl Curve {
    fn of(prim: &Prim) -> Self {
        let says = |name: &str, word: &str| matches!(prim.properties.get(name), Some(Value::Texts(texts)) if texts.first().is_some_and(|text| text == word));
        let is_pinned = says("wrap", "pinned");
        if says("type", "linear") {
            Self::Points
        } else if says("basis", "catmullRom") {
            if is_pinned { Self::Points } else { Self::Inner }
        } else if says("basis", "bspline") {
            if is_pinned { Self::PinnedSpline } else { Self::Spline }
        } else {
            Self::Bezier
        }
    }

    /// Control points at the ends that are no points of the strand.
    fn margin(self) -> usize {
        usize::from(matches!(self, Self::Inner | Self::Spline))
    }

    /// The point of a strand at a control point.
    fn at(self, own: &[Vec3], index: usize) -> Vec3 {
        let last = own.len() - 1;
        let mean = |before: Vec3, after: Vec3| (before + 4.0 * own[index] + after) / 6.0;
        match self {
            Self::Points | Self::Inner => own[index],
            Self::PinnedSpline if index == 0 || index == last => own[index],
            Self::PinnedSpline | Self::Spline => mean(own[index - 1], own[index + 1]),
            Self::Bezier => {
                let first = 3 * (index / 3);
                let Some(&[a, b, c, d]) = own.get(first..first + 4) else { return own[index] };
                let t = (index % 3) as f32 / 3.0;
                let ab_bc_cd = [a.lerp(b, t), b.lerp(c, t), c.lerp(d, t)];
                ab_bc_cd[0].lerp(ab_bc_cd[1], t).lerp(ab_bc_cd[1].lerp(ab_bc_cd[2], t), t)
            }
        }
    }
}

/// The strands of a prim, in its own space; widths are diameters.
pub(super) fn groom(
    source: &Source,
    prim: &Prim,
    frame: Option<u32>,
    problems: &mut Vec<String>,
) -> Result<Groom, GroomError> {
    let numbers = |name: &str| match prim.properties.get(name) {
        Some(Value::Numbers(numbers)) => Some(&numbers[..]),
        _ => None,
    };
    let lacks =
        |name: &str| source.error(format!("curves `{}` without `{name}`", prim.name), "both of each curve");
    let counts = numbers("curveVertexCounts").ok_or_else(|| lacks("curveVertexCounts"))?;
    let points = numbers("points").ok_or_else(|| lacks("points"))?;
    let controls: Vec<Vec3> = points
        .chunks_exact(3)
        .map(|point| Vec3::from_array([0, 1, 2].map(|axis| point[axis] as f32)))
        .collect();
    let is_no_count =
        |count: &&f64| !(count.fract() == 0.0 && (1.0..=MAX_POINTS_PER_STRAND as f64).contains(*count));
    if let Some(count) = counts.iter().find(is_no_count) {
        return Err(
            source.error(format!("a curve of {count} points"), format!("1 to {MAX_POINTS_PER_STRAND}"))
        );
    }
    let sum: f64 = counts.iter().sum();
    if counts.len() as u64 > MAX_STRANDS || controls.len() as u64 > MAX_POINTS || sum != controls.len() as f64
    {
        let found = format!("{} curves of {sum} points in all, and {} points", counts.len(), controls.len());
        return Err(source.error(found, "as many points as the curves have"));
    }
    let curve = Curve::of(prim);
    let mut groom = Groom::empty(0.0);
    // The control point of each point.
    let mut of_points = Vec::with_capacity(controls.len());
    let mut start = 0;
    for count in counts {
        let own = &controls[start..start + *count as usize];
        let range = curve.margin()..own.len().saturating_sub(curve.margin()).max(curve.margin());
        groom.push(range.clone().map(|index| curve.at(own, index)));
        of_points.extend(range.map(|index| start + index));
        start += own.len();
    }
    if prim.samples > 1 {
        let (count, name) = (prim.samples, &prim.name);
        problems.push(match frame {
            None => format!("the first of {count} times of `{name}` is read"),
            Some(frame) => format!("of {count} times of `{name}` the last up to time code {frame} is read"),
        });
    }
    let (strands, controls) = (groom.strand_count(), controls.len());
    Attributes { prim, strands, of_points: &of_points, controls, problems }.take(&mut groom);
    Ok(groom)
}

/// A primvar with its indices resolved, `size` numbers each.
fn primvar(prim: &Prim, names: &[&str], size: usize) -> Option<Vec<f32>> {
    names.iter().find_map(|name| {
        let Some(Value::Numbers(numbers)) = prim.properties.get(*name) else { return None };
        let single = |number: &f64| *number as f32;
        match prim.properties.get(&format!("{name}:indices")) {
            Some(Value::Numbers(indices)) => {
                let element = |index: &f64| {
                    // -1 stands for no value.
                    let first = (*index >= 0.0).then(|| (*index as usize).min(numbers.len()) * size)?;
                    numbers.get(first..first + size)
                };
                let found: Option<Vec<&[f64]>> = indices.iter().map(element).collect();
                Some(found?.into_iter().flatten().map(single).collect())
            }
            _ => Some(numbers.iter().map(single).collect()),
        }
    })
}

/// Values of an attribute by the number that there is: one for all, for each strand, or for each control point.
enum Spread<T> {
    All(T),
    Strands(Vec<T>),
    Points(Vec<T>),
}

/// Attributes of the strands of a prim.
struct Attributes<'a> {
    prim: &'a Prim,
    strands: usize,
    /// The control point of each point, and the number of control points.
    of_points: &'a [usize],
    controls: usize,
    problems: &'a mut Vec<String>,
}

impl Attributes<'_> {
    /// Adds a note on values that are not read.
    fn refuse(&mut self, name: &str, found: usize) {
        let (prim, strands, controls) = (&self.prim.name, self.strands, self.controls);
        let note = format!(
            "{name} of `{prim}` are not read: {found} values for {strands} curves of {controls} points"
        );
        self.problems.push(note);
    }

    /// Values of `N` numbers, by their count; a note where it is none of the curves.
    fn spread<const N: usize>(&mut self, name: &str, names: &[&str]) -> Option<Spread<[f32; N]>> {
        let values = primvar(self.prim, names, N)?;
        let values = values.as_chunks().0.to_vec();
        match values.len() {
            1 => Some(Spread::All(values[0])),
            count if count == self.strands => Some(Spread::Strands(values)),
            count if count == self.controls => {
                Some(Spread::Points(self.of_points.iter().map(|point| values[*point]).collect()))
            }
            count => {
                self.refuse(name, count);
                None
            }
        }
    }

    /// Values of `N` numbers of each strand, of those of points the root's.
    fn of_strands<const N: usize>(
        &mut self,
        name: &str,
        names: &[&str],
        groom: &Groom,
    ) -> Option<Vec<[f32; N]>> {
        Some(match self.spread(name, names)? {
            Spread::Strands(values) => values,
            Spread::All(value) => vec![value; self.strands],
            Spread::Points(values) => {
                let root = |start: &u32| values.get(*start as usize).copied().unwrap_or([0.0; N]);
                groom.starts[..self.strands].iter().map(root).collect()
            }
        })
    }

    /// Takes widths, colours, root coordinates and groups.
    fn take(mut self, groom: &mut Groom) {
        let strands = self.strands;
        let widths = self.spread("widths", &["widths", "primvars:widths", "primvars:groom_width"]);
        groom.widths = match widths {
            None => Widths::Constant(0.0),
            Some(Spread::All([width])) => Widths::Constant(width),
            Some(Spread::Strands(widths)) => Widths::PerStrand(widths.into_iter().flatten().collect()),
            Some(Spread::Points(widths)) => Widths::PerPoint(widths.into_iter().flatten().collect()),
        };
        let colors = self.spread("colours", &["primvars:displayColor", "primvars:groom_color"]);
        groom.colors = colors.map(|colors| match colors {
            Spread::All(color) => vec![color; groom.points.len()],
            Spread::Strands(colors) => {
                let of_strand =
                    |strand: usize| std::iter::repeat_n(colors[strand], groom.range(strand).len());
                (0..strands).flat_map(of_strand).collect()
            }
            Spread::Points(colors) => colors,
        });
        const UVS: [&str; 3] = ["primvars:st", "primvars:groom_root_uv", "primvars:surface_uv_coordinate"];
        let uvs = self.of_strands("root coordinates", &UVS, groom);
        groom.root_uvs = uvs.map(|uvs| uvs.into_iter().map(Vec2::from_array).collect());
        let groups = self.of_strands("groups", &["primvars:group_id", "primvars:groom_group_id"], groom);
        groom.groups = groups.map(|groups| groups.into_iter().map(|[group]| group as u32).collect());
        let names = ["primvars:group_name", "primvars:groom_group_name"];
        let names = names.map(|name| self.prim.properties.get(name));
        if let (Some(Value::Texts(names)), Some(groups)) = (names[0].or(names[1]), &groom.groups) {
            if names.len() == strands {
                let named = groups.iter().copied().zip(names.iter().cloned());
                groom.group_names = named.filter(|(_, name)| !name.is_empty()).collect();
            } else {
                self.refuse("names of groups", names.len());
            }
        }
    }
}
