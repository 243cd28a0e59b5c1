//! A learner of the task's reward plus a bonus for what is new: π_novelty and V_novelty of thesis 7.2.2.1 and 7.2.2.6,
//! and, without a bonus, every flat baseline.

use crate::{
    Bag, Checkpoint, Clip, Context, Corrupt, Experience, Lane, Learned, Learner, Lesson, Memory, Novelty,
    Practice, Running, experience::Rewards,
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
    practice: Practice,
}

impl<O, L> Curious<O, L> {
    /// A learner of the task's reward alone.
    pub fn new(learner: L, practice: Practice) -> Self {
        Self {
            learner,
            sober: None,
            novelty: None,
            weight: 0.0,
            centred: false,
            bonuses: Running::default(),
            practice,
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
        self.practice.updates()
    }

    /// The action at `s`.
    pub fn act<A>(&self, memory: &mut Memory, s: &O, ctx: &mut Context) -> A
    where
        L: Learner<O, A, ()>,
    {
        self.learner(ctx.explore).act(memory, s, None, ctx)
    }

    /// The actions of several lanes, all of which explore or none.
    pub fn act_all<A>(&self, lanes: &mut [Lane<'_, O, ()>]) -> Vec<A>
    where
        L: Learner<O, A, ()>,
    {
        self.learner(lanes.iter().all(|lane| lane.ctx.explore)).act_all(lanes)
    }

    /// Whether somebody who acts must now note what it remembers ([`Experience::note`]), before it sees observation
    /// number `step` of an episode.
    pub fn notes_at(&self, step: u32) -> bool {
        self.practice.replay().notes_at(step)
    }

    /// The newest step of an episode is a lesson, and perhaps time to learn.
    pub fn step<A>(&mut self, number: u64, all: &Experience<O, A>, ctx: &mut Context)
    where
        L: Learner<O, A, ()>,
    {
        let steps = all.length(number);
        let Some((episode, last)) = all.episode(number).zip(steps.checked_sub(1)) else { return };
        if let Some(novelty) = &mut self.novelty {
            if last == 0 {
                novelty.visit((number, 0), all, ctx);
            }
            novelty.visit((number, steps), all, ctx);
            self.bonuses.push(novelty.bonus(&episode.observations[steps as usize]));
        }
        if self.practice.replay().begins_at(last) {
            self.practice.push(Lesson::task(number, last));
        }
        let Self { learner, sober, novelty, weight, centred, bonuses, practice } = self;
        let usual = if *centred { bonuses.mean() } else { 0.0 };
        let scale = *weight / bonuses.deviation().max(SMALLEST);
        practice.step(learner.batch(), all, ctx, |clips, ctx| {
            if let Some(sober) = sober {
                // What it did not remember itself is not its memory.
                let own: Vec<_> = clips.iter().map(|clip| Clip { memory: &[], ..*clip }).collect();
                let learned = sober.learn(&own, ctx);
                ctx.check("loss of the policy that does not explore", learned.loss);
            }
            match novelty {
                None => learner.learn(clips, ctx),
                Some(novelty) => with_bonus(clips, |s| novelty.bonuses(s), usual, scale, learner, ctx),
            }
        });
    }
}

/// One update on clips whose steps pay `scale` · (bonus − `usual`) more each, but for those that terminate.
fn with_bonus<O, A, L: Learner<O, A, ()>>(
    clips: &[Clip<O, A, ()>],
    bonuses: impl Fn(&[&O]) -> Vec<f32>,
    usual: f32,
    scale: f32,
    learner: &mut L,
    ctx: &mut Context,
) -> Learned {
    let reached: Vec<&O> = clips.iter().flat_map(|clip| &clip.observations[clip.lead + 1..]).collect();
    let mut found = bonuses(&reached).into_iter();
    let sums: Vec<Vec<f32>> = clips
        .iter()
        .map(|clip| {
            let sum = |i: usize| {
                let bonus = found.next().unwrap_or(usual);
                let over = clip.terminal && i + 1 == clip.len();
                clip.reward(i) + if over { 0.0 } else { scale * (bonus - usual) }
            };
            (0..clip.len()).map(sum).collect()
        })
        .collect();
    let paid = clips.iter().zip(&sums).map(|(clip, sum)| Clip { rewards: Rewards::Given(sum), ..*clip });
    learner.learn(&paid.collect::<Vec<_>>(), ctx)
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
        bag.put("practice", &self.practice);
        bag.put("bonuses", &self.bonuses);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        bag.get_part("learner", &mut self.learner)?;
        if let Some(sober) = &mut self.sober {
            bag.get_part("sober", sober)?;
        }
        if let Some(novelty) = &mut self.novelty {
            bag.get_part("novelty", &mut **novelty)?;
        }
        self.practice = bag.get("practice")?;
        self.bonuses = bag.get("bonuses")?;
        Ok(())
    }
}
