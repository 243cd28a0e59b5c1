//! R2D2 recalls over six blank steps what the same network without a memory cannot know.
//!
//! Both act at random while they learn, so that nothing of the cue is in their actions; who forgets learns from single steps,
//! and reads neither a memory nor its previous action. An evaluation is frozen and has 200 episodes; `scrambled` ones choose
//! at random until they are asked.
//!
//! Price: 2 agents × 10 seeds × 16,000 steps, an update every fourth: about 2 core-minutes.

use std::sync::Arc;

use inroads::{
    agents::{
        Actor, Agent, Bag, Checkpoint, Clip, Context, Corrupt, Curious, Flat, Learned, Learner, Memory, Pace,
        Practice, Replay, Transition,
        dqn::Epsilon,
        encode::Scaled,
        episode,
        nets::{Backend, TorsoConfig},
        r2d2::{R2d2, R2d2Config},
    },
    envs::{Environment, Seed, recall::Recall},
    statistics::{Estimate, mean_interval, median},
};
use serde::Serialize;

use crate::{
    Options,
    support::{Done, over_seeds, write},
};

/// Blank steps between the cue and the question.
const BLANKS: u32 = 6;
const SEEDS: u64 = 10;
const STEPS: u64 = 16_000;
/// Steps between evaluations.
const EVERY: u64 = 800;
const EPISODES: u64 = 200;

type Vector = Vec<f32>;

#[derive(Serialize)]
struct Result {
    blanks: u32,
    steps: u64,
    config: R2d2Config,
    agents: Vec<Row>,
}

#[derive(Serialize)]
struct Row {
    agent: &'static str,
    /// Share of right answers at the end.
    success: Estimate,
    /// The same where what was done before the question was random.
    scrambled: Estimate,
    /// Steps until every answer was right from then on, the median over seeds that got there.
    steps: Option<f64>,
    trials: Vec<Trial>,
}

#[derive(Clone, Debug, Serialize)]
struct Trial {
    seed: u64,
    success: f64,
    scrambled: f64,
    /// Steps until every answer was right from then on.
    steps: Option<u64>,
    updates: u64,
}

/// Somebody who remembers nothing: neither what it saw nor what it did.
struct Forgetful(R2d2<Vector>);

impl Learner<Vector, usize, ()> for Forgetful {
    fn act(&self, memory: &mut Memory, s: &Vector, goal: Option<&()>, ctx: &mut Context) -> usize {
        memory.clear();
        let choice = self.0.act(memory, s, goal, ctx);
        memory.clear();
        choice
    }

    fn values(&self, _: &Memory, s: &Vector, goals: &[Option<&()>]) -> Vec<f32> {
        self.0.values(&Memory::new(), s, goals)
    }

    fn learn(&mut self, clips: &[Clip<Vector, usize, ()>], ctx: &mut Context) -> Learned {
        let bare = clips.iter().map(|clip| Clip { memory: &[], previous: None, ..*clip });
        self.0.learn(&bare.collect::<Vec<_>>(), ctx)
    }

    fn batch(&self) -> usize {
        Learner::<Vector, usize, ()>::batch(&self.0)
    }
}

impl Checkpoint for Forgetful {
    fn save(&self, bag: &mut Bag) {
        self.0.save(bag);
    }

    fn load(&mut self, bag: &Bag) -> std::result::Result<(), Corrupt> {
        self.0.load(bag)
    }
}

/// Acts at random until it is asked.
struct Scrambled<'a>(Box<dyn Actor<Vector, usize> + 'a>);

