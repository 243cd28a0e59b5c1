//! What environments of worlds weigh, seen as pictures and as symbols, and that their step loop allocates nothing. Counted, not estimated: all memory
//! that this thread asks for goes by the counter.

use allocation_counter::{measure, opt_out};
use inroads_envs::{
    Domain, Frame, Seed, Space, TimeLimit,
    registry::{self, AnyEnvironment, Options},
    vector::{AutoReset, Row, VectorEnvironment},
    world::{Layout, Pictured, See},
};
use inroads_sim::raster::Format;
use rand::RngExt;

#[allow(unreachable_pub, dead_code)] // also a part of the library's own tests
#[path = "support/nine.rs"]
mod nine;

/// How the thesis' agents see worlds: 84 × 84, in colour and in both kinds of grey.
const FORMATS: [Format; 3] = [Format::THESIS, Format::THESIS_GREY, Format::ATARI];
/// Bytes that an environment may take, with its spec and what draws it. What it is observed into is somebody else's.
const ENVIRONMENT: u64 = 64 << 10;
/// Layouts that it has seen by then.
const LAYOUTS: u64 = 100;
/// Copies that are stepped together, and bytes that they may take, with all observations.
const COPIES: u64 = 4096;
const VECTOR: u64 = 512 << 20;

/// Worlds that the registry has at least.
const WORLDS: usize = 30;

type Seen<O> = Box<dyn Domain<O, usize>>;

/// A world seen in some way, made anew.
struct Named<O> {
    name: String,
    make: Box<dyn Fn() -> Seen<O>>,
}

/// A world of the registry seen in that way; `None` for bodies.
fn made(name: &str, see: See) -> Option<AnyEnvironment> {
    let made = registry::make_with(name, &Options { see: Some(see), ..Options::default() });
    made.ok().filter(|env| !matches!(env, AnyEnvironment::Vectors(_)))
}

/// All worlds of the registry as symbols.
fn symbols() -> Vec<Named<Vec<f32>>> {
    let make = |name: &'static str| match made(name, See::Symbols)? {
        AnyEnvironment::Choices(env) => Some(env),
        _ => panic!("{name} is no symbols"),
    };
    let named = |name: &'static str| Named {
        name: format!("{name} as symbols"),
        make: Box::new(move || make(name).expect("it was there a moment ago")),
    };
    let all: Vec<_> = registry::entries().filter(|entry| make(entry.name).is_some()).collect();
    assert!(all.len() > WORLDS, "only {} worlds", all.len());
    all.iter().map(|entry| named(entry.name)).collect()
}

/// All worlds of the registry in all formats, and nine cells.
fn pictures() -> Vec<Named<Frame>> {
    let nine = || Pictured::new(nine::Nine::new(true), Layout::Random, Format::ATARI).expect("84 by 84");
    let nine = move || Box::new(TimeLimit::new(nine(), 50)) as Seen<Frame>;
    let mut all = vec![Named { name: "nine-cells".to_owned(), make: Box::new(nine) }];
    for (entry, format) in registry::entries().flat_map(|entry| FORMATS.map(|format| (entry, format))) {
        let make = move || match made(entry.name, See::Pixels(format))? {
            AnyEnvironment::Frames(env) => Some(env),
            _ => panic!("{} is no pictures", entry.name),
        };
        if make().is_some() {
            let make = Box::new(move || make().expect("it was there a moment ago"));
            all.push(Named { name: format!("{} as {format:?}", entry.name), make });
        }
    }
    assert!(all.len() > FORMATS.len() * WORLDS, "only {} pictures", all.len());
    all
}

/// How many choices there are.
fn choices<O: Row>(env: &Seen<O>) -> usize {
    let Space::Discrete(choices) = env.spec().action else { panic!("worlds have choices") };
    choices
}

/// Plays at random for so many steps; beginning an episode is not counted.
fn play<O: Row>(env: &mut Seen<O>, seen: &mut O, steps: u32, seed: u64) {
    let (choices, mut rng) = (choices(env), Seed(seed).stream("choices", 0));
    for _ in 0..steps {
        let step = env.step(&rng.random_range(0..choices)).expect("it is a choice");
        env.observe(seen);
        if step.end.is_some() {
            opt_out(|| env.reset(rng.random()));
        }
    }
}

