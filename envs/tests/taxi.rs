//! What always holds of taxis, seen and counted.

use inroads_envs::registry::{self, AnyEnvironment};
use inroads_envs::taxi::{Rules, Taxi, TaxiState};
use inroads_envs::visual_taxi::{Ink, Settings, Sizes, Starts, State, Town, VisualTaxi};
use inroads_envs::world::{Drawn, Layout, Painter, World};
use inroads_envs::{Bits, End, Frame, ProtoGoals, Seed, Snapshot, Step};
use inroads_sim::raster::{Format, Scaler};
use rand::RngExt;

fn at(rules: Rules, row: u8, column: u8, passenger: u8, destination: u8) -> Taxi {
    let mut taxi = Taxi::new(rules);
    taxi.load(&TaxiState { row, column, passenger, destination });
    taxi
}

#[test]
fn sparse_taxi_pays_for_arriving_only() {
    for (rules, wrong) in [(Rules::SPARSE, Some(End::Terminated)), (Rules::SPARSE_TO_DESTINATION, None)] {
        let answer = |mut taxi: Taxi, choice| {
            let step = taxi.act(choice);
            (step.reward, step.end)
        };
        // Aboard at red, bound for red, for green; in the open; then picking up, and nobody there.
        assert_eq!(answer(at(rules, 0, 0, 4, 0), 5), (1.0, Some(End::Terminated)));
        assert_eq!(answer(at(rules, 0, 0, 4, 1), 5), (0.0, wrong));
        assert_eq!(answer(at(rules, 2, 2, 4, 1), 5), (0.0, None));
        assert_eq!(answer(at(rules, 0, 0, 0, 1), 4), (0.0, None));
        assert_eq!(answer(at(rules, 0, 0, 2, 1), 4), (0.0, None));
        assert_eq!(answer(at(rules, 0, 0, 2, 1), 0), (0.0, None));
    }
}

/// The registry has both readings.
#[test]
fn a_wrong_depot_ends_one_sparse_taxi_only() {
    for (name, ends_in_vain) in [("sparse-taxi", true), ("sparse-taxi-to-destination", false)] {
        let Ok(AnyEnvironment::Choices(mut env)) = registry::make(name) else { panic!("{name}") };
        let mut rng = Seed(7).stream("drive", 0);
        let [mut arrived, mut in_vain] = [0, 0];
        for seed in 0..500 {
            env.reset(seed);
            let end = loop {
                let step = env.step(&rng.random_range(0..6)).expect("within the episode");
                if step.end.is_some() {
                    break step;
                }
                assert_eq!(step.reward, 0.0, "{name}");
            };
            arrived += u32::from(end.reward == 1.0);
            in_vain += u32::from(end == Step { reward: 0.0, end: Some(End::Terminated) });
        }
        assert!(arrived > 0 && (in_vain > 0) == ends_in_vain, "{name}: {arrived} and {in_vain} of 500");
    }
}

#[test]
fn the_thesis_34_proto_goals_say_where_things_are() {
    let names = Taxi::new(Rules::SPARSE).proto_goals();
    assert_eq!(names.len(), 34);
    let holds = |taxi: &Taxi| {
        let mut bits = Bits::default();
        taxi.annotate(&mut bits);
        bits.ones().map(|bit| names[bit].clone()).collect::<Vec<_>>()
    };
    let taxi = at(Rules::SPARSE, 2, 3, 4, 1);
    assert_eq!(holds(&taxi), ["taxi at 2,3", "passenger in taxi", "destination green"]);
    let taxi = at(Rules::SPARSE, 4, 4, 3, 0);
    assert_eq!(holds(&taxi), ["taxi at 4,4", "passenger at blue", "destination red"]);
    let mut all: Vec<_> = (0..TaxiState::COUNT)
        .map(|number| {
            let mut taxi = Taxi::new(Rules::SPARSE);
            taxi.load(&TaxiState::decode(number).unwrap());
            holds(&taxi)
        })
        .collect();
    assert!(all.iter().all(|holds| holds.len() == 3));
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), TaxiState::COUNT, "states differ in what holds");
    assert_eq!(TaxiState::decode(500), None);
}

#[test]
fn taxis_start_everywhere_and_equally_often() {
    let mut taxi = Taxi::new(Rules::Gymnasium);
    let mut seen = vec![0_u32; TaxiState::COUNT];
    let episodes = 30_000;
    for seed in 0..episodes {
        taxi.begin(Layout::Random.draw(seed));
        seen[taxi.state().encode()] += 1;
    }
    let expected = episodes as f64 / 300.0;
    let squares =
        TaxiState::starts().map(|start| (f64::from(seen[start.encode()]) - expected).powi(2) / expected);
    let squares: f64 = squares.sum();
    assert_eq!(TaxiState::starts().map(|start| u64::from(seen[start.encode()])).sum::<u64>(), episodes);
    // χ² with 299 degrees of freedom: mean 299, deviation 24.
    assert!((200.0..420.0).contains(&squares), "χ² is {squares}");
}

