//! Whole numbers as one-hot rows: what linear learners need of symbols.

use inroads_envs::{Space, Spec};

use super::Encoder;

/// Numbers a block may have: above that a table of it would hold states, not features.
const GREATEST_BLOCK: usize = 1 << 16;

/// Each dimension as a block of zeros with a one at its value, and dimensions that mean something only together (a row and a
/// column are a place) as one block with a one at their values' combination.
///
/// A linear function of such a row is a sum of tables, one a block. So which dimensions are joint says which of them may
/// interact; everything else adds up.
#[derive(Clone, Debug, PartialEq)]
pub struct OneHot {
    blocks: Vec<Block>,
    width: usize,
}

#[derive(Clone, Debug, PartialEq)]
struct Block {
    start: usize,
    digits: Vec<Digit>,
}

/// A dimension as a digit of a block's number.
#[derive(Clone, Debug, PartialEq)]
struct Digit {
    dim: usize,
    low: f32,
    values: usize,
}

/// Why observations cannot be one-hot.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OneHotError {
    /// Not a vector of numbers.
    #[error("only vectors of whole numbers can be one-hot; observe symbols")]
    NoVector,
    /// A dimension without bounds.
    #[error("dimension `{0}` has no bounds, so its values cannot be counted; scale it instead")]
    Unbounded(String),
    /// A joint dimension that there is not, or twice.
    #[error("dimension {0} cannot be joint: there is none of that number, or it is in a block already")]
    Joint(usize),
    /// A block that is too large.
    #[error("a block would have {0} numbers; join fewer dimensions")]
    Large(usize),
}

impl OneHot {
    /// The encoder that a domain's spec suggests: one joint block of where one is ([`Spec::place`]) and then of the other
    /// dimensions in their order, as long as it has at most `most` values; all that do not fit alone.
    ///
    /// That is a guess at what interacts, and the only knowledge of a domain in it is the order in which it names things.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn around(spec: &Spec, most: usize) -> Result<Self, OneHotError> {
        let others = (0..spec.observation.dimensions().len()).filter(|dim| !spec.place.contains(dim));
        let mut size = 1;
        let fits = |&dim: &usize| {
            let joined = values(&spec.observation, dim).map(|values| values.saturating_mul(size));
            joined.filter(|&joined| joined <= most).is_some_and(|joined| {
                size = joined;
                true
            })
        };
        let joint = spec.place.iter().copied().chain(others).take_while(fits).collect();
        Self::new(&spec.observation, &[joint])
    }

    /// The encoder for a space of whole numbers: each of `joint` lists dimensions that make one block; all others make one
    /// each.
    ///
    /// # Errors
    /// [`OneHotError`] names the dimension at fault.
    pub fn new(space: &Space, joint: &[Vec<usize>]) -> Result<Self, OneHotError> {
        let dimensions = space.dimensions();
        if dimensions.is_empty() {
            return Err(OneHotError::NoVector);
        }
        let mut taken = vec![false; dimensions.len()];
        for &dim in joint.iter().flatten() {
            match taken.get_mut(dim) {
                Some(taken) if !*taken => *taken = true,
                _ => return Err(OneHotError::Joint(dim)),
            }
        }
        let alone = (0..dimensions.len()).filter(|&dim| !taken[dim]).map(|dim| vec![dim]);
        let mut found = Self { blocks: Vec::new(), width: 0 };
        for dims in joint.iter().filter(|dims| !dims.is_empty()).cloned().chain(alone) {
            let digit = |dim: usize| {
                let unbounded = || OneHotError::Unbounded(dimensions[dim].name.to_string());
                let values = values(space, dim).ok_or_else(unbounded)?;
                Ok(Digit { dim, low: dimensions[dim].low, values })
            };
            let digits = dims.into_iter().map(digit).collect::<Result<Vec<_>, _>>()?;
            let size = digits.iter().fold(1, |size: usize, digit| size.saturating_mul(digit.values));
            if size > GREATEST_BLOCK {
                return Err(OneHotError::Large(size));
            }
            found.blocks.push(Block { start: found.width, digits });
            found.width += size;
        }
        Ok(found)
    }
}

