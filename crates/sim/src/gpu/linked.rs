//! The linked text of every shader module, as `build.rs` left it.

macro_rules! modules {
    ($($name:ident = $file:literal,)*) => {
        $(pub(super) const $name: &str = include_str!(concat!(env!("OUT_DIR"), "/", $file, ".wgsl"));)*

        /// Every linked module: its name and its text.
        pub fn modules() -> Vec<(&'static str, &'static str)> {
            vec![$(($file, $name),)*]
        }
    };
}

modules! {
    POSE_ROOTS = "pose_roots",
    INTEGRATE = "integrate",
    CONSTRAIN = "constrain",
    SPLAT = "splat",
    MARK = "mark",
    PCG = "pcg",
    ROOMS = "rooms",
    SOLVE_PRESSURE = "solve_pressure",
    GATHER = "gather",
    ADVANCE = "advance",
}
