//! Codes that shaders know from here (codes.wesl).

use strandline_groom::Guides;

/// Drawn attributes, in bits: the groom's colours, and its widths along strands, instead of the look's.
pub const OWN_COLORS: u32 = 1;
pub const OWN_WIDTHS: u32 = 2;
/// Light is scattered many times; with the look's colours.
pub const SCATTERS: u32 = 4;
pub const COLORED: u32 = 8;
/// Numbers stand for the light of hair: its ribbons are flat.
pub const FLAT: u32 = 16;
/// The body's materials are drawn: their cut-outs, and their colours and gloss.
pub const CUT: u32 = 32;
pub const PAINTED: u32 = 64;

/// Kinds of light; the last is a place on a rectangle or disc.
pub const DIRECTIONAL: u32 = 0;
pub const SPOT: u32 = 1;
pub const POINT: u32 = 2;
pub const SURFACE: u32 = 3;

/// Kinds of bodies: none, an open mesh, and a closed mesh, each of whose edges joins two triangles.
pub const NO_BODY: u32 = 0;
pub const OPEN: u32 = 1;
pub const CLOSED: u32 = 2;

/// Tone maps.
pub const TONE_OFF: u32 = 0;
pub const TONE_FILMIC: u32 = 1;
pub const TONE_ACES: u32 = 2;

/// Attributes of the groom that are drawn instead of the look's.
pub fn own_kinds(guides: &Guides) -> u32 {
    let colors = if guides.colors().is_some() { OWN_COLORS } else { 0 };
    let widths = if guides.profiles().is_some() { OWN_WIDTHS } else { 0 };
    colors | widths
}
