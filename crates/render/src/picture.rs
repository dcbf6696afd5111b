/// A finished picture: 8-bit sRGB, rows from the top, shape `[row][column][channel]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width \[pixel\].
    pub width: u32,
    /// Height \[pixel\].
    pub height: u32,
    /// RGB, three bytes a pixel.
    pub pixels: Vec<u8>,
}
