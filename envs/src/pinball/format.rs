//! The peers' text format, and what can be wrong with a text.

use std::sync::OnceLock;

use super::{board::Board, configuration::Configuration};
use crate::registry::nearest;

impl Configuration {
    /// Reads the peers' text format: lines `ball r`, `target x y r`, `start x y` and, as often as wanted, `polygon`
    /// with three or more corners `x y`; `#` begins a comment. A polygon that is there twice counts twice.
    ///
    /// ```
    /// use inroads_envs::{pinball::{Configuration, Pinball, Rules}, world::{Layout, Symbolic}};
    /// let text = "ball 0.02\ntarget 0.9 0.2 0.04\nstart 0.2 0.9\npolygon 0.45 0.45 0.55 0.45 0.5 0.55";
    /// let pinball = Pinball::new(Configuration::parse(text)?.into(), Rules::default())?;
    /// let env = Symbolic::new(pinball, Layout::Fixed(0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ConfigurationError`] names the line and the mend.
    pub fn parse(text: &str) -> Result<Self, ConfigurationError> {
        let mut draft = Draft::default();
        for (index, line) in text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or_default();
            draft.line(index + 1, line).map_err(|why| ConfigurationError::Line { line: index + 1, why })?;
        }
        draft.finish()
    }
}

/// Why a text is no configuration.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConfigurationError {
    /// A line cannot be used.
    #[error("line {line}: {why}")]
    Line {
        /// Which line, from 1.
        line: usize,
        /// What is wrong with it.
        why: LineError,
    },
    /// A line is missing.
    #[error("there is no line `{0}`; add one, such as `{example}`", example = example(.0))]
    Missing(&'static str),
    /// There is nowhere to start from.
    #[error(
        "the obstacles cover the board; leave a gap of a hundredth of its side somewhere between 0.02 and 0.98"
    )]
    NoRoom,
}

/// What is wrong with a line of a configuration.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LineError {
    /// It begins with something else than one of the four words.
    #[error(
        "there is no `{word}`; did you mean `{nearest}`? Lines begin with ball, target, start or polygon"
    )]
    Word {
        /// How it begins.
        word: String,
        /// The nearest of the four.
        nearest: &'static str,
    },
    /// Something is not a number.
    #[error("`{0}` is not a finite number; write it as 0.25")]
    Number(String),
    /// It has too many numbers, or too few.
    #[error("`{word}` has {found} numbers; write `{example}`", example = example(.word))]
    Count {
        /// The line's word.
        word: &'static str,
        /// Numbers that follow it.
        found: usize,
    },
    /// A number is too small or too large.
    #[error("{what} cannot be {value}; it lies between {low} and {high}")]
    Range {
        /// What it is.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Least value.
        low: f64,
        /// Greatest value.
        high: f64,
    },
    /// What there may be only one of is there a second time.
    #[error("a second `{word}`, after that of line {first}; leave one of them out")]
    Twice {
        /// The line's word.
        word: &'static str,
        /// Where the first is.
        first: usize,
    },
    /// Two neighbouring corners of a polygon are the same.
    #[error(
        "corners {corner} and {next} of the polygon are both ({}, {}); leave one out (the last corner is joined to \
         the first anyway)", at[0], at[1]
    )]
    Corner {
        /// The first of the two, from 1.
        corner: usize,
        /// The second.
        next: usize,
        /// Where both are.
        at: [f64; 2],
    },
    /// The start is within an obstacle.
    #[error("the start ({}, {}) is inside a polygon; move one of them", at[0], at[1])]
    Blocked {
        /// The start.
        at: [f64; 2],
    },
}

/// How a line with a word looks.
fn example(word: &str) -> &'static str {
    match word {
        "ball" => "ball 0.02",
        "target" => "target 0.9 0.2 0.04",
        "start" => "start 0.2 0.9",
        _ => "polygon 0.45 0.45 0.55 0.45 0.55 0.55",
    }
}

