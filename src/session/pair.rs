//! An agent and its environments, of kinds that are known.

use std::collections::BTreeMap;

use inroads_agents::{Actor, Bag, Context, Corrupt, Halt, Summary, Transition, episode, lanes::Alone, round};
use inroads_discovery::record::{GoalRecord, GraphRecord, PlanRecord, Query, SkillRecord};
use inroads_envs::{Annotated, Frame, Seed, Spec, check::Observed, registry::AnyEnvironment};

use super::{
    Action, Attempt, BoxedEnvironment, EpisodeMetrics, PlanError, Protocol, Session, Spot, Stopped,
    Travelled, Watched,
    attempt::{Kind, attempt},
    spot::Located,
    travel::Journey,
};
use crate::assembly::{BoxedAgent, Vector};

/// An observation, perhaps with a vector in it, which figures are drawn from.
pub(super) trait Seen: Observed {
    /// What is seen, as numbers; none where it is a picture.
    fn seen(&self) -> Option<&Vector>;

    /// The observation in which this is seen; none where that is not all there is to know of it.
    fn wholly(seen: &Vector) -> Option<&Self>;
}

impl Seen for Vector {
    fn seen(&self) -> Option<&Vector> {
        Some(self)
    }

    fn wholly(seen: &Vector) -> Option<&Self> {
        Some(seen)
    }
}

impl Seen for Frame {
    fn seen(&self) -> Option<&Vector> {
        None
    }

    fn wholly(_: &Vector) -> Option<&Self> {
        None
    }
}

impl Seen for Annotated<Vector> {
    fn seen(&self) -> Option<&Vector> {
        Some(&self.seen)
    }

    fn wholly(_: &Vector) -> Option<&Self> {
        None
    }
}

pub(super) struct Pair<O, A> {
    /// One a lane.
    envs: Vec<BoxedEnvironment<O, A>>,
    /// The one that evaluations are played in, where training episodes begin elsewhere; else the first lane's is.
    stage: Option<BoxedEnvironment<O, A>>,
    agent: BoxedAgent<O, A>,
    seed: Seed,
    episodes: u64,
    env_steps: u64,
}

/// Which episode stopped, and after how many steps since those before it.
fn stopped(episode: u64, before: u64, Halt { step, fault }: Halt) -> Stopped {
    Stopped { episode, step: before + u64::from(step), fault }
}

impl<O: Seen, A: Clone> Pair<O, A> {
    pub(super) fn new(
        envs: Vec<BoxedEnvironment<O, A>>,
        stage: Option<BoxedEnvironment<O, A>>,
        agent: BoxedAgent<O, A>,
        seed: Seed,
    ) -> Self {
        Self { envs, stage, agent, seed, episodes: 0, env_steps: 0 }
    }

    /// Begins evaluation episode number `index`; its first observation.
    fn first(&mut self, index: u64) -> O {
        let mut first = O::default();
        let stage = self.stage.as_mut().unwrap_or(&mut self.envs[0]);
        stage.reset(self.seed.number("evaluate-start", index));
        stage.observe(&mut first);
        first
    }
}

impl<O: Kind<A>, A: Clone + Into<Action>> Session for Pair<O, A> {
    fn spec(&self) -> &Spec {
        self.envs[0].spec()
    }

    fn train(&mut self) -> Result<Vec<EpisodeMetrics>, Stopped> {
        let numbers = self.episodes..self.episodes + self.envs.len() as u64;
        let starts: Vec<_> = numbers.clone().map(|n| self.seed.number("train-start", n)).collect();
        let mut ctxs: Vec<_> = numbers.clone().map(|n| Context::training(self.seed, n)).collect();
        let mut skill_steps = vec![0; self.envs.len()];
        let watch =
            |lane: usize, _: &Transition<'_, O, A>, source| skill_steps[lane] += u32::from(source > 0);
        let summaries = match self.agent.crowd() {
            Some(crowd) => round(&mut self.envs, crowd, &starts, &mut ctxs, watch),
            None => round(&mut self.envs, &mut Alone(&mut *self.agent), &starts, &mut ctxs, watch),
        }
        .map_err(|(lane, halt)| stopped(numbers.start + lane as u64, self.env_steps, halt))?;
        let updates: BTreeMap<_, _> =
            self.agent.updates().into_iter().map(|(name, n)| (name.to_owned(), n)).collect();
        let skills = self.agent.skills().len();
        let line = |((number, summary), skill_steps): ((u64, Summary), u32)| {
            self.episodes += 1;
            self.env_steps += u64::from(summary.steps);
            EpisodeMetrics {
                episode: number,
                env_steps: self.env_steps,
                steps: summary.steps,
                reward: summary.reward,
                success: summary.success,
                skills,
                skill_steps,
                updates: updates.clone(),
                fault: summary.fault,
            }
        };
        Ok(numbers.zip(summaries).zip(skill_steps).map(line).collect())
    }

