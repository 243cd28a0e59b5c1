//! Every point maze of the registry can be solved well within its limit: a walker that knows the map does it.

use std::collections::{HashMap, VecDeque};

use inroads_envs::{
    Environment, Pay,
    maze::{
        PointMaze,
        catalogue::{ALL, Listed, Walker},
    },
};
use inroads_sim::rigid::CellMap;

/// Centres of cells on a shortest way through the map, if there is one.
fn way(map: &CellMap, from: [f64; 2], to: [f64; 2]) -> Option<Vec<[f64; 2]>> {
    let side = map.scale();
    let cell = |at: [f64; 2]| at.map(|x| (x / side).round() as i64);
    let centre = |cell: [i64; 2]| cell.map(|x| x as f64 * side);
    let (first, last) = (cell(from), cell(to));
    let mut before = HashMap::from([(first, first)]);
    let mut queue = VecDeque::from([first]);
    while let Some(at) = queue.pop_front() {
        for [dx, dy] in [[1, 0], [-1, 0], [0, 1], [0, -1]] {
            let next = [at[0] + dx, at[1] + dy];
            if !map.is_wall(centre(next)) && !before.contains_key(&next) {
                before.insert(next, at);
                queue.push_back(next);
            }
        }
    }
    let mut cells = vec![last];
    while cells[cells.len() - 1] != first {
        cells.push(*before.get(&cells[cells.len() - 1])?);
    }
    Some(cells.iter().rev().map(|&cell| centre(cell)).chain([to]).collect())
}

/// Steps that the walker takes; none when it is not there in time.
fn walk(listed: &Listed, seed: u64) -> Option<u32> {
    let Walker::Point(stride) = listed.walker else { return None };
    let maze = &listed.maze;
    let map = CellMap::parse(maze.cells, maze.scale).unwrap();
    let mut env = PointMaze::striding(maze, stride).unwrap();
    env.reset(seed);
    let picture = env.picture();
    let mut stops = [picture.key, Some(picture.goal)].into_iter().flatten();
    let mut ahead: VecDeque<[f64; 2]> = VecDeque::new();
    for step in 1..=maze.limit {
        let state = env.state();
        let near = |at: &[f64; 2]| (at[0] - state.x).hypot(at[1] - state.y) < 0.5;
        while ahead.front().is_some_and(near) {
            ahead.pop_front();
        }
        if ahead.is_empty() {
            ahead.extend(way(&map, [state.x, state.y], stops.next().unwrap_or(picture.goal))?);
        }
        let to = ahead[0];
        let (dx, dy) = (to[0] - state.x, to[1] - state.y);
        let off = (dy.atan2(dx) - state.theta).sin().atan2((dy.atan2(dx) - state.theta).cos());
        let turn = (4.0 * off).clamp(-1.0, 1.0);
        let after = off - turn / 4.0;
        let forward = if after.abs() < 0.2 { (dx.hypot(dy) / stride.metres()).min(1.0) } else { 0.0 };
        if env.step(&vec![forward as f32, turn as f32]).unwrap().end.is_some() {
            return Some(step);
        }
    }
    None
}

#[test]
fn a_walker_that_knows_the_map_solves_every_point_maze_in_half_its_limit() {
    // Where nothing is paid nothing is solved.
    let point = |listed: &&Listed| listed.walker != Walker::Ant && listed.maze.pay != Pay::Nothing;
    for listed in ALL.iter().filter(point) {
        let steps: Vec<_> = (0..10).map(|seed| walk(listed, seed)).collect();
        let limit = listed.maze.limit / 2;
        assert!(
            steps.iter().all(|steps| steps.is_some_and(|steps| steps < limit)),
            "{}: {steps:?}",
            listed.maze.name
        );
    }
}

#[test]
fn every_ant_maze_has_a_way_to_its_goal() {
    for listed in ALL.iter().filter(|listed| listed.walker == Walker::Ant) {
        let map = CellMap::parse(listed.maze.cells, listed.maze.scale).unwrap();
        let goal = listed.maze.goal.unwrap_or_else(|| map.goals()[0]);
        assert!(map.starts().iter().all(|&start| way(&map, start, goal).is_some()), "{}", listed.maze.name);
    }
}
