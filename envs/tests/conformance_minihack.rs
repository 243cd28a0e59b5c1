//! River crossings against MiniHack's on NLE (fixtures/minihack).
//!
//! NetHack is random, so nothing is replayed from a seed: before each recorded step our river is brought into the situation
//! that the recorded screens show, all that it may come to is enumerated, and the recorded outcome must be among it: where
//! the hero is, what every cell shows, what was paid, whether it was the end, and the line that was read.
//!
//! Screens do not show everything. Outcomes that they do not tell apart are all followed, until one is refuted. What nobody
//! can see is assumed only when a step cannot be explained without, and then for the rest of the record: a second boulder under one that is seen, a boulder in the river's first column or where nobody
//! has looked yet (never more than five in all), a monster behind a boulder. Monsters' own deeds are not compared, ours being
//! stand-ins: what they say must stand at the end of the line, and only where there are monsters.

#[path = "../../tests/support/fixtures.rs"]
mod fixtures;
mod minihack;

use inroads_envs::{
    Snapshot,
    river::{BANK, Message, River, Setting, WAYS},
};
use minihack::{
    lines::{aside, sentences},
    record::{KEYS, Recorded, list, number, on_map, text},
    replay::{Counts, Replay},
};

/// Replays all records. The recorded rivers of one seed have the same generator, and so the same luck: of each seed only the
/// first record in which anything sank or crawled has a say in what is counted of chance.
fn replayed() -> Counts {
    let mut counts = Counts::default();
    let mut seeds = Vec::new();
    for record in fixtures::records("minihack", "river") {
        let keys: Vec<_> = list(&record["actions_order"]).iter().map(text).collect();
        assert_eq!(keys, KEYS, "the order of choices");
        let first = Replay::begin(&record);
        let what = first.what.clone();
        let steps: Vec<_> = list(&record["steps"]).iter().map(Recorded::read).collect();
        let mut replays = vec![first];
        for (taken, step) in steps.iter().enumerate() {
            let mut why = "no outcome has that end, reward, place, health and line".to_owned();
            let next = |assume, why: &mut String| -> Vec<_> {
                replays.iter().flat_map(|replay| replay.step(step, taken, assume, why)).collect()
            };
            let mut following = next(false, &mut why);
            if following.is_empty() {
                following = next(true, &mut why);
            }
            assert!(
                !following.is_empty(),
                "{what}, step {taken}: {} from {:?} came to {:?}, {:?}, reward {}, which our rules do not allow: {why}",
                WAYS[step.choice].0,
                replays[0].state.hero,
                step.hero,
                step.line,
                step.reward
            );
            // Two that have come to the same go on in the same way.
            replays = Vec::new();
            for replay in following {
                let same = |other: &Replay| {
                    (&other.state, &other.stale, &other.known)
                        == (&replay.state, &replay.stale, &replay.known)
                };
                if !replays.iter().any(same) {
                    replays.push(replay);
                }
            }
        }
        let chance = replays[0].counts.sunk != [[0; 2]; 2] || !replays[0].counts.crawled.is_empty();
        let seed = number(&record["nle_seed"]);
        counts.add(&replays[0].counts, chance && !seeds.contains(&seed));
        if chance {
            seeds.push(seed);
        }
        let last = steps.last().expect("a record has steps");
        let status =
            record["end_status"].as_str().map_or_else(|| record["end_status"].to_string(), str::to_owned);
        let expected = match (last.terminated, last.truncated, last.reward) {
            (true, false, 1.0) => "2",
            (true, false, _) => "1",
            (true, true, _) => "-1",
            (false, ..) => "0",
        };
        assert_eq!(status, expected, "{what}: how it ended");
        assert!(status != "0" || steps.len() == 120, "{what}: cut at step {}", steps.len());
        assert!(["bridge", "one_short", "walk_in", "random"].contains(&text(&record["kind"])));
    }
    counts
}

#[test]
fn conformance_minihack_admits_every_recorded_step() {
    let counts = replayed();
    let steps: usize =
        fixtures::records("minihack", "river").iter().map(|record| list(&record["steps"]).len()).sum();
    assert_eq!(counts.steps, steps, "all steps were compared");
    // Assumptions are for what screens cannot show, not for what our rules get wrong.
    assert!(counts.assumed * 50 <= steps, "{} of {steps} steps needed an assumption", counts.assumed);
    eprintln!("{steps} steps, {} of them with an assumption", counts.assumed);
}

