//! The engine of Baba Is You, and the U-maze.

use std::collections::{HashMap, HashSet, VecDeque};

use inroads_envs::{
    Bits, End, ProtoGoals, Seed, Snapshot,
    baba::{Baba, Kind, Level, Noun, Property, State, U_MAZE, WAYS, Word},
    world::{Layout, World},
};
use rand::RngExt;

fn level(text: &str) -> Baba {
    let mut baba = Baba::new(Level::parse(text).expect("a level"));
    baba.begin(Layout::Random.draw(0));
    baba
}

/// How a level stands, as its text has it; of several units in a cell the last.
fn drawn(baba: &Baba) -> String {
    let [columns, rows] = baba.size();
    let mut cells = vec!['.'; columns * rows];
    for unit in &baba.state().units {
        cells[usize::from(unit.cell)] = unit.kind.letter();
    }
    cells.chunks(columns).map(|row| row.iter().collect::<String>() + "\n").collect()
}

/// Plays `u`, `d`, `l`, `r` and says how it ended, and what it paid.
fn play(baba: &mut Baba, moves: &str) -> (f32, Option<End>) {
    let mut last = (0.0, None);
    for letter in moves.chars() {
        let choice = WAYS.iter().position(|(name, _)| name.starts_with(letter)).expect("a way");
        let step = baba.act(choice);
        last = (step.reward, step.end);
    }
    last
}

/// All positions that can be reached, with the length of the shortest way to each; wins are not played on.
fn explored(start: &Baba) -> (HashMap<Position, u32>, Vec<(u32, State)>) {
    let mut far = HashMap::from([(key(start), 0)]);
    let mut queue = VecDeque::from([(start.save(), 0)]);
    let (mut baba, mut wins) = (start.clone(), Vec::new());
    while let Some((state, steps)) = queue.pop_front() {
        for choice in 0..WAYS.len() {
            baba.load(&state);
            let step = baba.act(choice);
            if step.reward > 0.0 {
                wins.push((steps + 1, baba.save()));
            } else if step.end.is_none() && !far.contains_key(&key(&baba)) {
                far.insert(key(&baba), steps + 1);
                queue.push_back((baba.save(), steps + 1));
            }
        }
    }
    (far, wins)
}

/// Kind and cell of every unit.
type Position = Vec<(Kind, u16)>;

fn key(baba: &Baba) -> Position {
    baba.state().units.iter().map(|unit| (unit.kind, unit.cell)).collect()
}

#[test]
fn chains_are_pushed_and_walls_stop_them() {
    let mut baba = level("B=Y...\nbRF...\n......\n");
    play(&mut baba, "rr");
    assert_eq!(drawn(&baba), "B=Y...\n..bRF.\n......\n");
    play(&mut baba, "rr");
    assert_eq!(drawn(&baba), "B=Y...\n...bRF\n......\n", "the edge stops the chain");
    let mut baba = level("B=YH=S\nbR.Fh.\n......\n");
    play(&mut baba, "rrr");
    assert_eq!(drawn(&baba), "B=YH=S\n.bRFh.\n......\n", "so does what is STOP, behind a gap that closes");
}

#[test]
fn all_that_is_you_moves_together() {
    let mut baba = level("B=Y...\nbb.b..\n......\n");
    play(&mut baba, "r");
    assert_eq!(drawn(&baba), "B=Y...\n.bb.b.\n......\n");
    play(&mut baba, "rr");
    assert_eq!(drawn(&baba), "B=Y...\n...bbb\n......\n", "none is left behind where there is room");
}

#[test]
fn words_change_what_happens() {
    // Broken off, the rule about the hedge holds no longer; and without a YOU the game is lost.
    let mut baba = level("H=S.\nbh..\nB=Y.\n....\n");
    assert_eq!(play(&mut baba, "r"), (0.0, None));
    assert_eq!(drawn(&baba), "H=S.\nbh..\nB=Y.\n....\n");
    let mut baba = level("H=S.\n.b..\nB=Y.\n....\n");
    assert_eq!(play(&mut baba, "d"), (0.0, Some(End::Terminated)), "IS is pushed out of BABA IS YOU");
    let mut baba = level("B=Y..\n..W..\n..=b.\nW=R..\n..w..\n");
    play(&mut baba, "r");
    let walls =
        |baba: &Baba| baba.state().units.iter().filter(|unit| unit.kind == Kind::Thing(Noun::Wall)).count();
    assert_eq!(walls(&baba), 0, "WALL IS ROCK");
}

#[test]
fn rocks_are_pushed_when_words_say_so() {
    let mut baba = level("B=Y..\nbr...\nR=P..\n");
    play(&mut baba, "rr");
    assert_eq!(drawn(&baba), "B=Y..\n..br.\nR=P..\n");
    let mut baba = level("B=Y..\nbr...\nR....\n");
    play(&mut baba, "r");
    assert_eq!(baba.state().units.iter().filter(|unit| unit.cell == 6).count(), 2, "walked over");
    let mut baba = level("B=Y..\nbf...\nF=N..\n");
    assert_eq!(play(&mut baba, "r"), (1.0, Some(End::Terminated)));
}

