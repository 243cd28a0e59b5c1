//! Which proto-goals are plausible: observed, reachable and controllable (thesis section 8.3.1).
//!
//! For each goal that occurs in a batch of transitions, least-squares policy iteration gives values of *seeking* it
//! (reward 1 where it is attained) and of *avoiding* it (−1): [`inroads_agents::lspi`]. A goal is plausible if
//!
//! 1. it was ever observed,
//! 2. `max V_seek > τ₁` (equation 8.1): it can be attained from somewhere,
//! 3. `E[V_seek] − E[−V_avoid] ≥ τ₂` (equation 8.2): who seeks it attains it more than who avoids it. (The caption of figure
//!    8.6 calls this threshold τ₁.)
//!
//! A goal that was observed but that the batch does not attain is plausible: optimism in the face of what is not known
//! (footnote 2 of the chapter).
//!
//! **Where a goal occurs.** A transition attains a goal if all of the goal's bits hold *after* it, held before or not. With
//! "held after and not before" a passenger's destination, which is settled before the first step, would never occur, and
//! optimism would call it plausible; figure 8.3 needs it judged. That a goal which holds already is neither pursued nor
//! taught (`decisions.md`) is the business of who chooses goals.
//!
//! **Which states count.** Values are those after each transition. Where a goal is attained, they are 1 and −1. So the
//! maximum of equation 8.1 is over states where the goal does *not* hold, or it would be 1 for everything that occurs; the
//! means of equation 8.2 are over all, and states where it holds add nothing to their difference.

use inroads_agents::{
    Encoder, Experience,
    lspi::{Lspi, LspiError, Projection, Rows, Values},
};
use inroads_envs::{Annotated, Bits, End, Rng};
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};

use crate::Wanted;

/// Settings of plausibility.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Plausibility {
    /// Transitions in a batch (the thesis: "a small subset of the data").
    pub batch: usize,
    /// τ₁: the discounted probability of attaining a goal from the best state has to be more, in [0, 1). The thesis gives no
    /// number.
    pub reachable: f32,
    /// τ₂: the least difference between what seeking attains and what avoiding cannot avoid. The thesis gives no number and
    /// says that it depends on the environment; in our three probes 0.10 to 0.17 serves all on each of ten seeds,
    /// and with 16,384 transitions 0.03 to 0.41 (`docs/results/small/controllability.json`).
    pub controllable: f32,
    /// How values are estimated.
    pub lspi: Lspi,
}

impl Default for Plausibility {
    fn default() -> Self {
        Self { batch: 4096, reachable: 0.05, controllable: 0.1, lspi: Lspi::default() }
    }
}

/// What values of seeking and avoiding a goal come down to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The greatest value of seeking it where it does not hold; 0 if it holds everywhere.
    pub reach: f32,
    /// The mean value of seeking it, in [0, 1].
    pub seek: f32,
    /// The mean value of avoiding it, in [−1, 0].
    pub avoid: f32,
}

impl Estimate {
    /// The left-hand side of equation 8.2.
    pub fn control(&self) -> f32 {
        self.seek + self.avoid
    }

    fn of(values: Values<'_>) -> Self {
        let mean = |all: &[f32]| all.iter().map(|&x| f64::from(x)).sum::<f64>() / all.len().max(1) as f64;
        let away = values.seek.iter().zip(values.occurs).filter(|(_, occurs)| !**occurs);
        Self {
            reach: away.map(|(seek, _)| *seek).fold(0.0, f32::max),
            seek: mean(values.seek) as f32,
            avoid: mean(values.avoid) as f32,
        }
    }
}

/// What is thought of a goal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Judgement {
    /// It was never observed: not plausible.
    Unobserved,
    /// It was observed, but not in the batch: plausible, nobody knows.
    Absent,
    /// It occurs in the batch.
    Estimated(Estimate),
}

/// What is thought of goals, and on what basis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Judged {
    /// A judgement for each goal.
    pub goals: Vec<Judgement>,
    /// Whether the features were fewer than what is seen has directions ([`Projection::narrow`]): estimates may be wrong.
    pub narrow: bool,
}

impl Plausibility {
    /// Whether the settings make sense.
    ///
    /// # Errors
    /// What is wrong, and how to mend it.
    pub fn check(&self) -> Result<(), String> {
        if self.batch == 0 {
            return Err("batch = 0 says nothing about any goal; give 1 or more (4096)".into());
        }
        if !(0.0..1.0).contains(&self.reachable) {
            let found = self.reachable;
            return Err(format!("reachable = {found} is no probability to exceed; give 0 to below 1 (0.05)"));
        }
        if !(-1.0..=1.0).contains(&self.controllable) {
            let found = self.controllable;
            return Err(format!("controllable = {found} is no difference of values; give −1 to 1 (0.1)"));
        }
        self.lspi.check().map_err(|why| format!("lspi: {why}"))
    }

