//! Pieces of pictures that were made before.

/// Pieces under keys, as many as fit into a fixed amount of memory. A new one takes the place of an old one; what it
/// finds is exactly what was put in.
#[derive(Clone, Debug)]
pub(super) struct Cache {
    /// Bytes that a piece may have.
    piece: usize,
    /// The keys of four pieces that share a place; 0 for none.
    keys: Vec<[u64; WAYS]>,
    /// Which of the four goes next.
    next: Vec<u8>,
    bytes: Vec<u8>,
}

const WAYS: usize = 4;

impl Cache {
    /// For pieces of at most so many bytes, in this much memory.
    pub(super) fn new(piece: usize, memory: usize) -> Self {
        let places = memory / (WAYS * (piece + size_of::<u64>()) + 1);
        Self {
            piece,
            keys: vec![[0; WAYS]; places],
            next: vec![0; places],
            bytes: vec![0; places * WAYS * piece],
        }
    }

    /// Where a key's piece would be: a fixed mixture of its bits.
    fn place(&self, key: u64) -> usize {
        let mixed = (key ^ (key >> 32)).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32;
        ((mixed * self.keys.len() as u64) >> 32) as usize
    }

    /// The piece of a key that is not 0.
    pub(super) fn find(&self, key: u64) -> Option<&[u8]> {
        let place = self.place(key);
        let keys = self.keys.get(place)?;
        // Without a branch for each: which of them it is cannot be foreseen.
        let way =
            usize::from(keys[1] == key) + 2 * usize::from(keys[2] == key) + 3 * usize::from(keys[3] == key);
        (keys[way] == key).then(|| &self.bytes[(place * WAYS + way) * self.piece..][..self.piece])
    }

    /// Room for a key's piece, if there is any.
    pub(super) fn insert(&mut self, key: u64) -> Option<&mut [u8]> {
        let place = self.place(key);
        let keys = self.keys.get_mut(place)?;
        let way = usize::from(self.next[place]);
        self.next[place] = ((way + 1) % WAYS) as u8;
        keys[way] = key;
        Some(&mut self.bytes[(place * WAYS + way) * self.piece..][..self.piece])
    }
}
