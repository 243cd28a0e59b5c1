//! Axis-parallel rectangles on the floor.

/// A closed axis-parallel rectangle: its border belongs to it. Metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// The corner with the least coordinates, (x, y).
    pub low: [f64; 2],
    /// The corner with the greatest coordinates, (x, y).
    pub high: [f64; 2],
}

impl Rectangle {
    /// Whether the point lies in the rectangle, border included. Never true of NaN.
    pub fn contains(&self, at: [f64; 2]) -> bool {
        (0..2).all(|axis| self.low[axis] <= at[axis] && at[axis] <= self.high[axis])
    }

    /// Whether the point lies in the rectangle and not on its border. Never true of NaN.
    pub fn surrounds(&self, at: [f64; 2]) -> bool {
        (0..2).all(|axis| self.low[axis] < at[axis] && at[axis] < self.high[axis])
    }

    /// Whether any point of the segment lies in the rectangle (Liang and Barsky 1984).
    pub fn meets(&self, from: [f64; 2], to: [f64; 2]) -> bool {
        // The division below may miss an end that lies just on the border.
        if self.contains(from) || self.contains(to) {
            return true;
        }
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for axis in 0..2 {
            let (start, travel) = (from[axis], to[axis] - from[axis]);
            if travel == 0.0 {
                if start < self.low[axis] || start > self.high[axis] {
                    return false;
                }
                continue;
            }
            let (a, b) = ((self.low[axis] - start) / travel, (self.high[axis] - start) / travel);
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        enter <= leave
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Rectangle = Rectangle { low: [0.0, 0.0], high: [1.0, 1.0] };

    #[test]
    fn the_border_belongs_to_the_rectangle() {
        assert!(UNIT.contains([1.0, 0.5]) && UNIT.contains([0.0, 0.0]));
        assert!(!UNIT.surrounds([1.0, 0.5]) && UNIT.surrounds([0.5, 0.5]));
        assert!(!UNIT.contains([f64::NAN, 0.5]) && !UNIT.surrounds([0.5, f64::NAN]));
    }

    #[test]
    fn a_segment_meets_it_when_any_point_does() {
        assert!(UNIT.meets([-1.0, 0.5], [2.0, 0.5]), "right through");
        assert!(UNIT.meets([-0.5, 0.5], [0.5, 1.5]), "touching a corner");
        assert!(UNIT.meets([0.5, 0.5], [0.6, 0.5]), "inside");
        assert!(UNIT.meets([1.0, -3.0], [1.0, 3.0]), "along the border");
        assert!(!UNIT.meets([-0.6, 0.5], [0.5, 1.6]), "past a corner");
        assert!(!UNIT.meets([-2.0, 0.5], [-1.0, 0.5]), "too short");
        assert!(!UNIT.meets([1.1, -3.0], [1.1, 3.0]), "beside");
    }
}
