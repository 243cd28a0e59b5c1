//! Transitions as rows of numbers.

/// A batch of transitions, each a row of numbers before and one after.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    width: usize,
    before: Vec<f32>,
    after: Vec<f32>,
    actions: Vec<usize>,
    terminal: Vec<bool>,
}

impl Rows {
    /// No rows yet, of that many numbers each.
    pub fn new(width: usize) -> Self {
        Self { width, ..Self::default() }
    }

    /// Adds a transition. `terminal`: nothing comes after it; a truncation is not this.
    ///
    /// # Panics
    /// When a row has another width.
    pub fn push(&mut self, before: &[f32], action: usize, after: &[f32], terminal: bool) {
        assert_eq!((before.len(), after.len()), (self.width, self.width), "numbers in a row");
        self.before.extend_from_slice(before);
        self.after.extend_from_slice(after);
        self.actions.push(action);
        self.terminal.push(terminal);
    }

    /// Numbers in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// How many transitions there are.
    pub fn len(&self) -> usize {
        self.actions.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.actions.is_empty()
    }

    /// The row before a transition.
    pub fn before(&self, at: usize) -> &[f32] {
        &self.before[at * self.width..][..self.width]
    }

    /// The row after it.
    pub fn after(&self, at: usize) -> &[f32] {
        &self.after[at * self.width..][..self.width]
    }

    /// What was done.
    pub fn action(&self, at: usize) -> usize {
        self.actions[at]
    }

    /// Whether it ended there for good.
    pub fn terminal(&self, at: usize) -> bool {
        self.terminal[at]
    }

    /// Transitions of which no two are equal, sorted by action, and for each transition the place of its like among them.
    pub(super) fn distinct(&self) -> (Vec<usize>, Vec<usize>) {
        let numbers = |at: usize| self.before(at).iter().chain(self.after(at)).map(|x| x.to_bits());
        let compare = |a: usize, b: usize| {
            let key = |at: usize| (self.actions[at], self.terminal[at]);
            key(a).cmp(&key(b)).then_with(|| numbers(a).cmp(numbers(b)))
        };
        let mut order: Vec<usize> = (0..self.len()).collect();
        order.sort_by(|&a, &b| compare(a, b));
        let (mut distinct, mut places) = (Vec::new(), vec![0; self.len()]);
        for at in order {
            if distinct.last().is_none_or(|&last| compare(last, at).is_ne()) {
                distinct.push(at);
            }
            places[at] = distinct.len() - 1;
        }
        (distinct, places)
    }

    /// The same transitions with every row replaced by one of that width, which `write` fills.
    pub(super) fn map(&self, width: usize, mut write: impl FnMut(&[f32], &mut [f32])) -> Self {
        let mut replace = |numbers: &[f32]| {
            let mut out = vec![0.0; width * self.len()];
            for at in 0..self.len() {
                write(&numbers[at * self.width..][..self.width], &mut out[at * width..][..width]);
            }
            out
        };
        let (before, after) = (replace(&self.before), replace(&self.after));
        Self { width, before, after, actions: self.actions.clone(), terminal: self.terminal.clone() }
    }
}
