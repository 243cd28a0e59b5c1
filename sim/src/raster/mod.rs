//! Pictures made of cells, sprites and shapes, written into a caller's buffer: what the thesis' image domains show
//! (chapters 5 and 7 to 9).
//!
//! A domain draws in its own size and in RGB; a [`Format`] says what becomes of that: scaled or not, by which
//! filter, in colour or grey. Every path exists elsewhere (Pillow, OpenCV) and is reproduced to the bit, because an
//! agent of the thesis saw exactly these numbers.
//!
//! - [`Mosaic`]: a grid of equal tiles; draws again only the cells that differ from what it drew last;
//! - [`Scaler`]: whole pictures, or parts of one, through a [`Format`];
//! - [`Stencil`]: rectangles, discs, polygons, as pygame fills them;
//! - [`text`]: writing over a picture.

mod arithmetic;
mod bands;
mod blit;
mod cache;
mod colour;
mod format;
mod frame;
mod mosaic;
mod pieces;
mod scale;
mod separable;
mod shapes;
mod taps;
pub mod text;
mod tiles;
mod window;

pub use format::{Colour, Filter, Format, FormatError};
pub use frame::Frame;
pub use mosaic::Mosaic;
pub use scale::Scaler;
pub use shapes::Stencil;
pub use window::Window;
