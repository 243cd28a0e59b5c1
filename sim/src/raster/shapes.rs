//! Filled shapes, pixel for pixel as pygame draws them.

use std::ops::Range;

use super::Frame;

/// The pixels of a filled shape, row by row, relative to an origin of its own.
///
/// Made once; then it can be drawn anywhere, whole or only one row of a window, without allocating.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Stencil {
    /// The first row.
    top: i32,
    /// For each row, where its spans end in `spans`.
    ends: Vec<u32>,
    /// From and to (exclusive) of what is covered, row by row. Spans of a row may overlap.
    spans: Vec<[i32; 2]>,
}

impl Stencil {
    /// The pixels with `0 ≤ x < width`, `0 ≤ y < height`.
    pub fn rectangle([width, height]: [u32; 2]) -> Self {
        Self::collect(0..height as i32, |_, spans| spans.push([0, width as i32]))
    }

    /// A disc around the origin, as `pygame.draw.circle` fills one: columns and rows from `-radius` to `radius - 1`,
    /// its outline by the midpoint rule.
    pub fn disc(radius: u32) -> Self {
        let widths = half_widths(radius);
        let radius = radius as i32;
        Self::collect(-radius..radius, |y, spans| {
            let half = widths[if y < 0 { -y - 1 } else { y } as usize];
            spans.push([-half, half]);
        })
    }

    /// A polygon, concave or not, as `pygame.draw.polygon` fills one: its border belongs to it. A triangle differs from
    /// other polygons in how it rounds.
    pub fn polygon(corners: &[[i32; 2]]) -> Self {
        if let &[a, b, c] = corners {
            return Self::triangle([a, b, c]);
        }
        let (Some(top), Some(bottom)) =
            (corners.iter().map(|c| c[1]).min(), corners.iter().map(|c| c[1]).max())
        else {
            return Self::default();
        };
        Self::collect(top..bottom + 1, |y, spans| polygon_row(corners, top..bottom, y, spans))
    }

    fn triangle(mut corners: [[i32; 2]; 3]) -> Self {
        corners.sort_by_key(|corner| corner[1]);
        let [first, mut middle, last] = corners;
        if first[1] == last[1] && first[0] == middle[0] {
            middle = last;
        }
        // Offsets along an edge are rounded towards its upper end.
        let at = |above: [i32; 2], below: [i32; 2], y: i32| {
            let slope = match below[1] - above[1] {
                0 => 0.0,
                height => (f64::from(below[0] - above[0]) / f64::from(height)) as f32,
            };
            above[0] + ((y - above[1]) as f32 * slope) as i32
        };
        Self::collect(first[1]..last[1] + 1, |y, spans| {
            let long = at(first, last, y);
            let short = if y < middle[1] { at(first, middle, y) } else { at(middle, last, y) };
            spans.push([long.min(short), long.max(short) + 1]);
        })
    }

    fn collect(rows: Range<i32>, mut row: impl FnMut(i32, &mut Vec<[i32; 2]>)) -> Self {
        let mut stencil = Self { top: rows.start, ..Self::default() };
        for y in rows {
            row(y, &mut stencil.spans);
            stencil.ends.push(stencil.spans.len() as u32);
        }
        stencil
    }

    /// Rows that it covers.
    pub fn rows(&self) -> Range<i32> {
        self.top..self.top + self.ends.len() as i32
    }

    /// Columns that it covers.
    pub fn columns(&self) -> Range<i32> {
        let from = self.spans.iter().map(|span| span[0]).min().unwrap_or(0);
        from..self.spans.iter().map(|span| span[1]).max().unwrap_or(0)
    }

