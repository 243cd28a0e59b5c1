//! Double DQN whose choices grow in number: the policy over options (thesis 3.1.2, eq. 3.3).
//!
//! It knows nothing of options. A choice may take several steps (the discount is the sample's own), not every
//! choice is admissible at every state, and a new choice can be added without changing the others' values.

use inroads_envs::Rng;
use serde::{Deserialize, Serialize};

use super::Loss;
use crate::nets::{Backend, QNetwork, Step};
use crate::{Bag, Checkpoint, Corrupt};

/// Settings of [`GrowingDqn`]. Defaults are those of the authors' code (`authors.md`, section 1).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GrowingConfig {
    /// Widths of the hidden layers; 256 and 128 (authors' code).
    pub hidden: Vec<usize>,
    /// Adam's rate; 1e-4 (authors' code).
    pub rate: f32,
    /// τ of θ' ← τθ + (1−τ)θ', at every update; 1e-3 (authors' code).
    pub tau: f32,
    /// Samples an update; 64 (authors' code).
    pub batch: usize,
    /// Loss; Huber's (authors' code).
    pub loss: Loss,
    /// Greatest norm of the gradient; 0 is no bound (authors' code has none).
    pub gradient_clip: f32,
}

impl Default for GrowingConfig {
    fn default() -> Self {
        Self {
            hidden: vec![256, 128],
            rate: 1e-4,
            tau: 1e-3,
            batch: 64,
            loss: Loss::Huber,
            gradient_clip: 0.0,
        }
    }
}

impl GrowingConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        if self.hidden.contains(&0) {
            return Err(format!("hidden is {:?}; no layer may have width 0", self.hidden));
        }
        if self.batch == 0 {
            return Err("batch is 0; an update needs at least one sample".into());
        }
        if !(self.rate.is_finite() && self.rate > 0.0) {
            return Err(format!("rate is {}; it must be a number above 0", self.rate));
        }
        if !(0.0..=1.0).contains(&self.tau) {
            return Err(format!("tau is {}; it must lie in [0, 1]", self.tau));
        }
        if !(self.gradient_clip.is_finite() && self.gradient_clip >= 0.0) {
            return Err(format!("gradient_clip is {}; it must be 0 (none) or above", self.gradient_clip));
        }
        Ok(())
    }
}

/// What came of one choice.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample<'a> {
    /// The row of the state where it was made.
    pub before: &'a [f32],
    /// Which it was.
    pub choice: usize,
    /// What it earned, discounted over the steps it took: Σ γ^i r_i.
    pub reward: f32,
    /// γ to the number of steps it took.
    pub discount: f32,
    /// The row of the state where it ended.
    pub after: &'a [f32],
    /// The choices that are admissible there; all are when none is. Those it does not speak of are not.
    pub admissible: Vec<bool>,
    /// Whether the episode terminated there.
    pub terminal: bool,
}

/// Values of choices, learned by double Q-learning.
#[derive(Clone, Debug)]
pub struct GrowingDqn {
    config: GrowingConfig,
    nets: QNetwork,
    updates: u64,
}

impl GrowingDqn {
    /// A learner with weights drawn from `rng`, for rows of `inputs` numbers and at least one choice.
    pub fn new(
        inputs: usize,
        outputs: usize,
        config: &GrowingConfig,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        let nets = QNetwork::new(inputs, &config.hidden, outputs, backend, rng);
        Self { config: config.clone(), nets, updates: 0 }
    }

    /// Number of choices.
    pub fn outputs(&self) -> usize {
        self.nets.outputs()
    }

    /// Samples that [`learn`](Self::learn) wants.
    pub fn batch(&self) -> usize {
        self.config.batch
    }

    /// Minibatch updates made so far.
    pub fn updates(&self) -> u64 {
        self.updates
    }

    /// The values of all choices at the given rows, row by row.
    pub fn values(&self, rows: &[f32]) -> Vec<f32> {
        self.nets.values(rows.to_vec())
    }

