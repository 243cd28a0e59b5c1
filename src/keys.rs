//! Which key does what when a person plays.

use console::Key;

/// What a key press asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pressed {
    /// One of the environment's choices.
    Choice(usize),
    /// The next episode.
    Next,
    /// No more.
    Quit,
    /// Nothing that there is.
    Nothing,
}

/// Directions as domains call them, for the arrow keys.
const ARROWS: [(Key, &[&str]); 4] = [
    (Key::ArrowUp, &["up", "north", "forward"]),
    (Key::ArrowDown, &["down", "south"]),
    (Key::ArrowLeft, &["left", "west"]),
    (Key::ArrowRight, &["right", "east"]),
];

/// Leaves the game.
const QUIT: char = 'q';

/// The keys of an environment: a letter a choice, and arrows for directions.
#[derive(Clone, Debug)]
pub(crate) struct Keys {
    names: Vec<String>,
    letters: Vec<char>,
    arrows: Vec<(Key, usize)>,
}

impl Keys {
    /// Keys for `count` choices with these names, or none.
    pub(crate) fn new(names: &[&str], count: usize) -> Self {
        let name =
            |choice: usize| names.get(choice).map_or_else(|| choice.to_string(), |&name| name.to_owned());
        let names: Vec<_> = (0..count).map(name).collect();
        let mut letters: Vec<char> = Vec::with_capacity(count);
        for name in &names {
            let own = name.chars().flat_map(char::to_lowercase);
            let mut all = own.chain('a'..='z').chain('0'..='9').chain('A'..='Z');
            let free = |letter: &char| {
                letter.is_ascii_alphanumeric() && *letter != QUIT && !letters.contains(letter)
            };
            letters.push(all.find(free).unwrap_or('?'));
        }
        // "up" itself rather than "push up".
        let exact = |words: &[&str]| names.iter().position(|name| words.contains(&name.as_str()));
        let among =
            |words: &[&str]| names.iter().position(|name| name.split(' ').any(|word| words.contains(&word)));
        let arrow = |(key, words): (Key, &[&str])| Some((key, exact(words).or_else(|| among(words))?));
        let arrows = ARROWS.into_iter().filter_map(arrow).collect();
        Self { names, letters, arrows }
    }

    /// What a key asks for.
    pub(crate) fn pressed(&self, key: &Key) -> Pressed {
        let letter = |pressed: char| self.letters.iter().position(|&letter| letter == pressed);
        let arrow = || self.arrows.iter().find(|(arrow, _)| arrow == key).map(|&(_, choice)| choice);
        match key {
            Key::Char(QUIT) | Key::Escape | Key::CtrlC => Pressed::Quit,
            Key::Enter => Pressed::Next,
            Key::Char(pressed) => letter(*pressed).map_or(Pressed::Nothing, Pressed::Choice),
            _ => arrow().map_or(Pressed::Nothing, Pressed::Choice),
        }
    }

    /// The name of a choice.
    pub(crate) fn name(&self, choice: usize) -> &str {
        self.names.get(choice).map_or("", String::as_str)
    }

    /// All keys in a line.
    pub(crate) fn help(&self) -> String {
        let choices = self.names.iter().zip(&self.letters).enumerate().map(|(choice, (name, letter))| {
            let arrow = self.arrows.iter().find(|(_, own)| *own == choice).map_or("", |(key, _)| sign(key));
            format!("{letter}{arrow} {name}")
        });
        choices
            .chain(["enter: next episode".to_owned(), format!("{QUIT}: quit")])
            .collect::<Vec<_>>()
            .join(", ")
    }
}

fn sign(arrow: &Key) -> &'static str {
    match arrow {
        Key::ArrowUp => "↑",
        Key::ArrowDown => "↓",
        Key::ArrowLeft => "←",
        _ => "→",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_choice_has_a_key_of_its_own_and_directions_have_arrows() {
        let names = ["left", "right", "forward", "pick up", "drop", "toggle", "done"];
        let keys = Keys::new(&names, 7);
        assert_eq!(keys.pressed(&Key::ArrowUp), Pressed::Choice(2), "forward, and not pick up");
        assert_eq!(keys.pressed(&Key::ArrowLeft), Pressed::Choice(0));
        assert_eq!(keys.pressed(&Key::ArrowDown), Pressed::Nothing);
        let pressed: Vec<_> = keys.letters.iter().map(|&letter| keys.pressed(&Key::Char(letter))).collect();
        assert_eq!(pressed, (0..7).map(Pressed::Choice).collect::<Vec<_>>());
        assert_eq!(keys.pressed(&Key::Char('q')), Pressed::Quit);
        assert!(keys.help().starts_with("l← left, r→ right, f↑ forward"), "{}", keys.help());
    }

    #[test]
    fn moves_come_before_pushes_and_choices_without_names_are_numbers() {
        let keys = Keys::new(&["none", "push up", "up"], 3);
        assert_eq!(keys.pressed(&Key::ArrowUp), Pressed::Choice(2));
        let keys = Keys::new(&[], 20);
        assert_eq!(keys.pressed(&Key::Char('7')), Pressed::Choice(7));
        assert_eq!(keys.name(12), "12");
    }
}
