//! The linked texts of a crate's shader modules, as its build script left them.

/// Declares the modules of a crate: a constant with each linked text, and a list of all.
///
/// ```text
/// linked! {
///     SPLAT = "splat",
/// }
/// ```
#[macro_export]
macro_rules! linked {
    ($($name:ident = $file:literal,)*) => {
        $(pub(super) const $name: &str = include_str!(concat!(env!("OUT_DIR"), "/", $file, ".wgsl"));)*

        /// Every linked module: its name and its text.
        pub fn modules() -> Vec<(&'static str, &'static str)> {
            vec![$(($file, $name),)*]
        }
    };
}
