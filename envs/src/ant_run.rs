//! The ant paid for running along the x axis, as Gymnasium's Ant-v5: for learners of movement alone.

use inroads_sim::{
    rigid::{Configuration, Rectangle, StateError, Vector, ant},
    view::Scene,
};

use crate::maze::{Body, MazeError, Robot};
use crate::registry::{AnyEnvironment, Entry, Make};
use crate::{Drawing, End, Environment, Refused, Render, Seed, Snapshot, Space, Spec, Step, TimeLimit};

pub(crate) const ENTRIES: &[Entry] = &[Entry {
    name: NAME,
    about: ABOUT,
    make: Make::Bodies {
        make: || {
            let run = AntRun::new().expect("our ant can be simulated");
            AnyEnvironment::Vectors(Box::new(TimeLimit::new(run, LIMIT)))
        },
        picture: || None,
    },
}];

const NAME: &str = "ant";
const ABOUT: &str =
    "an ant is paid for running forward and for standing, and pays for effort; Gymnasium's Ant-v5";
/// Steps an episode of the registry (Ant-v5).
const LIMIT: u32 = 1000;
/// What a step pays that ends upright (Ant-v5).
const HEALTHY: f32 = 1.0;
/// Heights of the torso's middle that are upright, metres (Ant-v5).
const UPRIGHT: std::ops::RangeInclusive<f32> = 0.2..=1.0;
/// Price of the sum of the actions' squares (Ant-v5).
const EFFORT: f32 = 0.5;
/// Numbers that the body observes and this task does not: x and y.
const PLACE: usize = 2;

/// The ant on an open floor: a step pays its speed along x in metres a second, 1 for ending upright, and −½ Σ a².
///
/// Torques (150 N m), control step (0.05 s), start, rewards and end are Ant-v5's with its defaults, but for two: there is no
/// price of contact forces (5e-4 times the sum of their squares, each clipped to ±1, there), and they are not observed. So it
/// observes the 27 numbers of Ant-v4: positions without x and y, then velocities, as in the [mazes](crate::maze).
pub struct AntRun {
    spec: Spec,
    body: Body,
    over: bool,
    fault: Option<String>,
}

impl AntRun {
    /// An ant that waits for its first episode.
    ///
    /// # Errors
    /// [`MazeError::Body`] when the model cannot be simulated.
    pub fn new() -> Result<Self, MazeError> {
        let preset = ant::GYMNASIUM;
        let body = Body::on_open_floor(&ant::model(preset.gear), preset.physics, preset.floor)?;
        let everywhere = Rectangle { low: [f64::NEG_INFINITY; 2], high: [f64::INFINITY; 2] };
        let seen = body.observation(everywhere).into_iter().skip(PLACE).collect();
        let spec = Spec {
            name: NAME,
            about: ABOUT,
            observation: Space::Box(seen),
            action: Space::Box(body.action().into()),
            goal: None,
            place: Vec::new(),
            time_limit: None,
            // No end is a success.
            success_reward: f32::INFINITY,
        };
        Ok(Self { spec, body, over: true, fault: None })
    }

    /// Positions and velocities now, x and y included.
    pub fn configuration(&self) -> &Configuration {
        self.body.configuration()
    }

    /// Begins an episode in a given state instead of one that a seed names.
    ///
    /// # Errors
    /// [`StateError`] when numbers are missing or not finite.
    pub fn restore(&mut self, to: &Configuration) -> Result<(), StateError> {
        self.body.restore(to)?;
        (self.over, self.fault) = (false, None);
        Ok(())
    }

    /// What a step with this effort pays that went so far along x, metres, and whether the ant has fallen.
    fn paid(&self, action: &[f32], metres: f32) -> (f32, bool) {
        let upright = UPRIGHT.contains(&self.body.configuration().q[2]);
        let effort: f32 = action.iter().map(|a| a * a).sum();
        let healthy = if upright { HEALTHY } else { 0.0 };
        (metres / ant::GYMNASIUM.physics.control_step + healthy - EFFORT * effort, !upright)
    }
}

impl Environment for AntRun {
    type Observation = Vec<f32>;
    type Action = Vec<f32>;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        let mut rng = Seed(seed).stream("start", 0);
        self.fault = self.body.begin([0.0, 0.0], Some(&mut rng)).err();
        self.over = self.fault.is_some();
    }

    fn step(&mut self, action: &Vec<f32>) -> Result<Step, Refused> {
        if self.over {
            return Err(Refused::Over);
        }
        self.spec.action.admit(action)?;
        let from = self.body.at()[0];
        self.fault = self.body.act(action).err();
        let (reward, fallen) = self.paid(action, self.body.at()[0] - from);
        // Where the simulator gave up nobody knows where the step would have led: it pays what staying would have paid.
        let end = match &self.fault {
            Some(_) => Some(End::Truncated),
            None => fallen.then_some(End::Terminated),
        };
        self.over = end.is_some();
        Ok(Step { reward, end })
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        let Configuration { q, v } = self.body.configuration();
        out.clear();
        out.extend_from_slice(&q[PLACE..]);
        out.extend_from_slice(v);
    }

    fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }
}

