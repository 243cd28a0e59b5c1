//! The engine against mechanics that can be worked out by hand.

use rapier3d::math::{Pose, Rotation, Vector};

use super::*;
use crate::{
    Shape,
    rigid::{Actuator, Axis, CellMap, Joint, Link, Mass, Part},
};

/// A hundredth of a second a step, in ten sub-steps.
pub(super) const FINE: Physics = Physics {
    control_step: 0.01,
    calls: 1,
    substeps: 10,
    relaxations: 1,
    prediction: 0.02,
    gravity: Physics::GRAVITY,
    limits: Limits::Hard,
};
const WEIGHTLESS: Physics = Physics { gravity: Vector::ZERO, ..FINE };

fn part(shape: Shape) -> Part {
    Part { shape, pose: Pose::IDENTITY, density: 100.0, friction: 1.0, solid: true }
}

fn axis(axis: Vector) -> Axis {
    Axis { axis, anchor: Vector::ZERO, range: None, damping: 0.0, armature: 0.0, friction: 0.0 }
}

fn link(name: &str, parent: Option<usize>, place: Vector, joint: Joint, solids: Vec<Part>) -> Link {
    Link { name: name.into(), parent, place: Pose::from_translation(place), joint, solids, mass: None }
}

/// A free torso with two arms that turn, the second on the first; its centre of mass is off its origin.
pub(super) fn acrobat() -> Model {
    let arm = Shape::Capsule { from: Vector::ZERO, to: Vector::X * 0.4, radius: 0.05 };
    let mut torso = part(Shape::Cuboid { half: Vector::new(0.2, 0.1, 0.05) });
    torso.pose = Pose::from_translation(Vector::new(0.1, 0.05, -0.02));
    Model {
        name: "acrobat".into(),
        links: vec![
            link("torso", None, Vector::new(0.0, 0.0, 10.0), Joint::Free, vec![torso]),
            link(
                "upper",
                Some(0),
                Vector::new(0.3, 0.0, 0.0),
                Joint::Hinge(axis(Vector::Z)),
                vec![part(arm.clone())],
            ),
            link("lower", Some(1), Vector::X * 0.4, Joint::Hinge(axis(Vector::Y)), vec![part(arm)]),
        ],
        actuators: vec![Actuator { link: 1, gear: 2.0 }, Actuator { link: 2, gear: 3.0 }],
    }
}

pub(super) fn world(model: Model, physics: Physics) -> Articulated {
    Articulated::new(&[model], Surroundings::default(), physics).unwrap()
}

/// Momentum and angular momentum about the world's origin.
fn momenta(world: &Articulated) -> (Vector, Vector) {
    world
        .trees
        .iter()
        .map(|tree| tree.momenta(&world.world))
        .fold((Vector::ZERO, Vector::ZERO), |(p, l), (q, m)| (p + q, l + m))
}

#[test]
fn a_body_in_free_fall_and_spin_keeps_energy_and_momentum_to_a_hundredth() {
    let mut world = world(acrobat(), WEIGHTLESS);
    let mut start = world.zero();
    start.v = vec![0.3, -0.2, 0.1, 1.0, -0.5, 2.0, 1.5, -1.0];
    world.restore(&start).unwrap();
    let (energy, (p, l)) = (world.energy(), momenta(&world));
    for _ in 0..300 {
        world.step(&[0.0, 0.0]).unwrap();
    }
    let (after, (p2, l2)) = (world.energy(), momenta(&world));
    assert!((after / energy - 1.0).abs() < 0.01, "energy went from {energy} to {after}");
    assert!((p2 - p).length() < 0.01 * p.length(), "momentum went from {p} to {p2}");
    assert!((l2 - l).length() < 0.01 * l.length(), "angular momentum went from {l} to {l2}");
}

#[test]
fn a_dropped_body_falls_as_galilei_says() {
    let mut world = world(acrobat(), FINE);
    for _ in 0..100 {
        world.step(&[0.0, 0.0]).unwrap();
    }
    let (z, v) = (world.configuration().q[2], world.configuration().v[2]);
    // Symplectic Euler with sub-steps of 1 ms falls half a sub-step more.
    assert!((z - (10.0 - 9.81 / 2.0)).abs() < 0.006 && (v + 9.81).abs() < 1e-3, "{z} m, {v} m/s");
}