    /// One minibatch update; the mean loss.
    ///
    /// # Panics
    /// When a sample speaks of a choice that there is not.
    pub fn learn(&mut self, samples: &[Sample<'_>]) -> f32 {
        if samples.is_empty() {
            return 0.0;
        }
        let after = samples.iter().map(|sample| sample.after).collect::<Vec<_>>().concat();
        let online = self.nets.values(after.clone());
        let target = self.nets.target_values(after);
        let outputs = self.outputs();
        let targets: Vec<f32> = samples
            .iter()
            .zip(online.chunks_exact(outputs).zip(target.chunks_exact(outputs)))
            .map(|(sample, (online, target))| double_target(sample, online, target))
            .collect();
        let choices: Vec<usize> = samples.iter().map(|sample| sample.choice).collect();

        let loss = self.config.loss;
        let step = Step { rate: self.config.rate, clip: self.config.gradient_clip, ..Step::default() };
        let before = samples.iter().map(|sample| sample.before).collect::<Vec<_>>().concat();
        let errors = self.nets.learn(before, &choices, &targets, |error| loss.slope(error), step);
        self.nets.follow(self.config.tau);
        self.updates += 1;
        errors.iter().map(|&error| loss.value(error)).sum::<f32>() / samples.len() as f32
    }

    /// Adds a choice that is worth `bias` at every state, until it is learned otherwise (thesis 3.1.2). The
    /// values of the others do not change by a bit.
    pub fn grow(&mut self, bias: f32) {
        self.nets.grow(bias);
    }
}

/// y = r + γ^τ Q'(s', argmax over the admissible of Q(s', ·)) (eq. 3.3).
fn double_target(sample: &Sample<'_>, online: &[f32], target: &[f32]) -> f32 {
    if sample.terminal {
        return sample.reward;
    }
    let best = best(online, &sample.admissible).or_else(|| best(online, &vec![true; online.len()]));
    sample.reward + best.map_or(0.0, |choice| sample.discount * target[choice])
}

/// The first of the admissible choices of greatest value.
fn best(values: &[f32], admissible: &[bool]) -> Option<usize> {
    let mut best: Option<(usize, f32)> = None;
    for (choice, (&value, _)) in values.iter().zip(admissible).enumerate().filter(|(_, (_, ok))| **ok) {
        if best.is_none_or(|(_, greatest)| value > greatest) {
            best = Some((choice, value));
        }
    }
    best.map(|(choice, _)| choice)
}

impl Checkpoint for GrowingDqn {
    fn save(&self, bag: &mut Bag) {
        bag.put_part("nets", &self.nets);
        bag.put("updates", &self.updates);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        bag.get_part("nets", &mut self.nets)?;
        self.updates = bag.get("updates")?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::Seed;
    use rand::RngExt;

    fn learner(outputs: usize, config: &GrowingConfig) -> GrowingDqn {
        GrowingDqn::new(3, outputs, config, Backend::of_tests(), &mut Seed(5).stream("weights", 0))
    }

    fn small() -> GrowingConfig {
        GrowingConfig { hidden: vec![40, 24], rate: 3e-3, tau: 0.05, ..Default::default() }
    }

    fn sample(reward: f32, terminal: bool, admissible: &[bool]) -> Sample<'static> {
        let (before, after): (&[f32], &[f32]) = (&[0.1, 0.2, 0.3], &[0.3, 0.1, -0.2]);
        Sample { before, choice: 0, reward, discount: 0.81, after, admissible: admissible.to_vec(), terminal }
    }

    fn rows(n: usize) -> Vec<f32> {
        let mut rng = Seed(11).stream("rows", 0);
        (0..3 * n).map(|_| rng.random_range(-2.0..2.0)).collect()
    }

    fn bits(values: &[f32]) -> Vec<u32> {
        values.iter().map(|value| value.to_bits()).collect()
    }

    fn saved(learner: &GrowingDqn) -> Bag {
        let mut bag = Bag::default();
        learner.save(&mut bag);
        bag
    }

    /// Update number `index` on random samples.
    fn update(learner: &mut GrowingDqn, index: u64) -> f32 {
        let mut rng = Seed(9).stream("samples", index);
        let rows = rows(33);
        let samples: Vec<_> = (0..32)
            .map(|i| Sample {
                before: &rows[3 * i..3 * i + 3],
                choice: rng.random_range(0..learner.outputs()),
                reward: rng.random_range(-1.0..0.0),
                discount: 0.9,
                after: &rows[3 * i + 3..3 * i + 6],
                admissible: vec![true, i % 2 == 0],
                terminal: i % 7 == 0,
            })
            .collect();
        learner.learn(&samples)
    }

