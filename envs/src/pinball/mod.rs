//! Pinball: a ball is pushed through obstacles to a target (Konidaris and Barto 2009; thesis chapter 7).
//!
//! The rules are those of Bacon's port as rlpy keeps it. A [`Configuration`] is the board as data, five of them the
//! peers'; [`Rules`] say what a step pays and how often an action goes astray.

mod board;
mod configuration;
mod format;
mod layouts;
mod physics;
mod picture;

use std::sync::Arc;

use rand::{RngExt, SeedableRng};

pub use configuration::{Configuration, UnknownConfiguration};
pub use format::{ConfigurationError, LineError};
pub use physics::{Ball, SUBSTEPS};
pub use picture::BallPainter;

use crate::registry::{Entry, Make};
use crate::world::{Card, Draw, Drawn, Fact, Grain, Layout, See, World};
use crate::{Dimension, End, Rng, Seed, Snapshot, Step};
use inroads_sim::raster::Format;

/// The worlds of the registry.
pub(crate) const ENTRIES: &[Entry] = &[
    Entry {
        name: "pinball",
        about: "a ball is pushed through the hardest of five boards to a target; 10000 there, -1 or -5 a step",
        make: Make::World(|| Box::new(known("hard_single", Rules::default()))),
    },
    Entry {
        name: "pinball-simple",
        about: "pinball on a board with six obstacles",
        make: Make::World(|| Box::new(known("simple_single", Rules::default()))),
    },
    Entry {
        name: "pinball-medium",
        about: "pinball on a board with five obstacles, one of which counts twice",
        make: Make::World(|| Box::new(known("medium", Rules::default()))),
    },
    Entry {
        name: "pinball-box",
        about: "pinball on a board with a square in the middle",
        make: Make::World(|| Box::new(known("box", Rules::default()))),
    },
    Entry {
        name: "pinball-empty",
        about: "pinball on a board with nothing but its sides",
        make: Make::World(|| Box::new(known("empty", Rules::default()))),
    },
    Entry {
        name: "pinball-thesis",
        about: "the hardest board as the thesis has it: seen as a picture, 1 at the target and 0 otherwise",
        make: Make::World(|| Box::new(known("hard_single", Rules::THESIS))),
    },
];

fn known(configuration: &str, rules: Rules) -> Pinball {
    let configuration =
        Configuration::named(configuration).expect("the registry names configurations that exist");
    Pinball::new(configuration, rules).expect("the registry's rules are sound")
}

/// What a step pays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pay {
    /// rlpy's: −1 a step without a push, −5 with one, 10,000 at the target.
    #[default]
    Effort,
    /// The thesis author's: 1 at the target, 0 otherwise.
    Target,
}

/// What may differ between tasks on the same board.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rules {
    /// What a step pays.
    pub pay: Pay,
    /// How often, of 1, the action is replaced by one of the five drawn uniformly: 0.1 in rlpy unless told otherwise,
    /// 0 here and in the thesis author's code.
    pub noise: f64,
}

impl Rules {
    /// Those of the thesis author's code.
    pub const THESIS: Self = Self { pay: Pay::Target, noise: 0.0 };
}

/// Why there is no such pinball, or no such ball.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PinballError {
    /// The noise is no probability.
    #[error("actions cannot go astray with probability {0}; give a number between 0 and 1 (rlpy has 0.1)")]
    Noise(f64),
    /// A ball is nowhere, or has no velocity.
    #[error("a ball cannot be {0:?}; places and velocities are finite numbers")]
    Ball(Ball),
}

/// Steps after which an episode is truncated (rlpy and the thesis).
const LIMIT: u32 = 1000;
/// The unit vectors that the actions push along.
const PUSHES: [[f64; 2]; 5] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [0.0, 0.0]];
/// The action that pushes nowhere.
const NONE: usize = 4;

/// A board, a ball on it, and what reaching the target pays.
#[derive(Clone, Debug)]
pub struct Pinball {
    configuration: Arc<Configuration>,
    rules: Rules,
    state: PinballState,
}

/// All that changes in an episode.
#[derive(Clone, Debug, PartialEq)]
pub struct PinballState {
    /// The ball.
    pub ball: Ball,
    /// What decides which actions go astray.
    chance: Rng,
}

impl Pinball {
    /// A task on a board.
    ///
    /// # Errors
    /// [`PinballError::Noise`].
    pub fn new(configuration: Arc<Configuration>, rules: Rules) -> Result<Self, PinballError> {
        if !(0.0..=1.0).contains(&rules.noise) {
            return Err(PinballError::Noise(rules.noise));
        }
        let state = PinballState { ball: Ball::at(configuration.start()), chance: Rng::seed_from_u64(0) };
        Ok(Self { configuration, rules, state })
    }

