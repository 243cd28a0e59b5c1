//! What networks read that join goals to what is seen at the input (TD3+HER; Andrychowicz 2017): rows of both.

use std::sync::Arc;

use super::{Encode, Encoder, goal_rows, rows};

/// How observations and goals are written side by side.
pub(crate) struct Inputs<O> {
    encoder: Arc<dyn Encoder<O> + Send + Sync>,
    /// Numbers a goal; 0 where none is read.
    goal: usize,
}

impl<O> Inputs<O> {
    pub(crate) fn new(encoder: Arc<dyn Encoder<O> + Send + Sync>, goal: usize) -> Self {
        Self { encoder, goal }
    }

    /// Numbers a row.
    pub(crate) fn width(&self) -> usize {
        self.encoder.width() + self.goal
    }

    /// Rows of observations, each followed by its goal; zeros for none.
    pub(crate) fn rows<'a, G: Encode + 'a>(
        &self,
        seen: impl ExactSizeIterator<Item = (&'a O, Option<&'a G>)> + Clone,
    ) -> Vec<f32>
    where
        O: 'a,
    {
        let observed = rows(&*self.encoder, seen.clone().map(|(observation, _)| observation));
        if self.goal == 0 {
            return observed;
        }
        let goals = goal_rows(self.goal, seen.map(|(_, goal)| goal));
        let both = observed.chunks_exact(self.encoder.width()).zip(goals.chunks_exact(self.goal));
        both.flat_map(|(s, goal)| s.iter().chain(goal)).copied().collect()
    }
}

impl<O> Clone for Inputs<O> {
    fn clone(&self) -> Self {
        Self { encoder: Arc::clone(&self.encoder), goal: self.goal }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::encode::Select;

    struct Bits([f32; 2]);

    impl Encode for Bits {
        fn width(&self) -> usize {
            2
        }

        fn write(&self, out: &mut [f32]) {
            out.copy_from_slice(&self.0);
        }
    }

    #[test]
    fn a_goal_stands_behind_what_is_seen_and_none_is_zeros() {
        let inputs: Inputs<Vec<f32>> = Inputs::new(Arc::new(Select::new(&[1])), 2);
        let (s, t, goal) = (vec![9.0, 1.0], vec![9.0, 2.0], Bits([7.0, 8.0]));
        let rows = inputs.rows([(&s, Some(&goal)), (&t, None)].into_iter());
        assert_eq!((inputs.width(), rows), (3, vec![1.0, 7.0, 8.0, 2.0, 0.0, 0.0]));
        let blind: Inputs<Vec<f32>> = Inputs::new(Arc::new(Select::new(&[1])), 0);
        assert_eq!(blind.rows([(&s, Some(&goal))].into_iter()), [1.0]);
    }
}
