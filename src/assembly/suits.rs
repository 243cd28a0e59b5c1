//! What suits an environment: settings of agents that are other than an agent's own defaults there.
//!
//! They were found with the budget that `docs/results/chapter-3.md` tells, the same for all agents of a figure. A run's
//! `config.toml` has every value, whoever chose it, and `--set` overrides these as it does all defaults.

use toml::Table;

/// Agents, environments, and what suits these agents there.
struct Suit {
    agents: &'static [&'static str],
    environments: &'static [&'static str],
    settings: &'static str,
}

/// Later lines override earlier ones.
const SUITS: &[Suit] = &[
    // Two legs, or two starts: noise that goes on in one direction finds the goal two or three times as often.
    Suit {
        agents: &["ddpg", "dsc"],
        environments: &["point-e-maze", "point-lock-and-key"],
        settings: "policy.noise.kind = 'ornstein_uhlenbeck'",
    },
    Suit {
        agents: &["ddpg", "dsc"],
        environments: &["point-e-maze"],
        settings: "policy.noise.decay_steps = 30000",
    },
    // Noise has to last until the key and the lock have been found together some twenty times.
    Suit {
        agents: &["ddpg", "dsc"],
        environments: &["point-lock-and-key"],
        settings: "policy.noise = { decay_steps = 55000, end = 0.1 }",
    },
    // Skills long enough that four make a way, each of them soon in use; they give up soon, and their noise does not die down
    // before they have been seen to work.
    Suit {
        agents: &["dsc"],
        environments: &["point-e-maze", "point-lock-and-key"],
        settings: "chain = { segment = 40, gestation = 3, initiation_episodes = 5, initiation_successes = 3, timeout = 50 }
policy.fork_noise = { kind = 'ornstein_uhlenbeck', start = 1.0, end = 0.1, decay_steps = 30000 }",
    },
    // Sets that follow the corridor, of metres; a branch for each start.
    Suit {
        agents: &["dsc"],
        environments: &["point-e-maze"],
        settings: "chain.branch = 2.0
initiation.svm.gamma = 0.3",
    },
    // Sets that tell with the key from without it, of coordinates in [-1, 1].
    Suit { agents: &["dsc"], environments: &["point-lock-and-key"], settings: "initiation.svm.gamma = 3.0" },
    // A whole episode of a good policy has some sixteen steps.
    Suit {
        agents: &["dsc"],
        environments: &["reacher", "reacher-bonus"],
        settings: "chain = { segment = 10, timeout = 25 }",
    },
    // A distance to the goal is told, so skills are told theirs to their subgoal (3.1.1).
    Suit { agents: &["dsc"], environments: &["ant-u-maze-dense"], settings: "chain.option_reward = 'dense'" },
];

/// What suits an agent in an environment, as a table of its settings; empty where its defaults do.
pub fn suits(agent: &str, environment: &str) -> impl Iterator<Item = Table> {
    let fits = move |suit: &&Suit| suit.agents.contains(&agent) && suit.environments.contains(&environment);
    SUITS.iter().filter(fits).map(|suit| suit.settings.parse().expect("the table above is TOML"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;

    #[test]
    fn all_that_suits_is_a_setting_that_may_be() {
        for suit in SUITS {
            for agent in suit.agents {
                for environment in suit.environments {
                    let config = Config::defaults(agent, environment).unwrap();
                    let own = (super::super::agent(agent).unwrap().defaults)();
                    assert_ne!(config.agent, own, "{agent} in {environment} is as everywhere");
                }
            }
        }
    }
}
