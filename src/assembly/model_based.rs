//! Model-based control on its own: the flat model-based baseline of chapter 4.

use std::sync::Arc;

use inroads_agents::{
    Mpc, Practice, Replay,
    hindsight::HindsightConfig,
    mpc::{FreeBody, MpcConfig, Plain, Planned, PlannedConfig, Reward, View},
    nets::Backend,
    td3::{Td3, Td3Config},
};
use inroads_envs::{Kind, Seed, Spec};
use serde::{Deserialize, Serialize};
use toml::Table;

use super::{
    AgentEntry, BoxedAgent, Vector,
    actor_critic::aimed,
    shared::{MemoryConfig, named, scaled, table},
};
use crate::config::{ConfigError, section};

pub(super) const ENTRIES: &[AgentEntry] = &[
    AgentEntry {
        name: "mpc",
        about: "the flat model-based baseline: plans towards the goal with a learned model of the dynamics",
        defaults: || table(&FlatMpcConfig::default()),
        check: |t| named("mpc", section::<FlatMpcConfig>(t.clone(), "mpc")?.control.check()),
        continuous: Some(mpc),
        discrete: None,
        annotated: None,
        pictured: None,
    },
    AgentEntry {
        name: "mpc-her",
        about: "the same with an infinite horizon: plans end with the values of TD3 that learns in hindsight",
        defaults: || table(&AimedMpcConfig::default()),
        check: |t| section::<AimedMpcConfig>(t.clone(), "mpc-her")?.check(),
        continuous: Some(mpc_her),
        discrete: None,
        annotated: None,
        pictured: None,
    },
];

/// In which frame the model reads states.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Frame {
    /// The body's own, where what is seen is a body's place, attitude and velocities; then the model knows no walls. Else
    /// the world's.
    #[default]
    Body,
    /// The world's: states as they are (paper and authors).
    World,
}

/// Settings of `mpc`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct FlatMpcConfig {
    frame: Frame,
    control: MpcConfig,
}

/// Settings of `mpc-her`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct AimedMpcConfig {
    frame: Frame,
    memory: MemoryConfig,
    policy: Td3Config,
    hindsight: HindsightConfig,
    plans: PlannedConfig,
}

impl Default for AimedMpcConfig {
    fn default() -> Self {
        Self {
            frame: Frame::default(),
            memory: MemoryConfig { capacity: 300_000, updates_per_step: 0.5, warm_up: 10_000 },
            policy: Td3Config::default(),
            hindsight: HindsightConfig::default(),
            plans: PlannedConfig { reward: Reward::Sparse, ..PlannedConfig::default() },
        }
    }
}

impl AimedMpcConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())?;
        named("hindsight", self.hindsight.check())?;
        if self.plans.values && self.plans.reward == Reward::Dense {
            let why = "plans.values are those of -1 a step, and plans.reward is \"dense\"; set plans.reward = \"sparse\"";
            return named("plans", Err(why.into()));
        }
        named("plans", self.plans.check())
    }
}

/// How a model reads what this domain shows.
pub(super) fn view(spec: &Spec, frame: Frame) -> Arc<dyn View> {
    let dimensions = spec.observation.dimensions();
    let names: Vec<_> = dimensions.iter().map(|d| d.name.as_ref()).collect();
    let body = names.starts_with(&["x", "y", "z", "qw", "qx", "qy", "qz"]);
    let velocity = names.windows(3).position(|three| three == ["vx", "vy", "vz"]);
    match (frame, velocity) {
        (Frame::Body, Some(velocity)) if body => Arc::new(FreeBody::new(names.len(), velocity)),
        _ => {
            let angles: Vec<_> = dimensions.iter().map(|d| d.kind == Kind::Angle).collect();
            Arc::new(Plain::new(&angles, &[]))
        }
    }
}

fn mpc(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<Vector, Vector>, ConfigError> {
    let config: FlatMpcConfig = section(settings.clone(), "mpc")?;
    let Some(goal) = spec.goal.clone() else {
        let why =
            format!("{} has no goal to plan towards; take a domain with one, such as ant-reacher", spec.name);
        return named("mpc", Err(why));
    };
    let mut rng = seed.stream("initialise", 0);
    let view = view(spec, config.frame);
    Ok(Box::new(Mpc::new(view, spec.action.len(), goal, &config.control, backend, &mut rng)))
}

fn mpc_her(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<Vector, Vector>, ConfigError> {
    let config: AimedMpcConfig = section(settings.clone(), "mpc-her")?;
    let AimedMpcConfig { frame, memory, policy, hindsight, plans } = &config;
    let actions = spec.action.len();
    aimed(
        spec,
        hindsight,
        Practice::new(Replay::new(memory.capacity), memory.pace()),
        memory.capacity,
        |goal| {
            let mut rng = seed.stream("initialise", 0);
            let td3 = Td3::new(scaled(spec), goal, actions, policy, backend, &mut rng);
            let mut rng = seed.stream("initialise", 3);
            Planned::new(td3, view(spec, *frame), actions, plans, backend, &mut rng)
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::registry;

    #[test]
    fn a_body_is_seen_in_its_own_frame_and_other_things_as_they_are() {
        let inputs = |name: &str, frame| {
            view(registry::make(name).expect("it is in the registry").spec(), frame).inputs()
        };
        assert_eq!(inputs("ant-reacher", Frame::Body), 26);
        assert_eq!(inputs("ant-reacher", Frame::World), 29);
        // Of its six numbers one is an angle, which is read as two.
        assert_eq!(inputs("point-maze", Frame::Body), 7);
    }

    #[test]
    fn a_domain_without_a_goal_is_refused() {
        let arena = registry::make("point-arena").expect("it is in the registry");
        let refused = mpc(arena.spec(), &table(&FlatMpcConfig::default()), Backend::Flex, Seed(0));
        assert!(refused.err().expect("there is no task").to_string().contains("no goal"));
    }
}
