//! Rules, as the words that lie about say them.

use super::kinds::{Kind, Noun, Property, Word};

/// A thing or a block, and the number of its cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// What it is.
    pub kind: Kind,
    /// Its cell, row by row.
    pub cell: u16,
}

/// The rules that hold.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Rules {
    /// Of each kind of things: which properties it has.
    properties: [[bool; Property::ALL.len()]; Noun::ALL.len()],
    /// Of each kind of things: as what it is named, itself before all others, else the lowest of [`Noun::ALL`].
    becomes: [Option<Noun>; Noun::ALL.len()],
}

impl Rules {
    /// Reads all rules: a noun, IS, and a noun or property in three cells from left to right, or from top to bottom.
    pub fn read(&mut self, units: &[Unit], [columns, rows]: [usize; 2]) {
        *self = Self::default();
        let word = |cell: usize| {
            units.iter().find_map(|unit| match unit.kind {
                Kind::Block(word) if usize::from(unit.cell) == cell => Some(word),
                _ => None,
            })
        };
        for unit in units {
            let Kind::Block(Word::Noun(noun)) = unit.kind else { continue };
            let cell = usize::from(unit.cell);
            let across = (cell % columns + 2 < columns).then_some(1);
            let down = (cell / columns + 2 < rows).then_some(columns);
            for step in [across, down].into_iter().flatten() {
                if word(cell + step) == Some(Word::Is) {
                    self.learn(noun, word(cell + 2 * step));
                }
            }
        }
    }

    fn learn(&mut self, noun: Noun, of: Option<Word>) {
        match of {
            Some(Word::Property(property)) => self.properties[noun as usize][property as usize] = true,
            Some(Word::Noun(other)) => {
                let named = &mut self.becomes[noun as usize];
                // In an order of the nouns, not of the units, whose order says nothing about the level.
                let first = |a: Noun, b: Noun| if a == noun || b == noun { noun } else { a.min(b) };
                *named = Some(named.map_or(other, |before| first(before, other)));
            }
            Some(Word::Is) | None => {}
        }
    }

    /// Whether things of a kind have a property.
    pub fn has(&self, noun: Noun, property: Property) -> bool {
        self.properties[noun as usize][property as usize]
    }

    /// What things of a kind turn into: of several nouns the lowest of [`Noun::ALL`]. None when they stay, as those do,
    /// whatever else is said, that are said to be what they are.
    pub fn becomes(&self, noun: Noun) -> Option<Noun> {
        self.becomes[noun as usize].filter(|_| self.becomes[noun as usize] != Some(noun))
    }

    /// How many rules hold.
    pub fn count(&self) -> usize {
        let properties = self.properties.iter().flatten().filter(|&&holds| holds).count();
        properties + self.becomes.iter().flatten().count()
    }

    /// Whether the player moves units of a kind.
    pub fn is_you(&self, kind: Kind) -> bool {
        self.thing_has(kind, Property::You)
    }

    /// Whether whoever enters the cell of such a unit wins.
    pub fn is_win(&self, kind: Kind) -> bool {
        self.thing_has(kind, Property::Win)
    }

    /// Whether such units are pushed: blocks always are.
    pub fn is_push(&self, kind: Kind) -> bool {
        matches!(kind, Kind::Block(_)) || self.thing_has(kind, Property::Push)
    }

    /// Whether nothing enters the cell of such a unit: it stops, and cannot be pushed.
    pub fn is_stop(&self, kind: Kind) -> bool {
        self.thing_has(kind, Property::Stop) && !self.is_push(kind)
    }

    fn thing_has(&self, kind: Kind, property: Property) -> bool {
        matches!(kind, Kind::Thing(noun) if self.has(noun, property))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rules(lines: &str) -> Rules {
        let [rules, backwards] = both_orders(lines);
        assert_eq!(rules, backwards, "the order of units does not matter");
        rules
    }

    /// The rules when units are listed from the first cell, and from the last.
    fn both_orders(lines: &str) -> [Rules; 2] {
        let rows: Vec<&str> = lines.split('|').collect();
        let columns = rows[0].len();
        let unit = |(at, letter): (usize, char)| {
            let kind = Kind::all().find(|kind| kind.letter() == letter)?;
            Some(Unit { kind, cell: at as u16 })
        };
        let mut units: Vec<_> = rows.concat().chars().enumerate().filter_map(unit).collect();
        let mut forwards = Rules::default();
        forwards.read(&units, [columns, rows.len()]);
        units.reverse();
        let mut backwards = Rules::default();
        backwards.read(&units, [columns, rows.len()]);
        [forwards, backwards]
    }

    #[test]
    fn sentences_are_read_to_the_right_and_downwards() {
        assert!(rules("B=Y").has(Noun::Baba, Property::You));
        assert!(rules("..W|..=|..N").has(Noun::Wall, Property::Win));
        // Backwards, upwards, with a gap, around a corner or over the edge they are none.
        for text in ["Y=B", "N|=|W", "B=.Y", "B=.|..Y", ".B=|Y..", "..B|=Y.", "BY=", "B=="] {
            assert_eq!(rules(text).count(), 0, "{text}");
        }
    }

    #[test]
    fn a_word_has_a_part_in_two_sentences() {
        let crossing = rules("B=Y|=..|S..");
        assert!(crossing.has(Noun::Baba, Property::You) && crossing.has(Noun::Baba, Property::Stop));
        // The verb in the middle serves both.
        let cross = rules(".W.|B=Y|.N.");
        assert!(cross.has(Noun::Baba, Property::You) && cross.has(Noun::Wall, Property::Win));
        assert_eq!(cross.count(), 2);
    }

    #[test]
    fn things_turn_into_others_and_blocks_are_pushed() {
        let rules = rules("W=R|...|H=S|H=P|W=W");
        assert_eq!(rules, self::rules("W=W|...|H=S|H=P|W=R"));
        assert_eq!(rules.becomes(Noun::Wall), None, "what is said to be itself stays");
        assert!(!rules.is_stop(Kind::Thing(Noun::Hedge)), "what is pushed does not stop");
        assert!(rules.is_push(Kind::Block(Word::Is)) && !rules.is_push(Kind::Thing(Noun::Baba)));
        let rules = self::rules("W=R");
        assert_eq!(rules.becomes(Noun::Wall), Some(Noun::Rock));
        // Of several the lowest, wherever it stands.
        for text in ["W=R|...|W=F", "W=F|...|W=R"] {
            assert_eq!(self::rules(text).becomes(Noun::Wall), Some(Noun::Rock), "{text}");
        }
    }
}
