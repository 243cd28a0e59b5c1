//! What does not move: the walls of a board, and which of them a ball at some place can touch.

/// One edge of an obstacle, with what does not depend on the ball.
#[derive(Clone, Debug)]
pub(super) struct Edge {
    /// Which obstacle it belongs to.
    pub(super) obstacle: u32,
    /// Its first corner.
    pub(super) from: [f64; 2],
    /// From the first corner to the second.
    pub(super) along: [f64; 2],
    /// Its squared length.
    pub(super) square: f64,
}

/// The box around an obstacle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    low: [f64; 2],
    high: [f64; 2],
}

impl Extent {
    /// Whether a ball with this centre and radius reaches into the box.
    pub(super) fn near(&self, [x, y]: [f64; 2], radius: f64) -> bool {
        let beyond = x - radius > self.high[0]
            || x + radius < self.low[0]
            || y - radius > self.high[1]
            || y + radius < self.low[1];
        !beyond
    }
}

/// Cells along a side of the grid that says which edges are near. Sixteen kilobytes, and a cell about as large as a ball.
const CELLS: usize = 64;
/// What is added to a ball's radius when an edge counts as near, so that no rounding leaves one out.
const SLACK: f64 = 1e-9;

/// The obstacles of a board, and a grid that says which edges a ball can touch.
#[derive(Clone, Debug)]
pub(super) struct Board {
    pub(super) radius: f64,
    pub(super) target: [f64; 2],
    pub(super) reach: f64,
    pub(super) edges: Vec<Edge>,
    pub(super) extents: Vec<Extent>,
    /// For each cell, row by row, where its edges end in `near`.
    ends: Vec<u32>,
    near: Vec<u32>,
    /// The numbers of all edges, for balls that have left the grid.
    all: Vec<u32>,
}

impl Board {
    pub(super) fn new(radius: f64, target: [f64; 2], reach: f64, polygons: &[Vec<[f64; 2]>]) -> Self {
        let edges: Vec<_> =
            (0..).zip(polygons).flat_map(|(obstacle, corners)| edges(obstacle, corners)).collect();
        let extents = polygons.iter().map(|corners| extent(corners)).collect();
        let (mut ends, mut near) = (Vec::with_capacity(CELLS * CELLS), Vec::new());
        // From a cell's middle to its corners: what the middle is not near to, nothing in the cell is.
        let cell = 1.0 / CELLS as f64;
        let within = radius + cell * std::f64::consts::FRAC_1_SQRT_2 + SLACK;
        let all: Vec<_> = (0..edges.len() as u32).collect();
        for index in 0..CELLS * CELLS {
            let middle = [index % CELLS, index / CELLS].map(|at| (at as f64 + 0.5) * cell);
            let touched = |&&edge: &&u32| {
                let [x, y] = nearest(&edges[edge as usize], middle);
                (x - middle[0]).powi(2) + (y - middle[1]).powi(2) <= within * within
            };
            near.extend(all.iter().filter(touched));
            ends.push(near.len() as u32);
        }
        Self { radius, target, reach, edges, extents, ends, near, all }
    }

    /// The edges that a ball can touch whose centre is here, and maybe some others, in order.
    pub(super) fn near(&self, [x, y]: [f64; 2]) -> &[u32] {
        let [column, row] = [x, y].map(|at| at * CELLS as f64);
        let inside = 0.0..CELLS as f64;
        if !(inside.contains(&column) && inside.contains(&row)) {
            return &self.all;
        }
        let cell = row as usize * CELLS + column as usize;
        let from = if cell == 0 { 0 } else { self.ends[cell - 1] };
        &self.near[from as usize..self.ends[cell] as usize]
    }
}

/// The point of an edge that is nearest to a point.
pub(super) fn nearest(edge: &Edge, [x, y]: [f64; 2]) -> [f64; 2] {
    let from = [x - edge.from[0], y - edge.from[1]];
    let share = (from[0] * edge.along[0] + from[1] * edge.along[1]) / edge.square;
    let share = share.clamp(0.0, 1.0);
    [edge.from[0] + edge.along[0] * share, edge.from[1] + edge.along[1] * share]
}

fn edges(obstacle: u32, corners: &[[f64; 2]]) -> impl Iterator<Item = Edge> {
    corners.iter().zip(corners.iter().cycle().skip(1)).map(move |(&from, to)| {
        let along = [to[0] - from[0], to[1] - from[1]];
        Edge { obstacle, from, along, square: along[0] * along[0] + along[1] * along[1] }
    })
}

fn extent(corners: &[[f64; 2]]) -> Extent {
    let bound = |axis: usize, pick: fn(f64, f64) -> f64| {
        corners.iter().map(|corner| corner[axis]).reduce(pick).unwrap_or(f64::NAN)
    };
    Extent { low: [bound(0, f64::min), bound(1, f64::min)], high: [bound(0, f64::max), bound(1, f64::max)] }
}
