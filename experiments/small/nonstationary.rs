//! Figure 5.2: an option that becomes competent only by being executed, and who finds out.
//!
//! ```text
//! s1 ──a──► s2 ──a──► s3 (reward 1, the end)        s1 ──o──► s3 with probability p(n), else s1
//! ```
//!
//! The thesis says that p rises with the number n of executions of o, and no more; here p(n) = min(1, n/100). Inside the
//! option there is a right and a wrong action, and its policy takes the right one with probability p(n).
//!
//! Three questions. Who learns of the competence first, when the option is executed whatever anybody thinks of it? Whose
//! option becomes competent at all, when it is executed only from inside its set? And what does Q-learning do with it?

use std::sync::Arc;

use inroads::agents::classify::{Odds, OddsConfig};
use inroads::agents::draw::argmax;
use inroads::agents::encode::Select;
use inroads::agents::evaluate::{Table, TableConfig};
use inroads::agents::experience::Aim;
use inroads::agents::{Context, Experience, Lesson, Transition};
use inroads::discovery::initiation::{Bonus, IvfConfig, WeightedConfig, Weights};
use inroads::discovery::{Initiation, Ivf, SkillId, Weighted};
use inroads::envs::{Rng, Seed};
use inroads::figures::{Panel, Series, Summary, curves};
use inroads::statistics::{Estimate, Verdict, mean_interval, superiority, wilson};
use rand::RngExt;
use serde::Serialize;

use crate::Options;
use crate::support::{Done, over_seeds, write};

/// Executions that make the option competent.
const COMPETENT: u32 = 100;
/// Rounds in which the option may be executed.
const ROUNDS: usize = 400;
/// Episodes of Q-learning.
const EPISODES: usize = 4000;
const SKILL: SkillId = SkillId(1);

/// p(n).
fn competence(executions: u32) -> f32 {
    (executions as f32 / COMPETENT as f32).min(1.0)
}

type Family = Box<dyn Initiation<Vec<f32>, usize>>;

/// Ways to learn the set, by name.
const WAYS: [(&str, Option<Weights>, Bonus); 6] = [
    ("binary", Some(Weights::Equal), Bonus::None),
    ("weighted", Some(Weights::Value), Bonus::None),
    ("IVF", None, Bonus::None),
    ("weighted, prior", Some(Weights::Prior), Bonus::None),
    ("weighted + progress", Some(Weights::Value), Bonus::Progress),
    ("IVF + progress", None, Bonus::Progress),
];

/// c of the count bonuses that the first three are given in turn.
const DOSES: [f32; 7] = [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0];

fn family(weights: Option<Weights>, bonus: Bonus, gestation: u32) -> Family {
    let table = Table::new(2, &TableConfig { rate: 0.05, batch: 8, period: 20, ..TableConfig::default() });
    let config = IvfConfig { bonus, gestation, ..IvfConfig::default() };
    let ivf = Ivf::<Vec<f32>, usize, Table>::new(&config, table, |_| ());
    let Some(weights) = weights else { return Box::new(ivf) };
    let odds = Odds::new(&OddsConfig { radius: 0.5, balance: false });
    let config = WeightedConfig { weights, ..WeightedConfig::default() };
    Box::new(Weighted::new(&config, ivf, Arc::new(Select::new(&[0])), odds))
}

/// Of each round whether s1 is in the set before it, and the option's competence.
fn rounds(mut sets: Family, gated: bool, seed: u64) -> Vec<(bool, f32)> {
    let mut all = Experience::new(10_000);
    let mut ctx = Context::training(Seed(seed), 0);
    let (s1, s3) = (vec![1.0], vec![3.0]);
    let mut executions = 0;
    sets.born(SKILL, &[]);
    (0..ROUNDS)
        .map(|_| {
            let (inside, p) = (sets.contains(SKILL, &s1), competence(executions));
            if inside || !gated {
                let success = ctx.acting.random::<f32>() < p;
                let (action, after) = (usize::from(success), if success { &s3 } else { &s1 });
                all.begin(&s1);
                all.push(&Transition { before: &s1, action: &action, reward: 0.0, after, end: None });
                executions += 1;
                let p = competence(executions);
                let aim = Aim::Subgoal { attained: success };
                let episode = all.latest();
                sets.outcome(SKILL, std::slice::from_ref(&s1), success);
                sets.lesson(SKILL, &Lesson { episode, steps: 0..1, aim, goal: None, rewards: None });
                let policy = |_, _: &Vec<f32>, ctx: &mut Context| usize::from(ctx.acting.random::<f32>() < p);
                sets.learn(SKILL, &all, &policy, &mut ctx);
            }
            (inside, p)
        })
        .collect()
}

