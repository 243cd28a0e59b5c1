//! A classifier of outcomes that trusts each as far as the initiation value function still does (thesis 5.1.2).
//!
//! ```text
//! w(s) = Y V(s) + (1 − Y) (1 − V(s))                                                                     (5.1)
//! ```
//!
//! An old failure at a state where the policy has become competent hardly counts any more, nor does an old success
//! where it has forgotten. After each execution the weights are computed again and the classifier is fitted again.

use std::collections::VecDeque;

use inroads_agents::classify::{Odds, Weighing};
use inroads_agents::{Bag, Checkpoint, Context, Corrupt, Evaluator, Experience, Key, Lesson, checkpoint};
use serde::{Deserialize, Serialize, de::DeserializeOwned};

use super::examples::{Places, row};
use super::{Act, Initiation, Ivf};
use crate::SkillId;

/// What an example counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Weights {
    /// Equation 5.1.
    #[default]
    Value,
    /// The same for failures, and 1 for successes: policies usually improve (policy improvement prior, 5.1.2).
    Prior,
    /// All the same: a plain binary classifier, what the thesis compares with.
    Equal,
}

impl Weights {
    /// w(s) of an example with this label where the value is `v`.
    pub fn of(self, success: bool, v: f32) -> f32 {
        match (self, success) {
            (Self::Equal, _) | (Self::Prior, true) => 1.0,
            (Self::Value, true) => v,
            (Self::Value | Self::Prior, false) => 1.0 - v,
        }
    }
}

/// Settings of [`Weighted`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct WeightedConfig {
    /// What an example counts.
    pub weights: Weights,
    /// Examples of either class that a skill remembers (authors: those of 10 trajectories a class on grids, of 1,000 in
    /// all with the ant).
    pub examples: usize,
}

impl Default for WeightedConfig {
    fn default() -> Self {
        Self { weights: Weights::Value, examples: 500 }
    }
}

impl WeightedConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        if self.examples == 0 {
            return Err("examples is 0; a classifier needs at least one of either class".into());
        }
        Ok(())
    }
}

/// Sets that a weighted classifier draws. Thresholds, gestation and optimism are those of the value function that weighs.
pub struct Weighted<O, A, E, G = (), C = Odds> {
    config: WeightedConfig,
    ivf: Ivf<O, A, E, G>,
    places: Places<O>,
    blank: C,
    sets: Vec<Set<O, C>>,
}

struct Set<O, C> {
    classifier: C,
    positives: VecDeque<O>,
    negatives: VecDeque<O>,
}

checkpoint!(
    [O, C] Set<O, C>; plain: positives, negatives; parts: classifier;
    where O: Serialize + DeserializeOwned, C: Checkpoint
);

impl<O, A, E, G, C: Weighing + Clone> Weighted<O, A, E, G, C> {
    /// A family that classifies the rows of `places` with copies of `blank`, weighted by the values of `ivf`.
    pub fn new(config: &WeightedConfig, ivf: Ivf<O, A, E, G>, places: Places<O>, blank: C) -> Self {
        Self { config: config.clone(), ivf, places, blank, sets: Vec::new() }
    }

    fn set(&self, k: SkillId) -> Option<&Set<O, C>> {
        self.sets.get(k.index().checked_sub(1)?)
    }

    /// How probable it is that skill `k` succeeds from `s`, as the classifier says.
    pub fn probability(&self, k: SkillId, s: &O) -> f32 {
        self.set(k).map_or(1.0, |set| set.classifier.probability(&row(&self.places, s)))
    }
}

impl<O: Key, A, E: Evaluator<O, A, G> + Clone, G, C: Weighing + Clone> Weighted<O, A, E, G, C> {
    /// Weighs all examples of skill `k` by what its value function says now, and fits its classifier again.
    fn refit(&mut self, k: SkillId) {
        let Some(set) = self.set(k) else { return };
        let states: Vec<&O> = set.positives.iter().chain(&set.negatives).collect();
        let labels: Vec<_> = (0..states.len()).map(|i| i < set.positives.len()).collect();
        let values = self.ivf.values(k, &states);
        let weights: Vec<_> =
            labels.iter().zip(values).map(|(success, v)| self.config.weights.of(*success, v)).collect();
        let rows: Vec<_> = states.into_iter().map(|s| row(&self.places, s)).collect();
        let set = &mut self.sets[k.index() - 1];
        // Without any example there is nothing to fit, and the set keeps what it has.
        let _unfit = set.classifier.fit_weighted(&rows, &labels, &weights);
    }
}

