use super::*;
use crate::dqn::Epsilon;
use crate::experience::{Pay, Rewards};
use crate::{Bag, Checkpoint};
use inroads_envs::Seed;

/// Two numbers as they are.
struct Row;

impl Encoder<Vec<f32>> for Row {
    fn width(&self) -> usize {
        2
    }

    fn write(&self, s: &Vec<f32>, out: &mut [f32]) {
        out.copy_from_slice(s);
    }
}

/// A goal of one number.
struct Number(f32);

impl Encode for Number {
    fn width(&self) -> usize {
        1
    }

    fn write(&self, out: &mut [f32]) {
        out[0] = self.0;
    }
}

type Learns = R2d2<Vec<f32>>;

fn small() -> R2d2Config {
    R2d2Config {
        torso: crate::nets::TorsoConfig { hidden: vec![16], ..Default::default() },
        memory: 16,
        head: 16,
        rate: 5e-3,
        adam_epsilon: 1e-8,
        discount: 0.9,
        returns: 2,
        batch: 4,
        follow_every: 20,
        epsilon: Epsilon { start: 0.3, end: 0.3, ..Default::default() },
        ..Default::default()
    }
}

fn learner(config: &R2d2Config) -> Learns {
    let rng = &mut Seed(5).stream("weights", 0);
    R2d2::with_goals(Arc::new(Row), 1, 3, config, Backend::of_tests(), rng)
}

/// Observations of a walk that looks like no other.
fn walk(which: u64, steps: usize) -> Vec<Vec<f32>> {
    let mut rng = Seed(which).stream("walk", 0);
    (0..=steps).map(|_| (0..2).map(|_| rng.random_range(-1.0..1.0)).collect()).collect()
}

fn choices(which: u64, steps: usize) -> Vec<usize> {
    let mut rng = Seed(which).stream("choices", 0);
    (0..steps).map(|_| rng.random_range(0..3)).collect()
}

type Seq<'a> = Clip<'a, Vec<f32>, usize, Number>;

fn saved(learner: &Learns) -> Bag {
    let mut bag = Bag::default();
    learner.save(&mut bag);
    bag
}

fn ctx() -> Context {
    Context::training(Seed(0), 0)
}

/// What a learner without noise remembers after it has seen these states and made these choices.
fn remembers(learner: &Learns, seen: &[Vec<f32>], made: &[usize], goal: f32) -> Memory {
    let mut memory = Memory::new();
    let ctx = &mut Context::evaluation(Seed(0), 0);
    for (s, choice) in seen.iter().zip(made) {
        learner.act(&mut memory, s, Some(&Number(goal)), ctx);
        // Somebody else chose.
        memory[32] = *choice as f32;
    }
    memory
}

/// Some updates on three walks of different lengths, one of them led in.
fn practise(learner: &mut Learns, updates: u64) {
    let (seen, made) = ([walk(1, 6), walk(2, 3), walk(3, 5)], [choices(1, 6), choices(2, 3), choices(3, 5)]);
    let pay = Rewards::Subgoal(Pay::ATTAINMENT, true);
    let goals = [Number(1.0), Number(-1.0)];
    let clips = [
        Seq { memory: &[0.1; 34], weight: 0.5, ..Clip::new(&seen[0], &made[0], pay, Some(&goals[0]), true) },
        Seq { lead: 1, ..Clip::new(&seen[1], &made[1], pay, None, false) },
        Clip::new(&seen[2], &made[2], Rewards::Given(&[0.5, 0.0, -1.0, 0.0, 0.25]), Some(&goals[1]), false),
    ];
    (0..updates).for_each(|_| _ = learner.learn(&clips, &mut ctx()));
}

fn near(a: &[f32], b: &[f32]) {
    assert_eq!(a.len(), b.len());
    for (x, y) in a.iter().zip(b) {
        assert!((x - y).abs() < 1e-5, "{x} {y}");
    }
}