    fn progress(&self) -> (u64, u64) {
        (self.episodes, self.env_steps)
    }

    fn evaluate(&mut self, protocol: Protocol, index: u64) -> Result<Option<Watched>, Stopped> {
        let actor: Option<Box<dyn Actor<O, A> + '_>> = match protocol {
            Protocol::Frozen => Some(self.agent.frozen()),
            Protocol::ChainAlone => self.agent.chain_alone(),
        };
        let Some(mut actor) = actor else { return Ok(None) };
        let mut ctx = Context::evaluation(self.seed, index);
        let start = self.seed.number("evaluate-start", index);
        let (mut path, mut skills, mut actions, mut covered) = (Vec::new(), Vec::new(), Vec::new(), false);
        let stage = self.stage.as_mut().unwrap_or(&mut self.envs[0]);
        let summary = episode(&mut **stage, &mut *actor, start, &mut ctx, |t, source| {
            if skills.is_empty() {
                path.extend(t.before.seen().cloned());
                covered = self.agent.members(t.before).contains(&true);
            }
            path.extend(t.after.seen().cloned());
            skills.push(source);
            actions.push(t.action.clone().into());
        })
        .map_err(|halt| stopped(index, 0, halt))?;
        Ok(Some(Watched { path, skills, start, actions, covered, summary }))
    }

    fn skills(&self) -> Vec<SkillRecord> {
        self.agent.skills()
    }

    fn graph(&self) -> Option<GraphRecord> {
        self.agent.graph()
    }

    fn goals(&self) -> Vec<GoalRecord> {
        self.agent.goals()
    }

    fn plan(&mut self, from: &Spot, to: &Spot) -> Result<PlanRecord, PlanError> {
        let first = self.first(0);
        let graph = self.agent.graph().ok_or(PlanError::NoGraph)?;
        let [from_place, to_place] = [from, to].map(|spot| spot.located(&first, &graph, self.envs[0].spec()));
        let (from_place, to_place) = (from_place?, to_place?);
        if let Located::State(s, _) = &from_place
            && to_place.holds(&*self.agent, s)
        {
            return Ok(PlanRecord { case: Query::Inside, legs: Vec::new(), outside: 1.0 });
        }
        let plan = self.agent.plan(&from_place.place(), &to_place.place());
        plan.ok_or_else(|| PlanError::NoWay { from: from.clone(), to: to.clone() })
    }

    fn travel(&mut self, from: &Spot, to: &Spot, index: u64) -> Result<Travelled, PlanError> {
        let first = self.first(index);
        let graph = self.agent.graph().ok_or(PlanError::NoGraph)?;
        let [from, to] = [from, to].map(|spot| spot.located(&first, &graph, self.envs[0].spec()));
        let mut journey = Journey::new(&*self.agent, [from?, to?])?;
        let mut ctx = Context::evaluation(self.seed, index);
        let start = self.seed.number("evaluate-start", index);
        let stage = self.stage.as_mut().unwrap_or(&mut self.envs[0]);
        let summary = episode(&mut **stage, &mut journey, start, &mut ctx, |_, _| ())
            .map_err(|halt| stopped(index, 0, halt))?;
        let [departed, arrived] = journey.reached();
        Ok(Travelled { departed, arrived, summary })
    }

    fn members(&self, observation: &Vector) -> Vec<bool> {
        O::wholly(observation).map_or_else(Vec::new, |observation| self.agent.members(observation))
    }

    fn targets(&self, observation: &Vector) -> Vec<bool> {
        O::wholly(observation).map_or_else(Vec::new, |observation| self.agent.targets(observation))
    }

    fn attempt(
        &self,
        skill: u32,
        env: &mut AnyEnvironment,
        start: u64,
        index: u64,
    ) -> Result<Option<Attempt>, Stopped> {
        let Some(env) = O::of(env) else { return Ok(None) };
        let mut ctx = Context::evaluation(Seed(self.seed.number("attempt", u64::from(skill))), index);
        attempt(&*self.agent, env, skill, start, &mut ctx).map_err(|halt| stopped(index, 0, halt))
    }

    fn save(&self) -> Bag {
        let mut bag = Bag::default();
        bag.put("progress", &(self.episodes, self.env_steps));
        bag.put_part("agent", &*self.agent);
        bag
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        (self.episodes, self.env_steps) = bag.get("progress")?;
        bag.get_part("agent", &mut *self.agent)
    }
}
