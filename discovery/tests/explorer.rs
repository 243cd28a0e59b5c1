//! IM-DSG in a room of nine cells, where every step of the answer is known.
//!
//! ```text
//! (1,1) (2,1) (3,1)      start (1,1), goal (3,3); a skill has two steps, so an edge is right where two cells are at
//! (1,2) (2,2) (3,2)      most two steps apart, and nobody gets from the start to the goal in fewer than four
//! (1,3) (2,3) (3,3)
//! ```

use inroads_agents::{
    Actor, Agent, Bag, Checkpoint, Context, Curious, Pace, Practice, Replay, TabularQ, episode,
    experience::Pay, novelty::Counts, tabular::TabularConfig,
};
use inroads_discovery::{
    Features, GraphExplorer, Hierarchy, Shared, Skilled,
    frontier::Novel,
    graph::{AbstractMdp, AbstractMdpConfig, ExplorerConfig, Vertex},
    naming::Whole,
    record::{GraphRecord, Place, Query},
};
use inroads_envs::{
    Seed, TimeLimit,
    rooms::{NINE_CELLS, Rooms},
    world::{Layout, Symbolic},
};

type ImDsg = Hierarchy<
    Vec<f32>,
    usize,
    GraphExplorer<Features, Shared<TabularQ, Features>, Novel<Vec<f32>, TabularQ, Whole>>,
>;

type Env = TimeLimit<Symbolic<Rooms>>;

fn agent() -> ImDsg {
    remembering(5_000)
}

/// The agent, where its experience and both replays hold about so many steps.
fn remembering(capacity: usize) -> ImDsg {
    let tables = |discount| TabularQ::new(4, &TabularConfig { discount, ..TabularConfig::default() });
    let pace = Pace { updates_per_step: 2.0, warm_up: 8 };
    let replay = Replay::new(capacity).paying(Pay::ATTAINMENT).spanning(3);
    let policy = Shared::new(tables(0.95), Practice::new(replay, pace));
    let practice = Practice::new(Replay::new(capacity), pace);
    let curious = Curious::new(tables(0.9), practice)
        .sober(tables(0.9))
        .with_novelty(Box::new(Counts::default()), 0.01)
        .centred(true);
    let frontier = Novel::new(curious, Whole { tolerance: 0.5 }, 0.5);
    // A cell two steps away is worth 0.95, one three steps away 0.9025.
    let config =
        ExplorerConfig { horizon: 2, edge_value: 0.92, edge_doubt: 0.02, ..ExplorerConfig::default() };
    let planner = |optimism| {
        Box::new(AbstractMdp::new(&AbstractMdpConfig { optimism, ..AbstractMdpConfig::default() }))
    };
    Hierarchy::new(GraphExplorer::new(&config, planner(0.5), policy, frontier).sober(planner(0.0)), capacity)
}

fn env() -> Env {
    TimeLimit::new(Symbolic::new(Rooms::new(NINE_CELLS, 0.0, 20).unwrap(), Layout::Fixed(0)), 20)
}

fn train(agent: &mut ImDsg, episodes: std::ops::Range<u64>) {
    let mut env = env();
    for number in episodes {
        let mut ctx = Context::training(Seed(0), number);
        episode(&mut env, agent, Seed(0).number("start", number), &mut ctx, |_, _| {}).unwrap();
    }
}

/// The cells that a frozen actor goes through, and whether it came to the task's goal.
fn path(actor: &mut dyn Actor<Vec<f32>, usize>) -> (Vec<[u8; 2]>, bool) {
    let mut cells = vec![[1, 1]];
    let mut ctx = Context::evaluation(Seed(0), 0);
    let summary =
        episode(&mut env(), actor, 0, &mut ctx, |t, _| cells.push([t.after[0] as u8, t.after[1] as u8]));
    (cells, summary.unwrap().success)
}

fn cell(at: [u8; 2]) -> Vec<f32> {
    vec![f32::from(at[0]), f32::from(at[1]), 3.0, 3.0]
}

fn cells(graph: &GraphRecord) -> Vec<[u8; 2]> {
    graph.vertices.iter().map(|v| [v.at[0] as u8, v.at[1] as u8]).collect()
}