/// A bar of 2 kg that turns about the world's vertical, 0.5 m from its middle.
fn gate() -> Model {
    let bar = Shape::Cuboid { half: Vector::new(0.5, 0.05, 0.1) };
    let mut leaf =
        link("leaf", None, Vector::new(1.0, 0.5, 3.0), Joint::Hinge(axis(Vector::Z)), vec![part(bar)]);
    let place = Pose::from_translation(Vector::X * 0.5);
    leaf.mass = Some(Mass { mass: 2.0, place, inertia: Vector::new(0.1, 0.1, 0.25) });
    Model { name: "gate".into(), links: vec![leaf], actuators: vec![Actuator { link: 0, gear: 3.0 }] }
}

/// A carriage of 4 kg on a fixed rail along the diagonal of x and z.
fn rail() -> Model {
    let along = Vector::new(1.0, 0.0, 1.0).normalize();
    let carriage = Shape::Ball { radius: 0.1 };
    let bed = Shape::Cuboid { half: Vector::new(1.0, 0.1, 0.1) };
    let mut moving = link("carriage", Some(0), Vector::Z, Joint::Slide(axis(along)), vec![part(carriage)]);
    moving.mass = Some(Mass { mass: 4.0, place: Pose::IDENTITY, inertia: Vector::splat(0.1) });
    Model {
        name: "rail".into(),
        links: vec![link("bed", None, Vector::new(5.0, 0.0, 0.0), Joint::Fixed, vec![part(bed)]), moving],
        actuators: vec![Actuator { link: 1, gear: 8.0 }],
    }
}

/// The only axis of a model.
pub(super) fn of(model: &mut Model) -> &mut Axis {
    match &mut model.links.last_mut().unwrap().joint {
        Joint::Hinge(axis) | Joint::Slide(axis) => axis,
        _ => panic!("it does not move"),
    }
}

#[test]
fn a_torque_accelerates_a_hinge_by_its_inertia_and_its_rotors() {
    for (armature, damping) in [(0.0, 0.0), (1.25, 0.0), (0.25, 2.0)] {
        let mut model = gate();
        (of(&mut model).armature, of(&mut model).damping) = (armature, damping);
        let mut world = world(model, WEIGHTLESS);
        for _ in 0..20 {
            world.step(&[0.5]).unwrap();
        }
        // 0.25 about the middle, 2 (1/2)² for the way from there to the hinge; torque 3/2.
        let inertia = 0.25 + 0.5 + armature;
        let speed = if damping == 0.0 {
            1.5 / inertia * 0.2
        } else {
            1.5 / damping * (1.0 - (-damping / inertia * 0.2_f32).exp())
        };
        let v = world.configuration().v[0];
        assert!((v / speed - 1.0).abs() < 2e-3, "{v} rad/s instead of {speed} with armature {armature}");
        assert!((world.energy() - inertia * v * v / 2.0).abs() < 1e-3 * world.energy());
    }
}

#[test]
fn a_slide_runs_along_its_axis_and_only_there() {
    let mut world = world(rail(), FINE);
    for _ in 0..50 {
        world.step(&[-1.0]).unwrap();
    }
    // Half a second under −8 N and the share of gravity along the rail.
    let acceleration = -2.0 - 9.81 * 0.5_f32.sqrt();
    let (q, v) = (world.configuration().q[0], world.configuration().v[0]);
    assert!(
        (v / (acceleration * 0.5) - 1.0).abs() < 2e-3 && (q / (acceleration / 8.0) - 1.0).abs() < 5e-3,
        "{q} {v}"
    );
    let at = world.link_pose(0, 1).translation - Vector::new(5.0, 0.0, 1.0);
    assert!((at - Vector::new(q, 0.0, q) * 0.5_f32.sqrt()).length() < 1e-4, "{at}");
    assert_eq!(world.link_pose(0, 0).translation, Vector::new(5.0, 0.0, 0.0), "the bed is fixed");
}

