//! Settings of deep skill chaining.

use serde::{Deserialize, Serialize};

/// Settings of deep skill chaining. Where the thesis and the authors' code differ, the default follows
/// `decisions.md` and the other reading is a value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ChainConfig {
    /// N: times that a subgoal must be triggered before a skill for it is created (authors' runs: 5).
    pub gestation: u32,
    /// K: last states of each such trajectory that seed the initiation set (authors: 20).
    pub segment: u32,
    /// Episodes in which a new skill is executed before its initiation set is fixed (3.1.3).
    pub initiation_episodes: u32,
    /// Successful executions that the initiation period must have seen too, so that no set is fixed on
    /// failures alone (authors' code counts only these: 2).
    pub initiation_successes: u32,
    /// Steps after which a learned skill hands back (T; authors: 100).
    pub timeout: u32,
    /// When a skill's set becomes a subgoal for the next one.
    pub chain_at: ChainAt,
    /// What an option policy is rewarded with.
    pub option_reward: OptionReward,
    /// What an option policy learns from.
    pub lessons: Lessons,
    /// Updates of a new skill's policy on past experience, before it is executed (authors: one for every
    /// step of the global replay buffer).
    pub pretrain: u32,
    /// What an execution goes for (4.1.2).
    pub subgoals: Subgoals,
    /// What is done where no skill may start.
    pub explore: Explore,
    /// Greatest distance from a subgoal state that counts as there, in the units of the domain (authors: 0.6).
    pub tolerance: f32,
    /// States of an episode that policies are taught to reach, in hindsight, where they are told states.
    pub hindsight: u32,
    /// Whether a set is fixed when its initiation period is over (3.1.3), or goes on being refined (chapters 4 and 5).
    pub freeze: bool,
    /// Whether every state along an execution is a sample for the policy over options (authors' code), or only
    /// the one in which it was chosen.
    pub intra_option: bool,
    /// Greatest share of a new skill's states that may lie in the sets of other skills with the same subgoal;
    /// above it they tell of the same branch of the tree (authors' tree code: 0.35).
    pub sibling_overlap: f32,
    /// Whether a step that ends the task in a state of some set is a trigger of the task, so that a second branch of the
    /// tree may reach the goal itself; else it is one of that set.
    pub goal_first: bool,
    /// Greatest distance between the starts of trajectories that beget one skill, in the units of the domain: those from
    /// farther apart begin different branches of the tree (3.1.4). 0: wherever they start.
    pub branch: f32,
    /// γ of the task's rewards, for the policy over options.
    pub discount: f32,
    /// Learned skills at most.
    pub max_skills: u32,
}

impl Default for ChainConfig {
    fn default() -> Self {
        Self {
            gestation: 5,
            segment: 20,
            initiation_episodes: 10,
            initiation_successes: 5,
            timeout: 100,
            chain_at: ChainAt::InitiationEnd,
            option_reward: OptionReward::Sparse,
            lessons: Lessons::All,
            pretrain: 3000,
            subgoals: Subgoals::Set,
            explore: Explore::Task,
            tolerance: 0.6,
            hindsight: 4,
            freeze: true,
            intra_option: true,
            sibling_overlap: 0.35,
            goal_first: false,
            branch: 0.0,
            discount: 0.99,
            max_skills: 20,
        }
    }
}

impl ChainConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        for (name, value) in
            [("gestation", self.gestation), ("segment", self.segment), ("timeout", self.timeout)]
        {
            if value == 0 {
                return Err(format!("{name} is 0; it must be at least 1"));
            }
        }
        for (name, value) in [("sibling_overlap", self.sibling_overlap), ("discount", self.discount)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(format!("{name} is {value}; it must lie in [0, 1]"));
            }
        }
        for (name, distance) in [("tolerance", self.tolerance), ("branch", self.branch)] {
            if !(distance.is_finite() && distance >= 0.0) {
                return Err(format!("{name} is {distance}; it must be 0 or above"));
            }
        }
        if self.subgoals == Subgoals::DynamicProgramming && self.option_reward == OptionReward::Dense {
            return Err("subgoals = \"dynamic_programming\" reads probabilities from the values of sparse rewards; set \
                        option_reward = \"sparse\", or subgoals = \"sample\""
                .into());
        }
        if self.subgoals == Subgoals::Set && self.explore == Explore::Events {
            return Err("explore = \"events\" sends a policy to states, which with subgoals = \"set\" none can be told; \
                        set explore = \"task\""
                .into());
        }
        Ok(())
    }
}

/// What the global option does: it is called where no learned skill may start, or is not wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Explore {
    /// One primitive action on the way to the task's goal (3.1.2).
    Task,
    /// It goes for the nearest salient event, the task's goal among them, until some skill may start or its time is out
    /// (authors' code of chapter 4, in which a skill in gestation does that, and the global option afterwards).
    Events,
}

/// What an execution of a skill goes for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Subgoals {
    /// Any state of its subgoal: policies are told nothing (chapter 3).
    Set,
    /// A state that the parent is known to succeed from, drawn at random: for robustness (4.1.2).
    Sample,
    /// The state from which the rest of the chain is worth most: for hierarchical optimality (4.1.2).
    DynamicProgramming,
}

/// When a skill's initiation set becomes a salient event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ChainAt {
    /// When its initiation period is over and the set is fixed (3.1.3).
    InitiationEnd,
    /// As soon as the skill exists, while its set still moves (authors' code).
    Gestation,
}

/// The reward of an option policy (3.1.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OptionReward {
    /// 0 for reaching the subgoal, −1 for every other step.
    Sparse,
    /// Minus the distance to the subgoal: to the state that an execution goes for, to the goal's point, or to the parent's set
    /// in its classifier's units.
    Dense,
}

/// Which experience an option policy learns from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Lessons {
    /// Steps that the skill itself took, after one pass over the past (authors' code).
    Own,
    /// Every step of every episode, whoever acted: the policies are learned off-policy anyway.
    All,
}
