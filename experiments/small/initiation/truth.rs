//! What is true: the probability that an option, as its policy is now, succeeds within its horizon, by dynamic
//! programming over the cells.

use inroads::agents::tabular::TabularQ;

use super::practice::{GOALS, HORIZON, rooms, seen};

/// Four rooms as a list of cells and where each choice leads.
pub(super) struct Cells {
    pub(super) at: Vec<[u8; 2]>,
    to: Vec<[usize; 4]>,
    slip: f64,
}

impl Cells {
    pub(super) fn new(slip: f64) -> Self {
        let world = rooms(GOALS[0], slip);
        let at: Vec<[u8; 2]> = world.cells().collect();
        let index = |cell: [u8; 2]| at.iter().position(|known| *known == cell);
        // Left, right, up, down; walls stop one.
        let around = |[x, y]: [u8; 2]| [[x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]];
        let to = at
            .iter()
            .enumerate()
            .map(|(here, cell)| around(*cell).map(|next| index(next).unwrap_or(here)))
            .collect();
        Self { to, at, slip }
    }

    /// The number of a cell.
    pub(super) fn index(&self, cell: [u8; 2]) -> usize {
        self.at.iter().position(|known| *known == cell).expect("the cell is free")
    }

    /// f_h(s) = Σ π(a|s) Σ P(s′|s, a) (1 at the goal, else f_{h−1}(s′)), with h the horizon; the greedy policy breaks
    /// ties evenly.
    pub(super) fn success(&self, goal: [u8; 2], policy: &TabularQ) -> Vec<f64> {
        let end = self.index(goal);
        let chances: Vec<[f64; 4]> = self.at.iter().map(|cell| self.moves(*cell, goal, policy)).collect();
        let mut value = vec![0.0; self.at.len()];
        for _ in 0..HORIZON {
            value[end] = 1.0;
            value = (0..self.at.len())
                .map(|s| chances[s].iter().zip(self.to[s]).map(|(p, to)| p * value[to]).sum())
                .collect();
        }
        value[end] = 1.0;
        value
    }

    /// How probable each move is: the policy's choice, or where it goes astray.
    fn moves(&self, cell: [u8; 2], goal: [u8; 2], policy: &TabularQ) -> [f64; 4] {
        let values = policy.action_values::<()>(&seen(cell, goal), None);
        let best = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let ties = values.iter().filter(|value| **value == best).count() as f64;
        let chosen: Vec<f64> = values.iter().map(|v| if *v == best { 1.0 / ties } else { 0.0 }).collect();
        [0, 1, 2, 3].map(|a| chosen[a] * (1.0 - self.slip) + (1.0 - chosen[a]) * self.slip / 3.0)
    }
}
