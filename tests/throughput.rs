//! The parts of the benchmark that decide: its own harness runs no tests.

#[path = "../benches/throughput/compare.rs"]
mod compare;
#[path = "../benches/throughput/processor.rs"]
mod processor;

use compare::{Verdict, judge, median};
use processor::{name, of_cpuinfo};

/// A machine that is disturbed most of the time: relative speeds between 0.7 and 1.02 of the true one.
fn noisy(random: &mut u64) -> f64 {
    *random ^= *random << 13;
    *random ^= *random >> 7;
    *random ^= *random << 17;
    0.7 + 0.32 * ((*random >> 40) as f64 / (1u64 << 24) as f64)
}

#[test]
fn a_slowdown_of_a_fifth_is_caught_by_every_run_on_a_quiet_machine() {
    for wobble in [0.97, 1.0, 1.03] {
        let slower = 0.8 * wobble;
        assert_eq!(judge(1.0, slower, || slower), Verdict::Slower(slower));
    }
}

#[test]
fn a_slowdown_of_a_fifth_is_caught_among_noise() {
    let mut random = 7;
    for _ in 0..1000 {
        let first = 0.8 * noisy(&mut random);
        assert!(matches!(judge(1.0, first, || 0.8 * noisy(&mut random)), Verdict::Slower(_)));
    }
}

#[test]
fn noise_that_passes_is_not_a_slowdown() {
    let mut random = 7;
    let failures = (0..1000)
        .filter(|_| {
            let first = noisy(&mut random);
            matches!(judge(1.0, first, || noisy(&mut random)), Verdict::Slower(_))
        })
        .count();
    // (0.15 / 0.32)^6 is one in a hundred of runs in which one workload is disturbed throughout.
    assert!(failures < 20, "{failures}");
    let mut attempts = [0.5, 0.6, 0.7, 0.99].into_iter();
    assert_eq!(judge(1.0, 0.4, || attempts.next().unwrap()), Verdict::Kept);
}

#[test]
fn what_is_as_fast_as_recorded_is_not_measured_again() {
    assert_eq!(judge(1.0, 0.86, || unreachable!("it is fast enough")), Verdict::Kept);
    assert_eq!(judge(1.0, 1.10, || unreachable!("it is fast enough")), Verdict::Kept);
}

#[test]
fn faster_is_what_is_faster_twice() {
    assert_eq!(judge(1.0, 1.3, || 1.2), Verdict::Faster);
    assert_eq!(judge(1.0, 1.3, || 1.1), Verdict::Kept);
}

#[test]
fn the_fastest_attempt_is_reported() {
    let mut attempts = [0.7, 0.75, 0.6, 0.5, 0.74].into_iter();
    assert_eq!(judge(1.0, 0.5, || attempts.next().unwrap()), Verdict::Slower(0.75));
    assert!(attempts.next().is_none());
}

#[test]
fn the_median_is_the_lower_middle() {
    assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
    assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), 2.0);
    assert!(median(Vec::new()).is_nan());
}

#[test]
fn processors_are_named_by_what_the_kernel_tells() {
    let amd = "processor\t: 0\ncpu family\t: 26\nmodel\t\t: 2\nmodel name\t: AMD EPYC\n\nprocessor\t: 1\n";
    assert_eq!(of_cpuinfo(amd), "AMD EPYC, cpu family 26, model 2");
    let arm = "processor\t: 0\nCPU implementer\t: 0x41\nCPU part\t: 0xd0c\n";
    assert_eq!(of_cpuinfo(arm), "CPU implementer 0x41, CPU part 0xd0c");
    assert_eq!(of_cpuinfo(""), "");
    assert!(!name().is_empty());
}
