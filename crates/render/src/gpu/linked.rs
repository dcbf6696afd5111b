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
    TESSELLATE = "tessellate",
    INTERPOLATE = "interpolate",
    FIT = "fit",
    OPACITY_DEPTH = "opacity_depth",
    OPACITY_LAYERS = "opacity_layers",
    OCCLUDE = "occlude",
    SHADE = "shade",
    SORT = "sort",
    DRAW = "draw",
    BODY = "body",
    BACKGROUND = "background",
    RESOLVE = "resolve",
}