#[test]
fn a_range_stops_a_joint_and_dry_friction_holds_it() {
    let mut held = rail();
    of(&mut held).friction = 40.0;
    let mut world = Articulated::new(&[held], Surroundings::default(), FINE).unwrap();
    world.step(&[-1.0]).unwrap();
    assert!(world.configuration().v[0].abs() < 1e-3, "36 N do not move what 40 N hold");

    let mut stopped = rail();
    of(&mut stopped).range = Some([-0.3, 0.0]);
    let mut world = Articulated::new(&[stopped], Surroundings::default(), FINE).unwrap();
    for _ in 0..200 {
        world.step(&[-1.0]).unwrap();
    }
    let (q, v) = (world.configuration().q[0], world.configuration().v[0]);
    assert!((q + 0.3).abs() < 1e-3 && v.abs() < 1e-2, "{q} m, {v} m/s");
}

#[test]
fn forces_on_a_free_root_act_as_in_mujoco() {
    let mut model = acrobat();
    model.links.truncate(1);
    model.actuators.clear();
    model.links[0].mass =
        Some(Mass { mass: 2.0, place: Pose::from_translation(Vector::X * 0.1), inertia: Vector::splat(0.5) });
    let turn = Rotation::from_axis_angle(Vector::Z, 0.5);
    model.links[0].place.rotation = turn;
    let mut world = world(model, WEIGHTLESS);
    for _ in 0..10 {
        world.advance(&[0.0, 3.0, 0.0, 0.7, 0.0, 0.0], 0.001, 1).unwrap();
    }
    // A force at the origin, 0.1 m from the centre of mass, turns the body too; torques are in the body's frame.
    let force = Vector::Y * 3.0;
    let centre = turn * (Vector::X * 0.1);
    let spin = turn * (Vector::X * 0.7) - centre.cross(force);
    let angular = turn.inverse() * (spin / 0.5) * 0.01;
    let linear = force / 2.0 * 0.01 - (turn * angular).cross(centre);
    let v = &world.configuration().v;
    assert!((Vector::from_slice(&v[..3]) - linear).length() < 1e-5, "{v:?} instead of {linear}");
    assert!((Vector::from_slice(&v[3..]) - angular).length() < 1e-5, "{v:?} instead of {angular}");
}

#[test]
fn welded_links_weigh_as_if_they_were_one() {
    let mut loose = gate();
    let bar = part(Shape::Cuboid { half: Vector::new(0.3, 0.1, 0.2) });
    loose.links[0].mass = None;
    loose.links[0].solids = vec![bar.clone()];
    let mut welded = loose.clone();
    welded.links.push(link("plate", Some(0), Vector::X * 0.7, Joint::Fixed, vec![bar.clone()]));
    let mut shifted = bar;
    shifted.pose = Pose::from_translation(Vector::X * 0.7);
    loose.links[0].solids.push(shifted);
    let speed = |model: Model| {
        let mut world = world(model, WEIGHTLESS);
        world.step(&[1.0]).unwrap();
        world.configuration().v[0]
    };
    assert!((speed(loose) / speed(welded) - 1.0).abs() < 1e-5);
}

/// Two acrobats and a gate above a floor in a maze.
pub(super) fn crowd() -> Articulated {
    let map = CellMap::parse("#####\n#r..#\n#####", 4.0).unwrap();
    let mut second = acrobat();
    second.links[0].place.translation = Vector::new(4.0, 0.0, 1.0);
    let mut first = acrobat();
    first.links[0].place.translation.z = 0.5;
    let around = Surroundings { floor: Some(0.0), walls: Some(&map) };
    Articulated::new(&[first, gate(), second], around, Physics { substeps: 2, prediction: 0.1, ..FINE })
        .unwrap()
}

/// Numbers in [-1, 1] from a seed (Knuth's linear congruence).
fn numbers(mut seed: u64) -> impl FnMut() -> f32 {
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f32 / (1_u64 << 23) as f32 - 1.0
    }
}

