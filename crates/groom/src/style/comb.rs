//! Direction of a comb at every place on and around the head.

use glam::{Vec2, Vec3};
use strandline_base::math;
use strandline_body::Root;

use super::{Style, StyleSettings};

/// Centre of the whorl \[m\].
pub const WHORL: Vec3 = Vec3::new(0.012, 0.092, -0.062);
/// Tie of a ponytail \[m\]; hair leaves it there.
pub const TIE: Vec3 = Vec3::new(0.0, 0.038, -0.117);
/// Radius \[m\] of the tied hair.
pub const TIE_RADIUS: f32 = 0.011;
/// Middle \[m\] and axis of a bun.
const BUN: (Vec3, Vec3) = (Vec3::new(0.0, 0.040, -0.136), Vec3::new(0.0, 0.196_116_14, -0.980_580_7));
/// Part of a direction by which hair in a bun comes back to its place, for each metre off it.
const PULL: f32 = 90.0;
/// Length \[m\] of a plait in which each tress comes back to its place, and how far ahead hair is led \[m\].
const PLAIT: f32 = 0.075;
const AHEAD: f32 = 0.006;
/// Middle of the head \[m\].
const MIDDLE: Vec3 = Vec3::new(0.0, 0.010, -0.010);
/// The room in front of the face that falling hair keeps free: centre and half axes \[m\].
const FACE: (Vec3, Vec3) = (Vec3::new(0.0, -0.085, 0.080), Vec3::new(0.062, 0.145, 0.075));
/// Height, and place on the z axis in the middle \[m\], of the hairline above the forehead, and how it goes back aside \[1/m\].
const HAIRLINE: (f32, f32, f32) = (0.056, 0.085, 9.0);
/// Half of the breadth and the depth \[m\] of the section of hair that is cut as a fringe, a triangle behind the hairline.
const SECTION: (f32, f32) = (0.055, 0.040);
/// Strands rooted in front of this plane \[m\] fall before the shoulder.
const FRONT_FROM: f32 = 0.012;
/// Place behind an ear, on the side of positive x, to which hair is led that falls behind it \[m\]. Hair with roots farther
/// back falls there by itself.
const BEHIND_EAR: Vec3 = Vec3::new(0.072, 0.004, -0.042);
/// Distance \[m\] from that place, seen from the side, at which hair has reached it.
const AT_EAR: f32 = 0.016;
/// Hair has passed an ear below this height and behind this place \[m\].
const PAST_EAR: (f32, f32) = (0.020, -0.034);
/// From this height \[m\] on the skull the hair no longer heeds the parting.
const PARTED_ABOVE: f32 = 0.045;

/// End of a strand while it is combed.
#[derive(Clone, Copy, Debug)]
pub struct StrandEnd {
    /// Place \[m\].
    pub point: Vec3,
    /// Distance \[m\] from the skin.
    pub distance: f32,
    /// Unit vector away from the skin.
    pub out: Vec3,
    /// Way \[m\] since the tie.
    pub passed: f32,
}

impl StrandEnd {
    /// The part of a direction that runs along the skin, of length 1.
    fn along(&self, direction: Vec3) -> Vec3 {
        (direction - self.out * direction.dot(self.out)).normalize_or_zero()
    }
}

/// Constants of a strand while it is combed.
#[derive(Clone, Copy, Debug)]
pub struct Combed {
    /// Its root.
    pub root: Root,
    /// The side of the parting that it falls to, -1 or 1; 0 for a strand of the fringe.
    pub side: f32,
    /// Its place across the tie, in the unit disc.
    pub place: Vec2,
    /// True if it has passed the tie.
    pub tied: bool,
    /// True while it is on its way to the place behind the ear.
    pub led: bool,
    /// 1 for a strand that falls before the shoulder, -1 behind it.
    curtain: f32,
}

impl Combed {
    /// Of a root; `place` is its place across a tie, in the unit disc, and `chance` decides the
    /// side of strands on the parting itself.
    pub fn new(root: Root, settings: &StyleSettings, place: Vec2, chance: f32) -> Self {
        let across = root.position.x - settings.parting + 0.002 * (chance - 0.5);
        let side = if across < 0.0 { -1.0 } else { 1.0 };
        let side = if in_fringe(settings, &root) { 0.0 } else { side };
        let led = settings.leads_behind_ears() && side != 0.0 && root.position.z > BEHIND_EAR.z;
        // Hair that was led behind the ear stays behind the shoulder.
        let before = root.position.z > FRONT_FROM && !led;
        Self { root, side, place, tied: false, led, curtain: if before { 1.0 } else { -1.0 } }
    }

    /// Takes note of the place \[m\] that the strand has reached.
    pub fn pass(&mut self, point: Vec3) {
        self.led &= point.y > PAST_EAR.0 || point.z > PAST_EAR.1;
        // Hair in thick layers passes the place far outside of it.
        self.led &= (point - BEHIND_EAR).with_x(0.0).length() > AT_EAR;
    }

