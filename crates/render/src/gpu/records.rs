//! Records that several kernels read or write.

use strandline_gpu::mirror;

mirror! {
    /// A vertex of the body, head space. Mirrors `Vertex` in records.wesl, as those below their namesakes.
    pub(super) struct Vertex {
        /// \[m\]
        pub position: [f32; 3],
        /// Density of roots about it, 0 to 1.
        pub roots: f32,
        pub normal: [f32; 3],
        pub unused: f32,
    }
}

mirror! {
    /// A corner of a triangle of a body with materials: see surfaces/mod.rs.
    pub(super) struct Corner {
        pub place: [f32; 2],
        pub material: u32,
        /// \[1/m\]
        pub density: f32,
        pub color: [f32; 4],
    }
}

mirror! {
    /// Values of all curves at one of their points.
    pub(super) struct Tap {
        /// Weights of four control points.
        pub position: [f32; 4],
        pub tangent: [f32; 4],
        /// The first of the control points.
        pub first: f32,
        pub parameter: f32,
        /// Of the clump \[m\].
        pub radius: f32,
        pub unused: f32,
    }
}

mirror! {
    /// A point of a guide's curve, world space \[m\].
    pub(super) struct Curve {
        pub position: [f32; 4],
        pub tangent: [f32; 4],
        pub normal: [f32; 4],
    }
}

mirror! {
    /// A guide's root, head space.
    pub(super) struct Root {
        pub normal: [f32; 3],
        /// Diameter \[m\].
        pub width: f32,
        /// Axes in the skin.
        pub first: [f32; 3],
        /// Share of the clump's radius.
        pub spread: f32,
        pub second: [f32; 3],
        pub unused: f32,
    }
}

mirror! {
    /// A cell of scattered light.
    pub(super) struct LightCell {
        pub direction: [f32; 3],
        /// Area over that of a face.
        pub hair: f32,
        /// Area over that of a face times the normal.
        pub skin: [f32; 3],
        /// Share of the hair that has the direction.
        pub order: f32,
        pub on_skin: [f32; 3],
        /// Of the direction, among those of the fibre's table.
        pub number: f32,
        pub from_skin: [f32; 3],
        /// Density of roots on it, 0 to 1.
        pub rooted: f32,
        /// Share of the lightest hair in it, by channel.
        pub light: [f32; 3],
        pub unused: f32,
    }
}
