//! Grooms made of strands of others: a selection, or the union of two.

use std::path::Path;

use glam::Vec3;

use crate::{Groom, Widths};

impl Groom {
    /// The strands that a choice by index keeps, in their order.
    pub fn kept(&self, keep: impl Fn(usize) -> bool) -> Self {
        let strands: Vec<usize> = (0..self.strand_count()).filter(|strand| keep(*strand)).collect();
        self.select(&strands)
    }

    /// As [`Self::kept`], with the numbers that the strands have in their file.
    pub(crate) fn left_of_file(mut self, keep: impl Fn(usize) -> bool) -> Self {
        self.number_strands();
        self.kept(keep)
    }

    /// Gives each strand its number in its file, before strands are left out or added.
    pub fn number_strands(&mut self) {
        let count = self.strand_count() as u32;
        self.numbers.get_or_insert_with(|| (0..count).collect());
    }

    /// The number of a strand in its file, from 0.
    pub fn number(&self, strand: usize) -> usize {
        self.origin(strand).0
    }

    /// The number of a strand in its file, from 0, and the file where the groom was read from several.
    pub(crate) fn origin(&self, strand: usize) -> (usize, Option<&Path>) {
        let numbers = self.numbers.as_deref().unwrap_or_default();
        let number = numbers.get(strand).map_or(strand, |number| *number as usize);
        match self.files.range(..=number as u32).next_back() {
            Some((first, file)) => (number - *first as usize, Some(file)),
            None => (number, None),
        }
    }

    /// A strand in a note: its number in its file, with the file where the groom was read from several.
    pub(crate) fn numbered(&self, strand: usize) -> String {
        match self.origin(strand) {
            (number, Some(file)) => format!("{number} of {}", file.display()),
            (number, None) => number.to_string(),
        }
    }

    /// Gives strands of several files the numbers that they have in their own, which no longer name the files.
    fn leave_files(&mut self) {
        if !self.files.is_empty() {
            self.numbers = Some((0..self.strand_count()).map(|strand| self.number(strand) as u32).collect());
            self.files.clear();
        }
    }

    /// Some strands by their indices, in the order given, with everything that they have.
    pub fn select(&self, strands: &[usize]) -> Self {
        let mut groom = Self::empty(0.0);
        groom.starts.reserve(strands.len());
        groom.points.reserve(strands.iter().map(|strand| self.range(*strand).len()).sum());
        for strand in strands {
            groom.push(self.strand(*strand).iter().copied());
        }
        groom.widths = match &self.widths {
            Widths::Constant(width) => Widths::Constant(*width),
            Widths::PerStrand(widths) => Widths::PerStrand(per_strand(strands, widths)),
            Widths::PerPoint(widths) => Widths::PerPoint(self.per_point(strands, widths)),
        };
        groom.root_uvs = self.root_uvs.as_ref().map(|all| per_strand(strands, all));
        groom.root_normals = self.root_normals.as_ref().map(|all| per_strand(strands, all));
        groom.groups = self.groups.as_ref().map(|all| per_strand(strands, all));
        groom.group_names.clone_from(&self.group_names);
        groom.guide_flags = self.guide_flags.as_ref().map(|all| per_strand(strands, all));
        groom.influences = self.influences.as_ref().map(|all| all.select(strands));
        groom.colors = self.colors.as_ref().map(|all| self.per_point(strands, all));
        groom.transparencies = self.transparencies.as_ref().map(|all| self.per_point(strands, all));
        groom.masses = self.masses.as_ref().map(|all| self.per_point(strands, all));
        groom.velocities = self.velocities.as_ref().map(|all| self.per_point(strands, all));
        let numbers = match &self.numbers {
            Some(all) => Some(per_strand(strands, all)),
            // Of several files each strand keeps the number among all of them.
            None => (!self.files.is_empty()).then(|| strands.iter().map(|&strand| strand as u32).collect()),
        };
        let is_counted =
            |all: &Vec<u32>| all.iter().enumerate().all(|(strand, number)| *number as usize == strand);
        groom.numbers = numbers.filter(|all| !is_counted(all));
        groom.files.clone_from(&self.files);
        groom
    }