    /// True for a strand of the fringe.
    pub fn is_fringe(&self) -> bool {
        self.side == 0.0
    }

    /// The place \[m\] in the tie that this strand passes.
    pub fn tie(&self) -> Vec3 {
        TIE + TIE_RADIUS * Vec3::new(self.place.x, self.place.y, 0.0)
    }

    /// Direction at a place on or above the skin.
    pub fn direction(&self, settings: &StyleSettings, place: StrandEnd) -> Vec3 {
        if self.is_fringe() {
            return self.over_forehead(place);
        }
        match settings.style {
            Style::Ponytail if self.tied => self.tail(place.passed),
            Style::Bun if self.tied => self.wound(place),
            Style::Braid if self.tied => self.plaited(settings, place),
            Style::Ponytail | Style::Bun | Style::Braid => self.gathered(place),
            Style::Pixie => self.off_whorl(settings, place),
            Style::Buzz => 1.2 * self.root.normal + 0.6 * self.off_whorl(settings, place),
            Style::Afro => self.root.normal + 1.5 * (place.point - MIDDLE).normalize_or(Vec3::Y),
            Style::Bob | Style::Long | Style::Wavy | Style::Curly | Style::SideSwept | Style::Coils => {
                self.falling(settings, place)
            }
            // Combed in their own way.
            Style::Beard | Style::Brows | Style::Lashes => Vec3::NEG_Y,
        }
    }

    /// Forward over the hairline, then down.
    fn over_forehead(&self, place: StrandEnd) -> Vec3 {
        let forward = place.along(Vec3::new(4.0 * self.root.position.x, -0.4, 1.0));
        forward.lerp(Vec3::new(0.0, -1.0, -0.12), smooth(0.066, 0.040, place.point.y))
    }

    /// Along the skin to the tie; over the ear, not across it.
    fn gathered(&self, place: StrandEnd) -> Vec3 {
        let way = (self.tie() - place.point).normalize_or_zero();
        let before_ear = smooth(-0.03, 0.005, place.point.z) * smooth(0.030, 0.005, place.point.y);
        let over_ear = Vec3::new(0.0, 1.4 * before_ear, -0.3 * before_ear);
        place.along(way + over_ear) + 0.35 * way * (1.0 - before_ear)
    }

    /// Out of the tie, then down: the tail opens to its middle and closes to its end.
    fn tail(&self, passed: f32) -> Vec3 {
        let fall = smooth(0.0, 0.055, passed);
        let open =
            0.16 * smooth(0.0, 0.03, passed) * smooth(0.16, 0.07, passed) - 0.05 * smooth(0.16, 0.30, passed);
        let spread = open * Vec3::new(self.place.x, 0.0, self.place.y);
        Vec3::new(0.0, 0.35, -1.0).lerp(Vec3::new(0.0, -1.0, 0.03), fall) + spread
    }

    /// About the tie in a ring: each strand at its own place across it.
    fn wound(&self, place: StrandEnd) -> Vec3 {
        let aside = place.point - BUN.0;
        let depth = aside.dot(BUN.1);
        let radial = aside - BUN.1 * depth;
        let around = radial.normalize_or(Vec3::Y);
        let [radius, wanted] = [0.019 + 0.010 * self.place.x, 0.012 * self.place.y];
        BUN.1.cross(around) + PULL * ((radius - radial.length()) * around + (wanted - depth) * BUN.1)
    }

    /// Down from the tie as one of three tresses that cross each other in turn.
    fn plaited(&self, settings: &StyleSettings, place: StrandEnd) -> Vec3 {
        let tress =
            if self.root.position.x.abs() < 0.022 { 1.0 } else { 1.0 + self.root.position.x.signum() };
        let below = (TIE.y - place.point.y + AHEAD).max(0.0);
        let angle = std::f32::consts::TAU * (below / PLAIT + tress / 3.0);
        // The tresses begin in the tie, and end close to each other.
        let open =
            smooth(0.0, 0.03, below) * smooth(settings.cut_height, settings.cut_height + 0.05, place.point.y);
        let (breadth, depth) = (0.003 + 0.011 * open, 0.002 + 0.006 * open);
        let middle = TIE + Vec3::new(0.0, -below, -0.030 * smooth(0.0, 0.04, below));
        let across = Vec3::new(breadth * math::sin(angle), 0.0, depth * math::sin(2.0 * angle));
        let own = (0.003 + 0.004 * open) * Vec3::new(self.place.x, 0.0, self.place.y);
        middle + across + own - place.point
    }

    /// Outward from the whorl, turned by the swirl; over the forehead to the side.
    fn off_whorl(&self, settings: &StyleSettings, place: StrandEnd) -> Vec3 {
        let turn = math::rotation(WHORL.normalize(), settings.swirl);
        let away = place.along(turn * (self.root.position - WHORL));
        let ahead = smooth(0.02, 0.07, self.root.position.z) * smooth(-0.02, 0.05, self.root.position.y);
        let fringe = place.along(Vec3::new(-0.7 * settings.parting.signum(), -0.15, 0.5));
        away.lerp(fringe, 0.75 * ahead) + 0.35 * place.along(Vec3::NEG_Y) * smooth(0.06, -0.02, place.point.y)
    }

