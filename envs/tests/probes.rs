//! The probes of controllability: what the agent does makes no difference to what is called uncontrollable, and all
//! the difference to the rest.

use std::collections::{BTreeMap, BTreeSet};

use inroads_envs::{
    Bits, Frame, ProtoGoals, Seed, Snapshot,
    probes::{DistractorGrid, Probe, ProbeError, TimerGrid},
    registry::{self, AnyAnnotated},
    world::{Drawn, Layout, Painter, World},
};
use inroads_sim::raster::Format;
use rand::RngExt;

fn bits(world: &impl Probe) -> Vec<usize> {
    let mut bits = Bits::default();
    world.annotate(&mut bits);
    bits.ones().collect()
}

/// In every state on a random walk: each action leads to the same uncontrollable bits; and each controllable bit is one
/// that some action brings about or not.
fn truth_holds<W: World + Probe>(mut world: W) {
    let names = world.proto_goals();
    let truth = world.controllable();
    assert_eq!(names.len(), truth.len());
    assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "a name twice");
    let mut hinges = vec![false; truth.len()];
    let mut seen = vec![false; truth.len()];
    let mut rng = Seed(1).stream("test", 0);
    for episode in 0..20 {
        world.begin(Layout::Random.draw(episode));
        for _ in 0..world.card().limit.unwrap() {
            let kept = world.save();
            let after: Vec<_> = (0..4)
                .map(|choice| {
                    world.load(&kept);
                    world.act(choice);
                    bits(&world)
                })
                .collect();
            for bit in 0..truth.len() {
                let holds: Vec<_> = after.iter().map(|bits| bits.contains(&bit)).collect();
                hinges[bit] |= holds.iter().any(|&held| held != holds[0]);
                seen[bit] |= holds.contains(&true);
            }
            world.load(&kept);
            world.act(rng.random_range(0..4));
        }
    }
    assert_eq!(hinges, truth);
    assert!(seen.iter().all(|&seen| seen), "a proto-goal that never holds");
}

#[test]
fn what_is_called_controllable_is_what_hinges_on_actions() {
    truth_holds(TimerGrid::new(4, 100).unwrap());
    truth_holds(TimerGrid::new(3, 7).unwrap());
    truth_holds(DistractorGrid::new(4, 0.5).unwrap());
    truth_holds(DistractorGrid::new(5, 0.1).unwrap());
}

#[test]
fn a_timer_reads_the_steps_and_one_place_holds() {
    let mut world = TimerGrid::new(4, 100).unwrap();
    world.begin(Layout::Random.draw(1));
    assert_eq!(bits(&world).len(), 1);
    for step in 1..=100 {
        world.act(step % 4);
        let bits = bits(&world);
        assert!(bits.len() == 2 && bits[0] < 16 && bits[1] == 15 + step, "{bits:?}");
        assert_eq!(world.proto_goals()[bits[1]], format!("timer reads {step}"));
    }
}

#[test]
fn lamps_light_up_as_often_as_they_should_and_each_by_itself() {
    for odds in [0.5, 0.1] {
        let mut world = DistractorGrid::new(4, odds).unwrap();
        world.begin(Layout::Random.draw(1));
        let steps = 4000;
        let mut lit = BTreeMap::<usize, u32>::new();
        let mut both = 0;
        for _ in 0..steps {
            world.act(0);
            let bits = bits(&world);
            both += u32::from(bits.contains(&16) && bits.contains(&17));
            bits.into_iter().filter(|&bit| bit >= 16).for_each(|bit| *lit.entry(bit).or_default() += 1);
        }
        let near = |count: u32, odds: f64| {
            let (steps, count) = (f64::from(steps), f64::from(count));
            (count - odds * steps).abs() < 4.5 * (odds * (1.0 - odds) * steps).sqrt()
        };
        assert!(lit.len() == 32 && lit.values().all(|&count| near(count, odds)), "{lit:?}");
        assert!(near(both, odds * odds), "{both}");
    }
}