    /// Whether a goal of which this is thought is plausible.
    pub fn accepts(&self, judgement: &Judgement) -> bool {
        match judgement {
            Judgement::Unobserved => false,
            Judgement::Absent => true,
            Judgement::Estimated(found) => {
                found.reach > self.reachable && found.control() >= self.controllable
            }
        }
    }

    /// Judges goals by a batch drawn from the experience. `counts` says how often each goal was ever observed.
    ///
    /// # Errors
    /// [`LspiError`] when there is no experience yet, or the encoder writes what is no number.
    ///
    /// # Panics
    /// When there are not as many counts as goals, or a goal has other bits than the observations.
    pub fn judge<O>(
        &self,
        experience: &Experience<Annotated<O>, usize>,
        encoder: &(impl Encoder<O> + ?Sized),
        choices: usize,
        goals: &[Wanted],
        counts: &[u64],
        rng: &mut Rng,
    ) -> Result<Judged, LspiError> {
        assert_eq!(goals.len(), counts.len(), "a count for each goal");
        let (rows, bits) = self.draw(experience, encoder, rng);
        if rows.is_empty() {
            return Err(LspiError::Nothing);
        }
        let projection = Projection::fit(&rows, self.lspi.features, rng);
        let batch = self.lspi.batch(&projection.project(&rows), choices)?;
        let events = occurrences(&bits, goals);
        let known = |&count| if count == 0 { Judgement::Unobserved } else { Judgement::Absent };
        let mut judged = Judged { goals: counts.iter().map(known).collect(), narrow: projection.narrow() };
        self.lspi.solve(&batch, &events, rng, |goal, values| {
            judged.goals[goal] = Judgement::Estimated(Estimate::of(values));
        });
        Ok(judged)
    }

    /// Transitions drawn without replacement, all if there are no more than a batch; and what holds after each.
    fn draw<'a, O>(
        &self,
        experience: &'a Experience<Annotated<O>, usize>,
        encoder: &(impl Encoder<O> + ?Sized),
        rng: &mut Rng,
    ) -> (Rows, Vec<&'a Bits>) {
        let steps: usize = experience.numbers().map(|number| experience.length(number) as usize).sum();
        let mut all: Vec<usize> = (0..steps).collect();
        let mut chosen = all.partial_shuffle(rng, self.batch.min(steps)).0.to_vec();
        chosen.sort_unstable();
        let (mut rows, mut bits) = (Rows::new(encoder.width()), Vec::with_capacity(chosen.len()));
        let (mut before, mut after) = (vec![0.0; encoder.width()], vec![0.0; encoder.width()]);
        let mut chosen = chosen.into_iter().peekable();
        let mut passed = 0;
        for episode in experience.numbers().filter_map(|number| experience.episode(number)) {
            let length = episode.actions.len();
            while let Some(at) = chosen.next_if(|&at| at < passed + length) {
                let step = at - passed;
                let [s, next] = [&episode.observations[step], &episode.observations[step + 1]];
                encoder.write(&s.seen, &mut before);
                encoder.write(&next.seen, &mut after);
                let over = episode.end == Some(End::Terminated) && step + 1 == length;
                rows.push(&before, episode.actions[step], &after, over);
                bits.push(&next.bits);
            }
            passed += length;
        }
        (rows, bits)
    }
}

