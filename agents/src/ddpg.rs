//! DDPG (Lillicrap 2015): the policy inside every option of chapter 3 (thesis 3.1.1).
//!
//! Learned from clips of one step by y = r + γ(1−d)Q'(s', μ'(s')), where d is a *termination*: truncations
//! and time-outs bootstrap. The authors' actor has batch normalisation, which the thesis does not mention and
//! most later implementations dropped (Fujimoto 2018, CleanRL); ours has none.

use std::sync::Arc;

use inroads_envs::Rng;
use serde::{Deserialize, Serialize};

use crate::nets::{ActorCritic, Backend, Shape, Step};
use crate::noise::NoiseConfig;
use crate::{Bag, Checkpoint, Clip, Context, Corrupt, Encode, Encoder, Learned, Learner, Memory};

/// Settings of [`Ddpg`]. Defaults are those of the authors' code (`authors.md`, section 1), which are the DDPG
/// paper's but for τ (0.001 there); the decay of the critic is the exception.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DdpgConfig {
    /// Widths of the hidden layers of actor and critic; 400 and 300 (authors' code, paper section 7).
    pub hidden: Vec<usize>,
    /// Adam's rate for the actor; 1e-4 (authors' code, paper).
    pub actor_rate: f32,
    /// Adam's rate for the critic; 1e-3 (authors' code, paper).
    pub critic_rate: f32,
    /// γ; 0.99 (authors' code, paper).
    pub discount: f32,
    /// τ of θ' ← τθ + (1−τ)θ'; 0.01 (authors' code).
    pub tau: f32,
    /// Clips an update; 64 (authors' code, paper).
    pub batch: usize,
    /// L2 decay of the critic's parameters, added to the gradient. The authors' code and the paper have 1e-2;
    /// 0 here, because within Adam that flattens values: with it the best action of a bandit r = −(a − 0.3)²
    /// is learned as 0.18, whatever the seed and the size of the network.
    pub critic_decay: f32,
    /// Greatest norm of a network's gradient; 0 is no bound (authors' code and paper have none).
    pub gradient_clip: f32,
    /// Price of the square of what enters the actor's last tanh; 0 (authors' code, paper). Above 0 it keeps an actor
    /// that has seen no reward yet from saturating, where its gradient vanishes and noise is clipped away (HER,
    /// Andrychowicz 2017, appendix A).
    pub preactivation: f32,
    /// Exploration noise.
    pub noise: NoiseConfig,
    /// Exploration noise of a [`fork`](Ddpg::fork): what already knows something explores less.
    pub fork_noise: NoiseConfig,
}

impl Default for DdpgConfig {
    fn default() -> Self {
        Self {
            hidden: vec![400, 300],
            actor_rate: 1e-4,
            critic_rate: 1e-3,
            discount: 0.99,
            tau: 0.01,
            batch: 64,
            critic_decay: 0.0,
            gradient_clip: 0.0,
            preactivation: 0.0,
            noise: NoiseConfig::default(),
            fork_noise: NoiseConfig::default(),
        }
    }
}

impl DdpgConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        if self.hidden.is_empty() || self.hidden.contains(&0) {
            return Err(format!("hidden is {:?}; name at least one layer, and none of width 0", self.hidden));
        }
        if self.batch == 0 {
            return Err("batch is 0; an update needs at least one clip".into());
        }
        for (name, value) in [("actor_rate", self.actor_rate), ("critic_rate", self.critic_rate)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(format!("{name} is {value}; it must be a number above 0"));
            }
        }
        for (name, value) in [("discount", self.discount), ("tau", self.tau)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(format!("{name} is {value}; it must lie in [0, 1]"));
            }
        }
        let prices = [
            ("critic_decay", self.critic_decay),
            ("gradient_clip", self.gradient_clip),
            ("preactivation", self.preactivation),
        ];
        for (name, value) in prices {
            if !(value.is_finite() && value >= 0.0) {
                return Err(format!("{name} is {value}; it must be 0 (none) or a number above"));
            }
        }
        self.noise.check()?;
        self.fork_noise.check()
    }
}

