/// Default threads of a workgroup; the build gives shaders the same number.
pub const THREADS: usize = 64;
/// Threads of a workgroup that works alone: all that WebGPU grants. Shaders know it too.
pub const MANY: usize = 256;
