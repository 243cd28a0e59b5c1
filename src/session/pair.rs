//! An agent and its environment, of kinds that are known.

use inroads_agents::{Actor, Bag, Context, Corrupt, Halt, episode};
use inroads_discovery::record::{GoalRecord, GraphRecord, PlanRecord, Query, SkillRecord};
use inroads_envs::{Annotated, Frame, Seed, Spec, check::Observed};

use super::{
    Action, BoxedEnvironment, EpisodeMetrics, PlanError, Protocol, Session, Spot, Stopped, Travelled,
    Watched, spot::Located, travel::Journey,
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
    env: BoxedEnvironment<O, A>,
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
    pub(super) fn new(env: BoxedEnvironment<O, A>, agent: BoxedAgent<O, A>, seed: Seed) -> Self {
        Self { env, agent, seed, episodes: 0, env_steps: 0 }
    }

    /// Begins evaluation episode number `index`; its first observation.
    fn first(&mut self, index: u64) -> O {
        let mut first = O::default();
        self.env.reset(self.seed.number("evaluate-start", index));
        self.env.observe(&mut first);
        first
    }
}

impl<O: Seen, A: Clone + Into<Action>> Session for Pair<O, A> {
    fn spec(&self) -> &Spec {
        self.env.spec()
    }

    fn train(&mut self) -> Result<EpisodeMetrics, Stopped> {
        let number = self.episodes;
        let mut ctx = Context::training(self.seed, number);
        let mut skill_steps = 0;
        let start = self.seed.number("train-start", number);
        let summary = episode(&mut *self.env, &mut *self.agent, start, &mut ctx, |_, source| {
            skill_steps += u32::from(source > 0);
        })
        .map_err(|halt| stopped(number, self.env_steps, halt))?;
        self.episodes += 1;
        self.env_steps += u64::from(summary.steps);
        Ok(EpisodeMetrics {
            episode: number,
            env_steps: self.env_steps,
            steps: summary.steps,
            reward: summary.reward,
            success: summary.success,
            skills: self.agent.skills().len(),
            skill_steps,
            updates: self.agent.updates().into_iter().map(|(name, n)| (name.to_owned(), n)).collect(),
            fault: summary.fault,
        })
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
        let summary = episode(&mut *self.env, &mut *actor, start, &mut ctx, |t, source| {
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
        let [from_place, to_place] = [from, to].map(|spot| spot.located(&first, &graph, self.env.spec()));
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
        let [from, to] = [from, to].map(|spot| spot.located(&first, &graph, self.env.spec()));
        let mut journey = Journey::new(&*self.agent, [from?, to?])?;
        let mut ctx = Context::evaluation(self.seed, index);
        let start = self.seed.number("evaluate-start", index);
        let summary = episode(&mut *self.env, &mut journey, start, &mut ctx, |_, _| ())
            .map_err(|halt| stopped(index, 0, halt))?;
        let [departed, arrived] = journey.reached();
        Ok(Travelled { departed, arrived, summary })
    }

    fn members(&self, observation: &Vector) -> Vec<bool> {
        O::wholly(observation).map_or_else(Vec::new, |observation| self.agent.members(observation))
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
