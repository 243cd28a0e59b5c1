//! Pictures through a [`Format`].

use std::ops::Range;

use super::{
    Colour, Filter, Format, Frame, Window,
    arithmetic::{Blocks, Interpolation, Pillow, Shares},
    colour,
    separable::{Memory, Row, Separable},
    taps,
};

/// Makes pictures of one native size into a [`Format`]. Reused: it holds its weights and its scratch memory, a few
/// rows, and allocates no more.
///
/// Equal to Pillow and OpenCV to the bit, whatever the sizes. (Pillow 13 sums columns before rows where a picture
/// shrinks much more in height than in width; all before, the author's included, and this, never do.)
#[derive(Clone, Debug)]
pub struct Scaler {
    native: [u32; 2],
    format: Format,
    method: Method,
    /// Memory for whole pictures: a native row, and a scaled one that has yet to become grey.
    drawn: Vec<u8>,
    coloured: Vec<u8>,
}

#[derive(Clone, Debug)]
enum Method {
    Copied,
    Pillow(Separable<Pillow>),
    Interpolated(Separable<Interpolation>),
    Shared(Separable<Shares>),
    Blocks(Separable<Blocks>),
}

/// Does the same with whichever method it is.
macro_rules! with_method {
    ($method:expr, $copied:expr, $it:ident => $then:expr) => {
        match $method {
            Method::Copied => $copied,
            Method::Pillow($it) => $then,
            Method::Interpolated($it) => $then,
            Method::Shared($it) => $then,
            Method::Blocks($it) => $then,
        }
    };
}

impl Scaler {
    /// For pictures of `native` width and height, RGB.
    ///
    /// # Panics
    /// When there is nothing to be scaled: width or height is 0.
    pub fn new(native: [u32; 2], format: Format) -> Self {
        let [width, height] = native;
        assert!(width > 0 && height > 0, "a picture of {width} by {height} pixels cannot be scaled");
        Self { native, format, method: method(native, format), drawn: Vec::new(), coloured: Vec::new() }
    }

    /// For pictures whose rows come as luma already, one byte a pixel, if luma is what the format wants.
    pub(super) fn of_converted(native: [u32; 2], format: Format) -> Self {
        let mut scaler = Self::new(native, format);
        with_method!(&mut scaler.method, (), method => method.converted = true);
        scaler
    }

    /// Makes a window from all `pixels` of the native window that it needs. Not for formats that
    /// [copy](Self::copies).
    pub(super) fn piece(&mut self, window: Window, native: Window, pixels: &[u8], out: &mut Frame) {
        let coloured = &mut self.coloured;
        with_method!(&mut self.method, (), method => method.piece(window, native, pixels, coloured, out));
    }

    fn converted(&self) -> bool {
        self.format.colour == Colour::Luma && with_method!(&self.method, false, method => method.converted)
    }

    /// Whether it leaves pictures as large as they are.
    pub(super) fn copies(&self) -> bool {
        matches!(self.method, Method::Copied)
    }

    /// Whether it makes two pixels along an axis in the same way, the second of native pixels `by` further.
    pub(super) fn alike(&self, axis: usize, pixels: [u32; 2], by: u32) -> bool {
        with_method!(&self.method, pixels[0] + by == pixels[1], method => match axis {
            0 => method.across.alike(pixels, by),
            _ => method.down.alike(pixels, by),
        })
    }

    /// The native pixels along an axis that make one.
    pub(super) fn reach(&self, axis: usize, pixel: u32) -> Range<u32> {
        with_method!(&self.method, pixel..pixel + 1, method => match axis {
            0 => method.across.needs(pixel..pixel + 1),
            _ => method.down.needs(pixel..pixel + 1),
        })
    }

    /// Width and height of what it makes.
    pub fn size(&self) -> [u32; 2] {
        self.format.size(self.native)
    }

    /// Makes the whole picture. `row(y, pixels)` writes row `y` of the native picture, RGB, into `pixels`
    /// (`3 × width` bytes); rows are asked for from the top, at most once each, so no native picture need exist.
    ///
    /// Allocates on its first call.
    pub fn run(&mut self, mut row: impl FnMut(u32, &mut [u8]), out: &mut Frame) {
        let [width, height] = self.size();
        out.shape([width, height], self.format.channels());
        let whole = Window::of(0..width, 0..height);
        let row = &mut |y, _, pixels: &mut [u8]| row(y, pixels);
        let Self { native, format, method, drawn, coloured } = self;
        drawn.resize(3 * native[0] as usize, 0);
        with_method!(method, copied(format.colour, whole, drawn, row, out), method => {
            let room = method.room(whole.columns());
            coloured.resize(room[0], 0);
            let mut rows = std::mem::take(&mut method.rows);
            rows.resize(room[1], Default::default());
            method.window(whole, 0..native[0], Memory { drawn, coloured, rows: &mut rows }, row, out);
            method.rows = rows;
        });
    }

