//! Tabular Q-learning, for small worlds whose answers are known.

use std::collections::BTreeMap;

use inroads_envs::{Annotated, Bits, Frame};
use rand::RngExt;
use serde::{Deserialize, Serialize};

use crate::{
    Clip, Context, Learned, Learner, Memory, checkpoint,
    draw::{argmax, greatest},
};

/// What can name a row of a table: observations, goals.
pub trait Key {
    /// Equal things have equal keys, and others, for all that can happen, others.
    fn key(&self) -> u128;
}

/// One key of many numbers: FxHash (Firefox's; a rotation, an exclusive or, a product), of every other number in either
/// half, so that neither waits for the other. States of a hundred numbers are hashed for every step that is replayed.
pub fn key(numbers: impl IntoIterator<Item = u64>) -> u128 {
    let mut halves = [0x6c62_272e_07bb_0142_u64, 0x62b8_2175_6295_c58d];
    for (at, number) in numbers.into_iter().enumerate() {
        let half = &mut halves[at % 2];
        *half = (half.rotate_left(5) ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
    u128::from(halves[0]) << 64 | u128::from(halves[1])
}

/// A number to the nearest thousandth. (`round` is a call into a library on many processors.)
pub fn thousandths(x: f32) -> u64 {
    (f64::from(x) * 1e3 + 0.5_f64.copysign(f64::from(x))) as i64 as u64
}

/// Where there is nothing to tell apart.
impl Key for () {
    fn key(&self) -> u128 {
        0
    }
}

impl Key for Vec<f32> {
    /// Components to the nearest thousandth.
    fn key(&self) -> u128 {
        key(self.iter().map(|x| thousandths(*x)))
    }
}

impl Key for Bits {
    fn key(&self) -> u128 {
        key(self.ones().map(|bit| bit as u64))
    }
}

impl Key for Frame {
    /// All its bytes, and its shape.
    fn key(&self) -> u128 {
        let [width, height] = self.size();
        let shape = [width, height, self.channels()].map(u64::from);
        let words = self.bytes().chunks(8).map(|bytes| {
            let mut word = [0; 8];
            word[..bytes.len()].copy_from_slice(bytes);
            u64::from_le_bytes(word)
        });
        key(shape.into_iter().chain(words))
    }
}

impl<O: Key> Key for Annotated<O> {
    /// That of what is seen: bits may tell of what has just happened, which is no part of the state.
    fn key(&self) -> u128 {
        self.seen.key()
    }
}

/// Settings of tabular Q-learning.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TabularConfig {
    /// Step size of an update.
    pub rate: f32,
    /// γ.
    pub discount: f32,
    /// Share of random actions while exploring.
    pub epsilon: f32,
    /// Value of what was never tried.
    pub initial: f32,
    /// Clips an update.
    pub batch: usize,
}

impl Default for TabularConfig {
    fn default() -> Self {
        Self { rate: 0.5, discount: 0.99, epsilon: 0.1, initial: 0.0, batch: 8 }
    }
}

impl TabularConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        for (name, value) in [("rate", self.rate), ("discount", self.discount), ("epsilon", self.epsilon)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(format!("{name} is {value}; it must lie in [0, 1]"));
            }
        }
        if !self.initial.is_finite() {
            return Err(format!("initial is {}; it must be a number", self.initial));
        }
        if self.batch == 0 {
            return Err("batch is 0; an update needs at least one clip".into());
        }
        Ok(())
    }
}

/// Q-learning on a table, for the task and for every goal that it ever read; ties are broken at random (first-index
/// argmax can keep it from ever learning).
///
/// Returns of several steps end where somebody did what does not look best (Watkins 1989): what came after that says
/// nothing of how good it is to act well, and whoever learns in hindsight learns from steps on all kinds of errands.
#[derive(Clone, Debug)]
pub struct TabularQ {
    config: TabularConfig,
    /// The row of what was never tried.
    blank: Vec<f32>,
    /// By goal (none: the task) and state.
    values: BTreeMap<(Option<u128>, u128), Vec<f32>>,
}

checkpoint!([] TabularQ; plain: values; parts: );

impl TabularQ {
    /// An empty table for `actions` choices.
    pub fn new(actions: usize, config: &TabularConfig) -> Self {
        Self { config: config.clone(), blank: vec![config.initial; actions], values: BTreeMap::new() }
    }

    /// The value of every action at a state, on the way to a goal.
    pub fn action_values<G: Key>(&self, s: &impl Key, goal: Option<&G>) -> &[f32] {
        self.values.get(&(goal.map(Key::key), s.key())).unwrap_or(&self.blank)
    }
}

impl TabularQ {
    /// The return of a clip, as far as its actions look best, and what is expected from there on.
    fn target<O: Key, G>(&self, clip: &Clip<O, usize, G>, goal: Option<u128>) -> f32 {
        let (mut sum, mut discount) = (0.0, 1.0);
        let (states, actions) = (&clip.observations[clip.lead..], &clip.actions[clip.lead..]);
        for i in 0..clip.len() {
            sum += discount * clip.reward(i);
            discount *= self.config.discount;
            let last = i + 1 == clip.len();
            if last && clip.terminal {
                break;
            }
            let row = self.values.get(&(goal, states[i + 1].key())).unwrap_or(&self.blank);
            let best = greatest(row);
            if last || row[actions[i + 1]] < best {
                return sum + discount * best;
            }
        }
        sum
    }
}

