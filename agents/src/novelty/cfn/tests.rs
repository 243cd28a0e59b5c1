//! What `algorithms.md` 4.2 and 14 (CFN) ask, with their numbers.

use inroads_envs::{Frame, Seed, Space};

use super::*;
use crate::encode::{Encoder, Patches};
use crate::{Curious, Experience, Learner, Practice, Replay, Transition};

/// A state of 64 (or 128) by its number.
struct Numbered(usize);

impl Encoder<usize> for Numbered {
    fn width(&self) -> usize {
        self.0
    }

    fn write(&self, state: &usize, out: &mut [f32]) {
        out.fill(0.0);
        out[*state] = 1.0;
    }
}

/// The network of `algorithms.md` 4.2: 64-128-20, Adam 1e-3, batch 256, which learns when it is told.
fn config() -> CfnConfig {
    CfnConfig {
        torso: TorsoConfig { hidden: vec![128], ..TorsoConfig::default() },
        batch: 256,
        updates_per_visit: 0.0,
        warm_up: 0,
        ..CfnConfig::default()
    }
}

fn cfn(states: usize, config: &CfnConfig, seed: u64) -> Cfn<usize> {
    Cfn::new(Arc::new(Numbered(states)), config, Backend::of_tests(), &mut Seed(seed).stream("weights", 0))
}

/// How often state number `i` is visited.
fn visits(state: usize) -> usize {
    [1, 4, 16, 64, 256][state % 5]
}

/// 64 states visited so often, and the novelty that saw it.
fn visited(config: &CfnConfig, states: usize, seed: u64) -> (Cfn<usize>, Vec<usize>) {
    let mut cfn = cfn(states, config, seed);
    let all: Vec<usize> = (0..64).flat_map(|state| vec![state; visits(state)]).collect();
    let mut ctx = Context::training(Seed(seed), 0);
    for step in 0..all.len() as u32 {
        cfn.visit((0, step), &all, &mut ctx);
    }
    cfn.watch(&all);
    (cfn, all)
}

fn bonuses(cfn: &Cfn<usize>, states: std::ops::Range<usize>) -> Vec<f32> {
    let states: Vec<_> = states.collect();
    cfn.bonuses(&states.iter().collect::<Vec<_>>())
}

fn mean(values: &[f32]) -> f32 {
    values.iter().sum::<f32>() / values.len() as f32
}

fn correlation(x: &[f32], y: &[f32]) -> f32 {
    let (mx, my) = (mean(x), mean(y));
    let sum = |f: &dyn Fn(f32, f32) -> f32| x.iter().zip(y).map(|(a, b)| f(a - mx, b - my)).sum::<f32>();
    sum(&|a, b| a * b) / (sum(&|a, _| a * a) * sum(&|_, b| b * b)).sqrt()
}

#[test]
fn the_mean_of_coins_squares_to_one_over_n() {
    // The best that a network can say: its mean square is 1/N, with a deviation of √(2(N−1)/(dN³)).
    let mut rng = Seed(1).stream("coins", 0);
    let (n, d, trials) = (10, 20, 20_000);
    let shares: Vec<f64> = (0..trials)
        .map(|_| {
            let flips: Vec<u32> = (0..n).map(|_| rng.random()).collect();
            let square = |coin| {
                (flips.iter().map(|coins| f64::from(side(*coins, coin))).sum::<f64>() / f64::from(n)).powi(2)
            };
            (0..d).map(square).sum::<f64>() / d as f64
        })
        .collect();
    let mean = shares.iter().sum::<f64>() / f64::from(trials);
    let deviation = (shares.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / f64::from(trials)).sqrt();
    assert!((mean - 0.1).abs() < 0.001, "{mean}");
    assert!((deviation - 0.030).abs() < 0.001, "{deviation}");
}

#[test]
fn it_learns_one_over_the_root_of_n() {
    let (mut cfn, all) = visited(&config(), 64, 0);
    let mut ctx = Context::training(Seed(0), 1);
    (0..1000).for_each(|_| cfn.learn(&all, &mut ctx));
    let truth: Vec<f32> = (0..64).map(|state| (visits(state) as f32).sqrt().recip()).collect();
    let found = bonuses(&cfn, 0..64);
    let correlation = correlation(&found, &truth);
    let error = mean(&found.iter().zip(&truth).map(|(x, y)| (x - y).abs()).collect::<Vec<_>>());
    assert!(correlation > 0.99, "{correlation}");
    assert!(error < 0.03, "{error}");
}

#[test]
fn flipping_coins_again_when_they_are_drawn_makes_everything_known() {
    let (mut cfn, all) = visited(&config(), 64, 0);
    let mut ctx = Context::training(Seed(0), 1);
    for _ in 0..1000 {
        cfn.visits.flip_again(&mut ctx.learning);
        cfn.learn(&all, &mut ctx);
    }
    let found = mean(&bonuses(&cfn, 0..64));
    // What is left is the noise of the last steps.
    assert!(found < 0.15, "the mean of 1/√N is 0.39; this is {found}");
}

#[test]
fn what_was_never_seen_is_new_only_with_a_prior() {
    for (prior, range) in [(true, 0.8..1.3), (false, 0.0..0.3)] {
        let (cfn, _) = visited(&CfnConfig { prior, ..config() }, 128, 3);
        let unseen = mean(&bonuses(&cfn, 64..128));
        assert!(range.contains(&unseen), "{prior}: {unseen}");
    }
}

/// Learns nothing, and notes what steps pay.
#[derive(Clone, Default)]
struct Paid(std::rc::Rc<std::cell::RefCell<Vec<(u32, f32)>>>);

