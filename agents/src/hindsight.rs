//! Hindsight: steps teach how to get where they led, whatever they were taken for (HER, Andrychowicz 2017).
//!
//! There are two ways. Clips are given the goal of a later state of their episode where they are drawn
//! ([`HindsightConfig::goals`], [`relabelled`]), so a step is learned from for another goal each time. Or an episode becomes
//! [`lessons`] about goals that are known beforehand, for instance some that it [`achieved`] (thesis 7.2.2.5, 8.4.2). In
//! both, reward *and* end follow from the goal: the step that attains it ends what is learned from, and the end that another
//! goal made does not.

mod lessons;

use std::collections::BTreeSet;

use inroads_envs::Rng;
use rand::RngExt;
use serde::{Deserialize, Serialize};

pub use lessons::{lessons, stretches};

use crate::{
    Clip, Experience, Goal, draw,
    experience::{Episode, Pay, Rewards},
};

/// Whose achievement becomes a goal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Strategy {
    /// Nobody's: every clip keeps its goal.
    None,
    /// That of a state after the step, all with the same probability.
    #[default]
    Future,
    /// That of the episode's last state.
    Final,
    /// Those of some states of the episode, about each of which the whole way there is a lesson (authors of thesis chapter 7).
    Achieved,
}

/// Settings of hindsight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HindsightConfig {
    /// Whose achievement becomes a goal.
    pub strategy: Strategy,
    /// Clips that get another goal for each that keeps its own, with `future` and `final`; 4 (k of the paper).
    pub per_clip: u32,
    /// Goals an episode, with `achieved`; 5 (authors of thesis chapter 7).
    pub per_episode: usize,
}

impl Default for HindsightConfig {
    fn default() -> Self {
        Self { strategy: Strategy::Future, per_clip: 4, per_episode: 5 }
    }
}

impl HindsightConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        let nothing = match self.strategy {
            Strategy::Future | Strategy::Final => ("per_clip", self.per_clip == 0),
            Strategy::Achieved => ("per_episode", self.per_episode == 0),
            Strategy::None => ("", false),
        };
        match nothing {
            (name, true) => Err(format!("{name} is 0, so nothing is relabelled; say strategy = \"none\"")),
            _ => Ok(()),
        }
    }

    /// The number of the observation whose achievement a clip is to be learned from for, when it begins with `step` of an
    /// episode of `length` steps; none when it keeps its goal.
    fn draw(&self, step: u32, length: u32, rng: &mut Rng) -> Option<u32> {
        let drawn = matches!(self.strategy, Strategy::Future | Strategy::Final)
            && rng.random_range(0..=self.per_clip) > 0;
        drawn.then(|| match self.strategy {
            Strategy::Future => rng.random_range(step + 1..=length),
            _ => length,
        })
    }

    /// The goals that clips are to be learned from for, in their order; none for those that keep theirs.
    ///
    /// Episodes should be over: of one that goes on nobody knows yet where it leads.
    pub fn goals<O, A, G>(
        &self,
        clips: &[Clip<'_, O, A, G>],
        all: &Experience<O, A>,
        achieved: impl Fn(&O) -> G,
        rng: &mut Rng,
    ) -> Vec<Option<G>> {
        let goal = |clip: &Clip<'_, O, A, G>| {
            let episode = all.episode(clip.at.0)?;
            let step = clip.at.1 + clip.lead as u32;
            let at = self.draw(step, episode.actions.len() as u32, rng)?;
            Some(achieved(&episode.observations[at as usize]))
        };
        clips.iter().map(goal).collect()
    }
}

/// Clips for other goals, where there are any.
pub fn relabelled<'a, O, A, G: Goal<O>>(
    clips: &[Clip<'a, O, A, G>],
    goals: &'a [Option<G>],
    pay: Pay,
) -> Vec<Clip<'a, O, A, G>> {
    let new = |(clip, goal): (&Clip<'a, O, A, G>, &'a Option<G>)| match goal {
        Some(goal) => relabel(clip, goal, pay),
        None => Clip { ..*clip },
    };
    clips.iter().zip(goals).map(new).collect()
}

/// A clip for another goal: up to the first step that attains it, which ends it for good.
fn relabel<'a, O, A, G: Goal<O>>(clip: &Clip<'a, O, A, G>, goal: &'a G, pay: Pay) -> Clip<'a, O, A, G> {
    let hit = (clip.lead + 1..clip.observations.len()).find(|&i| goal.reached(&clip.observations[i]));
    let end = hit.unwrap_or(clip.actions.len());
    // What ended because its own goal was attained would have gone on for another one.
    let own = clip.goal.is_some_and(|goal| goal.reached(clip.last()));
    Clip {
        observations: &clip.observations[..=end],
        actions: &clip.actions[..end],
        rewards: Rewards::Subgoal(pay, hit.is_some()),
        goal: Some(goal),
        terminal: hit.is_some() || (clip.terminal && !own),
        ..*clip
    }
}

/// Up to `n` different goals that an episode achieved and that did not hold at its start, drawn one after the other by
/// `weight`, which is above 0. They stand in the order in which they were first achieved.
pub fn achieved<O, A, G: Goal<O>>(
    episode: &Episode<O, A>,
    goal: impl Fn(&O) -> G,
    weight: impl Fn(&G) -> f64,
    n: usize,
    rng: &mut Rng,
) -> Vec<G> {
    let Some((start, rest)) = episode.observations.split_first() else { return Vec::new() };
    let mut met = BTreeSet::new();
    let mut found: Vec<_> = rest
        .iter()
        .map(goal)
        .filter(|goal| !goal.reached(start) && met.insert(goal.key()))
        .map(Some)
        .collect();
    let weights: Vec<_> = found.iter().flatten().map(weight).collect();
    draw::different(&weights, n, rng).into_iter().filter_map(|i| found[i].take()).collect()
}

#[cfg(test)]
mod tests;
