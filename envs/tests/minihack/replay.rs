//! A record that is played again on our river.

use inroads_envs::{
    Snapshot,
    river::{
        COLUMNS, GOAL, Ground, Kind, Map, Message, Monster, Outcome, Place, ROWS, River, Setting, State,
        Turn, WAYS,
    },
};
use serde_json::Value;

use super::{
    lines::{LEVEL, LOAD, aside, lines, of_monsters, sentences},
    record::{CORNER, LIMIT, Recorded, list, on_map, place, setting, text},
};

/// What is counted over records.
#[derive(Clone, Default)]
pub(crate) struct Counts {
    pub(crate) steps: usize,
    pub(crate) assumed: usize,
    /// Filled and lost: in water, in lava.
    pub(crate) sunk: [[u32; 2]; 2],
    /// By the number of cells to crawl to: how often to each.
    pub(crate) crawled: Vec<(usize, Vec<u32>)>,
}

impl Counts {
    fn crawl(&mut self, banks: usize) -> &mut Vec<u32> {
        let row = self.crawled.iter().position(|(count, _)| *count == banks);
        let row = row.unwrap_or_else(|| {
            self.crawled.push((banks, vec![0; banks]));
            self.crawled.len() - 1
        });
        &mut self.crawled[row].1
    }

    /// Adds another's counts; those of chance only if it is to have a say.
    pub(crate) fn add(&mut self, other: &Self, chance: bool) {
        self.steps += other.steps;
        self.assumed += other.assumed;
        if !chance {
            return;
        }
        for liquid in 0..2 {
            for end in 0..2 {
                self.sunk[liquid][end] += other.sunk[liquid][end];
            }
        }
        for (banks, to) in &other.crawled {
            self.crawl(*banks).iter_mut().zip(to).for_each(|(all, more)| *all += more);
        }
    }
}

/// A record in the course of its replay.
#[derive(Clone)]
pub(crate) struct Replay {
    pub(crate) what: String,
    monsters: bool,
    pub(crate) state: State,
    river: River,
    screen: Vec<char>,
    start: Place,
    /// Cells of which it is known what lies there.
    pub(crate) known: Vec<bool>,
    /// Cells that have changed where nobody could see it: behind the rest of a pile.
    pub(crate) stale: Vec<bool>,
    /// Whether the hero has taken up more than he carries easily.
    loaded: bool,
    pub(crate) counts: Counts,
}

impl Replay {
    pub(crate) fn begin(record: &Value) -> Self {
        let setting = setting(text(&record["env"]));
        let river =
            River::new(Setting { boulders: 0, monsters: 0, ..setting }).expect("a river that there is");
        let mut state = river.save();
        state.hero = place(&record["start_xy"][0], &record["start_xy"][1]);
        let mut replay = Self {
            what: format!("{}, seed {}", text(&record["env"]), record["nle_seed"]),
            monsters: setting.monsters > 0,
            start: state.hero,
            state,
            river,
            screen: vec![' '; COLUMNS * ROWS],
            known: vec![false; COLUMNS * ROWS],
            stale: vec![false; COLUMNS * ROWS],
            loaded: false,
            counts: Counts::default(),
        };
        let rows = list(&record["chars0"]).iter().enumerate();
        let shown: Vec<_> = rows
            .flat_map(|(y, row)| {
                text(row).chars().enumerate().map(move |(x, shown)| (x as i8, y as i8, shown))
            })
            .filter(|&(.., shown)| shown != ' ')
            .map(|(x, y, shown)| (on_map([x - CORNER[0], y - CORNER[1]]), shown))
            .collect();
        match text(&record["start_message"]) {
            "Hello Agent, welcome to NetHack!  You are a chaotic male human Rogue." => {}
            "There is a staircase up here.  You see here a boulder." => {
                replay.state.map.add_boulder(on_map(replay.start));
            }
            other => panic!("{}: nobody is greeted by {other:?}", replay.what),
        }
        replay.look(&shown).unwrap_or_else(|why| panic!("{}: {why}", replay.what));
        replay
    }

    /// Sees what the screen shows anew: it must be what is there, as far as that is known.
    fn look(&mut self, shown: &[(usize, char)]) -> Result<(), String> {
        for &(cell, shown) in shown {
            self.screen[cell] = shown;
        }
        for cell in 0..self.screen.len() {
            let shown = self.screen[cell];
            if shown == '`' && !self.known[cell] && self.state.map.boulders(cell) == 0 {
                self.state.map.add_boulder(cell);
            }
            let ours = self.shown(cell);
            let terrain = ".}`@<>".contains(shown);
            let stale = self.stale[cell] && !self.beside(cell);
            if shown != ours && shown != ' ' && !stale && (terrain || !self.monsters) {
                return Err(format!("{:?} shows {shown:?} where we have {ours:?}", Map::place(cell)));
            }
            self.stale[cell] &= shown != ours;
            // What lies in the water, or where a monster was put, is not seen.
            self.known[cell] |= terrain && shown != '}';
        }
        Ok(())
    }

