//! The linked text of every shader module, as `build.rs` left it.

strandline_gpu::linked! {
    POSE_ROOTS = "pose_roots",
    INTEGRATE = "integrate",
    CONSTRAIN = "constrain",
    SOLVE_RODS = "solve_rods",
    SPLAT = "splat",
    ORDER = "order",
    MARK = "mark",
    PCG = "pcg",
    ROOMS = "rooms",
    SOLVE_PRESSURE = "solve_pressure",
    GATHER = "gather",
    ADVANCE = "advance",
    LENGTHS_ALONE = "lengths_alone",
}