    #[test]
    fn the_double_target_takes_the_online_choice_at_the_targets_value() {
        // A plain maximum over the target would be 1 + 0.81 × 10.
        let (online, target) = ([2.0, 1.0], [3.0, 10.0]);
        let y = |sample: &Sample<'_>| double_target(sample, &online, &target);
        let all = [true, true];
        assert_eq!(y(&sample(1.0, false, &all)), 1.0 + 0.81 * 3.0);
        // A truncation is not terminal and bootstraps; a termination does not.
        assert_eq!(y(&sample(1.0, true, &all)), 1.0);
        // Only what is admissible is chosen; where nothing is, all is.
        assert_eq!(y(&sample(1.0, false, &[false, true])), 1.0 + 0.81 * 10.0);
        assert_eq!(y(&sample(1.0, false, &[false, false])), 1.0 + 0.81 * 3.0);
        // A sample from before the network grew does not speak of the new choice.
        assert_eq!(y(&sample(1.0, false, &[true])), 1.0 + 0.81 * 3.0);
    }

    #[test]
    fn a_new_choice_is_worth_its_bias_everywhere_and_the_old_ones_keep_their_bits() {
        for outputs in [1, 2, 5, 8] {
            let mut learner = learner(outputs, &small());
            (0..3).for_each(|index| _ = update(&mut learner, index));
            for n in [1, 2, 33, 64] {
                let mut grown = learner.clone();
                grown.grow(-7.25);
                let rows = rows(n);
                let old = learner.values(&rows);
                let new = grown.values(&rows);
                let target = grown.nets.target_values(rows.clone());
                for row in 0..n {
                    let (old, new) = (&old[row * outputs..][..outputs], &new[row * (outputs + 1)..]);
                    assert_eq!(bits(old), bits(&new[..outputs]));
                    assert_eq!((new[outputs], target[row * (outputs + 1) + outputs]), (-7.25, -7.25));
                }
            }
        }
    }

    #[test]
    fn it_learns_the_values_of_a_small_process() {
        // Choice 0 ends with −1; choice 1 costs −0.25, takes two steps (0.9²) and leads back. Greedy: the
        // state is worth max(−1, −0.25 + 0.81 V), of which the second is −0.25/0.19 and the first is better.
        let mut learner = learner(2, &small());
        let row = [0.5, -0.5, 1.0];
        let both = |choice, reward, terminal| Sample {
            before: &row,
            choice,
            reward,
            discount: 0.81,
            after: &row,
            admissible: vec![true, true],
            terminal,
        };
        let samples = [vec![both(0, -1.0, true); 16], vec![both(1, -0.25, false); 16]].concat();
        let loss = (0..2000).map(|_| learner.learn(&samples)).last().unwrap();
        let values = learner.values(&row);
        assert!(loss < 1e-4, "{loss}");
        assert!((values[0] + 1.0).abs() < 0.02 && (values[1] + 0.25 + 0.81).abs() < 0.02, "{values:?}");
    }

    #[test]
    fn a_grown_learner_resumes_to_the_same_bits() {
        let run = |learner: &mut GrowingDqn, from, to| (from..to).for_each(|i| _ = update(learner, i));
        let mut one = learner(2, &small());
        run(&mut one, 0, 25);
        one.grow(0.5);
        run(&mut one, 25, 50);
        let mut resumed = learner(2, &small());
        resumed.load(&saved(&one)).unwrap();
        assert_eq!((resumed.outputs(), resumed.updates()), (3, 50));
        assert!(saved(&resumed) == saved(&one));
        run(&mut one, 50, 60);
        run(&mut resumed, 50, 60);
        assert!(saved(&resumed) == saved(&one));
    }

    #[test]
    fn settings_that_make_no_learner_are_named() {
        assert_eq!(GrowingConfig::default().check(), Ok(()));
        assert!(GrowingConfig { tau: 2.0, ..small() }.check().unwrap_err().contains("tau"));
    }
}
