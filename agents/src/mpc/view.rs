//! In which coordinates a model of the dynamics reads a state and predicts its change.
//!
//! Nagabandi 2018 reads states as they are and predicts s′ − s; that is [`Plain`], with which dimensions can be left out of
//! what is read: where nothing depends on the place, a model that does not read it need not learn that. [`FreeBody`] goes
//! on in that: nothing depends on where a body on a floor faces either, so all is read and predicted in its own frame.
//! There a turn is composed with the attitude instead of added to its quaternion, which so stays one.

use std::f32::consts::TAU;

/// Reads states and applies changes, row by row.
pub trait View: Send + Sync {
    /// Numbers a state.
    fn width(&self) -> usize;

    /// Numbers that are read of a state.
    fn inputs(&self) -> usize;

    /// Numbers of a change.
    fn changes(&self) -> usize;

    /// Appends what is read of a state.
    fn read(&self, s: &[f32], out: &mut Vec<f32>);

    /// Appends what has changed between two states.
    fn change(&self, before: &[f32], after: &[f32], out: &mut Vec<f32>);

    /// Appends the state that comes of this change: the inverse of [`change`](Self::change).
    fn apply(&self, s: &[f32], change: &[f32], out: &mut Vec<f32>);
}

/// States as they are, some dimensions of which are not read; changes are differences of all dimensions, unread ones too.
///
/// An angle is read as its sine and cosine, and its change is the shorter way round. A quaternion is four plain numbers
/// here, which cease to be of length 1 when changes are added; see [`FreeBody`] for bodies.
#[derive(Clone, Debug)]
pub struct Plain {
    angles: Vec<bool>,
    read: Vec<usize>,
    inputs: usize,
}

impl Plain {
    /// States of so many numbers, `true` being an angle in radians; those at `unread` are not read.
    pub fn new(angles: &[bool], unread: &[usize]) -> Self {
        let read: Vec<_> = (0..angles.len()).filter(|dim| !unread.contains(dim)).collect();
        let inputs = read.iter().map(|&dim| 1 + usize::from(angles[dim])).sum();
        Self { angles: angles.to_vec(), read, inputs }
    }
}

impl View for Plain {
    fn width(&self) -> usize {
        self.angles.len()
    }

    fn inputs(&self) -> usize {
        self.inputs
    }

    fn changes(&self) -> usize {
        self.width()
    }

    fn read(&self, s: &[f32], out: &mut Vec<f32>) {
        for &dim in &self.read {
            match self.angles[dim] {
                true => out.extend([s[dim].sin(), s[dim].cos()]),
                false => out.push(s[dim]),
            }
        }
    }

    fn change(&self, before: &[f32], after: &[f32], out: &mut Vec<f32>) {
        for ((before, after), angle) in before.iter().zip(after).zip(&self.angles) {
            let change = after - before;
            let rounds = if *angle { (change / TAU).round() } else { 0.0 };
            out.push(change - rounds * TAU);
        }
    }

    fn apply(&self, s: &[f32], change: &[f32], out: &mut Vec<f32>) {
        out.extend(s.iter().zip(change).map(|(s, change)| s + change));
    }
}

/// A body that moves freely over a floor, in its own frame.
///
/// Its state begins like MuJoCo's `qpos` (place x, y, z and quaternion w, x, y, z), and has the root's velocity in the
/// world's frame from number `velocity` on; everything else (joints, the angular velocity in its own frame, …) has no
/// direction in the world. Read are height, the direction of "up", the velocity, both in the body's frame, and
/// everything else; neither place nor where it faces.
#[derive(Clone, Copy, Debug)]
pub struct FreeBody {
    width: usize,
    velocity: usize,
}

/// Where the quaternion begins, behind x, y and z.
const TURN: usize = 3;
/// Where everything else begins.
const REST: usize = 7;

impl FreeBody {
    /// States of `width` numbers with the velocity from number `velocity` on.
    ///
    /// # Panics
    /// When the velocity does not lie behind the quaternion and within the state.
    pub fn new(width: usize, velocity: usize) -> Self {
        assert!((REST..=width.saturating_sub(3)).contains(&velocity), "a velocity at {velocity} of {width}");
        Self { width, velocity }
    }

    /// Everything that has no direction in the world.
    fn rest(self, s: &[f32]) -> impl Iterator<Item = f32> {
        s[REST..self.velocity].iter().chain(&s[self.velocity + 3..]).copied()
    }

    fn moves(self, s: &[f32]) -> [f32; 3] {
        vector(s, self.velocity)
    }
}

impl View for FreeBody {
    fn width(&self) -> usize {
        self.width
    }

    /// Less x, y and one of the quaternion's numbers.
    fn inputs(&self) -> usize {
        self.width - 3
    }

    /// A turn has three numbers, a quaternion four.
    fn changes(&self) -> usize {
        self.width - 1
    }

    fn read(&self, s: &[f32], out: &mut Vec<f32>) {
        let inverse = conjugate(attitude(s));
        out.push(s[2]);
        out.extend(rotated(inverse, [0.0, 0.0, 1.0]));
        out.extend(rotated(inverse, self.moves(s)));
        out.extend(self.rest(s));
    }

    fn change(&self, before: &[f32], after: &[f32], out: &mut Vec<f32>) {
        let inverse = conjugate(attitude(before));
        out.extend(rotated(inverse, less(vector(after, 0), vector(before, 0))));
        // q and −q are the same attitude; the turn is the shorter one.
        let [w, x, y, z] = product(inverse, attitude(after));
        out.extend([x, y, z].map(|part| if w < 0.0 { -part } else { part }));
        out.extend(rotated(inverse, less(self.moves(after), self.moves(before))));
        out.extend(self.rest(after).zip(self.rest(before)).map(|(after, before)| after - before));
    }

