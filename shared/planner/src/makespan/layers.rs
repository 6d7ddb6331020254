//! Which literals, operators and events a schedule of so many steps can have at which step.
//!
//! Forwards: the layers of the joint relaxed planning graph (Blum & Furst, "Fast planning through planning
//! graph analysis", AIJ 90, 1997), without mutexes. Backwards: what the goal may still need.

use super::model::{Lit, Maker, Model};
use super::relevance::Relevance;
use crate::csr::Csr;

/// Never reached.
pub(super) const NEVER: u32 = u32::MAX;

/// The first layer of everything.
#[derive(Debug)]
pub(super) struct Reach {
    pub lits: Vec<u32>,
    pub operators: Vec<u32>,
    pub events: Vec<u32>,
    waiting: Csr<u32>,
}

/// What may hold before step `t` and what may be done in it, for a schedule of a certain length.
#[derive(Debug)]
pub(super) struct Layer {
    /// Literals that may be needed before the step.
    pub lits: Vec<Lit>,
    /// Operators that may be done in the step; none in the last layer.
    pub operators: Vec<u32>,
    /// Events that may be counted on in the step.
    pub events: Vec<u32>,
}

/// Nodes wait for literals: operators first, then events, then derivations.
impl Reach {
    pub fn new(model: &Model) -> Self {
        let operators = model.preconditions.len();
        let derivations: Vec<(Lit, &Vec<Lit>)> = model
            .derivations
            .iter()
            .flat_map(|(&head, bodies)| bodies.iter().map(move |body| (Lit(head), body)))
            .collect();
        let conditions: Vec<&[Lit]> = (0..operators)
            .map(|o| model.preconditions.row(o))
            .chain(model.events.iter().map(|e| e.condition.as_slice()))
            .chain(derivations.iter().map(|(_, body)| body.as_slice()))
            .collect();
        let pairs = conditions
            .iter()
            .enumerate()
            .flat_map(|(node, lits)| lits.iter().map(move |lit| (lit.0, node as u32)));
        let waiting = Csr::from_pairs(model.literals_count(), pairs);
        let mut missing: Vec<u32> = conditions.iter().map(|lits| lits.len() as u32).collect();
        // An event waits for its operator, too.
        model.events.iter().enumerate().for_each(|(event, _)| missing[operators + event] += 1);
        let mut makes: Vec<Vec<Lit>> = vec![Vec::new(); operators + model.events.len()];
        for (lit, makers) in model.makers.iter().enumerate() {
            for maker in makers {
                match *maker {
                    Maker::Operator(o) => makes[o as usize].push(Lit(lit as u32)),
                    Maker::Event(e) => makes[operators + e as usize].push(Lit(lit as u32)),
                }
            }
        }
        let mut reach = Reach {
            lits: vec![NEVER; model.literals_count()],
            operators: vec![NEVER; operators],
            events: vec![NEVER; model.events.len()],
            waiting,
        };
        let mut current: Vec<Lit> =
            (0..model.literals_count() as u32).map(Lit).filter(|l| model.initially[l.index()]).collect();
        // What derivations with an empty body give holds from the start.
        current.extend(derivations.iter().filter(|(_, body)| body.is_empty()).map(|(head, _)| *head));
        let mut ready: Vec<u32> = (0..operators as u32).filter(|&o| missing[o as usize] == 0).collect();
        let mut layer = 0;
        loop {
            // The literals of this layer, with what follows from them at once.
            let mut at = 0;
            while at < current.len() {
                let lit = current[at];
                at += 1;
                if reach.lits[lit.index()] != NEVER {
                    continue;
                }
                reach.lits[lit.index()] = layer;
                for &node in reach.waiting.row(lit.index()) {
                    missing[node as usize] -= 1;
                    if missing[node as usize] > 0 {
                        continue;
                    }
                    match (node as usize).checked_sub(makes.len()) {
                        Some(derivation) => current.push(derivations[derivation].0),
                        None => ready.push(node),
                    }
                }
            }
            current.clear();
            if ready.is_empty() {
                return reach;
            }
            let mut at = 0;
            while at < ready.len() {
                let node = ready[at] as usize;
                at += 1;
                current.extend(makes[node].iter().filter(|l| reach.lits[l.index()] == NEVER));
                if node >= operators {
                    reach.events[node - operators] = layer;
                    continue;
                }
                reach.operators[node] = layer;
                for event in model.events_of[node].clone() {
                    let waits = &mut missing[operators + event as usize];
                    *waits -= 1;
                    if *waits == 0 {
                        ready.push(operators as u32 + event);
                    }
                }
            }
            ready.clear();
            layer += 1;
        }
    }

