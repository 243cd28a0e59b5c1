//! Sums along rows, then of rows: what all scaling methods have in common.

use std::ops::Range;

use super::{Colour, Frame, Window, arithmetic::Arithmetic, colour, taps::Taps};

/// Scales rows along themselves as they come, keeps the last few, and sums these to rows of the result.
#[derive(Clone, Debug)]
pub(super) struct Separable<A: Arithmetic> {
    arithmetic: A,
    pub(super) across: Taps<A::Weight>,
    pub(super) down: Taps<A::Weight>,
    colour: Colour,
    /// Whether native rows come as luma already, one byte a pixel.
    pub(super) converted: bool,
    /// How many rows a row of the result is made of at most.
    places: usize,
    /// Memory for whole pictures and for pieces.
    pub(super) rows: Vec<A::Middle>,
}

/// Writes columns of a native row.
pub(super) type Row<'a> = dyn FnMut(u32, Range<u32>, &mut [u8]) + 'a;

/// Memory to make a window in.
pub(super) struct Memory<'a, M> {
    /// A native row.
    pub(super) drawn: &'a mut [u8],
    /// A scaled one that has yet to become grey.
    pub(super) coloured: &'a mut [u8],
    /// Rows scaled along themselves.
    pub(super) rows: &'a mut [M],
}

impl<A: Arithmetic> Separable<A> {
    pub(super) fn new(arithmetic: A, across: Taps<A::Weight>, down: Taps<A::Weight>, colour: Colour) -> Self {
        let places = down.most();
        Self { arithmetic, across, down, colour, converted: false, places, rows: Vec::new() }
    }

    /// Channels of what is summed: luma is taken before, the mean after.
    fn channels(&self) -> usize {
        if self.colour == Colour::Luma { 1 } else { 3 }
    }

    /// How long [`Memory::coloured`] and [`Memory::rows`] are for these columns of the result.
    pub(super) fn room(&self, columns: Range<u32>) -> [usize; 2] {
        let width = columns.len();
        let coloured = if self.colour == Colour::Mean { 3 * width } else { 0 };
        [coloured, self.places * width * self.channels()]
    }

    /// Makes a window of `out` from the columns `native` of native rows, which `row` writes.
    pub(super) fn window(
        &self,
        window: Window,
        native: Range<u32>,
        memory: Memory<'_, A::Middle>,
        row: &mut Row<'_>,
        out: &mut Frame,
    ) {
        let Memory { drawn, coloured, rows } = memory;
        let width = window.columns().len() * self.channels();
        let bytes = out.channels() as usize * window.from[0] as usize
            ..out.channels() as usize * window.to[0] as usize;
        // Native row `y`, scaled along itself, lies in this place.
        let place = |y: u32| y as usize % self.places * width;
        let mut next = 0;
        for y in window.rows() {
            let (from, weights) = self.down.of(y);
            let to = from + weights.len() as u32;
            for y in from.max(next)..to {
                row(y, native.clone(), drawn);
                let middle = &mut rows[place(y)..][..width];
                if self.colour == Colour::Luma {
                    if !self.converted {
                        colour::luma_in_place(drawn);
                    }
                    self.scale_row::<1>(window.columns(), native.start, drawn, middle);
                } else {
                    self.scale_row::<3>(window.columns(), native.start, drawn, middle);
                }
            }
            next = to.max(next);
            let middle = |index: usize| &rows[place(from + index as u32)..][..width];
            self.sum_rows(weights, middle, coloured, &mut out.row_mut(y)[bytes.clone()]);
        }
    }

    /// Makes a window of `out` from all `pixels` of the native window that it needs, in memory of its own: faster than
    /// [`window`](Self::window) where windows are small.
    pub(super) fn piece(
        &mut self,
        window: Window,
        native: Window,
        pixels: &[u8],
        coloured: &mut Vec<u8>,
        out: &mut Frame,
    ) {
        let mut rows = std::mem::take(&mut self.rows);
        let width = window.columns().len() * self.channels();
        coloured.resize(width, 0);
        let room = width * native.rows().len();
        if rows.len() < room {
            rows.resize(room, A::Middle::default());
        }
        if self.colour == Colour::Luma {
            self.scale_rows::<1>(window.columns(), native, pixels, &mut rows);
        } else {
            self.scale_rows::<3>(window.columns(), native, pixels, &mut rows);
        }
        let channels = out.channels() as usize;
        let bytes = channels * window.from[0] as usize..channels * window.to[0] as usize;
        for y in window.rows() {
            let (from, weights) = self.down.of(y);
            let middle = |index: usize| &rows[((from - native.from[1]) as usize + index) * width..][..width];
            self.sum_rows(weights, middle, coloured, &mut out.row_mut(y)[bytes.clone()]);
        }
        self.rows = rows;
    }

    /// Sums rows to one of the result, by way of `coloured` if that is a mean of channels.
    fn sum_rows<'a>(
        &self,
        weights: &[A::Weight],
        middle: impl Fn(usize) -> &'a [A::Middle],
        coloured: &mut [u8],
        out: &mut [u8],
    ) where
        A: 'a,
    {
        if self.colour == Colour::Mean {
            self.arithmetic.down(weights, middle, coloured);
            colour::grey(Colour::Mean, coloured, out);
        } else {
            self.arithmetic.down(weights, middle, out);
        }
    }

    /// Scales rows along themselves.
    fn scale_rows<const CHANNELS: usize>(
        &self,
        columns: Range<u32>,
        native: Window,
        pixels: &[u8],
        out: &mut [A::Middle],
    ) {
        let (pixels, _) = pixels.as_chunks::<CHANNELS>();
        let (out, _) = out.as_chunks_mut::<CHANNELS>();
        let [from, to] = [native.columns().len(), columns.len()];
        for (index, column) in columns.enumerate() {
            let (first, weights) = self.across.of(column);
            let pixels = &pixels[(first - native.from[0]) as usize..];
            // Two taps are the most frequent number of them by far.
            if let Ok(weights) = <&[A::Weight; 2]>::try_from(weights) {
                for row in 0..native.rows().len() {
                    out[row * to + index] = A::across(weights, &pixels[row * from..][..2]);
                }
            } else {
                for row in 0..native.rows().len() {
                    out[row * to + index] = A::across(weights, &pixels[row * from..][..weights.len()]);
                }
            }
        }
    }

    /// Scales a row along itself: `columns` of the result, from native `pixels` of which the first is `first`.
    fn scale_row<const CHANNELS: usize>(
        &self,
        columns: Range<u32>,
        first: u32,
        pixels: &[u8],
        out: &mut [A::Middle],
    ) {
        let (pixels, _) = pixels.as_chunks::<CHANNELS>();
        let (out, _) = out.as_chunks_mut::<CHANNELS>();
        for (out, column) in out.iter_mut().zip(columns) {
            let (from, weights) = self.across.of(column);
            *out = A::across(weights, &pixels[(from - first) as usize..][..weights.len()]);
        }
    }
}
