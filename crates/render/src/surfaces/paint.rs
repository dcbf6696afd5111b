//! The paint of a place on the body; the twin of gpu/draw/surfaces.wesl.

use glam::{Vec2, Vec3, Vec4};

use super::{CLAMP, MATERIAL_WORDS, MIRROR, OWN_COLOR, Surfaces, TABLE_WORDS, WRAP_BITS};

/// The material of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Painted {
    /// Linear RGB and alpha.
    color: Vec4,
    /// Below 0 where the body's settings say it.
    pub roughness: f32,
    /// Share of metal.
    pub metallic: f32,
    cutoff: f32,
    is_own: bool,
}

impl Painted {
    /// True where nothing is drawn.
    pub fn is_cut(&self) -> bool {
        self.color.w < self.cutoff
    }

    /// Its colour, linear RGB; `None` where the body's settings say it.
    pub fn own_color(&self) -> Option<Vec3> {
        self.is_own.then(|| self.color.truncate())
    }

    /// Its colour, linear RGB, on a body of a given one, of which it has a share where it has none of its own.
    pub fn color_on(&self, plain: Vec3) -> Vec3 {
        if self.is_own { self.color.truncate() } else { plain * self.color.truncate() }
    }

    /// True for skin: a surface whose colour the body's settings say.
    pub fn is_skin(&self) -> bool {
        !self.is_own
    }

    /// A plain colour of its own, linear RGB.
    #[cfg(test)]
    pub fn of_color(color: Vec3) -> Self {
        Self { color: color.extend(1.0), roughness: -1.0, metallic: 0.0, cutoff: -1.0, is_own: true }
    }

    /// The mean of several of one material.
    pub fn mean(several: impl Iterator<Item = Self>) -> Option<Self> {
        let (mut first, mut sum, mut count) = (None, Vec4::ZERO, 0.0);
        for painted in several {
            first = first.or(Some(painted));
            sum += painted.color;
            count += 1.0;
        }
        first.map(|first| Self { color: sum / count, ..first })
    }
}

impl Surfaces {
    /// The paint of a triangle at shares of its corners, drawn from a copy of its texture of some size, from 0, the full
    /// one.
    pub fn at(&self, triangle: u32, shares: Vec3, copy: f32) -> Painted {
        let [a, b, c] = [0, 1, 2].map(|corner| &self.corners[3 * triangle as usize + corner]);
        let place = a.place * shares.x + b.place * shares.y + c.place * shares.z;
        let factor = a.color * shares.x + b.color * shares.y + c.color * shares.z;
        self.painted(a.material, place, factor, copy)
    }

    fn painted(&self, material: u32, place: Vec2, factor: Vec4, copy: f32) -> Painted {
        let first = (TABLE_WORDS + material * MATERIAL_WORDS) as usize;
        let words = &self.words[first..][..MATERIAL_WORDS as usize];
        let [red, green, blue, alpha, roughness, metallic, cutoff] =
            [0, 1, 2, 3, 4, 5, 6].map(|word| f32::from_bits(words[word]));
        let mut color = Vec4::new(red, green, blue, alpha) * factor;
        if words[8] != 0 {
            color *= self.texture(words, place, copy);
        }
        Painted { color, roughness, metallic, cutoff, is_own: words[7] & OWN_COLOR != 0 }
    }

    /// Between the two copies of a texture about a size.
    fn texture(&self, words: &[u32], place: Vec2, copy: f32) -> Vec4 {
        let copy = copy.clamp(0.0, words[9] as f32);
        let (whole, share) = (copy.floor() as u32, copy - copy.floor());
        let (mut first, mut size) = (words[8], [words[10], words[11]]);
        for _ in 0..whole {
            first += size[0] * size[1];
            size = size.map(|length| (length / 2).max(1));
        }
        let fine = self.between(first, size, words[7], place);
        if share == 0.0 {
            return fine;
        }
        first += size[0] * size[1];
        let coarse = self.between(first, size.map(|length| (length / 2).max(1)), words[7], place);
        fine + (coarse - fine) * share
    }

    /// Between the four texels about a place.
    fn between(&self, first: u32, size: [u32; 2], wraps: u32, place: Vec2) -> Vec4 {
        let at = place * Vec2::new(size[0] as f32, size[1] as f32) - 0.5;
        let (low, share) = (at.floor(), at - at.floor());
        let (x, y) = (low.x as i32, low.y as i32);
        let texel = |right: i32, down: i32| {
            let column = wrapped(x + right, size[0], wraps);
            let row = wrapped(y + down, size[1], wraps >> WRAP_BITS);
            self.texel(self.words[(first + row * size[0] + column) as usize])
        };
        let above = texel(0, 0) + (texel(1, 0) - texel(0, 0)) * share.x;
        let below = texel(0, 1) + (texel(1, 1) - texel(0, 1)) * share.x;
        above + (below - above) * share.y
    }

    /// A texel as linear light.
    fn texel(&self, word: u32) -> Vec4 {
        let [red, green, blue, alpha] = word.to_le_bytes();
        let light = |stored: u8| f32::from_bits(self.words[usize::from(stored)]);
        Vec4::new(light(red), light(green), light(blue), f32::from(alpha) / 255.0)
    }
}

/// A texel of a row of some length for one within it or beyond.
fn wrapped(at: i32, length: u32, wrap: u32) -> u32 {
    let length = length as i32;
    let texel = match wrap & (MIRROR | CLAMP) {
        CLAMP => at.clamp(0, length - 1),
        MIRROR => {
            let at = at.rem_euclid(2 * length);
            at.min(2 * length - 1 - at)
        }
        _ => at.rem_euclid(length),
    };
    texel as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_beyond_the_borders_repeat_mirror_or_stop() {
        let row = |wrap: u32| (-5..8).map(|at| wrapped(at, 3, wrap)).collect::<Vec<_>>();
        assert_eq!(row(0), [1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1]);
        assert_eq!(row(MIRROR), [1, 2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1]);
        assert_eq!(row(CLAMP), [0, 0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2]);
    }
}
