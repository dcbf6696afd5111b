//! The linked text of every shader module, as `build.rs` left it.

strandline_gpu::linked! {
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
