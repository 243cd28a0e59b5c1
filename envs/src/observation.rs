//! What is seen, beside vectors of numbers: [`Frame`](crate::Frame)s, and observations with proto-goals.

/// Yes or no to each of a list of questions.
#[derive(
    Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
pub struct Bits {
    words: Vec<u64>,
    len: usize,
}

impl Bits {
    /// `len` times no.
    pub fn new(len: usize) -> Self {
        Self { words: vec![0; len.div_ceil(64)], len }
    }

    /// Becomes `len` times no, in the memory that it has.
    pub fn clear(&mut self, len: usize) {
        self.words.clear();
        self.words.resize(len.div_ceil(64), 0);
        self.len = len;
    }

    /// How many questions there are.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is no question.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The answer to a question.
    ///
    /// # Panics
    /// When there is no such question, as in [`set`](Self::set).
    pub fn get(&self, bit: usize) -> bool {
        assert!(bit < self.len, "there are {} bits, and none of number {bit}", self.len);
        self.words[bit / 64] >> (bit % 64) & 1 == 1
    }

    /// Whether all that is answered with yes in `others`, to the same questions, is answered with yes here.
    pub fn contains(&self, others: &Self) -> bool {
        self.words.iter().zip(&others.words).all(|(word, other)| other & !word == 0)
    }

    /// Answers yes.
    pub fn set(&mut self, bit: usize) {
        assert!(bit < self.len, "there are {} bits, and none of number {bit}", self.len);
        self.words[bit / 64] |= 1 << (bit % 64);
    }

    /// The questions answered with yes, in ascending order.
    pub fn ones(&self) -> impl Iterator<Item = usize> {
        self.words.iter().enumerate().flat_map(|(at, &word)| {
            let rest = |&word: &u64| Some(word & (word - 1)).filter(|&rest| rest != 0);
            std::iter::successors(Some(word).filter(|&word| word != 0), rest)
                .map(move |word| 64 * at + word.trailing_zeros() as usize)
        })
    }
}

/// An observation, and which proto-goals hold in the state that it is of (thesis section 8.1).
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Annotated<O> {
    /// What is seen.
    pub seen: O,
    /// What holds.
    pub bits: Bits,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ones_are_what_was_set() {
        let mut bits = Bits::new(130);
        [0, 63, 64, 129].into_iter().for_each(|bit| bits.set(bit));
        assert_eq!(bits.ones().collect::<Vec<_>>(), [0, 63, 64, 129]);
        assert!(bits.get(63) && !bits.get(62));
        let mut few = Bits::new(130);
        [0, 129].into_iter().for_each(|bit| few.set(bit));
        assert!(bits.contains(&few) && bits.contains(&bits) && !few.contains(&bits));
        assert!(few.contains(&Bits::new(130)));
        bits.clear(3);
        assert_eq!((bits.len(), bits.ones().count()), (3, 0));
    }
}
