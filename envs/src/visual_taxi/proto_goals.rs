//! Questions about where taxis and passengers are.

use super::VisualTaxi;
use crate::{Bits, ProtoGoals};

/// One question for each cell that the taxi can be in; for each passenger one for each cell, one for the taxi, one for
/// each depot that they may want to go to.
impl ProtoGoals for VisualTaxi {
    fn proto_goals(&self) -> Vec<String> {
        let size = self.settings.town.size();
        let cells = || (0..size).flat_map(move |row| (0..size).map(move |column| (row, column)));
        let mut goals: Vec<String> = cells().map(|(row, column)| format!("taxi at {row},{column}")).collect();
        for nth in 0..self.settings.passengers {
            let who = self.who(nth);
            goals.extend(cells().map(|(row, column)| format!("{who} at {row},{column}")));
            goals.push(format!("{who} in taxi"));
            goals.extend(self.settings.town.depots().iter().map(|depot| format!("{who} to {}", depot.name)));
        }
        goals
    }

    fn annotate(&self, out: &mut Bits) {
        let size = usize::from(self.settings.town.size());
        let (cells, depots) = (size * size, self.settings.town.depots().len());
        let number = |[row, column]: [u8; 2]| usize::from(row) * size + usize::from(column);
        out.clear(cells + self.settings.passengers * (cells + 1 + depots));
        out.set(number(self.state.taxi));
        for (nth, passenger) in self.state.passengers.iter().enumerate() {
            let first = cells + nth * (cells + 1 + depots);
            out.set(first + number(passenger.cell));
            if passenger.aboard {
                out.set(first + cells);
            }
            out.set(first + cells + 1 + usize::from(passenger.goal));
        }
    }

    fn cell(&self, bit: usize) -> Option<[usize; 2]> {
        let size = usize::from(self.settings.town.size());
        let (cells, depots) = (size * size, self.settings.town.depots().len());
        let nth = bit.checked_sub(cells).map_or(bit, |bit| bit % (cells + 1 + depots));
        (nth < cells).then_some([nth % size, nth / size])
    }
}
