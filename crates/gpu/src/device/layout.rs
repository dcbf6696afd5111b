//! What a type of the host looks like in a shader.

use bytemuck::Pod;

/// The memory layout of a type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Layout {
    /// `f32`, `u32` or `i32`, possibly atomic.
    Scalar(&'static str),
    /// `count` scalars in a row: `vec2f` to `vec4f` and their like.
    Vector {
        /// The scalar.
        scalar: &'static str,
        /// 2 to 4.
        count: usize,
    },
    /// Fields one after the other.
    Struct {
        /// Its name.
        name: &'static str,
        /// Its size in bytes, padding included.
        size: usize,
        /// Its fields.
        fields: Vec<Field>,
    },
}

/// A field of a struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name, the same on both sides.
    pub name: &'static str,
    /// Bytes from the start of the struct.
    pub offset: usize,
    /// What it is.
    pub layout: Layout,
}

/// A type of the host that a shader declares too. [`mirror!`](crate::mirror) makes structs of them.
pub trait Mirror: Pod {
    /// Its layout.
    fn layout() -> Layout;
}

macro_rules! scalar {
    ($($kind:ident)*) => {$(
        impl Mirror for $kind {
            fn layout() -> Layout {
                Layout::Scalar(stringify!($kind))
            }
        }
        scalar!(@vector $kind 2);
        scalar!(@vector $kind 3);
        scalar!(@vector $kind 4);
    )*};
    (@vector $kind:ident $count:literal) => {
        impl Mirror for [$kind; $count] {
            fn layout() -> Layout {
                Layout::Vector { scalar: stringify!($kind), count: $count }
            }
        }
    };
}

scalar!(f32 u32 i32);

/// Declares a struct that a shader declares too, field by field under the same names.
#[macro_export]
macro_rules! mirror {
    ($(#[$attribute:meta])* $visibility:vis struct $name:ident {
        $($(#[$note:meta])* pub $field:ident: $kind:ty,)*
    }) => {
        $(#[$attribute])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Default, PartialEq, $crate::bytemuck::Pod, $crate::bytemuck::Zeroable)]
        #[bytemuck(crate = "::strandline_gpu::bytemuck")]
        $visibility struct $name {
            $($(#[$note])* pub $field: $kind,)*
        }

        impl $crate::Mirror for $name {
            fn layout() -> $crate::Layout {
                $crate::Layout::Struct {
                    name: stringify!($name),
                    size: size_of::<$name>(),
                    fields: vec![$($crate::Field {
                        name: stringify!($field),
                        offset: std::mem::offset_of!($name, $field),
                        layout: <$kind as $crate::Mirror>::layout(),
                    },)*],
                }
            }
        }
    };
}
