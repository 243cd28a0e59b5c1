//! How fast a workload is, and how fast relative to the calibration loop, whoever else is on the machine.
//!
//! In a round, cycle and calibration alternate, and of every piece the fastest repetition counts: one
//! that nobody interrupted. The calibration is cut into pieces of the same length as the workload's, so that what
//! interrupts hits both alike. Processors also change their pace over seconds, so a ratio is made of what
//! was timed within one round (about a tenth of a second), and the median over rounds counts.

use std::time::{Duration, Instant};

use crate::{
    calibration::Yardstick,
    compare::median,
    workload::{Work, Workload},
};

/// How long to measure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Rounds, whose median counts.
    pub(crate) rounds: usize,
    /// Repetitions in a round, of which the fastest counts.
    pub(crate) repetitions: usize,
}

/// What a round found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Round {
    /// Microseconds of one operation.
    pub(crate) micros: f64,
    /// Operations in the time of one calibration loop.
    pub(crate) relative: f64,
}

/// A workload, the loops beside it, and what was found so far.
pub(crate) struct Measured {
    pub(crate) workload: Workload,
    pub(crate) rounds: Vec<Round>,
    /// Calibration loops that take as long as a piece.
    loops: u32,
    /// How many times as long everything takes as it would; for trying out the comparison.
    pub(crate) handicap: f64,
}

/// Calibration loops in a piece before it is known how many there should be: some tenths of a millisecond.
const PROBE: u32 = 32;
/// Threads that take this many times as long as an undisturbed one, on average, have no processors to themselves.
const CROWDED: f64 = 1.2;
/// Pieces of calibration beside a cycle, at most.
const SLOTS: usize = 8;

impl Measured {
    pub(crate) fn new(workload: Workload, yardstick: &mut Yardstick) -> Self {
        let mut made = Self { workload, rounds: Vec::new(), loops: PROBE, handicap: 1.0 };
        // Of the fastest repetitions, as everything.
        let first = made.round(yardstick, 8);
        made.loops = made.matching(first);
        made
    }

    /// One round.
    pub(crate) fn round(&mut self, yardstick: &mut Yardstick, repetitions: usize) -> Round {
        let pieces = self.workload.pieces;
        let mut cycle = vec![f64::INFINITY; pieces];
        let mut beside = vec![f64::INFINITY; pieces.min(SLOTS)];
        for _ in 0..repetitions {
            for fastest in &mut beside {
                let taken = time(1.0, || yardstick.loops(self.loops, self.workload.threads));
                *fastest = fastest.min(taken);
            }
            self.workload.work.begin();
            for (piece, fastest) in cycle.iter_mut().enumerate() {
                *fastest = fastest.min(time(self.handicap, || self.workload.work.piece(piece)));
            }
        }
        let operation = cycle.iter().sum::<f64>() / self.workload.operations as f64;
        let calibrated = beside.iter().sum::<f64>() / (beside.len() as f64 * f64::from(self.loops));
        let round = Round { micros: operation * 1e6, relative: calibrated / operation };
        // A length that an interruption had doubled would stay doubled, and be interrupted ever after.
        self.loops = self.loops.min(self.matching(round));
        round
    }

    /// Calibration loops that take as long as a piece.
    fn matching(&self, found: Round) -> u32 {
        let loops = self.workload.operations as f64 / (self.workload.pieces as f64 * found.relative);
        loops.round().max(1.0) as u32
    }

    /// Rounds that are not kept; the median ratio.
    pub(crate) fn again(&mut self, yardstick: &mut Yardstick, effort: Effort) -> f64 {
        let ratios = (0..effort.rounds).map(|_| self.round(yardstick, effort.repetitions).relative);
        median(ratios.collect())
    }

    /// Whether its threads have processors to themselves now. Where a neighbour holds one of them, work on several
    /// threads tells nothing: they wait for each other.
    pub(crate) fn has_room(&self, yardstick: &mut Yardstick) -> bool {
        const TIMES: u32 = 100;
        if self.workload.threads == 1 {
            return true;
        }
        let mut times =
            |threads| (0..TIMES).map(|_| time(1.0, || yardstick.loops(self.loops, threads))).collect();
        let [alone, together]: [Vec<f64>; 2] = [times(1), times(self.workload.threads)];
        let undisturbed = alone.into_iter().fold(f64::INFINITY, f64::min);
        together.iter().sum::<f64>() < CROWDED * undisturbed * f64::from(TIMES)
    }

    /// Microseconds of one operation.
    pub(crate) fn micros(&self) -> f64 {
        median(self.rounds.iter().map(|round| round.micros).collect())
    }

    /// Operations in the time of one calibration loop.
    pub(crate) fn relative(&self) -> f64 {
        median(self.rounds.iter().map(|round| round.relative).collect())
    }
}

/// Operations in a second of processor time and in one of the clock's, over about so many seconds, everything counted: what
/// scripts compare with other programs. Where the system does not tell processor time, and on several threads, the clock's
/// time counts for both.
pub(crate) fn plainly(workload: &mut Workload, seconds: f64) -> [f64; 2] {
    let length = Duration::from_secs_f64(seconds);
    workload.work.begin();
    let cycle = |work: &mut dyn Work| (0..workload.pieces).for_each(|piece| work.piece(piece));
    cycle(&mut *workload.work);
    let spent = || if workload.threads == 1 { processor_time() } else { None };
    let (before, began, mut cycles) = (spent(), Instant::now(), 0);
    while began.elapsed() < length {
        cycle(&mut *workload.work);
        cycles += 1;
    }
    let elapsed = began.elapsed().as_secs_f64();
    let taken = before.zip(spent()).map_or(elapsed, |(before, after)| after - before);
    [taken, elapsed].map(|seconds| (cycles * workload.operations) as f64 / seconds)
}

/// Seconds that this thread has run, to some milliseconds; Linux only.
pub(crate) fn processor_time() -> Option<f64> {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(told.split_whitespace().next()?.parse::<f64>().ok()? * 1e-9)
}

/// Seconds that something takes, drawn out to `handicap` times as long.
fn time(handicap: f64, what: impl FnOnce()) -> f64 {
    let began = Instant::now();
    what();
    if handicap > 1.0 {
        let until = began.elapsed().mul_f64(handicap);
        while began.elapsed() < until {
            std::hint::spin_loop();
        }
    }
    began.elapsed().as_secs_f64()
}
