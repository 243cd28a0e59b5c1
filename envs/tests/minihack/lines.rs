//! What stands on the terminal's last line.

use inroads_envs::river::{Message, last_line};

/// The lines that the terminal may show last of these messages: the peer's hero has belongings that rust, which is told
/// before his sack gets wet, and moves the ends of lines.
pub(crate) fn lines(log: &[Message]) -> Vec<String> {
    let rust = "x".repeat(60);
    let sack = log.iter().position(|&message| message == Message::Sack);
    let told = (0..=sack.map_or(0, |_| rust.len())).map(|length| {
        let mut texts: Vec<_> = log.iter().map(|message| message.text()).collect();
        if let (Some(at), 1..) = (sack, length) {
            texts.insert(at, &rust[..length]);
        }
        texts[last_line(texts.iter().copied())].join("  ")
    });
    let mut lines: Vec<_> = told.filter(|line| !line.contains('x') || sack.is_none()).collect();
    lines.dedup();
    lines
}

/// A line's messages. Some of ours have two spaces within, as between messages.
pub(crate) fn sentences(line: &str) -> Vec<&str> {
    let mut sentences = Vec::new();
    let mut rest = line;
    while !rest.is_empty() {
        let ours = Message::all().map(|message| message.text().len()).filter(|&length| {
            Message::all().any(|message| message.text().len() == length && rest.starts_with(message.text()))
                && (rest.len() == length || rest[length..].starts_with("  "))
        });
        let end = ours.max().or(rest.find("  ")).unwrap_or(rest.len());
        sentences.push(&rest[..end]);
        rest = rest[end..].trim_start_matches(' ');
    }
    sentences
}

/// Whether it is a sentence of our monsters' fights.
pub(crate) fn of_monsters(sentence: &str) -> bool {
    Message::all().any(|message| {
        let fights =
            matches!(message, Message::Fights(..) | Message::Fought(..) | Message::Zapped | Message::Die);
        fights && message.text() == sentence
    })
}

/// How the game tells that the hero has grown, in health too.
pub(crate) const LEVEL: &str = "Welcome to experience level ";
/// How the game begins to speak of what a load does to the hero: turns are then no longer one a step.
pub(crate) const LOAD: &str = "Your movements are ";

/// How sentences begin of what the peer has and we have not.
pub(crate) const ASIDES: [(&str, &[&str]); 5] = [
    ("experience", &[LEVEL]),
    (
        "belongings that get wet or rot",
        &["Your short sword ", "Your dagger", "Your potion ", "Your diluted potion "],
    ),
    (
        "things on the floor, or taken up",
        &["You see here", "There are several ", "You have a little trouble ", LOAD],
    ),
    (
        "other monsters, and weapons",
        &["The ", "A ", "An ", "You are hit by ", "You are almost hit by ", "You kill ", "You destroy "],
    ),
    ("other monsters, and weapons", &["You hit ", "You miss "]),
];

/// Which kind of thing the peer speaks of there that we have not; none: it is no such thing.
pub(crate) fn aside(sentence: &str) -> Option<&'static str> {
    let ours = Message::all().any(|message| message.text() == sentence);
    let river = ["boulder", "water", "lava", "stone"].iter().any(|word| sentence.contains(word));
    let taken_up = sentence.get(1..4) == Some(" - ");
    let rots = sentence.starts_with("Your ") && sentence.ends_with(" rots away.");
    let begins = || {
        let mut asides = ASIDES.iter();
        asides.find(|(_, starts)| starts.iter().any(|start| sentence.starts_with(start)))
    };
    match () {
        () if ours || river => None,
        () if taken_up || rots => Some("things on the floor, or taken up"),
        () => begins().map(|(kind, _)| *kind),
    }
}
