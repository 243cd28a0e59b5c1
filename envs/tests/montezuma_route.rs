//! The screen can be solved: the shortest way to the key and on through a door, by breadth-first search over the whole
//! game in decisions of four frames.

use std::collections::HashSet;

use inroads_envs::{
    Snapshot,
    montezuma::{Hold, Key, Montezuma, Rules, Scene, TARGETS},
    world::{Layout, World},
};

/// Choices that differ: with the button, up and down say nothing.
const CHOICES: [usize; 12] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12];

/// The choices of a shortest way from the start through a door, of all ways or of those on which nobody dies.
///
/// Lives are given back as they are lost, so that scenes with more and fewer are one: what is found is a shortest way of
/// the game without end, and so of the game if it dies less than five times.
fn shortest(mortal: bool) -> Vec<usize> {
    let mut game = Montezuma::new(Rules::default()).unwrap();
    game.begin(Layout::Fixed(0).draw(0));
    let mut frontier = vec![(game.save(), 0)];
    // For each state, in the order in which they were found: the one before it, and the choice.
    let mut found = vec![(0, 0)];
    let mut seen: HashSet<Scene> = HashSet::new();
    while !frontier.is_empty() {
        let mut next = Vec::new();
        for (state, number) in frontier {
            game.load(&state);
            game.act(CHOICES[0]);
            // Who does nothing and is in the air all the time could not have done anything else.
            let helpless = [state[0].player.hold, game.scene().player.hold];
            let helpless = helpless == [Hold::Air; 2] || helpless == [Hold::Dead; 2];
            for &choice in &CHOICES[..if helpless { 1 } else { CHOICES.len() }] {
                game.load(&state);
                let step = game.act(choice);
                let [mut scene, before] = game.save();
                if !mortal && scene.player.hold == Hold::Dead {
                    continue;
                }
                // Neither matters to what follows.
                (scene.lives, scene.player.left) = (5, false);
                if scene.key == Key::Used || seen.insert(scene) {
                    found.push((number, choice));
                    next.push(([scene, before], found.len() - 1));
                }
                if step.end.is_some() && scene.key == Key::Used {
                    let back = |&number: &usize| Some(found[number].0).filter(|_| number != 0);
                    let mut way: Vec<usize> = std::iter::successors(Some(found.len() - 1), back).collect();
                    way.pop();
                    return way.iter().rev().map(|&number| found[number].1).collect();
                }
            }
        }
        frontier = next;
    }
    panic!("no way through a door");
}

/// Plays it, and tells decisions up to the key, all decisions, points, and lives that are left.
fn played(way: &[usize]) -> (usize, usize, f32, u8) {
    let mut game = Montezuma::new(Rules::default()).unwrap();
    game.begin(Layout::Fixed(0).draw(0));
    let mut attained = [false; TARGETS.len()];
    let mut play = |&choice: &usize| {
        let step = game.act(choice);
        (0..TARGETS.len()).for_each(|target| attained[target] |= game.attained(target));
        step
    };
    let steps: Vec<_> = way.iter().map(&mut play).collect();
    let missed: Vec<_> = TARGETS.iter().zip(attained).filter(|(_, attained)| !attained).collect();
    assert!(missed.len() == 1 && missed[0].0.name.contains("door"), "{missed:?}");
    let key = steps.iter().position(|step| step.reward == 100.0).unwrap() + 1;
    assert!(steps.last().unwrap().end.is_some());
    (key, way.len(), steps.iter().map(|step| step.reward).sum(), game.scene().lives)
}

#[test]
fn the_shortest_way_takes_the_key_dies_and_opens_a_door() {
    assert_eq!(played(&shortest(true)), (127, 164, 400.0, 4));
}

#[test]
fn nobody_need_die() {
    assert_eq!(played(&shortest(false)), (127, 265, 400.0, 5));
}
