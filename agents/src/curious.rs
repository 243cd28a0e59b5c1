//! A learner of the task's reward plus a bonus for what is new: π_novelty and V_novelty of thesis 7.2.2.1 and 7.2.2.6,
//! and, without a bonus, every flat baseline.

use crate::{
    Bag, Checkpoint, Clip, Context, Corrupt, Experience, Learner, Lesson, Memory, Novelty, Pace, Replay,
    Running, experience::Rewards,
};

/// A learner that sees every step of an agent's life once, and learns R + b · r_novelty.
///
/// Who does not explore may act on a second learner, which learns the task's reward alone from the same steps: a bonus
/// keeps its hold on who no longer counts, for good, where it has visited least.
///
/// The bonus is divided by the running standard deviation of all bonuses (`decisions.md`), and computed anew whenever a
/// step is replayed. A step that terminates the episode has none: nobody explores from there.
pub struct Curious<O, L> {
    learner: L,
    /// Learns the task's reward alone, for who does not explore.
    sober: Option<L>,
    novelty: Option<Box<dyn Novelty<O>>>,
    /// b.
    weight: f32,
    /// Whether the mean of all bonuses is taken from each.
    centred: bool,
    /// Of all bonuses when they were first seen.
    bonuses: Running,
    replay: Replay,
    pace: Pace,
    steps: u64,
    updates: u64,
}

impl<O, L> Curious<O, L> {
    /// A learner of the task's reward alone, which remembers about `capacity` steps.
    pub fn new(learner: L, capacity: usize, pace: Pace) -> Self {
        Self {
            learner,
            sober: None,
            novelty: None,
            weight: 0.0,
            centred: false,
            bonuses: Running::default(),
            replay: Replay::new(capacity),
            pace,
            steps: 0,
            updates: 0,
        }
    }

    /// The same with a bonus, which weighs `weight` (b; 0.01 in the thesis).
    pub fn with_novelty(self, novelty: Box<dyn Novelty<O>>, weight: f32) -> Self {
        Self { novelty: Some(novelty), weight, ..self }
    }

    /// The same where a bonus counts by how far it is above the mean of all bonuses so far (the authors' normalisation).
    /// Without it a bonus never ends, and where success ends the episode, to live on and collect may be worth more.
    pub fn centred(self, centred: bool) -> Self {
        Self { centred, ..self }
    }

    /// The same with returns of up to `steps` steps.
    pub fn spanning(self, steps: u32) -> Self {
        Self { replay: self.replay.spanning(steps), ..self }
    }

    /// The same with a second learner, as young as the first, of the task's reward alone, for who does not explore.
    pub fn sober(self, learner: L) -> Self {
        Self { sober: Some(learner), ..self }
    }

    /// What who explores acts on, or who does not.
    pub fn learner(&self, explore: bool) -> &L {
        match &self.sober {
            Some(sober) if !explore => sober,
            _ => &self.learner,
        }
    }

    /// r_novelty(s), 0 where nobody counts.
    pub fn bonus(&self, s: &O) -> f32 {
        self.novelty.as_ref().map_or(0.0, |novelty| novelty.bonus(s))
    }

    /// Mean and spread of all bonuses, each as it was when its state was visited (equation 7.8).
    pub fn bonuses(&self) -> &Running {
        &self.bonuses
    }

    /// Minibatch updates made so far.
    pub fn updates(&self) -> u64 {
        self.updates
    }

    /// The action at `s`.
    pub fn act<A>(&self, memory: &mut Memory, s: &O, ctx: &mut Context) -> A
    where
        L: Learner<O, A, ()>,
    {
        self.learner(ctx.explore).act(memory, s, None, ctx)
    }

    /// The newest step of the experience is a lesson, and perhaps time to learn.
    pub fn step<A>(&mut self, all: &Experience<O, A>, ctx: &mut Context)
    where
        L: Learner<O, A, ()>,
    {
        let number = all.latest();
        let Some((episode, seen)) = all.episode(number).and_then(|e| Some((e, e.observations.last()?)))
        else {
            return;
        };
        if let Some(novelty) = &mut self.novelty {
            if let [first, _] = &episode.observations[..] {
                novelty.visit(first, ctx);
            }
            novelty.visit(seen, ctx);
            self.bonuses.push(novelty.bonus(seen));
        }
        self.replay.forget_before(all.first());
        self.replay.push(Lesson::task(number, episode.actions.len() as u32 - 1));
        self.steps += 1;
        if self.replay.len() >= self.pace.warm_up.max(self.learner.batch()) {
            for _ in 0..self.pace.due(self.steps) {
                self.update(all, ctx);
            }
        }
    }

    fn update<A>(&mut self, all: &Experience<O, A>, ctx: &mut Context)
    where
        L: Learner<O, A, ()>,
    {
        let batch = self.learner.batch();
        let mut clips: Vec<Clip<O, A, ()>> = Vec::with_capacity(batch);
        self.replay.sample(all, batch, &mut ctx.learning, &mut clips);
        self.updates += 1;
        if let Some(sober) = &mut self.sober {
            sober.learn(&clips, ctx);
        }
        let Some(novelty) = &self.novelty else {
            self.learner.learn(&clips, ctx);
            return;
        };
        let usual = if self.centred { self.bonuses.mean() } else { 0.0 };
        let scale = self.weight / self.bonuses.deviation().max(SMALLEST);
        let sums: Vec<Vec<f32>> = clips
            .iter()
            .map(|clip| {
                let bonus = |i: usize| {
                    let over = clip.terminal && i + 1 == clip.actions.len();
                    if over { 0.0 } else { scale * (novelty.bonus(&clip.observations[i + 1]) - usual) }
                };
                (0..clip.actions.len()).map(|i| clip.reward(i) + bonus(i)).collect()
            })
            .collect();
        for (clip, sum) in clips.iter_mut().zip(&sums) {
            clip.rewards = Rewards::Given(sum);
        }
        self.learner.learn(&clips, ctx);
    }
}

/// The least spread that bonuses are divided by: while all are alike, none is scaled up without bound.
const SMALLEST: f32 = 0.01;

impl<O, L: Checkpoint> Checkpoint for Curious<O, L> {
    fn save(&self, bag: &mut Bag) {
        bag.put_part("learner", &self.learner);
        if let Some(sober) = &self.sober {
            bag.put_part("sober", sober);
        }
        if let Some(novelty) = &self.novelty {
            bag.put_part("novelty", &**novelty);
        }
        bag.put("replay", &self.replay);
        bag.put("counts", &(self.bonuses, self.steps, self.updates));
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        bag.get_part("learner", &mut self.learner)?;
        if let Some(sober) = &mut self.sober {
            bag.get_part("sober", sober)?;
        }
        if let Some(novelty) = &mut self.novelty {
            bag.get_part("novelty", &mut **novelty)?;
        }
        self.replay = bag.get("replay")?;
        (self.bonuses, self.steps, self.updates) = bag.get("counts")?;
        Ok(())
    }
}