#[test]
fn the_graph_is_the_one_that_must_be_found() {
    let mut agent = agent();
    train(&mut agent, 0..150);
    let graph = Skilled::graph(&agent).unwrap();
    let cells = cells(&graph);
    assert_eq!(cells, [[1, 3], [3, 3], [2, 1], [3, 2]], "vertices, in the order in which they were found");
    let edges: Vec<_> = graph.edges.iter().map(|e| (e.from, e.to)).collect();
    assert_eq!(edges, [(0, 1), (2, 3), (3, 1), (3, 2)]);

    let (start, goal) = (cell([1, 1]), cell([3, 3]));
    let plan = agent.plan(&Place::State(&start), &Place::State(&goal)).unwrap();
    assert_eq!(plan.case, Query::StartOutside);
    assert_eq!(plan.legs.iter().map(|(v, _)| *v).collect::<Vec<_>>(), [2, 3, 1]);
    let within = agent.plan(&Place::Vertex(2), &Place::Vertex(1)).unwrap();
    assert_eq!((within.case, within.legs.len()), (Query::Inside, 2));
    assert!(agent.plan(&Place::Vertex(1), &Place::Vertex(2)).is_none(), "the episode is over there");

    // Frozen, it goes to the task's goal as fast as can be, and leaves the agent as it was.
    assert_eq!(path(&mut *agent.frozen()), (vec![[1, 1], [2, 1], [3, 1], [3, 2], [3, 3]], true));
}

#[test]
fn goals_that_were_never_vertices_are_reached() {
    let mut agent = agent();
    train(&mut agent, 0..150);
    let known = cells(&Skilled::graph(&agent).unwrap());
    for held_out in [[1, 2], [2, 2]] {
        assert!(!known.contains(&held_out), "{held_out:?} is a vertex");
        let (cells, _) = path(&mut *agent.pursue(&Place::State(&cell(held_out))).unwrap());
        let steps = usize::from(held_out[0] + held_out[1] - 2);
        assert_eq!(cells[steps], held_out, "{cells:?}");
    }
    // The cell above vertex 0 is nearest to it, and there is no way from there to what is nearest to the one in the middle.
    let plan = agent.plan(&Place::Vertex(0), &Place::State(&cell([1, 2]))).unwrap();
    assert_eq!((plan.case, plan.legs), (Query::GoalOutside, vec![]));
    assert!(agent.plan(&Place::Vertex(0), &Place::State(&cell([2, 2]))).is_none());
}

#[test]
fn vertices_that_come_late_learn_from_what_is_still_remembered() {
    // Fifty steps are a few episodes: most of what the first vertices were made of is forgotten when the last one comes.
    let mut agent = remembering(50);
    train(&mut agent, 0..150);
    let remembered = agent.experience().numbers();
    assert!(remembered.end == 150 && remembered.start > 130, "{remembered:?}");
    let graph = Skilled::graph(&agent).unwrap();
    assert!(graph.vertices.len() > 1, "there are vertices: {}", graph.vertices.len());
    let forgotten = |v: &u32| agent.method().effects(Vertex(*v)).iter().any(|(n, _)| *n < remembered.start);
    assert!(
        (0..graph.vertices.len() as u32).any(|v| forgotten(&v)),
        "some were reached in episodes that are gone"
    );
    // And where one was reached last is told only if it is remembered.
    for v in &graph.vertices {
        let last = agent.method().effects(Vertex(v.vertex)).last();
        assert_eq!(v.at.is_empty(), last.is_none_or(|(number, _)| *number < remembered.start));
    }
}

#[test]
fn a_saved_explorer_goes_on_as_if_nothing_had_happened() {
    let save = |agent: &ImDsg| {
        let mut bag = Bag::default();
        agent.save(&mut bag);
        bag
    };
    let mut whole = agent();
    train(&mut whole, 0..30);
    let mut bag = Bag::default();
    whole.save(&mut bag);
    let mut resumed = agent();
    resumed.load(&bag).unwrap();
    assert_eq!(path(&mut *whole.frozen()), path(&mut *resumed.frozen()));
    train(&mut whole, 30..60);
    train(&mut resumed, 30..60);
    assert!(save(&whole) == save(&resumed));
}
