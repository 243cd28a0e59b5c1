//! Initiation sets: where a skill may start (3.1.3).

use std::sync::Arc;

use inroads_agents::{Bag, Checkpoint, Corrupt, Encoder, classify::Classifier};

use crate::SkillId;

/// A family of initiation sets, one a skill. The global option has none: it starts anywhere.
pub trait Initiation<O>: Checkpoint {
    /// A new skill `k` begins with states from which its subgoal was reached.
    fn born(&mut self, k: SkillId, positives: &[O]);

    /// Whether skill `k` may start at `s`.
    fn contains(&self, k: SkillId, s: &O) -> bool {
        self.distance(k, s) <= 0.0
    }

    /// How far `s` is outside `k`'s set, 0 inside; in the classifier's own units, for dense rewards (3.1.1).
    fn distance(&self, k: SkillId, s: &O) -> f32;

    /// Skill `k` was executed: `states` led to its subgoal, or did not.
    fn outcome(&mut self, k: SkillId, states: &[O], success: bool);

    /// The number of positive and negative examples that `k`'s set was learned from.
    fn examples(&self, k: SkillId) -> (usize, usize);
}

/// Sets that a binary classifier learns: one-class from the gestation's states, then two-class (3.1.3).
pub struct Binary<O, C> {
    encoder: Arc<dyn Encoder<O> + Send + Sync>,
    blank: C,
    sets: Vec<Set<C>>,
    capacity: usize,
}

struct Set<C> {
    classifier: C,
    positives: Vec<Vec<f32>>,
    negatives: Vec<Vec<f32>>,
}

impl<O, C: Classifier + Clone> Binary<O, C> {
    /// A family that classifies the rows of `encoder` with copies of `blank`, remembering at most `capacity`
    /// examples of either class a skill (the oldest are forgotten first).
    pub fn new(encoder: Arc<dyn Encoder<O> + Send + Sync>, blank: C, capacity: usize) -> Self {
        Self { encoder, blank, sets: Vec::new(), capacity }
    }

    fn row(&self, s: &O) -> Vec<f32> {
        let mut row = vec![0.0; self.encoder.width()];
        self.encoder.write(s, &mut row);
        row
    }

    /// The set of a learned skill: skill 1 is row 0.
    fn set(&self, k: SkillId) -> Option<&Set<C>> {
        self.sets.get(k.index().checked_sub(1)?)
    }
}

impl<C: Classifier> Set<C> {
    /// Refits; a set that cannot be fitted (no positives, say) keeps its last fit.
    fn refit(&mut self) {
        let _unfit = self.classifier.fit(&self.positives, &self.negatives);
    }
}

impl<O, C: Classifier + Clone> Initiation<O> for Binary<O, C> {
    fn born(&mut self, k: SkillId, positives: &[O]) {
        assert_eq!(k.index(), self.sets.len() + 1, "skills are born in the order of their numbers");
        let positives = positives.iter().map(|s| self.row(s)).collect();
        let mut set = Set { classifier: self.blank.clone(), positives, negatives: Vec::new() };
        set.refit();
        self.sets.push(set);
    }

    fn distance(&self, k: SkillId, s: &O) -> f32 {
        match self.set(k) {
            Some(set) => (-set.classifier.score(&self.row(s))).max(0.0),
            None => 0.0,
        }
    }

    fn outcome(&mut self, k: SkillId, states: &[O], success: bool) {
        let rows: Vec<_> = states.iter().map(|s| self.row(s)).collect();
        let capacity = self.capacity;
        let Some(set) = k.index().checked_sub(1).and_then(|i| self.sets.get_mut(i)) else { return };
        let examples = if success { &mut set.positives } else { &mut set.negatives };
        examples.extend(rows);
        let surplus = examples.len().saturating_sub(capacity);
        examples.drain(..surplus);
        set.refit();
    }

    fn examples(&self, k: SkillId) -> (usize, usize) {
        self.set(k).map_or((0, 0), |set| (set.positives.len(), set.negatives.len()))
    }
}

impl<O, C: Classifier + Clone> Checkpoint for Binary<O, C> {
    fn save(&self, bag: &mut Bag) {
        bag.put("sets", &self.sets.len());
        for (i, set) in self.sets.iter().enumerate() {
            bag.put(&format!("{i}.examples"), &(&set.positives, &set.negatives));
            bag.put_part(&format!("{i}.classifier"), &set.classifier);
        }
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        self.sets.clear();
        for i in 0..bag.get::<usize>("sets")? {
            let (positives, negatives) = bag.get(&format!("{i}.examples"))?;
            let mut set = Set { classifier: self.blank.clone(), positives, negatives };
            bag.get_part(&format!("{i}.classifier"), &mut set.classifier)?;
            self.sets.push(set);
        }
        Ok(())
    }
}
