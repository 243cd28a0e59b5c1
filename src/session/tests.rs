//! Plans and journeys of an agent whose graph is known; what there is to know of one that sees pictures.

use inroads_discovery::record::{GraphRecord, Query};
use inroads_envs::{Dimension, Environment, Frame, Refused, Seed, Space, Spec, Step, TimeLimit};

use super::{PlanError, Protocol, Session, Spot, Stopped, stub};
use crate::config::Config;

#[test]
fn a_plan_tells_its_vertices_and_how_probable_it_is() {
    let mut session = stub::session();
    let plan = session.plan(&Spot::Start, &Spot::At(vec![2.0])).unwrap();
    assert_eq!((plan.case, &plan.legs), (Query::Inside, &vec![(1, 0.5), (2, 0.5)]));
    assert_eq!(plan.probability(), 0.25);
    assert!(session.plan(&Spot::Vertex(3), &Spot::Vertex(3)).unwrap().legs.is_empty());
    let plan = session.plan(&Spot::Start, &Spot::Start).unwrap();
    assert_eq!((plan.case, plan.legs.len(), plan.outside), (Query::Inside, 0, 1.0), "it is there already");
}

#[test]
fn what_is_no_place_and_where_no_way_leads_is_said() {
    let mut session = stub::session();
    let mut why = |to: Spot| session.plan(&Spot::Start, &to).unwrap_err().to_string();
    assert_eq!(why(Spot::Vertex(7)), "there is no vertex 7; the graph has 5 from 0 to 4");
    assert_eq!(why(Spot::At(vec![1.0, 2.0])), "2 coordinates say no place in `corridor-5`; give 1: cell");
    assert_eq!(why(Spot::At(vec![7.0])), "cell is 7, outside `corridor-5`: it goes from 0 to 4");
    assert!(why(Spot::Goal).starts_with("no way leads from the start to the goal on the skill graph"));
    assert!(session.travel(&Spot::Vertex(7), &Spot::Start, 0).is_err());
}

#[test]
fn an_agent_without_a_graph_has_no_plan() {
    let config = Config::defaults("q-learning", "corridor-5").unwrap();
    let mut session = super::build(&config).unwrap();
    assert_eq!(session.plan(&Spot::Start, &Spot::Goal), Err(PlanError::NoGraph));
    assert_eq!(session.travel(&Spot::Start, &Spot::Goal, 0), Err(PlanError::NoGraph));
}

#[test]
fn a_journey_departs_from_where_its_plan_begins_and_counts_from_there() {
    let mut session = stub::session();
    let mut travel = |from, to| {
        let journey = session.travel(&from, &to, 3).unwrap();
        (journey.departed, journey.arrived, journey.summary.steps)
    };
    // Cell 4 ends the episode; otherwise 50 steps do, with the walker about the place where it should be.
    assert_eq!(travel(Spot::Start, Spot::Vertex(2)), (Some(0), Some(2), 50));
    assert_eq!(travel(Spot::Vertex(3), Spot::Vertex(1)), (Some(3), Some(5), 50));
    assert_eq!(travel(Spot::Vertex(2), Spot::At(vec![2.0])), (Some(2), Some(2), 50));
    assert_eq!(travel(Spot::Start, Spot::Goal), (Some(0), Some(4), 4));
    assert_eq!(travel(Spot::Goal, Spot::Vertex(1)), (Some(4), None, 4));
}

