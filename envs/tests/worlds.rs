//! Worlds seen in several ways: the same world in each, with the same refusals, limits and snapshots; and all worlds of
//! the registry, in each way that they can be seen.

use inroads_envs::{
    Annotated, Domain, Drawing, End, Environment, ProtoGoals, Refused, Render, Seed, Snapshot, Sweep,
    TimeLimit,
    check::{self, check},
    registry::{self, AnyAnnotated, AnyEnvironment, MakeError, Options},
    world::{Annotating, Layout, Pictured, Question, See, Symbolic, World},
};
use inroads_sim::raster::{Filter, Format};
use rand::RngExt;

#[allow(unreachable_pub, dead_code)] // also a part of the library's own tests
#[path = "support/nine.rs"]
mod nine;

use nine::Nine;

const LAYOUTS: [Layout; 3] = [Layout::Random, Layout::Fixed(3), Layout::FixedMap(3)];

fn pictured(ice: bool, layout: Layout) -> Pictured<Nine> {
    Pictured::new(Nine::new(ice), layout, Format::NATIVE).expect("as large as it is")
}

/// Choices of an episode.
fn choices(seed: u64) -> impl Iterator<Item = usize> {
    let mut rng = Seed(seed).stream("choices", 0);
    std::iter::repeat_with(move || rng.random_range(0..4))
}

/// What an environment shows now.
fn seen<E: Environment>(env: &mut E) -> E::Observation {
    let mut out = E::Observation::default();
    env.observe(&mut out);
    out
}

fn symbols(world: &impl World) -> Vec<f32> {
    let mut out = Vec::new();
    world.symbols(&mut out);
    out
}

#[test]
fn every_way_of_seeing_a_world_keeps_the_contract() {
    for (ice, layout) in [false, true].into_iter().flat_map(|ice| LAYOUTS.map(|layout| (ice, layout))) {
        let options = check::Options::default();
        let limited = |steps| TimeLimit::new(Annotating(pictured(ice, layout)), steps);
        check(&mut Symbolic::new(Nine::new(ice), layout), options).unwrap();
        check(&mut pictured(ice, layout), options).unwrap();
        check(&mut TimeLimit::new(Annotating(Symbolic::new(Nine::new(ice), layout)), 5), options).unwrap();
        check(&mut limited(1), options).unwrap();
        check(&mut limited(30), options).unwrap();
    }
}

#[test]
fn symbols_and_pictures_are_of_one_world() {
    for (layout, seed) in LAYOUTS.into_iter().flat_map(|layout| (0..20).map(move |seed| (layout, seed))) {
        let mut one = Symbolic::new(Nine::new(true), layout);
        let mut other = TimeLimit::new(Annotating(pictured(true, layout)), 1000);
        one.reset(seed);
        other.reset(seed);
        for choice in choices(seed) {
            let [x, y, ..] = seen(&mut one)[..] else { panic!("four symbols") };
            let Annotated { seen: frame, bits } = seen(&mut other);
            assert_eq!(symbols(one.world()), symbols(other.inner().0.world()));
            assert_eq!(frame.pixel([4 * x as u32 + 1, 4 * y as u32 + 2]), [255, 0, 0]);
            assert_eq!(bits.ones().collect::<Vec<_>>(), [(x + 3.0 * y) as usize]);
            let [a, b] = [one.step(&choice), other.step(&choice)].map(|step| step.expect("it is a choice"));
            assert_eq!(a, b);
            if a.end.is_some() {
                assert_eq!(
                    (one.step(&choice), other.step(&choice)),
                    (Err(Refused::Over), Err(Refused::Over))
                );
                break;
            }
        }
        let names = other.proto_goals();
        assert_eq!((names.len(), names[5].as_str()), (9, "at (2, 1)"));
        assert_eq!((one.facts(), other.facts()[0].value), (other.facts(), 1.0));
    }
}

#[test]
fn an_illegal_choice_is_refused_by_its_number_and_changes_nothing() {
    let mut env = pictured(true, Layout::Random);
    assert_eq!(env.step(&0), Err(Refused::Over), "nothing was begun");
    env.reset(1);
    let before = env.save();
    let refused = env.step(&4).expect_err("there are four");
    assert_eq!(refused.to_string(), "action component 0 is 4, outside [0, 3]; clip it to the action space");
    assert_eq!(env.save(), before);
}

