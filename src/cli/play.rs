//! `inroads play`: a person plays in the terminal.

use std::io::{self, Read, Write};

use console::{Key, Term};
use image::{RgbImage, imageops};
use inroads_envs::{Domain, End, registry::AnyEnvironment};

use super::{Done, world};
use crate::{
    config::{ConfigError, World},
    film::{self, View},
    keys::{Keys, Pressed},
    run::RunError,
    session,
};

/// What `inroads play` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The environment (see `inroads list`)
    environment: String,
    /// The first episode's seed
    #[arg(long, default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    world: world::Arguments,
}

pub(super) fn play(arguments: &Arguments) -> Done {
    let mut own = World::default();
    arguments.world.put(&mut own)?;
    match session::world(&arguments.environment, &own)? {
        AnyEnvironment::Choices(mut env) => round(&mut *env, arguments.seed),
        AnyEnvironment::Frames(mut env) => round(&mut *env, arguments.seed),
        AnyEnvironment::Vectors(_) => {
            let why = format!(
                "`{}` is moved by numbers, not by keys; let it move: inroads render",
                arguments.environment
            );
            Err(ConfigError::World(why).into())
        }
    }
}

/// Where an episode is.
#[derive(Default)]
struct Score {
    steps: u32,
    last: Option<(usize, f32)>,
    sum: f32,
    end: Option<(End, bool)>,
}

fn round<O: Clone + Default>(env: &mut dyn Domain<O, usize>, mut seed: u64) -> Done {
    let keys = Keys::new(env.choices(), env.spec().action.choices());
    let mut table = Table::new();
    let mut score = Score::default();
    env.reset(seed);
    loop {
        table.show(env, &keys, &score, seed).map_err(RunError::io("write to", "the terminal".as_ref()))?;
        let Some(key) = table.key().map_err(RunError::io("read from", "the keyboard".as_ref()))? else {
            break;
        };
        match keys.pressed(&key) {
            Pressed::Quit => break,
            Pressed::Next => {
                seed = seed.wrapping_add(1);
                env.reset(seed);
                score = Score::default();
            }
            Pressed::Choice(choice) if score.end.is_none() => {
                let step = env.step(&choice)?;
                score.steps += 1;
                score.sum += step.reward;
                score.last = Some((choice, step.reward));
                score.end = step.end.map(|end| (end, env.spec().succeeded(&step)));
            }
            Pressed::Choice(_) | Pressed::Nothing => {}
        }
    }
    Ok(())
}

/// A terminal, or, when input or output go elsewhere, keys as letters and states as lines. There the end of a line is the
/// enter key, so letters are best sent without one.
enum Table {
    Terminal(Term),
    Piped,
}

impl Table {
    fn new() -> Self {
        let attended = io::IsTerminal::is_terminal(&io::stdin()) && console::user_attended();
        if attended { Self::Terminal(Term::stdout()) } else { Self::Piped }
    }

    /// The next key; none when there are no more.
    fn key(&self) -> io::Result<Option<Key>> {
        match self {
            Self::Terminal(term) => term.read_key().map(Some),
            Self::Piped => {
                let mut byte = [0];
                let read = io::stdin().read(&mut byte)?;
                Ok((read == 1).then(|| if byte[0] == b'\n' { Key::Enter } else { Key::Char(byte[0].into()) }))
            }
        }
    }

    fn show<O: Clone + Default>(
        &mut self,
        env: &dyn Domain<O, usize>,
        keys: &Keys,
        score: &Score,
        seed: u64,
    ) -> io::Result<()> {
        let line = [Some(status(keys, score, seed)), env.told()].into_iter().flatten().collect::<Vec<_>>();
        let line = line.join(" · ");
        let facts: Vec<_> = env.facts().iter().map(|fact| format!("{} {}", fact.name, fact.value)).collect();
        match self {
            Self::Terminal(term) => {
                let (rows, columns) = term.size();
                let text = [line, facts.join(", "), keys.help()].join("\n");
                let used: usize =
                    text.lines().map(|line| line.chars().count().div_ceil(columns.max(1).into())).sum();
                let room = [u32::from(columns), 2 * u32::from(rows).saturating_sub(used as u32 + 1).max(4)];
                let picture = film::picture(env.drawing(), (View::Above, 400));
                let screen = format!("\x1b[H{}\x1b[J{text}", blocks(&fitting(&picture, room)));
                (&*term).write_all(screen.replace('\n', "\r\n").as_bytes())?;
                term.flush()
            }
            Self::Piped if facts.is_empty() => writeln!(io::stdout(), "{line}"),
            Self::Piped => writeln!(io::stdout(), "{line} · {}", facts.join(", ")),
        }
    }
}

fn status(keys: &Keys, score: &Score, seed: u64) -> String {
    let mut line = format!("episode {seed}, step {}", score.steps);
    if let Some((choice, reward)) = score.last {
        line += &format!(": {}, reward {reward}, sum {}", keys.name(choice), score.sum);
    }
    match score.end {
        Some((End::Terminated, true)) => line += " · over: success",
        Some((End::Terminated, false)) => line += " · over: no success",
        Some((End::Truncated, _)) => line += " · over: truncated",
        None => {}
    }
    line
}

/// The picture as large as there is room, at most.
fn fitting(picture: &RgbImage, [width, height]: [u32; 2]) -> RgbImage {
    let share = |room: u32, has: u32| f64::from(room) / f64::from(has.max(1));
    let scale = share(width, picture.width()).min(share(height, picture.height())).min(1.0);
    let side = |has: u32| ((f64::from(has) * scale) as u32).max(1);
    imageops::resize(picture, side(picture.width()), side(picture.height()), imageops::FilterType::Triangle)
}

/// Two pixels a character: the upper half of a block in one colour, the lower in another.
fn blocks(picture: &RgbImage) -> String {
    let mut text = String::new();
    for y in (0..picture.height()).step_by(2) {
        for x in 0..picture.width() {
            let [r, g, b] = picture.get_pixel(x, y).0;
            text += &format!("\x1b[38;2;{r};{g};{b}m");
            match y + 1 < picture.height() {
                true => {
                    let [r, g, b] = picture.get_pixel(x, y + 1).0;
                    text += &format!("\x1b[48;2;{r};{g};{b}m▀");
                }
                false => text += "\x1b[49m▀",
            }
        }
        text += "\x1b[0m\x1b[K\n";
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_fits_and_two_rows_become_one() {
        let picture = RgbImage::from_fn(8, 5, |x, y| image::Rgb([x as u8, y as u8, 9]));
        let text = blocks(&picture);
        assert_eq!((text.lines().count(), text.matches('▀').count()), (3, 24));
        assert!(text.starts_with("\x1b[38;2;0;0;9m\x1b[48;2;0;1;9m▀"), "{text:?}");
        let small = fitting(&picture, [4, 100]);
        assert_eq!((small.width(), small.height()), (4, 2));
        assert_eq!(fitting(&picture, [100, 100]), picture, "never larger than it is");
    }
}