#[test]
fn of_pictures_there_are_no_coordinates_to_be_watched_or_planned_to() {
    let config = Config::defaults("q-learning", "door-key-5x5").unwrap();
    let config = config.with_assignment("world.see=\"rgb\"").unwrap().fitted().unwrap();
    let mut session = super::build(&config).unwrap();
    session.train().unwrap();
    let watched = session.evaluate(Protocol::Frozen, 0).unwrap().unwrap();
    assert_eq!(watched.path, [[0.0; 0]; 0]);
    assert_eq!((watched.acted().len(), watched.skills.len()), (0, watched.actions.len()));
    assert!(session.members(&vec![1.0]).is_empty());
    assert_eq!(session.plan(&Spot::Start, &Spot::Goal), Err(PlanError::NoGraph));

    let (first, other) = (Frame::new([2, 2], 3), Frame::new([2, 2], 1));
    let (graph, spec) = (GraphRecord::default(), session.spec());
    let at = |spot: Spot| spot.located(&first, &graph, spec).map(|_| ());
    assert_eq!(at(Spot::At(vec![1.0, 2.0])), Err(PlanError::Pictures("door-key-5x5")));
    assert!(matches!(at(Spot::Goal), Err(PlanError::NoGoal { .. })));
    let start = Spot::Start.located(&first, &graph, spec).unwrap();
    let agent = crate::assembly::agent("q-learning").unwrap().pictured.unwrap();
    let agent = agent(spec, &config.agent, config.settings.backend, Seed(0)).unwrap();
    assert!(start.holds(&*agent, &first) && !start.holds(&*agent, &other));
}

/// A corridor of five cells in which something is wrong from the seventh step of an episode on.
struct Ill {
    spec: Spec,
    at: f32,
    steps: u32,
    what: What,
}

#[derive(Clone, Copy, PartialEq)]
enum What {
    Seen(f32),
    Paid(f32),
    Shape,
}

impl Environment for Ill {
    type Observation = Vec<f32>;
    type Action = usize;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, _: u64) {
        (self.at, self.steps) = (2.0, 0);
    }

    fn step(&mut self, choice: &usize) -> Result<Step, Refused> {
        self.spec.action.admit_choice(*choice)?;
        self.at = (self.at + *choice as f32 * 2.0 - 1.0).clamp(0.0, 4.0);
        self.steps += 1;
        let reward = match self.what {
            What::Paid(wrong) if self.steps >= 7 => wrong,
            _ => 0.0,
        };
        Ok(Step { reward, end: None })
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        out.clear();
        out.extend([self.at, 0.0]);
        match self.what {
            What::Seen(wrong) if self.steps >= 7 => out[1] = wrong,
            What::Shape if self.steps >= 7 => out.push(0.0),
            _ => {}
        }
    }
}

fn ill(what: What) -> (Box<dyn Session>, Stopped) {
    let cell = Dimension::linear("cell", "", 0.0, 4.0);
    let spec = Spec {
        name: "ill",
        about: "",
        observation: Space::Box([cell, Dimension::linear("light", "", 0.0, 1.0)].into()),
        action: Space::Discrete(2),
        goal: None,
        place: vec![0],
        time_limit: Some(20),
        success_reward: 1.0,
    };
    let env = TimeLimit::new(Ill { spec, at: 0.0, steps: 0, what }, 20);
    let mut session =
        super::discrete(vec![Box::new(env)], &Config::defaults("q-learning", "ill").unwrap()).unwrap();
    let stopped = session.train().unwrap_err();
    (session, stopped)
}

#[test]
fn what_is_no_number_is_named_with_its_step_before_anybody_learns_of_it() {
    let said = |what| ill(what).1.to_string();
    let head = "episode 0, step 7 of the environment: ";
    let mend = "; mend the environment: `envs::check::check` finds what is wrong with it";
    for (what, told) in [
        (What::Seen(f32::NAN), "observation component 1 (light) is NaN"),
        (What::Seen(f32::NEG_INFINITY), "observation component 1 (light) is -inf"),
        (What::Paid(f32::NAN), "the reward is NaN"),
        (What::Shape, "the observation has 3 components where the spec has 2 components"),
    ] {
        assert_eq!(said(what), format!("{head}{told}{mend}"));
    }
    let (mut session, _) = ill(What::Paid(f32::NAN));
    assert_eq!(session.progress(), (0, 0), "an episode that stopped is none");
    assert!(session.evaluate(Protocol::Frozen, 0).is_err());
}
