//! The setting of thesis 5.2.1: options with subgoals given by hand, whose policies and sets are learned together.

use inroads::agents::experience::{Aim, Pay};
use inroads::agents::tabular::TabularConfig;
use inroads::agents::{
    Context, Experience, Lesson, Memory, Pace, Replay, TabularQ, Transition, checkpoint, episode,
};
use inroads::discovery::{
    Call, Discovery, Hierarchy, Initiation, Outcome, Shared, SkillId, SkillPolicy, Stop,
};
use inroads::envs::rooms::{FOUR_ROOMS, Rooms};
use inroads::envs::world::{Layout, Symbolic};
use inroads::envs::{End, Environment, Seed, TimeLimit};
use rand::RngExt;

/// What is seen: column and row, and column and row of the goal.
pub(super) type State = Vec<f32>;
/// Sets of any kind.
pub(super) type Family = Box<dyn Initiation<State, usize>>;

/// The middles of the four rooms: what the options aim at, as in the thesis.
pub(super) const GOALS: [[u8; 2]; 4] = [[3, 3], [9, 3], [3, 9], [9, 9]];

/// H: steps that an option has (authors: 50).
pub(super) const HORIZON: u32 = 50;

/// Four rooms with the goal in that cell.
pub(super) fn rooms([x, y]: [u8; 2], slip: f64) -> Rooms {
    let mut map: Vec<Vec<char>> =
        FOUR_ROOMS.trim().lines().map(|row| row.replace(['S', 'G'], " ").chars().collect()).collect();
    map[1][1] = 'S';
    map[usize::from(y)][usize::from(x)] = 'G';
    let rows: Vec<String> = map.into_iter().map(|row| row.into_iter().collect()).collect();
    // A step more than an option has, so that it runs out of time before it is cut off.
    Rooms::new(&rows.join("\n"), slip, HORIZON + 1).expect("the four rooms are whole")
}

/// What is seen in a cell on the way to a goal.
pub(super) fn seen(at: [u8; 2], goal: [u8; 2]) -> State {
    [at, goal].into_iter().flatten().map(f32::from).collect()
}

/// Options that are called for whatever goal there is.
pub(super) struct Practice {
    pub(super) sets: Family,
    pub(super) policy: Shared<TabularQ, ()>,
    /// Whether all states of a failed execution are examples of failure (authors, grids), or its first alone (authors,
    /// ant).
    whole_failures: bool,
}

checkpoint!([] Practice; plain: ; parts: sets, policy);

impl Practice {
    fn new(mut sets: Family, whole_failures: bool) -> Self {
        (1..=GOALS.len() as u32).for_each(|k| sets.born(SkillId(k), &[]));
        // Learned slowly enough that sets have something to follow.
        let config = TabularConfig { rate: 0.2, discount: 0.95, batch: 4, ..TabularConfig::default() };
        let pace = Pace { updates_per_step: 0.5, warm_up: 1 };
        let replay = Replay::new(20_000).paying(Pay::ATTAINMENT);
        let practice = inroads::agents::Practice::new(replay, pace);
        Self { sets, policy: Shared::new(TabularQ::new(4, &config), practice), whole_failures }
    }

    fn call(s: &State) -> Call<()> {
        let goal = [s[2] as u8, s[3] as u8];
        let index = GOALS.iter().position(|known| *known == goal).expect("goals are the options' own");
        Call { skill: SkillId(index as u32 + 1), goal: None, budget: HORIZON }
    }
}

impl Discovery<State, usize> for Practice {
    type Goal = ();
    type Lane = ();

    fn decide(&self, (): &mut (), s: &State, _: &Experience<State, usize>, _: &mut Context) -> Call<()> {
        Self::call(s)
    }

    fn act(&self, (): &mut (), call: &Call<()>, s: &State, ctx: &mut Context) -> usize {
        self.policy.act(&mut Memory::new(), call, s, ctx)
    }

    fn reached(&self, _: &Call<()>, t: &Transition<State, usize>) -> bool {
        t.end == Some(End::Terminated)
    }

    fn finished(
        &mut self,
        (): &mut (),
        out: &Outcome<()>,
        all: &Experience<State, usize>,
        ctx: &mut Context,
    ) {
        let (k, attained) = (out.call.skill, out.stop == Stop::Reached);
        let Some(episode) = all.episode(out.episode) else { return };
        if out.stop == Stop::CutShort {
            return;
        }
        let aim = Aim::Subgoal { attained };
        let lesson =
            Lesson { episode: out.episode, steps: out.steps.clone(), aim, goal: None, rewards: None };
        let states = &episode.observations[out.steps.start as usize..out.steps.end as usize];
        let examples = if attained || self.whole_failures { states } else { &states[..1] };
        self.sets.outcome(k, examples, attained);
        self.sets.lesson(k, &lesson);
        SkillPolicy::<State, usize, ()>::lesson(&mut self.policy, k, lesson);
        let policy = &self.policy;
        let act = |_: SkillId, s: &State, ctx: &mut Context| {
            let explore = std::mem::replace(&mut ctx.explore, false);
            let action = policy.act(&mut Memory::new(), &Self::call(s), s, ctx);
            ctx.explore = explore;
            action
        };
        self.sets.learn(k, all, &act, ctx);
    }

    fn learn(&mut self, call: &Call<()>, all: &Experience<State, usize>, ctx: &mut Context) {
        self.policy.step(call.skill, all, ctx);
    }

    fn updates(&self) -> Vec<(&'static str, u64)> {
        vec![("options", SkillPolicy::<State, usize, ()>::updates(&self.policy))]
    }
}

/// Asks for executions of the four options in turn, from cells drawn evenly; only where the set says yes there is one.
/// `watch` is called before the first and after each query, with how many executions there were.
pub(super) fn practise(
    seed: u64,
    queries: u64,
    slip: f64,
    (sets, whole_failures): (Family, bool),
    mut watch: impl FnMut(u64, u64, &Practice),
) {
    let mut agent = Hierarchy::new(Practice::new(sets, whole_failures), 40_000);
    let mut envs =
        GOALS.map(|goal| TimeLimit::new(Symbolic::new(rooms(goal, slip), Layout::FixedMap(0)), HORIZON + 1));
    let (mut executions, mut s) = (0, State::new());
    watch(0, 0, agent.method());
    for query in 0..queries {
        let option = (query % GOALS.len() as u64) as usize;
        let env = &mut envs[option];
        let start = Seed(seed).stream("start", query).random();
        env.reset(start);
        env.observe(&mut s);
        if agent.method().sets.contains(SkillId(option as u32 + 1), &s) {
            let mut ctx = Context::training(Seed(seed), query);
            episode(env, &mut agent, start, &mut ctx, |_, _| {}).expect("choices are legal");
            executions += 1;
        }
        watch(query + 1, executions, agent.method());
    }
}