    /// Whether the hero touches a cell, and so sees what is there.
    fn beside(&self, cell: usize) -> bool {
        let ([x, y], [a, b]) = (Map::place(cell), self.state.hero);
        x.abs_diff(a) <= 1 && y.abs_diff(b) <= 1
    }

    /// What a cell shows to whoever sees it.
    fn shown(&self, cell: usize) -> char {
        let (map, place) = (&self.state.map, Map::place(cell));
        match map.ground(cell) {
            _ if place == self.state.hero => '@',
            Ground::Water | Ground::Lava => '}',
            Ground::Floor if map.boulders(cell) > 0 => '`',
            Ground::Floor if place == self.start => '<',
            Ground::Floor if place == GOAL => '>',
            Ground::Floor => '.',
        }
    }

    /// Our monsters are those on the screen; of kinds that look alike the one that the line names.
    fn meet(&mut self, line: &str) {
        let named = |kind: &Kind| {
            Message::all().any(|message| match message {
                Message::Fights(other, _) => other == *kind && line.contains(message.text()),
                _ => false,
            })
        };
        self.state.monsters.clear();
        self.state.holder = None;
        for (cell, &shown) in self.screen.iter().enumerate() {
            // An I is what is remembered of a monster that nobody has seen.
            let monster = shown.is_alphabetic() && shown != 'I' || shown == ':';
            let mut alike = Kind::ALL.iter().filter(|kind| kind.nature().letter == shown);
            let place = Map::place(cell);
            if self.monsters && place != self.state.hero && monster {
                let kind =
                    alike.clone().find(|kind| named(kind)).or(alike.next()).copied().unwrap_or(Kind::Newt);
                self.state.monsters.push(Monster { kind, place, health: 4 });
            }
        }
    }

    /// All replays that go on from here by the recorded step; those that need an assumption too, if they may make one.
    /// `why` says, when there is none, why the last that was tried is not.
    pub(crate) fn step(
        &self,
        recorded: &Recorded,
        taken: usize,
        assume: bool,
        why: &mut String,
    ) -> Vec<Self> {
        let mut before = self.clone();
        before.meet(&recorded.line);
        let [dx, dy] = WAYS[recorded.choice].1;
        let [x, y] = before.state.hero;
        let (to, beyond) = (Map::cell([x + dx, y + dy]), Map::cell([x + 2 * dx, y + 2 * dy]));
        let unseen = |cell: &usize| {
            let [x, y] = Map::place(*cell);
            !before.known[*cell] && (1..=18).contains(&x) && (1..=5).contains(&y)
        };
        let pile = to.filter(|&cell| before.state.map.boulders(cell) > 0);
        let hidden = [pile, beyond.filter(unseen), to.filter(unseen)].into_iter().flatten();
        let assumed = |assumption: &dyn Fn(&mut Self) -> bool| {
            let mut other = before.clone();
            other.counts.assumed += 1;
            assumption(&mut other).then_some(other)
        };
        let mut starts = vec![];
        if !assume {
            // Who is loaded takes more turns than steps.
            starts.extend(before.loaded.then(|| {
                let mut slow = before.clone();
                slow.state.rested = 3;
                slow
            }));
            starts.push(before.clone());
        } else {
            starts.extend(hidden.filter_map(|cell| {
                assumed(&|other| {
                    other.state.map.add_boulder(cell);
                    true
                })
            }));
            starts.extend(assumed(&|other| other.assume_monster(&recorded.line, beyond)));
        }
        let mut next = Vec::new();
        for mut start in starts {
            start.river.load(&start.state);
            let outcomes = start.river.outcomes(recorded.choice);
            let chance: f64 = outcomes.iter().map(|outcome| outcome.chance).sum();
            assert!((chance - 1.0).abs() < 1e-9, "all outcomes together have chance {chance}");
            for outcome in outcomes.iter().filter(|outcome| start.admits(outcome, recorded, taken)) {
                let mut other = start.clone();
                match other.go_on(outcome, recorded) {
                    Ok(()) => next.push(other),
                    Err(reason) => *why = reason,
                }
            }
        }
        next
    }

