//! The maps of the thesis' mazes, as texts that [`CellMap::parse`](inroads_sim::rigid::CellMap::parse) reads.
//!
//! `#` wall, `.` free, `r` start, `g` goal, `k` key. The first start is the origin, x grows to the right and
//! y downwards in the text (upwards in the pictures).

/// Round three sides of a U (rllab; thesis section 3.2). With cells of 4 m: from (0, 0) to (0, 8).
pub const U: &str = "\
#####
#r..#
###.#
#g..#
#####";

/// A straight corridor of three cells, of ours, where learners can be tested in seconds.
pub const CORRIDOR: &str = "\
#####
#r.g#
#####";

/// An E with a start on its top and its bottom rung and the goal on the middle one (thesis section 3.2). The
/// map's file was never published; this is the natural reading, with the goal where Point-Maze has it.
pub const E: &str = "\
#####
#r..#
###.#
#g..#
###.#
#r..#
#####";

/// D4RL's medium maze (Fu et al. 2020). With cells of 4 m: from (0, 0) to (20, 20).
pub const MEDIUM: &str = "\
########
#r.##..#
#..#...#
##...###
#..#...#
#.#..#.#
#...#.g#
########";

/// D4RL's large maze (Fu et al. 2020). With cells of 4 m: from (0, 0) to (32, 24).
pub const LARGE: &str = "\
############
#r...#.....#
#.##.#.#.#.#
#......#...#
#.####.###.#
#..#.#.....#
##.#.#.#.###
#..#...#.g.#
############";

/// Four rooms with a door between neighbours (Sutton et al. 1999; layout of the author's code of chapter 4).
/// With cells of 3 m: from the middle of one room, (0, 0), to that of the opposite one, (12, 12).
pub const FOUR_ROOMS: &str = "\
#########
#...#...#
#.r.....#
#...#...#
##.###.##
#...#...#
#.....g.#
#...#...#
#########";

/// The same rooms with a key in the opposite one, (8, 8), and the lock above the start, (0, 8); cells of 2 m,
/// coordinates of the author's code of chapter 3.
pub const LOCK_AND_KEY: &str = "\
#########
#...#...#
#.r.....#
#...#...#
##.###.##
#...#...#
#.g...k.#
#...#...#
#########";

/// An open square arena with the origin in its middle (author's code of chapter 4; thesis section 4.2.3).
/// With cells of 3 m its floor reaches from −10.5 to 10.5.
pub const ARENA: &str = "\
#########
#.......#
#.......#
#.......#
#...r...#
#.......#
#.......#
#.......#
#########";