    /// The first layer that has the whole goal; [`NEVER`] if none does.
    pub fn goal(&self, model: &Model) -> u32 {
        model.goal.iter().map(|lit| self.lits[lit.index()]).max().unwrap_or(0)
    }

    /// The layers of a schedule of `steps` steps: what its goal may need and its start may give.
    pub fn layers(&self, model: &Model, relevance: &Relevance, steps: u32) -> Vec<Layer> {
        let mut layers = Vec::with_capacity(steps as usize + 1);
        let mut needed = Needed::new(model.literals_count());
        model.goal.iter().for_each(|&lit| needed.add(lit));
        self.close(model, &mut needed, &[], steps);
        layers.push(Layer { lits: needed.take(), operators: Vec::new(), events: Vec::new() });
        for step in (0..steps).rev() {
            let after: &Layer = &layers[layers.len() - 1];
            let (operators, events) = self.step(model, relevance, &after.lits, step);
            let lasting = after.lits.iter().filter(|l| !model.is_derived(**l));
            lasting.filter(|l| self.lits[l.index()] <= step).for_each(|&lit| needed.add(lit));
            for &operator in &operators {
                model.preconditions.row(operator as usize).iter().for_each(|&lit| needed.add(lit));
            }
            for &event in &events {
                model.events[event as usize].condition.iter().for_each(|&lit| needed.add(lit));
            }
            for lit in &after.lits {
                self.excuse(model, &mut needed, *lit, &operators, step);
            }
            self.close(model, &mut needed, &operators, step);
            layers.push(Layer { lits: needed.take(), operators, events });
        }
        layers.reverse();
        layers
    }

    /// What may make these literals true in a step.
    fn step(&self, model: &Model, relevance: &Relevance, lits: &[Lit], step: u32) -> (Vec<u32>, Vec<u32>) {
        let (mut operators, mut events) = (Vec::new(), Vec::new());
        for lit in lits {
            let makers = model.makers[lit.index()].iter();
            for maker in makers.filter(|&&m| relevance.operators[model.operator_of(m) as usize]) {
                match *maker {
                    Maker::Operator(o) if self.operators[o as usize] <= step => operators.push(o),
                    Maker::Event(e) if self.events[e as usize] <= step => {
                        events.push(e);
                        operators.push(model.events[e as usize].operator);
                    }
                    Maker::Operator(_) | Maker::Event(_) => {}
                }
            }
        }
        for list in [&mut operators, &mut events] {
            list.sort_unstable();
            list.dedup();
        }
        (operators, events)
    }

    /// Adds why the operators might do the literal no harm.
    fn excuse(&self, model: &Model, needed: &mut Needed, lit: Lit, operators: &[u32], layer: u32) {
        let threats = model.threats[lit.index()].iter().filter(|t| !t.harmless_if.is_empty());
        for threat in threats.filter(|t| operators.binary_search(&t.operator).is_ok()) {
            let possible = threat.harmless_if.iter().filter(|l| self.lits[l.index()] <= layer);
            possible.for_each(|&lit| needed.add(lit));
        }
    }

    /// Adds what derived literals rest on, and the excuses of what threatens the literals that are needed.
    fn close(&self, model: &Model, needed: &mut Needed, operators: &[u32], layer: u32) {
        let mut at = 0;
        while at < needed.list.len() {
            let lit = needed.list[at];
            at += 1;
            for body in model.derivations.get(&lit.0).into_iter().flatten() {
                if body.iter().all(|l| self.lits[l.index()] <= layer) {
                    body.iter().for_each(|&l| needed.add(l));
                }
            }
            self.excuse(model, needed, lit, operators, layer);
        }
    }
}

/// A set of literals that is filled and taken again and again.
struct Needed {
    marks: Vec<bool>,
    list: Vec<Lit>,
}

impl Needed {
    fn new(literals: usize) -> Self {
        Needed { marks: vec![false; literals], list: Vec::new() }
    }

    fn add(&mut self, lit: Lit) {
        if !std::mem::replace(&mut self.marks[lit.index()], true) {
            self.list.push(lit);
        }
    }

    fn take(&mut self) -> Vec<Lit> {
        let mut list = std::mem::take(&mut self.list);
        list.iter().for_each(|lit| self.marks[lit.index()] = false);
        list.sort_unstable();
        list
    }
}
