//! What training costs that is compared with PyTorch (`benches/peers/learners.py`): updates of deep Q-learning by each
//! encoder of pictures and from vectors, and TD3 with an update a step.

use std::{hint::black_box, mem::swap, sync::Arc};

use inroads::{
    agents::{
        Clip, Context, Encoder, Learner, Transition,
        dqn::{Dqn, DqnConfig},
        encode::Select,
        experience::Rewards,
        nets::{Backend, TorsoConfig, Vision},
    },
    assembly::{self, BoxedAgent},
    config::Config,
    envs::{
        Domain, Frame, Seed, Space,
        registry::{self, AnyEnvironment},
    },
};
use rand::RngExt;

use crate::workload::Workload;

/// Choices of the learners here.
const CHOICES: usize = 5;
/// Numbers that a vector has.
const SEEN: usize = 35;
/// Steps before TD3 is timed: as many as a batch needs, and some updates.
const BEFORE: usize = 300;

/// An update from 32 pictures by the default encoder and by Nature's convolution, one from 256 vectors, and steps of TD3.
pub(crate) fn training() -> Vec<Workload> {
    let mut all = Vec::new();
    for (name, vision, hidden) in [("patches", Vision::Patches, 128), ("nature", Vision::Nature, 512)] {
        for (seen, pixels, channels) in [("84x84 grey", 84, 1), ("64x64 colour", 64, 3)] {
            let torso = TorsoConfig { vision, hidden: vec![hidden], ..TorsoConfig::default() };
            let space = Space::Frame { width: pixels, height: pixels, channels };
            let encoder = torso.encoder(&space).expect("both fit into these pictures");
            let config = DqnConfig { torso, ..plain() };
            let pictures = (0..=config.batch as u64).map(|i| picture(pixels, channels, i)).collect();
            let name = format!("encoder/{name}/train, {seen}");
            all.push(update(&name, Arc::new(encoder), &config, pictures));
        }
    }
    let torso = TorsoConfig { hidden: vec![256], ..TorsoConfig::default() };
    let config = DqnConfig { torso, head: 256, dueling: false, batch: 256, ..plain() };
    let mut rng = Seed(0).stream("vectors", 0);
    let mut vector = || (0..SEEN).map(|_| rng.random_range(-1.0..1.0)).collect::<Vec<f32>>();
    let vectors = (0..=config.batch).map(|_| vector()).collect();
    let encoder = Arc::new(Select::new(&(0..SEEN).collect::<Vec<_>>()));
    all.push(update("mlp/train, 256-256 on 256 vectors", encoder, &config, vectors));
    all.push(td3_on_the_ant());
    all
}

/// Deep Q-learning with as little around the train step as can be: one pass of the target, of what follows.
fn plain() -> DqnConfig {
    DqnConfig { double: false, gradient_clip: 0.0, ..DqnConfig::default() }
}

fn picture(pixels: u32, channels: u32, number: u64) -> Frame {
    let (mut frame, mut rng) = (Frame::new([pixels, pixels], channels), Seed(0).stream("pictures", number));
    frame.bytes_mut().iter_mut().for_each(|byte| *byte = rng.random());
    frame
}

/// One update on a batch of steps between observations, of which there is one more.
fn update<O: 'static>(
    name: &str,
    encoder: Arc<dyn Encoder<O> + Send + Sync>,
    config: &DqnConfig,
    observations: Vec<O>,
) -> Workload {
    let mut rng = Seed(0).stream("bench", 3);
    let mut learner = Dqn::new(encoder, CHOICES, config, Backend::Flex, &mut rng);
    let choices: Vec<usize> = (0..config.batch).map(|i| i % CHOICES).collect();
    let mut ctx = Context::training(Seed(0), 0);
    Workload::repeated(name, move || {
        let clip = |i: usize| {
            let rewards = Rewards::Given(&[-1.0]);
            Clip::new(&observations[i..=i + 1], &choices[i..=i], rewards, None::<&()>, false)
        };
        let clips: Vec<_> = (0..choices.len()).map(clip).collect();
        black_box(learner.learn(&clips, &mut ctx));
    })
}

/// A step of the ant by TD3 as the registry has it (256-256, batch 256), with an update.
fn td3_on_the_ant() -> Workload {
    let AnyEnvironment::Vectors(env) = registry::make("ant").expect("it is in the registry") else {
        unreachable!("an ant is moved by numbers")
    };
    let config = Config::defaults("td3", "ant")
        .and_then(|config| config.with_assignment("memory.warm_up=256"))
        .expect("these settings are possible");
    let build =
        assembly::agent("td3").expect("it is in the registry").continuous.expect("it acts by numbers");
    let agent =
        build(env.spec(), &config.agent, Backend::Flex, Seed(0)).expect("these settings are possible");
    let ctx = Context::training(Seed(0), 0);
    let mut life = Life { env, agent, ctx, episodes: 0, before: Vec::new(), after: Vec::new() };
    life.begin();
    (0..BEFORE).for_each(|_| life.step());
    Workload::repeated("agents/td3/step and update, ant", move || life.step())
}

/// An agent in its environment, episode after episode.
struct Life {
    env: Box<dyn Domain<Vec<f32>, Vec<f32>>>,
    agent: BoxedAgent<Vec<f32>, Vec<f32>>,
    ctx: Context,
    episodes: u64,
    before: Vec<f32>,
    after: Vec<f32>,
}

impl Life {
    fn begin(&mut self) {
        self.env.reset(self.episodes);
        self.episodes += 1;
        self.env.observe(&mut self.before);
        self.agent.begin(&self.before, &mut self.ctx);
    }

    fn step(&mut self) {
        let Self { env, agent, ctx, before, after, .. } = self;
        let action = agent.act(before, ctx);
        let step = env.step(&action).expect("no episode is stepped when it is over");
        env.observe(after);
        let (reward, end) = (step.reward, step.end);
        agent.observe(&Transition { before, action: &action, reward, after, end }, ctx);
        swap(before, after);
        if end.is_some() {
            self.begin();
        }
    }
}