    /// The part of the native picture that a window of the result depends on.
    pub fn needs(&self, window: Window) -> Window {
        with_method!(&self.method, window, method => Window::of(
            method.across.needs(window.columns()),
            method.down.needs(window.rows()),
        ))
    }

    /// The part of the result that a window of the native picture has a say in.
    pub fn touches(&self, native: Window) -> Window {
        with_method!(&self.method, native, method => Window::of(
            method.across.touches(native.columns()),
            method.down.touches(native.rows()),
        ))
    }

    /// Makes a window of the result again and leaves the rest of `out`, which a [`run`](Self::run) has written, as it
    /// is. `row(y, columns, pixels)` writes these columns of the native picture's row `y`; rows are asked for from the
    /// top, at most once each.
    ///
    /// # Panics
    /// When `out` has not the size and channels of the format, or the window is not within.
    pub fn part(&self, window: Window, mut row: impl FnMut(u32, Range<u32>, &mut [u8]), out: &mut Frame) {
        let fits = out.size() == self.size() && out.channels() == self.format.channels();
        assert!(fits, "the picture has another format");
        if window.columns().is_empty() || window.rows().is_empty() {
            return;
        }
        let native = self.needs(window).columns();
        let row = &mut row;
        let channels = if self.converted() { 1 } else { 3 };
        scratch(channels * native.len(), |drawn| {
            with_method!(&self.method, copied(self.format.colour, window, drawn, row, out), method => {
                let room = method.room(window.columns());
                scratch(room[0], |coloured| scratch(room[1], |rows| {
                    method.window(window, native, Memory { drawn, coloured, rows }, row, out);
                }));
            });
        });
    }
}

/// Memory on the stack if that suffices, else from the heap.
fn scratch<T: Copy + Default, R>(length: usize, then: impl FnOnce(&mut [T]) -> R) -> R {
    match length {
        0..=256 => then(&mut [T::default(); 256][..length]),
        257..=2048 => then(&mut [T::default(); 2048][..length]),
        _ => then(&mut vec![T::default(); length]),
    }
}

/// Makes a window as large as it is drawn; `drawn` is memory for a row.
fn copied(colour: Colour, window: Window, drawn: &mut [u8], row: &mut Row<'_>, out: &mut Frame) {
    let channels = out.channels() as usize;
    let bytes = channels * window.from[0] as usize..channels * window.to[0] as usize;
    for y in window.rows() {
        let out = &mut out.row_mut(y)[bytes.clone()];
        if colour == Colour::Rgb {
            row(y, window.columns(), out);
        } else {
            row(y, window.columns(), drawn);
            colour::grey(colour, drawn, out);
        }
    }
}

/// The method of a format.
fn method(native: [u32; 2], format: Format) -> Method {
    let Some((size, filter)) = format.scale else { return Method::Copied };
    let axes = [0, 1].map(|axis| (native[axis], size[axis]));
    match filter {
        _ if native == size => Method::Copied,
        Filter::Pillow => {
            let [across, down] = axes.map(|(native, scaled)| taps::pillow(native, scaled));
            Method::Pillow(Separable::new(Pillow, across, down, format.colour))
        }
        Filter::Area if axes.iter().all(|&(native, scaled)| taps::shrinks(native, scaled)) => {
            let times = axes.map(|(native, scaled)| taps::whole(native, scaled));
            if let [Some(x), Some(y)] = times {
                let [across, down] = [taps::blocks(size[0], x), taps::blocks(size[1], y)];
                Method::Blocks(Separable::new(Blocks { block: [x, y] }, across, down, format.colour))
            } else {
                let [across, down] = axes.map(|(native, scaled)| taps::shares(native, scaled));
                Method::Shared(Separable::new(Shares, across, down, format.colour))
            }
        }
        Filter::Area | Filter::Linear => {
            let area = filter == Filter::Area;
            let [across, down] =
                [0, 1].map(|axis| taps::neighbours(native[axis], size[axis], area, axis == 1));
            Method::Interpolated(Separable::new(Interpolation, across, down, format.colour))
        }
    }
}