/// A deterministic policy for continuous actions in [−1, 1], learned off-policy.
///
/// A clone has all that was learned, moments of the optimiser and number of updates included, and learns on
/// independently; a new option begins as a [`fork`](Self::fork) of the global one (thesis 3.1.2).
pub struct Ddpg<O> {
    encoder: Arc<dyn Encoder<O> + Send + Sync>,
    goal_width: usize,
    config: DdpgConfig,
    nets: ActorCritic,
    updates: u64,
}

impl<O> Ddpg<O> {
    /// A learner for actions of that many components, with weights drawn from `rng`.
    ///
    /// # Panics
    /// When there is no hidden layer, or one of width 0: see [`DdpgConfig::check`].
    pub fn new(
        encoder: Arc<dyn Encoder<O> + Send + Sync>,
        actions: usize,
        config: &DdpgConfig,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        Self::with_goals(encoder, 0, actions, config, backend, rng)
    }

    /// A learner that reads goals of `goal_width` numbers ([`Encode::width`]) beside the observation.
    ///
    /// # Panics
    /// As [`new`](Self::new).
    pub fn with_goals(
        encoder: Arc<dyn Encoder<O> + Send + Sync>,
        goal_width: usize,
        actions: usize,
        config: &DdpgConfig,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        let shape = Shape { inputs: encoder.width() + goal_width, actions, hidden: &config.hidden };
        let nets = ActorCritic::new(shape, backend, rng);
        Self { encoder, goal_width, nets, config: config.clone(), updates: 0 }
    }

    /// Minibatch updates made so far.
    pub fn updates(&self) -> u64 {
        self.updates
    }

    /// A clone of what was learned that begins its own exploration.
    pub fn fork(&self) -> Self {
        let config = DdpgConfig { noise: self.config.fork_noise, ..self.config.clone() };
        Self { config, updates: 0, ..self.clone() }
    }

    /// Rows of observations, each followed by its goal; zeros for none.
    fn encode<'a, G: Encode + 'a>(
        &self,
        seen: impl ExactSizeIterator<Item = (&'a O, Option<&'a G>)>,
    ) -> Vec<f32>
    where
        O: 'a,
    {
        let width = self.encoder.width();
        let mut rows = vec![0.0; (width + self.goal_width) * seen.len()];
        for (row, (observation, goal)) in rows.chunks_exact_mut(width + self.goal_width).zip(seen) {
            let (row, rest) = row.split_at_mut(width);
            self.encoder.write(observation, row);
            if let Some(goal) = goal {
                goal.write(rest);
            }
        }
        rows
    }
}

/// y = r + γ(1−d)·v, row by row, from r and γ(1−d).
fn targets(returns: impl Iterator<Item = (f32, f32)>, next: &[f32]) -> Vec<f32> {
    returns.zip(next).map(|((reward, discount), value)| reward + discount * value).collect()
}

impl<O, G: Encode> Learner<O, Vec<f32>, G> for Ddpg<O> {
    fn act(&self, memory: &mut Memory, s: &O, goal: Option<&G>, ctx: &mut Context) -> Vec<f32> {
        let mut action = self.nets.act(self.encode(std::iter::once((s, goal))));
        if ctx.explore {
            self.config.noise.perturb(&mut action, memory, self.updates, &mut ctx.acting);
        }
        action
    }

    fn values(&self, _: &Memory, s: &O, goals: &[Option<&G>]) -> Vec<f32> {
        self.nets.values(self.encode(goals.iter().map(|goal| (s, *goal))))
    }

