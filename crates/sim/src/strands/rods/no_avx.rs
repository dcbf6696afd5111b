//! In the place of `avx` on processors of other kinds.

use strandline_groom::Vec3Lanes;
use wide::f32x8;

use super::pull::Pull;
use super::real::Vector;
use super::rod::{Node, Solved, StepSettings, Work};
use super::rounds::{Push, Turned};

/// There is none.
#[derive(Clone)]
pub(crate) enum Avx {}

impl Avx {
    /// None.
    pub(crate) fn new(_points: usize) -> Option<Self> {
        None
    }

    /// Not called, since there is none.
    pub(crate) fn solve(
        &mut self,
        _work: &mut Work<f32x8>,
        _rod: &[Node<f32x8>],
        _pulls: &mut [Pull<f32x8>],
        _settings: &StepSettings<f32x8>,
    ) -> Solved<f32x8> {
        match *self {}
    }

    /// Not called.
    pub(crate) fn prepare(
        &mut self,
        _work: &mut Work<f32x8>,
        _rod: &[Node<f32x8>],
        _pulls: &[Pull<f32x8>],
        _viscous: f32x8,
    ) {
        match *self {}
    }

    /// Not called.
    pub(crate) fn set_tension(&mut self, _segment: usize, _tension: f32x8) {
        match *self {}
    }

    /// Not called.
    pub(crate) fn tension(&self, _segment: usize) -> f32x8 {
        match *self {}
    }

    /// Not called.
    pub(crate) fn push(
        &mut self,
        _work: &mut Work<f32x8>,
        _pushes: &[Push<f32x8>],
        _settings: &StepSettings<f32x8>,
        _first: bool,
        _open: [f32x8; 2],
    ) -> Turned<f32x8> {
        match *self {}
    }

    /// Not called.
    pub(crate) fn set_held(&mut self, _held: &[Vector<f32x8>]) {
        match *self {}
    }

    /// Not called.
    pub(crate) fn round(&mut self, _forces: &[Vec3Lanes], _whole: f32x8, _ways: &mut [Vec3Lanes]) {
        match *self {}
    }

    /// Not called.
    pub(crate) fn settle(&mut self, _open: f32x8) {
        match *self {}
    }

    /// Not called.
    pub(crate) fn give(&self, _work: &mut Work<f32x8>, _pulls: &mut [Pull<f32x8>]) {
        match *self {}
    }

    /// Not called.
    pub(crate) fn set_loaded(&mut self, _loaded: f32x8) {
        match *self {}
    }

    /// Not called.
    pub(crate) fn loaded(&self) -> f32x8 {
        match *self {}
    }
}
