//! Initiation sets of chapter 5 where every number is known: an option of one step that becomes competent and forgets
//! again, and a chain whose sets are value functions.

use std::cell::Cell;
use std::ops::Range;
use std::rc::Rc;
use std::sync::Arc;

use inroads_agents::classify::{Odds, OddsConfig};
use inroads_agents::encode::Select;
use inroads_agents::evaluate::{Table, TableConfig};
use inroads_agents::experience::Aim;
use inroads_agents::{
    Bag, Checkpoint, Context, Corrupt, Experience, Lesson, Pace, TabularQ, Transition, episode,
    tabular::TabularConfig,
};
use inroads_discovery::chain::Phase;
use inroads_discovery::initiation::{Act, Bonus, IvfConfig, WeightedConfig, Weights};
use inroads_discovery::over_skills::{Epsilon, TabularOverSkills};
use inroads_discovery::{
    ChainConfig, Chaining, Hierarchy, Initiation, Ivf, PerSkill, SkillId, Skilled, Weighted,
};
use inroads_envs::{Environment, Seed, TimeLimit, corridor::Corridor};

type State = Vec<f32>;
type Values = Ivf<State, usize, Table>;
type Family = Box<dyn Initiation<State, usize>>;

const SKILL: SkillId = SkillId(1);

/// A value function that learns each execution once, by three quarters of the error.
fn values(bonus: Bonus) -> Values {
    let table = TableConfig { rate: 0.75, batch: 1, period: 2, ..TableConfig::default() };
    let config = IvfConfig { gestation: 3, capacity: 1, bonus, ..IvfConfig::default() };
    Ivf::new(&config, Table::new(1, &table), |_| ())
}

fn weighted(weights: Weights) -> Weighted<State, usize, Table> {
    let config = WeightedConfig { weights, ..WeightedConfig::default() };
    let odds = Odds::new(&OddsConfig { radius: 0.5, balance: false });
    Weighted::new(&config, values(Bonus::None), Arc::new(Select::new(&[0])), odds)
}

/// Executes the skill from state 0 once for each outcome, and asks `ask` after each.
fn run<I: Initiation<State, usize>, T>(sets: &mut I, outcomes: &[bool], ask: impl FnMut(&I) -> T) -> Vec<T> {
    sets.born(SKILL, &[]);
    go_on(sets, &mut Experience::new(1000), outcomes, ask)
}

/// The same of a skill that there is already.
fn go_on<I: Initiation<State, usize>, T>(
    sets: &mut I,
    all: &mut Experience<State, usize>,
    outcomes: &[bool],
    mut ask: impl FnMut(&I) -> T,
) -> Vec<T> {
    let mut ctx = Context::training(Seed(0), all.numbers().end);
    let (before, after) = (vec![0.0], vec![1.0]);
    let execute = |&success: &bool| {
        all.begin(&before);
        all.push(&Transition { before: &before, action: &0, reward: 0.0, after: &after, end: None });
        let aim = Aim::Subgoal { attained: success };
        let episode = all.latest();
        sets.outcome(SKILL, std::slice::from_ref(&before), success);
        sets.lesson(SKILL, &Lesson { episode, steps: 0..1, aim, goal: None, rewards: None });
        sets.learn(SKILL, all, &|_, _, _| 0, &mut ctx);
        ask(sets)
    };
    outcomes.iter().map(execute).collect()
}

/// A success, three failures, two successes, two failures.
const STORY: [bool; 8] = [true, false, false, false, true, true, false, false];

#[test]
fn values_follow_the_policy_and_classifiers_of_outcomes_do_not() {
    let near = |found: &[f32], expected: &[f32]| {
        assert!(found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-6), "{found:?} {expected:?}");
        assert_eq!(found.len(), expected.len());
    };
    // Q goes three quarters of the way to each outcome, and V three quarters of the way to Q.
    let expected =
        [0.562_5, 0.281_25, 0.105_468_75, 0.035_156_25, 0.573_486_3, 0.847_045_9, 0.387_680_05, 0.140_899_66];
    let found = run(&mut values(Bonus::None), &STORY, |sets| sets.values(SKILL, &[&vec![0.0]])[0]);
    near(&found, &expected);

    // Shares of weight of 3 successes among 3 + 3, then 3 + 4 and 3 + 5 examples.
    let probability = |weights| {
        let found = run(&mut weighted(weights), &STORY, |sets| sets.probability(SKILL, &vec![0.0]));
        found[5..].to_vec()
    };
    let latest = [(expected[5], 3.0), (expected[6], 4.0), (expected[7], 5.0)];
    let share = |positive: f32, negative: f32| positive / (positive + negative);
    near(&probability(Weights::Value), &latest.map(|(v, n)| share(3.0 * v, n * (1.0 - v))));
    near(&probability(Weights::Prior), &latest.map(|(v, n)| share(3.0, n * (1.0 - v))));
    near(&probability(Weights::Equal), &[0.5, 3.0 / 7.0, 3.0 / 8.0]);
    // algorithms.md 14, IVF (4): where V is 0.9.
    near(&[Weights::Value.of(true, 0.9), Weights::Value.of(false, 0.9)], &[0.9, 0.1]);
}

