//! The same seed, machine and build give the same metrics, bit for bit, whatever the number of threads.

mod support;

use std::fs;

use support::{Folder, newest_checkpoint, small_training, succeed};

#[test]
fn the_same_seed_gives_the_same_run_with_one_thread_and_with_two() {
    let folder = Folder::new("determinism");
    let runs = [("first", "1"), ("again", "1"), ("threads", "2")].map(|(name, threads)| {
        let run = folder.join(name);
        let mut training = small_training(&run, 6);
        // Products of this size are split over threads when there are any.
        training.args(["--set", "policy.hidden=[400, 300]", "--set", "policy.batch=256"]);
        succeed(training.env("RAYON_NUM_THREADS", threads));
        (fs::read(run.join("metrics.jsonl")).unwrap(), fs::read(newest_checkpoint(&run)).unwrap())
    });
    assert!(runs[0] == runs[1], "two runs of one seed differ");
    assert!(runs[0] == runs[2], "two threads change the result");
}

#[test]
fn another_seed_gives_another_run() {
    let folder = Folder::new("seeds");
    let runs = ["3", "4"].map(|seed| {
        let run = folder.join(seed);
        succeed(small_training(&run, 3).args(["--set", &format!("seed={seed}")]));
        fs::read(run.join("metrics.jsonl")).unwrap()
    });
    assert!(runs[0] != runs[1]);
}
