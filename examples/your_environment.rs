//! Your own environment, chained by the same agent: Moore's mountain car (1990) with a continuous action.
//!
//! `cargo run --release --example your_environment` (`-- --quick` stops after three episodes)

use inroads::{envs::check, prelude::*, session};

/// A car in a valley, too weak to drive straight up to the goal on the right.
struct MountainCar {
    spec: Spec,
    position: f32,
    velocity: f32,
    over: bool,
}

impl MountainCar {
    fn new() -> Self {
        let spec = Spec {
            name: "mountain-car",
            about: "a weak car in a valley",
            observation: Space::Box(
                [
                    Dimension::linear("position", "", -1.2, 0.6),
                    Dimension::linear("velocity", "", -0.07, 0.07),
                ]
                .into(),
            ),
            action: Space::Box([Dimension::linear("force", "", -1.0, 1.0)].into()),
            goal: None, // the reward tells: an episode that terminates with 0 succeeded
            place: vec![0, 1],
            time_limit: None,
            success_reward: 0.0,
        };
        Self { spec, position: 0.0, velocity: 0.0, over: true }
    }
}

impl Environment for MountainCar {
    type Observation = Vec<f32>;
    type Action = Vec<f32>;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        let offset = (Seed(seed).number("start", 0) % 1000) as f32 / 1000.0;
        (self.position, self.velocity, self.over) = (-0.6 + 0.2 * offset, 0.0, false);
    }

    fn step(&mut self, action: &Vec<f32>) -> Result<Step, Refused> {
        if self.over {
            return Err(Refused::Over);
        }
        self.spec.action.admit(action)?;
        let slope = (3.0 * self.position).cos();
        self.velocity = (self.velocity + 0.0015 * action[0] - 0.0025 * slope).clamp(-0.07, 0.07);
        self.position = (self.position + self.velocity).clamp(-1.2, 0.6);
        self.over = self.position >= 0.45;
        let (reward, end) = if self.over { (0.0, Some(End::Terminated)) } else { (-1.0, None) };
        Ok(Step { reward, end })
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        out.clear();
        out.extend([self.position, self.velocity]);
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let quick = std::env::args().any(|argument| argument == "--quick");
    // The same suite that the project's own environments pass.
    check::check(&mut TimeLimit::new(MountainCar::new(), 200), check::Options::default())?;

    let env = TimeLimit::new(MountainCar::new(), 1000);
    let config = Config::defaults("dsc", "mountain-car")?;
    let mut session = session::continuous(vec![Box::new(env)], &config)?;
    for _ in 0..if quick { 3 } else { 100 } {
        let episode = &session.train()?[0];
        eprintln!("episode {}: {} steps, {} skills", episode.episode, episode.steps, episode.skills);
    }
    Ok(())
}
