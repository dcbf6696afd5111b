//! The linked text of every shader module with an entry point, as `build.rs` left it.

include!(concat!(env!("OUT_DIR"), "/linked.rs"));
