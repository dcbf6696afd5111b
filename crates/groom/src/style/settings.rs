use strandline_base::{Group, Value, settings};

use super::Style;
use crate::GroomError;

settings! {
    /// Settings of a grown style. The default of every number but the first two is that of the style.
    pub struct StyleSettings {
        /// The style.
        style: Style = Style::default();
        /// Number of strands: guides for the renderer's follow strands.
        strand_count: usize = 2000, in [1, 8_000_000], slider [100, 20_000],
            more "denser hair that costs more";
        /// Seed of every random choice.
        seed: u64 = 1;
        /// Greatest length of a strand before curls.
        length: f32 = 0.52, in [0.01, 2.0] "m", slider [0.02, 1.0], more "longer hair";
        /// Share by which lengths differ from strand to strand.
        length_variation: f32 = 0.10, in [0.0, 0.9], more "more uneven ends";
        /// Height, head space, at which falling hair is cut level.
        cut_height: f32 = -0.27, in [-10.0, 1.0] "m", slider [-0.5, 0.1], more "shorter hair";
        /// Height over which the cut is spread, hair from the crown ending highest; 0 cuts level.
        layering: f32 = 0.02, in [0.0, 0.5] "m", slider [0.0, 0.2], more "more steps in the cut";
        /// Turn of the ends under, toward the neck.
        turn_under: f32 = 0.0, in [0.0, 2.0], more "ends that curl further in";
        /// Place of the parting, positive on the head's left.
        parting: f32 = 0.0, in [-0.07, 0.07] "m", more "a parting further left";
        /// Way below the hairline at which hair from above the forehead is cut that falls over it; 0 leaves the forehead
        /// free, and 0.05 reaches the brows. For hair that falls from a parting or is tied.
        fringe: f32 = 0.0, in [0.0, 0.3] "m", slider [0.0, 0.1], more "a longer fringe";
        /// Leads hair from the front and the sides behind the ears. For hair that falls from a parting.
        behind_ears: bool = false;
        /// Grows a beard beside the hair: the group `beard`, as the style of that name.
        beard: bool = false;
        /// Grows eyebrows beside the hair: the group `brows`.
        brows: bool = false;
        /// Grows eyelashes beside the hair: the group `lashes`.
        lashes: bool = false;
        /// Turn of the hair around the whorl.
        swirl: f32 = 0.0, in [-3.0, 3.0] "rad", more "a tighter whorl";
        /// Thickness of the hair that lies on the skull.
        volume: f32 = 0.012, in [0.001, 0.1] "m", slider [0.001, 0.05], more "fuller hair";
        /// Width of a clump at the roots.
        clump_width: f32 = 0.020, in [0.002, 0.2] "m", slider [0.002, 0.06], more "fewer, broader locks";
        /// Share of the way to the middle of its clump that a strand is drawn at the tip.
        clump_share: f32 = 0.35, in [0.0, 1.0], more "more pointed locks";
        /// Amplitude of waves.
        wave_amplitude: f32 = 0.0, in [0.0, 0.1] "m", slider [0.0, 0.03], more "deeper waves";
        /// Length of a wave.
        wave_length: f32 = 0.07, in [0.005, 2.0] "m", slider [0.02, 0.3], more "calmer waves";
        /// Radius of curls.
        curl_radius: f32 = 0.0, in [0.0, 0.1] "m", slider [0.0, 0.03], more "wider curls";
        /// Length of hair for one turn of a curl.
        curl_length: f32 = 0.05, in [0.005, 2.0] "m", slider [0.02, 0.3], more "looser curls";
        /// Amplitude of each strand's own disorder at the tip.
        noise: f32 = 0.003, in [0.0, 0.1] "m", slider [0.0, 0.02], more "more disorder";
        /// Share of the way to the middle of its small lock, eight neighbours, that a strand between the guides is
        /// drawn at the tip.
        lock_share: f32 = 0.4, in [0.0, 1.0], more "finer, clearer locks";
        /// Mean amplitude of the waves that each strand between the guides has of its own.
        frizz: f32 = 0.0026, in [0.0, 0.05] "m", slider [0.0, 0.01], more "frizzier hair";
        /// Share of the strands between the guides that leave their lock.
        strays: f32 = 0.04, in [0.0, 1.0], slider [0.0, 0.2], more "more strays";
        /// Share of the length by which the ends of locks and of strands between the guides differ.
        thinning: f32 = 0.07, in [0.0, 0.9], slider [0.0, 0.3], more "thinner, softer ends";
        /// Breadth of the hairline, along which hair grows denser, longer and thicker.
        hairline: f32 = 0.009, in [0.0, 0.05] "m", slider [0.0, 0.02], more "a softer hairline";
    }
    prepare StyleSettings::prepare;
}