    fn apply(&self, s: &[f32], change: &[f32], out: &mut Vec<f32>) {
        let now = attitude(s);
        let at = rotated(now, vector(change, 0));
        out.extend((0..3).map(|i| s[i] + at[i]));
        let turn = vector(change, 3);
        let square = turn.iter().map(|part| part * part).sum::<f32>();
        let next = product(now, unit([(1.0 - square).max(0.0).sqrt(), turn[0], turn[1], turn[2]]));
        // Nothing distinguishes the two signs but that they do not jump.
        let sign = if now.iter().zip(&next).map(|(a, b)| a * b).sum::<f32>() < 0.0 { -1.0 } else { 1.0 };
        out.extend(next.map(|part| sign * part));
        let velocity = rotated(now, vector(change, 6));
        let joints = self.velocity - REST;
        out.extend(s[REST..self.velocity].iter().zip(&change[9..]).map(|(s, change)| s + change));
        out.extend((0..3).map(|i| s[self.velocity + i] + velocity[i]));
        out.extend(s[self.velocity + 3..].iter().zip(&change[9 + joints..]).map(|(s, change)| s + change));
    }
}

/// w, x, y, z.
type Quaternion = [f32; 4];

fn attitude(s: &[f32]) -> Quaternion {
    unit(std::array::from_fn(|i| s[TURN + i]))
}

fn vector(row: &[f32], from: usize) -> [f32; 3] {
    std::array::from_fn(|i| row[from + i])
}

fn less(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Of length 1; no turn where it has none.
fn unit(q: Quaternion) -> Quaternion {
    let length = q.iter().map(|part| part * part).sum::<f32>().sqrt();
    if length > f32::EPSILON { q.map(|part| part / length) } else { [1.0, 0.0, 0.0, 0.0] }
}

fn conjugate([w, x, y, z]: Quaternion) -> Quaternion {
    [w, -x, -y, -z]
}

fn product([a, b, c, d]: Quaternion, [e, f, g, h]: Quaternion) -> Quaternion {
    [
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    ]
}

/// v turned by a unit quaternion.
fn rotated(q: Quaternion, [x, y, z]: [f32; 3]) -> [f32; 3] {
    let [_, x, y, z] = product(product(q, [0.0, x, y, z]), conjugate(q));
    [x, y, z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::{Rng, Seed};
    use rand::RngExt;

    /// A body with two joints: 9 positions and 8 velocities.
    fn drawn(rng: &mut Rng) -> Vec<f32> {
        let mut s: Vec<f32> = (0..17).map(|_| rng.random_range(-1.0..1.0)).collect();
        let q = attitude(&s);
        s[TURN..REST].copy_from_slice(&q);
        s
    }

    fn called(call: impl FnOnce(&mut Vec<f32>)) -> Vec<f32> {
        let mut out = Vec::new();
        call(&mut out);
        out
    }

    #[test]
    fn applying_a_change_undoes_taking_it() {
        let mut rng = Seed(1).stream("states", 0);
        let views: [&dyn View; 2] = [&Plain::new(&[false; 17], &[0, 1]), &FreeBody::new(17, 9)];
        for view in views {
            for _ in 0..50 {
                let (before, after) = (drawn(&mut rng), drawn(&mut rng));
                let change = called(|out| view.change(&before, &after, out));
                assert_eq!(change.len(), view.changes());
                assert_eq!(called(|out| view.read(&before, out)).len(), view.inputs());
                let again = called(|out| view.apply(&before, &change, out));
                // The quaternion's sign is free.
                let dot: f32 = (TURN..REST).map(|i| again[i] * after[i]).sum();
                for (i, (a, b)) in again.iter().zip(&after).enumerate() {
                    let b = if (TURN..REST).contains(&i) { b * dot.signum() } else { *b };
                    assert!((a - b).abs() < 1e-5, "{i}: {a} {b}");
                }
            }
        }
    }

    #[test]
    fn a_body_elsewhere_that_faces_elsewhere_reads_and_changes_alike() {
        let mut rng = Seed(2).stream("states", 0);
        let view = FreeBody::new(17, 9);
        let (before, after) = (drawn(&mut rng), drawn(&mut rng));
        let yaw = [0.6_f32, 0.0, 0.0, 0.8];
        let moved = |s: &[f32]| {
            let mut t = s.to_vec();
            let at = rotated(yaw, vector(s, 0));
            t[..3].copy_from_slice(&[at[0] + 7.0, at[1] - 3.0, at[2]]);
            t[TURN..REST].copy_from_slice(&product(yaw, attitude(s)));
            t[9..12].copy_from_slice(&rotated(yaw, vector(s, 9)));
            t
        };
        let near = |a: Vec<f32>, b: Vec<f32>| a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-5);
        let read = |s: &[f32]| called(|out| view.read(s, out));
        assert!(near(read(&before), read(&moved(&before))));
        let change = |a: &[f32], b: &[f32]| called(|out| view.change(a, b, out));
        assert!(near(change(&before, &after), change(&moved(&before), &moved(&after))));
    }

    #[test]
    fn what_is_not_read_is_predicted_all_the_same_and_angles_go_the_shorter_way() {
        let view = Plain::new(&[false, false, true], &[0]);
        assert_eq!(called(|out| view.read(&[1.0, 2.0, 0.0], out)), [2.0, 0.0, 1.0]);
        let change = called(|out| view.change(&[1.0, 2.0, 3.0], &[1.5, 2.0, -3.0], out));
        assert_eq!(change[..2], [0.5, 0.0]);
        assert!((change[2] - (TAU - 6.0)).abs() < 1e-6, "{change:?}");
    }
}
