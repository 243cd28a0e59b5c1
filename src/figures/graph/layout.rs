//! Where the vertices of a graph stand on the sheet.

use std::collections::{BTreeMap, VecDeque};

use super::super::canvas::Area;
use super::super::map::{Rect, View};
use super::{Graph, Ground, Role};

/// Vertices and what they stand on, in pixels.
pub(super) struct Layout {
    /// What is drawn below the graph.
    pub(super) area: Area,
    /// Where everything ends, vertices that are nowhere included.
    pub(super) bottom: f32,
    /// Side of a cell; 0 on a map.
    pub(super) cell: f32,
    /// Where each vertex stands.
    pub(super) at: Vec<(f32, f32)>,
    /// Radius of the largest vertex.
    pub(super) radius: f32,
}

/// Radii of the largest vertex, at most and at least.
const RADII: [f32; 2] = [15.0, 5.0];
/// Side of a cell, at most.
const CELL: f32 = 110.0;
/// Share of a cell between its middle and the vertices that have it together.
const APART: f32 = 0.28;
/// Distances between neighbouring columns, and between neighbours in one.
const STEP: [f32; 2] = [96.0, 62.0];
/// Height of a row of vertices that are nowhere.
const ROW: f32 = 44.0;

impl Layout {
    /// The layout in a picture whose ground begins at (`x`, `y`) and is at most `wide`.
    pub(super) fn of(ground: Ground<'_>, graph: &Graph, (x, y, wide): (f32, f32, f32)) -> Self {
        let cells = match ground {
            Ground::Map(map) => {
                let view = View::fit(map.bounds, Area { x, y, w: wide, h: wide * map.shape() });
                // The ground is the area that the map fills.
                let place = |at| Some(view.at(at));
                return Self::standing(graph, view.area, 0.0, place);
            }
            Ground::Layers => return Self::layers(graph, (x, y)),
            Ground::Picture { cells, .. } => {
                Rect { min: [0.0; 2], max: cells.map(|count| count.max(1) as f32) }
            }
            Ground::Lattice => lattice(graph),
        };
        let [columns, rows] = cells.size();
        let cell = (wide / columns).min(wide / rows).min(CELL).floor().max(1.0);
        let area = Area { x, y, w: columns * cell, h: rows * cell };
        let place = |[column, row]: [f32; 2]| {
            Some((x + (column - cells.min[0] + 0.5) * cell, y + (row - cells.min[1] + 0.5) * cell))
        };
        Self::standing(graph, area, cell, place)
    }

    /// Vertices at their positions; those at one place around it, those that are nowhere in rows below.
    fn standing(
        graph: &Graph,
        area: Area,
        cell: f32,
        place: impl Fn([f32; 2]) -> Option<(f32, f32)>,
    ) -> Self {
        let position = |index: usize| {
            let at = graph.vertices[index].at.filter(|at| at.iter().all(|x| x.is_finite()));
            // Far outside is as good as outside, and keeps the rasteriser from overflowing.
            at.and_then(&place).map(|(x, y)| (x.clamp(-1e4, 1e4), y.clamp(-1e4, 1e4)))
        };
        let mut together: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
        let mut nowhere = Vec::new();
        for index in 0..graph.vertices.len() {
            match position(index) {
                Some((x, y)) => together.entry([x, y].map(|x| (2.0 * x) as i64)).or_default().push(index),
                None => nowhere.push(index),
            }
        }
        let mut at = vec![(0.0, 0.0); graph.vertices.len()];
        let apart = if cell > 0.0 { APART * cell } else { RADII[0] };
        for members in together.values() {
            for (nth, &index) in members.iter().enumerate() {
                let (x, y) = position(index).unwrap_or_default();
                let turn = std::f32::consts::TAU * (nth as f32 / members.len() as f32 - 0.375);
                let off = if members.len() > 1 { apart } else { 0.0 };
                at[index] = (x + off * turn.cos(), y + off * turn.sin());
            }
        }
        let a_row = (area.w / ROW).floor().max(1.0) as usize;
        for (nth, &index) in nowhere.iter().enumerate() {
            let (column, row) = (nth % a_row, nth / a_row);
            at[index] = (area.x + (column as f32 + 0.5) * ROW, area.bottom() + (row as f32 + 0.6) * ROW);
        }
        let bottom = area.bottom() + nowhere.len().div_ceil(a_row) as f32 * ROW;
        Self { area, bottom, cell, radius: radius(&at), at }
    }

    /// Columns by the least number of edges from the start; what no edge leads to stands in a column of its own.
    fn layers(graph: &Graph, (x, y): (f32, f32)) -> Self {
        let columns = columns(graph);
        let tallest = columns.iter().map(Vec::len).max().unwrap_or(0).max(1);
        let h = tallest as f32 * STEP[1];
        let mut at = vec![(0.0, 0.0); graph.vertices.len()];
        for (column, members) in columns.iter().enumerate() {
            let top = y + (h - members.len() as f32 * STEP[1]) / 2.0;
            for (row, &index) in members.iter().enumerate() {
                at[index] = (x + (column as f32 + 0.5) * STEP[0], top + (row as f32 + 0.5) * STEP[1]);
            }
        }
        let area = Area { x, y, w: columns.len().max(1) as f32 * STEP[0], h };
        Self { area, bottom: area.bottom(), cell: 0.0, radius: RADII[0], at }
    }
}

