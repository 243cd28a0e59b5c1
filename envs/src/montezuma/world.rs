//! The rules of the game: decisions, keys, doors, lives.

use rand::RngExt;

use super::hazards::Skull;
use super::options::{STARTS, TARGETS};
use super::player::{Hold, PIXEL, Player, Status, Stick, Terrain};
use super::rules::{Rules, RulesError};
use super::screen::{ENTRY, HEIGHT, KEY, SKULL_RANGE, WIDTH, from_ram};
use crate::world::{Card, Draw, Fact, Layout, World};
use crate::{Dimension, End, Snapshot, Step, Sweep};

/// What the 18 choices press, in ALE's order.
pub const ACTIONS: [&str; 18] = [
    "noop",
    "fire",
    "up",
    "right",
    "left",
    "down",
    "up right",
    "up left",
    "down right",
    "down left",
    "up fire",
    "right fire",
    "left fire",
    "down fire",
    "up right fire",
    "up left fire",
    "down right fire",
    "down left fire",
];

/// What the key earns (the real game's points).
pub const KEY_REWARD: f32 = 100.0;
/// What opening a door earns (the real game's points).
pub const DOOR_REWARD: f32 = 300.0;
/// Frames from a death to the next life (invented).
pub const MOURNING: u8 = 32;
/// Frames after which an episode is truncated: the author's cap, half an hour of play.
pub const FRAMES: u32 = 30 * 60 * 60;

/// Where the key is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Key {
    /// Where it hangs at first.
    Hanging,
    /// In the player's hands.
    Held,
    /// In the lock of an open door.
    Used,
}

/// All that there is on the screen in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Scene {
    /// The player.
    pub player: Player,
    /// The skull.
    pub skull: Skull,
    /// The key.
    pub key: Key,
    /// Which doors are open, left and right.
    pub open: [bool; 2],
    /// Lives that are left, the present one included.
    pub lives: u8,
    /// Frames until the next life, 0 in the course of one.
    pub mourning: u8,
}

impl Scene {
    /// The game's points.
    pub fn score(&self) -> u32 {
        let key = u32::from(self.key != Key::Hanging) * KEY_REWARD as u32;
        key + self.open.map(u32::from).iter().sum::<u32>() * DOOR_REWARD as u32
    }
}

/// The game. `Clone` and [`Snapshot`] are cheap: it is some dozens of bytes, and nothing in it is left to chance.
#[derive(Clone, Debug)]
pub struct Montezuma {
    rules: Rules,
    drift: [i32; 2],
    now: Scene,
    before: Scene,
}

impl Montezuma {
    /// The game by these rules.
    ///
    /// # Errors
    /// [`RulesError`] names the value that makes no game.
    pub fn new(rules: Rules) -> Result<Self, RulesError> {
        rules.check()?;
        let scene = Scene {
            player: Player::at(ENTRY),
            skull: Skull::START,
            key: Key::Hanging,
            open: [false; 2],
            lives: rules.lives,
            mourning: 0,
        };
        Ok(Self { rules, drift: rules.belts.drift(), now: scene, before: scene })
    }

    /// The rules.
    pub fn rules(&self) -> &Rules {
        &self.rules
    }

    /// The present frame.
    pub fn scene(&self) -> &Scene {
        &self.now
    }

    /// The frame before it; the same when an episode has just begun.
    pub fn before(&self) -> &Scene {
        &self.before
    }

    /// Whether one of [`TARGETS`] is attained now.
    ///
    /// # Panics
    /// When there is no such target.
    pub fn attained(&self, target: usize) -> bool {
        TARGETS[target].attains(self.now.player.ram(), self.now.key != Key::Hanging)
    }

    /// Begins with the player there, and the skull at a place.
    fn put(&mut self, player: Player, skull: Skull) {
        let lives = self.rules.lives;
        self.now = Scene { player, skull, key: Key::Hanging, open: [false; 2], lives, mourning: 0 };
        self.before = self.now;
    }

    /// One frame. Gives what it earned, in points.
    fn frame(&mut self, stick: Stick) -> f32 {
        self.before = self.now;
        let scene = &mut self.now;
        scene.skull.frame();
        if scene.player.hold == Hold::Dead {
            scene.mourning -= 1;
            if scene.mourning == 0 {
                scene.player = Player::at(ENTRY);
            }
            return 0.0;
        }
        let door = scene.player.frame(stick, &Terrain { open: scene.open, drift: self.drift });
        let area = scene.player.area();
        if scene.player.hold != Hold::Dead && scene.skull.touches(&area) {
            scene.player.die();
        }
        if scene.player.hold == Hold::Dead {
            (scene.lives, scene.mourning) = (scene.lives - 1, MOURNING);
            return 0.0;
        }
        if scene.key == Key::Hanging && area.meets(&KEY) {
            scene.key = Key::Held;
            return KEY_REWARD;
        }
        match door {
            Some(door) if scene.key == Key::Held => {
                (scene.key, scene.open[door]) = (Key::Used, true);
                DOOR_REWARD
            }
            _ => 0.0,
        }
    }

