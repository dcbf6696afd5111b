//! The linked text of every shader module, as `build.rs` left it.

strandline_gpu::linked! {
    BOUND_FRAMES = "bound_frames",
    BOUND = "bound",
    BOUND_OUTSIDE = "bound_outside",
    TESSELLATE = "tessellate",
    INTERPOLATE = "interpolate",
    FIT = "fit",
    OPACITY_DEPTH = "opacity_depth",
    OPACITY_LAYERS = "opacity_layers",
    OCCLUDE = "occlude",
    SHADE = "shade",
    LIGHT_SUMS = "light_sums",
    LIGHT_PREPARE = "light_prepare",
    LIGHT_GRID = "light_grid",
    LIGHT_GATHER = "light_gather",
    SHADE_CHIANG = "shade_chiang",
    SORT = "sort",
    DRAW = "draw",
    BODY = "body",
    BACKGROUND = "background",
    RESOLVE = "resolve",
}