impl Actor<Vector, usize> for Scrambled<'_> {
    fn begin(&mut self, s: &Vector, ctx: &mut Context) {
        self.0.begin(s, ctx);
    }

    fn act(&mut self, s: &Vector, ctx: &mut Context) -> usize {
        ctx.explore = s[1] == 0.0;
        self.0.act(s, ctx)
    }

    fn observe(&mut self, t: &Transition<Vector, usize>, ctx: &mut Context) {
        self.0.observe(t, ctx);
    }
}

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(SEEDS);
    let config = config();
    let sequences = Replay::new(STEPS as usize).sequences(BLANKS + 2, BLANKS + 2, 0);
    let remembering = over_seeds(seeds, |seed| trial(seed, learner(seed, &config), sequences.clone()));
    // As many steps an update.
    let config_of_one =
        R2d2Config { returns: 1, batch: config.batch * (BLANKS as usize + 2), ..config.clone() };
    let forgetting = over_seeds(seeds, |seed| {
        trial(seed, Forgetful(learner(seed, &config_of_one)), Replay::new(STEPS as usize))
    });
    let agents = vec![row("R2D2", remembering), row("the same without memory", forgetting)];
    println!("{:<26} {:>18} {:>18} {:>9}", "", "right", "scrambled before", "steps");
    for Row { agent, success, scrambled, steps, .. } in &agents {
        let share =
            |e: &Estimate| format!("{:.1} % [{:.1}, {:.1}]", 100.0 * e.value, 100.0 * e.low, 100.0 * e.high);
        let steps = steps.map_or("never".to_owned(), |steps| format!("{steps:.0}"));
        println!("{agent:<26} {:>18} {:>18} {steps:>9}", share(success), share(scrambled));
    }
    write(options, "recall", &Result { blanks: BLANKS, steps: STEPS, config, agents })
}

fn config() -> R2d2Config {
    R2d2Config {
        torso: TorsoConfig { hidden: vec![32], ..TorsoConfig::default() },
        memory: 32,
        head: 32,
        rate: 2e-3,
        adam_epsilon: 1e-5,
        discount: 0.99,
        batch: 16,
        follow_every: 50,
        epsilon: Epsilon { start: 1.0, end: 1.0, updates: 1 },
        ..R2d2Config::default()
    }
}

fn learner(seed: u64, config: &R2d2Config) -> R2d2<Vector> {
    let encoder = Arc::new(Scaled::new(&Recall::new(BLANKS).spec().observation));
    R2d2::new(encoder, 2, config, Backend::Flex, &mut Seed(seed).stream("initialise", 0))
}

fn trial(seed: u64, learner: impl Learner<Vector, usize, ()>, replay: Replay) -> Trial {
    let pace = Pace { updates_per_step: 0.25, warm_up: 400 };
    let mut agent = Flat::new(Curious::new(learner, Practice::new(replay, pace)), STEPS as usize);
    let mut env = Recall::new(BLANKS);
    let mut trial = Trial { seed, success: 0.0, scrambled: 0.0, steps: None, updates: 0 };
    let (mut steps, mut index) = (0, 0);
    while steps < STEPS {
        let mut ctx = Context::training(Seed(seed), index);
        let played = episode(&mut env, &mut agent, play(seed, index), &mut ctx, |_, _| ());
        let now = steps + u64::from(played.expect("both choices are legal").steps);
        index += 1;
        if now / EVERY > steps / EVERY {
            trial.success = share(seed, agent.frozen());
            trial.scrambled = share(seed, Box::new(Scrambled(agent.frozen())));
            let all = trial.success == 1.0 && trial.scrambled == 1.0;
            trial.steps = if all { trial.steps.or(Some(now)) } else { None };
        }
        steps = now;
    }
    trial.updates = agent.updates()[0].1;
    trial
}

/// The seed of an episode of training; those of evaluations lie beyond.
fn play(seed: u64, index: u64) -> u64 {
    seed << 32 | index
}

/// Share of right answers.
fn share(seed: u64, mut actor: Box<dyn Actor<Vector, usize> + '_>) -> f64 {
    let mut env = Recall::new(BLANKS);
    let right = (0..EPISODES).filter(|index| {
        let mut ctx = Context::evaluation(Seed(seed), *index);
        let played = episode(&mut env, &mut *actor, play(seed, 1 << 31 | index), &mut ctx, |_, _| ());
        played.expect("both choices are legal").success
    });
    right.count() as f64 / EPISODES as f64
}

fn row(agent: &'static str, trials: Vec<Trial>) -> Row {
    let of = |found: &dyn Fn(&Trial) -> f64| mean_interval(&trials.iter().map(found).collect::<Vec<_>>());
    let steps: Vec<_> = trials.iter().filter_map(|trial| trial.steps.map(|steps| steps as f64)).collect();
    Row {
        agent,
        success: of(&|trial| trial.success),
        scrambled: of(&|trial| trial.scrambled),
        steps: median(&steps),
        trials,
    }
}