#[test]
fn layouts_of_the_table_keep_passenger_and_destination() {
    let mut taxi = Taxi::new(Rules::Gymnasium);
    let mut begin = |layout: Layout, episode| {
        taxi.begin(layout.draw(episode));
        taxi.state()
    };
    let fixed = begin(Layout::Fixed(42), 0);
    assert!((1..50).all(|episode| begin(Layout::Fixed(42), episode) == fixed));
    assert_eq!(begin(Layout::Random, 42), fixed, "a layout's seed is an episode's");
    assert!((0..50).any(|seed| begin(Layout::Fixed(seed), 0) != fixed));
    let starts: Vec<TaxiState> = (0..500).map(|episode| begin(Layout::FixedMap(42), episode)).collect();
    let kept = |state: &TaxiState| (state.passenger, state.destination);
    assert!(starts.iter().all(|start| kept(start) == kept(&fixed)));
    let mut cells: Vec<_> = starts.iter().map(|start| [start.row, start.column]).collect();
    cells.sort_unstable();
    cells.dedup();
    assert_eq!(cells.len(), 25, "the taxi starts in every cell");
}

fn crowded(town: Town, passengers: usize, starts: Starts) -> VisualTaxi {
    VisualTaxi::new(Settings { town, passengers, starts, ..Settings::TEN })
        .expect("fewer passengers than depots")
}

#[test]
fn passengers_stay_apart_and_one_rides_at_a_time() {
    for (town, passengers) in [(Town::FIVE, 1), (Town::FIVE, 3), (Town::TEN, 7), (Town::TEN_WITH_SEVEN, 6)] {
        let mut rng = Seed(1).stream("drive", 0);
        for (starts, seed) in [(Starts::Classic, 0), (Starts::Exploring, 1), (Starts::Exploring, 2)] {
            let mut world = crowded(town, passengers, starts);
            for layout in [Layout::Random, Layout::FixedMap(seed)] {
                world.begin(layout.draw(seed));
                for _ in 0..2000 {
                    let State { taxi, passengers } = world.state().clone();
                    let mut cells: Vec<_> = passengers.iter().map(|one| one.cell).collect();
                    cells.sort_unstable();
                    cells.dedup();
                    assert_eq!(cells.len(), passengers.len());
                    assert!(passengers.iter().filter(|one| one.aboard).count() <= 1);
                    assert!(passengers.iter().all(|one| !one.aboard || one.cell == taxi));
                    assert!(cells.iter().chain([&taxi]).flatten().all(|&at| at < town.size()));
                    let choice = rng.random_range(0..5);
                    let legal = world.legal()[choice];
                    let before = world.state().clone();
                    let step = world.act(choice);
                    assert_eq!(*world.state() != before, legal, "what is legal does something");
                    if step.end.is_some() {
                        break;
                    }
                }
            }
        }
    }
}

#[test]
fn states_of_taxis_come_back() {
    let mut world = crowded(Town::TEN, 3, Starts::Exploring);
    let mut rng = Seed(2).stream("drive", 0);
    world.begin(Layout::Random.draw(4));
    let drive = |world: &mut VisualTaxi, way: &[usize]| {
        way.iter().map(|&choice| (world.act(choice), world.save())).collect::<Vec<_>>()
    };
    let way: Vec<usize> = (0..400).map(|_| rng.random_range(0..5)).collect();
    drive(&mut world, &way[..200]);
    let kept = world.save();
    let first = drive(&mut world, &way[200..]);
    world.begin(Layout::Random.draw(5));
    world.load(&kept);
    assert_eq!(first, drive(&mut world, &way[200..]));
}

#[test]
fn layouts_fix_start_passenger_and_goal() {
    let mut world = VisualTaxi::new(Settings::FIVE).unwrap();
    let mut begin = |layout: Layout, episode| {
        world.begin(layout.draw(episode));
        world.state().clone()
    };
    let fixed = begin(Layout::Fixed(42), 0);
    assert!((1..20).all(|episode| begin(Layout::Fixed(42), episode) == fixed));
    assert!((1..20).any(|episode| begin(Layout::Random, episode) != fixed));
    let starts: Vec<State> = (0..20).map(|episode| begin(Layout::FixedMap(42), episode)).collect();
    assert!(starts.iter().all(|state| state.passengers == fixed.passengers));
    assert!(starts.iter().any(|state| state.taxi != fixed.taxi));
}

#[test]
fn painting_on_is_painting_anew() {
    let all = [Sizes::SMALL, Sizes::MEDIUM, Sizes::LARGE, Sizes::WIDE];
    let formats = [Format::NATIVE, Format::THESIS, Format::THESIS_GREY, Format::ATARI];
    for (sizes, format) in all.into_iter().flat_map(|sizes| formats.map(|format| (sizes, format))) {
        let mut world = VisualTaxi::new(Settings { sizes, passengers: 2, ..Settings::TEN }).unwrap();
        let mut painter = world.painter(format);
        let mut rng = Seed(6).stream("drive", 0);
        let [mut on, mut anew] = [Frame::default(), Frame::default()];
        for seed in 0..3 {
            world.begin(Layout::Random.draw(seed));
            for _ in 0..100 {
                world.act(rng.random_range(0..5));
                painter.paint(&world, &mut on);
                world.painter(format).paint(&world, &mut anew);
                assert!(on == anew, "{sizes:?}, {format:?}");
            }
        }
    }
}

