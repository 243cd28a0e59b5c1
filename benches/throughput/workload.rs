//! A workload: the same work each time, in pieces of about a millisecond.
//!
//! A piece is shorter than the slice of time that an operating system gives to a process, so that among a few
//! repetitions of each there is one that nobody interrupted.

use std::time::{Duration, Instant};

/// Steps of a cycle, as a rule: some seconds of a body's life.
pub(crate) const CYCLE: usize = 128;
/// About as long as a piece is.
const PIECE: Duration = Duration::from_millis(1);

/// Something whose speed is of interest.
pub(crate) struct Workload {
    /// Its name, for good: baselines know it by this.
    pub(crate) name: String,
    /// Operations in a cycle: what "a second" counts.
    pub(crate) operations: usize,
    /// Pieces of a cycle.
    pub(crate) pieces: usize,
    /// Threads that it keeps busy: the calibration beside it does the same.
    pub(crate) threads: usize,
    /// What is done.
    pub(crate) work: Box<dyn Work>,
}

/// What a workload does.
pub(crate) trait Work {
    /// Goes to where a cycle begins; not timed.
    fn begin(&mut self) {}

    /// Does a piece. Pieces are asked for in order.
    fn piece(&mut self, piece: usize);
}

impl Workload {
    /// The same operation over and over.
    pub(crate) fn repeated(name: &str, mut operation: impl FnMut() + 'static) -> Self {
        let operations = in_a_piece(|_| operation());
        Self {
            name: name.to_owned(),
            operations,
            pieces: 1,
            threads: 1,
            work: Box::new(Repeated { operations, operation }),
        }
    }

    /// The same, where one time stands for so many operations on so many threads.
    pub(crate) fn at_once(self, operations: usize, threads: usize) -> Self {
        Self { operations: self.operations * operations, threads, ..self }
    }

    /// `cycle` steps, a power of two, from a start that is gone back to. `step` also gets the step's number in the
    /// cycle.
    pub(crate) fn steps<S: 'static>(
        name: &str,
        cycle: usize,
        mut state: S,
        begin: impl Fn(&mut S) + 'static,
        step: impl Fn(&mut S, usize) + 'static,
    ) -> Self {
        begin(&mut state);
        let each = in_a_piece(|at| step(&mut state, at)).min(cycle);
        Self {
            name: name.to_owned(),
            operations: cycle,
            pieces: cycle / each,
            threads: 1,
            work: Box::new(Steps { state, each, begin, step }),
        }
    }
}

struct Repeated<F> {
    operations: usize,
    operation: F,
}

impl<F: FnMut()> Work for Repeated<F> {
    fn piece(&mut self, _: usize) {
        (0..self.operations).for_each(|_| (self.operation)());
    }
}

struct Steps<S, B, F> {
    state: S,
    each: usize,
    begin: B,
    step: F,
}

impl<S, B: Fn(&mut S), F: Fn(&mut S, usize)> Work for Steps<S, B, F> {
    fn begin(&mut self) {
        (self.begin)(&mut self.state);
    }

    fn piece(&mut self, piece: usize) {
        (piece * self.each..(piece + 1) * self.each).for_each(|at| (self.step)(&mut self.state, at));
    }
}

/// How often something is done in about a [`PIECE`]: a power of two, so that it is the same in nearly every run.
fn in_a_piece(mut operation: impl FnMut(usize)) -> usize {
    operation(0);
    let (began, mut done) = (Instant::now(), 0);
    while began.elapsed() < 2 * PIECE {
        done += 1;
        operation(done);
    }
    (done / 2).max(1).next_power_of_two()
}
