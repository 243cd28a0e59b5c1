//! Learners with no notion of options: replay, hindsight, networks on Burn, DDPG, TD3, the DQN family, R2D2, tables, policy
//! evaluation, novelty, model-based control, support vector machines.
//!
//! Burn stands in this room only, and is compiled once: rows of numbers in, rows of numbers out.

mod actor_critic;
pub mod aimed;
pub mod checkpoint;
pub mod classify;
pub mod curious;
pub mod ddpg;
pub mod dqn;
pub mod draw;
pub mod encode;
pub mod episode;
pub mod evaluate;
pub mod experience;
mod fault;
pub mod flat;
pub mod goal;
pub mod hindsight;
pub mod lanes;
pub mod lspi;
pub mod mpc;
pub mod nets;
pub mod noise;
pub mod novelty;
mod pace;
mod practice;
pub mod r2d2;
pub mod replay;
mod running;
pub mod svm;
pub mod tabular;
pub mod td3;

pub use aimed::Aimed;
pub use checkpoint::{Bag, Checkpoint, Corrupt};
pub use curious::Curious;
pub use encode::{Encode, Encoder};
pub use episode::{Summary, episode};
pub use evaluate::Evaluator;
pub use experience::{Clip, Experience, Lesson};
pub use fault::{Fault, Halt};
pub use flat::Flat;
pub use goal::Goal;
pub use lanes::{Crowd, round};
pub use mpc::Mpc;
pub use novelty::Novelty;
pub use pace::Pace;
pub use practice::Practice;
pub use replay::Replay;
pub use running::Running;
pub use tabular::{Key, TabularQ};

use inroads_envs::{End, Rng, Seed};

/// What lasts one episode of one actor beside its observation: a recurrent state, correlated noise. A plain
/// type, so that learners stay storable and usable as `dyn`.
pub type Memory = Vec<f32>;

/// What surrounds one call of an agent: who asks, when, and the random streams of this episode.
#[derive(Debug)]
pub struct Context {
    /// Whether exploration noise is added.
    pub explore: bool,
    /// Stream for choices of action.
    pub acting: Rng,
    /// Stream for learning: minibatches, initial weights.
    pub learning: Rng,
    /// The first number of an update that was none; the episode ends with it ([`check`](Self::check)).
    pub fault: Option<Fault>,
}

impl Context {
    /// The context of training episode number `index`.
    pub fn training(seed: Seed, index: u64) -> Self {
        let (acting, learning) = (seed.stream("act", index), seed.stream("learn", index));
        Self { explore: true, acting, learning, fault: None }
    }

    /// Whoever learns tells here what its updates come to, a loss say: the first that is NaN or infinite ends the episode,
    /// and with it the training. Such an update must not have been applied.
    pub fn check(&mut self, what: &'static str, value: f32) {
        if !value.is_finite() {
            self.fault.get_or_insert(Fault::Learning { what, value });
        }
    }

    /// The context of evaluation episode number `index`: no exploration.
    pub fn evaluation(seed: Seed, index: u64) -> Self {
        Self {
            explore: false,
            acting: seed.stream("evaluate-act", index),
            learning: seed.stream("evaluate-learn", index),
            fault: None,
        }
    }
}

/// One step of an episode, all borrowed.
#[derive(Debug)]
pub struct Transition<'a, O, A> {
    /// Where it was.
    pub before: &'a O,
    /// What was done.
    pub action: &'a A,
    /// What it earned.
    pub reward: f32,
    /// Where it led.
    pub after: &'a O,
    /// Whether and how the episode ended there.
    pub end: Option<End>,
}

/// What the episode loop needs of whoever acts.
pub trait Actor<O, A> {
    /// An episode begins at `s`.
    fn begin(&mut self, s: &O, ctx: &mut Context);

    /// The action to take at `s`.
    fn act(&mut self, s: &O, ctx: &mut Context) -> A;

    /// What came of the last action.
    fn observe(&mut self, t: &Transition<O, A>, ctx: &mut Context);

    /// Which part of the agent chose the last action (a skill's number, say); 0 where there are no parts.
    fn source(&self) -> usize {
        0
    }
}

/// An actor that learns, can be saved between episodes, and can be watched without changing.
pub trait Agent<O, A>: Actor<O, A> + Checkpoint {
    /// The agent as it is now, acting without learning. It borrows the agent, so that an evaluation *cannot*
    /// change it.
    fn frozen(&self) -> Box<dyn Actor<O, A> + '_>;

    /// Learning steps (minibatch updates) made so far, by name of the network.
    fn updates(&self) -> Vec<(&'static str, u64)>;

    /// The agent as one that learns from several episodes side by side; none where it cannot.
    fn crowd(&mut self) -> Option<&mut dyn Crowd<O, A>> {
        None
    }
}

/// One of several episodes that go on side by side: what one actor has in it.
#[derive(Debug)]
pub struct Lane<'a, O, G> {
    /// What it remembers.
    pub memory: &'a mut Memory,
    /// What it sees.
    pub s: &'a O,
    /// Where it is going.
    pub goal: Option<&'a G>,
    /// Its random streams.
    pub ctx: &'a mut Context,
}

/// What an update came to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Learned {
    /// The mean loss before it.
    pub loss: f32,
    /// How wrong each clip was found: its priority, where there are priorities. Empty where nobody measured it.
    pub errors: Vec<f32>,
}

impl Learned {
    /// An update that descended on the mean square of these errors.
    pub fn of(errors: Vec<f32>) -> Self {
        let squares = errors.iter().map(|error| error.powi(2)).sum::<f32>();
        Self { loss: squares / errors.len().max(1) as f32, errors }
    }
}

/// Learns a policy from clips of experience: for the task, and for goals of type `G` if it reads any.
///
/// `None` as a goal is the task itself. A learner without goals has `G = ()`.
pub trait Learner<O, A, G>: Checkpoint {
    /// The action at `s` on the way to a goal, with exploration noise when `ctx.explore`.
    fn act(&self, memory: &mut Memory, s: &O, goal: Option<&G>, ctx: &mut Context) -> A;

    /// What `s` is worth to somebody on the way to each of these goals, who acts without noise. With the rewards of
    /// [`Pay::ATTAINMENT`](experience::Pay::ATTAINMENT) that is the discounted probability of getting there.
    fn values(&self, memory: &Memory, s: &O, goals: &[Option<&G>]) -> Vec<f32>;

    /// What each of these states is worth to somebody on the way to one goal, who remembers nothing. Whoever computes on
    /// matrices computes them together.
    fn values_of(&self, states: &[O], goal: Option<&G>) -> Vec<f32> {
        states.iter().flat_map(|s| self.values(&Memory::new(), s, &[goal])).collect()
    }

    /// The actions at several states at once, one of each lane. Whoever computes on matrices computes them together.
    fn act_all(&self, lanes: &mut [Lane<'_, O, G>]) -> Vec<A> {
        lanes.iter_mut().map(|lane| self.act(lane.memory, lane.s, lane.goal, lane.ctx)).collect()
    }

    /// One minibatch update on these clips.
    fn learn(&mut self, clips: &[Clip<O, A, G>], ctx: &mut Context) -> Learned;

    /// How many clips `learn` wants.
    fn batch(&self) -> usize;
}