/// Where each of some episodes begins and what the goal is, and what the first steps on ice lead to.
fn beginnings(layout: Layout) -> Vec<[Vec<f32>; 3]> {
    let mut env = Symbolic::new(Nine::new(true), layout);
    let episode = |seed| {
        env.reset(seed);
        let first = seen(&mut env);
        choices(0).take(3).for_each(|choice| drop(env.step(&choice)));
        [first[..2].to_vec(), first[2..].to_vec(), seen(&mut env)]
    };
    (0..50).map(episode).collect()
}

#[test]
fn a_layout_says_what_is_the_same_in_all_episodes() {
    let kinds = |episodes: &[[Vec<f32>; 3]]| {
        [0, 1, 2].map(|what| {
            let mut all: Vec<_> = episodes.iter().map(|episode| &episode[what]).collect();
            all.sort_by(|a, b| a.partial_cmp(b).expect("they are numbers"));
            all.dedup();
            all.len()
        })
    };
    let [random, fixed, map] = LAYOUTS.map(beginnings);
    assert_eq!(kinds(&random)[..2], [9, 9]);
    let [starts, goals, after] = kinds(&fixed);
    assert!((starts, goals) == (1, 1) && after > 1, "chance differs: {after}");
    assert_eq!(kinds(&map)[..2], [8, 1]);
    assert_eq!((&fixed[0][1], &fixed[0][0]), (&map[0][1], &beginnings(Layout::Fixed(3))[0][0]));
    assert_eq!(
        fixed[0][..2],
        beginnings(Layout::Random)[3][..2],
        "the seed names the same layout in each way"
    );
    assert_ne!(fixed[0][1], beginnings(Layout::Fixed(4))[0][1]);
}

#[test]
fn what_follows_a_snapshot_is_the_same_every_time() {
    let make = || TimeLimit::new(Annotating(pictured(true, Layout::Random)), 40);
    for seed in 0..20 {
        let mut env = make();
        env.reset(seed);
        choices(seed).take(3).for_each(|choice| drop(env.step(&choice)));
        let state = env.save();
        let play = |env: &mut TimeLimit<Annotating<Pictured<Nine>>>| {
            let mut trace = vec![(None, seen(env))];
            trace.extend(choices(seed + 100).take(45).map(|choice| (Some(env.step(&choice)), seen(env))));
            trace
        };
        let first = play(&mut env);
        // Somebody else played on meanwhile, and its painter remembers other pictures.
        env.reset(seed + 1);
        seen(&mut env);
        env.load(&state);
        assert_eq!(play(&mut env), first);
        let mut fresh = make();
        fresh.load(&state);
        assert_eq!(play(&mut fresh), first);
    }
}

#[test]
fn a_sweep_goes_through_all_wrappers() {
    let mut env = TimeLimit::new(Annotating(pictured(false, Layout::Random)), 2);
    let mut plain = Symbolic::new(Nine::new(false), Layout::Random);
    assert_eq!((env.starts(), plain.starts()), (8, 8));
    for start in 0..8 {
        env.begin(start);
        plain.begin(start);
        assert_eq!(seen(&mut plain), [(start % 3) as f32, (start / 3) as f32, 2.0, 2.0]);
        assert!(seen(&mut env).bits.get(start));
        // The limit counts from the start: two steps, against the wall.
        let ends = [0, 0].map(|choice| env.step(&choice).expect("an episode is on").end);
        assert_eq!(ends, [None, Some(End::Truncated)]);
        plain.step(&0).expect("an episode is on");
    }
}

#[test]
#[should_panic(expected = "there are 8 starts, and none of number 8")]
fn there_are_no_more_starts_than_there_are() {
    Symbolic::new(Nine::new(false), Layout::Random).begin(8);
}

#[test]
fn a_picture_of_no_size_is_refused() {
    for size in [[0, 84], [84, 5000]] {
        let format = Format { scale: Some((size, Filter::Area)), ..Format::NATIVE };
        let error =
            Pictured::new(Nine::new(false), Layout::Random, format).map(drop).expect_err("no such size");
        assert!(error.to_string().contains("width and height lie between 1 and 4096"), "{error}");
    }
}

/// The names of the registry's worlds: what takes the option `see`.
fn worlds() -> Vec<&'static str> {
    let options = Options { see: Some(See::Symbols), ..Options::default() };
    let takes = |name: &&str| registry::make_with(name, &options).is_ok();
    registry::entries().map(|entry| entry.name).filter(takes).collect()
}