    /// What only monsters explain: one that nobody sees behind a boulder, and one that holds the hero.
    fn assume_monster(&mut self, line: &str, beyond: Option<usize>) -> bool {
        if !self.monsters {
            return false;
        }
        let holds = |monster: &Monster| {
            let [x, y] = self.state.hero;
            let [dx, dy] = [monster.place[0] - x, monster.place[1] - y];
            monster.kind.sticks() && dx.abs() <= 1 && dy.abs() <= 1
        };
        if line.ends_with("Perhaps that's why you cannot move it.") {
            beyond.is_some_and(|cell| {
                self.state.monsters.push(Monster { kind: Kind::Newt, place: Map::place(cell), health: 4 });
                true
            })
        } else {
            self.state.holder = self.state.monsters.iter().position(holds);
            self.state.holder.is_some()
        }
    }

    /// Whether an outcome of ours is what was recorded.
    fn admits(&self, outcome: &Outcome, recorded: &Recorded, taken: usize) -> bool {
        let (step, turn) = (outcome.turn.step(), outcome.turn);
        let ended = matches!(turn, Turn::Won | Turn::Dead);
        let killed = self.monsters && turn == Turn::Passed && recorded.terminated && !recorded.truncated;
        let last = taken + 1 == LIMIT && !ended && !killed;
        if step.reward != recorded.reward
            || (ended || killed || last) != recorded.terminated
            || last != recorded.truncated
            || recorded.terminated != recorded.cells.is_none()
        {
            return false;
        }
        if recorded.terminated {
            // The screen is cleared then, the line too, and numbers are nought.
            let nought = [-CORNER[0], -CORNER[1]];
            return recorded.line.is_empty() && recorded.hero == nought && recorded.health == 0;
        }
        // Monsters may hurt; a point of health may come back.
        let health = i64::from(outcome.state.health);
        let healthy = match self.monsters {
            true => recorded.health <= health + 1 || recorded.line.contains(LEVEL),
            false => recorded.health == health,
        };
        outcome.state.hero == recorded.hero && healthy && self.says(outcome, &recorded.line)
    }

    /// Whether the line can be what the terminal shows last of what the outcome says, and monsters after it.
    fn says(&self, outcome: &Outcome, line: &str) -> bool {
        let log = outcome.state.log();
        let lines = lines(log);
        if lines.iter().any(|ours| ours == line) {
            return true;
        }
        let sentences = sentences(line);
        self.monsters
            && (0..=sentences.len()).any(|count| {
                let (own, foreign) = sentences.split_at(count);
                let tail = log.len().checked_sub(count).map(|from| &log[from..]);
                tail.is_some_and(|tail| tail.iter().map(|message| message.text()).eq(own.iter().copied()))
                    && !foreign.is_empty()
                    && foreign.iter().all(|sentence| of_monsters(sentence) || aside(sentence).is_some())
            })
    }

    /// Takes over an outcome, and counts what happened by chance; the error says where the screen contradicts it.
    fn go_on(&mut self, outcome: &Outcome, recorded: &Recorded) -> Result<(), String> {
        self.counts.steps += 1;
        let before = std::mem::replace(&mut self.state, outcome.state.clone());
        if outcome.turn == Turn::Passed {
            self.state.pass();
        }
        self.state.health = u8::try_from(recorded.health).map_err(|why| why.to_string())?;
        let all = self.state.map.all_boulders() + self.state.filled + self.state.lost;
        if all > 5 {
            return Err(format!("{all} boulders are more than there are"));
        }
        let Some(cells) = &recorded.cells else { return Ok(()) };
        // Behind the rest of a pile, or behind water, which NetHack cannot see through, nobody sees what has changed.
        for cell in 0..self.stale.len() {
            let changed = outcome.state.map.boulders(cell) > before.map.boulders(cell)
                || outcome.state.map.ground(cell) != before.map.ground(cell);
            self.stale[cell] |= changed && !cells.iter().any(|&(seen, _)| seen == cell);
        }
        self.loaded |= self.monsters && recorded.line.contains(LOAD);
        // Whoever has been in a cell knows what lay there.
        let [dx, dy] = WAYS[recorded.choice].1;
        let to = [before.hero[0] + dx, before.hero[1] + dy];
        let been = outcome.state.hero == to || outcome.state.log().contains(&Message::Crawl);
        if let Some(cell) = Map::cell(to).filter(|_| been) {
            self.known[cell] = true;
        }
        self.look(cells)?;
        let lava = outcome.state.log().iter().any(|message| message.text().contains("lava"));
        let sunk = &mut self.counts.sunk[usize::from(lava)];
        sunk[0] += outcome.state.filled - before.filled;
        sunk[1] += outcome.state.lost - before.lost;
        if outcome.state.log().contains(&Message::Crawl) && !self.monsters {
            let mut banks: Vec<_> = outcome.state.map.around(to).collect();
            banks.sort_unstable();
            let at = banks.iter().position(|&cell| Map::place(cell) == recorded.hero);
            self.counts.crawl(banks.len())[at.expect("out of the water")] += 1;
        }
        Ok(())
    }
}
