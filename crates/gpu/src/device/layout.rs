//! Layout of a host type in a shader.

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
    /// An array of vectors within a struct.
    Array {
        /// An element.
        element: Box<Layout>,
        /// Number of elements.
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
        /// Elements of any number behind them.
        tail: Option<Box<Tail>>,
    },
}

/// A field of a struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name, the same on both sides.
    pub name: &'static str,
    /// Bytes from the start of the struct.
    pub offset: usize,
    /// Its type.
    pub layout: Layout,
}

/// Array without a length that follows a struct in its buffer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tail {
    /// Its name, the same on both sides.
    pub name: &'static str,
    /// An element; elements begin where the struct ends.
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

impl<const COUNT: usize> Mirror for [[f32; 4]; COUNT]
where
    Self: Pod,
{
    fn layout() -> Layout {
        Layout::Array { element: Box::new(<[f32; 4]>::layout()), count: COUNT }
    }
}

/// Declares a struct that a shader declares too, field by field under the same names. `then NAME: TYPE,` behind the
/// fields is a shader's array without a length that ends the struct: [`Buffer::with_tail`](crate::Buffer::with_tail)
/// makes room for it.
#[macro_export]
macro_rules! mirror {
    ($(#[$attribute:meta])* $visibility:vis struct $name:ident {
        $($(#[$note:meta])* pub $field:ident: $kind:ty,)*
        $(then $tail:ident: $element:ty,)?
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
                    tail: $crate::mirror!(@tail $($tail $element)?),
                }
            }
        }
    };
    (@tail) => { None };
    (@tail $tail:ident $element:ty) => {
        Some(Box::new($crate::Tail {
            name: stringify!($tail),
            layout: <$element as $crate::Mirror>::layout(),
        }))
    };
}
