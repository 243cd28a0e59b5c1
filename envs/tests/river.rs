//! Invariants of river crossings.

use inroads_envs::{
    Bits, Environment, ProtoGoals, Seed, Snapshot,
    river::{
        GOAL, Ground, HEALTH, Kind, Map, Message, Monster, River, RiverError, Setting, Text, Turn, WAYS,
    },
    world::{Grain, Layout, Pictured, Symbolic, World},
};
use inroads_sim::raster::Format;
use rand::RngExt;

const SETTINGS: [Setting; 4] =
    [Setting::NARROW, Setting::WIDE.monsters(5), Setting::LAVA, Setting::LAVA.monsters(32)];

fn river(setting: Setting) -> River {
    River::new(setting).expect("a river that there is")
}

/// A river with nothing in it but what `put` puts there.
fn empty(setting: Setting, put: impl FnOnce(&mut inroads_envs::river::State)) -> River {
    let mut river = river(Setting { boulders: 0, monsters: 0, ..setting });
    let mut state = river.save();
    put(&mut state);
    river.load(&state);
    river
}

fn at(place: [i8; 2]) -> usize {
    Map::cell(place).expect("on the map")
}

/// Mostly eastwards, so that boulders come to the river.
fn choice(rng: &mut inroads_envs::Rng) -> usize {
    if rng.random_bool(0.5) { 1 } else { rng.random_range(0..WAYS.len()) }
}

#[test]
fn boulders_are_kept_and_nobody_is_in_one() {
    let (mut filled, mut lost, mut won) = (0, 0, 0);
    for setting in SETTINGS {
        let mut river = river(setting);
        for seed in 0..200 {
            let mut rng = Seed(seed).stream("test", 0);
            river.begin(Layout::Random.draw(seed));
            let start = river.state().hero;
            let mut moved = false;
            for _ in 0..350 {
                let step = river.act(choice(&mut rng));
                let state = river.state();
                assert_eq!(state.map.all_boulders() + state.filled + state.lost, setting.boulders);
                moved |= state.hero != start;
                let cell = at(state.hero);
                // MiniHack may put the hero on a boulder at first; he never gets there later, nor into the river.
                if step.end.is_none() {
                    assert_eq!(state.map.ground(cell), Ground::Floor);
                    assert!(state.map.boulders(cell) == 0 || state.hero == start && !moved);
                }
                let alive = || state.monsters.iter().filter(|monster| monster.health > 0);
                for monster in alive() {
                    assert!(state.map.free(at(monster.place)) && monster.place != state.hero);
                    assert_eq!(alive().filter(|other| other.place == monster.place).count(), 1);
                }
                assert!(
                    state.health <= HEALTH && (state.health > 0) == (step.end.is_none() || step.reward > 0.0)
                );
                if step.end.is_some() {
                    break;
                }
            }
            filled += river.state().filled;
            lost += river.state().lost;
            won += u32::from(river.state().hero == GOAL);
        }
    }
    assert!(filled > 50 && lost > 5, "{filled} filled, {lost} lost, {won} won");
}

#[test]
fn what_follows_a_load_is_what_followed_the_save() {
    for setting in SETTINGS {
        let mut env = Symbolic::new(river(setting), Layout::Random);
        for seed in 0..20 {
            let mut rng = Seed(seed).stream("test", 0);
            env.reset(seed);
            let mut over = false;
            for _ in 0..20 {
                over |= env.step(&choice(&mut rng)).is_ok_and(|step| step.end.is_some());
            }
            if over {
                continue;
            }
            let saved = env.save();
            let choices: Vec<_> = (0..100).map(|_| choice(&mut rng)).collect();
            let play = |env: &mut Symbolic<River>| -> Vec<_> {
                let mut seen = Vec::new();
                let mut step = |&choice: &usize| {
                    let step = env.step(&choice).ok();
                    env.observe(&mut seen);
                    (step, seen.clone(), env.world().heard().to_vec())
                };
                choices.iter().map(&mut step).collect()
            };
            let first = play(&mut env);
            env.reset(seed + 1000);
            env.load(&saved);
            assert_eq!(play(&mut env), first);
        }
    }
}

#[test]
fn pictures_are_of_the_state_alone() {
    let mut env = Pictured::new(river(SETTINGS[3]), Layout::Random, Format::NATIVE).expect("a format");
    let (mut on, mut anew) = (Default::default(), Default::default());
    for seed in 0..3 {
        let mut rng = Seed(seed).stream("test", 0);
        env.reset(seed);
        for _ in 0..50 {
            if env.step(&choice(&mut rng)).map_or(true, |step| step.end.is_some()) {
                break;
            }
            env.observe(&mut on);
            let mut other =
                Pictured::new(river(SETTINGS[3]), Layout::Random, Format::NATIVE).expect("a format");
            other.load(&env.save());
            other.observe(&mut anew);
            assert_eq!(on, anew);
        }
    }
}

