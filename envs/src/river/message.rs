//! What the game says.

use super::kinds::Kind;

/// One sentence or two that the game prints together, in NetHack's wording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Message {
    /// A boulder moves, and none did in the two turns before.
    Effort,
    /// A boulder does not move.
    InVain,
    /// What is heard of a monster that a boulder would crush.
    HearBehind,
    /// Why the boulder does not move then.
    PerhapsWhy,
    /// A boulder fills water, or lava.
    Pushed(Liquid),
    /// After [`Message::Pushed`].
    CanCross,
    /// A boulder is lost.
    Splash(Liquid),
    /// After [`Message::Splash`].
    Sinks,
    /// The hero is in the water, or lava.
    Fall(Liquid),
    /// After falling into water.
    LikeARock,
    /// The one belonging that always gets wet.
    Sack,
    /// Out of the water.
    Crawl,
    /// After [`Message::Crawl`].
    Pheew,
    /// Nothing to crawl to.
    Drown,
    /// After falling into lava.
    Crisp,
    /// The edge of the map.
    SolidStone,
    /// The hero fights a monster.
    Fights(Kind, Blow),
    /// A monster fights the hero.
    Fought(Kind, Attack),
    /// After a grid bug's bite.
    Zapped,
    /// A lichen holds the hero.
    Held(Kind),
    /// It holds him no longer.
    Free(Kind),
    /// No health left.
    Die,
}

/// What a river is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Liquid {
    /// Wet.
    Water,
    /// Deadly.
    Lava,
}

/// How the hero's blow ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Blow {
    /// It goes wrong.
    Misses,
    /// It hurts.
    Hits,
    /// It kills.
    Kills,
}

/// How a monster's attack ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Attack {
    /// It goes wrong.
    Misses,
    /// It goes wrong by the least amount.
    JustMisses,
    /// It hurts.
    Hits,
}

impl Message {
    /// The wording.
    pub fn text(self) -> &'static str {
        match self {
            Self::Effort => "With great effort you move the boulder.",
            Self::InVain => "You try to move the boulder, but in vain.",
            Self::HearBehind => "You hear a monster behind the boulder.",
            Self::PerhapsWhy => "Perhaps that's why you cannot move it.",
            Self::Pushed(Liquid::Water) => "You push the boulder into the water.",
            Self::Pushed(Liquid::Lava) => "You push the boulder into the lava.",
            Self::CanCross => "Now you can cross it!",
            Self::Splash(Liquid::Water) => "There is a large splash as the boulder falls into the water.",
            Self::Splash(Liquid::Lava) => "There is a large splash as the boulder falls into the lava.",
            Self::Sinks => "It sinks without a trace!",
            Self::Fall(Liquid::Water) => "You fall into the water!",
            Self::Fall(Liquid::Lava) => "You fall into the lava!",
            Self::LikeARock => "You sink like a rock.",
            Self::Sack => "Water gets into your sack!",
            Self::Crawl => "You try to crawl out of the water.",
            Self::Pheew => "Pheew!  That was close.",
            Self::Drown => "You drown.",
            Self::Crisp => "You burn to a crisp...",
            Self::SolidStone => "It's solid stone.",
            Self::Fights(kind, blow) => kind.words().fights[blow as usize],
            Self::Fought(kind, attack) => kind.words().fought[attack as usize],
            Self::Zapped => "You get zapped!",
            Self::Held(kind) => kind.words().held,
            Self::Free(kind) => kind.words().free,
            Self::Die => "You die...",
        }
    }

    /// All that the game can say.
    pub fn all() -> impl Iterator<Item = Self> {
        let plain = [
            Self::Effort,
            Self::InVain,
            Self::HearBehind,
            Self::PerhapsWhy,
            Self::CanCross,
            Self::Sinks,
            Self::LikeARock,
            Self::Sack,
            Self::Crawl,
            Self::Pheew,
            Self::Drown,
            Self::Crisp,
            Self::SolidStone,
            Self::Zapped,
            Self::Die,
        ];
        let wet = [Liquid::Water, Liquid::Lava]
            .into_iter()
            .flat_map(|liquid| [Self::Pushed(liquid), Self::Splash(liquid), Self::Fall(liquid)]);
        let fights = Kind::ALL.into_iter().flat_map(|kind| {
            let blows = [Blow::Misses, Blow::Hits, Blow::Kills].map(|blow| Self::Fights(kind, blow));
            let attacks =
                [Attack::Misses, Attack::JustMisses, Attack::Hits].map(|attack| Self::Fought(kind, attack));
            blows.into_iter().chain(attacks)
        });
        let holds = Kind::ALL
            .into_iter()
            .filter(|kind| kind.sticks())
            .flat_map(|kind| [Self::Held(kind), Self::Free(kind)]);
        plain.into_iter().chain(wet).chain(fights).chain(holds)
    }
}

/// How much of a turn's text the hero is told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Text {
    /// All of it.
    #[default]
    Whole,
    /// What an agent of NLE is told: the last line that the terminal shows, the others being confirmed unseen.
    LastLine,
}

/// Characters that NetHack fills of its terminal's line (80 columns less room for `--More--`).
const LINE: usize = 72;

/// Which of a turn's messages stand on the last line that the terminal shows.
///
/// NetHack writes a message behind the one before, two spaces between, when there is room, and asks for
/// confirmation when there is none. A death always stands on a line of its own.
pub fn last_line<'a>(texts: impl IntoIterator<Item = &'a str>) -> std::ops::Range<usize> {
    let (mut from, mut to, mut filled) = (0, 0, 0);
    for text in texts {
        let fits = filled + text.len() + 3 < LINE && !text.starts_with("You die");
        if to > 0 && fits {
            filled += 2 + text.len();
        } else {
            (from, filled) = (to, text.len());
        }
        to += 1;
    }
    from..to
}

/// The words of a text: letters, as they stand there.
pub fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|letter: char| !letter.is_ascii_alphabetic()).filter(|word| !word.is_empty())
}

/// All words that the game can say, in lower case and alphabetical order.
pub fn vocabulary() -> Vec<String> {
    let mut all: Vec<_> =
        Message::all().flat_map(|message| words(message.text())).map(str::to_ascii_lowercase).collect();
    all.sort();
    all.dedup();
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_where_nethack_breaks_them() {
        let text = |messages: &[Message]| messages.iter().map(|message| message.text()).collect::<Vec<_>>();
        let line = |messages: &[Message]| {
            let texts = text(messages);
            texts[last_line(texts.iter().copied())].join("  ")
        };
        use Message as M;
        assert_eq!(line(&[]), "");
        let filled = [M::Pushed(Liquid::Water), M::CanCross];
        assert_eq!(line(&filled), "You push the boulder into the water.  Now you can cross it!");
        assert_eq!(line(&[M::Splash(Liquid::Water), M::Sinks]), "It sinks without a trace!");
        assert_eq!(line(&[M::HearBehind, M::PerhapsWhy]), "Perhaps that's why you cannot move it.");
        let fall = [M::Fall(Liquid::Water), M::LikeARock, M::Sack, M::Crawl, M::Pheew];
        assert_eq!(line(&fall), "Pheew!  That was close.");
        assert_eq!(line(&[M::Zapped, M::Die]), "You die...");
    }

    #[test]
    fn words_are_those_of_the_messages() {
        let words = vocabulary();
        assert!(words.is_sorted() && words.iter().all(|word| word.bytes().all(|b| b.is_ascii_lowercase())));
        for word in ["water", "boulder", "lava", "stone", "s", "jackal", "pheew"] {
            assert!(words.iter().any(|other| other == word), "{word}");
        }
    }
}