    /// Away from the parting over the skull, then down beside the face.
    fn falling(&self, settings: &StyleSettings, place: StrandEnd) -> Vec3 {
        let point = place.point;
        let on_top = smooth(PARTED_ABOVE - 0.03, PARTED_ABOVE + 0.04, point.y);
        // The parting runs from the forehead to the whorl; behind it hair falls to the back.
        let parted = smooth(WHORL.z - 0.01, WHORL.z + 0.035, self.root.position.z);
        let sideways = place.along(Vec3::new(self.side, -0.35, -0.45));
        let spread = Vec3::new(0.6, 1.0, 1.0);
        let loose = Vec3::new(0.010 * self.place.x, -0.02, -0.03);
        let backward = place.along((self.root.position - WHORL) * spread + loose);
        let combed = backward.lerp(sideways, parted);
        if self.led {
            return combed * on_top + (self.way_to_ear(place) + self.off_face(point)) * (1.0 - 0.75 * on_top);
        }
        let down = (Vec3::NEG_Y + self.over_ear(point)).normalize();
        let mut free = down + self.off_face(point) + self.toward_curtain(point);
        free += self.turned_under(settings, point);
        let resting = smooth(0.040, 0.012, place.distance) * smooth(-0.125, -0.150, point.y);
        free = free.lerp(1.3 * self.off_shoulder(place), resting);
        combed * on_top + free * (1.0 - 0.75 * on_top)
    }

    /// Along the skin to the place behind the ear; over the ear, not across it.
    fn way_to_ear(&self, place: StrandEnd) -> Vec3 {
        let way = BEHIND_EAR * Vec3::new(self.side, 1.0, 1.0) - place.point;
        let before_ear = smooth(-0.03, 0.005, place.point.z) * smooth(0.030, 0.008, place.point.y);
        place.along(way.normalize_or_zero() + Vec3::new(0.0, 1.4 * before_ear, -0.3 * before_ear))
    }

    /// Hair from the side of the head is led back over the ear.
    fn over_ear(&self, point: Vec3) -> Vec3 {
        let level = smooth(-0.07, 0.0, point.y) * smooth(0.07, 0.02, point.y);
        Vec3::new(0.0, 0.0, -0.55 * level * smooth(-0.02, 0.05, point.z))
    }

    /// Out of the room in front of the face, to the side that the strand was combed to.
    fn off_face(&self, point: Vec3) -> Vec3 {
        let inside = 1.3 - ((point - FACE.0) / FACE.1).length();
        if inside <= 0.0 {
            return Vec3::ZERO;
        }
        let middle = self.root.position.x.abs() < 0.04;
        let side = if middle { self.side } else { self.root.position.x.signum() };
        Vec3::new(side * 3.0, 0.3, -1.5) * inside.min(0.8)
    }

    /// In good time before or behind the shoulder.
    fn toward_curtain(&self, point: Vec3) -> Vec3 {
        let level = smooth(-0.21, -0.17, point.y);
        let forward = 0.32 * smooth(-0.06, -0.13, point.y);
        let backward = -0.50 * smooth(0.01, -0.08, point.y) * smooth(-0.105, -0.06, point.z);
        Vec3::new(0.0, 0.0, if self.curtain > 0.0 { forward } else { backward } * level)
    }

    /// Hair that rests on the shoulder slides off it to the front or the back, not outward.
    fn off_shoulder(&self, place: StrandEnd) -> Vec3 {
        let inward = -0.25 * place.point.x.signum() * smooth(0.07, 0.13, place.point.x.abs());
        place.along(Vec3::new(inward, -0.45, 0.9 * self.curtain))
    }

    /// The ends turn toward the neck.
    fn turned_under(&self, settings: &StyleSettings, point: Vec3) -> Vec3 {
        let near_end = smooth(settings.cut_height + 0.055, settings.cut_height, point.y);
        let inward = Vec3::new(-point.x, 0.0, -0.03 - point.z).normalize_or_zero();
        settings.turn_under * near_end * inward
    }
}

/// True if hair at a root is cut as a fringe.
pub fn in_fringe(settings: &StyleSettings, root: &Root) -> bool {
    if settings.fringe == 0.0 || !(settings.style.is_parted() || settings.style.is_tied()) {
        return false;
    }
    let Vec3 { x, y, z } = root.position;
    let behind = HAIRLINE.1 - HAIRLINE.2 * x * x - z;
    y > 0.03 && behind < SECTION.1 * (1.0 - x.abs() / SECTION.0)
}

/// Height \[m\] at which a fringe is cut.
pub fn fringe_end(settings: &StyleSettings) -> f32 {
    HAIRLINE.0 - settings.fringe
}

/// Rises smoothly from 0 at `from` to 1 at `to`; falls when `to` is the smaller.
pub fn smooth(from: f32, to: f32, value: f32) -> f32 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}
