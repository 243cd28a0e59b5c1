//! What cannot be is refused by name and changes nothing.

use rapier3d::math::Vector;

use super::{
    tests::{FINE, acrobat, bits, crowd, of, play, world},
    *,
};
use crate::{Shape, rigid::Joint};

/// What makes something wrong, and a part of what is said of it.
type Wrong<'a, T> = (&'a dyn Fn(&mut T), &'a str);

#[test]
fn states_that_cannot_be_are_refused_and_change_nothing() {
    let mut world = crowd();
    play(&mut world, 9, 20);
    let before = world.configuration().clone();
    let wrong = |change: &dyn Fn(&mut Configuration)| {
        let mut state = before.clone();
        change(&mut state);
        state
    };
    let cases: [Wrong<Configuration>; 6] = [
        (&|state| state.q.truncate(18), "18 positions and"),
        (&|state| state.v[3] = f32::NAN, "velocity 3 of the state is NaN"),
        (&|state| state.q[0] = f32::INFINITY, "position 0"),
        (&|state| state.q[3..7].fill(0.0), "quaternion at position 3"),
        (&|state| state.q[1] = 1.97, "deep in a wall"),
        (&|state| state.q[0] = -50.0, "inf m deep in a wall"),
    ];
    for (change, says) in cases {
        let fault = world.restore(&wrong(change)).unwrap_err().to_string();
        assert!(fault.contains(says), "{fault}");
        assert_eq!(world.configuration(), &before);
    }
    let mut twin = crowd();
    play(&mut twin, 9, 20);
    assert_eq!(bits(&play(&mut world, 10, 50)), bits(&play(&mut twin, 10, 50)), "the world went on unharmed");
}

#[test]
fn steps_that_cannot_be_made_are_refused() {
    let mut world = crowd();
    assert!(matches!(world.step(&[0.0; 4]), Err(PhysicsFault::Length { given: 4, expected: 5, .. })));
    let fault = world.step(&[0.0, f32::NAN, 0.0, 0.0, 0.0]).unwrap_err();
    assert_eq!(fault.to_string(), "control 1 is NaN; it must be a finite number");
    assert!(matches!(world.advance(&[0.0; 16], 0.01, 1), Err(PhysicsFault::Length { expected: 17, .. })));
    assert!(matches!(world.advance(&[0.0; 17], -1.0, 1), Err(PhysicsFault::NotFinite { .. })));
    assert!(matches!(world.advance(&[f32::INFINITY; 17], 0.01, 1), Err(PhysicsFault::NotFinite { .. })));
}

#[test]
fn a_simulation_that_breaks_down_says_so() {
    let mut world = world(acrobat(), FINE);
    let mut state = world.zero();
    state.v[6] = 3e38;
    world.restore(&state).unwrap();
    let fault = (0..10).find_map(|_| world.step(&[1.0, 1.0]).err());
    assert!(matches!(fault, Some(PhysicsFault::Diverged { .. })), "{fault:?} {:?}", world.configuration());
    world.restore(&world.zero()).unwrap();
    world.step(&[0.0, 0.0]).unwrap();
    assert!((world.configuration().q[2] - 10.0).abs() < 0.01, "restored as if nothing had been");
}

#[test]
fn models_that_cannot_be_built_name_the_link_and_the_mend() {
    let made = |model: Model| Articulated::new(&[model], Surroundings::default(), FINE).map(drop);
    let cases: [Wrong<Model>; 11] = [
        (&|model| model.links[2].parent = Some(99), "link \"lower\": its parent must stand before it"),
        (&|model| model.links.clear(), "model \"acrobat\": it has no links"),
        (&|model| model.links[2].parent = Some(2), "link \"lower\": its parent must stand before it"),
        (&|model| model.links[1].parent = None, "link \"upper\": only the first link has no parent"),
        (&|model| model.links[2].joint = Joint::Free, "link \"lower\": only a root can be free"),
        (&|model| of(model).axis = Vector::ZERO, "axis must have length 1"),
        (&|model| of(model).range = Some([1.0, 0.0]), "range must be finite, the least coordinate first"),
        (&|model| of(model).armature = -1.0, "damping, armature and friction"),
        (&|model| model.links[2].solids.clear(), "link \"lower\": it moves but has no mass"),
        (&|model| model.links[0].solids[0].shape = Shape::Ball { radius: 0.0 }, "sizes of its solids"),
        (&|model| model.actuators[1].link = 0, "actuator 1: its link has no hinge"),
    ];
    for (change, says) in cases {
        let mut model = acrobat();
        change(&mut model);
        let fault = made(model).unwrap_err().to_string();
        assert!(fault.contains(says), "{fault}");
    }
    let flat = Shape::Hull { points: vec![Vector::ZERO, Vector::X, Vector::Y, Vector::X + Vector::Y] };
    let mut model = acrobat();
    model.links[0].solids[0].shape = flat;
    let fault = made(model).err().map(|fault| fault.to_string());
    assert!(fault.is_some_and(|fault| fault.contains("hull")));
    let timeless = Physics { substeps: 0, ..FINE };
    assert!(matches!(
        Articulated::new(&[acrobat()], Surroundings::default(), timeless),
        Err(ModelError::Physics(_))
    ));
}
