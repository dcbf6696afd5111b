//! Drawn strands by themselves, for files of what pictures show.

use std::sync::Arc;

use strandline_body::{BodyFrame, Solids};
use strandline_groom::{Binding, Guides, Vec3Lanes};

use super::bind::{Carried, bind, drawn_points};
use super::interpolate::interpolate;
use super::keep_outside;
use super::tessellate::{Curves, tessellate};
use crate::strands::Strands;
use crate::strands::roots::RootTurns;
use crate::{DetailLevel, Look};

/// Grows the strands that pictures draw of a groom, in some detail; keeps its memory from call to call.
#[derive(Clone, Debug)]
pub struct Growth {
    guides: Guides,
    carried: Option<Carried>,
    turns: RootTurns,
    curves: Curves,
    strands: Strands,
}

impl Growth {
    /// Growth about strands at rest, head space.
    pub fn new(guides: &Guides) -> Self {
        Self {
            guides: guides.clone(),
            carried: None,
            turns: RootTurns::default(),
            curves: Curves::default(),
            strands: Strands::default(),
        }
    }

    /// Growth about the strands of a binding, which guides carry; all that is drawn of them stays out of the solids.
    pub fn bound(binding: &Arc<Binding>, solids: &Solids) -> Self {
        let carried = Carried::new(binding.clone(), solids.clone());
        Self { carried: Some(carried), ..Self::new(binding.strands()) }
    }

    /// The strands where guide points lie at `positions` \[m\], world space, shape `[block][point]` of lanes.
    pub fn at(
        &mut self,
        positions: &[Vec3Lanes],
        body: &BodyFrame,
        look: &Look,
        level: &DetailLevel,
    ) -> &Strands {
        let Self { guides, carried, turns, curves, strands } = self;
        carried.iter_mut().for_each(|carried| bind(carried, level.drawn_lanes(), positions, body));
        let points = drawn_points(carried.as_ref(), positions, guides, level);
        turns.place(body, carried.as_ref().map(Carried::binding), guides.strand_count());
        tessellate(&points, guides, turns, level, curves);
        interpolate(curves, guides, turns, look, level, strands);
        if let Some(carried) = carried {
            let solids = carried.solids().placed(body);
            keep_outside(strands, curves, guides.points_per_strand(), &solids);
        }
        strands
    }
}