/// Rounds from the one where the option succeeds more often than not to the one from which on its state is inside.
fn lag(rounds: &[(bool, f32)]) -> f64 {
    let better = rounds.iter().position(|(_, p)| *p > 0.5).unwrap_or(rounds.len());
    let inside = rounds.iter().rposition(|(inside, _)| !inside).map_or(0, |last| last + 1);
    inside as f64 - better as f64
}

/// How Q-learning chooses at s1.
#[derive(Clone, Copy, Debug)]
enum Explore {
    Epsilon(f32),
    /// c/√N(s1, ·) is added.
    Counts(f32),
    /// |Q − Q as it was 50 episodes ago| is added.
    Progress,
}

const LEARNERS: [(&str, Explore); 6] = [
    ("greedy", Explore::Epsilon(0.0)),
    ("ε = 0.01", Explore::Epsilon(0.01)),
    ("ε = 0.1", Explore::Epsilon(0.1)),
    ("greedy + counts, c = 1", Explore::Counts(1.0)),
    ("greedy + counts, c = 4", Explore::Counts(4.0)),
    ("greedy + progress", Explore::Progress),
];

/// Q-learning (γ = 0.9, step size 0.1, ties at random) in the three states; of each episode whether the greedy choice
/// at s1 is o, and the option's competence.
fn q_learning(explore: Explore, rng: &mut Rng) -> Vec<(bool, f32)> {
    const GAMMA: f32 = 0.9;
    const RATE: f32 = 0.1;
    // Q(s1, a), Q(s1, o); s2 has but one action.
    let (mut q, mut second, mut counts, mut before) = ([0.0_f32; 2], 0.0_f32, [0_u32; 2], [0.0_f32; 2]);
    let mut story = Vec::with_capacity(EPISODES);
    for episode in 0..EPISODES {
        if episode % 50 == 0 {
            before = q;
        }
        loop {
            let bonus = |i: usize| match explore {
                Explore::Epsilon(_) => 0.0,
                Explore::Counts(c) => c / (counts[i].max(1) as f32).sqrt(),
                Explore::Progress => (q[i] - before[i]).abs(),
            };
            let random = matches!(explore, Explore::Epsilon(e) if rng.random::<f32>() < e);
            let choice = match random {
                true => rng.random_range(0..2),
                false => argmax(&[q[0] + bonus(0), q[1] + bonus(1)], rng),
            };
            let p = competence(counts[1]);
            counts[choice] += 1;
            let greatest = q[0].max(q[1]);
            let (target, over) = match choice {
                0 => (GAMMA * second, true),
                _ if rng.random::<f32>() < p => (1.0, true),
                _ => (GAMMA * greatest, false),
            };
            q[choice] += RATE * (target - q[choice]);
            if choice == 0 {
                second += RATE * (1.0 - second);
            }
            if over {
                break;
            }
        }
        story.push((q[1] > q[0], competence(counts[1])));
    }
    story
}

#[derive(Serialize)]
struct Row {
    name: &'static str,
    /// Rounds by which the set is late, when the option is always executed.
    lag: Estimate,
    /// Competence at the end, when it is executed only from inside.
    competence: Estimate,
    /// Share of seeds whose set holds s1 at the end.
    kept: Estimate,
}

#[derive(Serialize)]
struct Learner {
    name: &'static str,
    /// Share of seeds that prefer o at the end.
    prefers: Estimate,
    competence: Estimate,
}