/// Plays a whole episode twice and asks that all be the same, with a state brought back in the middle.
fn replays<W: World + Drawn>(mut world: W) {
    let mut other = world.clone();
    let (mut a, mut b) = (world.painter(Format::THESIS), other.painter(Format::THESIS));
    let (mut frames, mut symbols) = ([Frame::default(), Frame::default()], [Vec::new(), Vec::new()]);
    world.begin(Layout::Random.draw(5));
    for step in 0..40 {
        world.act(step % 3);
        if step == 17 {
            // From here on the other goes along; its painter starts in the middle.
            let kept = world.save();
            other.begin(Layout::Random.draw(8));
            other.act(0);
            other.load(&kept);
        } else if step > 17 {
            other.act(step % 3);
            world.symbols(&mut symbols[0]);
            other.symbols(&mut symbols[1]);
            a.paint(&world, &mut frames[0]);
            b.paint(&other, &mut frames[1]);
            assert!(symbols[0] == symbols[1] && frames[0] == frames[1]);
            other.painter(Format::THESIS).paint(&other, &mut frames[1]);
            assert!(frames[0] == frames[1], "painting anew is something else");
        }
    }
}

#[test]
fn states_come_back_to_the_bit_and_pictures_are_functions_of_them() {
    replays(TimerGrid::new(4, 100).unwrap());
    replays(DistractorGrid::new(4, 0.5).unwrap());
}

/// Nothing is hidden from who sees pictures, even scaled as the thesis has it.
#[test]
fn pictures_tell_all_readings_and_places_apart() {
    for (side, ticks) in [(4, 100), (2, 300)] {
        let mut world = TimerGrid::new(side, ticks).unwrap();
        let mut painter = world.painter(Format::THESIS);
        let mut seen = BTreeSet::new();
        for x in 0..side {
            for y in 0..side {
                for reading in 0..=ticks {
                    world.load(&([x, y], reading));
                    let mut frame = Frame::default();
                    painter.paint(&world, &mut frame);
                    seen.insert(frame.bytes().to_vec());
                }
            }
        }
        assert_eq!(seen.len() as u32, side * side * (ticks + 1));
    }
    let world = DistractorGrid::new(4, 0.5).unwrap();
    let mut frame = Frame::default();
    world.painter(Format::NATIVE).paint(&world, &mut frame);
    assert_eq!(
        (frame.size(), frame.pixel([0, 0]), frame.pixel([8, 0])),
        ([32, 32], &[255, 0, 0][..], &[0; 3][..])
    );
}

#[test]
fn the_start_is_anywhere_or_as_the_layout_says() {
    let mut world = TimerGrid::new(4, 100).unwrap();
    let mut starts = |layout: Layout| {
        let cells = (0..400).map(|episode| {
            world.begin(layout.draw(episode));
            bits(&world)[0]
        });
        cells.collect::<BTreeSet<_>>().len()
    };
    assert_eq!([Layout::Random, Layout::Fixed(42), Layout::FixedMap(42)].map(&mut starts), [16, 1, 16]);
}

#[test]
fn sizes_that_make_no_probe_are_told() {
    assert_eq!(TimerGrid::new(1, 100).unwrap_err(), ProbeError::Side(1));
    assert_eq!(DistractorGrid::new(33, 0.5).unwrap_err(), ProbeError::Side(33));
    assert_eq!(TimerGrid::new(4, 0).unwrap_err(), ProbeError::Ticks(0));
    for odds in [-0.5, 1.5, f64::NAN] {
        let text = DistractorGrid::new(4, odds).unwrap_err().to_string();
        assert!(text.contains("between 0 and 1"), "{text}");
    }
    assert!(TimerGrid::new(1, 1).unwrap_err().to_string().contains("between 2 and 32"));
    assert!(TimerGrid::new(32, 10_000).is_ok());
}

#[test]
fn the_registry_shows_the_proto_goals() {
    for (name, count) in [("timer-grid", 116), ("distractor-grid", 48)] {
        let Ok(AnyAnnotated::Vectors(mut env)) =
            registry::make_annotated(name, &registry::Options::default())
        else {
            panic!("{name} has no proto-goals")
        };
        env.reset(0);
        let mut seen = Default::default();
        env.observe(&mut seen);
        assert_eq!(seen.bits.len(), count);
        assert_eq!(env.spec().time_limit, Some(100));
    }
}