/// No world is at fault; all that are get named.
fn none(faults: impl Iterator<Item = String>) {
    let faults: Vec<_> = faults.collect();
    assert!(faults.is_empty(), "\n  {}", faults.join("\n  "));
}

/// What is kept of what was measured.
fn bytes(weight: allocation_counter::AllocationInfo) -> u64 {
    u64::try_from(weight.bytes_current).expect("more is taken than given back")
}

fn heavy<O: Row>(Named { name, make }: &Named<O>) -> Option<String> {
    let (mut kept, mut seen) = (None, O::default());
    let weight = bytes(measure(|| {
        let mut env = make();
        // What was seen in one layout may be kept for the next.
        for layout in 0..LAYOUTS {
            env.reset(layout);
            play(&mut env, &mut seen, 30, layout);
        }
        kept = Some(env);
        seen = O::default();
    }));
    assert!(weight > 100, "{weight} bytes: the counter does not count");
    (weight >= ENVIRONMENT).then(|| format!("{name} weighs {weight} bytes"))
}

#[test]
fn an_environment_weighs_less_than_64_kib() {
    none(pictures().iter().filter_map(heavy).chain(symbols().iter().filter_map(heavy)));
}

fn wasteful<O: Row>(Named { name, make }: &Named<O>) -> Option<String> {
    let (mut env, mut seen) = (make(), O::default());
    let mut episodes = || {
        env.reset(0);
        measure(|| play(&mut env, &mut seen, 1000, 1))
    };
    // The first time, what a cell looks like may be drawn and kept.
    episodes();
    let counted = episodes();
    (counted.count_total > 0).then(|| format!("{name} allocates {} bytes in 1000 steps", counted.bytes_total))
}

#[test]
fn a_step_and_a_look_allocate_nothing() {
    none(pictures().iter().filter_map(wasteful).chain(symbols().iter().filter_map(wasteful)));
}

/// Bytes of a vector of so many copies, each made by itself, that was stepped a few times.
fn vector<O: Row>(make: &dyn Fn() -> Seen<O>, copies: u64) -> u64 {
    let mut kept = None;
    bytes(measure(|| {
        let envs = (0..copies).map(|_| make()).collect();
        let mut envs = VectorEnvironment::new(envs, 0, AutoReset::SameStep).expect("copies are alike");
        let (choices, mut rng) = (choices(envs.copy(0).expect("there is one")), Seed(0).stream("choices", 0));
        for _ in 0..3 {
            let choices: Vec<usize> = (0..copies).map(|_| rng.random_range(0..choices)).collect();
            envs.step(&choices).expect("they are choices");
        }
        kept = Some(envs);
    }))
}

fn many_heavy<O: Row>(Named { name, make }: &Named<O>) -> Option<String> {
    // What copies share is there after the first; from then on each weighs the same.
    let [few, more] = [2, 6].map(|copies| vector(&**make, copies));
    let bytes = few + (more - few) / 4 * (COPIES - 2);
    (bytes >= VECTOR).then(|| format!("{name} weighs {} MiB in {COPIES} copies", bytes >> 20))
}

/// As many copies of one world in earnest.
fn in_earnest<O: Row>(worlds: &[Named<O>], name: &str) -> Option<String> {
    let world = worlds.iter().find(|world| world.name.starts_with(name)).expect("the registry has it");
    let bytes = vector(&*world.make, COPIES);
    assert!(bytes > 100 * COPIES, "{bytes} bytes: the counter does not count");
    (bytes >= VECTOR).then(|| format!("{COPIES} copies of {} weigh {} MiB", world.name, bytes >> 20))
}

#[test]
fn thousands_of_copies_weigh_less_than_512_mib() {
    let (pictures, symbols) = (pictures(), symbols());
    none(pictures.iter().filter_map(many_heavy).chain(symbols.iter().filter_map(many_heavy)));
    // Of symbols, four-rooms has the most.
    none(in_earnest(&pictures, "door-key-8x8 ").into_iter().chain(in_earnest(&symbols, "four-rooms ")));
}
