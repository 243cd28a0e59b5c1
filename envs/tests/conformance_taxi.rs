//! Taxi against Gymnasium (fixtures/taxi): the complete table, and every recorded step.

#[path = "../../tests/support/fixtures.rs"]
mod fixtures;

use inroads_envs::taxi::{Rules, Taxi, TaxiState};
use inroads_envs::world::{Layout, Symbolic, World};
use inroads_envs::{End, Environment, Snapshot, TimeLimit};
use serde_json::{Value, json};

fn state(number: &Value) -> TaxiState {
    let number = number.as_u64().expect("a state's number") as usize;
    TaxiState::decode(number).unwrap_or_else(|| panic!("no state {number}"))
}

fn at(state: TaxiState) -> Taxi {
    let mut taxi = Taxi::new(Rules::Gymnasium);
    taxi.load(&state);
    taxi
}

/// The table is in the repository's set for certain; others have the episodes.
#[test]
fn conformance_taxi_table() {
    if fixtures::from_elsewhere() && !fixtures::folder("taxi").join("taxi_table.json").exists() {
        return;
    }
    let table = fixtures::document("taxi", "taxi_table.json");
    let starts: Vec<TaxiState> = TaxiState::starts().collect();
    for number in 0..TaxiState::COUNT {
        let from = state(&json!(number));
        assert_eq!(from.encode(), number);
        let TaxiState { row, column, passenger, destination } = from;
        assert_eq!(json!([row, column, passenger, destination]), table["decode"][number], "state {number}");
        let mask = at(from).legal().map(u8::from);
        assert_eq!(json!(mask), table["action_mask"][number], "state {number}");
        let chance = if starts.contains(&from) { 1.0 / starts.len() as f64 } else { 0.0 };
        let initial = table["initial_distribution"][number].as_f64().expect("a probability");
        assert!((chance - initial).abs() < 1e-6, "state {number} starts with probability {initial}");
        for choice in 0..6 {
            let mut taxi = at(from);
            let step = taxi.act(choice);
            let found = json!([taxi.state().encode(), step.reward as i64, u8::from(step.end.is_some())]);
            assert_eq!(found, table["P_next_reward_done"][number][choice], "state {number}, choice {choice}");
            assert_eq!(step.reward.fract(), 0.0);
        }
    }
    for (depot, cell) in table["locs_RGYB"].as_array().expect("depots").iter().enumerate() {
        // A passenger that waits at a depot can be picked up there.
        let [row, column]: [u8; 2] = serde_json::from_value(cell.clone()).expect("a cell");
        let passenger = depot as u8;
        let mut taxi = at(TaxiState { row, column, passenger, destination: (passenger + 1) % 4 });
        taxi.act(4);
        assert_eq!(taxi.state().passenger, 4, "depot {depot}");
    }
}

#[test]
fn conformance_taxi_every_step() {
    for record in fixtures::records("taxi", "episodes") {
        let seed = &record["seed"];
        let actions: Vec<usize> = serde_json::from_value(record["actions"].clone()).expect("actions");
        assert!(!actions.is_empty(), "seed {seed}");
        let first = state(&record["states"][0]);
        assert!(TaxiState::starts().any(|start| start == first), "seed {seed} starts in {first:?}");
        let mut env = TimeLimit::new(Symbolic::new(Taxi::new(Rules::Gymnasium), Layout::Random), 200);
        env.reset(0);
        env.change(|inner| inner.load(&(first, false)));
        for (number, &action) in actions.iter().enumerate() {
            let step = env.step(&action).unwrap_or_else(|why| panic!("seed {seed}, step {number}: {why}"));
            let next = env.inner().world().state();
            assert_eq!(json!(next.encode()), record["states"][number + 1], "seed {seed}, step {number}");
            let reward = record["rewards"][number].as_f64().expect("a reward");
            assert_eq!(f64::from(step.reward), reward, "seed {seed}, step {number}");
            let terminated = step.end == Some(End::Terminated);
            assert_eq!(json!(u8::from(terminated)), record["done"][number], "seed {seed}, step {number}");
        }
        assert_eq!(record["states"].as_array().map(Vec::len), Some(actions.len() + 1), "seed {seed}");
    }
}