#[test]
fn every_world_of_the_registry_can_be_seen_in_every_way() {
    let worlds = worlds();
    assert!(worlds.len() > 30, "{worlds:?}");
    let options = check::Options { episodes: 1, steps: 200 };
    let ways =
        [See::Symbols, See::Pixels(Format::NATIVE), See::Pixels(Format::THESIS), See::Pixels(Format::ATARI)];
    for (name, see) in worlds.into_iter().flat_map(|name| ways.map(|see| (name, see))) {
        let chosen = Options { see: Some(see), ..Options::default() };
        let verdict = match registry::make_with(name, &chosen).expect("worlds are seen in every way") {
            AnyEnvironment::Choices(mut env) if see == See::Symbols => check(&mut env, options),
            AnyEnvironment::Frames(mut env) if see != See::Symbols => check(&mut env, options),
            _ => panic!("{name} is not seen as it was asked for: {see:?}"),
        };
        verdict.unwrap_or_else(|fault| panic!("{name}, {see:?}: {fault}"));
        let verdict = match registry::make_annotated(name, &chosen) {
            Ok(AnyAnnotated::Vectors(mut env)) => check(&mut env, options).map(|()| bits(name, &mut env)),
            Ok(AnyAnnotated::Frames(mut env)) => check(&mut env, options).map(|()| bits(name, &mut env)),
            Err(MakeError::NoProtoGoals { .. }) => Ok(()),
            Err(error) => panic!("{error}"),
        };
        verdict.unwrap_or_else(|fault| panic!("{name}, {see:?}, annotated: {fault}"));
    }
}

/// There is a question to each bit.
fn bits<O, E>(name: &str, env: &mut E)
where
    O: Clone + Default,
    E: Environment<Observation = Annotated<O>>,
{
    env.reset(0);
    let questions = registry::proto_goals(name).expect("it has some");
    assert_eq!(seen(env).bits.len(), questions.len(), "{name}: {questions:?}");
    assert!(!questions.is_empty(), "{name}");
}

#[test]
fn questions_about_cells_name_their_column_and_row() {
    let of = |name| registry::questions(name).expect("it has some");
    let [taxi, visual, distractor, timer, baba] =
        ["sparse-taxi", "visual-taxi-5x5", "distractor-grid", "timer-grid", "baba-u-maze"].map(of);
    let asks = |text: &str, cell| Question { text: text.to_owned(), cell };
    assert_eq!(taxi[7], asks("taxi at 1,2", Some([2, 1])));
    assert_eq!(taxi[29], asks("passenger in taxi", None));
    assert_eq!(distractor[16 + 6], asks("green (2, 1)", Some([2, 1])));
    assert_eq!((&timer[0], timer[115].cell), (&asks("player at (0, 0)", Some([0, 0])), None));
    for Question { text, cell } in visual {
        let ends = cell.map_or_else(|| text.clone(), |[column, row]| format!(" at {row},{column}"));
        assert!(text.ends_with(&ends) && cell.is_some() == text.contains(','), "{text}");
    }
    for Question { text, cell } in baba {
        let [column, row] = cell.expect("all are about cells");
        assert!(text.ends_with(&format!(" at {column},{row}")), "{text}");
    }
}

#[test]
fn every_world_of_the_registry_is_drawn_for_people() {
    fn drawn<O: Clone + Default>(mut env: Box<dyn Domain<O, usize>>) {
        env.reset(0);
        let name = env.spec().name;
        let Drawing::Pixels(picture) = env.drawing() else { panic!("{name} is a picture") };
        assert!(picture.pixels().any(|pixel| pixel != picture.get_pixel(0, 0)), "{name} is of one colour");
        assert!(!env.facts().is_empty(), "{name} has no facts");
    }
    for name in worlds() {
        match registry::make(name) {
            Ok(AnyEnvironment::Choices(env)) => drawn(env),
            Ok(AnyEnvironment::Frames(env)) => drawn(env),
            _ => panic!("worlds have choices"),
        }
    }
}

#[test]
fn a_frame_takes_the_shape_that_the_spec_says() {
    let mut env = pictured(false, Layout::Random);
    env.reset(0);
    let frame = seen(&mut env);
    assert_eq!((frame.size(), frame.channels()), ([12, 12], 3));
}