#[test]
fn a_memory_goes_on_from_where_it_was_noted() {
    let learner = learner(&small());
    let (seen, made) = (walk(1, 40), choices(1, 40));
    let whole = remembers(&learner, &seen[..40], &made, 0.0);
    let mut half = remembers(&learner, &seen[..20], &made, 0.0);
    for (s, choice) in seen[20..40].iter().zip(&made[20..]) {
        learner.act(&mut half, s, None::<&Number>, &mut ctx());
        half[32] = *choice as f32;
    }
    assert_eq!(half, whole);
    // And one pass over the sequence, as in learning, comes to the same.
    let clip = Seq { lead: 40, ..Clip::new(&seen, &made, Rewards::Given(&[]), None, false) };
    let [led, _] = learner.starts(&[clip]);
    near(&led.hidden, &whole[..16]);
    near(&led.cell, &whole[16..32]);
}

#[test]
fn a_memory_knows_nothing_of_the_goal() {
    let learner = learner(&small());
    let (seen, made) = (walk(1, 9), choices(1, 9));
    let [one, other] = [1.0, -1.0].map(|goal| remembers(&learner, &seen, &made, goal));
    assert_eq!(one, other);
    let [one, other] = [1.0, -1.0].map(|goal| learner.values(&one, &seen[9], &[Some(&Number(goal))]));
    assert_ne!(one, other, "but the values do");
}

#[test]
fn what_leads_in_has_neither_loss_nor_gradient() {
    let (seen, made) = (walk(4, 7), choices(4, 7));
    let pay = Rewards::Given(&[0.0, 1.0, -1.0, 0.5]);
    // Until the target is copied, network and target are alike, and what one noted the other would have.
    let mut led = learner(&small());
    let mut noted = led.clone();
    let memory = remembers(&led, &seen[..3], &made[..3], 0.0);
    let clip = Seq { lead: 3, ..Clip::new(&seen, &made, pay, None, false) };
    let of_led = led.learn(&[clip], &mut ctx());
    let rest = Seq {
        memory: &memory,
        previous: Some(&made[2]),
        ..Clip::new(&seen[3..], &made[3..], pay, None, false)
    };
    let of_noted = noted.learn(&[rest], &mut ctx());
    near(&[of_led.loss, of_led.errors[0]], &[of_noted.loss, of_noted.errors[0]]);
    // The first step of Adam is its rate in the direction of each derivative's sign: any more of a gradient would show.
    let values = |learner: &Learns| learner.values(&Memory::new(), &seen[0], &[None, Some(&Number(1.0))]);
    near(&values(&led), &values(&noted));
    // Without either, it is another matter.
    let mut neither = learner(&small());
    let start = neither.learn(&[Seq::new(&seen[3..], &made[3..], pay, None, false)], &mut ctx());
    assert!((start.loss - of_led.loss).abs() > 1e-4);
}

#[test]
fn longer_neighbours_change_neither_loss_nor_priority() {
    let learner = learner(&small());
    let (seen, made) = (walk(1, 14), choices(1, 14));
    let (rewards, paid) = ([0.3, 0.0, 1.0, -0.5], [0.0; 14]);
    let short = || Seq::new(&seen[..5], &made[..4], Rewards::Given(&rewards), None, true);
    let alone = learner.clone().learn(&[short()], &mut ctx());
    // Ten steps more, of no weight.
    let long = Seq { weight: 0.0, ..Clip::new(&seen, &made, Rewards::Given(&paid), None, false) };
    let beside = learner.clone().learn(&[short(), long], &mut ctx());
    near(&[beside.errors[0], 2.0 * beside.loss], &[alone.errors[0], alone.loss]);
}

#[test]
fn the_loss_is_summed_over_steps_and_averaged_over_sequences_by_weight() {
    let learner = learner(&small());
    let (seen, made) = (walk(1, 3), choices(1, 3));
    let clip =
        |weight| Seq { weight, ..Clip::new(&seen, &made, Rewards::Given(&[1.0, 2.0, 3.0]), None, true) };
    // At first all values are near 0, and so are bootstrapped ones.
    let one = learner.clone().learn(&[clip(1.0)], &mut ctx());
    let y = [1.0 + 0.9 * 2.0, 2.0 + 0.9 * 3.0, 3.0];
    let expected = y.iter().map(|y| 0.5 * y * y).sum::<f32>();
    assert!((one.loss - expected).abs() < 0.2, "{} {expected}", one.loss);
    assert!((one.errors[0] - (0.9 * 4.7 + 0.1 * 3.5)).abs() < 0.1, "{}", one.errors[0]);
    let two = learner.clone().learn(&[clip(1.0), clip(0.5)], &mut ctx());
    assert!((two.loss - 0.75 * one.loss).abs() < 1e-4);
}

