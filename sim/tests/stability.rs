//! Ten thousand random control steps in each maze. `examples/stability.rs` does a million.

#[path = "support/stability.rs"]
mod stability;

use inroads_sim::rigid::{
    CellMap,
    ant::{THESIS, world},
};

#[test]
fn random_play_stays_within_the_walls_of_every_maze() {
    for (name, text, scale) in stability::MAZES {
        let map = CellMap::parse(text, scale).unwrap();
        let mut ant = world(&THESIS, Some(&map)).unwrap();
        let report = stability::play(&mut ant, &map, 10_000, 2);
        assert!(report.holds(), "{name}: {report:#?}");
        assert!(report.touching > 50, "{name}: walls were hardly met, {report:#?}");
    }
}
