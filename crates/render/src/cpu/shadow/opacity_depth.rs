//! `opacity_depth`: for each light with shadow, the depth of the first hair and of the body [Yuksel2008 §3].

use std::iter;

use glam::{Vec2, Vec3};
use strandline_base::par::prelude::*;

use super::body::{ShadowBody, draw_depth};
use super::hair::{part_strands, parts_of, plane_bounds, stride, walk};
use crate::shadow::{LightView, NOTHING, ShadowMap, Shadows, Window};
use crate::strands::Strands;
use crate::{Light, Shadow};

/// Fits each shadow light's maps to hair and body, and finds the first depths in them. Point lights look
/// at `middle` \[m\], world space, and all texels keep their places beside it.
///
/// The hair has a map of its own, no larger than the hair, so that its texels are small.
pub fn opacity_depth(
    strands: &Strands,
    body: Option<ShadowBody>,
    lights: &[Light],
    middle: Vec3,
    settings: &Shadow,
    out: &mut Shadows,
) {
    out.casts.clear();
    out.casts.extend(lights.iter().map(|light| light.shadow));
    out.maps.resize_with(lights.len(), ShadowMap::default);
    for (map, light) in out.maps.iter_mut().zip(lights) {
        map.view = LightView::new(light, middle);
        map.set(settings);
    }
    let count = out.casts.iter().filter(|casts| **casts).count();
    let active = out.maps.iter_mut().zip(&out.casts).filter(|(_, casts)| **casts);
    active.enumerate().for_each(|(order, (map, _))| map.parts = parts_of(order, count));
    out.active().for_each(|map| {
        let hair = plane_bounds(&strands.positions, &map.view);
        map.hair_window = Window::around(hair, &map.view, middle, map.size);
        match body {
            Some(body) => body_depths(map, body, middle),
            None => map.body_depths.clear(),
        }
        hair_depths(map, strands);
    });
}

fn body_depths(map: &mut ShadowMap, body: ShadowBody, middle: Vec3) {
    let bounds: (Vec2, Vec2) = plane_bounds(body.positions, &map.view);
    map.body_window = Window::around(bounds, &map.view, middle, map.size);
    map.body_depths.clear();
    map.body_depths.resize(map.size * map.size, NOTHING);
    draw_depth(&body, &map.view, &map.body_window, map.size, &mut map.body_depths);
    let depths = &map.body_depths;
    map.nearest_body.take(map.size, |texel| depths[texel]);
}

fn hair_depths(map: &mut ShadowMap, strands: &Strands) {
    let size = map.size;
    let (view, window, parts) = (map.view, map.hair_window, map.parts);
    map.depth_parts.resize_with(parts - 1, Vec::new);
    let mut all: Vec<_> = iter::once(&mut map.depths).chain(&mut map.depth_parts).collect();
    all.par_iter_mut().enumerate().for_each(|(part, depths)| {
        depths.clear();
        depths.resize(size * stride(size), NOTHING);
        let depths = depths.as_mut_slice();
        walk(
            strands,
            part_strands(strands, part, parts),
            &view,
            &window,
            size,
            |_| 1.0,
            |piece| {
                let depth = &mut depths[piece.texel];
                *depth = if piece.depth < *depth { piece.depth } else { *depth };
            },
        );
    });
    for part in &map.depth_parts {
        map.depths.par_chunks_mut(stride(size)).zip(part.par_chunks(stride(size))).for_each(
            |(depths, others)| {
                depths.iter_mut().zip(others).for_each(|(depth, other)| *depth = depth.min(*other));
            },
        );
    }
}