    fn over(&self) -> bool {
        self.now.lives == 0 || self.now.open != [false; 2]
    }
}

/// What a choice presses.
fn stick(choice: usize) -> Stick {
    // Up, right, left, down, then the diagonals; the same again with the button.
    const AXES: [[i32; 2]; 8] = [[0, -1], [1, 0], [-1, 0], [0, 1], [1, -1], [-1, -1], [1, 1], [-1, 1]];
    let ([x, y], fire) = match choice {
        0 => ([0, 0], false),
        1 => ([0, 0], true),
        2..=9 => (AXES[choice - 2], false),
        _ => (AXES[choice - 10], true),
    };
    Stick { x, y, fire }
}

impl World for Montezuma {
    fn card(&self) -> Card {
        let linear = Dimension::linear;
        let [low, high] = SKULL_RANGE.map(|x| x as f32);
        Card {
            name: "montezuma",
            about: "a screen like the first of Montezuma's Revenge: get the key, open a door",
            actions: &ACTIONS,
            symbols: vec![
                linear("x", "px", 1.0, WIDTH as f32),
                linear("y", "px", 308.0 - HEIGHT as f32, 255.0),
                linear("vx", "px/frame", -1.0, 1.0),
                // A jump begins with 1.7; who jumps off the upper level falls with 4.5 before the ground is there.
                linear("vy", "px/frame", -5.0, 2.0),
                linear("status", "", 0.0, 7.0),
                linear("looks left", "", 0.0, 1.0),
                linear("key hangs", "", 0.0, 1.0),
                linear("key held", "", 0.0, 1.0),
                linear("left door open", "", 0.0, 1.0),
                linear("right door open", "", 0.0, 1.0),
                linear("lives", "", 0.0, f32::from(self.rules.lives)),
                linear("skull x", "px", low, high),
                linear("skull rolls left", "", 0.0, 1.0),
                linear("frames to next life", "", 0.0, f32::from(MOURNING)),
            ],
            place: vec![0, 1],
            limit: Some(FRAMES.div_ceil(self.rules.repeat)),
            success_reward: self.rules.pay(DOOR_REWARD),
            layout: Layout::Fixed(0),
            see: self.rules.see,
        }
    }

    fn begin(&mut self, draw: Draw) {
        match draw.start() {
            Some(mut rng) => Sweep::begin(self, rng.random_range(0..STARTS.len())),
            None => self.put(Player::at(ENTRY), Skull::START),
        }
    }

    fn act(&mut self, choice: usize) -> Step {
        let stick = stick(choice);
        let mut points = 0.0;
        for _ in 0..self.rules.repeat {
            points += self.frame(stick);
            if self.over() {
                break;
            }
        }
        Step { reward: self.rules.pay(points), end: self.over().then_some(End::Terminated) }
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        let Scene { player, skull, key, open, lives, mourning } = self.now;
        let pixels = |x: i32| x as f32 / PIXEL as f32;
        out.clear();
        out.extend([
            pixels(player.x) + 1.0,
            308.0 - pixels(player.y),
            pixels(player.vx),
            -pixels(player.vy),
            player.status() as u8 as f32,
            f32::from(u8::from(player.left)),
            f32::from(u8::from(key == Key::Hanging)),
            f32::from(u8::from(key == Key::Held)),
            f32::from(u8::from(open[0])),
            f32::from(u8::from(open[1])),
            f32::from(lives),
            pixels(skull.x),
            f32::from(u8::from(skull.left)),
            f32::from(mourning),
        ]);
    }

    fn facts(&self) -> Vec<Fact> {
        let Scene { player, key, lives, .. } = self.now;
        let [x, y] = player.ram().map(|byte| byte as f32);
        let own = [
            Fact::new("ram x", x),
            Fact::new("ram y", y),
            Fact::new("status", player.status() as u8),
            Fact::new("has key", key == Key::Held),
            Fact::new("lives", lives),
        ];
        let attained = |number: usize| Fact::new(TARGETS[number].name, self.attained(number));
        own.into_iter().chain((0..TARGETS.len()).map(attained)).collect()
    }
}

impl Snapshot for Montezuma {
    type State = [Scene; 2];

    fn save(&self) -> Self::State {
        [self.now, self.before]
    }

    fn load(&mut self, &[now, before]: &Self::State) {
        (self.now, self.before) = (now, before);
    }
}

/// The starts are [`STARTS`]. The skull begins at the turning point that is further away, so that no start is lost.
impl Sweep for Montezuma {
    fn starts(&self) -> usize {
        STARTS.len()
    }

    fn begin(&mut self, start: usize) {
        let player = Player::at(from_ram(STARTS[start]));
        self.put(player, Skull::far_from(player.area().x));
    }
}

const _: () = assert!(Status::Dead as u8 == 7, "the status in the symbols has eight values");
