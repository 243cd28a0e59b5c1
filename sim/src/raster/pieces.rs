//! A scaled mosaic, piece by piece.

use std::ops::Range;

use super::{
    Frame, Scaler, Window,
    bands::{Band, bands},
    blit::{blit, unpack},
    cache::Cache,
    tiles::{Changed, Tiles},
};

/// Memory for pieces that were made before, bytes: in grey and in colour. An environment is to fit into 64 KiB with its
/// picture of 84 × 84; in colour, 46 KiB would halve the time that DoorKey-8x8 takes.
const MEMORY: [usize; 2] = [32 << 10, 18 << 10];

/// How scaled pictures come apart into pieces that depend on few cells, and the pieces that were needed before.
///
/// Where no pixel depends on more than two cells along either axis, the picture is made of two kinds of pieces, one of
/// each for every cell: rows that depend on its row of cells only, and those before them, the edge, that depend on the
/// row above, too. In both, the first columns may depend on the cell to the left. So the looks of two and of four
/// cells say all of a piece; there are few combinations in most worlds, and they recur.
#[derive(Clone, Debug)]
pub(super) struct Pieces {
    columns: Vec<Column>,
    rows: Vec<Band>,
    /// Columns of cells with something that depends on the cell to the left, a bit each.
    edged: u64,
    inner: Cache,
    edges: Cache,
    /// Of a row of cells and of the one above: what [`pair`] makes of their looks.
    looks: [Vec<u32>; 2],
    /// Memory for the native pixels of a piece.
    native: Vec<u8>,
}

/// Columns of a piece.
#[derive(Clone, Debug)]
struct Column {
    /// The number of their [`Band`], where it belongs in a key.
    phase: u64,
    pixels: Range<u32>,
    native: Range<u32>,
}

/// Bits of a look in a key. Where there are more looks, nothing is remembered.
const BITS: u32 = 12;

impl Pieces {
    /// `None` when a pixel depends on more cells, or there are too many cells in a row.
    pub(super) fn new(scaler: &Scaler, cells: [u32; 2], side: u32, channels: u32) -> Option<Self> {
        if scaler.copies() || cells[0] > u64::BITS {
            return None;
        }
        let columns = bands(scaler, 0, side, false)?;
        let rows = bands(scaler, 1, side, true)?;
        let edged = columns.iter().map(|band| u64::from(band.before) << band.cell).sum();
        let width = columns.iter().map(|band| band.pixels.len()).max()? * channels as usize;
        let most = |edge: bool| {
            let rows = rows.iter().filter(|band| band.before == edge);
            width * rows.map(|band| band.pixels.len()).max().unwrap_or(0)
        };
        // There are more kinds of edges, and they are smaller.
        let memory = MEMORY[usize::from(channels > 1)];
        let edges = if most(true) > 0 { memory * 3 / 10 } else { 0 };
        let [inner, edges] = [Cache::new(most(false), memory - edges), Cache::new(most(true), edges)];
        let looks = [0; 2].map(|look| vec![look; columns.len()]);
        let columns = columns.into_iter().map(|band| Column {
            phase: u64::from(band.phase) << 56,
            pixels: band.pixels,
            native: band.native,
        });
        Some(Self { columns: columns.collect(), rows, edged, inner, edges, looks, native: Vec::new() })
    }

    /// Draws all pieces that changed cells have a say in.
    pub(super) fn draw(
        &mut self,
        changed: Changed<'_>,
        tiles: &Tiles,
        scaler: &mut Scaler,
        canvas: &mut Frame,
    ) {
        let Self { columns, rows, edged, inner, edges, looks, native } = self;
        let all = u64::MAX >> (u64::BITS as usize - columns.len());
        let known = tiles.count() <= 1 << BITS;
        let channels = canvas.channels() as usize;
        let stride = canvas.size()[0] as usize * channels;
        let (mut row, mut cells, mut above) = (usize::MAX, 0, 0);
        for band in &*rows {
            if row != band.cell as usize {
                row = band.cell as usize;
                above = std::mem::replace(&mut cells, changed.row(row));
                looks.swap(0, 1);
                pair(&mut looks[0], &changed.new[row * columns.len()..][..columns.len()], *edged);
            }
            let (cache, cells, looks) = if band.before {
                (&mut *edges, cells | above, [&looks[0], &looks[1]])
            } else {
                (&mut *inner, cells, [&looks[0]; 2])
            };
            let mut pieces = (cells | (cells << 1 & *edged)) & all;
            while pieces != 0 {
                let x = pieces.trailing_zeros() as usize;
                pieces &= pieces - 1;
                let Column { phase, pixels, native: column } = &columns[x];
                let [here, above] = looks.map(|looks| u64::from(looks[x]));
                let key = phase | u64::from(band.phase) << 48 | above << (2 * BITS) | here;
                let start = band.pixels.start as usize * stride + pixels.start as usize * channels;
                let (width, height) = (pixels.len() * channels, band.pixels.len());
                if let Some(bytes) = cache.find(key).filter(|_| known) {
                    unpack(width, height, bytes, stride, &mut canvas.bytes_mut()[start..]);
                    continue;
                }
                let window = Window::of(pixels.clone(), band.pixels.clone());
                let needed = Window::of(column.clone(), band.native.clone());
                tiles.gather(changed.new, [x as u32, band.cell], needed, native);
                scaler.piece(window, needed, native, canvas);
                if known && let Some(bytes) = cache.insert(key) {
                    blit(width, height, [stride, width], &canvas.bytes()[start..], bytes);
                }
            }
        }
    }
}

/// The looks of each cell and, where columns depend on it, of the one to the left.
fn pair(pairs: &mut [u32], looks: &[u16], edged: u64) {
    let mut left = 0;
    for (x, (pair, &look)) in pairs.iter_mut().zip(looks).enumerate() {
        let before = if edged >> x & 1 == 1 { left } else { 0 };
        *pair = u32::from(look) | before << BITS;
        left = u32::from(look);
    }
}
