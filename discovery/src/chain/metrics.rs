//! Which skills make a chain: whose probability of success is measured (4.2.2, equation 4.2).

use crate::SkillRecord;

/// The skills that lead from a skill to the task's goal, the skill itself first.
pub fn chain_from(skills: &[SkillRecord], skill: u32) -> Vec<u32> {
    let record = |k: u32| skills.iter().find(|record| record.skill == k);
    std::iter::successors(record(skill), |last| record(last.enters?)).map(|record| record.skill).collect()
}

/// The skills that no other skill aims at: where chains begin.
pub fn leaves(skills: &[SkillRecord]) -> Vec<u32> {
    let aimed_at = |k: u32| skills.iter().any(|record| record.enters == Some(k));
    skills.iter().map(|record| record.skill).filter(|k| !aimed_at(*k)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::Phase;

    fn record(skill: u32, enters: Option<u32>, successes: u64, executions: u64) -> SkillRecord {
        SkillRecord { skill, enters, phase: Phase::Fixed, born: 0, executions, successes, examples: (0, 0) }
    }

    #[test]
    fn a_tree_has_a_chain_a_leaf() {
        // 1 reaches the goal; 2 and 3 enter 1; 4 enters 3.
        let skills = [
            record(1, None, 9, 10),
            record(2, Some(1), 1, 2),
            record(3, Some(1), 4, 5),
            record(4, Some(3), 0, 0),
        ];
        assert_eq!(leaves(&skills), [2, 4]);
        assert_eq!((chain_from(&skills, 4), chain_from(&skills, 2)), (vec![4, 3, 1], vec![2, 1]));
        assert!(chain_from(&skills, 9).is_empty());
    }
}