pub(super) fn play(world: &mut Articulated, seed: u64, steps: usize) -> Vec<Configuration> {
    let mut number = numbers(seed);
    (0..steps)
        .map(|_| {
            let controls: Vec<_> = (0..world.actuators()).map(|_| number()).collect();
            world.step(&controls).unwrap();
            world.configuration().clone()
        })
        .collect()
}

pub(super) fn bits(states: &[Configuration]) -> Vec<u32> {
    states.iter().flat_map(|state| state.q.iter().chain(&state.v)).map(|x| x.to_bits()).collect()
}

#[test]
fn what_follows_a_restored_state_does_not_depend_on_what_came_before() {
    let mut fresh = crowd();
    let start = fresh.zero();
    fresh.restore(&start).unwrap();
    let expected = play(&mut fresh, 1, 300);
    let mut used = crowd();
    play(&mut used, 2, 777);
    used.restore(&start).unwrap();
    assert_eq!(bits(&play(&mut used, 1, 300)), bits(&expected));

    // And from a state in the midst of things, with contacts and speed.
    let middle = expected[150].clone();
    used.restore(&middle).unwrap();
    fresh.restore(&middle).unwrap();
    assert_eq!(bits(std::slice::from_ref(used.configuration())), bits(std::slice::from_ref(&middle)));
    assert_eq!(bits(&play(&mut used, 3, 300)), bits(&play(&mut fresh, 3, 300)));
}

#[test]
fn what_follows_a_loaded_snapshot_is_what_followed_it_at_first() {
    let mut world = crowd();
    play(&mut world, 4, 200);
    let saved = world.save();
    let expected = play(&mut world, 5, 300);
    play(&mut world, 6, 50);
    world.load(&saved);
    assert_eq!(bits(&play(&mut world, 5, 300)), bits(&expected));
    let mut other = crowd();
    play(&mut other, 7, 33);
    other.load(&saved);
    assert_eq!(bits(&play(&mut other, 5, 300)), bits(&expected), "in another world of the same make");
}

#[test]
fn positions_that_are_set_are_those_that_are_read() {
    let mut world = crowd();
    let mut state = world.zero();
    let mut number = numbers(8);
    for x in state.q.iter_mut().chain(&mut state.v) {
        *x += 0.1 * number();
    }
    world.restore(&state).unwrap();
    world.trees[0].read(&world.world, &mut world.configuration);
    let read = world.configuration().clone();
    world.restore(&read).unwrap();
    world.trees[0].read(&world.world, &mut world.configuration);
    for (x, y) in [(&read.q, &world.configuration().q), (&read.v, &world.configuration().v)] {
        assert!(x.iter().zip(y).all(|(x, y)| (x - y).abs() < 1e-5), "{read:?}\n{:?}", world.configuration());
    }
    let length: f32 = read.q[3..7].iter().map(|x| x * x).sum();
    assert!((length - 1.0).abs() < 1e-5);
}

#[test]
fn bodies_rest_on_the_floor_and_say_what_they_touch() {
    let mut block = acrobat();
    block.links.truncate(1);
    block.actuators.clear();
    block.links[0].place.translation.z = 0.1;
    let around = Surroundings { floor: Some(0.0), walls: None };
    let mut world = Articulated::new(&[block], around, FINE).unwrap();
    for _ in 0..200 {
        world.step(&[]).unwrap();
    }
    let weight = 0.4 * 0.2 * 0.1 * 100.0 * 9.81;
    let contacts: Vec<_> = world.contacts().collect();
    let [contact] = contacts[..] else { panic!("{contacts:?}") };
    assert!([contact.first, contact.second].contains(&Party::Link { model: 0, link: 0 }));
    assert!([contact.first, contact.second].contains(&Party::Floor));
    assert!((contact.force / weight - 1.0).abs() < 0.05, "{} N instead of {weight} N", contact.force);
    // The block's underside is 7 cm below its origin.
    assert!((world.configuration().q[2] - 0.07).abs() < 0.01, "{:?}", world.configuration());
}
