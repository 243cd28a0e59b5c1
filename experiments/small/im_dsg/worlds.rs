//! Where they are compared.

use inroads::{
    envs::{
        Environment, Seed, Snapshot, TimeLimit,
        grid::{GridWorld, Maker, Pay},
        rooms::{FOUR_ROOMS, Rooms},
        world::{Layout, Symbolic, World as Rules},
    },
    statistics::{Estimate, wilson},
};
use rand::RngExt;

use crate::support::over_seeds;

/// Any of them.
pub(crate) type Domain = Box<dyn Environment<Observation = Vec<f32>, Action = usize> + Send>;

/// A world.
#[derive(Clone, Copy)]
pub(crate) struct World {
    pub(crate) name: &'static str,
    /// Steps of an episode at most.
    pub(crate) limit: u32,
    /// Steps of a training.
    pub(crate) budget: u64,
    kind: Kind,
}

#[derive(Clone, Copy)]
enum Kind {
    /// DoorKey of so many cells a side, where success pays 1; another layout for every seed.
    DoorKey(u32),
    FourRooms,
    /// So many rooms a side, in a row that winds from side to side.
    Winding(usize),
}

/// All of them.
pub(crate) const WORLDS: [World; 3] = [
    World { name: "door-key-6x6", limit: 200, budget: 24_000, kind: Kind::DoorKey(6) },
    World { name: "rooms", limit: 200, budget: 10_000, kind: Kind::FourRooms },
    World { name: "winding rooms", limit: 200, budget: 40_000, kind: Kind::Winding(3) },
];

/// What experiments do with a world of any type.
pub(crate) trait Visit {
    /// What comes of it.
    type Out;

    /// Does it.
    fn visit<W: Rules + Snapshot + Send + 'static>(self, env: Symbolic<W>) -> Self::Out;
}

impl World {
    /// Builds it with the layout of that seed.
    pub(crate) fn make(&self, seed: u64) -> Domain {
        struct Boxing(u32);
        impl Visit for Boxing {
            type Out = Domain;

            fn visit<W: Rules + Snapshot + Send + 'static>(self, env: Symbolic<W>) -> Domain {
                Box::new(TimeLimit::new(env, self.0))
            }
        }
        self.visit(seed, Boxing(self.limit))
    }

    /// Does something with it as it is, without a limit.
    pub(crate) fn visit<V: Visit>(&self, seed: u64, visit: V) -> V::Out {
        let rooms = |map: &str| Rooms::new(map, 0.0, self.limit).expect("the map is whole");
        let layout = Layout::Fixed(seed);
        match self.kind {
            Kind::DoorKey(size) => {
                let world = GridWorld::new(Maker::DoorKey { size }).expect("that size is possible");
                visit.visit(Symbolic::new(world.paying(Pay::One), layout))
            }
            Kind::FourRooms => visit.visit(Symbolic::new(rooms(FOUR_ROOMS), layout)),
            Kind::Winding(side) => visit.visit(Symbolic::new(rooms(&winding(side)), layout)),
        }
    }
}

/// Cells along a room's side.
const ROOM: usize = 5;

/// Rooms from the top left, a row of them to the right, the next to the left, and so on.
fn winding(side: usize) -> String {
    let cells = side * (ROOM + 1) + 1;
    let mut map = vec![vec!['#'; cells]; cells];
    let order: Vec<_> = (0..side)
        .flat_map(|row| (0..side).map(move |i| [if row % 2 == 0 { i } else { side - 1 - i }, row]))
        .collect();
    let corner = |room: [usize; 2]| room.map(|i| i * (ROOM + 1) + 1);
    for room in &order {
        let [x, y] = corner(*room);
        (y..y + ROOM).for_each(|y| map[y][x..x + ROOM].fill(' '));
    }
    for two in order.windows(2) {
        let [[x, y], [u, v]] = [corner(two[0]), corner(two[1])];
        // In the middle of the wall between them.
        map[usize::midpoint(y, v) + ROOM / 2][usize::midpoint(x, u) + ROOM / 2] = ' ';
    }
    let [[x, y], [u, v]] = [corner(order[0]), corner(order[order.len() - 1])];
    map[y][x] = 'S';
    map[v + ROOM - 1][u] = 'G';
    map.into_iter().map(|row| row.into_iter().collect::<String>() + "\n").collect()
}

/// Episodes of the random policy, over all seeds.
const RANDOM: u64 = 2_000;

/// How often the uniformly random policy succeeds.
pub(crate) fn random(world: World, seeds: u64) -> Estimate {
    let each = RANDOM.div_ceil(seeds);
    let successes: u64 = over_seeds(seeds, |seed| {
        let (mut env, mut rng) = (world.make(seed), Seed(seed).stream("random", 0));
        let mut success = |number| {
            env.reset(number);
            loop {
                let step = env.step(&rng.random_range(0..choices(&env))).expect("it is a choice");
                if step.end.is_some() {
                    return u64::from(env.spec().succeeded(&step));
                }
            }
        };
        (0..each).map(&mut success).sum::<u64>()
    })
    .into_iter()
    .sum();
    wilson(successes, each * seeds)
}

fn choices(env: &Domain) -> usize {
    match env.spec().action {
        inroads::envs::Space::Discrete(n) => n,
        _ => unreachable!("these worlds have choices"),
    }
}