/// The cells that the positions need.
fn lattice(graph: &Graph) -> Rect {
    let places =
        || graph.vertices.iter().filter_map(|vertex| vertex.at).filter(|at| at.iter().all(|x| x.abs() < 1e4));
    let span = |axis: usize| {
        let low = places().map(|at| at[axis].floor()).fold(f32::INFINITY, f32::min);
        let high = places().map(|at| at[axis].ceil()).fold(f32::NEG_INFINITY, f32::max);
        if low > high { (0.0, 1.0) } else { (low, high + 1.0) }
    };
    let ((left, right), (top, bottom)) = (span(0), span(1));
    Rect { min: [left, top], max: [right, bottom] }
}

/// The vertices column by column. Within a column they stand in the order of the mean height of those before them, so
/// that few edges cross.
fn columns(graph: &Graph) -> Vec<Vec<usize>> {
    let count = graph.vertices.len();
    let mut depth = vec![None; count];
    let starts = (0..count).filter(|&index| graph.vertices[index].role == Role::Start);
    let mut queue: VecDeque<usize> = starts.collect();
    if queue.is_empty() && count > 0 {
        queue.push_back(0);
    }
    queue.iter().for_each(|&start| depth[start] = Some(0));
    while let Some(from) = queue.pop_front() {
        for edge in graph.edges.iter().filter(|edge| edge.from == from && edge.to < count) {
            if depth[edge.to].is_none() {
                depth[edge.to] = depth[from].map(|depth| depth + 1);
                queue.push_back(edge.to);
            }
        }
    }
    let deepest = depth.iter().flatten().max().map_or(0, |depth| depth + 1);
    let mut columns = vec![Vec::new(); deepest + usize::from(depth.contains(&None))];
    for (index, depth) in depth.iter().enumerate() {
        columns[depth.unwrap_or(deepest)].push(index);
    }
    let mut height = vec![0.0; count];
    for column in &mut columns {
        let mut means: Vec<(f32, usize)> = column
            .iter()
            .map(|&index| {
                let before: Vec<f32> = graph
                    .edges
                    .iter()
                    .filter(|edge| edge.to == index && edge.from < count && depth[edge.from] < depth[index])
                    .map(|edge| height[edge.from])
                    .collect();
                (before.iter().sum::<f32>() / before.len().max(1) as f32, index)
            })
            .collect();
        means.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        *column = means.into_iter().map(|(_, index)| index).collect();
        for (row, &index) in column.iter().enumerate() {
            height[index] = row as f32 - (column.len() as f32 - 1.0) / 2.0;
        }
    }
    columns
}

/// The radius at which four in five vertices do not touch their nearest neighbour.
fn radius(at: &[(f32, f32)]) -> f32 {
    let nearest = |index: usize| {
        let others = at.iter().enumerate().filter(|&(other, _)| other != index);
        let distances = others.map(|(_, &(x, y))| (x - at[index].0).hypot(y - at[index].1));
        distances.fold(f32::INFINITY, f32::min)
    };
    let mut distances: Vec<f32> = (0..at.len()).map(nearest).collect();
    distances.sort_by(f32::total_cmp);
    let tight = distances.get(distances.len() / 5).copied().unwrap_or(f32::INFINITY);
    (0.4 * tight).clamp(RADII[1], RADII[0])
}

#[cfg(test)]
mod tests {
    use super::super::{Edge, Vertex};
    use super::*;

    fn graph(ats: &[Option<[f32; 2]>], edges: &[(usize, usize)]) -> Graph {
        let vertices = ats.iter().map(|&at| Vertex { at, ..Vertex::default() });
        let edges = edges.iter().map(|&(from, to)| Edge { from, to, ..Edge::default() });
        Graph { vertices: vertices.collect(), edges: edges.collect(), ..Graph::default() }
    }

    #[test]
    fn columns_are_distances_from_the_start_and_keep_neighbours_together() {
        let mut tree = graph(&[None; 8], &[(2, 0), (2, 1), (0, 4), (1, 3), (3, 4), (4, 2), (9, 9), (5, 6)]);
        assert_eq!(columns(&tree), [vec![0], vec![4], vec![2], vec![1], vec![3], vec![5, 6, 7]]);
        tree.vertices[2].role = Role::Start;
        // 4 follows 0 and 3 follows 1, so 4 stands above 3.
        assert_eq!(columns(&tree), [vec![2], vec![0, 1], vec![4, 3], vec![5, 6, 7]]);
        assert!(columns(&graph(&[], &[])).is_empty());
    }

    #[test]
    fn cells_are_counted_downwards_and_shared_places_are_spread() {
        let at = [Some([2.0, 1.0]), Some([2.0, 3.0]), Some([4.0, 1.0]), Some([4.0, 1.0]), None];
        let layout = Layout::of(Ground::Lattice, &graph(&at, &[]), (10.0, 20.0, 330.0));
        assert_eq!((layout.cell, layout.area.w, layout.area.h), (110.0, 330.0, 330.0));
        assert_eq!((layout.at[0], layout.at[1]), ((65.0, 75.0), (65.0, 295.0)));
        let middle = ((layout.at[2].0 + layout.at[3].0) / 2.0, (layout.at[2].1 + layout.at[3].1) / 2.0);
        assert!((middle.0 - 285.0).abs() < 1e-3 && (middle.1 - 75.0).abs() < 1e-3, "{middle:?}");
        assert!(layout.at[2] != layout.at[3] && layout.at[4].1 > layout.area.bottom());
    }
}
