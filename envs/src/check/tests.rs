//! Environments that break one clause each.

use rand::RngExt;

use super::*;
use crate::{Annotated, Dimension, Frame, Goal, Step, corridor::Corridor};

/// What is broken in the toy below.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Broken {
    Nothing,
    SpecGoal,
    Length,
    Nan,
    Buffer,
    Reward,
    Replay,
    Timid,
    Reckless,
    Marked,
    Eager,
    Tireless,
    Late,
    Early,
}

/// Adds its action to a number that starts anywhere, until the number is large or 10 steps are over.
struct Toy {
    broken: Broken,
    spec: Spec,
    sum: f32,
    steps: u32,
    resets: u32,
    over: bool,
}

impl Toy {
    fn new(broken: Broken) -> Self {
        let dims = if broken == Broken::SpecGoal { vec![1] } else { vec![0] };
        let spec = Spec {
            name: "toy",
            about: "",
            observation: Space::Box([Dimension::linear("sum", "", -5.0, 5.0)].into()),
            action: Space::Box([Dimension::linear("add", "", -1.0, 1.0)].into()),
            goal: Some(Goal { dims, at: vec![2.0], tolerance: 1.0 }),
            place: vec![0],
            time_limit: Some(10),
            success_reward: 0.0,
        };
        Self { broken, spec, sum: 0.0, steps: 0, resets: 0, over: broken != Broken::Eager }
    }
}

impl Environment for Toy {
    type Observation = Vec<f32>;
    type Action = Vec<f32>;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        self.resets += 1;
        let from = if self.broken == Broken::Replay { u64::from(self.resets) } else { seed };
        self.sum = Seed(from).stream("start", 0).random_range(-1.0..1.0);
        self.steps = 0;
        self.over = false;
    }

    fn step(&mut self, action: &Vec<f32>) -> Result<Step, Refused> {
        if self.over && (self.broken != Broken::Tireless || self.resets == 0) {
            return Err(Refused::Over);
        }
        if self.broken == Broken::Marked {
            self.sum += 0.125;
        }
        if self.broken != Broken::Reckless {
            self.spec.action.admit(action)?;
        }
        if self.broken == Broken::Timid && action[0] > 0.0 {
            return Err(Refused::NotFinite { index: 0, value: action[0] });
        }
        self.sum += action.first().copied().unwrap_or_default();
        self.steps += 1;
        let limit = match self.broken {
            Broken::Late => 11,
            Broken::Early => 9,
            _ => 10,
        };
        let end = match () {
            () if self.sum > 2.0 => Some(End::Terminated),
            () if self.steps == limit => Some(End::Truncated),
            () => None,
        };
        self.over = end.is_some();
        Ok(Step { reward: if self.broken == Broken::Reward { f32::NAN } else { -1.0 }, end })
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        if self.broken != Broken::Buffer || out.len() > 1 {
            out.clear();
        }
        match self.broken {
            Broken::Length => out.extend([self.sum, self.sum]),
            Broken::Nan => out.push(f32::NAN),
            _ => out.push(self.sum),
        }
    }
}

fn verdict(broken: Broken) -> Result<(), Fault> {
    check(&mut Toy::new(broken), Options { episodes: 8, steps: 20 })
}

#[test]
fn a_sound_environment_passes() {
    assert_eq!(verdict(Broken::Nothing), Ok(()));
}

#[test]
fn each_broken_clause_is_caught_by_its_own_name() {
    let caught = |broken| verdict(broken).expect_err("a broken toy passed");
    assert!(matches!(caught(Broken::SpecGoal), Fault::Spec(_)));
    let length = caught(Broken::Length).to_string();
    assert!(length.ends_with("the observation has 2 components where the spec has 1 component"), "{length}");
    let nan = caught(Broken::Nan).to_string();
    assert!(nan.ends_with("observation component 0 (sum) is NaN"), "{nan}");
    assert!(matches!(caught(Broken::Buffer), Fault::Buffer { .. }));
    assert!(matches!(caught(Broken::Reward), Fault::Reward { .. }));
    assert!(matches!(caught(Broken::Replay), Fault::Replay { step: 0, .. }));
    assert!(matches!(caught(Broken::Timid), Fault::RefusedLegal { .. }));
    assert!(matches!(caught(Broken::Reckless), Fault::Admitted { .. }));
    assert!(matches!(caught(Broken::Marked), Fault::Mark { step: 1, .. }));
    assert!(matches!(caught(Broken::Eager), Fault::NotOver { when: "before the first reset", .. }));
    assert!(matches!(caught(Broken::Tireless), Fault::NotOver { when: "after the end of an episode", .. }));
    assert!(matches!(caught(Broken::Late), Fault::Limit { step: 10, end: None, .. }));
    assert!(matches!(caught(Broken::Early), Fault::Limit { step: 9, end: Some(End::Truncated), .. }));
}

