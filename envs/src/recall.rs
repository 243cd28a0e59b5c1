//! A cue that is shown once and asked for later: who does not remember is at chance.

use inroads_sim::{
    Shape,
    rigid::{Pose, Rectangle, Vector},
    view::{Mark, Scene, Solid},
};
use rand::RngExt;

use crate::registry::{AnyEnvironment, Entry, Make};
use crate::{Dimension, Drawing, End, Environment, Refused, Render, Seed, Space, Spec, Step};

/// The worlds of the registry.
pub(crate) const ENTRIES: &[Entry] = &[Entry {
    name: "recall-6",
    about: "one of two cues, six blank steps, then the cue's choice; 1 for the right one",
    make: Make::Bodies {
        make: || AnyEnvironment::Choices(Box::new(Recall::named("recall-6", 6))),
        picture: || None,
    },
}];

/// A cue, −1 or 1, is seen at the first step only; then so many observations are blank; at the last the agent is asked, and
/// choice 0 is right after −1, choice 1 after 1. Choices before that lead on, whichever they are.
///
/// So every deterministic choice at the question that is a function of what is seen *then* is right in half of all episodes.
#[derive(Clone, Debug)]
pub struct Recall {
    spec: Spec,
    blanks: u32,
    /// Which choice is right.
    right: usize,
    /// Steps taken; none before the first episode and after each.
    at: Option<u32>,
}

impl Recall {
    /// A cue that is to be remembered over so many blank observations.
    pub fn new(blanks: u32) -> Self {
        Self::named("recall", blanks)
    }

    /// The same under a registry's name.
    pub fn named(name: &'static str, blanks: u32) -> Self {
        let dimensions = [Dimension::linear("cue", "", -1.0, 1.0), Dimension::linear("asked", "", 0.0, 1.0)];
        let spec = Spec {
            name,
            about: "a cue, blank steps, then the cue's choice; 1 for the right one",
            observation: Space::Box(dimensions.into()),
            action: Space::Discrete(2),
            goal: None,
            place: Vec::new(),
            time_limit: None,
            success_reward: 1.0,
        };
        Self { spec, blanks, right: 0, at: None }
    }
}

impl Environment for Recall {
    type Observation = Vec<f32>;
    type Action = usize;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        self.right = usize::from(Seed(seed).stream("cue", 0).random::<bool>());
        self.at = Some(0);
    }

    fn step(&mut self, action: &usize) -> Result<Step, Refused> {
        let at = self.at.ok_or(Refused::Over)?;
        self.spec.action.admit_choice(*action)?;
        let asked = at > self.blanks;
        self.at = (!asked).then_some(at + 1);
        Ok(match asked {
            true => {
                Step { reward: if *action == self.right { 1.0 } else { 0.0 }, end: Some(End::Terminated) }
            }
            false => Step { reward: 0.0, end: None },
        })
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        let cue = if self.right == 1 { 1.0 } else { -1.0 };
        out.clear();
        match self.at {
            Some(0) => out.extend([cue, 0.0]),
            Some(at) if at > self.blanks => out.extend([0.0, 1.0]),
            _ => out.extend([0.0, 0.0]),
        }
    }
}

impl Render for Recall {
    fn choices(&self) -> &'static [&'static str] {
        &["left", "right"]
    }

    /// One walks along; the cue is a mark at the beginning, the two answers are marks at the end.
    fn drawing(&self) -> Drawing {
        let end = self.blanks as f32 + 1.0;
        let at = self.at.map_or(end, |at| at as f32);
        let walker = Solid {
            shape: Shape::Ball { radius: 0.3 },
            pose: Pose::from_translation(Vector::new(at, 0.0, 0.3)),
            colour: [214, 96, 77],
        };
        let side = |choice: usize| if choice == 1 { -1.0 } else { 1.0 };
        let mark = |x, choice| Mark { at: [x, side(choice)], radius: 0.4, colour: [77, 175, 74] };
        let mut marks = vec![mark(end, 0), mark(end, 1)];
        if self.at == Some(0) {
            marks.push(mark(0.0, self.right));
        }
        Drawing::Bodies(Scene {
            solids: vec![walker],
            marks,
            trail: Vec::new(),
            bounds: Rectangle { low: [-0.5, -1.5], high: [f64::from(end) + 0.5, 1.5] },
            focus: Vector::new(end / 2.0, 0.0, 0.0),
            distance: 1.5 * end,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is seen in an episode with this last choice, and what it pays.
    fn played(seed: u64, last: usize) -> (Vec<Vec<f32>>, f32) {
        let mut recall = Recall::new(6);
        recall.reset(seed);
        let (mut seen, mut all) = (Vec::new(), Vec::new());
        for step in 0.. {
            recall.observe(&mut seen);
            all.push(seen.clone());
            let Step { reward, end } = recall.step(&if step == 7 { last } else { step % 2 }).unwrap();
            if let Some(end) = end {
                assert_eq!((step, end), (7, End::Terminated));
                assert_eq!(recall.spec().succeeded(&Step { reward, end: Some(end) }), reward == 1.0);
                assert_eq!(recall.step(&0), Err(Refused::Over));
                return (all, reward);
            }
            assert_eq!(reward, 0.0);
        }
        unreachable!("it asks");
    }

    #[test]
    fn the_cue_is_seen_once_and_pays_eight_steps_later() {
        let mut cues = [0; 2];
        for seed in 0..200 {
            let (seen, left) = played(seed, 0);
            let (again, right) = played(seed, 1);
            assert_eq!(seen, again);
            let cue = seen[0][0];
            assert_eq!((left, right), if cue < 0.0 { (1.0, 0.0) } else { (0.0, 1.0) });
            cues[usize::from(cue > 0.0)] += 1;
            assert_eq!(seen[1..7], [[0.0, 0.0]; 6]);
            assert_eq!(seen[7], [0.0, 1.0]);
        }
        assert!(cues.iter().all(|n| *n > 70), "{cues:?}");
    }

    #[test]
    fn a_choice_that_there_is_not_changes_nothing() {
        let mut recall = Recall::new(0);
        recall.reset(0);
        assert!(matches!(recall.step(&2), Err(Refused::OutOfRange { .. })));
        assert_eq!(recall.step(&0).unwrap().end, None);
        assert_eq!(recall.step(&0).unwrap().end, Some(End::Terminated));
    }
}
