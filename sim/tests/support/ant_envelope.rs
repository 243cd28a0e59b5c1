//! What MuJoCo itself does with the ant's open-loop programs when its time step, integrator or friction cone
//! differs: `ant_envelope.json`, written by `ant_envelope.py`.
//!
//! The fixtures were recorded with RK4 at 20 ms, which MuJoCo leaves at a finer step: a single column says as much
//! about that integrator as about the ant. So what is asked is to lie among MuJoCo's own answers.

use serde_json::Value;

use crate::ant::{Band, Measures, Program, numbers};

const ENVELOPE: &str = include_str!("ant_envelope.json");

/// Slack of net movement and path, as a share.
const ON_THE_FLOOR: f64 = 0.05;
/// Slack of heights, as a share.
const OF_HEIGHT: f64 = 0.02;

/// MuJoCo's variants under one of its two settings.
pub(crate) struct Envelope(Value);

/// A program by variants.
pub(crate) struct Answers {
    bands: Vec<Measures<Band>>,
    /// Mean movement over starts, metres.
    pub(crate) moved: Vec<[f64; 2]>,
}

impl Envelope {
    /// `settings` is "thesis" or "gymnasium".
    pub(crate) fn of(settings: &str) -> Self {
        let all: Value = serde_json::from_str(ENVELOPE).expect("the envelope is JSON");
        Self(all[settings].clone())
    }

    /// What variants make of the value `key` that has nothing to do with programs.
    pub(crate) fn spread(&self, key: &str) -> Band {
        Band::of(self.variants().map(|variant| variant[key].as_f64().expect("a number")))
    }

    /// What variants do with a program, if it is one of those that they were run with.
    pub(crate) fn answers(&self, program: &Program) -> Option<Answers> {
        let programs = self.0["programs"].as_array().expect("programs");
        let index = programs.iter().position(|known| program.is(known))?;
        Some(self.answers_to(index))
    }

    /// Where the mean of each measure may lie for MuJoCo to agree: within the recorded starts and those of all
    /// variants. For a program that variants were not run with, the recorded band is widened at either end by the
    /// greatest factor by which any variant exceeds it there in any of the programs in `known`.
    pub(crate) fn bands(&self, program: &Program, known: &[Program]) -> [(&'static str, Band); 4] {
        let recorded = program.recorded.named();
        let factors = self.factors(known);
        let answers = self.answers(program).map(|answers| answers.bands);
        std::array::from_fn(|i| {
            let (name, band) = recorded[i];
            let (min, max) = match &answers {
                Some(variants) => variants
                    .iter()
                    .map(|variant| variant.named()[i].1)
                    .fold((band.min, band.max), |(min, max), variant| {
                        (variant.min.min(min), variant.max.max(max))
                    }),
                None => (factors[i][0] * band.min, factors[i][1] * band.max),
            };
            let slack = if i < 2 { ON_THE_FLOOR } else { OF_HEIGHT };
            (name, Band { min: min * (1.0 - slack), mean: band.mean, max: max * (1.0 + slack) })
        })
    }

    /// Of each measure, the least of variants' least over the recorded least, and the greatest of their greatest
    /// over the recorded greatest.
    fn factors(&self, known: &[Program]) -> [[f64; 2]; 4] {
        let mut factors = [[1.0_f64; 2]; 4];
        for program in known {
            let recorded = program.recorded.named();
            for variant in self.answers(program).into_iter().flat_map(|answers| answers.bands) {
                for ((factor, (_, recorded)), (_, variant)) in
                    factors.iter_mut().zip(recorded).zip(variant.named())
                {
                    factor[0] = factor[0].min(variant.min / recorded.min);
                    factor[1] = factor[1].max(variant.max / recorded.max);
                }
            }
        }
        factors
    }

    fn variants(&self) -> impl Iterator<Item = &Value> + Clone {
        self.0["variants"].as_array().expect("variants").iter()
    }

    fn answers_to(&self, program: usize) -> Answers {
        let rows = || self.variants().map(|variant| &variant["programs"][program]);
        let moved = rows().map(|row| numbers(&row["mean_displacement_m"])).map(|moved| [moved[0], moved[1]]);
        Answers { bands: rows().map(Measures::read).collect(), moved: moved.collect() }
    }
}