impl StyleSettings {
    /// The style with its own defaults.
    pub fn new(style: Style) -> Self {
        let plain = Self { style, ..Self::default() };
        match style {
            Style::Long => plain,
            Style::Bob => plain.bob(),
            Style::Wavy => plain.wavy(),
            Style::Curly => plain.curly(),
            Style::Pixie => plain.pixie(),
            Style::Ponytail => plain.ponytail(),
            Style::Buzz => plain.buzz(),
            Style::SideSwept => plain.side_swept(),
            Style::Afro => plain.afro(),
            Style::Coils => plain.coils(),
            Style::Bun => plain.bun(),
            Style::Braid => plain.braid(),
            Style::Beard => plain.beard(),
            Style::Brows => plain.brows(),
            Style::Lashes => plain.lashes(),
        }
    }

    fn bob(self) -> Self {
        Self {
            length: 0.34,
            length_variation: 0.03,
            cut_height: -0.112,
            layering: 0.004,
            turn_under: 0.7,
            parting: 0.025,
            volume: 0.016,
            clump_share: 0.15,
            noise: 0.0015,
            frizz: 0.0017,
            thinning: 0.03,
            ..self
        }
    }

    fn wavy(self) -> Self {
        Self {
            layering: 0.06,
            volume: 0.017,
            parting: 0.02,
            clump_width: 0.022,
            clump_share: 0.55,
            lock_share: 0.6,
            frizz: 0.0017,
            wave_amplitude: 0.011,
            wave_length: 0.095,
            ..self
        }
    }

    fn curly(self) -> Self {
        Self {
            length: 0.34,
            length_variation: 0.25,
            cut_height: -0.175,
            layering: 0.09,
            parting: -0.02,
            volume: 0.026,
            clump_width: 0.018,
            clump_share: 0.9,
            curl_radius: 0.0095,
            curl_length: 0.05,
            noise: 0.002,
            lock_share: 0.85,
            frizz: 0.0011,
            strays: 0.04,
            thinning: 0.12,
            ..self
        }
    }

    fn pixie(self) -> Self {
        Self {
            length: 0.075,
            length_variation: 0.25,
            cut_height: -0.105,
            parting: 0.03,
            swirl: 0.35,
            volume: 0.010,
            clump_width: 0.0155,
            clump_share: 0.35,
            noise: 0.004,
            frizz: 0.0012,
            thinning: 0.15,
            ..self
        }
    }

    fn ponytail(self) -> Self {
        Self {
            length: 0.50,
            length_variation: 0.15,
            cut_height: -0.25,
            volume: 0.009,
            clump_width: 0.025,
            clump_share: 0.1,
            wave_amplitude: 0.003,
            wave_length: 0.12,
            noise: 0.003,
            lock_share: 0.25,
            frizz: 0.0021,
            strays: 0.03,
            thinning: 0.15,
            ..self
        }
    }

    fn buzz(self) -> Self {
        Self {
            length: 0.012,
            length_variation: 0.2,
            cut_height: -0.2,
            swirl: 0.35,
            volume: 0.008,
            clump_share: 0.1,
            noise: 0.001,
            lock_share: 0.1,
            frizz: 0.0003,
            strays: 0.0,
            ..self
        }
    }

    fn side_swept(self) -> Self {
        Self {
            length: 0.26,
            length_variation: 0.15,
            cut_height: -0.13,
            layering: 0.06,
            turn_under: 0.3,
            parting: 0.034,
            volume: 0.021,
            clump_share: 0.45,
            wave_amplitude: 0.006,
            wave_length: 0.12,
            lock_share: 0.5,
            frizz: 0.0017,
            thinning: 0.1,
            ..self
        }
    }

