//! The machine for evidence: from an experiment file to runs, a figure, verdicts and their price.
//!
//! An experiment file (`experiments/fig-*.toml`) says what the thesis claims, which agents are held against which, where,
//! for how long and at what price. `inroads reproduce` makes a [`Plan`] of it, does the runs that are not done
//! (`work`), draws the figure with every seed and writes [`Record`], the JSON beside it, with a verdict a claim.
//! `inroads claims` reads all of those. The rules behind it are the project's rules of evidence: every claim has a price,
//! one budget for all agents of a domain, three words for verdicts, contradictions stay in the table.
//!
//! | module | |
//! |---|---|
//! | `file`, `drawing` | the experiment file; what it can ask to be drawn |
//! | `plan` | the runs that it asks for |
//! | `state` | what has become of each |
//! | `work` | doing them, stopped and taken up again, in shards |
//! | `metric` | what is drawn and compared, read from a run's logs |
//! | `claim` | verdicts |
//! | `price` | core-hours |
//! | `record` | the JSON of a figure, and the table of claims |
//! | `figure`, `picture` | what is drawn of many runs, and of one |

mod claim;
mod drawing;
mod error;
mod figure;
mod file;
mod metric;
mod picture;
mod plan;
mod price;
mod record;
mod state;
mod work;

pub use claim::Judged;
pub use drawing::{Axis, Choice, Draw, Options};
pub use error::EvidenceError;
pub use figure::draw;
pub use file::{Arm, Budget, Claim, Domain, Experiment, Rule, find};
pub use metric::{Metric, Point, Quantity};
pub use plan::{Asked, Plan, Shard, Wanted};
pub use price::price;
pub use record::{ArmCost, Record, RunRecord, Shown, claims};
pub use state::State;
pub use work::{Told, Worker};
