//! Several copies of a domain, stepped together into one contiguous batch: of numbers, or of the bytes of pictures.
//!
//! What a copy does is a function of the seed, its number and its actions alone, so the batch is the same for
//! any number of threads. Threads exist with the feature `threads` only; without it all copies are stepped
//! one after the other.

mod batch;
mod row;
mod slot;

pub use batch::Batch;
pub use row::Row;

use self::slot::{Rows, Slot};
use crate::{Environment, Refused, Seed, Space, Spec};

/// Parts of the batch that a thread gets in the mean: more even out copies that take longer than others.
#[cfg(feature = "threads")]
const PARTS: usize = 4;

/// What happens to a copy whose episode has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AutoReset {
    /// Nothing: stepping it is refused until [`VectorEnvironment::restart`].
    Off,
    /// The step that ends an episode begins the next one: its observation is the new episode's first, and the
    /// ended one's last stands in [`Batch::last`].
    SameStep,
    /// The step after the one that ends an episode begins the next one: its action is ignored and it pays
    /// nothing. It is no step of any episode, and [`Batch::began`] says so.
    NextStep,
}

/// What cannot be done with several copies.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum VectorError {
    /// There are none.
    #[error("a vector environment needs at least one copy")]
    Empty,
    /// Two copies are not of the same domain.
    #[error("copy {copy} differs from copy 0 in what is seen or done; all copies must be of one domain")]
    Unlike {
        /// Which copy.
        copy: usize,
    },
    /// There are more or fewer actions than copies.
    #[error("{found} actions were given to {expected} copies; give one each")]
    Actions {
        /// Copies.
        expected: usize,
        /// Actions given.
        found: usize,
    },
    /// A copy refuses its action. No copy was stepped, unless the domain refused what its spec admits.
    #[error("copy {copy}: {refused}")]
    Refused {
        /// Which copy.
        copy: usize,
        /// What it says.
        refused: Refused,
    },
    /// There is no such copy.
    #[error("there is no copy {copy}: the copies are numbered from 0 to {}", count - 1)]
    NoCopy {
        /// Its number.
        copy: usize,
        /// How many there are.
        count: usize,
    },
    /// The threads could not be started.
    #[error("the threads could not be started: {0}")]
    Threads(String),
}

/// Actions that can be checked before anything is done.
pub trait Admissible {
    /// Checks the action against its space.
    ///
    /// # Errors
    /// [`Refused`] names what is wrong.
    fn admit(&self, space: &Space) -> Result<(), Refused>;
}

impl Admissible for Vec<f32> {
    fn admit(&self, space: &Space) -> Result<(), Refused> {
        space.admit(self)
    }
}

impl Admissible for usize {
    fn admit(&self, space: &Space) -> Result<(), Refused> {
        space.admit_choice(*self)
    }
}

/// A part of the batch, its copies, what they write into, and the actions from its first copy's on.
type Walk<'a, E> = (
    batch::Part<'a, Number<E>>,
    &'a mut [Slot<E>],
    &'a mut <E as Environment>::Observation,
    &'a [<E as Environment>::Action],
);

/// What an observation of the domain consists of.
type Number<E> = <<E as Environment>::Observation as Row>::Number;

/// Several copies of a domain.
///
/// ```
/// use inroads_envs::{corridor::Corridor, vector::{AutoReset, VectorEnvironment}};
/// let mut three = VectorEnvironment::new(vec![Corridor::new(2); 3], 0, AutoReset::SameStep)?;
/// let batch = three.step(&[0, 1, 1])?;
/// assert_eq!((batch.rewards(), batch.observation(1)), (&[-1.0, 0.0, 0.0][..], &[0.0][..]));
/// assert_eq!((batch.last(0), batch.last(1)), (None, Some(&[1.0][..])));
/// # Ok::<(), inroads_envs::vector::VectorError>(())
/// ```
pub struct VectorEnvironment<E: Environment<Observation: Row>> {
    slots: Vec<Slot<E>>,
    batch: Batch<Number<E>>,
    auto: AutoReset,
    /// What copies write their observations into, one a part.
    seen: Vec<E::Observation>,
    #[cfg(feature = "threads")]
    pool: Option<rayon::ThreadPool>,
}