    fn learn(&mut self, clips: &[Clip<O, Vec<f32>, G>], ctx: &mut Context) -> Learned {
        if clips.is_empty() {
            return Learned::default();
        }
        let config = &self.config;
        let before = self.encode(clips.iter().map(|clip| (clip.first(), clip.goal)));
        let after = self.encode(clips.iter().map(|clip| (clip.last(), clip.goal)));
        let actions = clips.iter().flat_map(|clip| &clip.actions[clip.lead]).copied().collect();
        let next = self.nets.target_values(after);
        let targets = targets(clips.iter().map(|clip| clip.discounted(config.discount)), &next);

        let clip = config.gradient_clip;
        let critic = Step { rate: config.critic_rate, decay: config.critic_decay, clip };
        let actor = Step { rate: config.actor_rate, decay: 0.0, clip };
        let (errors, refused) =
            self.nets.learn(before, actions, targets, critic, actor, config.preactivation);
        let learned = Learned::of(errors);
        ctx.check("loss of the critic", learned.loss);
        if let Some(gradient) = refused {
            ctx.check(gradient, f32::NAN);
            return learned;
        }
        self.nets.follow(config.tau);
        self.updates += 1;
        learned
    }

    fn batch(&self) -> usize {
        self.config.batch
    }
}

impl<O> Clone for Ddpg<O> {
    fn clone(&self) -> Self {
        Self {
            encoder: Arc::clone(&self.encoder),
            goal_width: self.goal_width,
            config: self.config.clone(),
            nets: self.nets.clone(),
            updates: self.updates,
        }
    }
}

impl<O> Checkpoint for Ddpg<O> {
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
    use crate::experience::Rewards;
    use inroads_envs::Seed;
    use rand::RngExt;

    struct Row;

    impl Encoder<Vec<f32>> for Row {
        fn width(&self) -> usize {
            2
        }

        fn write(&self, observation: &Vec<f32>, out: &mut [f32]) {
            out.copy_from_slice(observation);
        }
    }

    fn small() -> DdpgConfig {
        DdpgConfig { hidden: vec![32, 24], actor_rate: 1e-3, critic_rate: 3e-3, ..Default::default() }
    }

    fn learner(config: &DdpgConfig) -> Ddpg<Vec<f32>> {
        Ddpg::new(Arc::new(Row), 1, config, Backend::of_tests(), &mut Seed(3).stream("weights", 0))
    }

    fn saved(learner: &Ddpg<Vec<f32>>) -> Bag {
        let mut bag = Bag::default();
        learner.save(&mut bag);
        bag
    }

    /// Update number `index` of a bandit: r = −(a − 0.3)², and the episode terminates.
    fn bandit(learner: &mut Ddpg<Vec<f32>>, index: u64) -> f32 {
        let mut ctx = Context::training(Seed(7), index);
        let observations = [vec![0.2, -0.4], vec![0.1, 0.9]];
        let actions: Vec<[Vec<f32>; 1]> =
            (0..64).map(|_| [vec![ctx.learning.random_range(-1.0..1.0)]]).collect();
        let rewards: Vec<_> = actions.iter().map(|action| [-(action[0][0] - 0.3).powi(2)]).collect();
        let clips: Vec<_> = actions
            .iter()
            .zip(&rewards)
            .map(|(action, reward)| {
                Clip::new(&observations, action, Rewards::Given(reward), None::<&()>, true)
            })
            .collect();
        learner.learn(&clips, &mut ctx).loss
    }

    fn greedy(learner: &Ddpg<Vec<f32>>) -> f32 {
        let mut ctx = Context::evaluation(Seed(0), 0);
        learner.act(&mut Memory::new(), &vec![0.2, -0.4], None::<&()>, &mut ctx)[0]
    }

