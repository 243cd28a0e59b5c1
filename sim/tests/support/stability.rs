//! Random play in mazes, and what must not happen meanwhile.

use inroads_sim::rigid::{Articulated, CellMap, Contact, Party, PhysicsFault};

#[path = "numbers.rs"]
mod numbers;

pub(crate) use numbers::Numbers;

/// The mazes of the thesis with the sides of their cells, metres (D4RL; DSC++'s four rooms).
pub(crate) const MAZES: [(&str, &str, f64); 4] = [
    ("u", "11111\n1r001\n11101\n1g001\n11111", 4.0),
    ("medium", "11111111\n1r011001\n10010001\n11000111\n10010001\n10100101\n100010g1\n11111111", 4.0),
    (
        "large",
        "111111111111\n1r0001000001\n101101010101\n100000010001\n101111011101\n100101000001\n110101010111\n\
         1001000100g1\n111111111111",
        4.0,
    ),
    (
        "four-rooms",
        "111111111\n100010001\n10r000001\n100010001\n110111011\n100010001\n100000g01\n100010001\n111111111",
        3.0,
    ),
];

/// Control steps of an episode.
const EPISODE: usize = 250;
/// No leg of the ant at the start reaches farther from its middle, metres.
const REACH: f64 = 1.05;

/// What happened.
#[derive(Debug, Default)]
pub(crate) struct Report {
    /// Control steps with random actions.
    pub(crate) steps: usize,
    /// Steps that the engine gave up in.
    pub(crate) faults: Vec<PhysicsFault>,
    /// Steps after which the torso's middle was in a wall or outside the map.
    pub(crate) outside: usize,
    /// How deep any solid ever was in a wall, metres.
    pub(crate) deepest: f32,
    /// Steps after which a solid was deeper in a wall than 2 cm.
    pub(crate) deep: usize,
    /// Steps in which a wall pushed the ant.
    pub(crate) touching: usize,
    /// Greatest height of the torso, metres.
    pub(crate) highest: f32,
    /// Greatest speed of the torso, m/s.
    pub(crate) fastest: f32,
    /// Share of the steps in which it lay on its back.
    pub(crate) upside_down: f64,
    /// Episodes that ended on its back, and all.
    pub(crate) ended_upside_down: [usize; 2],
    /// Greatest energy that it gained within 100 steps without actuation, joules.
    pub(crate) gained: f32,
    /// Greatest energy, joules.
    pub(crate) energy: f32,
}

impl Report {
    /// Nothing failed, nobody left, nothing was deep in a wall, no energy came from nowhere.
    pub(crate) fn holds(&self) -> bool {
        self.faults.is_empty() && self.outside == 0 && self.deepest <= 0.02 && self.gained < 1.0
    }
}

/// Plays for so many steps, in episodes.
pub(crate) fn play(ant: &mut Articulated, map: &CellMap, steps: usize, seed: u64) -> Report {
    let (mut report, mut numbers) = (Report::default(), Numbers::new(seed));
    let cells: Vec<_> = map.free_cells().collect();
    let mut down = 0;
    while report.steps < steps {
        let [x, y] = cells[((numbers.uniform() + 1.0) / 2.0 * cells.len() as f32) as usize];
        let mut start = ant.zero();
        let free = (map.scale() / 2.0 - REACH).max(0.0);
        let [x, y] = [x, y].map(|middle| (middle + free * f64::from(numbers.uniform())) as f32);
        (start.q[0], start.q[1]) = (x, y);
        start.q[2..].iter_mut().for_each(|q| *q += 0.1 * numbers.uniform());
        start.v.iter_mut().for_each(|v| *v += 0.1 * numbers.normal());
        ant.restore(&start).expect("a free place");
        for _ in 0..EPISODE {
            let action: [f32; 8] = std::array::from_fn(|_| numbers.uniform());
            report.steps += 1;
            if let Err(fault) = ant.step(&action) {
                report.faults.push(fault);
                break;
            }
            report.note(ant, map);
            down += usize::from(upside_down(ant));
        }
        report.ended_upside_down[0] += usize::from(upside_down(ant));
        report.ended_upside_down[1] += 1;
        if report.ended_upside_down[1] % 10 == 1 {
            report.leave_alone(ant);
        }
    }
    report.upside_down = down as f64 / report.steps as f64;
    report
}

impl Report {
    fn note(&mut self, ant: &Articulated, map: &CellMap) {
        let (q, v) = (&ant.configuration().q, &ant.configuration().v);
        let depth = ant.depth_in_walls();
        self.outside += usize::from(map.is_wall([f64::from(q[0]), f64::from(q[1])]));
        let pushed =
            |contact: Contact| contact.force > 0.0 && [contact.first, contact.second].contains(&Party::Walls);
        self.touching += usize::from(ant.contacts().any(pushed));
        self.deep += usize::from(depth > 0.02);
        self.deepest = self.deepest.max(depth);
        self.highest = self.highest.max(q[2]);
        self.fastest = self.fastest.max(v[..3].iter().map(|x| x * x).sum::<f32>().sqrt());
        self.energy = self.energy.max(ant.energy());
    }

    fn leave_alone(&mut self, ant: &mut Articulated) {
        let mut least = ant.energy();
        for _ in 0..100 {
            if let Err(fault) = ant.step(&[0.0; 8]) {
                self.faults.push(fault);
                return;
            }
            self.gained = self.gained.max(ant.energy() - least);
            least = least.min(ant.energy());
        }
    }
}

fn upside_down(ant: &Articulated) -> bool {
    let q = &ant.configuration().q;
    1.0 - 2.0 * (q[4] * q[4] + q[5] * q[5]) < 0.0
}
