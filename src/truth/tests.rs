//! A skill of which it is known where it succeeds, and sets that are wrong by a known amount.

use inroads_agents::{Actor, Agent, Context, Transition, checkpoint};
use inroads_discovery::{
    SkillRecord, Skilled, Stop,
    chain::Phase,
    record::{Came, Trial},
};
use inroads_envs::registry::{self, AnyEnvironment};

use super::{How, Lattice, Truth};
use crate::{
    assembly::Vector,
    config::{Config, Settings},
    figures::Rect,
    run::RunError,
    session::{Session, stub},
};

/// Where its subgoal begins, metres along the corridor.
const SUBGOAL: f32 = 7.0;
/// Steps that a call may take, of a metre each.
const BUDGET: u32 = 4;

/// Knows one skill, which walks straight ahead; or none.
struct Strider {
    skills: usize,
}

checkpoint!([] Strider; plain: skills; parts: );

impl Actor<Vector, Vector> for Strider {
    fn begin(&mut self, _: &Vector, _: &mut Context) {}

    fn act(&mut self, _: &Vector, _: &mut Context) -> Vector {
        vec![1.0, 0.0]
    }

    fn observe(&mut self, _: &Transition<Vector, Vector>, _: &mut Context) {}
}

impl Agent<Vector, Vector> for Strider {
    fn frozen(&self) -> Box<dyn Actor<Vector, Vector> + '_> {
        Box::new(Stride(None, 0))
    }

    fn updates(&self) -> Vec<(&'static str, u64)> {
        Vec::new()
    }
}

impl Skilled<Vector, Vector> for Strider {
    fn skills(&self) -> Vec<SkillRecord> {
        let skill = SkillRecord {
            skill: 1,
            enters: None,
            phase: Phase::Fixed,
            born: 0,
            executions: 0,
            successes: 0,
            examples: (0, 0),
        };
        vec![skill; self.skills]
    }

    /// One metre more than is true.
    fn members(&self, s: &Vector) -> Vec<bool> {
        vec![s[0] >= 2.0]
    }

    fn targets(&self, s: &Vector) -> Vec<bool> {
        vec![s[0] >= 5.0]
    }

    fn chances(&self, s: &Vector) -> Vec<Option<f32>> {
        vec![Some(if s[0] >= 2.0 { 0.5 } else { 0.0 })]
    }

    fn one_call(&self, skill: u32) -> Option<Box<dyn Trial<Vector, Vector> + '_>> {
        (skill == 1).then(|| Box::new(Stride(None, 0)) as _)
    }
}

/// What the call came to, and the steps that it has taken.
struct Stride(Option<Came>, u32);

impl Actor<Vector, Vector> for Stride {
    fn begin(&mut self, s: &Vector, _: &mut Context) {
        let there = Came { stop: Stop::Reached, steps: 0, success: true };
        (self.0, self.1) = ((s[0] >= SUBGOAL).then_some(there), 0);
    }

    fn act(&mut self, _: &Vector, _: &mut Context) -> Vector {
        vec![1.0, 0.0]
    }

    fn observe(&mut self, t: &Transition<Vector, Vector>, _: &mut Context) {
        self.1 += 1;
        let success = t.after[0] >= SUBGOAL;
        let stop = if success { Stop::Reached } else { Stop::TimedOut };
        self.0 = (success || self.1 == BUDGET).then_some(Came { stop, steps: self.1, success });
    }
}

impl Trial<Vector, Vector> for Stride {
    fn came(&self) -> Option<Came> {
        self.0
    }
}

fn settings(environment: &str) -> Settings {
    Config::defaults("ddpg", environment).unwrap().settings
}

fn walking(skills: usize) -> Box<dyn Session> {
    let AnyEnvironment::Vectors(env) = registry::make("point-corridor").unwrap() else {
        unreachable!("a point robot is moved by numbers")
    };
    stub::of(env, Box::new(Strider { skills }))
}

/// Free space reaches from x = −2 to 10 and y = −2 to 2, so that cells of a metre have their middles at halves. With at most 0.1 m
/// and 0.1 rad of noise a call covers 3.9 to 4.1 m: it succeeds from 3.5 on, and not from 2.5.
#[test]
fn a_skill_succeeds_where_it_is_known_to() {
    let session = walking(1);
    let how = How { cells: 12, times: 3 };
    let mut watched = Vec::new();
    let truth = Truth::of(&*session, &settings("point-corridor"), how, |done, all| watched.push((done, all)));
    let truth = truth.unwrap();
    assert_eq!((watched.first(), watched.last()), (Some(&(0, 48)), Some(&(48, 48))));
    assert_eq!((truth.lattice.columns, truth.lattice.rows, truth.lattice.cell()), (12, 4, [1.0, 1.0]));

    let [skill] = &truth.skills[..] else { panic!("there is one skill") };
    assert_eq!(skill.cells.len(), 48);
    for cell in &skill.cells {
        let [x, _] = cell.at;
        assert_eq!(x, cell.column as f32 - 1.5);
        let (tried, there) = if x < SUBGOAL { (3, 0) } else { (0, 3) };
        let succeeded = if (3.0..SUBGOAL).contains(&x) { 3 } else { 0 };
        assert_eq!((cell.tried, cell.there, cell.succeeded), (tried, there, succeeded), "{cell:?}");
        // A metre a step, from a place that is known up to 0.1 m.
        let steps = (succeeded > 0).then(|| (SUBGOAL - x).ceil());
        assert_eq!(cell.steps, steps, "{cell:?}");
    }
    let score = skill.score;
    let [nine, four, two] = [9.0, 4.0, 2.0].map(|columns| 4.0 * columns);
    assert_eq!((score.cells, score.area, score.succeeds), (36, nine, four));
    assert_eq!((score.may_start, score.may_aim), (20.0, two));
    assert_eq!((score.precision, score.recall), (Some(0.8), Some(1.0)));
    assert_eq!((score.aim_precision, score.success), (Some(1.0), 4.0 / 9.0));
    assert_eq!((score.success_inside, score.balanced_accuracy), (Some(0.8), Some(0.9)));
    // Half a unit off in five columns of nine, exact in the others.
    assert!((score.brier.unwrap() - 0.25 * 5.0 / 9.0).abs() < 1e-12, "{:?}", score.brier);
}

#[test]
fn what_cannot_be_asked_is_said() {
    let why = |session: &dyn Session, environment| {
        Truth::of(session, &settings(environment), How::default(), |_, _| {}).unwrap_err()
    };
    let error = why(&*walking(0), "point-corridor");
    assert!(matches!(error, RunError::NoCalls { episodes: 0, .. }), "{error}");
    assert!(matches!(why(&*walking(1), "reacher"), RunError::NoMap(_)));
}

#[test]
fn cells_are_as_square_as_can_be() {
    let rect = |w: f32, h: f32| Rect { min: [-1.0, 2.0], max: [-1.0 + w, 2.0 + h] };
    let lattice = Lattice::of(rect(8.0, 3.0), 4);
    assert_eq!((lattice.columns, lattice.rows, lattice.cell()), (4, 2, [2.0, 1.5]));
    assert_eq!((lattice.middle(0, 0), lattice.middle(3, 1)), ([0.0, 2.75], [6.0, 4.25]));
    assert_eq!(Lattice::of(rect(1.0, 9.0), 3).columns, 1);
}
