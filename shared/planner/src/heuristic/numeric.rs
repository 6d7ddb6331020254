//! Which operators bring a comparison of numbers nearer to holding.

use std::collections::BTreeMap;

use crate::numeric::NumericEffect;
use crate::task::{FactId, OperatorId, Task};

/// An operator (under an effect's condition) that helps a comparison to hold.
pub(super) struct Support {
    pub operator: OperatorId,
    /// The operator's preconditions and the effect's condition.
    pub conditions: Vec<FactId>,
    /// That the comparison holds.
    pub fact: FactId,
    /// What it brings the comparison nearer by; `None` where that differs from state to state.
    pub gain: Option<f64>,
}

/// For each comparison whatever may ever help. Where the comparison is linear and all effects are fixed
/// increases, those that lead away from it are left out; else every operator that changes one of its numbers
/// counts. So where no support is reachable, the comparison never holds.
pub(super) fn supports(task: &Task) -> Vec<(u32, Vec<Support>)> {
    let comparisons = &task.numeric.comparisons;
    if comparisons.is_empty() {
        return Vec::new();
    }
    // Each number's comparisons, with the factor it has there; `None`: not linear.
    let mut of_number: Vec<BTreeMap<u32, Option<f64>>> = vec![BTreeMap::new(); task.numeric.initial.len()];
    for (at, (_, comparison)) in comparisons.iter().enumerate() {
        let linear = comparison.coefficients().filter(|_| comparison.is_directed());
        comparison.for_each_variable(&mut |number| {
            let factor = linear.as_ref().map(|factors| factors.get(&number).copied().unwrap_or(0.0));
            of_number[number as usize].insert(at as u32, factor);
        });
    }
    let mut all: Vec<Vec<Support>> = comparisons.iter().map(|_| Vec::new()).collect();
    for operator in (0..task.operators.len() as u32).map(OperatorId) {
        let effects = task.numeric.effects_of(operator.index());
        // Effects under one condition happen together.
        let mut together: BTreeMap<&[FactId], BTreeMap<u32, Option<f64>>> = BTreeMap::new();
        for effect in effects {
            let condition = task.effect_conditions.row(effect.condition as usize);
            let gains = together.entry(condition).or_default();
            for (&comparison, &factor) in &of_number[effect.target as usize] {
                let gain = gain(effect, factor);
                let so_far = gains.entry(comparison).or_insert(Some(0.0));
                *so_far = so_far.zip(gain).map(|(a, b)| a + b);
            }
        }
        for (condition, gains) in together {
            for (comparison, gain) in gains {
                if gain.is_some_and(|gain| gain <= 0.0) {
                    continue;
                }
                let mut conditions = [task.preconditions(operator), condition].concat();
                conditions.sort_unstable();
                conditions.dedup();
                let fact = comparisons[comparison as usize].0;
                all[comparison as usize].push(Support { operator, conditions, fact, gain });
            }
        }
    }
    all.into_iter().enumerate().map(|(at, supports)| (at as u32, supports)).collect()
}

/// What an effect adds to `left - right` of a comparison where its number has this factor.
fn gain(effect: &NumericEffect, factor: Option<f64>) -> Option<f64> {
    Some(factor? * effect.gain()?)
}