    #[test]
    fn only_a_termination_cuts_the_target() {
        // The third is a truncation, which a clip does not call terminal.
        let observations = [vec![], vec![]];
        let returns = [false, true, false].map(|terminal| {
            let rewards = Rewards::Given(&[-1.0]);
            let clip = Clip::new(&observations, &[()], rewards, None::<&()>, terminal);
            let _: &Vec<f32> = clip.last();
            clip.discounted(0.99)
        });
        let y = targets(returns.into_iter(), &[1.0, 1.0, 1.0]);
        assert!((y[0] + 0.01).abs() < 1e-6 && y[1] == -1.0 && y[2] == y[0]);
    }

    #[test]
    fn an_update_whose_loss_is_no_number_changes_nothing_and_is_told() {
        let mut rng = Seed(3).stream("weights", 0);
        let mut learner: Ddpg<Vec<f32>> =
            Ddpg::new(Arc::new(Row), 1, &small(), Backend::of_tests(), &mut rng);
        bandit(&mut learner, 0);
        let before = saved(&learner);
        let mut ctx = Context::training(Seed(0), 0);
        let observations = [vec![0.2, -0.4], vec![0.1, 0.9]];
        let rewards = Rewards::Given(&[1e30]);
        learner.learn(&[Clip::new(&observations, &[vec![0.5]], rewards, None::<&()>, true)], &mut ctx);
        let what = "loss of the critic";
        assert_eq!(ctx.fault, Some(crate::Fault::Learning { what, value: f32::INFINITY }));
        assert!(saved(&learner) == before);
    }

    #[test]
    fn a_goal_is_read_beside_the_observation_and_none_is_zeros() {
        struct Bit(f32);
        impl Encode for Bit {
            fn width(&self) -> usize {
                1
            }

            fn write(&self, out: &mut [f32]) {
                out[0] = self.0;
            }
        }
        let mut rng = Seed(3).stream("weights", 0);
        let mut learner: Ddpg<Vec<f32>> =
            Ddpg::with_goals(Arc::new(Row), 1, 1, &small(), Backend::of_tests(), &mut rng);
        // The same step is worth 1 to one goal and nothing to the other.
        let (observations, action, goals) =
            ([vec![0.2, -0.4], vec![0.2, -0.4]], [vec![0.1]], [Bit(1.0), Bit(-1.0)]);
        let clip = |goal: usize| {
            let rewards = Rewards::Given(if goal == 0 { &[1.0] } else { &[0.0] });
            Clip::new(&observations, &action, rewards, Some(&goals[goal]), true)
        };
        let clips: Vec<_> = (0..32).map(|i| clip(i % 2)).collect();
        (0..600).for_each(|i| _ = learner.learn(&clips, &mut Context::training(Seed(0), i)));
        let asked = [Some(&goals[0]), Some(&goals[1])];
        let values = learner.values(&Memory::new(), &observations[0], &asked);
        assert!((values[0] - 1.0).abs() < 0.2 && values[1].abs() < 0.2, "{values:?}");
        let none = learner.values(&Memory::new(), &observations[0], &[None, Some(&Bit(0.0))]);
        assert_eq!(none[0], none[1]);
    }

    #[test]
    fn it_solves_a_bandit() {
        let mut learner = learner(&DdpgConfig { hidden: vec![16, 256], critic_rate: 1e-3, ..small() });
        let first = bandit(&mut learner, 0);
        let last = (1..2000).map(|index| bandit(&mut learner, index)).last().unwrap();
        assert!((greedy(&learner) - 0.3).abs() < 0.05, "{}", greedy(&learner));
        assert!(last < first / 10.0, "{first} {last}");
    }