    fn afro(self) -> Self {
        Self {
            length: 0.075,
            length_variation: 0.2,
            cut_height: -0.2,
            layering: 0.0,
            volume: 0.02,
            clump_width: 0.009,
            clump_share: 0.3,
            curl_radius: 0.0055,
            curl_length: 0.015,
            noise: 0.008,
            lock_share: 0.35,
            frizz: 0.0055,
            strays: 0.06,
            thinning: 0.12,
            ..self
        }
    }

    fn coils(self) -> Self {
        Self {
            length: 0.24,
            length_variation: 0.3,
            cut_height: -0.15,
            layering: 0.10,
            parting: -0.015,
            volume: 0.034,
            clump_width: 0.011,
            clump_share: 0.75,
            curl_radius: 0.0048,
            curl_length: 0.030,
            noise: 0.004,
            lock_share: 0.85,
            frizz: 0.0009,
            strays: 0.06,
            thinning: 0.12,
            ..self
        }
    }

    fn bun(self) -> Self {
        Self {
            length: 0.42,
            length_variation: 0.25,
            cut_height: -0.25,
            volume: 0.009,
            clump_share: 0.1,
            noise: 0.0014,
            lock_share: 0.3,
            frizz: 0.0023,
            strays: 0.02,
            ..self
        }
    }

    fn braid(self) -> Self {
        Self {
            length: 0.75,
            length_variation: 0.05,
            cut_height: -0.30,
            volume: 0.009,
            clump_share: 0.1,
            noise: 0.001,
            lock_share: 0.3,
            frizz: 0.0018,
            strays: 0.025,
            thinning: 0.1,
            ..self
        }
    }

    fn beard(self) -> Self {
        Self {
            length: 0.022,
            length_variation: 0.5,
            volume: 0.005,
            curl_radius: 0.0008,
            curl_length: 0.016,
            noise: 0.004,
            ..self
        }
    }

    fn brows(self) -> Self {
        Self { length: 0.010, length_variation: 0.35, volume: 0.001, noise: 0.001, ..self }
    }

    fn lashes(self) -> Self {
        Self { length: 0.011, length_variation: 0.2, noise: 0.0006, ..self }
    }

    /// A missing key has the value of its style.
    fn prepare(&mut self, given: &<Self as Value>::Given) {
        if let Some(style) = given.style {
            *self = Self::new(style);
        }
    }

    /// True for hair that is led behind the ears.
    pub(super) fn leads_behind_ears(&self) -> bool {
        self.behind_ears && self.style.is_parted()
    }

    /// Settings of this section that are set although the style makes nothing of them, as keys.
    pub fn without_effect(&self) -> Vec<&'static str> {
        let (falls, is_tied) = (self.style.is_parted(), self.style.is_tied());
        let set = [
            ("style.fringe", self.fringe > 0.0 && !falls && !is_tied),
            ("style.behind_ears", self.behind_ears && !falls),
            ("style.beard", self.beard && self.style == Style::Beard),
            ("style.brows", self.brows && self.style == Style::Brows),
            ("style.lashes", self.lashes && self.style == Style::Lashes),
        ];
        set.into_iter().filter(|(_, unused)| *unused).map(|(key, _)| key).collect()
    }

    /// True for hair that falls in curls; the coils of an afro are closer together than locks are.
    pub(super) fn is_curled(&self) -> bool {
        self.curl_radius > 0.0 && self.style.is_parted()
    }

    /// Points of a grown strand: more where it bends more.
    pub(super) fn points(&self) -> usize {
        if self.style == Style::Lashes {
            7
        } else if self.style.is_of_face() || self.style == Style::Buzz {
            10
        } else if self.curl_radius > 0.0 || matches!(self.style, Style::Bun | Style::Braid) {
            64
        } else if self.wave_amplitude > 0.0 {
            32
        } else {
            24
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// The first that is outside its range.
    pub fn validate(&self) -> Result<(), GroomError> {
        Ok(self.check_as("style")?)
    }
}
