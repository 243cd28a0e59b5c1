//! What a step of the environment costs each agent, by part: `cargo bench --bench throughput -- --cost`.
//!
//! Whole agents with their registry's settings live in their environments, first beside the goal until they have a learned
//! skill, then from anywhere, as chapter 4 trains them. Every call of the environment, of `act` and of `observe` is timed; how the
//! processor time of the measured steps is shared among them is what those times say, so that whoever else is on the machine
//! lengthens all alike. What `observe` does besides learning is taken from it: refits of classifiers, so many as there were at
//! the price of one with full memories. An act of a model-based agent is a plan.

use std::{
    cell::Cell,
    rc::Rc,
    time::{Duration, Instant},
};

use inroads::{
    agents::{Actor, Context, Transition, episode, nets::Backend},
    assembly::{self, BoxedAgent},
    config::{Config, ConfigError},
    discovery::chain::Phase,
    envs::{
        Domain, Environment, Refused, Seed, Spec, Step,
        maze::Starts,
        registry::{self, AnyEnvironment, Options},
    },
};

use crate::{measure::processor_time, refits};

/// An agent in an environment.
struct Row {
    agent: &'static str,
    environment: &'static str,
    /// Beside the registry's settings.
    settings: &'static [&'static str],
    /// Where the first episodes begin, metres: near enough to the goal for random actions to reach it.
    near: [f64; 2],
    /// What its initiation sets are refitted for, as a workload of [`refits`].
    classifier: Option<&'static str>,
    /// Whether an action is a plan.
    plans: bool,
}

/// Learning begins with the first batch: otherwise thousands of steps would have to be lived before any could be timed.
const SOON: &str = "memory.warm_up=256";
/// So many updates before the first plan, for the same reason.
const READY: &str = "control.plans.ready=200";
/// Beside the goals of the U-mazes, of the point and of the ant.
const NEAR: [[f64; 2]; 2] = [[3.0, 8.0], [1.2, 8.0]];

const ROWS: &[Row] = &[
    flat("ddpg", "point-maze", NEAR[0]),
    flat("td3-her", "point-maze", NEAR[0]),
    flat("td3-her", "ant-u-maze", NEAR[1]),
    Row { classifier: Some(refits::BINARY), ..flat("dsc", "point-maze", NEAR[0]) },
    Row { classifier: Some(refits::BINARY), ..flat("dsc", "ant-u-maze", NEAR[1]) },
    robust("point-maze", &[SOON, "control.model=false"], NEAR[0]),
    robust("ant-u-maze", &[SOON, "control.model=false"], NEAR[1]),
    Row { plans: true, ..robust("point-maze", &[SOON, READY, "control.model=true"], NEAR[0]) },
    Row { plans: true, ..robust("ant-u-maze", &[SOON, READY, "control.model=true"], NEAR[1]) },
];

const fn flat(agent: &'static str, environment: &'static str, near: [f64; 2]) -> Row {
    Row { agent, environment, settings: &[SOON], near, classifier: None, plans: false }
}

