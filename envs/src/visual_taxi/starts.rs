//! Where taxis and passengers begin.

use rand::{RngExt, seq::SliceRandom};

use super::{Passenger, VisualTaxi};
use crate::{Rng, world::Draw};

/// How episodes start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Starts {
    /// Passengers wait at depots, each at one of their own, not all where they want to go; the taxi is at another. Of
    /// several some may be where they want to go.
    #[default]
    Classic,
    /// Passengers are anywhere; with probability ½ the taxi is with one of them, who then is aboard with probability ½.
    /// Otherwise it is anywhere too.
    Exploring,
}

/// How often a start is drawn before one is constructed. Each draw fails with probability ¼ at most.
const TRIES: usize = 100;

impl VisualTaxi {
    /// Begins an episode.
    pub(super) fn start(&mut self, draw: Draw) {
        let mut rng = draw.layout();
        let exploring = self.settings.starts == Starts::Exploring;
        if !exploring || !(0..TRIES).any(|_| self.start_exploring(&mut rng)) {
            self.start_classic(&mut rng);
        }
        let Some(mut rng) = draw.start() else { return };
        // Anywhere, but not onto another passenger with one aboard: no rule leads there.
        let aboard = self.state.aboard();
        let size = self.settings.town.size();
        let cells = (0..size).flat_map(|row| (0..size).map(move |column| [row, column]));
        let open = |&cell: &[u8; 2]| aboard.is_none_or(|rider| !self.state.taken(cell, rider));
        let cells: Vec<[u8; 2]> = cells.filter(open).collect();
        let taxi = cells[rng.random_range(0..cells.len())];
        self.state.taxi = taxi;
        if let Some(rider) = aboard {
            self.state.passengers[rider].cell = taxi;
        }
    }

    fn anywhere(&self, rng: &mut Rng) -> [u8; 2] {
        let size = self.settings.town.size();
        [rng.random_range(0..size), rng.random_range(0..size)]
    }

    /// Passengers and taxi at depots of their own.
    fn start_classic(&mut self, rng: &mut Rng) {
        let depots = self.settings.town.depots();
        let mut order: Vec<u8> = (0..depots.len() as u8).collect();
        order.shuffle(rng);
        let mut goals = order.clone();
        let drawn = (0..TRIES).any(|_| {
            goals.shuffle(rng);
            order.iter().zip(&goals).take(self.settings.passengers).any(|(start, goal)| start != goal)
        });
        if !drawn {
            goals.clone_from(&order);
            goals.rotate_left(1);
        }
        self.state.taxi = depots[usize::from(order[order.len() - 1])].cell;
        let pairs = order.iter().zip(&goals).take(self.settings.passengers);
        let waiting = |(&start, &goal): (&u8, &u8)| {
            let cell = depots[usize::from(start)].cell;
            Passenger { cell, aboard: false, goal }
        };
        self.state.passengers.clear();
        self.state.passengers.extend(pairs.map(waiting));
    }

    /// Passengers anywhere. Says whether there is something left to do, and everyone has a cell.
    fn start_exploring(&mut self, rng: &mut Rng) -> bool {
        let mut goals: Vec<u8> = (0..self.settings.town.depots().len() as u8).collect();
        goals.shuffle(rng);
        self.state.taxi = self.anywhere(rng);
        self.state.passengers.clear();
        for &goal in &goals[..self.settings.passengers] {
            let cell = self.anywhere(rng);
            self.state.passengers.push(Passenger { cell, aboard: false, goal });
        }
        if rng.random_bool(0.5) {
            let with = rng.random_range(0..self.settings.passengers);
            self.state.taxi = self.state.passengers[with].cell;
            self.state.passengers[with].aboard = rng.random_bool(0.5);
        }
        let passengers = &self.state.passengers;
        let apart = (0..passengers.len()).all(|nth| !self.state.taken(passengers[nth].cell, nth));
        apart && !self.solved()
    }
}
