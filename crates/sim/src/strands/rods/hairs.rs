//! Materials of the strands of a model: those of the settings, or of their group.

use std::collections::BTreeMap;
use std::sync::Arc;

use strandline_base::SettingError;
use strandline_groom::Guides;

use super::crowding::crowding;
use super::material::Section;
use super::rest::Former;
use super::settings::{GroupSettings, Rest, RodSettings};
use crate::SimError;

/// Properties of a hair that are constant along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Traits {
    /// Second bending stiffness and twisting stiffness over the first bending stiffness.
    pub bend_ratio: f32,
    pub twist_ratio: f32,
    /// Relaxation time of bends and twists \[s\].
    pub damping: f32,
    /// Share of the strand beside which others pass at rest.
    pub crowding: f32,
    /// Diameter \[m\] of a hair at the root, and over it at the tip; share of the length where it begins to taper.
    pub diameter: f32,
    pub tip: f32,
    pub taper_start: f32,
    /// Hairs that weigh and resist together.
    pub hairs: f32,
    /// Share of the section of a wisp that its hairs fill.
    pub packing: f32,
}

/// Material of a strand.
#[derive(Clone, Copy)]
struct Hair {
    section: Section,
    former: Former,
    damping: f32,
    /// \[m\]
    diameter: f32,
    hairs: f32,
    packing: f32,
}

impl Hair {
    fn new(rods: &RodSettings) -> Self {
        let material = rods.material();
        Self {
            section: material.section(),
            former: match rods.rest {
                Rest::SagFree | Rest::Unstressed => Former::SAME,
                Rest::Dry => Former::new(&rods.dry().material().section(), &material.section()),
            },
            damping: rods.damping,
            diameter: material.diameter() as f32,
            hairs: material.hairs as f32,
            packing: rods.packing,
        }
    }
}

/// Materials of all strands.
#[derive(Clone)]
pub(crate) struct Hairs {
    /// Group of each strand, shape `[strand]`; empty where the groom has none.
    groups: Vec<u32>,
    names: BTreeMap<u32, String>,
    hair: Hair,
    /// Crowding of each strand at rest, 0 to 1.
    crowding: Arc<[f32]>,
    /// Materials of groups that have their own.
    own: BTreeMap<u32, Hair>,
}

impl Hairs {
    /// Materials of the strands of guides, by the settings of all and those of single groups.
    ///
    /// # Errors
    /// Settings of a group that the guides do not have.
    pub fn new(guides: &Guides, rods: &RodSettings, groups: &[GroupSettings]) -> Result<Self, SimError> {
        let strands = Self {
            groups: guides.groups().map_or_else(Vec::new, <[u32]>::to_vec),
            names: guides.group_names().clone(),
            hair: Hair::new(rods),
            crowding: crowding(guides).into(),
            own: BTreeMap::new(),
        };
        strands.changed(rods, groups)
    }

    /// The same strands under other settings.
    ///
    /// # Errors
    /// As [`Hairs::new`].
    pub fn changed(&self, rods: &RodSettings, groups: &[GroupSettings]) -> Result<Self, SimError> {
        let mut own = BTreeMap::new();
        for (index, group) in groups.iter().enumerate() {
            let numbers = self.numbers(&group.group);
            if numbers.is_empty() {
                let key = format!("simulation.groups[{index}].group");
                return Err(SettingError::new(key, format!("`{}`", group.group), self.expected()).into());
            }
            let hair = Hair::new(&rods.of_group(group));
            // The first of two settings of one group counts, as with looks.
            numbers.into_iter().for_each(|number| _ = own.entry(number).or_insert(hair));
        }
        Ok(Self { hair: Hair::new(rods), own, ..self.clone() })
    }

    /// The section of a strand.
    pub fn section(&self, strand: usize) -> Section {
        self.hair(strand).section
    }

    /// The hair of a strand when it took the groom's shape.
    pub fn former(&self, strand: usize) -> Former {
        self.hair(strand).former
    }

    /// Properties of a strand's hair that are constant along it.
    pub fn traits(&self, strand: usize) -> Traits {
        let Hair { section, damping, diameter, hairs, packing, .. } = self.hair(strand);
        Traits {
            bend_ratio: (section.bend[1] / section.bend[0]) as f32,
            twist_ratio: (section.twist / section.bend[0]) as f32,
            damping,
            crowding: self.crowding[strand],
            diameter,
            tip: section.along.tip as f32,
            taper_start: section.along.start as f32,
            hairs,
            packing,
        }
    }

    fn hair(&self, strand: usize) -> Hair {
        *self.groups.get(strand).and_then(|group| self.own.get(group)).unwrap_or(&self.hair)
    }

    /// Mass of a point over that of the same lengths of even hair of the settings' own material. `length` gives
    /// the length \[m\] behind each of the strand's points.
    pub fn weight(&self, strand: usize, point: usize, points: usize, length: impl Fn(usize) -> f32) -> f32 {
        let section = self.section(strand);
        let of_group = section.mass / self.hair.section.mass;
        if section.along.tip == 1.0 {
            return of_group as f32;
        }
        let length = |index: usize| f64::from(length(index));
        let sum = |end: usize| (0..end).map(length).sum::<f64>();
        let (passed, total) = (sum(point), sum(points - 1));
        let (before, after) = (
            if point > 0 { length(point - 1) } else { 0.0 },
            if point + 1 < points { length(point) } else { 0.0 },
        );
        let weight = |from: f64, length: f64| length * section.along.weight((from + 0.5 * length) / total);
        (of_group * (weight(passed - before, before) + weight(passed, after)) / (before + after)) as f32
    }

    /// A number that differs where the masses of the strands do, as rods or at a constant mass per length \[kg/m\].
    pub fn key(&self, line_density: f32, has_rods: bool) -> u64 {
        let numbers =
            |section: &Section| [section.mass, section.along.tip, section.along.start].map(f64::to_bits);
        let own = self
            .own
            .iter()
            .flat_map(|(group, hair)| std::iter::once(u64::from(*group)).chain(numbers(&hair.section)));
        let first = [u64::from(line_density.to_bits()), u64::from(has_rods)];
        // The hash of Fowler, Noll and Vo, over 64-bit numbers.
        let mix = |key: u64, number: u64| (key ^ number).wrapping_mul(0x0100_0000_01b3);
        first.into_iter().chain(numbers(&self.hair.section)).chain(own).fold(0xcbf2_9ce4_8422_2325, mix)
    }

    /// Group numbers for a name; a numeric string is a group number itself.
    fn numbers(&self, group: &str) -> Vec<u32> {
        let named = self.names.iter().filter(|(_, name)| *name == group).map(|(number, _)| *number);
        let mut numbers: Vec<u32> = named.collect();
        if numbers.is_empty() {
            numbers.extend(group.parse::<u32>());
        }
        numbers.retain(|number| self.groups.contains(number));
        numbers
    }

    /// Groups of the groom, for an error message.
    fn expected(&self) -> String {
        let mut numbers = self.groups.clone();
        numbers.sort_unstable();
        numbers.dedup();
        let name = |number: &u32| self.names.get(number).cloned().unwrap_or_else(|| number.to_string());
        let some: Vec<String> = numbers.iter().take(20).map(name).collect();
        match some.len() {
            0 => "no group: the groom has none".to_owned(),
            _ if numbers.len() > some.len() => format!("a group of the groom, {} and more", some.join(", ")),
            _ => format!("a group of the groom: {}", some.join(", ")),
        }
    }
}