#[derive(Serialize)]
struct Report {
    seeds: u64,
    sets: Vec<Row>,
    /// Mean competence at the end by c of a count bonus, when the option is executed only from inside.
    doses: Vec<(&'static str, Vec<(f32, f32)>)>,
    q_learning: Vec<Learner>,
    claims: Vec<(String, Estimate, Verdict)>,
}

fn share(hits: impl Iterator<Item = bool>) -> Estimate {
    let (hits, all) = hits.fold((0, 0), |(hits, all), hit| (hits + u64::from(hit), all + 1));
    wilson(hits, all)
}

/// The story of every seed as points of a curve.
fn points(stories: &[Vec<(bool, f32)>], of: impl Fn(&(bool, f32)) -> f64) -> Vec<Vec<(f64, f64)>> {
    let run = |story: &Vec<(bool, f32)>| story.iter().enumerate().map(|(i, at)| (i as f64, of(at))).collect();
    stories.iter().map(run).collect()
}

fn panel(title: &str, x_label: &str, y_label: &str) -> Panel {
    Panel {
        title: title.into(),
        x_label: x_label.into(),
        y_label: y_label.into(),
        y_range: Some((0.0, 1.0)),
        summary: Summary::MeanAndInterval,
        ..Panel::default()
    }
}

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(20);
    let mut report =
        Report { seeds, sets: Vec::new(), doses: Vec::new(), q_learning: Vec::new(), claims: Vec::new() };
    let mut panels = [
        panel("executed always", "executions (p > 0.5 from 51 on)", "share of seeds with s1 in the set"),
        panel(
            "executed from inside only",
            "c of a count bonus c/√N",
            "p, the option's competence at the end",
        ),
        panel("Q-learning", "episodes", "p, the option's competence"),
    ];
    let mut lags = Vec::new();
    println!("{:22}{:>26}{:>26}{:>24}", "", "lag", "competence if gated", "kept if gated");
    for (number, (name, weights, bonus)) in WAYS.into_iter().enumerate() {
        let always = over_seeds(seeds, |seed| rounds(family(weights, bonus, 0), false, seed));
        let gated = over_seeds(seeds, |seed| rounds(family(weights, bonus, 5), true, seed));
        let lags_of: Vec<f64> = always.iter().map(|story| lag(story)).collect();
        let last = |story: &Vec<(bool, f32)>| story[ROUNDS - 1];
        let row = Row {
            name,
            lag: mean_interval(&lags_of),
            competence: mean_interval(
                &gated.iter().map(|story| f64::from(last(story).1)).collect::<Vec<_>>(),
            ),
            kept: share(gated.iter().map(|story| last(story).0)),
        };
        let [late, competence, kept] =
            [format!("{:.1}", row.lag), row.competence.to_string(), row.kept.to_string()];
        println!("{name:22}{late:>26}{competence:>26}{kept:>24}");
        let series = |runs| Series { label: name.into(), colour: number + 1, runs };
        let early: Vec<_> = always.iter().map(|story| story[..ROUNDS / 2].to_vec()).collect();
        panels[0].series.push(series(points(&early, |at| f64::from(u8::from(at.0)))));
        lags.push((name, lags_of, gated.iter().map(|story| f64::from(last(story).1)).collect::<Vec<_>>()));
        report.sets.push(row);
    }
    println!("\ncompetence if gated, with a count bonus of c = {DOSES:?}");
    for (number, (name, weights, _)) in WAYS.into_iter().take(3).enumerate() {
        let end = |c| {
            over_seeds(seeds, |seed| rounds(family(weights, Bonus::Count { c }, 5), true, seed)[ROUNDS - 1].1)
        };
        let ends = DOSES.map(end);
        let means = ends.each_ref().map(|ends| ends.iter().sum::<f32>() / ends.len() as f32);
        println!("{name:22}{means:.2?}");
        let run =
            |seed: usize| (0..DOSES.len()).map(|i| (f64::from(DOSES[i]), f64::from(ends[i][seed]))).collect();
        let runs = (0..seeds as usize).map(run).collect();
        panels[1].series.push(Series { label: name.into(), colour: number + 1, runs });
        report.doses.push((name, DOSES.into_iter().zip(means).collect()));
    }
    println!("\n{:22}{:>22}{:>22}", "Q-learning", "prefers o at the end", "competence");
    for (number, (name, explore)) in LEARNERS.into_iter().enumerate() {
        let stories = over_seeds(seeds, |seed| q_learning(explore, &mut Seed(seed).stream("q-learning", 0)));
        let last = |story: &Vec<(bool, f32)>| story[EPISODES - 1];
        let learner = Learner {
            name,
            prefers: share(stories.iter().map(|story| last(story).0)),
            competence: mean_interval(&stories.iter().map(|s| f64::from(last(s).1)).collect::<Vec<_>>()),
        };
        println!("{name:22}{:>22}{:>22}", learner.prefers.to_string(), learner.competence.to_string());
        let runs = points(&stories, |at| f64::from(at.1));
        panels[2].series.push(Series { label: format!("Q: {name}"), colour: number + 1, runs });
        report.q_learning.push(learner);
    }
    let of = |name: &str| lags.iter().find(|(way, ..)| *way == name).expect("the way is compared");
    for ours in ["weighted", "IVF"] {
        let claim = [
            (format!("lag: binary above {ours}"), superiority(&of("binary").1, &of(ours).1)),
            (format!("gated competence: {ours} + progress above binary"), {
                superiority(&of(&format!("{ours} + progress")).2, &of("binary").2)
            }),
        ];
        for (claim, superiority) in claim {
            let verdict = Verdict::of(&superiority);
            println!("{claim:56} {superiority} {verdict:?}");
            report.claims.push((claim, superiority, verdict));
        }
    }
    std::fs::create_dir_all(&options.out)?;
    curves(options.out.join("nonstationary.png"), &panels)?;
    write(options, "nonstationary", &report)
}