/// The transitions that attain each goal: where all of its bits hold after. A goal without bits asks nothing, and nothing
/// attains it.
fn occurrences(bits: &[&Bits], goals: &[Wanted]) -> Vec<Vec<usize>> {
    let mut holding = vec![Vec::new(); bits.first().map_or(0, |bits| bits.len())];
    for (row, bits) in bits.iter().enumerate() {
        bits.ones().for_each(|bit| holding[bit].push(row));
    }
    let attained = |goal: &Wanted| {
        let mut wanted = goal.0.ones();
        let first = wanted.next().map_or_else(Vec::new, |bit| holding[bit].clone());
        wanted.fold(first, |rows, bit| rows.into_iter().filter(|&row| bits[row].get(bit)).collect())
    };
    goals.iter().map(attained).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_agents::Transition;
    use inroads_envs::Seed;
    use rand::RngExt;

    /// What is seen, as it is.
    struct Plain;

    impl Encoder<Vec<f32>> for Plain {
        fn width(&self) -> usize {
            4
        }

        fn write(&self, observation: &Vec<f32>, out: &mut [f32]) {
            out.copy_from_slice(observation);
        }
    }

    fn goal(bits: &[usize]) -> Wanted {
        let mut wanted = Bits::new(5);
        bits.iter().for_each(|&bit| wanted.set(bit));
        Wanted(wanted)
    }

    /// Two bits that the two actions set (0: off, 1: on), a coin, one that is settled with the episode, and one that never
    /// holds. Episodes of 10 steps.
    fn experience(episodes: u64) -> Experience<Annotated<Vec<f32>>, usize> {
        let (mut rng, mut actions) = (Seed(5).stream("bits", 0), Seed(5).stream("actions", 0));
        let mut all = Experience::new(100_000);
        for _ in 0..episodes {
            let (mut switch, settled) = (false, rng.random_bool(0.5));
            let mut state = |switch: bool| {
                let coin = rng.random_bool(0.5);
                let holds = [switch, !switch, coin, settled];
                let mut bits = Bits::new(5);
                (0..4).filter(|&bit| holds[bit]).for_each(|bit| bits.set(bit));
                Annotated { seen: holds.map(|holds| f32::from(u8::from(holds))).to_vec(), bits }
            };
            let mut s = state(switch);
            all.begin(&s);
            for step in 0..10 {
                let action = actions.random_range(0..2);
                switch = action == 1;
                let after = state(switch);
                let end = (step == 9).then_some(End::Truncated);
                all.push(&Transition { before: &s, action: &action, reward: 0.0, after: &after, end });
                s = after;
            }
        }
        all
    }

    fn judge(goals: &[Wanted], counts: &[u64], config: &Plausibility) -> Vec<Judgement> {
        let mut rng = Seed(6).stream("judge", 0);
        let judged = config.judge(&experience(400), &Plain, 2, goals, counts, &mut rng).unwrap();
        assert!(!judged.narrow);
        judged.goals
    }

    #[test]
    fn what_actions_set_is_plausible_and_what_they_do_not_is_not() {
        let config = Plausibility::default();
        let goals: Vec<Wanted> = (0..5).map(|bit| goal(&[bit])).collect();
        let judged = judge(&goals, &[9, 9, 9, 9, 0], &config);
        let accepted: Vec<bool> = judged.iter().map(|judgement| config.accepts(judgement)).collect();
        assert_eq!(accepted, [true, true, false, false, false]);
        assert_eq!(judged[4], Judgement::Unobserved);
        let Judgement::Estimated(switch) = judged[0] else { panic!("{judged:?}") };
        // On: at once for who seeks it. Off for good for who avoids it, but for where it is on now.
        assert!(switch.reach > 0.99 && switch.seek > 0.99, "{switch:?}");
        assert!((switch.control() - 0.5).abs() < 0.05, "{switch:?}");
        let Judgement::Estimated(settled) = judged[3] else { panic!("{judged:?}") };
        assert!(settled.reach < 0.02 && settled.control().abs() < 0.01, "{settled:?}");
    }

    #[test]
    fn a_goal_of_two_bits_needs_both() {
        let config = Plausibility::default();
        let judged = judge(&[goal(&[0, 3]), goal(&[0, 1])], &[1, 1], &config);
        // On while settled: half of the episodes can.
        let Judgement::Estimated(both) = judged[0] else { panic!("{judged:?}") };
        assert!((0.1..0.6).contains(&both.control()), "{both:?}");
        // On and off never hold together. Said to have been observed, they are believed; else not.
        assert_eq!(judged[1], Judgement::Absent);
        assert!(config.accepts(&judged[1]) && !config.accepts(&Judgement::Unobserved));
    }

    #[test]
    fn a_goal_is_attained_where_all_its_bits_hold() {
        let rows: Vec<Bits> = [[0, 1], [1, 2], [0, 2]].map(|bits| goal(&bits).0).into();
        let rows: Vec<&Bits> = rows.iter().collect();
        let goals = [goal(&[0]), goal(&[1, 2]), goal(&[3]), goal(&[])];
        assert_eq!(occurrences(&rows, &goals), [vec![0, 2], vec![1], vec![], vec![]]);
    }

    #[test]
    fn a_batch_is_drawn_without_replacement() {
        let all = experience(30);
        let draw = |batch| {
            let config = Plausibility { batch, ..Plausibility::default() };
            config.draw(&all, &Plain, &mut Seed(1).stream("draw", 0)).0
        };
        assert_eq!((draw(50).len(), draw(300).len(), draw(1_000).len()), (50, 300, 300));
        let everything = draw(300);
        let first = all.episode(0).unwrap();
        assert_eq!(everything.before(0), &first.observations[0].seen[..]);
        assert_eq!(everything.after(9), &first.observations[10].seen[..]);
    }

    #[test]
    fn without_experience_nothing_is_judged() {
        let nothing = Experience::<Annotated<Vec<f32>>, usize>::new(10);
        let mut rng = Seed(0).stream("judge", 0);
        let judged = Plausibility::default().judge(&nothing, &Plain, 2, &[], &[], &mut rng);
        assert_eq!(judged, Err(LspiError::Nothing));
    }

    #[test]
    fn settings_are_checked() {
        let good = Plausibility::default();
        assert_eq!(good.check(), Ok(()));
        let wrong = [
            Plausibility { batch: 0, ..good.clone() },
            Plausibility { reachable: 1.0, ..good.clone() },
            Plausibility { controllable: 2.0, ..good.clone() },
            Plausibility { lspi: Lspi { gamma: 1.0, ..Lspi::default() }, ..good },
        ];
        for (config, name) in wrong.iter().zip(["batch", "reachable", "controllable", "lspi"]) {
            assert!(config.check().unwrap_err().starts_with(name));
        }
    }
}