#[test]
fn random_choices_are_remembered_and_the_cell_goes_on() {
    let learner = learner(&small());
    let (mut exploring, mut greedy) = (Memory::new(), Memory::new());
    let seen = walk(1, 0);
    let mut made = [0; 3];
    for index in 0..300 {
        let ctx = &mut Context::training(Seed(0), index);
        exploring.clear();
        let choice = learner.act(&mut exploring, &seen[0], None::<&Number>, ctx);
        assert_eq!(exploring[32] as usize, choice);
        made[choice] += 1;
        greedy.clear();
        learner.act(&mut greedy, &seen[0], None::<&Number>, &mut Context::evaluation(Seed(0), index));
        assert_eq!(exploring[..32], greedy[..32]);
    }
    made.sort_unstable();
    // ε is 0.3: each of the others in a tenth of all episodes.
    assert!(made[0] > 15 && made[1] < 50 && made[2] > 220, "{made:?}");
}

#[test]
fn an_episode_keeps_its_rung() {
    let learner = learner(&R2d2Config { rungs: 4, ..small() });
    let seen = walk(1, 5);
    let mut drawn = [0; 4];
    for index in 0..100 {
        let (mut memory, ctx) = (Memory::new(), &mut Context::training(Seed(0), index));
        let rungs: Vec<_> = seen
            .iter()
            .map(|s| {
                learner.act(&mut memory, s, None::<&Number>, ctx);
                memory[33] as usize
            })
            .collect();
        assert!(rungs.iter().all(|rung| *rung == rungs[0]));
        drawn[rungs[0]] += 1;
    }
    assert!(drawn.iter().all(|n| *n > 10), "{drawn:?}");
}

#[test]
fn lanes_are_as_each_alone_and_all_goals_as_one_at_a_time() {
    let mut learner = learner(&small());
    practise(&mut learner, 3);
    let goals: [Option<Number>; 3] = [None, Some(Number(1.0)), Some(Number(-0.5))];
    let seen = walk(9, 2);
    let mut memories = [Memory::new(), remembers(&learner, &walk(1, 4), &choices(1, 4), 0.0), Memory::new()];
    let mut alone = memories.clone();
    let mut contexts = [0, 1, 2].map(|index| Context::training(Seed(1), index));
    let single: Vec<usize> = (0..3)
        .map(|i| {
            let ctx = &mut Context::training(Seed(1), i as u64);
            learner.act(&mut alone[i], &seen[i], goals[i].as_ref(), ctx)
        })
        .collect();
    let mut lanes: Vec<_> = memories
        .iter_mut()
        .zip(&mut contexts)
        .enumerate()
        .map(|(i, (memory, ctx))| Lane { memory, s: &seen[i], goal: goals[i].as_ref(), ctx })
        .collect();
    assert_eq!(learner.act_all(&mut lanes), single);
    memories.iter().zip(&alone).for_each(|(a, b)| near(a, b));

    let wanted = goals.each_ref().map(Option::as_ref);
    let all = learner.values(&memories[1], &seen[0], &wanted);
    let each: Vec<f32> =
        wanted.iter().flat_map(|goal| learner.values(&memories[1], &seen[0], &[*goal])).collect();
    near(&all, &each);
    assert!(all[0] != all[1] && all[1] != all[2]);
    let before = memories[1].clone();
    near(&memories[1], &before);
}

#[test]
fn without_goals_every_goal_is_the_task() {
    let rng = &mut Seed(5).stream("weights", 0);
    let learner: Learns = R2d2::new(Arc::new(Row), 3, &small(), Backend::of_tests(), rng);
    let values = learner.values(&Memory::new(), &walk(1, 0)[0], &[None::<&()>, Some(&())]);
    assert!(values.len() == 2 && values[0] == values[1]);
}