impl<O, C> Set<O, C> {
    fn new(classifier: C) -> Self {
        Self { classifier, positives: VecDeque::new(), negatives: VecDeque::new() }
    }

    fn remember(&mut self, states: impl IntoIterator<Item = O>, success: bool, capacity: usize) {
        let examples = if success { &mut self.positives } else { &mut self.negatives };
        examples.extend(states);
        let surplus = examples.len().saturating_sub(capacity);
        examples.drain(..surplus);
    }
}

impl<O, A, E, G, C> Initiation<O, A> for Weighted<O, A, E, G, C>
where
    O: Key + Clone + Serialize + DeserializeOwned,
    E: Evaluator<O, A, G> + Clone,
    G: Key + Clone + Serialize + DeserializeOwned,
    C: Weighing + Clone,
{
    fn born(&mut self, k: SkillId, positives: &[O]) {
        self.ivf.born(k, positives);
        let mut set = Set::new(self.blank.clone());
        set.remember(positives.iter().cloned(), true, self.config.examples);
        self.sets.push(set);
        self.refit(k);
    }

    fn contains(&self, k: SkillId, s: &O) -> bool {
        self.ivf.gestating(k) || {
            let (_, bonus) = self.ivf.optimism(k, s);
            self.probability(k, s) + bonus > self.ivf.config().optimistic
        }
    }

    /// Probability that is lacking to the pessimistic threshold.
    fn distance(&self, k: SkillId, s: &O) -> f32 {
        (self.ivf.config().pessimistic - self.probability(k, s)).max(0.0)
    }

    fn chance(&self, k: SkillId, s: &O) -> Option<f32> {
        Some(self.probability(k, s))
    }

    fn outcome(&mut self, k: SkillId, states: &[O], success: bool) {
        self.ivf.outcome(k, states, success);
        let capacity = self.config.examples;
        if let Some(set) = k.index().checked_sub(1).and_then(|i| self.sets.get_mut(i)) {
            set.remember(states.iter().cloned(), success, capacity);
        }
    }

    fn interrupted(&mut self, k: SkillId, s: &O) {
        self.ivf.interrupted(k, s);
    }

    fn lesson(&mut self, k: SkillId, lesson: &Lesson) {
        match self.config.weights {
            // Nobody asks for values then.
            Weights::Equal => self.ivf.count(k, lesson),
            Weights::Value | Weights::Prior => self.ivf.lesson(k, lesson),
        }
    }

    fn learn(&mut self, k: SkillId, all: &Experience<O, A>, act: &Act<'_, O, A>, ctx: &mut Context) {
        if self.config.weights != Weights::Equal {
            self.ivf.learn(k, all, act, ctx);
        }
        self.refit(k);
    }

    fn examples(&self, k: SkillId) -> (usize, usize) {
        self.set(k).map_or((0, 0), |set| (set.positives.len(), set.negatives.len()))
    }
}

impl<O, A, E, G, C> Checkpoint for Weighted<O, A, E, G, C>
where
    O: Serialize + DeserializeOwned,
    E: Checkpoint + Clone,
    G: Serialize + DeserializeOwned,
    C: Checkpoint + Clone,
{
    fn save(&self, bag: &mut Bag) {
        bag.put_part("ivf", &self.ivf);
        bag.put("sets", &self.sets.len());
        self.sets.iter().enumerate().for_each(|(i, set)| bag.put_part(&format!("{i}"), set));
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        bag.get_part("ivf", &mut self.ivf)?;
        self.sets.clear();
        for i in 0..bag.get::<usize>("sets")? {
            let mut set = Set::new(self.blank.clone());
            bag.get_part(&format!("{i}"), &mut set)?;
            self.sets.push(set);
        }
        Ok(())
    }
}