impl<O: Key, G: Key> Learner<O, usize, G> for TabularQ {
    fn act(&self, _: &mut Memory, s: &O, goal: Option<&G>, ctx: &mut Context) -> usize {
        if ctx.explore && ctx.acting.random::<f32>() < self.config.epsilon {
            return ctx.acting.random_range(0..self.blank.len());
        }
        argmax(self.action_values(s, goal), &mut ctx.acting)
    }

    fn values(&self, _: &Memory, s: &O, goals: &[Option<&G>]) -> Vec<f32> {
        let state = s.key();
        let row = |goal: &Option<&G>| self.values.get(&(goal.map(Key::key), state)).unwrap_or(&self.blank);
        goals.iter().map(|goal| greatest(row(goal))).collect()
    }

    fn learn(&mut self, clips: &[Clip<O, usize, G>], _: &mut Context) -> Learned {
        let mut errors = Vec::with_capacity(clips.len());
        for clip in clips {
            let goal = clip.goal.map(Key::key);
            let target = self.target(clip, goal);
            let row = self.values.entry((goal, clip.first().key()));
            let value = &mut row.or_insert_with(|| self.blank.clone())[clip.actions[clip.lead]];
            errors.push(target - *value);
            *value += self.config.rate * clip.weight * (target - *value);
        }
        Learned::of(errors)
    }

    fn batch(&self) -> usize {
        self.config.batch
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experience::{Pay, Rewards};
    use inroads_envs::Seed;

    #[test]
    fn every_goal_has_a_table_of_its_own_and_the_task_another() {
        let mut learner = TabularQ::new(2, &TabularConfig { discount: 0.9, ..TabularConfig::default() });
        let observations = [vec![0.0_f32], vec![1.0], vec![2.0]];
        let (near, far) = (vec![2.0_f32], vec![9.0]);
        let clip = |goal, rewards, terminal| Clip::new(&observations, &[1, 0], rewards, goal, terminal);
        let mut ctx = Context::training(Seed(0), 0);
        for _ in 0..60 {
            let attained = clip(Some(&near), Rewards::Subgoal(Pay::ATTAINMENT, true), true);
            let missed = clip(Some(&far), Rewards::Subgoal(Pay::ATTAINMENT, false), false);
            learner.learn(&[attained, missed, clip(None, Rewards::Given(&[1.0, 1.0]), true)], &mut ctx);
        }
        let value = |goal| learner.action_values(&observations[0], goal)[1];
        assert!((value(Some(&near)) - 0.9).abs() < 1e-6, "two steps, the second attains it");
        assert!(value(Some(&far)).abs() < 1e-6 && (value(None) - 1.9).abs() < 1e-6);
        let asked = [Some(&near), None, Some(&vec![5.0])];
        let values = learner.values(&Memory::new(), &observations[0], &asked);
        assert!((values[0] - 0.9).abs() < 1e-6 && (values[1] - 1.9).abs() < 1e-6 && values[2] == 0.0);
    }

    #[test]
    fn pictures_are_told_apart_by_every_byte_and_by_their_shape() {
        let black = Frame::new([3, 3], 3);
        let mut keys: Vec<u128> = (0..27)
            .map(|at| {
                let mut frame = black.clone();
                frame.bytes_mut()[at] = 1;
                frame.key()
            })
            .collect();
        keys.extend([black.key(), Frame::new([9, 1], 3).key(), Frame::new([3, 9], 1).key()]);
        assert_eq!(Frame::new([3, 3], 3).key(), black.key());
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), 30);
    }

    #[test]
    fn returns_end_where_an_action_does_not_look_best() {
        let config = TabularConfig { discount: 0.5, rate: 1.0, ..TabularConfig::default() };
        let mut learner = TabularQ::new(2, &config);
        let observations = [vec![0.0_f32], vec![1.0], vec![2.0]];
        let mut ctx = Context::training(Seed(0), 0);
        let mut learn = |from: usize, action: usize, pay: &[f32]| {
            let actions = [action, 1];
            let (states, actions) = (&observations[from..], &actions[..pay.len()]);
            let clip: Clip<_, _, ()> = Clip::new(states, actions, Rewards::Given(pay), None, true);
            learner.learn(&[clip], &mut ctx);
            learner.action_values(&observations[from], None::<&()>)[action]
        };
        assert_eq!(learn(0, 0, &[0.0, 1.0]), 0.5, "what was never tried looks as good as anything");
        assert_eq!(learn(1, 0, &[3.0]), 3.0);
        assert_eq!(
            learn(0, 0, &[0.0, 1.0]),
            1.5,
            "action 1 at state 1 is worse than 3, so 3 is expected there"
        );
    }
}