checkpoint!([] Paid; plain: ; parts: );

impl Learner<usize, usize, ()> for Paid {
    fn act(&self, _: &mut crate::Memory, _: &usize, _: Option<&()>, _: &mut Context) -> usize {
        0
    }

    fn values(&self, _: &crate::Memory, _: &usize, _: &[Option<&()>]) -> Vec<f32> {
        Vec::new()
    }

    fn learn(&mut self, clips: &[crate::Clip<usize, usize, ()>], _: &mut Context) -> crate::Learned {
        self.0.borrow_mut().extend(clips.iter().map(|clip| (clip.at.1, clip.reward(0))));
        crate::Learned::default()
    }

    fn batch(&self) -> usize {
        3
    }
}

#[test]
fn a_step_that_terminates_has_no_bonus() {
    let paid = Paid::default();
    let practice = Practice::new(Replay::new(10), Pace { updates_per_step: 9.0, warm_up: 3 });
    let mut curious =
        Curious::new(paid.clone(), practice).with_novelty(Box::new(cfn(64, &config(), 0)), 0.01);
    let (mut all, mut ctx) = (Experience::new(10), Context::training(Seed(0), 0));
    let number = all.begin(&0);
    for step in 0..3_usize {
        let end = (step == 2).then_some(inroads_envs::End::Terminated);
        all.push(&Transition { before: &step, action: &0, reward: 5.0, after: &(step + 1), end });
        curious.step(number, &all, &mut ctx);
    }
    let paid = paid.0.borrow();
    assert!(paid.iter().any(|(step, _)| *step == 2) && paid.iter().any(|(step, _)| *step < 2));
    for (step, reward) in paid.iter() {
        assert_eq!(*reward == 5.0, *step == 2, "step {step} pays {reward}");
    }
}

/// Learns on as visits come, one update every second of them, for so many episodes.
fn live(cfn: &mut Cfn<usize>, all: &mut Experience<usize, usize>, episodes: std::ops::Range<u64>) {
    for episode in episodes {
        let mut ctx = Context::training(Seed(5), episode);
        let number = all.begin(&(episode as usize % 64));
        cfn.visit((number, 0), all, &mut ctx);
        for step in 1..20 {
            let s = (episode as usize * 7 + step) % 64;
            all.push(&Transition { before: &0, action: &0, reward: 0.0, after: &s, end: None });
            cfn.visit((number, step as u32), all, &mut ctx);
        }
    }
}

#[test]
fn a_restored_one_goes_on_to_the_same_bits_and_forgets_with_the_experience() {
    let config = CfnConfig { updates_per_visit: 0.5, warm_up: 30, batch: 16, ..config() };
    let (mut one, mut all) = (cfn(64, &config, 1), Experience::new(100));
    live(&mut one, &mut all, 0..12);
    assert_eq!(one.updates(), 106, "one every second visit from the 30th on");
    assert!(one.visits.len() <= 140, "{} visits of forgotten episodes are kept", one.visits.len());
    let mut bag = Bag::default();
    one.save(&mut bag);
    let mut restored = cfn(64, &config, 2);
    restored.load(&bag).unwrap();
    let mut other = all.clone();
    live(&mut one, &mut all, 12..16);
    live(&mut restored, &mut other, 12..16);
    let bags = [&one, &restored].map(|cfn| {
        let mut bag = Bag::default();
        cfn.save(&mut bag);
        bag
    });
    assert!(bags[0] == bags[1]);
    let bits = |cfn: &Cfn<usize>| bonuses(cfn, 0..64).iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&one), bits(&restored));
    assert_eq!(bits(&one), bits(&one.clone()));
}

#[test]
fn frames_that_were_often_seen_become_known() {
    // Four pictures of one white square each, of which two are seen, the first far more often.
    let frame = |place: usize| {
        let mut frame = Frame::new([8, 8], 1);
        for y in 0..4 {
            let from = (place / 2 * 4 + y) * 8 + place % 2 * 4;
            frame.bytes_mut()[from..from + 4].fill(255);
        }
        frame
    };
    let patches = Patches::new(&Space::Frame { width: 8, height: 8, channels: 1 }, 4).unwrap();
    let torso = TorsoConfig { embedding: 8, merges: vec![16], hidden: vec![32], ..Default::default() };
    let config = CfnConfig { torso, warm_up: 50, batch: 32, rate: 3e-3, ..CfnConfig::default() };
    let mut cfn =
        Cfn::new(Arc::new(patches), &config, Backend::of_tests(), &mut Seed(0).stream("weights", 0));
    let all: Vec<Frame> = (0..300).map(|i| frame(usize::from(i % 75 == 0))).collect();
    let mut ctx = Context::training(Seed(0), 0);
    (0..all.len() as u32).for_each(|step| cfn.visit((0, step), &all, &mut ctx));
    let found: Vec<f32> = (0..4).map(|place| cfn.bonus(&frame(place))).collect();
    assert!(found[0] < 0.15, "seen 296 times: {found:?}");
    assert!(found[1] > 2.0 * found[0], "seen 4 times: {found:?}");
}

#[test]
fn settings_that_make_no_novelty_are_named() {
    assert_eq!(CfnConfig::default().check(), Ok(()));
    let wrong = |config: CfnConfig| config.check().unwrap_err();
    assert!(wrong(CfnConfig { coins: 33, ..config() }).contains("coins"));
    assert!(wrong(CfnConfig { batch: 0, ..config() }).contains("batch"));
    assert!(wrong(CfnConfig { rate: f32::NAN, ..config() }).contains("rate"));
    assert!(wrong(CfnConfig { updates_per_visit: -1.0, ..config() }).contains("updates_per_visit"));
}
