//! Levels as texts.

use super::kinds::{Kind, Noun};
use super::rules::{Rules, Unit};

/// A level: a rectangle of cells with units in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Level {
    /// Columns and rows.
    pub(super) size: [usize; 2],
    pub(super) units: Vec<Unit>,
}

/// Most columns, and most rows.
const GREATEST: usize = 32;

/// The level of thesis figure 8.7, as far as it is known: a U of two arms and a corridor, two cells wide. The word WALL lies
/// in the corridor; IS and WIN stand at the foot of the left arm, the sheep and a wall at that of the right one.
pub const U_MAZE: &str = "\
hhhhhhhhhhh
h.........h
h....W....h
h..hhhhh..h
h..hB=Yh..h
h..hhhhh..h
h=.hH=Sh..h
hN.hhhhhwbh
hhhhhhhhhhh
";

/// What is wrong with a level. Lines and columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LevelError {
    /// No unit of that letter.
    #[error("line {line}, column {column}: nothing is called `{letter}`; use {}", legend())]
    Letter {
        /// Line.
        line: usize,
        /// Column.
        column: usize,
        /// The letter.
        letter: char,
    },
    /// A line of another length.
    #[error(
        "line {line}, column {column}: the line ends here, and the first one has {expected} cells; fill up with dots"
    )]
    Short {
        /// Line.
        line: usize,
        /// The column after its last.
        column: usize,
        /// Cells of the first line.
        expected: usize,
    },
    /// A line that is too long.
    #[error("line {line}, column {column}: the first line has {expected} cells, and this one goes on")]
    Long {
        /// Line.
        line: usize,
        /// The first column too many.
        column: usize,
        /// Cells of the first line.
        expected: usize,
    },
    /// Too large, or nothing.
    #[error("a level has 1 to {GREATEST} lines of 1 to {GREATEST} cells, and this has {lines} of {columns}")]
    Size {
        /// Lines.
        lines: usize,
        /// Cells of the first.
        columns: usize,
    },
    /// Nobody to play.
    #[error(
        "nothing in the level is YOU; write a thing, and beside or below each other its word, IS and YOU (`B=Y`)"
    )]
    NobodyIsYou,
}

/// Letters and what they stand for.
fn legend() -> String {
    let kinds = Kind::all().map(|kind| format!("{} {}", kind.letter(), kind.name()));
    kinds.chain(["`.` nothing".to_owned()]).collect::<Vec<_>>().join(", ")
}

impl Level {
    /// Reads a level: a line a row, a letter a cell ([`Kind::letter`]), `.` for nothing.
    ///
    /// # Errors
    /// [`LevelError`] names line and column, and what may stand there.
    pub fn parse(text: &str) -> Result<Self, LevelError> {
        let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
        let columns = lines.first().map_or(0, |line| line.chars().count());
        if !(1..=GREATEST).contains(&lines.len()) || !(1..=GREATEST).contains(&columns) {
            return Err(LevelError::Size { lines: lines.len(), columns });
        }
        let mut units = Vec::new();
        for (y, row) in lines.iter().enumerate() {
            let mut length = 0;
            for (x, letter) in row.chars().enumerate() {
                let (line, column) = (y + 1, x + 1);
                if x == columns {
                    return Err(LevelError::Long { line, column, expected: columns });
                }
                match Kind::all().find(|kind| kind.letter() == letter) {
                    Some(kind) => units.push(Unit { kind, cell: (y * columns + x) as u16 }),
                    None if letter == '.' => {}
                    None => return Err(LevelError::Letter { line, column, letter }),
                }
                length = column;
            }
            if length < columns {
                return Err(LevelError::Short { line: y + 1, column: length + 1, expected: columns });
            }
        }
        let level = Self { size: [columns, lines.len()], units };
        let mut rules = Rules::default();
        rules.read(&level.units, level.size);
        match level.units.iter().any(|unit| rules.is_you(unit.kind)) {
            true => Ok(level),
            false => Err(LevelError::NobodyIsYou),
        }
    }

    /// Cells.
    pub(super) fn cells(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// The kinds of units that there are or, by a rule about nouns, may be.
    pub(super) fn kinds(&self) -> Vec<Kind> {
        let here = |kind: &Kind| self.units.iter().any(|unit| unit.kind == *kind);
        let may_be = |kind: &Kind| match *kind {
            Kind::Thing(noun) => here(&Kind::Block(super::Word::Noun(noun))),
            Kind::Block(_) => false,
        };
        Kind::all().filter(|kind| here(kind) || may_be(kind)).collect()
    }

    /// The kinds that goals speak of: all but hedges, which are scenery.
    pub(super) fn goal_kinds(&self) -> Vec<Kind> {
        self.kinds().into_iter().filter(|kind| *kind != Kind::Thing(Noun::Hedge)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_named_with_line_and_column() {
        let fault = |text| Level::parse(text).unwrap_err().to_string();
        assert!(fault("B=Y\n.?b\n").starts_with("line 2, column 2: nothing is called `?`; use b baba"));
        assert!(fault("B=Y\nb.\n").starts_with("line 2, column 3: the line ends here"));
        assert!(fault("B=Y\nb...\n").starts_with("line 2, column 4: the first line has 3 cells"));
        assert!(fault("").contains("1 to 32 lines"));
        assert!(fault("B=Y\n...\n").contains("nothing in the level is YOU"));
        assert!(fault("Y=B\nb..\n").contains("nothing in the level is YOU"));
        assert!(Level::parse("B=Y\nb..\n").is_ok());
    }
}