/// Values of a whole number that a dimension has; none without bounds.
fn values(space: &Space, dim: usize) -> Option<usize> {
    let dimension = &space.dimensions()[dim];
    let range = dimension.high - dimension.low;
    range.is_finite().then(|| range.max(0.0).round() as usize + 1)
}

impl Encoder<Vec<f32>> for OneHot {
    fn width(&self) -> usize {
        self.width
    }

    /// Values beyond their bounds count as the bound.
    fn write(&self, observation: &Vec<f32>, out: &mut [f32]) {
        out.fill(0.0);
        for Block { start, digits } in &self.blocks {
            let number = digits.iter().fold(0, |number, Digit { dim, low, values }| {
                number * values + ((observation[*dim] - low).round().max(0.0) as usize).min(values - 1)
            });
            out[start + number] = 1.0;
        }
    }
}

/// A choice as a row: 1 in its own place.
#[derive(Clone, Copy, Debug)]
pub struct Choices(
    /// How many there are.
    pub usize,
);

impl Encoder<usize> for Choices {
    fn width(&self) -> usize {
        self.0
    }

    fn write(&self, choice: &usize, out: &mut [f32]) {
        out.fill(0.0);
        out[*choice] = 1.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::Dimension;

    fn space() -> Space {
        let dims = [("row", 0.0, 1.0), ("lamp", -1.0, 1.0), ("column", 0.0, 2.0)];
        Space::Box(dims.map(|(name, low, high)| Dimension::linear(name, "", low, high)).into())
    }

    fn row(encoder: &OneHot, observation: [f32; 3]) -> Vec<f32> {
        let mut out = vec![7.0; encoder.width()];
        encoder.write(&observation.to_vec(), &mut out);
        out
    }

    #[test]
    fn each_dimension_has_a_block() {
        let encoder = OneHot::new(&space(), &[]).unwrap();
        assert_eq!(row(&encoder, [1.0, 0.0, 2.0]), [0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
        // What is out of bounds counts as the bound.
        assert_eq!(row(&encoder, [-5.0, 9.0, 0.0]), [1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0]);
    }

    #[test]
    fn joint_dimensions_have_one_block_together_and_first() {
        let encoder = OneHot::new(&space(), &[vec![0, 2]]).unwrap();
        assert_eq!(row(&encoder, [1.0, -1.0, 1.0]), [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]);
    }

    #[test]
    fn a_spec_joins_the_place_and_what_fits_after_it() {
        let spec = Spec {
            observation: space(),
            place: vec![2],
            ..inroads_envs::registry::make("corridor-5").unwrap().spec().clone()
        };
        let around = |most| OneHot::around(&spec, most).unwrap();
        let joint = |dims: &[usize]| OneHot::new(&space(), &[dims.to_vec()]).unwrap();
        assert_eq!(around(18), joint(&[2, 0, 1]));
        assert_eq!(around(17), joint(&[2, 0]));
        assert_eq!(around(3), joint(&[2]));
        assert_eq!(around(2), joint(&[]));
    }

    #[test]
    fn what_cannot_be_one_hot_is_named() {
        assert_eq!(OneHot::new(&Space::Discrete(3), &[]), Err(OneHotError::NoVector));
        assert_eq!(OneHot::new(&space(), &[vec![0, 3]]), Err(OneHotError::Joint(3)));
        assert_eq!(OneHot::new(&space(), &[vec![0], vec![0]]), Err(OneHotError::Joint(0)));
        let angle = Space::Box([Dimension::angle("heading")].into());
        assert_eq!(OneHot::new(&angle, &[]), Err(OneHotError::Unbounded("heading".into())));
        let wide = Dimension::linear("x", "", 0.0, 999.0);
        let wide = Space::Box([wide.clone(), wide].into());
        assert_eq!(OneHot::new(&wide, &[vec![0, 1]]), Err(OneHotError::Large(1_000_000)));
    }
}