/// Whether `hits` of `all` throws are not much fewer, nor much more, than the chance has them be: as likely at least as three
/// standard deviations are of a normal quantity. (The binomial distribution itself, because there may be few throws.)
fn likely(hits: u32, all: u32, chance: f64) -> bool {
    const BEYOND_THREE: f64 = 0.00135;
    // Logarithms: the chance of none is soon too small for a number.
    let mut log = f64::from(all) * (1.0 - chance).ln();
    let (mut fewer, mut more) = (0.0, 0.0);
    for count in 0..=all {
        let exactly = log.exp();
        fewer += if count <= hits { exactly } else { 0.0 };
        more += if count >= hits { exactly } else { 0.0 };
        log += (f64::from(all - count) / f64::from(count + 1) * chance / (1.0 - chance)).ln();
    }
    fewer >= BEYOND_THREE && more >= BEYOND_THREE
}

#[test]
fn three_deviations_are_that() {
    // 900 of 1,000 have a deviation of 9.5.
    assert!(likely(900, 1000, 0.9) && likely(874, 1000, 0.9) && likely(926, 1000, 0.9));
    assert!(!likely(868, 1000, 0.9) && !likely(930, 1000, 0.9) && likely(0, 0, 0.9));
}

#[test]
fn conformance_minihack_boulders_fill_as_often() {
    let Counts { sunk: [[filled, lost], [lava_filled, lava_lost]], .. } = replayed();
    assert!(filled + lost > 0, "no boulder came to the river");
    assert!(likely(filled, filled + lost, 0.9), "{filled} of {} boulders filled water", filled + lost);
    assert!(likely(lava_filled, lava_filled + lava_lost, 0.1), "{lava_filled} filled lava");
    // With all runs of the peer that were counted before (envs.md, section e).
    assert!(likely(158 + filled, 158 + 23 + filled + lost, 0.9));
    eprintln!("filled {filled}, lost {lost}; in lava {lava_filled} and {lava_lost}");
    // Our own odds, exactly.
    for (setting, row, chance) in [(Setting::WIDE, 3, 0.9), (Setting::LAVA, 3, 0.1), (Setting::LAVA, 2, 0.9)]
    {
        let mut river = River::new(Setting { boulders: 0, ..setting }).expect("a river that there is");
        let mut state = river.save();
        state.hero = [BANK as i8 - 2, row];
        state.map.add_boulder(on_map([BANK as i8 - 1, row]));
        river.load(&state);
        let filled = river.outcomes(1).into_iter().filter(|outcome| outcome.state.filled == 1);
        let odds: f64 = filled.map(|outcome| outcome.chance).sum();
        assert!((odds - chance).abs() < 1e-9, "row {row} of {setting:?}: {odds}");
    }
}

#[test]
fn conformance_minihack_crawls_anywhere() {
    let counts = replayed();
    let (mut squares, mut freedom, mut falls) = (0.0, 0.0, 0);
    for (count, to) in &counts.crawled {
        let all: u32 = to.iter().sum();
        falls += all;
        let expected = f64::from(all) / *count as f64;
        // Chi-square needs some to be expected of each.
        if *count > 1 && expected >= 3.0 {
            squares += to.iter().map(|&n| (f64::from(n) - expected).powi(2) / expected).sum::<f64>();
            freedom += *count as f64 - 1.0;
        }
    }
    assert!(falls > 0, "nobody fell into the river");
    if freedom == 0.0 {
        return;
    }
    // Wilson and Hilferty: the cube root of chi-square over its degrees of freedom is nearly normal.
    let part = 2.0 / (9.0 * freedom);
    let deviation = ((squares / freedom).cbrt() - (1.0 - part)) / f64::sqrt(part);
    eprintln!(
        "{falls} falls: chi-square {squares:.1} of {freedom} degrees of freedom, {deviation:.2} deviations"
    );
    assert!(deviation <= 3.0, "{deviation:.2} standard deviations from even: {:?}", counts.crawled);
}

#[test]
fn conformance_minihack_every_line_is_ours_or_accounted_for() {
    let document = fixtures::document("minihack", "message_counts.json");
    let lines = document.as_object().expect("lines with their counts");
    assert!(!lines.is_empty(), "no lines");
    let (mut all, mut ours, mut asides) = (0, 0, Vec::new());
    for (line, count) in lines {
        let foreign: Vec<_> = sentences(line)
            .into_iter()
            .filter(|sentence| !Message::all().any(|message| message.text() == *sentence))
            .collect();
        for sentence in &foreign {
            let kind =
                aside(sentence).unwrap_or_else(|| panic!("nobody here says {sentence:?} (in {line:?})"));
            asides.push((kind, sentence.to_string()));
        }
        all += number(count);
        ours += if foreign.is_empty() { number(count) } else { 0 };
    }
    eprintln!("{ours} of {all} lines are wholly ours; the others speak of {asides:?}");
    assert!(ours * 100 >= all * 95, "{ours} of {all} lines are ours");
}
