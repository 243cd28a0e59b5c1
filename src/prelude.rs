//! What most programs that use the library need.

pub use inroads_agents::{Actor, Agent, Checkpoint, Context, Encoder, Experience, Learner, episode};
pub use inroads_discovery::{
    Chaining, Discovery, Hierarchy, Initiation, PolicyOverSkills, SkillPolicy, Skilled,
};
pub use inroads_envs::{Dimension, End, Environment, Goal, Refused, Rng, Seed, Space, Spec, Step, TimeLimit};

pub use crate::{
    assembly,
    config::Config,
    run::{Ended, Run, Summary},
    session::{Protocol, Session},
};
