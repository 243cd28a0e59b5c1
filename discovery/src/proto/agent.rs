//! The agent of chapter 8, from its parts.

use inroads_agents::{
    Agent, Bag, Checkpoint, Context, Corrupt, Experience, Lesson, Memory, Transition,
    experience::{Aim, Episode},
};
use inroads_envs::{Annotated, Rng};
use rand::RngExt;

use super::{
    GoalId, GoalSpace, ProtoConfig, SeekAvoid,
    evaluator::{evaluate, records},
    hindsight, pursuit,
    recombine::recombine,
};
use crate::{
    Call, Discovery, Goal, Hierarchy, Outcome, SkillId, SkillPolicy, Skilled, Stop, Wanted,
    execution::Driver, hindsight::lessons, record::GoalRecord,
};

/// Pursues goals out of a space that it prunes and extends, with the policies of `P` and the judgement of `E`.
///
/// The task's own reward is one more thing to pursue, without a goal: it has a share of the decisions in training and all of
/// them when it is watched (8.4.1.2).
pub struct ProtoGoalAgent<P, E> {
    config: ProtoConfig,
    space: GoalSpace,
    policy: P,
    judge: E,
    /// Steps of the environment so far.
    steps: u64,
}

impl<P, E> ProtoGoalAgent<P, E> {
    /// An agent that knows no goals yet; `policy` must be as young.
    pub fn new(config: &ProtoConfig, policy: P, judge: E) -> Self {
        let space = GoalSpace::new(config.window);
        Self { config: config.clone(), space, policy, judge, steps: 0 }
    }

    /// The goal space.
    pub fn space(&self) -> &GoalSpace {
        &self.space
    }

    /// The skill that pursues a goal. Its number is the goal's plus one, for 0 is the task's.
    fn skill(id: GoalId) -> SkillId {
        SkillId(id.0 + 1)
    }

    /// The goal that a skill pursues; none of the task's.
    fn goal(skill: SkillId) -> Option<GoalId> {
        skill.0.checked_sub(1).map(GoalId)
    }

    /// A call is over: its steps teach what it was for, the task, and some of what they attained on the way.
    fn look_back<O, A>(&mut self, out: &Outcome<Wanted>, episode: &Episode<Annotated<O>, A>, rng: &mut Rng)
    where
        P: SkillPolicy<Annotated<O>, A, Wanted>,
    {
        let about =
            |aim, goal| Lesson { episode: out.episode, steps: out.steps.clone(), aim, goal, rewards: None };
        self.policy.lesson(SkillId::GLOBAL, about(Aim::Task, None));
        if out.call.goal.is_some() {
            let aim = Aim::Subgoal { attained: out.stop == Stop::Reached };
            self.policy.lesson(out.call.skill, about(aim, out.call.goal.clone()));
        }
        let path = &episode.observations[out.steps.start as usize..=out.steps.end as usize];
        let bits: Vec<_> = path.iter().map(|s| &s.bits).collect();
        for id in hindsight::goals(&self.space, &bits, &self.config, rng) {
            if Self::skill(id) == out.call.skill {
                continue;
            }
            for lesson in lessons(&self.space.goal(id).wanted, out.episode, episode, out.steps.clone()) {
                self.policy.lesson(Self::skill(id), lesson);
            }
        }
    }
}

impl<O, A, P, E> Discovery<Annotated<O>, A> for ProtoGoalAgent<P, E>
where
    P: SkillPolicy<Annotated<O>, A, Wanted>,
    E: SeekAvoid<O, A>,
{
    type Goal = Wanted;
    type Lane = Driver;

    fn decide(
        &self,
        lane: &mut Driver,
        s: &Annotated<O>,
        _: &Experience<Annotated<O>, A>,
        ctx: &mut Context,
    ) -> Call<Wanted> {
        let values = |few: &[GoalId]| {
            let calls: Vec<_> =
                few.iter().map(|id| (Self::skill(*id), Some(&self.space.goal(*id).wanted))).collect();
            self.policy.values(&Memory::new(), s, &calls)
        };
        let chosen = if ctx.explore && ctx.acting.random::<f32>() >= self.config.task_share {
            pursuit::choose(&self.space, &s.bits, &self.config, values, &mut ctx.acting)
        } else {
            None
        };
        let skill = chosen.map_or(SkillId::GLOBAL, Self::skill);
        lane.hand_to(skill);
        let goal = chosen.map(|id| self.space.goal(id).wanted.clone());
        Call { skill, goal, budget: self.config.horizon }
    }

    fn act(&self, lane: &mut Driver, call: &Call<Wanted>, s: &Annotated<O>, ctx: &mut Context) -> A {
        self.policy.act(lane.memory(), call, s, ctx)
    }

    fn reached(&self, call: &Call<Wanted>, t: &Transition<Annotated<O>, A>) -> bool {
        call.goal.as_ref().is_some_and(|goal| goal.reached(t.after))
    }

    fn finished(
        &mut self,
        _: &mut Driver,
        out: &Outcome<Wanted>,
        all: &Experience<Annotated<O>, A>,
        ctx: &mut Context,
    ) {
        if let Some(id) = Self::goal(out.call.skill) {
            self.space.goal_mut(id).pursuits.push(out.stop == Stop::Reached);
        }
        if let Some(episode) = all.episode(out.episode) {
            self.look_back(out, episode, &mut ctx.learning);
        }
    }

    fn learn(&mut self, call: &Call<Wanted>, all: &Experience<Annotated<O>, A>, ctx: &mut Context) {
        self.steps += 1;
        let newest = all.episode(all.latest()).and_then(|episode| {
            let [.., before, after] = &episode.observations[..] else { return None };
            Some((before, after, *episode.rewards.last()?))
        });
        if let Some((before, after, reward)) = newest {
            self.space.count(&before.bits, &after.bits, reward);
        }
        if self.steps.is_multiple_of(self.config.evaluate_every) {
            recombine(&mut self.space, &self.config);
            evaluate(&mut self.space, &self.judge, all, &mut ctx.learning);
        }
        self.policy.step(call.skill, all, ctx);
    }

    fn updates(&self) -> Vec<(&'static str, u64)> {
        vec![("skills", self.policy.updates())]
    }
}

impl<P: Checkpoint, E> Checkpoint for ProtoGoalAgent<P, E> {
    fn save(&self, bag: &mut Bag) {
        bag.put("space", &self.space);
        bag.put("steps", &self.steps);
        bag.put_part("policy", &self.policy);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        self.space = bag.get("space")?;
        self.steps = bag.get("steps")?;
        bag.get_part("policy", &mut self.policy)
    }
}

impl<O, A, P, E> Skilled<Annotated<O>, A> for Hierarchy<Annotated<O>, A, ProtoGoalAgent<P, E>>
where
    O: Clone,
    A: Clone,
    ProtoGoalAgent<P, E>: Discovery<Annotated<O>, A>,
    Self: Agent<Annotated<O>, A>,
{
    fn goals(&self) -> Vec<GoalRecord> {
        let method = self.method();
        records(&method.space, &method.config)
    }
}