/// Radii that a ball can have: a pixel of the picture at least.
const BALL: [f64; 2] = [0.002, 0.25];
/// Radii that a target can have.
const TARGET: [f64; 2] = [0.002, 0.5];
/// What was read, and in which line.
type Read<T> = Option<(usize, T)>;

/// A configuration in the course of being read.
#[derive(Default)]
struct Draft {
    ball: Read<f64>,
    target: Read<([f64; 2], f64)>,
    start: Read<[f64; 2]>,
    polygons: Vec<Vec<[f64; 2]>>,
}

impl Draft {
    fn line(&mut self, number: usize, text: &str) -> Result<(), LineError> {
        let mut words = text.split_whitespace();
        let Some(word) = words.next() else { return Ok(()) };
        let numbers = words.map(finite).collect::<Result<Vec<_>, _>>();
        match word {
            "ball" => match numbers?[..] {
                [radius] => once("ball", &mut self.ball, number, within("a ball's radius", radius, BALL)?),
                ref other => Err(LineError::Count { word: "ball", found: other.len() }),
            },
            "target" => match numbers?[..] {
                [x, y, radius] => {
                    let target = (point(x, y)?, within("a target's radius", radius, TARGET)?);
                    once("target", &mut self.target, number, target)
                }
                ref other => Err(LineError::Count { word: "target", found: other.len() }),
            },
            "start" => match numbers?[..] {
                [x, y] => once("start", &mut self.start, number, point(x, y)?),
                ref other => Err(LineError::Count { word: "start", found: other.len() }),
            },
            "polygon" => {
                self.polygons.push(polygon(&numbers?)?);
                Ok(())
            }
            _ => {
                let known = ["ball", "target", "start", "polygon"];
                let nearest = nearest(word, known).expect("there are four");
                Err(LineError::Word { word: word.to_owned(), nearest })
            }
        }
    }

    fn finish(self) -> Result<Configuration, ConfigurationError> {
        let (_, ball) = self.ball.ok_or(ConfigurationError::Missing("ball"))?;
        let (_, (target, reach)) = self.target.ok_or(ConfigurationError::Missing("target"))?;
        let (line, start) = self.start.ok_or(ConfigurationError::Missing("start"))?;
        let board = Board::new(ball, target, reach, &self.polygons);
        let (still, first) = (OnceLock::new(), OnceLock::new());
        let made = Configuration { board, start, polygons: self.polygons, still, first };
        if !made.free(start) {
            return Err(ConfigurationError::Line { line, why: LineError::Blocked { at: start } });
        }
        made.lattice().next().ok_or(ConfigurationError::NoRoom)?;
        Ok(made)
    }
}

/// Keeps what there may be only one of.
fn once<T>(word: &'static str, kept: &mut Read<T>, line: usize, value: T) -> Result<(), LineError> {
    match kept {
        Some((first, _)) => Err(LineError::Twice { word, first: *first }),
        None => {
            *kept = Some((line, value));
            Ok(())
        }
    }
}

fn finite(word: &str) -> Result<f64, LineError> {
    word.parse()
        .ok()
        .filter(|number: &f64| number.is_finite())
        .ok_or_else(|| LineError::Number(word.to_owned()))
}

fn within(what: &'static str, value: f64, [low, high]: [f64; 2]) -> Result<f64, LineError> {
    if (low..=high).contains(&value) { Ok(value) } else { Err(LineError::Range { what, value, low, high }) }
}

fn point(x: f64, y: f64) -> Result<[f64; 2], LineError> {
    Ok([within("a coordinate", x, [0.0, 1.0])?, within("a coordinate", y, [0.0, 1.0])?])
}