#[test]
fn who_contains_the_state_after_each_execution() {
    // Anywhere until the third success, whoever decides. Then the policy is competent, and then it forgets.
    let traces: [(Family, [bool; 3]); 6] = [
        (Box::new(values(Bonus::None)), [true, false, false]),
        // 0.388 + 0.5/√7 is above one half, 0.141 + 0.5/√8 is not.
        (Box::new(values(Bonus::Count { c: 0.5 })), [true, true, false]),
        // "Earlier" moves on at every second update: after the seventh it is 0.847, after the eighth what is now.
        (Box::new(values(Bonus::Progress)), [true, true, false]),
        (Box::new(weighted(Weights::Value)), [true, false, false]),
        (Box::new(weighted(Weights::Prior)), [true, true, false]),
        // The plain classifier drops the state when the policy has become competent.
        (Box::new(weighted(Weights::Equal)), [false, false, false]),
    ];
    for (number, (mut sets, rest)) in traces.into_iter().enumerate() {
        let contained = run(&mut sets, &STORY, |sets| sets.contains(SKILL, &vec![0.0]));
        assert_eq!(contained, [&[true; 5][..], &rest].concat(), "trace {number}");
    }
}

#[test]
fn failures_alone_leave_a_set_in_gestation_and_then_empty() {
    let failures = [false; 8];
    let ask = |sets: &Family| (sets.contains(SKILL, &vec![0.0]), sets.targets(SKILL, &vec![0.0]));
    let families: [fn(u32) -> Family; 2] = [
        |gestation| {
            let config = IvfConfig { gestation, ..IvfConfig::default() };
            Box::new(Values::new(&config, Table::new(1, &TableConfig::default()), |_| ()))
        },
        |gestation| {
            let config = IvfConfig { gestation, ..IvfConfig::default() };
            let ivf = Values::new(&config, Table::new(1, &TableConfig::default()), |_| ());
            let odds = Odds::new(&OddsConfig { radius: 0.5, balance: true });
            let encoder = Arc::new(Select::new(&[0]));
            Box::new(Weighted::new(&WeightedConfig::default(), ivf, encoder, odds))
        },
    ];
    for family in families {
        assert_eq!(
            run(&mut family(1), &failures, ask),
            [(true, false); 8],
            "a gestation lasts until a success"
        );
        assert_eq!(run(&mut family(0), &failures, ask), [(false, false); 8]);
    }
}

#[test]
fn checkpoints_go_on_alike() {
    let families: [fn() -> Family; 2] =
        [|| Box::new(values(Bonus::Count { c: 0.5 })), || Box::new(weighted(Weights::Value))];
    for family in families {
        let (mut saved, mut restored) = (family(), family());
        let mut all = Experience::new(1000);
        saved.born(SKILL, &[]);
        go_on(&mut saved, &mut all, &STORY[..5], |_| ());
        let mut bag = Bag::default();
        saved.save(&mut bag);
        restored.load(&bag).unwrap();
        let of = |sets: &Family| (sets.distance(SKILL, &vec![0.0]), sets.examples(SKILL));
        assert_eq!(of(&restored), of(&saved));
        let mut again = Bag::default();
        restored.save(&mut again);
        assert!(again == bag, "a restored family is saved as it was");
        let traces = [saved, restored].map(|mut sets| go_on(&mut sets, &mut all.clone(), &STORY[5..], of));
        assert_eq!(traces[0], traces[1]);
        assert!(traces[0][0] != traces[0][2], "there was something to learn");
    }
}

#[test]
fn goals_are_named_by_what_was_attained_and_the_best_one_counts() {
    // From 0 the policy reaches 1, and never 2; both attain the subgoal.
    let config = IvfConfig { gestation: 0, ..IvfConfig::default() };
    let table = Table::new(2, &TableConfig { rate: 0.5, ..TableConfig::default() });
    let mut sets: Ivf<State, usize, Table, State> = Ivf::new(&config, table, Clone::clone);
    let mut all = Experience::new(1000);
    let mut ctx = Context::training(Seed(5), 0);
    sets.born(SKILL, &[]);
    for round in 0..40 {
        let (action, to) = if round % 2 == 0 { (0, 1.0) } else { (1, 2.0) };
        let (before, after) = (vec![0.0], vec![to]);
        all.begin(&before);
        all.push(&Transition { before: &before, action: &action, reward: 0.0, after: &after, end: None });
        let aim = Aim::Subgoal { attained: true };
        sets.lesson(SKILL, &Lesson { episode: all.latest(), steps: 0..1, aim, goal: None, rewards: None });
        sets.learn(SKILL, &all, &|_, _, _| 0, &mut ctx);
    }
    assert!(sets.contains(SKILL, &vec![0.0]) && !sets.contains(SKILL, &vec![3.0]));
}