#[test]
fn a_resumed_learner_goes_on_to_the_same_bits() {
    let mut one = learner(&small());
    practise(&mut one, 25);
    let mut resumed = learner(&R2d2Config { rate: 5e-3, ..small() });
    resumed.load(&saved(&one)).unwrap();
    assert_eq!(resumed.updates(), 25);
    assert!(saved(&resumed) == saved(&one));
    practise(&mut one, 20);
    practise(&mut resumed, 20);
    assert!(saved(&resumed) == saved(&one), "the target was copied at 40 in both");
    let mut other = learner(&R2d2Config { memory: 8, ..small() });
    assert!(other.load(&saved(&one)).unwrap_err().to_string().contains("online"));
}

/// One of two cues, three blank steps, a choice that is paid when it is the cue's: every cue with every choice.
struct Recall {
    seen: [Vec<Vec<f32>>; 2],
}

impl Recall {
    fn new() -> Self {
        let blank = [vec![0.0, 0.0], vec![0.0, 0.0], vec![0.0, 0.0], vec![0.0, 1.0], vec![0.0, 0.0]];
        Self { seen: [-1.0, 1.0].map(|cue| [vec![vec![cue, 0.0]], blank.to_vec()].concat()) }
    }

    /// The value of each choice at the end, for either cue, as it is after 400 updates on all eight episodes.
    fn learned(&self, steps: impl Fn(usize) -> std::ops::Range<usize>) -> [Vec<f32>; 2] {
        let rng = &mut Seed(5).stream("weights", 0);
        let config = R2d2Config { returns: 1, ..small() };
        let mut learner: Learns = R2d2::new(Arc::new(Row), 2, &config, Backend::of_tests(), rng);
        let episodes: Vec<(usize, [usize; 5], [f32; 5])> = (0..16)
            .map(|i| {
                // Choices on the way say nothing of the cue.
                let (cue, last) = (i & 1, i >> 1 & 1);
                let made = [i >> 2 & 1, i >> 3 & 1, cue ^ last ^ (i >> 2 & 1), i >> 3 & 1, last];
                (cue, made, [0.0, 0.0, 0.0, 0.0, if cue == last { 1.0 } else { 0.0 }])
            })
            .collect();
        for _ in 0..400 {
            let clips: Vec<Clip<Vec<f32>, usize, ()>> = episodes
                .iter()
                .enumerate()
                .map(|(i, (cue, made, paid))| {
                    let of = steps(i);
                    let seen = &self.seen[*cue][of.start..=of.end];
                    Clip::new(seen, &made[of.clone()], Rewards::Given(&paid[of.clone()]), None, of.end == 5)
                })
                .collect();
            learner.learn(&clips, &mut ctx());
        }
        [0, 1].map(|cue| {
            let from = steps(0).start;
            let (mut memory, end) = (Memory::new(), &self.seen[cue][4]);
            let ctx = &mut Context::evaluation(Seed(0), 0);
            for s in &self.seen[cue][from..4] {
                learner.act(&mut memory, s, None::<&()>, ctx);
                memory[32] = 0.0;
            }
            let state = learner.state(std::iter::once(&memory[..]));
            let previous = Remembered::read(&memory, 16).map(|found| found.choice);
            let state = learner.nets.step(end.clone(), &[previous], state);
            learner.nets.values(state.hidden, 16, Vec::new())
        })
    }
}

#[test]
fn who_remembers_recalls_and_who_does_not_is_at_chance() {
    let recall = Recall::new();
    let [left, right] = recall.learned(|_| 0..5);
    assert!((left[0] - 1.0).abs() < 0.1 && left[1].abs() < 0.1, "{left:?}");
    assert!((right[1] - 1.0).abs() < 0.1 && right[0].abs() < 0.1, "{right:?}");
    // The last step alone.
    for values in recall.learned(|_| 4..5) {
        assert!(values.iter().all(|value| (value - 0.5).abs() < 0.05), "{values:?}");
    }
}

#[test]
fn impossible_settings_are_named() {
    assert_eq!(R2d2Config::default().check(), Ok(()));
    let wrong = |config: R2d2Config| config.check().unwrap_err();
    assert!(wrong(R2d2Config { memory: 0, ..small() }).contains("memory"));
    assert!(wrong(R2d2Config { returns: 0, ..small() }).contains("returns"));
    assert!(wrong(R2d2Config { discount: 1.5, ..small() }).contains("discount"));
    let epsilon = Epsilon { end: -1.0, ..Default::default() };
    assert!(wrong(R2d2Config { epsilon, ..small() }).contains("epsilon: end"));
}
