//! One vocabulary: initiation sets, subgoals, novelty, naming, planner and learner are each swapped by one line of
//! configuration, and every combination trains, saves, loads and can be watched.

use inroads::{
    config::Config,
    session::{self, Protocol, Session},
};

/// A short run with these settings, saved and loaded into a fresh session, then watched for an episode. Returns how many
/// steps were trained.
fn trained(agent: &str, environment: &str, episodes: u64, sets: &[String]) -> u64 {
    let config = sets.iter().fold(Config::defaults(agent, environment).unwrap(), |config, set| {
        config
            .with_assignment(set)
            .unwrap_or_else(|error| panic!("{agent} in {environment} with {set}: {error}"))
    });
    let build = || session::build(&config).unwrap_or_else(|error| panic!("{agent} with {sets:?}: {error}"));
    let mut run: Box<dyn Session> = build();
    for _ in 0..episodes {
        run.train().unwrap();
    }
    let saved = run.save();
    let mut loaded = build();
    loaded.load(&saved).unwrap();
    assert!(loaded.save() == saved, "{agent} with {sets:?} saves other things than it loads");
    let watch = |run: &mut Box<dyn Session>| run.evaluate(Protocol::Frozen, 0).unwrap().unwrap();
    assert_eq!(watch(&mut run), watch(&mut loaded), "{agent} with {sets:?} acts otherwise when it is loaded");
    assert!(run.save() == saved, "{agent} with {sets:?} learns while it is watched");
    run.progress().1
}

/// All combinations of the values of these keys.
fn combinations(keys: &[(&str, &[&str])]) -> Vec<Vec<String>> {
    keys.iter().fold(vec![Vec::new()], |all, (key, values)| {
        let with = |one: &Vec<String>| -> Vec<Vec<String>> {
            values.iter().map(|value| [&one[..], &[format!("{key}={value}")]].concat()).collect()
        };
        all.iter().flat_map(with).collect()
    })
}

fn all_train(agent: &str, environment: &str, episodes: u64, keys: &[(&str, &[&str])]) {
    let combinations = combinations(keys);
    assert_eq!(combinations.len(), keys.iter().map(|(_, values)| values.len()).product::<usize>());
    for sets in combinations {
        assert!(trained(agent, environment, episodes, &sets) > 0);
    }
}

#[test]
fn chains_with_every_kind_of_set_subgoal_and_choice() {
    let keys: [(&str, &[&str]); 4] = [
        ("initiation.sets", &["binary", "dual", "ivf", "weighted"]),
        ("chain.subgoals", &["set", "sample", "dynamic_programming"]),
        ("over_options.choose", &["values", "scan"]),
        ("initiation.classifier", &["nearest", "svm"]),
    ];
    all_train("dsc-tabular", "corridor-5", 12, &keys);
    let keys: [(&str, &[&str]); 3] = [
        ("chain.subgoals", &["sample", "dynamic_programming"]),
        ("chain.explore", &["task", "events"]),
        ("chain.lessons", &["all", "own"]),
    ];
    all_train("robust-dsc-tabular", "corridor-5", 12, &keys);
    // A network of one class only is everywhere, so it makes no dual sets.
    let keys: [(&str, &[&str]); 3] = [
        ("initiation.sets", &["binary", "weighted"]),
        ("initiation.classifier", &["neural"]),
        ("initiation.neural.updates", &["10"]),
    ];
    all_train("dsc-tabular", "corridor-5", 12, &keys);
}

#[test]
fn explorers_with_every_kind_of_planner_novelty_and_name() {
    let keys: [(&str, &[&str]); 3] = [
        ("planner", &["abstract_mdp", "dijkstra", "dijkstra_surest", "direct"]),
        ("novelty.counts", &["states", "features"]),
        ("naming", &["whole", "counterfactual"]),
    ];
    all_train("im-dsg", "nine-cells", 12, &keys);
    all_train("abstract-subgoals", "nine-cells", 12, &keys);
}

#[test]
fn agents_with_a_bonus_from_networks() {
    let keys: [(&str, &[&str]); 5] = [
        ("novelty.counts", &["cfn", "rnd"]),
        ("novelty.cfn.warm_up", &["20"]),
        ("novelty.rnd.warm_up", &["20"]),
        ("novelty.cfn.batch", &["8"]),
        ("novelty.rnd.batch", &["8"]),
    ];
    for agent in ["counts-q", "im-dsg", "abstract-subgoals"] {
        all_train(agent, "nine-cells", 6, &keys);
    }
    let keys: [(&str, &[&str]); 4] = [
        ("novelty.counts", &["states", "features", "cfn", "rnd"]),
        ("novelty.cfn.warm_up", &["20"]),
        ("novelty.rnd.warm_up", &["20"]),
        ("memory.warm_up", &["40"]),
    ];
    all_train("cfn", "nine-cells", 6, &keys);
}

#[test]
fn graphs_of_regions_with_every_kind_of_set_planner_and_policy() {
    let keys: [(&str, &[&str]); 3] = [
        ("initiation.sets", &["binary", "dual"]),
        ("planner", &["dijkstra", "abstract_mdp"]),
        ("policies", &["given", "ddpg"]),
    ];
    all_train("dsg", "point-arena", 2, &keys);
}

#[test]
fn an_unknown_part_is_answered_with_those_that_there_are() {
    let config = Config::defaults("dsc-tabular", "rooms").unwrap();
    let error = config.with_assignment("initiation.sets=convex").unwrap_err().to_string();
    assert!(error.contains("convex") && error.contains("weighted"), "{error}");
    let config = Config::defaults("dsc-tabular", "rooms").unwrap().with_assignment("initiation.sets=dual");
    let error = config.unwrap().with_assignment("initiation.classifier=neural").unwrap_err().to_string();
    assert!(error.contains("neural") && error.contains("nearest"), "{error}");
}

#[test]
fn tables_learn_from_pictures_as_from_symbols() {
    for agent in ["q-learning", "counts-q"] {
        for see in ["rgb", "grey:16"] {
            let sets =
                [format!("world.see={see:?}"), "memory.warm_up=8".into(), "world.layout=\"fixed:42\"".into()];
            assert!(trained(agent, "door-key-5x5", 4, &sets) > 0);
        }
    }
}