/// A corridor that takes any choice for a step to the right.
struct Careless(Corridor);

impl Environment for Careless {
    type Observation = Vec<f32>;
    type Action = usize;

    fn spec(&self) -> &Spec {
        self.0.spec()
    }

    fn reset(&mut self, seed: u64) {
        self.0.reset(seed);
    }

    fn step(&mut self, action: &usize) -> Result<Step, Refused> {
        self.0.step(action.min(&1))
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        self.0.observe(out);
    }
}

#[test]
fn a_choice_that_is_none_must_be_refused() {
    let fault = check(&mut Careless(Corridor::new(5)), Options::default());
    assert!(matches!(&fault, Err(Fault::Admitted { action, .. }) if action == "2"), "{fault:?}");
}

/// What is broken in a picture.
#[derive(Clone, Copy, PartialEq)]
enum Smudge {
    None,
    /// Grey, though the spec says colour.
    Grey,
    /// Draws on what the buffer held.
    Over,
    /// Draws only what has changed since the last step, not since it drew last.
    Steps,
    /// Leaves the bits that the buffer held.
    Bits,
}

/// A corridor as a picture with a row of pixels, white where one is; its one proto-goal is to be at the end.
struct Seen {
    corridor: Corridor,
    smudge: Smudge,
    spec: Spec,
    shown: Frame,
    was: u32,
}

impl Seen {
    fn new(smudge: Smudge) -> Self {
        let corridor = Corridor::new(5);
        let observation = Space::Frame { width: 5, height: 1, channels: 3 };
        let spec = Spec { observation, goal: None, place: vec![], ..corridor.spec().clone() };
        Self { corridor, smudge, spec, shown: Frame::new([5, 1], 3), was: 0 }
    }

    fn at(&mut self) -> u32 {
        let mut seen = Vec::new();
        self.corridor.observe(&mut seen);
        seen[0] as u32
    }
}

impl Environment for Seen {
    type Observation = Annotated<Frame>;
    type Action = usize;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        self.corridor.reset(seed);
        self.shown.bytes_mut().fill(0);
        self.was = 0;
    }

    fn step(&mut self, action: &usize) -> Result<Step, Refused> {
        self.was = self.at();
        self.corridor.step(action)
    }

    fn observe(&mut self, out: &mut Annotated<Frame>) {
        let (at, was) = (self.at(), self.was);
        let paint = |frame: &mut Frame, x: u32, byte| frame.bytes_mut()[3 * x as usize..][..3].fill(byte);
        let channels = if self.smudge == Smudge::Grey { 1 } else { 3 };
        out.seen.shape([5, 1], channels);
        if self.smudge != Smudge::Over {
            out.seen.bytes_mut().fill(0);
        }
        match self.smudge {
            Smudge::Grey => {}
            Smudge::Steps => {
                paint(&mut self.shown, was, 0);
                paint(&mut self.shown, at, 255);
                out.seen.copy(&self.shown);
            }
            _ => paint(&mut out.seen, at, 255),
        }
        if self.smudge != Smudge::Bits {
            out.bits.clear(1);
        }
        if at == 4 && !out.bits.is_empty() {
            out.bits.set(0);
        }
    }
}

#[test]
fn pictures_and_proto_goals_are_checked_as_vectors_are() {
    let verdict = |smudge| check(&mut Seen::new(smudge), Options { episodes: 8, steps: 200 });
    assert_eq!(verdict(Smudge::None), Ok(()));
    let grey = verdict(Smudge::Grey).expect_err("grey is not colour").to_string();
    assert!(grey.contains("picture of 5 by 1 pixels with 1 channels with 1 proto-goals is not"), "{grey}");
    assert!(
        grey.ends_with("has 5 by 1 pixels of 1 bytes where the spec has 5 by 1 pixels of 3 bytes"),
        "{grey}"
    );
    assert!(matches!(verdict(Smudge::Over), Err(Fault::Buffer { step: 0, .. })));
    assert!(matches!(verdict(Smudge::Bits), Err(Fault::Buffer { step: 0, .. })));
    assert!(matches!(verdict(Smudge::Steps), Err(Fault::Looks { .. })));
}
