//! Visits with the coins that were flipped at them, drawn by priority.

use std::collections::VecDeque;

use inroads_envs::Rng;
use rand::RngExt;
use serde::{Deserialize, Serialize};

use crate::{experience::Moment, replay::SumTree};

/// A visit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Visit {
    /// Where the state is to be found.
    pub(super) at: Moment,
    /// A bit a coin, flipped once and for all.
    pub(super) coins: u32,
    /// How often it was learned from.
    replays: u32,
}

/// Visits, oldest first.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Visits {
    visits: VecDeque<Visit>,
    /// Visits before the first of them.
    gone: u64,
    capacity: usize,
    /// Priorities. A ring: visit number `n` stands at `n` modulo the number of places.
    tree: SumTree,
}

/// The priority of a visit that was learned from so often, where the bonus squared was `share` when it last was:
/// ½/(n+1) + ½ min(f̄², 1) (Lobel 2023, section 4.3; clipped in the authors' later code). A new one has 1.
fn priority(replays: u32, share: f32) -> f64 {
    0.5 / (f64::from(replays) + 1.0) + 0.5 * f64::from(share.clamp(0.0, 1.0))
}

impl Visits {
    pub(super) fn new(capacity: usize) -> Self {
        Self { visits: VecDeque::new(), gone: 0, capacity, tree: SumTree::new(1024) }
    }

    pub(super) fn len(&self) -> usize {
        self.visits.len()
    }

    /// The newest ones, so many of them.
    pub(super) fn newest(&self, n: usize) -> impl Iterator<Item = &Visit> {
        self.visits.range(self.len().saturating_sub(n)..)
    }

    fn place(&self, number: u64) -> usize {
        (number % self.tree.places() as u64) as usize
    }

    /// One more; the oldest falls out where there are too many.
    pub(super) fn push(&mut self, at: Moment, coins: u32) {
        if self.len() >= self.capacity.max(1) {
            self.drop_oldest();
        }
        if self.len() == self.tree.places() {
            let old: Vec<_> = (self.gone..).take(self.len()).map(|n| self.tree.get(self.place(n))).collect();
            self.tree = SumTree::new(2 * old.len());
            (self.gone..).zip(old).for_each(|(n, weight)| self.tree.set(self.place(n), weight));
        }
        let number = self.gone + self.len() as u64;
        self.visits.push_back(Visit { at, coins, replays: 0 });
        self.tree.set(self.place(number), priority(0, 1.0));
    }

    fn drop_oldest(&mut self) {
        if self.visits.pop_front().is_some() {
            self.tree.set(self.place(self.gone), 0.0);
            self.gone += 1;
        }
    }

    /// Drops visits of episodes before that one. Where episodes go on side by side, some stay behind one that is newer;
    /// they are left out when they are [drawn](Self::draw).
    pub(super) fn forget_before(&mut self, episode: u64) {
        while self.visits.front().is_some_and(|visit| visit.at.0 < episode) {
            self.drop_oldest();
        }
    }

    /// The numbers of `n` visits, each drawn from a part of the total of its own, and less where some are forgotten:
    /// those are never drawn again.
    pub(super) fn draw(&mut self, n: usize, rng: &mut Rng, kept: impl Fn(Moment) -> bool) -> Vec<u64> {
        if self.visits.is_empty() {
            return Vec::new();
        }
        let (part, places) = (self.tree.total() / n as f64, self.tree.places() as u64);
        let drawn: Vec<u64> = (0..n)
            .map(|i| {
                let place = self.tree.find((i as f64 + rng.random::<f64>()) * part) as u64;
                self.gone + (place + places - self.gone % places) % places
            })
            .collect();
        let known = |number: &u64| match self.get(*number).filter(|visit| kept(visit.at)) {
            Some(_) => true,
            None => {
                self.tree.set((number % places) as usize, 0.0);
                false
            }
        };
        drawn.into_iter().filter(known).collect()
    }

    /// The visit of that number.
    pub(super) fn get(&self, number: u64) -> Option<Visit> {
        self.visits.get(usize::try_from(number.checked_sub(self.gone)?).ok()?).copied()
    }

    /// These were learned from, where the bonus squared was so and so.
    pub(super) fn revise(&mut self, numbers: &[u64], shares: &[f32]) {
        for (&number, &share) in numbers.iter().zip(shares) {
            let index = (number - self.gone) as usize;
            if let (Some(visit), true) = (self.visits.get_mut(index), share.is_finite()) {
                visit.replays = visit.replays.saturating_add(1);
                let weight = priority(visit.replays, share);
                self.tree.set(self.place(number), weight);
            }
        }
    }

    /// Flips all coins anew: what must not be done.
    #[cfg(test)]
    pub(super) fn flip_again(&mut self, rng: &mut Rng) {
        self.visits.iter_mut().for_each(|visit| visit.coins = rng.random());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::Seed;

    fn weights(visits: &Visits) -> Vec<f64> {
        (visits.gone..).take(visits.len()).map(|n| visits.tree.get(visits.place(n))).collect()
    }

    #[test]
    fn a_priority_is_of_how_seldom_it_was_seen_and_how_new_it_looks() {
        let mut visits = Visits::new(10);
        (0..3).for_each(|step| visits.push((0, step), 0));
        assert_eq!(weights(&visits), [1.0; 3], "new ones come first");
        // ½/(n+1) + ½·f̄² after the first replay, and after the second; never more than 1 of f̄².
        visits.revise(&[0, 1], &[0.25, 4.0]);
        assert_eq!(weights(&visits), [0.25 + 0.125, 0.25 + 0.5, 1.0]);
        visits.revise(&[0], &[0.0]);
        assert_eq!(weights(&visits)[0], 0.5 / 3.0);
    }

    #[test]
    fn they_are_drawn_in_proportion() {
        let mut visits = Visits::new(10);
        (0..2).for_each(|step| visits.push((0, step), 0));
        visits.revise(&[0], &[0.5]);
        let drawn = visits.draw(3000, &mut Seed(0).stream("test", 0), |_| true);
        let first = drawn.iter().filter(|number| **number == 0).count();
        // 0.5 against 1: a third of them.
        assert!(first.abs_diff(1000) <= 2, "{first}: each is drawn from a part of its own");
    }

    #[test]
    fn what_is_forgotten_is_never_drawn_and_the_ring_grows() {
        let mut visits = Visits::new(5000);
        for step in 0..1000 {
            visits.push((3, step), step);
            // Two episodes side by side: the older one ends up behind the newer.
            visits.push((2, step), step);
        }
        visits.push((4, 0), 7);
        assert_eq!((visits.len(), visits.tree.places()), (2001, 2048));
        visits.forget_before(3);
        assert_eq!(visits.len(), 2001, "the first visit is of an episode that is still there");
        let rng = &mut Seed(0).stream("test", 0);
        for _ in 0..30 {
            let drawn = visits.draw(500, rng, |(episode, _)| episode > 2);
            assert!(drawn.iter().all(|number| visits.get(*number).unwrap().at.0 > 2));
        }
        assert!(visits.draw(500, rng, |(episode, _)| episode > 2).len() > 490);
        visits.forget_before(4);
        assert_eq!((visits.len(), visits.draw(3, rng, |_| true)), (1, vec![2000; 3]));
        assert_eq!(visits.get(2000).map(|visit| visit.coins), Some(7));
        let mut few = Visits::new(2);
        (0..5).for_each(|step| few.push((0, step), step));
        assert_eq!(few.newest(9).map(|visit| visit.at.1).collect::<Vec<_>>(), [3, 4]);
    }
}
