//! The hero's part of a turn, as NetHack 3.6 has it.

use super::{
    State,
    dice::Dice,
    map::{GOAL, Ground, Map, Place, add},
    message::{Blow, Liquid, Message},
};
use crate::{End, Step};

/// What comes of the hero's part of a turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// Nothing was done: no time passes in the game.
    Idle,
    /// Something was done, and it is the monsters' turn.
    Passed,
    /// The hero is dead.
    Dead,
    /// The hero is on the stairs.
    Won,
}

/// Turns after which the hero remarks again that a boulder is heavy: more than two since he last moved one.
pub(super) const RESTED: u8 = 3;

/// Reward on the stairs.
pub(super) const WIN: f32 = 1.0;
/// Reward of a step in which no time passes in the game.
const IDLE: f32 = -0.01;

impl Turn {
    /// What a turn pays, and whether it is the last.
    pub fn step(self) -> Step {
        match self {
            Self::Idle => Step { reward: IDLE, end: None },
            Self::Passed => Step { reward: 0.0, end: None },
            Self::Dead => Step { reward: 0.0, end: Some(End::Terminated) },
            Self::Won => Step { reward: WIN, end: Some(End::Terminated) },
        }
    }
}

/// A filling: water 9 in 10, lava 1 in 10.
const FILL_SIDES: u32 = 10;

/// Sides of the die of a fight.
pub(super) const FIGHT_SIDES: u32 = 20;
/// What the hero's blow adds to the victim's armour class: 1, and 1 for his level.
const HERO_HITS: u32 = 2;
/// Greatest damage of his short sword.
const HERO_DAMAGE: u32 = 6;
/// A holding monster lets go in 3 of 40 attempts.
const FREE: (u32, u32) = (3, 40);

impl State {
    /// The hero walks, pushes, or fights.
    pub(super) fn hero_acts(&mut self, way: Place, dice: &mut impl Dice) -> Turn {
        let to = add(self.hero, way);
        if let Some(holder) = self.holder
            && self.monsters[holder].place != to
        {
            let kind = self.monsters[holder].kind;
            if dice.below(FREE.1) >= FREE.0 {
                self.say(Message::Held(kind));
                return Turn::Passed;
            }
            self.say(Message::Free(kind));
            self.holder = None;
        }
        if let Some(monster) = self.monster_at(to) {
            self.fight(monster, dice);
            return Turn::Passed;
        }
        let Some(cell) = Map::cell(to) else {
            self.say(Message::SolidStone);
            return Turn::Idle;
        };
        if !self.clear(cell, add(to, way), dice) {
            return Turn::Idle;
        }
        self.hero = to;
        match self.map.ground(cell) {
            Ground::Floor if to == GOAL => Turn::Won,
            Ground::Floor => Turn::Passed,
            Ground::Water => self.crawl(dice),
            Ground::Lava => {
                self.say(Message::Fall(Liquid::Lava));
                self.say(Message::Crisp);
                self.health = 0;
                Turn::Dead
            }
        }
    }

    /// Pushes all boulders off a cell to the one beyond, one after another; `false` when one stays.
    fn clear(&mut self, cell: usize, beyond: Place, dice: &mut impl Dice) -> bool {
        while self.map.boulders(cell) > 0 {
            let Some(next) = Map::cell(beyond).filter(|&next| self.map.boulders(next) == 0) else {
                self.say(Message::InVain);
                return false;
            };
            if self.monster_at(beyond).is_some() {
                self.say(Message::HearBehind);
                self.say(Message::PerhapsWhy);
                return false;
            }
            self.map.take_boulder(cell);
            match self.map.ground(next) {
                Ground::Floor => {
                    self.map.add_boulder(next);
                    if self.rested >= RESTED {
                        self.say(Message::Effort);
                    }
                    self.rested = 0;
                }
                Ground::Water => {
                    let fills = dice.below(FILL_SIDES) != 0;
                    self.sink(next, Liquid::Water, fills);
                }
                Ground::Lava => {
                    let fills = dice.below(FILL_SIDES) == 0;
                    self.sink(next, Liquid::Lava, fills);
                }
            }
        }
        true
    }

    /// A boulder is in the river.
    fn sink(&mut self, cell: usize, liquid: Liquid, fills: bool) {
        if fills {
            self.map.fill(cell);
            self.filled += 1;
            self.say(Message::Pushed(liquid));
            self.say(Message::CanCross);
        } else {
            self.lost += 1;
            self.say(Message::Splash(liquid));
            self.say(Message::Sinks);
        }
    }

    /// The hero is in the water and gets out at a free cell beside it, all equally likely.
    fn crawl(&mut self, dice: &mut impl Dice) -> Turn {
        for message in [Message::Fall(Liquid::Water), Message::LikeARock, Message::Sack] {
            self.say(message);
        }
        let (mut cells, mut count) = ([0; 8], 0);
        for cell in self.map.around(self.hero) {
            if self.monster_at(Map::place(cell)).is_none() {
                cells[count] = cell;
                count += 1;
            }
        }
        if count == 0 {
            self.say(Message::Drown);
            self.health = 0;
            return Turn::Dead;
        }
        self.hero = Map::place(cells[dice.below(count as u32) as usize]);
        self.holder = None;
        self.say(Message::Crawl);
        self.say(Message::Pheew);
        // Beside a river that is as wide as can be the stairs are a bank too.
        if self.hero == GOAL { Turn::Won } else { Turn::Passed }
    }

    /// The hero strikes.
    fn fight(&mut self, monster: usize, dice: &mut impl Dice) {
        let kind = self.monsters[monster].kind;
        let blow = if dice.below(FIGHT_SIDES) + 1 >= kind.nature().armour + HERO_HITS {
            Blow::Misses
        } else {
            let struck = &mut self.monsters[monster];
            struck.health = struck.health.saturating_sub(1 + dice.below(HERO_DAMAGE) as u8);
            if struck.health == 0 { Blow::Kills } else { Blow::Hits }
        };
        if blow == Blow::Kills && self.holder == Some(monster) {
            self.holder = None;
        }
        self.say(Message::Fights(kind, blow));
    }

    /// The living monster at a place.
    pub(super) fn monster_at(&self, place: Place) -> Option<usize> {
        self.monsters.iter().position(|monster| monster.health > 0 && monster.place == place)
    }

    pub(super) fn say(&mut self, message: Message) {
        self.log.push(message);
    }
}
