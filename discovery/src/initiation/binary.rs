//! Sets that a binary classifier learns, as chapter 3 has them (3.1.3).

use inroads_agents::{Bag, Checkpoint, Corrupt, classify::Classifier};

use super::{
    Initiation,
    examples::{Examples, Places, row},
};
use crate::SkillId;

/// Sets that a binary classifier learns: one-class from the gestation's states, then two-class (3.1.3).
pub struct Binary<O, C> {
    places: Places<O>,
    blank: C,
    sets: Vec<Set<C>>,
    capacity: usize,
}

struct Set<C> {
    classifier: C,
    examples: Examples,
}

impl<O, C: Classifier + Clone> Binary<O, C> {
    /// A family that classifies the rows of `places` with copies of `blank`, remembering at most `capacity`
    /// examples of either class a skill (the oldest are forgotten first).
    pub fn new(places: Places<O>, blank: C, capacity: usize) -> Self {
        Self { places, blank, sets: Vec::new(), capacity }
    }

    /// The set of a learned skill: skill 1 is row 0.
    fn set(&self, k: SkillId) -> Option<&Set<C>> {
        self.sets.get(k.index().checked_sub(1)?)
    }
}

impl<C: Classifier> Set<C> {
    /// Refits; a set that cannot be fitted (no positives, say) keeps its last fit.
    fn refit(&mut self) {
        let _unfit = self.classifier.fit(&self.examples.positives, &self.examples.negatives);
    }
}

impl<O, A, C: Classifier + Clone> Initiation<O, A> for Binary<O, C> {
    fn born(&mut self, k: SkillId, positives: &[O]) {
        assert_eq!(k.index(), self.sets.len() + 1, "skills are born in the order of their numbers");
        self.sets.push(Set { classifier: self.blank.clone(), examples: Examples::default() });
        Initiation::<O, A>::outcome(self, k, positives, true);
    }

    fn distance(&self, k: SkillId, s: &O) -> f32 {
        match self.set(k) {
            Some(set) => (-set.classifier.score(&row(&self.places, s))).max(0.0),
            None => 0.0,
        }
    }

    fn outcome(&mut self, k: SkillId, states: &[O], success: bool) {
        let Some(set) = k.index().checked_sub(1).and_then(|i| self.sets.get_mut(i)) else { return };
        set.examples.add(states.iter().map(|s| row(&self.places, s)), success, self.capacity);
        set.refit();
    }

    fn examples(&self, k: SkillId) -> (usize, usize) {
        self.set(k).map_or((0, 0), |set| set.examples.counts())
    }
}

impl<O, C: Classifier + Clone> Checkpoint for Binary<O, C> {
    fn save(&self, bag: &mut Bag) {
        bag.put("sets", &self.sets.len());
        for (i, set) in self.sets.iter().enumerate() {
            bag.put(&format!("{i}.examples"), &set.examples);
            bag.put_part(&format!("{i}.classifier"), &set.classifier);
        }
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        self.sets.clear();
        for i in 0..bag.get::<usize>("sets")? {
            let examples = bag.get(&format!("{i}.examples"))?;
            let mut set = Set { classifier: self.blank.clone(), examples };
            bag.get_part(&format!("{i}.classifier"), &mut set.classifier)?;
            self.sets.push(set);
        }
        Ok(())
    }
}
