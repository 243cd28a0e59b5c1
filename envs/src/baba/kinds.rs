//! What there is: things, and words.

/// A kind of thing, and the word for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs, reason = "their names say all")]
pub enum Noun {
    Baba,
    Wall,
    Hedge,
    Rock,
    Flag,
}

/// What rules make of things.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Property {
    /// The player moves it.
    You,
    /// Nothing enters its cell.
    Stop,
    /// It is pushed out of a cell that something enters.
    Push,
    /// Whoever is [`Property::You`] and enters its cell wins.
    Win,
}

/// A word on a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Word {
    /// A kind of thing.
    Noun(Noun),
    /// The verb.
    Is,
    /// What things of the kind before it are.
    Property(Property),
}

/// A kind of unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A thing.
    Thing(Noun),
    /// A block with a word, which can always be pushed.
    Block(Word),
}

impl Noun {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Baba, Self::Wall, Self::Hedge, Self::Rock, Self::Flag];
}

impl Property {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::You, Self::Stop, Self::Push, Self::Win];
}

impl Kind {
    /// All of them: things first.
    pub fn all() -> impl Iterator<Item = Self> {
        let things = Noun::ALL.into_iter().map(Self::Thing);
        let nouns = Noun::ALL.into_iter().map(Word::Noun);
        let properties = Property::ALL.into_iter().map(Word::Property);
        things.chain(nouns.chain([Word::Is]).chain(properties).map(Self::Block))
    }

    /// The letter that stands for it in a level: small for a thing, capital for its word and for properties.
    pub fn letter(self) -> char {
        match self {
            Self::Thing(Noun::Baba) => 'b',
            Self::Thing(Noun::Wall) => 'w',
            Self::Thing(Noun::Hedge) => 'h',
            Self::Thing(Noun::Rock) => 'r',
            Self::Thing(Noun::Flag) => 'f',
            Self::Block(Word::Noun(noun)) => Self::Thing(noun).letter().to_ascii_uppercase(),
            Self::Block(Word::Is) => '=',
            Self::Block(Word::Property(Property::You)) => 'Y',
            Self::Block(Word::Property(Property::Stop)) => 'S',
            Self::Block(Word::Property(Property::Push)) => 'P',
            Self::Block(Word::Property(Property::Win)) => 'N',
        }
    }

    /// What it is called: a word in capitals is a block.
    pub fn name(self) -> &'static str {
        match self {
            Self::Thing(Noun::Baba) => "baba",
            Self::Thing(Noun::Wall) => "wall",
            Self::Thing(Noun::Hedge) => "hedge",
            Self::Thing(Noun::Rock) => "rock",
            Self::Thing(Noun::Flag) => "flag",
            Self::Block(Word::Noun(Noun::Baba)) => "BABA",
            Self::Block(Word::Noun(Noun::Wall)) => "WALL",
            Self::Block(Word::Noun(Noun::Hedge)) => "HEDGE",
            Self::Block(Word::Noun(Noun::Rock)) => "ROCK",
            Self::Block(Word::Noun(Noun::Flag)) => "FLAG",
            Self::Block(Word::Is) => "IS",
            Self::Block(Word::Property(Property::You)) => "YOU",
            Self::Block(Word::Property(Property::Stop)) => "STOP",
            Self::Block(Word::Property(Property::Push)) => "PUSH",
            Self::Block(Word::Property(Property::Win)) => "WIN",
        }
    }
}