#[test]
fn layouts_are_the_seeds() {
    let mut river = river(Setting::WIDE.monsters(3));
    let mut begun = |layout: Layout, seed| {
        river.begin(layout.draw(seed));
        river.save()
    };
    assert_eq!(begun(Layout::Random, 7), begun(Layout::Random, 7));
    assert_ne!(begun(Layout::Random, 7).map, begun(Layout::Random, 8).map);
    let (a, b) = (begun(Layout::Fixed(42), 1), begun(Layout::Fixed(42), 2));
    assert!(
        a.map == b.map && a.hero == b.hero && a.monsters == b.monsters && a != b,
        "only what comes differs"
    );
    let heroes: std::collections::HashSet<_> = (0..50)
        .map(|seed| {
            let begun = begun(Layout::FixedMap(42), seed);
            assert!(begun.map == a.map && begun.map.free(at(begun.hero)));
            begun.hero
        })
        .collect();
    assert!(heroes.len() > 20);
}

/// Where MiniHack's boulders lie: a chi-square of 18 columns, 5 rows.
#[test]
fn boulders_are_strewn_evenly() {
    let mut river = river(Setting::WIDE);
    let mut counts = vec![0_u32; 18 * 5];
    for seed in 0..2000 {
        river.begin(Layout::Random.draw(seed));
        for x in 1..=18 {
            for y in 1..=5 {
                counts[(x as usize - 1) * 5 + y as usize - 1] +=
                    u32::from(river.state().map.boulders(at([x, y])));
            }
        }
    }
    let expected = 10_000.0 / counts.len() as f64;
    let square: f64 = counts.iter().map(|&n| (f64::from(n) - expected).powi(2) / expected).sum();
    // 89 degrees of freedom: 150 is passed once in 20,000 times.
    assert!(counts.iter().sum::<u32>() == 10_000 && square < 150.0, "{square}");
}

#[test]
fn a_fall_ends_on_every_bank_alike() {
    // The last column of a narrow river, the first one filled: west by the filled cell, or east.
    let river = empty(Setting::NARROW, |state| {
        state.map.fill(at([18, 3]));
        state.hero = [18, 3];
    });
    let outcomes = river.outcomes(1);
    let mut places: Vec<_> = outcomes.iter().map(|outcome| outcome.state.hero).collect();
    places.sort_unstable();
    assert_eq!(places, [[18, 3], [20, 2], [20, 3], [20, 4]]);
    assert!(
        outcomes.iter().all(|outcome| (outcome.chance - 0.25).abs() < 1e-12 && outcome.turn == Turn::Passed)
    );
}

#[test]
fn who_crawls_out_onto_the_stairs_has_won() {
    // The last column of the widest river: the bank across is the column of the stairs.
    let river = empty(Setting { wide: 6, ..Setting::WIDE }, |state| {
        state.map.fill(at([22, 2]));
        state.hero = [22, 2];
    });
    let outcomes = river.outcomes(1);
    let mut places: Vec<_> = outcomes.iter().map(|outcome| (outcome.state.hero, outcome.turn)).collect();
    places.sort_unstable_by_key(|(place, _)| *place);
    let passed = |place| (place, Turn::Passed);
    assert_eq!(places, [passed([22, 2]), passed([24, 1]), (GOAL, Turn::Won), passed([24, 3])]);
    assert!(outcomes.iter().all(|outcome| outcome.state.log().last() == Some(&Message::Pheew)));
    assert!(
        outcomes.iter().all(|outcome| (outcome.turn.step().reward > 0.0) == (outcome.state.hero == GOAL))
    );
}

#[test]
fn a_search_passes_over_the_clocks() {
    for (setting, grain) in [(Setting::WIDE, Grain::Exact), (Setting::WIDE.monsters(2), Grain::Coarse)] {
        let mut river = river(setting);
        let marks = |river: &River| {
            let mut numbers = Vec::new();
            (river.landmark(&mut numbers), numbers)
        };
        let first = marks(&river);
        assert_eq!((first.0, first.1.len() + 2), (grain, river.card().symbols.len()));
        let begun = river.save();
        let mut changed = |change: fn(&mut inroads_envs::river::State)| {
            let mut state = begun.clone();
            change(&mut state);
            river.load(&state);
            marks(&river) != first
        };
        assert!(!changed(|state| (state.rested, state.clock) = (3, 9)));
        assert!(changed(|state| state.health -= 1) && changed(|state| state.map.fill(at([19, 3]))));
        assert!(changed(|state| state.map.add_boulder(at([5, 5]))));
        assert!(changed(|state| state.hero[1] = (state.hero[1] + 1) % 7));
        assert!(changed(|state| state.hero[0] = (state.hero[0] + 1) % 18));
    }
}