    /// The same strands without some of their points, with everything that the others have; shape of `is_kept`
    /// `[point]`.
    pub(crate) fn with_points(mut self, is_kept: &[bool]) -> Self {
        fn keep<T>(values: &mut Vec<T>, is_kept: &[bool]) {
            let mut kept = is_kept.iter();
            values.retain(|_| kept.next().is_none_or(|kept| *kept));
        }
        let ends = (0..self.strand_count()).scan(0, |sum, strand| {
            *sum += is_kept[self.range(strand)].iter().filter(|kept| **kept).count() as u32;
            Some(*sum)
        });
        self.starts = std::iter::once(0).chain(ends).collect();
        keep(&mut self.points, is_kept);
        if let Widths::PerPoint(widths) = &mut self.widths {
            keep(widths, is_kept);
        }
        self.colors.iter_mut().for_each(|all| keep(all, is_kept));
        self.transparencies.iter_mut().for_each(|all| keep(all, is_kept));
        self.masses.iter_mut().for_each(|all| keep(all, is_kept));
        self.velocities.iter_mut().for_each(|all| keep(all, is_kept));
        self
    }

    /// Adds the strands of another groom behind these. Attributes of only one of the two are lost, but for widths and
    /// names of groups.
    pub fn append(&mut self, mut other: Self) {
        self.leave_files();
        other.leave_files();
        match &mut self.widths {
            Widths::PerPoint(own) => own.extend(other.point_widths()),
            _ => self.widths = self.joined_widths(&other),
        }
        let strands = self.strand_count();
        let first = self.points.len() as u32;
        self.starts.extend(other.starts[1..].iter().map(|start| first + start));
        self.points.extend(other.points);
        join(&mut self.root_uvs, other.root_uvs);
        join(&mut self.root_normals, other.root_normals);
        join(&mut self.groups, other.groups);
        self.group_names.extend(other.group_names);
        join(&mut self.guide_flags, other.guide_flags);
        self.influences = self.influences.take().zip(other.influences).map(|(mut one, two)| {
            one.append(two, strands);
            one
        });
        join(&mut self.colors, other.colors);
        join(&mut self.transparencies, other.transparencies);
        join(&mut self.masses, other.masses);
        join(&mut self.velocities, other.velocities);
        join(&mut self.numbers, other.numbers);
    }

    fn joined_widths(&self, other: &Self) -> Widths {
        match (&self.widths, &other.widths) {
            (Widths::Constant(one), Widths::Constant(two)) if one == two => Widths::Constant(*one),
            (_, Widths::PerPoint(_)) => {
                Widths::PerPoint(self.point_widths().chain(other.point_widths()).collect())
            }
            _ => Widths::PerStrand(self.root_widths().chain(other.root_widths()).collect()),
        }
    }

    /// Diameter \[m\] at every point.
    pub fn point_widths(&self) -> impl Iterator<Item = f32> + '_ {
        let strands = 0..self.strand_count();
        strands.flat_map(move |strand| self.range(strand).map(move |point| self.widths.at(strand, point)))
    }

    /// Diameter \[m\] at every root.
    pub fn root_widths(&self) -> impl Iterator<Item = f32> + '_ {
        (0..self.strand_count()).map(|strand| self.widths.at(strand, self.starts[strand] as usize))
    }

    /// The roots \[m\].
    pub fn roots(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.starts[..self.strand_count()].iter().map(|start| self.points[*start as usize])
    }

    fn per_point<T: Copy>(&self, strands: &[usize], values: &[T]) -> Vec<T> {
        strands.iter().flat_map(|strand| &values[self.range(*strand)]).copied().collect()
    }
}

fn per_strand<T: Copy>(strands: &[usize], values: &[T]) -> Vec<T> {
    strands.iter().map(|strand| values[*strand]).collect()
}

fn join<T>(one: &mut Option<Vec<T>>, two: Option<Vec<T>>) {
    *one = one.take().zip(two).map(|(mut one, two)| {
        one.extend(two);
        one
    });
}
