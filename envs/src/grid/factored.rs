//! DoorKey as a handful of factors, for methods that ask what each of them is good for (thesis 9.2.3.1).

use inroads_sim::raster::{Format, Frame};

use super::{Cell, Door, GridError, GridPainter, GridWorld, Maker, Pay, State};
use crate::world::{Card, Draw, Drawn, Fact, Layout, Painter, World};
use crate::{Dimension, Snapshot, Step};

/// DoorKey seen as nine numbers, none of which follows from the others: where the agent is and looks, whether it has the
/// key, where that lies or was picked up, and the door.
///
/// A grid's symbols are the whole board, cell by cell, in which one event changes many numbers: taking the key empties a
/// cell and fills a hand. Here it changes one. Rules, reward and limit are as the thesis' author has them (7.3.1): success
/// pays 1, all episodes have one layout, 200 steps.
#[derive(Clone, Debug)]
pub struct FactoredDoorKey {
    world: GridWorld,
    /// Where the key lies, or was picked up.
    key: [u8; 2],
}

impl FactoredDoorKey {
    /// A world of `size` by `size` cells.
    ///
    /// # Errors
    /// [`GridError::Size`] when there is no such door-key.
    pub fn new(size: u32) -> Result<Self, GridError> {
        let world = GridWorld::new(Maker::DoorKey { size })?.paying(Pay::One).laid_out(Layout::Fixed(42));
        Ok(Self { world: world.limited(super::DOOR_KEY)?, key: [0, 0] })
    }

    /// The cell of the first thing of a kind, if there is one.
    fn find(&self, wanted: fn(Cell) -> bool) -> Option<([u8; 2], Cell)> {
        self.world.state().board.cells().find(|(_, cell)| wanted(*cell))
    }

    fn look_for_the_key(&mut self) {
        self.key = self.find(|cell| matches!(cell, Cell::Key(_))).map_or(self.key, |(at, _)| at);
    }
}

impl Snapshot for FactoredDoorKey {
    type State = (State, [u8; 2]);

    fn save(&self) -> Self::State {
        (self.world.save(), self.key)
    }

    fn load(&mut self, (state, key): &Self::State) {
        self.world.load(state);
        self.key = *key;
    }
}

impl World for FactoredDoorKey {
    fn card(&self) -> Card {
        let card = self.world.card();
        let [x, y] = [&card.symbols[0], &card.symbols[1]].map(|place| place.high);
        let symbols = [
            ("x", x),
            ("y", y),
            ("direction", 3.0),
            ("has key", 1.0),
            ("key x", x),
            ("key y", y),
            ("door x", x),
            ("door y", y),
            ("door", 2.0),
        ];
        let symbols = symbols.map(|(name, high)| Dimension::linear(name, "", 0.0, high)).into();
        Card { symbols, ..card }
    }

    fn begin(&mut self, draw: Draw) {
        self.world.begin(draw);
        self.look_for_the_key();
    }

    fn act(&mut self, choice: usize) -> Step {
        let step = self.world.act(choice);
        self.look_for_the_key();
        step
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        let State { pose, carried, .. } = self.world.state();
        let (at, door) = match self.find(|cell| matches!(cell, Cell::Door(..))) {
            Some((at, Cell::Door(_, door))) => (at, door),
            _ => ([0, 0], Door::Open),
        };
        let has_key = u8::from(*carried != Cell::Empty);
        let numbers = [
            pose.at[0],
            pose.at[1],
            pose.facing as u8,
            has_key,
            self.key[0],
            self.key[1],
            at[0],
            at[1],
            door as u8,
        ];
        out.clear();
        out.extend(numbers.map(f32::from));
    }

    fn facts(&self) -> Vec<Fact> {
        self.world.facts()
    }

    fn told(&self) -> Option<String> {
        self.world.told()
    }
}

impl Drawn for FactoredDoorKey {
    type Painter = GridPainter;

    fn painter(&self, format: Format) -> GridPainter {
        self.world.painter(format)
    }
}

impl Painter<FactoredDoorKey> for GridPainter {
    fn shape(&self) -> ([u32; 2], u32) {
        Painter::<GridWorld>::shape(self)
    }

    fn paint(&mut self, world: &FactoredDoorKey, out: &mut Frame) {
        self.paint(&world.world, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is seen in the course of these choices, the beginning included.
    fn seen(layout: Layout, choices: &[usize]) -> Vec<Vec<f32>> {
        let mut world = FactoredDoorKey::new(5).unwrap();
        world.begin(layout.draw(0));
        let mut seen = Vec::new();
        let mut look = |world: &FactoredDoorKey| {
            let mut out = vec![9.0];
            world.symbols(&mut out);
            seen.push(out);
        };
        look(&world);
        for choice in choices {
            world.act(*choice);
            look(&world);
        }
        seen
    }

    /// Turns to look for the key until it is in hand: the agent of the 5 × 5 world stands in a column of three cells with it.
    #[test]
    fn taking_the_key_changes_one_number_and_dropping_it_moves_it() {
        let (mut taken, mut dropped) = (0, 0);
        for seed in 0..20 {
            let all = [0, 3, 2, 3, 0, 4, 3, 0, 3, 2, 4, 2, 3, 0, 3, 4];
            for pair in seen(Layout::Fixed(seed), &all).windows(2) {
                let changed: Vec<_> = (0..9).filter(|i| pair[0][*i] != pair[1][*i]).collect();
                match pair[1][3] - pair[0][3] {
                    1.0 => {
                        assert_eq!(changed, [3]);
                        taken += 1;
                    }
                    -1.0 => {
                        assert!(changed.contains(&3) && changed.iter().all(|i| [3, 4, 5].contains(i)));
                        dropped += 1;
                    }
                    _ => assert!(!changed.contains(&4) && !changed.contains(&5), "the key moves by itself"),
                }
            }
        }
        assert!(taken > 5 && dropped > 2, "{taken} {dropped}");
    }

    #[test]
    fn the_numbers_say_what_the_board_has() {
        let mut world = FactoredDoorKey::new(6).unwrap();
        world.begin(Layout::Fixed(42).draw(7));
        let mut out = Vec::new();
        world.symbols(&mut out);
        let facts = world.facts();
        let fact = |name: &str| facts.iter().find(|fact| fact.name == name).unwrap().value;
        assert_eq!((out[0], out[1], out[3]), (fact("x"), fact("y"), fact("has key")));
        assert_eq!(out[8], fact(&format!("door {} {}", out[6], out[7])));
        assert_eq!(
            world.world.state().board.get([out[4] as u8, out[5] as u8]),
            Cell::Key(super::super::Colour::Yellow)
        );
        assert!(FactoredDoorKey::new(4).is_err());
    }
}
