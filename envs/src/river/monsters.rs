//! The monsters' part of a turn. Who they are and how they strike is NetHack's; how they move is invented.

use super::{
    State,
    dice::Dice,
    kinds::Kind,
    map::{Map, Place, WAYS, add, apart},
    message::{Attack, Message},
    rules::FIGHT_SIDES,
};

/// A monster.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Monster {
    /// What it is.
    pub kind: Kind,
    /// Where it is.
    pub place: Place,
    /// What it can still suffer, 1 to 4 at first; 0: it is dead and gone.
    pub health: u8,
}

/// Greatest health of a monster of level 0.
pub(super) const MONSTER_HEALTH: u32 = 4;
/// Twelfths of an action that make one.
const ACTION: u32 = 12;
/// A monster's throw must be below this: 10, and 7 for the armour class of a rogue in leather.
const HITS_BELOW: u32 = 17;
/// Of ten throws, those for which leather protects from sparks and glue.
const CANCELLED: (u32, u32) = (3, 10);

impl State {
    /// All monsters act, in a fixed order. `false` when the hero is dead.
    pub(super) fn monsters_act(&mut self, dice: &mut impl Dice) -> bool {
        for monster in 0..self.monsters.len() {
            let Monster { kind, .. } = self.monsters[monster];
            let speed = kind.nature().speed;
            let odd = speed % ACTION;
            let actions = speed / ACTION + u32::from(odd > 0 && dice.below(ACTION) < odd);
            for _ in 0..actions {
                if self.monsters[monster].health > 0 {
                    self.monster_acts(monster, dice);
                }
                if self.health == 0 {
                    self.say(Message::Die);
                    return false;
                }
            }
        }
        true
    }

    /// One attack, or one step towards the hero.
    fn monster_acts(&mut self, monster: usize, dice: &mut impl Dice) {
        let Monster { kind, place, .. } = self.monsters[monster];
        let straight = |way: Place| way[0] == 0 || way[1] == 0;
        let reach = if kind.straight() { 1 } else { 2 };
        if apart(place, self.hero) <= reach {
            return self.attack(monster, dice);
        }
        let mut nearest = (apart(place, self.hero), place);
        for (_, way) in WAYS {
            let to = add(place, way);
            let free = Map::cell(to).is_some_and(|cell| self.map.free(cell)) && self.monster_at(to).is_none();
            if free && (straight(way) || !kind.straight()) && apart(to, self.hero) < nearest.0 {
                nearest = (apart(to, self.hero), to);
            }
        }
        self.monsters[monster].place = nearest.1;
    }

    fn attack(&mut self, monster: usize, dice: &mut impl Dice) {
        let kind = self.monsters[monster].kind;
        let throw = dice.below(FIGHT_SIDES) + 1;
        if throw >= HITS_BELOW {
            let attack = if throw == HITS_BELOW { Attack::JustMisses } else { Attack::Misses };
            return self.say(Message::Fought(kind, attack));
        }
        self.say(Message::Fought(kind, Attack::Hits));
        let mut damage = match kind.nature().damage {
            0 => 0,
            most => 1 + dice.below(most),
        };
        let special = kind == Kind::GridBug || kind.sticks();
        let cancelled = special && dice.below(CANCELLED.1) < CANCELLED.0;
        match kind {
            Kind::GridBug if cancelled => damage = 0,
            Kind::GridBug => self.say(Message::Zapped),
            _ if kind.sticks() && !cancelled && self.holder.is_none() => self.holder = Some(monster),
            _ => {}
        }
        self.health = self.health.saturating_sub(damage as u8);
    }
}