/// What is scaled is the native picture, as [`Scaler`] scales it whole; the ink comes after.
#[test]
fn scaled_pictures_are_pictures_scaled() {
    for (ink, format) in [(Ink::Coloured, Format::THESIS), (Ink::Inverted, Format::ATARI)] {
        let mut world = VisualTaxi::new(Settings { ink, ..Settings::TEN }).unwrap();
        world.begin(Layout::Random.draw(3));
        let plain = VisualTaxi::new(Settings::TEN).unwrap();
        let [mut native, mut expected, mut found] = [Frame::default(), Frame::default(), Frame::default()];
        plain.painter(Format::NATIVE).paint(&world, &mut native);
        let row = |y, pixels: &mut [u8]| pixels.copy_from_slice(native.row(y));
        Scaler::new(native.size(), format).run(row, &mut expected);
        if ink == Ink::Inverted {
            expected.bytes_mut().iter_mut().for_each(|byte| *byte = if *byte == 255 { 0 } else { 255 });
        }
        world.painter(format).paint(&world, &mut found);
        assert!(found == expected, "{format:?}");
    }
}

#[test]
fn inverted_ink_is_all_or_nothing() {
    let [mut drawn, mut inverted] = [Frame::default(), Frame::default()];
    let mut plain = VisualTaxi::new(Settings::FIVE).unwrap();
    let ink = VisualTaxi::new(Settings { ink: Ink::Inverted, ..Settings::FIVE }).unwrap();
    plain.begin(Layout::Random.draw(8));
    plain.painter(Format::NATIVE).paint(&plain, &mut drawn);
    ink.painter(Format::NATIVE).paint(&plain, &mut inverted);
    let expected = drawn.bytes().iter().map(|&byte| if byte == 255 { 0 } else { 255 });
    assert!(inverted.bytes().iter().copied().eq(expected));
    assert!(inverted.bytes().contains(&0) && inverted.bytes().contains(&255));
}

/// visgrid's third way of drawing, of which no picture is recorded: derived from its rule for any size.
#[test]
fn a_cell_of_seven_pixels() {
    let mut world = VisualTaxi::new(Settings { sizes: Sizes::SMALL, ..Settings::FIVE }).unwrap();
    world.begin(Layout::Fixed(0).draw(0));
    let mut state = world.save();
    // The passenger waits in a corner, bound for red (number 2), where the taxi is.
    state.taxi = [0, 0];
    (state.passengers[0].cell, state.passengers[0].goal) = ([4, 4], 2);
    world.load(&state);
    let mut frame = Frame::default();
    world.painter(Format::NATIVE).paint(&world, &mut frame);
    assert_eq!(frame.size(), [48, 48]);
    let cell = |left: u32, top: u32| -> Vec<String> {
        let symbol = |x, y| match frame.pixel([left + x, top + y]) {
            [255, 255, 255] => '.',
            [255, 0, 0] => 'R',
            [26, 26, 26] => 'x',
            _ => '?',
        };
        (0..7).map(|y| (0..7).map(|x| symbol(x, y)).collect()).collect()
    };
    let taxi = ["RRRRRRR", "RxxxxxR", "Rx...xR", "Rx...xR", "Rx...xR", "RxxxxxR", "RRRRRRR"];
    assert_eq!(cell(5, 5), taxi);
    let waiting = [".......", ".......", "..xRx..", "..RxR..", "..xRx..", ".......", "......."];
    assert_eq!(cell(37, 37), waiting);
}

#[test]
fn too_many_passengers_are_refused() {
    let refused = |passengers| {
        VisualTaxi::new(Settings { passengers, ..Settings::FIVE }).err().map(|why| why.to_string())
    };
    assert_eq!(refused(4).as_deref(), Some("4 passengers where there are 4 depots; ask for 1 to 3"));
    assert_eq!(refused(0).as_deref(), Some("0 passengers where there are 4 depots; ask for 1 to 3"));
    assert_eq!(refused(3), None);
}

#[test]
fn proto_goals_of_the_visual_taxi_have_names() {
    let world = crowded(Town::FIVE, 2, Starts::Classic);
    let names = world.proto_goals();
    let mut bits = Bits::default();
    world.annotate(&mut bits);
    assert_eq!((names.len(), bits.len()), (25 + 2 * (25 + 1 + 4), names.len()));
    let State { taxi: [row, column], passengers } = world.state();
    let mut expected = vec![format!("taxi at {row},{column}")];
    for (who, passenger) in ["passenger 1", "passenger 2"].iter().zip(passengers) {
        let [row, column] = passenger.cell;
        let goal = Town::FIVE.depots()[usize::from(passenger.goal)].name;
        expected.extend([format!("{who} at {row},{column}"), format!("{who} to {goal}")]);
    }
    assert_eq!(bits.ones().map(|bit| names[bit].clone()).collect::<Vec<_>>(), expected);
}
