//! Two classifiers a set (4.1.1): an optimistic one says where the skill may start, so that it can grow; a pessimistic one
//! where another may aim, so that what is aimed at does not shrink away.

use inroads_agents::{Bag, Checkpoint, Corrupt, classify::Classifier};

use super::{
    Initiation,
    examples::{Examples, Places, row},
};
use crate::SkillId;

/// Sets of two classifiers each, of any kinds. The authors' are a two-class support vector machine, one-class with
/// ν = 0.01 before there are negatives, and a one-class machine with ν = 0.1.
pub struct Dual<O, C, P> {
    places: Places<O>,
    blank: (C, P),
    sets: Vec<Set<C, P>>,
    capacity: usize,
}

struct Set<C, P> {
    optimistic: C,
    pessimistic: P,
    examples: Examples,
}

impl<O, C: Classifier + Clone, P: Classifier + Clone> Dual<O, C, P> {
    /// A family that classifies the rows of `places` with copies of two classifiers, remembering at most `capacity`
    /// examples of either class a skill (the oldest are forgotten first).
    pub fn new(places: Places<O>, optimistic: C, pessimistic: P, capacity: usize) -> Self {
        Self { places, blank: (optimistic, pessimistic), sets: Vec::new(), capacity }
    }

    /// The set of a learned skill: skill 1 is row 0.
    fn set(&self, k: SkillId) -> Option<&Set<C, P>> {
        self.sets.get(k.index().checked_sub(1)?)
    }
}

impl<C: Classifier, P: Classifier> Set<C, P> {
    /// Refits both: the optimistic one to all examples, the pessimistic one, without negatives, to those that the
    /// optimistic one calls positive (authors' code). What cannot be fitted keeps its last fit.
    fn refit(&mut self) {
        let Examples { positives, negatives } = &self.examples;
        let _unfit = self.optimistic.fit(positives, negatives);
        let mut sure: Vec<_> = positives.iter().chain(negatives).cloned().collect();
        sure.retain(|row| self.optimistic.contains(row));
        // All examples lie where the others do: they tell nothing apart yet.
        let sure = if negatives.is_empty() || sure.is_empty() { positives } else { &sure };
        let _unfit = self.pessimistic.fit(sure, &[]);
    }
}

impl<O, A, C: Classifier + Clone, P: Classifier + Clone> Initiation<O, A> for Dual<O, C, P> {
    fn born(&mut self, k: SkillId, positives: &[O]) {
        assert_eq!(k.index(), self.sets.len() + 1, "skills are born in the order of their numbers");
        let (optimistic, pessimistic) = self.blank.clone();
        self.sets.push(Set { optimistic, pessimistic, examples: Examples::default() });
        Initiation::<O, A>::outcome(self, k, positives, true);
    }

    fn contains(&self, k: SkillId, s: &O) -> bool {
        self.set(k).is_none_or(|set| {
            let row = row(&self.places, s);
            set.optimistic.score(&row) >= 0.0 || set.pessimistic.score(&row) >= 0.0
        })
    }

    fn distance(&self, k: SkillId, s: &O) -> f32 {
        self.set(k).map_or(0.0, |set| (-set.pessimistic.score(&row(&self.places, s))).max(0.0))
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

impl<O, C: Classifier + Clone, P: Classifier + Clone> Checkpoint for Dual<O, C, P> {
    fn save(&self, bag: &mut Bag) {
        bag.put("sets", &self.sets.len());
        for (i, set) in self.sets.iter().enumerate() {
            bag.put(&format!("{i}.examples"), &set.examples);
            bag.put_part(&format!("{i}.optimistic"), &set.optimistic);
            bag.put_part(&format!("{i}.pessimistic"), &set.pessimistic);
        }
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        self.sets.clear();
        for i in 0..bag.get::<usize>("sets")? {
            let examples = bag.get(&format!("{i}.examples"))?;
            let (optimistic, pessimistic) = self.blank.clone();
            let mut set = Set { optimistic, pessimistic, examples };
            bag.get_part(&format!("{i}.optimistic"), &mut set.optimistic)?;
            bag.get_part(&format!("{i}.pessimistic"), &mut set.pessimistic)?;
            self.sets.push(set);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use inroads_agents::{
        classify::{Nearest, Svm, SvmConfig, TwoClassRule},
        encode::Select,
    };

    use super::*;

    /// Where one may start and where one may aim, of the places 0 to 9.
    fn tell<C: Classifier + Clone>(family: &Dual<Vec<f32>, C, C>) -> [Vec<u8>; 2] {
        let family: &dyn Initiation<Vec<f32>, usize> = family;
        let inside = |f: &dyn Fn(&Vec<f32>) -> bool| (0..10).filter(|x| f(&vec![f32::from(*x)])).collect();
        let k = SkillId(1);
        [inside(&|s| family.contains(k, s)), inside(&|s| family.targets(k, s))]
    }

    fn learn<C: Classifier + Clone>(optimistic: C, pessimistic: C) -> Dual<Vec<f32>, C, C> {
        let mut family = Dual::new(Arc::new(Select::new(&[0])), optimistic, pessimistic, 100);
        let states = |places: &[f32]| places.iter().map(|x| vec![*x]).collect::<Vec<_>>();
        let sets: &mut dyn Initiation<Vec<f32>, usize> = &mut family;
        sets.born(SkillId(1), &states(&[4.0, 5.0, 6.0]));
        sets.outcome(SkillId(1), &states(&[3.0, 2.0]), true);
        sets.outcome(SkillId(1), &states(&[2.0, 0.0]), false);
        family
    }

    #[test]
    fn one_may_start_where_it_may_work_and_aim_where_it_did() {
        let family = learn(Nearest::new(1.5), Nearest::new(0.5));
        // 2 led to the subgoal once and failed once; 7 is next to a success; 1 is as near to a failure, and 0 is one.
        assert_eq!(tell(&family), [vec![1, 2, 3, 4, 5, 6, 7], vec![3, 4, 5, 6]]);
    }

    #[test]
    fn machines_are_as_the_authors_have_them() {
        let optimistic =
            Svm::new(SvmConfig { nu: 0.01, two_class: TwoClassRule::Plain, ..SvmConfig::default() });
        let [may, aim] = tell(&learn(optimistic, Svm::default()));
        assert!(
            aim.iter().all(|x| may.contains(x)) && aim.contains(&5) && !may.contains(&0),
            "{may:?} {aim:?}"
        );
        assert!(!aim.contains(&9), "a one-class machine is closed");
    }

    #[test]
    fn what_is_saved_is_what_is_restored() {
        let family = learn(Nearest::new(1.5), Nearest::new(0.5));
        let mut bag = Bag::default();
        family.save(&mut bag);
        let mut again = Dual::new(Arc::new(Select::new(&[0])), Nearest::new(1.5), Nearest::new(0.5), 100);
        again.load(&bag).unwrap();
        assert_eq!(tell(&again), tell(&family));
        assert_eq!(Initiation::<Vec<f32>, usize>::examples(&again, SkillId(1)), (5, 2));
    }
}
