//! Which monsters there are.

/// A kind of monster: those that NetHack puts into a river level at the first experience level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "their names say all")]
pub enum Kind {
    Newt,
    Jackal,
    GridBug,
    Lichen,
    Goblin,
    SewerRat,
    Kobold,
    Fox,
    KoboldZombie,
}

/// What the game says of a kind.
pub(super) struct Words {
    pub(super) fights: [&'static str; 3],
    pub(super) fought: [&'static str; 3],
    pub(super) held: &'static str,
    pub(super) free: &'static str,
}

/// The sentences about a monster that attacks by doing this, and whom to overcome is called that.
macro_rules! words {
    ($name:literal, $attacks:literal, $kill:literal) => {
        &Words {
            fights: [
                concat!("You miss the ", $name, "."),
                concat!("You hit the ", $name, "."),
                concat!("You ", $kill, " the ", $name, "!"),
            ],
            fought: [
                concat!("The ", $name, " misses!"),
                concat!("The ", $name, " just misses!"),
                concat!("The ", $name, " ", $attacks, "!"),
            ],
            held: concat!("You cannot escape from the ", $name, "!"),
            free: concat!("You pull free from the ", $name, "."),
        }
    };
}

/// Numbers of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Nature {
    /// How often it is met: appearances on the first screens of 800 levels of the peer.
    pub weight: u32,
    /// Twelfths of an action a turn.
    pub speed: u32,
    /// Armour class: the greater, the easier to hit.
    pub armour: u32,
    /// Greatest damage of an attack, health; every number from 1 is equally likely. 0: it does not hurt.
    pub damage: u32,
    /// The letter that it is on a terminal.
    pub letter: char,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 9] = [
        Self::Newt,
        Self::Jackal,
        Self::GridBug,
        Self::Lichen,
        Self::Goblin,
        Self::SewerRat,
        Self::Kobold,
        Self::Fox,
        Self::KoboldZombie,
    ];

    /// Its numbers. Speed and armour class are NetHack's (read from NLE 1.3.0), damage as its monster list has it.
    pub fn nature(self) -> Nature {
        let (weight, speed, armour, damage, letter) = match self {
            Self::Newt => (549, 6, 8, 3, ':'),
            Self::Jackal => (532, 12, 7, 2, 'd'),
            Self::GridBug => (518, 12, 9, 1, 'x'),
            Self::Lichen => (472, 1, 9, 0, 'F'),
            Self::Goblin => (264, 6, 10, 6, 'o'),
            Self::SewerRat => (187, 12, 7, 3, 'r'),
            Self::Kobold => (132, 6, 10, 5, 'k'),
            Self::Fox => (130, 15, 7, 3, 'd'),
            Self::KoboldZombie => (93, 6, 10, 4, 'Z'),
        };
        Nature { weight, speed, armour, damage, letter }
    }

    pub(super) fn words(self) -> &'static Words {
        match self {
            Self::Newt => words!("newt", "bites", "kill"),
            Self::Jackal => words!("jackal", "bites", "kill"),
            Self::GridBug => words!("grid bug", "bites", "kill"),
            Self::Lichen => words!("lichen", "touches you", "kill"),
            Self::Goblin => words!("goblin", "hits", "kill"),
            Self::SewerRat => words!("sewer rat", "bites", "kill"),
            Self::Kobold => words!("kobold", "hits", "kill"),
            Self::Fox => words!("fox", "bites", "kill"),
            Self::KoboldZombie => words!("kobold zombie", "hits", "destroy"),
        }
    }

    /// Whether its touch holds the hero.
    pub fn sticks(self) -> bool {
        self == Self::Lichen
    }

    /// Whether it neither moves nor attacks along diagonals.
    pub fn straight(self) -> bool {
        self == Self::GridBug
    }
}
