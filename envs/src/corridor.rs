//! A row of cells, small enough for every value to be known by hand.

use inroads_sim::{
    Shape,
    rigid::{Pose, Rectangle, Vector},
    view::{Mark, Scene, Solid},
};

use crate::registry::{AnyEnvironment, Entry, Make};
use crate::{Dimension, Drawing, End, Environment, Goal, Refused, Render, Space, Spec, Step, TimeLimit};

/// The corridors of the registry. Episodes are long enough for a random walk to arrive, which takes about `n²` steps.
pub(crate) const ENTRIES: &[Entry] = &[
    Entry {
        name: "corridor-5",
        about: "five cells in a row, walked from one end to the other; -1 a step",
        make: Make::Bodies { make: || limited("corridor-5", 5, 50), picture: || None },
    },
    Entry {
        name: "corridor-20",
        about: "twenty cells in a row",
        make: Make::Bodies { make: || limited("corridor-20", 20, 400), picture: || None },
    },
    Entry {
        name: "corridor-50",
        about: "fifty cells in a row",
        make: Make::Bodies { make: || limited("corridor-50", 50, 2500), picture: || None },
    },
];

fn limited(name: &'static str, cells: usize, steps: u32) -> AnyEnvironment {
    AnyEnvironment::Choices(Box::new(TimeLimit::new(Corridor::named(name, cells), steps)))
}

/// `n` cells in a row: 0 steps left, 1 steps right, from the first cell to the last; the ends stop one.
///
/// A step costs 1 and the one that arrives costs nothing, so that the undiscounted value of cell `i` is
/// `-(n - 2 - i)`.
#[derive(Clone, Debug)]
pub struct Corridor {
    spec: Spec,
    last: usize,
    at: usize,
    over: bool,
}

impl Corridor {
    /// A corridor of `n` cells, at least two.
    pub fn new(n: usize) -> Self {
        Self::named("corridor", n)
    }

    /// The same under a registry's name.
    pub fn named(name: &'static str, n: usize) -> Self {
        let last = n.max(2) - 1;
        let spec = Spec {
            name,
            about: "a row of cells, walked from one end to the other; -1 a step",
            observation: Space::Box([Dimension::linear("cell", "", 0.0, last as f32)].into()),
            action: Space::Discrete(2),
            goal: Some(Goal { dims: vec![0], at: vec![last as f32], tolerance: 0.25 }),
            place: vec![0],
            time_limit: None,
            success_reward: 0.0,
        };
        Self { spec, last, at: 0, over: true }
    }
}

impl Environment for Corridor {
    type Observation = Vec<f32>;
    type Action = usize;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, _seed: u64) {
        self.at = 0;
        self.over = false;
    }

    fn step(&mut self, action: &usize) -> Result<Step, Refused> {
        if self.over {
            return Err(Refused::Over);
        }
        self.spec.action.admit_choice(*action)?;
        self.at = if *action == 1 { self.at + 1 } else { self.at.saturating_sub(1) };
        self.over = self.at == self.last;
        Ok(match self.over {
            true => Step { reward: 0.0, end: Some(End::Terminated) },
            false => Step { reward: -1.0, end: None },
        })
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        out.clear();
        out.push(self.at as f32);
    }
}

impl Render for Corridor {
    fn choices(&self) -> &'static [&'static str] {
        &["left", "right"]
    }

    fn drawing(&self) -> Drawing {
        let last = self.last as f32;
        let walker = Solid {
            shape: Shape::Ball { radius: 0.3 },
            pose: Pose::from_translation(Vector::new(self.at as f32, 0.0, 0.3)),
            colour: [214, 96, 77],
        };
        Drawing::Bodies(Scene {
            solids: vec![walker],
            marks: vec![Mark { at: [last, 0.0], radius: 0.4, colour: [77, 175, 74] }],
            trail: Vec::new(),
            bounds: Rectangle { low: [-0.5, -0.5], high: [f64::from(last) + 0.5, 0.5] },
            focus: Vector::new(last / 2.0, 0.0, 0.0),
            distance: 1.5 * last,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_right_costs_three_in_five_cells() {
        let mut corridor = Corridor::new(5);
        corridor.reset(0);
        let steps: Vec<_> = [0, 1, 1, 1, 1].iter().map(|action| corridor.step(action).unwrap()).collect();
        assert_eq!(
            steps.iter().map(|step| step.reward).sum::<f32>(),
            -4.0,
            "the first step ran into the end"
        );
        assert!(corridor.spec().succeeded(&steps[4]));
        let mut seen = Vec::new();
        corridor.observe(&mut seen);
        assert!(corridor.spec().goal.as_ref().unwrap().reached(&seen));
        assert_eq!(corridor.step(&1), Err(Refused::Over));
    }
}