    #[test]
    fn a_bootstrapped_value_approaches_its_fixed_point() {
        // −1 a step for ever, γ = 0.5: the value is −2 everywhere, and a terminal step's is −1.
        let mut learner = learner(&DdpgConfig { discount: 0.5, tau: 0.05, ..small() });
        let (going, ending) = ([vec![0.2, -0.4], vec![0.2, -0.4]], [vec![-0.9, 0.8], vec![0.2, -0.4]]);
        let actions: Vec<[Vec<f32>; 1]> = (0..64).map(|i| [vec![i as f32 / 32.0 - 1.0]]).collect();
        let clip = |i: usize| {
            let states = if i.is_multiple_of(2) { &going } else { &ending };
            Clip::new(states, &actions[i], Rewards::Given(&[-1.0]), None::<&()>, i % 2 == 1)
        };
        let clips: Vec<_> = (0..64).map(clip).collect();
        let loss =
            (0..1500).map(|i| learner.learn(&clips, &mut Context::training(Seed(0), i)).loss).last().unwrap();
        let values = learner.nets.target_values(vec![0.2, -0.4, -0.9, 0.8]);
        assert!(loss < 1e-3, "{loss}");
        assert!((values[0] + 2.0).abs() < 0.1 && (values[1] + 1.0).abs() < 0.1, "{values:?}");
    }

    #[test]
    fn the_same_seed_gives_the_same_bits_and_a_saved_run_goes_on_as_if_never_stopped() {
        let (mut one, mut two) = (learner(&small()), learner(&small()));
        for index in 0..50 {
            bandit(&mut one, index);
            bandit(&mut two, index);
        }
        assert!(saved(&one) == saved(&two));
        assert_eq!(one.updates(), 50);

        let other_weights = &mut Seed(99).stream("weights", 0);
        let mut resumed = Ddpg::new(Arc::new(Row), 1, &small(), Backend::of_tests(), other_weights);
        assert!(saved(&resumed) != saved(&one));
        resumed.load(&saved(&one)).unwrap();
        for index in 50..60 {
            bandit(&mut one, index);
            bandit(&mut resumed, index);
        }
        assert!(saved(&resumed) == saved(&one));
    }

    #[test]
    fn a_clone_goes_on_from_all_that_was_learned_and_on_its_own() {
        let mut global = learner(&small());
        (0..5).for_each(|index| _ = bandit(&mut global, index));
        let before = saved(&global);
        let mut option = global.clone();
        assert!(saved(&option) == before);
        bandit(&mut option, 5);
        assert!(saved(&global) == before && saved(&option) != before);
    }

    #[test]
    fn a_checkpoint_of_other_sizes_is_refused_and_named() {
        let wide = learner(&DdpgConfig { hidden: vec![48, 24], ..small() });
        let error = learner(&small()).load(&saved(&wide)).unwrap_err().to_string();
        assert!(error.contains("actor") && error.contains("96"), "{error}");
    }

    #[test]
    fn exploring_adds_noise_and_settings_are_checked() {
        let learner = learner(&small());
        let act = |ctx: &mut Context| learner.act(&mut Memory::new(), &vec![0.2, -0.4], None::<&()>, ctx)[0];
        assert!(greedy(&learner).abs() < 0.1, "actions begin near zero");
        assert_ne!(act(&mut Context::training(Seed(0), 0)), greedy(&learner));

        assert_eq!(DdpgConfig::default().check(), Ok(()));
        let wrong = DdpgConfig { hidden: vec![], ..small() }.check().unwrap_err();
        assert!(wrong.contains("hidden"));
        assert!(serde_json::from_str::<DdpgConfig>("{\"taw\": 1}").unwrap_err().to_string().contains("taw"));
    }

    #[cfg(feature = "ndarray")]
    #[test]
    fn both_backends_learn_alike() {
        let weights = || Seed(3).stream("weights", 0);
        let mut flex = Ddpg::new(Arc::new(Row), 1, &small(), Backend::Flex, &mut weights());
        let mut ndarray = Ddpg::new(Arc::new(Row), 1, &small(), Backend::NdArray, &mut weights());
        for index in 0..20 {
            let (a, b) = (bandit(&mut flex, index), bandit(&mut ndarray, index));
            assert!((a - b).abs() < 1e-4 * (1.0 + a.abs()), "update {index}: {a} {b}");
        }
        assert!((greedy(&flex) - greedy(&ndarray)).abs() < 1e-3);
    }
}