#[test]
fn a_pile_is_pushed_one_by_one() {
    let river = empty(Setting::NARROW, |state| {
        state.hero = [3, 3];
        state.rested = 3;
        state.map.add_boulder(at([4, 3]));
        state.map.add_boulder(at([4, 3]));
    });
    let [outcome] = &river.outcomes(1)[..] else { panic!("nothing is left to chance") };
    assert_eq!((outcome.turn, outcome.state.hero), (Turn::Idle, [3, 3]));
    assert_eq!(outcome.state.log(), [Message::Effort, Message::InVain]);
    let boulders = [[4, 3], [5, 3]].map(|place| outcome.state.map.boulders(at(place)));
    assert_eq!(boulders, [1, 1]);
}

#[test]
fn a_lichen_holds_on_until_it_is_dead_or_left() {
    let mut river = empty(Setting::NARROW, |state| {
        state.hero = [3, 3];
        state.monsters.push(Monster { kind: Kind::Lichen, place: [4, 3], health: 1 });
        state.holder = Some(0);
    });
    let free: f64 =
        river.outcomes(3).iter().filter(|outcome| outcome.state.hero == [2, 3]).map(|o| o.chance).sum();
    assert!((free - 3.0 / 40.0).abs() < 1e-12);
    let killed: f64 =
        river.outcomes(1).iter().filter(|outcome| outcome.state.holder.is_none()).map(|o| o.chance).sum();
    // Its armour class is 9: a throw of 1 to 10 of 20.
    assert!((killed - 0.5).abs() < 1e-12);
    river.act(3);
    assert!(river.state().log().iter().any(|message| matches!(message, Message::Held(_) | Message::Free(_))));
}

#[test]
fn goals_are_the_words_of_the_turn() {
    let put = |state: &mut inroads_envs::river::State| {
        state.hero = [16, 3];
        state.map.add_boulder(at([17, 3]));
    };
    let mut bits = Bits::default();
    for text in [Text::Whole, Text::LastLine] {
        let mut river = empty(Setting { text, ..Setting::WIDE }, put);
        let names = river.proto_goals();
        river.annotate(&mut bits);
        assert_eq!((bits.len(), bits.ones().count()), (names.len(), 0), "nothing is said at first");
        river.act(1);
        river.annotate(&mut bits);
        let said: Vec<_> = bits.ones().map(|bit| names[bit].as_str()).collect();
        match river.state().filled {
            1 => assert_eq!(
                said,
                ["boulder", "can", "cross", "into", "it", "now", "push", "the", "water", "you"]
            ),
            _ if text == Text::LastLine => assert_eq!(said, ["a", "it", "sinks", "trace", "without"]),
            _ => assert!(said.contains(&"water") && said.contains(&"sinks")),
        }
        // Nothing is left of it a step later.
        river.act(3);
        river.annotate(&mut bits);
        assert_eq!(bits.ones().count(), 0);
    }
}

/// An agent of NLE reads the last line alone of what is said of a fall.
#[test]
fn who_falls_into_water_reads_as_much_as_is_set() {
    let mut bits = Bits::default();
    let mut fall = |text| {
        let mut river = empty(Setting { text, ..Setting::WIDE }, |state| state.hero = [17, 3]);
        let names = river.proto_goals();
        assert_eq!(river.told(), None, "nothing is said at first");
        river.act(1);
        river.annotate(&mut bits);
        let said: Vec<_> = bits.ones().map(|bit| names[bit].clone()).collect();
        (river.told().expect("something is said"), said)
    };
    let (line, said) = fall(Text::LastLine);
    assert_eq!(
        (line.as_str(), said),
        ("Pheew!  That was close.", ["close", "pheew", "that", "was"].map(String::from).to_vec())
    );
    let (line, said) = fall(Text::Whole);
    assert!(
        line.starts_with("You fall into the water!  ") && line.ends_with("Pheew!  That was close."),
        "{line}"
    );
    assert!(["water", "sack", "pheew"].iter().all(|word| said.iter().any(|other| other == word)), "{said:?}");
}

#[test]
fn rivers_that_cannot_be_are_refused() {
    let refusal = |setting: Setting| River::new(setting).map(|_| ()).unwrap_err();
    assert_eq!(refusal(Setting { wide: 7, ..Setting::WIDE }), RiverError::Wide(7));
    assert_eq!(refusal(Setting { wide: 0, ..Setting::WIDE }), RiverError::Wide(0));
    assert_eq!(refusal(Setting { boulders: 86, ..Setting::WIDE }), RiverError::Boulders(86));
    let text = refusal(Setting::WIDE.monsters(33)).to_string();
    assert!(text.contains("33 monsters") && text.contains("at most 32"), "{text}");
}