const fn robust(environment: &'static str, settings: &'static [&'static str], near: [f64; 2]) -> Row {
    Row { settings, classifier: Some(refits::DUAL), ..flat("robust-dsc", environment, near) }
}

/// Steps at least before any is timed; at most, where there is no skill yet; and steps that are timed.
const STEPS: [u32; 3] = [1000, 3000, 2000];
/// Steps of an episode at most.
const LIMIT: u32 = 300;

/// Prints a table in Markdown, a row an agent; `price` is the microseconds of a refit of those sets.
pub(crate) fn table(only: Option<&str>, mut price: impl FnMut(&str) -> f64) {
    println!(
        "| agent | environment | whole step | environment | acting | planning | learning | classifiers | other | updates | skills |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for row in ROWS.iter().filter(|row| only.is_none_or(|only| row.agent == only)) {
        match row.measured() {
            Ok(found) => println!("{}", row.told(&found, &mut price)),
            Err(why) => println!("| {} | {} | {why} | | | | | | | | |", row.agent, row.environment),
        }
    }
}

/// Microseconds a step.
struct Found {
    whole: f64,
    parts: [f64; 3],
    /// Updates a step, over all networks.
    updates: f64,
    refits: f64,
    skills: usize,
}

impl Row {
    fn told(&self, found: &Found, mut price: impl FnMut(&str) -> f64) -> String {
        let Found { whole, parts: [world, acting, observing], updates, refits, skills } = *found;
        let classifiers = self.classifier.map(|name| refits * price(name));
        let other = (whole - world - acting - observing).max(0.0);
        let micros = |x: f64| format!("{x:.0}");
        let maybe = |x: Option<f64>| x.map_or_else(|| "–".to_owned(), micros);
        let [acts, plans] = if self.plans { [None, Some(acting)] } else { [Some(acting), None] };
        format!(
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {updates:.2} | {skills} |",
            self.name(),
            self.environment,
            micros(whole),
            micros(world),
            maybe(acts),
            maybe(plans),
            micros((observing - classifiers.unwrap_or(0.0)).max(0.0)),
            maybe(classifiers),
            micros(other),
        )
    }

    fn name(&self) -> String {
        let set = self.settings.iter().filter(|set| ![SOON, READY].contains(*set));
        std::iter::once(self.agent.to_owned())
            .chain(set.map(|set| format!("`{set}`")))
            .collect::<Vec<_>>()
            .join(", ")
    }

    fn measured(&self) -> Result<Found, ConfigError> {
        let config = self
            .settings
            .iter()
            .try_fold(Config::defaults(self.agent, self.environment)?, |config, set| {
                config.with_assignment(set)
            })?;
        let mut near = self.world(Starts::At(&[self.near]));
        let entry = assembly::agent(self.agent)?;
        let build = entry.continuous.expect("the robots of the mazes are moved by numbers");
        let agent = build(near.spec(), &config.agent, Backend::Flex, Seed(0))?;
        let mut life = Life { agent, episodes: 0 };
        let (mut steps, clock) = (0, Clock::default());
        let waits = |life: &Life| self.classifier.is_some() && life.agent.skills().is_empty();
        while steps < STEPS[0] || steps < STEPS[1] && waits(&life) {
            steps += life.episode(&mut near, &clock);
        }
        let mut anywhere = self.world(Starts::Anywhere);
        let (clock, updates, refits) = (Clock::default(), life.updates(), life.refits());
        let (before, began, mut steps) = (processor_time(), Instant::now(), 0);
        while steps < STEPS[2] {
            steps += life.episode(&mut anywhere, &clock);
        }
        let elapsed = began.elapsed().as_secs_f64();
        let taken = before.zip(processor_time()).map_or(elapsed, |(before, after)| after - before);
        let each = |seconds: f64| seconds * taken / elapsed * 1e6 / f64::from(steps);
        Ok(Found {
            whole: each(elapsed),
            parts: clock.0.each_ref().map(|part| each(part.get().as_secs_f64())),
            updates: (life.updates() - updates) as f64 / f64::from(steps),
            refits: (life.refits() - refits) as f64 / f64::from(steps),
            skills: life.agent.skills().len(),
        })
    }

    fn world(&self, starts: Starts<'_>) -> World {
        let options = Options { starts: Some(starts), ..Options::default() };
        let made = registry::make_with(self.environment, &options).expect("a maze of the registry");
        let AnyEnvironment::Vectors(env) = made else { unreachable!("robots are moved by numbers") };
        inroads::envs::TimeLimit::new(env, LIMIT)
    }
}

type World = inroads::envs::TimeLimit<Box<dyn Domain<Vec<f32>, Vec<f32>>>>;

/// Time that the environment, `act` and `observe` have taken.
#[derive(Clone, Default)]
struct Clock(Rc<[Cell<Duration>; 3]>);

impl Clock {
    fn time<T>(&self, part: usize, what: impl FnOnce() -> T) -> T {
        let began = Instant::now();
        let answer = what();
        self.0[part].set(self.0[part].get() + began.elapsed());
        answer
    }
}

/// An agent and how many episodes it has lived.
struct Life {
    agent: BoxedAgent<Vec<f32>, Vec<f32>>,
    episodes: u64,
}

impl Life {
    /// Another episode; its steps.
    fn episode(&mut self, env: &mut World, clock: &Clock) -> u32 {
        let mut ctx = Context::training(Seed(0), self.episodes);
        self.episodes += 1;
        let (mut env, mut actor) = (Timed(env, clock), Timed(&mut self.agent, clock));
        let summary = episode(&mut env, &mut actor, self.episodes, &mut ctx, |_, _| {});
        summary.expect("actions are admitted").steps
    }

    fn updates(&self) -> u64 {
        self.agent.updates().into_iter().map(|(_, updates)| updates).sum()
    }

    /// Executions of skills whose sets still move, each of which refits one.
    fn refits(&self) -> u64 {
        let skills = self.agent.skills();
        skills.iter().filter(|skill| skill.phase != Phase::Fixed).map(|skill| skill.executions).sum()
    }
}

/// Somebody whose time is taken.
struct Timed<'a, T>(&'a mut T, &'a Clock);

impl Environment for Timed<'_, World> {
    type Observation = Vec<f32>;
    type Action = Vec<f32>;

    fn spec(&self) -> &Spec {
        self.0.spec()
    }

    fn reset(&mut self, seed: u64) {
        let Self(env, clock) = self;
        clock.time(0, || env.reset(seed));
    }

    fn step(&mut self, action: &Vec<f32>) -> Result<Step, Refused> {
        let Self(env, clock) = self;
        clock.time(0, || env.step(action))
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        let Self(env, clock) = self;
        clock.time(0, || env.observe(out));
    }
}

impl Actor<Vec<f32>, Vec<f32>> for Timed<'_, BoxedAgent<Vec<f32>, Vec<f32>>> {
    fn begin(&mut self, s: &Vec<f32>, ctx: &mut Context) {
        self.0.begin(s, ctx);
    }

    fn act(&mut self, s: &Vec<f32>, ctx: &mut Context) -> Vec<f32> {
        let Self(agent, clock) = self;
        clock.time(1, || agent.act(s, ctx))
    }

    fn observe(&mut self, t: &Transition<Vec<f32>, Vec<f32>>, ctx: &mut Context) {
        let Self(agent, clock) = self;
        clock.time(2, || agent.observe(t, ctx));
    }
}