    /// What it covers of a row, not empty, maybe overlapping.
    pub fn spans(&self, y: i32) -> impl Iterator<Item = Range<i32>> + '_ {
        let spans = if self.rows().contains(&y) {
            let row = (y - self.top) as usize;
            let from = row.checked_sub(1).map_or(0, |before| self.ends[before]);
            &self.spans[from as usize..self.ends[row] as usize]
        } else {
            &[]
        };
        spans.iter().map(|&[from, to]| from..to)
    }

    /// Draws it with its origin at pixel `at` of an RGB picture; what lies outside is cut off.
    pub fn fill(&self, at: [i32; 2], colour: [u8; 3], frame: &mut Frame) {
        let [width, height] = frame.size();
        let rows = self.rows();
        let rows = (rows.start + at[1]).max(0)..(rows.end + at[1]).min(height as i32);
        for y in rows {
            self.fill_row(at, colour, y as u32, 0..width, frame.row_mut(y as u32));
        }
    }

    /// Draws what of it falls on these columns of row `y`, whose RGB `pixels` (`3 × columns`) are. Its origin lies at
    /// pixel `at` of the whole picture.
    pub fn fill_row(&self, at: [i32; 2], colour: [u8; 3], y: u32, columns: Range<u32>, pixels: &mut [u8]) {
        let [left, right] = [columns.start as i32, columns.end as i32];
        for span in self.spans(y as i32 - at[1]) {
            let [from, to] = [(span.start + at[0]).max(left), (span.end + at[0]).min(right)];
            if from < to {
                let pixels = &mut pixels[3 * (from - left) as usize..3 * (to - left) as usize];
                pixels.as_chunks_mut().0.fill(colour);
            }
        }
    }
}

/// For rows 0, 1 … of a disc's lower half, how far it reaches to either side.
///
/// The midpoint rule walks one eighth of the outline and mirrors it; pygame's disc has `2 × radius` rows and columns.
fn half_widths(radius: u32) -> Vec<i32> {
    let mut widths = vec![0; radius as usize];
    let (mut x, mut y, mut error) = (0, radius as i32, 1 - radius as i32);
    while x < y {
        if error >= 0 {
            y -= 1;
            error -= 2 * y;
        }
        x += 1;
        error += 2 * x + 1;
        for (row, width) in [(x, y), (y, x)] {
            let old = &mut widths[row.max(1) as usize - 1];
            *old = width.max(*old);
        }
    }
    widths
}

/// The spans of a polygon's row: between every second and the next of its crossings with edges.
fn polygon_row(corners: &[[i32; 2]], extent: Range<i32>, y: i32, spans: &mut Vec<[i32; 2]>) {
    let edges = || {
        let before = corners.iter().cycle().skip(corners.len() - 1);
        before.zip(corners).map(|(&a, &b)| [a, b])
    };
    if extent.is_empty() {
        let columns = corners.iter().map(|corner| corner[0]);
        spans.extend(columns.clone().min().zip(columns.max()).map(|(from, to)| [from, to + 1]));
        return;
    }
    let mut crossings = Vec::new();
    for [a, b] in edges() {
        let [above, below] = if a[1] < b[1] { [a, b] } else { [b, a] };
        // An edge owns its upper end and not its lower one, except in the last row of all.
        let crosses = (above[1]..below[1]).contains(&y) || (y == extent.end && below[1] == y);
        if above[1] < below[1] && crosses {
            let along = ((y - above[1]) * (below[0] - above[0])) as f32 / (below[1] - above[1]) as f32;
            // Outwards, if crossings come in pairs from the left.
            let along = if crossings.len() % 2 == 0 { along.floor() } else { along.ceil() };
            crossings.push(above[0] + along as i32);
        }
    }
    crossings.sort_unstable();
    spans.extend(crossings.chunks_exact(2).map(|pair| [pair[0], pair[1] + 1]));
    // Level edges have no crossings; one that the inside lies above of would be left out.
    if extent.start < y && y < extent.end {
        for [a, b] in edges().filter(|[a, b]| a[1] == y && b[1] == y) {
            spans.push([a[0].min(b[0]), a[0].max(b[0]) + 1]);
        }
    }
}