/// Steps of the shortest solution: the certificate of the docs page.
const SHORTEST: u32 = 31;

#[test]
fn the_u_maze_has_no_shorter_trick() {
    let start = level(U_MAZE);
    let (far, wins) = explored(&start);
    let wall = Kind::Block(Word::Noun(Noun::Wall));
    assert_eq!(wins.iter().map(|(steps, _)| *steps).min(), Some(SHORTEST));
    let won: HashSet<u16> = wins.iter().map(|(_, state)| at(state, wall)).collect();
    assert_eq!(won, HashSet::from([5 * 11 + 1]), "all wins have WALL above IS at the foot of the left arm");
    assert!(wins.iter().all(|(_, state)| state.rules.has(Noun::Wall, Property::Win)));
    // Nothing else can be moved: neither words, of which the rules are made that hold, nor the wall.
    let fixed = |units: &Position| -> Position {
        let mobile = |kind: &Kind| *kind == wall || *kind == Kind::Thing(Noun::Baba);
        units.iter().filter(|(kind, _)| !mobile(kind)).copied().collect()
    };
    assert!(far.keys().all(|units| fixed(units) == fixed(&key(&start))));
    assert!(far.len() > 300, "{} positions", far.len());
}

fn at(state: &State, kind: Kind) -> u16 {
    state.units.iter().find(|unit| unit.kind == kind).expect("it is there").cell
}

#[test]
fn the_u_maze_is_solved_by_its_idea() {
    let mut baba = level(U_MAZE);
    // Up the right arm, the word along the corridor, down the left arm, and back.
    let solution = ["uuuuu", "lll", "llll", "ul", "ddd", "uu", "rrrrrrr", "ddddd"].concat();
    assert_eq!(solution.len(), SHORTEST as usize);
    assert_eq!(play(&mut baba, &solution), (1.0, Some(End::Terminated)));
}

#[test]
fn units_are_kept_and_never_where_something_stops() {
    for (name, text) in
        [("u-maze", U_MAZE), ("open", "hhhhhhh\nhB=Y..h\nhb.r.wh\nhR=Pf.h\nh.W=N.h\nhH=S..h\nhhhhhhh\n")]
    {
        for seed in 0..20 {
            let mut rng = Seed(seed).stream("test", 0);
            let mut baba = level(text);
            let count = baba.state().units.len();
            let mut saved = None;
            let mut after = Vec::new();
            for step in 0..300 {
                if step == 100 {
                    saved = Some(baba.save());
                }
                let choice = rng.random_range(0..WAYS.len());
                let outcome = baba.act(choice);
                if step >= 100 {
                    after.push((choice, baba.save()));
                }
                let State { units, rules } = baba.state();
                assert_eq!(units.len(), count, "{name}");
                for unit in units.iter().filter(|unit| rules.is_stop(unit.kind)) {
                    let company = units.iter().filter(|other| other.cell == unit.cell).count();
                    // A rule may begin to hold where things are already.
                    assert!(company == 1 || name == "open", "{name}: {unit:?}");
                }
                if outcome.end.is_some() {
                    break;
                }
            }
            if let Some(saved) = saved {
                baba.load(&saved);
                for (choice, state) in after {
                    baba.act(choice);
                    assert_eq!(baba.save(), state, "{name}: what follows a load is what followed the save");
                }
            }
        }
    }
}

#[test]
fn goals_are_kinds_in_cells() {
    let mut baba = level(U_MAZE);
    let names = baba.proto_goals();
    assert_eq!(names.len(), 9 * 99);
    let mut bits = Bits::default();
    baba.annotate(&mut bits);
    let mut held: Vec<_> = bits.ones().map(|bit| names[bit].as_str()).collect();
    held.sort_unstable();
    assert!(held.contains(&"baba at 9,7") && held.contains(&"wall at 8,7") && held.contains(&"WALL at 5,2"));
    // 11 units besides hedges, all at places of their own.
    assert_eq!(held.len(), 11);
    play(&mut baba, "u");
    baba.annotate(&mut bits);
    assert!(
        bits.ones().any(|bit| names[bit] == "baba at 9,6")
            && !bits.ones().any(|bit| names[bit] == "baba at 9,7")
    );
}

#[test]
fn a_start_anywhere_is_on_a_free_cell() {
    let mut baba = level(U_MAZE);
    let mut starts = HashSet::new();
    for seed in 0..300 {
        baba.begin(Layout::FixedMap(42).draw(seed));
        let sheep = at(baba.state(), Kind::Thing(Noun::Baba));
        let units = &baba.state().units;
        let alone =
            units.iter().filter(|unit| unit.cell == sheep && unit.kind != Kind::Thing(Noun::Wall)).count();
        assert_eq!(alone, 1);
        starts.insert(sheep);
    }
    // 18 cells of the corridor without WALL's, and 20 of the arms without IS and WIN.
    assert!(starts.len() > 30 && starts.len() <= 35, "{}", starts.len());
}