/// The state of an [`AntRun`], for [`Snapshot`].
#[derive(Clone)]
pub struct AntRunState {
    body: <Body as Robot>::State,
    over: bool,
    fault: Option<String>,
}

impl Snapshot for AntRun {
    type State = AntRunState;

    fn save(&self) -> AntRunState {
        AntRunState { body: self.body.save(), over: self.over, fault: self.fault.clone() }
    }

    fn load(&mut self, state: &AntRunState) {
        self.body.load(&state.body);
        (self.over, self.fault) = (state.over, state.fault.clone());
    }
}

impl Render for AntRun {
    fn drawing(&self) -> Drawing {
        let [x, y] = self.body.at();
        let about = |at: f32| [f64::from(at) - 3.0, f64::from(at) + 3.0];
        let ([left, right], [low, high]) = (about(x), about(y));
        let mut solids = Vec::new();
        self.body.draw(&mut solids);
        Drawing::Bodies(Scene {
            solids,
            marks: Vec::new(),
            trail: Vec::new(),
            bounds: Rectangle { low: [left, low], high: [right, high] },
            focus: Vector::new(x, y, 0.0),
            distance: 6.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(env: &mut AntRun) -> Vec<f32> {
        let mut seen = Vec::new();
        env.observe(&mut seen);
        seen
    }

    #[test]
    fn a_step_pays_speed_and_standing_and_costs_effort() {
        let mut env = AntRun::new().unwrap();
        let mut state = env.configuration().clone();
        // Bent ankles, within their range: nothing throws it about.
        for (ankle, bend) in [(8, 1.0), (10, -1.0), (12, -1.0), (14, 1.0)] {
            state.q[ankle] = bend;
        }
        state.v[0] = 2.0;
        env.restore(&state).unwrap();
        let action = vec![0.5, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0];
        let x = env.configuration().q[0];
        let Step { reward, end } = env.step(&action).unwrap();
        let speed = (env.configuration().q[0] - x) / 0.05;
        assert!(speed > 1.5, "{speed}");
        assert!((reward - (speed + 1.0 - 0.5 * 1.25)).abs() < 1e-5, "{reward} {speed}");
        assert_eq!(end, None);
    }

    #[test]
    fn it_sees_neither_x_nor_y_and_is_no_worse_off_for_being_elsewhere() {
        let mut env = AntRun::new().unwrap();
        let names: Vec<_> = env.spec().observation.dimensions().iter().map(|d| d.name.clone()).collect();
        assert_eq!((names.len(), env.spec().action.len()), (27, 8));
        assert_eq!(names[..6], ["z", "qw", "qx", "qy", "qz", "shin 1"]);
        assert_eq!(names[13], "vx");
        env.reset(3);
        let Configuration { q, v } = env.configuration().clone();
        assert_eq!(seen(&mut env), [&q[2..], &v[..]].concat());
    }

    #[test]
    fn who_falls_or_jumps_too_high_is_out() {
        for (height, upright) in [(0.19, false), (0.75, true), (1.6, false)] {
            let mut env = AntRun::new().unwrap();
            let mut state = env.configuration().clone();
            (state.q[2], state.v[2]) = (height, if upright { 0.0 } else { -0.5 });
            if height < 0.2 {
                // On its back, with its legs in the air, and so nothing under it but the torso.
                (state.q[3], state.q[4], state.q[2]) = (0.0, 1.0, 0.3);
                state.v[2] = -6.0;
            }
            env.restore(&state).unwrap();
            let Step { reward, end } = env.step(&vec![0.0; 8]).unwrap();
            assert_eq!(end.is_none(), upright, "{height}: {:?}", env.configuration().q);
            assert_eq!(reward > 0.5, upright, "who is out is not paid for standing: {reward}");
            assert_eq!(env.step(&vec![0.0; 8]).is_err(), !upright);
        }
    }

    #[test]
    fn a_state_that_was_kept_goes_on_to_the_same_bits() {
        let mut env = AntRun::new().unwrap();
        env.reset(1);
        let walk = |env: &mut AntRun| {
            (0..20).map(|i| env.step(&vec![(i as f32).sin(); 8]).unwrap().reward).collect::<Vec<_>>()
        };
        walk(&mut env);
        let kept = env.save();
        let (first, at) = (walk(&mut env), seen(&mut env));
        env.load(&kept);
        assert_eq!((walk(&mut env), seen(&mut env)), (first, at));
    }
}
