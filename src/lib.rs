//! Inroads: a laboratory for skill discovery, in pure Rust.
//!
//! Simulators, learners, and on top of them the agents of the thesis "Skill Discovery for Exploration and Planning".
//! This crate is the facade over four rooms, each used by the next, and holds the experiments: configuration, runs,
//! figures and the command line.
//!
//! ```text
//! sim ──► envs ──► agents ──► discovery ──► inroads
//! ```

pub use inroads_agents as agents;
pub use inroads_discovery as discovery;
pub use inroads_envs as envs;
pub use inroads_sim as sim;

pub mod assembly;
pub mod cli;
pub mod config;
pub mod draw;
pub mod evidence;
pub mod figures;
pub mod film;
mod keys;
pub mod prelude;
pub mod run;
pub mod session;
pub mod statistics;
pub mod truth;