type Chain = Hierarchy<State, usize, Chaining<State, usize, Family, PerSkill<TabularQ>, TabularOverSkills>>;

/// Skill chaining in the corridor of five states, as in `corridor.rs`, with other sets.
fn chain(sets: Family, freeze: bool) -> (TimeLimit<Corridor>, Chain) {
    let env = TimeLimit::new(Corridor::new(5), 50);
    let config = ChainConfig {
        gestation: 5,
        segment: 3,
        initiation_episodes: 2,
        initiation_successes: 1,
        timeout: 5,
        pretrain: 50,
        freeze,
        ..ChainConfig::default()
    };
    let tables = TabularConfig { discount: 0.9, ..TabularConfig::default() };
    let global = TabularQ::new(2, &tables);
    let policy = PerSkill::new(global, TabularQ::clone, 1000, Pace { updates_per_step: 1.0, warm_up: 1 });
    let over = TabularOverSkills::new(0.5, Epsilon { start: 0.5, end: 0.1, decisions: 200 });
    let agent = Hierarchy::new(Chaining::new(&config, env.spec(), sets, policy, over), 1000);
    (env, agent)
}

fn train((env, agent): &mut (TimeLimit<Corridor>, Chain), episodes: Range<u64>) {
    for number in episodes {
        let mut ctx = Context::training(Seed(7), number);
        episode(env, agent, Seed(7).number("start", number), &mut ctx, |_, _| {}).unwrap();
    }
}

#[test]
fn a_chain_of_value_functions_is_as_long_as_its_policies_need() {
    // The first skill's policy learns to succeed from everywhere, and its set says so: there is no second skill.
    let tables = TableConfig { rate: 0.5, ..TableConfig::default() };
    let config = IvfConfig { gestation: 1, ..IvfConfig::default() };
    let mut chain = chain(Box::new(Values::new(&config, Table::new(2, &tables), |_| ())), false);
    train(&mut chain, 0..60);
    let members: Vec<_> = (0..4).map(|cell| chain.1.members(&vec![cell as f32])).collect();
    assert_eq!(members, vec![[true]; 4]);
}

/// Sets without an end that count what they are told.
struct Told(Rc<Cell<u32>>);

impl Told {
    fn tell(&self) {
        self.0.set(self.0.get() + 1);
    }
}

impl Initiation<State, usize> for Told {
    fn born(&mut self, _: SkillId, _: &[State]) {}

    fn distance(&self, _: SkillId, _: &State) -> f32 {
        0.0
    }

    fn outcome(&mut self, _: SkillId, _: &[State], _: bool) {
        self.tell();
    }

    fn interrupted(&mut self, _: SkillId, _: &State) {
        self.tell();
    }

    fn lesson(&mut self, _: SkillId, _: &Lesson) {
        self.tell();
    }

    fn learn(
        &mut self,
        _: SkillId,
        _: &Experience<State, usize>,
        _: &Act<'_, State, usize>,
        _: &mut Context,
    ) {
        self.tell();
    }

    fn examples(&self, _: SkillId) -> (usize, usize) {
        (0, 0)
    }
}

impl Checkpoint for Told {
    fn save(&self, _: &mut Bag) {}

    fn load(&mut self, _: &Bag) -> Result<(), Corrupt> {
        Ok(())
    }
}

#[test]
fn a_fixed_set_is_told_nothing_more() {
    for (freeze, phase) in [(true, Phase::Fixed), (false, Phase::Mature)] {
        let told = Rc::new(Cell::new(0));
        let mut chain = chain(Box::new(Told(told.clone())), freeze);
        train(&mut chain, 0..40);
        let skills = chain.1.skills();
        assert_eq!((skills.len(), skills[0].phase), (1, phase));
        let (before, executions) = (told.get(), skills[0].executions);
        train(&mut chain, 40..60);
        assert!(before > 0 && chain.1.skills()[0].executions > executions);
        assert_eq!(told.get() == before, freeze);
    }
}

#[test]
fn starts_are_counted_however_executions_end() {
    let mut sets = values(Bonus::Count { c: 0.8 });
    run(&mut sets, &[true; 3], |_| ());
    // Nothing is known of state 9 but that it was tried: c, c/√2 and c/√3 against one half.
    let tried = |sets: &mut Values| {
        sets.interrupted(SKILL, &vec![9.0]);
        sets.contains(SKILL, &vec![9.0])
    };
    assert_eq!([(); 3].map(|()| tried(&mut sets)), [true, true, false]);
}