impl<E> VectorEnvironment<E>
where
    E: Environment<Observation: Row, Action: Admissible + Sync> + Send,
{
    /// Takes copies of one domain and begins the first episode of each. Episode `k` of copy `i` has a seed
    /// that is a function of (`seed`, i, k).
    ///
    /// # Errors
    /// [`VectorError::Empty`] and [`VectorError::Unlike`].
    pub fn new(copies: Vec<E>, seed: u64, auto: AutoReset) -> Result<Self, VectorError> {
        let first = copies.first().ok_or(VectorError::Empty)?.spec().clone();
        let like = |spec: &Spec| (&spec.observation, &spec.action) == (&first.observation, &first.action);
        if let Some(copy) = copies.iter().position(|copy| !like(copy.spec())) {
            return Err(VectorError::Unlike { copy });
        }
        let batch = Batch::new(copies.len(), first.observation.len());
        let seeds = (0..).map(|copy| Seed(Seed(seed).number("copy", copy)));
        let slots = copies.into_iter().zip(seeds).map(|(env, seed)| Slot::new(env, seed)).collect();
        let mut made = Self {
            slots,
            batch,
            auto,
            seen: Vec::new(),
            #[cfg(feature = "threads")]
            pool: None,
        };
        made.each(&[], |slot, rows, _, seen| slot.begin(rows, seen));
        Ok(made)
    }

    /// Steps the copies on this many threads of their own from now on; 1 is the caller's thread.
    ///
    /// # Errors
    /// [`VectorError::Threads`] when the system does not give them.
    #[cfg(feature = "threads")]
    pub fn on_threads(mut self, threads: usize) -> Result<Self, VectorError> {
        let build = || rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        self.pool = match threads {
            0 | 1 => None,
            _ => Some(build().map_err(|why| VectorError::Threads(why.to_string()))?),
        };
        Ok(self)
    }

    /// What agents may know of every copy.
    pub fn spec(&self) -> &Spec {
        self.slots[0].env().spec()
    }

    /// Number of copies.
    pub fn count(&self) -> usize {
        self.slots.len()
    }

    /// A copy, to be looked at.
    pub fn copy(&self, copy: usize) -> Option<&E> {
        self.slots.get(copy).map(Slot::env)
    }

    /// What the last step, or the beginning, left.
    pub fn batch(&self) -> &Batch<Number<E>> {
        &self.batch
    }

    /// Carries out one action a copy.
    ///
    /// # Errors
    /// [`VectorError::Actions`], or [`VectorError::Refused`] with the first copy at fault.
    pub fn step(&mut self, actions: &[E::Action]) -> Result<&Batch<Number<E>>, VectorError> {
        let (expected, found) = (self.slots.len(), actions.len());
        if expected != found {
            return Err(VectorError::Actions { expected, found });
        }
        let auto = self.auto;
        for (copy, (slot, action)) in self.slots.iter().zip(actions).enumerate() {
            slot.admit(action, auto).map_err(|refused| VectorError::Refused { copy, refused })?;
        }
        self.each(actions, move |slot, rows, action, seen| {
            if let Some(action) = action {
                slot.step(action, auto, rows, seen);
            }
        });
        // A domain may still refuse for a reason of its own.
        match self.slots.iter_mut().enumerate().find_map(|(copy, slot)| Some((copy, slot.refusal()?))) {
            Some((copy, refused)) => Err(VectorError::Refused { copy, refused }),
            None => Ok(&self.batch),
        }
    }

    /// Begins a new episode in each of these copies, whether its old one is over or not. The others' rows
    /// stay.
    ///
    /// # Errors
    /// [`VectorError::NoCopy`]; nothing has changed then.
    pub fn restart(&mut self, copies: &[usize]) -> Result<&Batch<Number<E>>, VectorError> {
        let count = self.slots.len();
        if let Some(&copy) = copies.iter().find(|&&copy| copy >= count) {
            return Err(VectorError::NoCopy { copy, count });
        }
        for slot in copies {
            self.slots[*slot].call();
        }
        self.each(&[], |slot, rows, _, seen| {
            if slot.called() {
                slot.begin(rows, seen);
            }
        });
        Ok(&self.batch)
    }

    /// Does something with each copy and its rows of the batch, and with its action if there are any.
    fn each(
        &mut self,
        actions: &[E::Action],
        work: impl Fn(&mut Slot<E>, Rows<'_, Number<E>>, Option<&E::Action>, &mut E::Observation) + Sync,
    ) {
        let part = self.part();
        self.seen.resize_with(self.slots.len().div_ceil(part), E::Observation::default);
        let copies = self.slots.chunks_mut(part).zip(&mut self.seen);
        let parts = self.batch.parts(part).zip(copies).enumerate();
        let parts = parts.map(|(index, (rows, (slots, seen)))| {
            (rows, slots, seen, actions.get(index * part..).unwrap_or(&[]))
        });
        let walk = |(rows, slots, seen, actions): Walk<'_, E>| {
            for (index, (slot, rows)) in slots.iter_mut().zip(rows.rows()).enumerate() {
                work(slot, rows, actions.get(index), seen);
            }
        };
        #[cfg(feature = "threads")]
        if let Some(pool) = &self.pool {
            use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};
            let parts: Vec<_> = parts.collect();
            return pool.install(|| parts.into_par_iter().with_max_len(1).for_each(walk));
        }
        parts.for_each(walk);
    }

    /// Copies that one thread steps in one go.
    fn part(&self) -> usize {
        #[cfg(feature = "threads")]
        if let Some(pool) = &self.pool {
            return self.slots.len().div_ceil(PARTS * pool.current_num_threads());
        }
        self.slots.len()
    }
}
