use strandline_base::settings;

settings! {
    /// Light about the strand and two highlights from shifted tangents \[Scheuermann2004\].
    pub struct Scheuermann: Copy {
        /// The white highlight, from the surface of the hair.
        first_highlight: Highlight = Highlight { shift: -5.0, width: 5.0, strength: 0.07 };
        /// The coloured highlight, from light that crossed the hair.
        second_highlight: Highlight = Highlight { shift: 7.0, width: 9.0, strength: 0.2 };
        /// Break-up of the second highlight into sparkles by a second noise.
        sparkle: f32 = 0.7, in [0.0, 1.0], more "fewer, brighter sparkles";
        /// Extra reach of light through bright hair, relative to black hair.
        translucency: f32 = 0.6, in [0.0, 1.0], more "brighter shadows in light hair";
    }
}

settings! {
    /// A highlight on the hair \[Scheuermann2004\].
    pub struct Highlight: Copy {
        /// Angle by which it is moved toward the tip; below 0 toward the root.
        shift: f32 = 0.0, in [-45.0, 45.0] "degrees", more "a highlight nearer to the tips";
        /// Its standard deviation along the strand.
        width: f32 = 5.0, in [0.5, 60.0] "degrees", more "a wider, duller highlight";
        /// Share of the light that goes into it.
        strength: f32 = 0.1, in [0.0, 0.5], more "a brighter highlight";
    }
}