fn polygon(numbers: &[f64]) -> Result<Vec<[f64; 2]>, LineError> {
    let (pairs, rest) = numbers.as_chunks::<2>();
    if pairs.len() < 3 || !rest.is_empty() {
        return Err(LineError::Count { word: "polygon", found: numbers.len() });
    }
    let corners = pairs.iter().map(|&[x, y]| point(x, y)).collect::<Result<Vec<_>, _>>()?;
    let count = corners.len();
    // Squared, as the physics divides by it.
    let joined = |&corner: &usize| {
        let [from, to] = [corners[corner], corners[(corner + 1) % count]];
        (to[0] - from[0]).powi(2) + (to[1] - from[1]).powi(2) == 0.0
    };
    match (0..count).find(joined) {
        Some(corner) => {
            Err(LineError::Corner { corner: corner + 1, next: (corner + 1) % count + 1, at: corners[corner] })
        }
        None => Ok(corners),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOUND: &str = "ball 0.02\ntarget 0.9 0.2 0.04\nstart 0.2 0.9\n";

    #[test]
    fn a_board_is_read_with_comments_and_blank_lines() {
        let text = "# mine\n\nstart 0.2 0.9 # below\nball 2e-2\n  polygon 0 0 1 0 0.5 0.1\ntarget .9 .2 .04";
        let read = Configuration::parse(text).unwrap();
        assert_eq!((read.ball(), read.start(), read.target()), (0.02, [0.2, 0.9], ([0.9, 0.2], 0.04)));
        assert_eq!(read.polygons(), [[[0.0, 0.0], [1.0, 0.0], [0.5, 0.1]]]);
        assert!(!read.free([0.5, 0.05]) && read.free([0.5, 0.2]) && read.free([0.05, 0.05]));
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line_and_the_mend() {
        let cases = [
            ("bal 0.02", "line 4: there is no `bal`; did you mean `ball`?"),
            ("polygone 0 0 1 0 1 1", "line 4: there is no `polygone`; did you mean `polygon`?"),
            ("ball 0.02", "line 4: a second `ball`, after that of line 1"),
            ("target 0.9 0.2 0.04", "line 4: a second `target`, after that of line 2"),
            ("polygon 0 0 1 x 1 1", "line 4: `x` is not a finite number"),
            ("polygon 0 0 1 inf 1 1", "line 4: `inf` is not a finite number"),
            ("polygon 0 0 1 1", "line 4: `polygon` has 4 numbers; write `polygon 0.45"),
            ("polygon 0 0 1 0 1 1 1", "line 4: `polygon` has 7 numbers"),
            ("polygon 0 0 1 0 1 1.5", "line 4: a coordinate cannot be 1.5; it lies between 0 and 1"),
            ("polygon 0 0 1 0 1 1 0 0", "line 4: corners 4 and 1 of the polygon are both (0, 0)"),
            ("polygon 0 0 1 0 1 0 0 1", "line 4: corners 2 and 3 of the polygon are both (1, 0)"),
            ("polygon 0 0.8 0.3 0.8 0.3 1 0 1", "line 3: the start (0.2, 0.9) is inside a polygon"),
            (
                "polygon 0 0 1 0 1 0.899 0 0.899\npolygon 0 1 1 1 1 0.901 0 0.901",
                "the obstacles cover the board",
            ),
        ];
        for (line, told) in cases {
            let text = Configuration::parse(&format!("{SOUND}{line}\n")).unwrap_err().to_string();
            assert!(text.starts_with(told), "{line}: {text}");
        }
        let changed =
            |from: &str, to: &str| Configuration::parse(&SOUND.replace(from, to)).unwrap_err().to_string();
        assert_eq!(
            changed("start 0.2 0.9\n", ""),
            "there is no line `start`; add one, such as `start 0.2 0.9`"
        );
        assert!(changed("ball 0.02", "ball").starts_with("line 1: `ball` has 0 numbers; write `ball 0.02`"));
        assert!(changed("ball 0.02", "ball 0.3").starts_with("line 1: a ball's radius cannot be 0.3"));
        assert!(changed("0.04", "0").starts_with("line 2: a target's radius cannot be 0"));
        assert!(changed("start 0.2", "start 2").starts_with("line 3: a coordinate cannot be 2"));
    }
}
