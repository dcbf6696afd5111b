/// Threads of a workgroup where a kernel says nothing else; the build gives shaders the same number.
pub const THREADS: usize = 64;
