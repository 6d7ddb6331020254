//! The order in which axioms are evaluated: what an axiom negates is settled in an earlier layer.

use super::GroundError;
use super::propositional::Ground;

/// The rules, layer by layer.
pub(super) struct Layering {
    pub layers: Vec<Vec<u32>>,
    /// Whether a layer needs to be evaluated until nothing changes.
    pub recursive: bool,
}

/// Orders the rules of a task.
pub(super) fn layers(ground: &Ground) -> Result<Layering, GroundError> {
    if let Some(order) = acyclic_order(ground) {
        let layers = if order.is_empty() { Vec::new() } else { vec![order] };
        return Ok(Layering { layers, recursive: false });
    }
    let mut layer = vec![0u32; ground.names.len()];
    let derived = ground.derived.iter().filter(|&&derived| derived).count() as u32;
    loop {
        let mut changed = false;
        for rule in &ground.rules {
            for lit in ground.lits(rule.body).iter().filter(|lit| ground.derived[lit.atom()]) {
                let least = layer[lit.atom()] + u32::from(!lit.holds());
                if layer[rule.head as usize] < least {
                    layer[rule.head as usize] = least;
                    changed = true;
                }
                if least > derived {
                    return Err(GroundError::Malformed(
                        "a derived predicate depends on its own negation, so its value is not defined".into(),
                    ));
                }
            }
        }
        if !changed {
            break;
        }
    }
    let mut layers = vec![Vec::new(); layer.iter().max().map_or(0, |&max| max as usize + 1)];
    for (at, rule) in ground.rules.iter().enumerate() {
        layers[layer[rule.head as usize] as usize].push(at as u32);
    }
    Ok(Layering { layers, recursive: true })
}

/// The rules in an order in which each comes after those for the atoms it asks for, if there is one.
fn acyclic_order(ground: &Ground) -> Option<Vec<u32>> {
    let rules = &ground.rules;
    let mut open = vec![0u32; ground.names.len()];
    rules.iter().for_each(|rule| open[rule.head as usize] += 1);
    let asks = rules.iter().enumerate().flat_map(|(at, rule)| {
        let derived = ground.lits(rule.body).iter().filter(|lit| open[lit.atom()] > 0);
        derived.map(move |lit| (lit.atom() as u32, at as u32)).collect::<Vec<_>>()
    });
    let asks: Vec<(u32, u32)> = asks.collect();
    let askers = crate::csr::Csr::from_pairs(ground.names.len(), asks.iter().copied());
    let mut waits = vec![0u32; rules.len()];
    asks.iter().for_each(|&(_, rule)| waits[rule as usize] += 1);
    let mut order: Vec<u32> = (0..rules.len() as u32).filter(|&rule| waits[rule as usize] == 0).collect();
    let mut done = 0;
    while done < order.len() {
        let head = rules[order[done] as usize].head as usize;
        done += 1;
        open[head] -= 1;
        if open[head] == 0 {
            for &rule in askers.row(head) {
                waits[rule as usize] -= 1;
                if waits[rule as usize] == 0 {
                    order.push(rule);
                }
            }
        }
    }
    (order.len() == rules.len()).then_some(order)
}