    /// The board.
    pub fn configuration(&self) -> &Arc<Configuration> {
        &self.configuration
    }

    /// The ball.
    pub fn ball(&self) -> Ball {
        self.state.ball
    }

    /// Puts another ball in the place of the one that there is.
    ///
    /// # Errors
    /// [`PinballError::Ball`] when some number of it is not finite.
    pub fn restore(&mut self, ball: Ball) -> Result<(), PinballError> {
        if ![ball.x, ball.y, ball.xdot, ball.ydot].iter().all(|number| number.is_finite()) {
            return Err(PinballError::Ball(ball));
        }
        self.state.ball = ball;
        Ok(())
    }

    /// Whether a point lies outside all obstacles.
    pub fn free(&self, point: [f64; 2]) -> bool {
        self.configuration.free(point)
    }

    /// Places to be reached at test time (thesis section 7.3.3: ten thousand of them), which this seed names: free
    /// points, uniformly.
    pub fn test_goals(&self, seed: Seed, count: usize) -> Vec<[f64; 2]> {
        let mut rng = seed.stream("test goals", 0);
        (0..count).map(|_| self.configuration.sample(&mut rng)).collect()
    }
}

impl World for Pinball {
    fn card(&self) -> Card {
        let thesis = self.rules.pay == Pay::Target;
        let velocity = |name| Dimension::linear(name, "", -physics::FASTEST as f32, physics::FASTEST as f32);
        Card {
            name: "pinball",
            about: "a ball is pushed through obstacles to a target",
            actions: &["right", "down", "left", "up", "none"],
            symbols: vec![
                Dimension::linear("x", "", 0.0, 1.0),
                Dimension::linear("y", "", 0.0, 1.0),
                velocity("xdot"),
                velocity("ydot"),
            ],
            place: vec![0, 1],
            limit: Some(LIMIT),
            success_reward: if thesis { 1.0 } else { 10_000.0 },
            // Which seed makes no difference: the configuration says where the ball starts.
            layout: Layout::Fixed(42),
            see: if thesis { See::Pixels(Format::THESIS) } else { See::Symbols },
        }
    }

    fn begin(&mut self, draw: Draw) {
        let at = match draw.start() {
            Some(mut start) => self.configuration.sample(&mut start),
            None if draw.fixed() => self.configuration.start(),
            None => self.configuration.sample(&mut draw.layout()),
        };
        self.state = PinballState { ball: Ball::at(at), chance: draw.play() };
    }

    fn act(&mut self, choice: usize) -> Step {
        let PinballState { ball, chance } = &mut self.state;
        let astray = self.rules.noise > 0.0 && chance.random_bool(self.rules.noise);
        let choice = if astray { chance.random_range(0..PUSHES.len()) } else { choice };
        let there = self.configuration.board.decide(ball, PUSHES[choice]);
        let reward = match (self.rules.pay, there) {
            (Pay::Effort, true) => 10_000.0,
            (Pay::Effort, false) if choice == NONE => -1.0,
            (Pay::Effort, false) => -5.0,
            (Pay::Target, there) => f32::from(u8::from(there)),
        };
        Step { reward, end: there.then_some(End::Terminated) }
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        let Ball { x, y, xdot, ydot } = self.state.ball;
        out.clear();
        out.extend([x, y, xdot, ydot].map(|number| number as f32));
    }

    /// Places to a fiftieth of the board (the ball's radius) and velocities to one push, rounded.
    fn landmark(&self, out: &mut Vec<f32>) -> Grain {
        let Ball { x, y, xdot, ydot } = self.state.ball;
        let rounded = |number: f64, to: f64| (number / to).round() as f32;
        out.clear();
        out.extend([rounded(x, 0.02), rounded(y, 0.02), rounded(xdot, 0.2), rounded(ydot, 0.2)]);
        Grain::Coarse
    }

    /// What the author plots: the place in hundredths, rounded.
    fn facts(&self) -> Vec<Fact> {
        let hundredths = |at: f64| (100.0 * at).round_ties_even() as f32;
        let Ball { x, y, .. } = self.state.ball;
        vec![Fact::new("100 x", hundredths(x)), Fact::new("100 y", hundredths(y))]
    }
}

impl Drawn for Pinball {
    type Painter = BallPainter;

    fn painter(&self, format: Format) -> BallPainter {
        BallPainter::new(self.configuration.clone(), format)
    }
}

impl Snapshot for Pinball {
    type State = PinballState;

    fn save(&self) -> PinballState {
        self.state.clone()
    }

    fn load(&mut self, state: &PinballState) {
        self.state.clone_from(state);
    }
}
