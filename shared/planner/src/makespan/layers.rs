//! Which literals, operators and events a schedule of so many steps can have at which step.
//!
//! Forwards: the layers of the joint relaxed planning graph (Blum & Furst, "Fast planning through planning
//! graph analysis", AIJ 90, 1997), without mutexes. Backwards: what the goal may still need.

use super::model::{Lit, Maker, Model};
use crate::csr::Csr;

/// Never reached.
pub(super) const NEVER: u32 = u32::MAX;

/// The first layer of everything.
#[derive(Debug)]
pub(super) struct Reach {
    pub lits: Vec<u32>,
    pub operators: Vec<u32>,
    pub events: Vec<u32>,
}

/// What waits for what: the same wherever a schedule begins. Nodes wait for literals: operators first, then
/// events, then derivations.
#[derive(Debug)]
pub(super) struct Waiting {
    nodes: Csr<u32>,
    /// How many conditions each node has; an event waits for its operator, too.
    missing: Vec<u32>,
    /// What operators and events make true.
    makes: Csr<Lit>,
    /// What each derivation makes true.
    heads: Vec<Lit>,
    /// Operators without preconditions.
    ready: Vec<u32>,
    /// What derivations with an empty body give holds from the start.
    given: Vec<Lit>,
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

impl Waiting {
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
        let nodes = Csr::from_pairs(model.literals_count(), pairs);
        let mut missing: Vec<u32> = conditions.iter().map(|lits| lits.len() as u32).collect();
        model.events.iter().enumerate().for_each(|(event, _)| missing[operators + event] += 1);
        let made = model.makers.iter().enumerate().flat_map(|(lit, makers)| {
            makers.iter().map(move |maker| match *maker {
                Maker::Operator(o) => (o, Lit(lit as u32)),
                Maker::Event(e) => (operators as u32 + e, Lit(lit as u32)),
            })
        });
        Waiting {
            nodes,
            makes: Csr::from_pairs(operators + model.events.len(), made),
            heads: derivations.iter().map(|(head, _)| *head).collect(),
            ready: (0..operators as u32).filter(|&o| missing[o as usize] == 0).collect(),
            given: derivations.iter().filter(|(_, body)| body.is_empty()).map(|(head, _)| *head).collect(),
            missing,
        }
    }
}

impl Reach {
    /// From where the literals of `start` hold, for at most `steps` steps.
    pub fn new(model: &Model, waiting: &Waiting, start: impl Fn(Lit) -> bool, steps: u32) -> Self {
        let operators = model.preconditions.len();
        let mut reach = Reach {
            lits: vec![NEVER; model.literals_count()],
            operators: vec![NEVER; operators],
            events: vec![NEVER; model.events.len()],
        };
        let mut missing = waiting.missing.clone();
        let mut current: Vec<Lit> =
            (0..model.literals_count() as u32).map(Lit).filter(|&lit| start(lit)).collect();
        current.extend(&waiting.given);
        let mut ready = waiting.ready.clone();
        let mut layer = 0;
        loop {
            reach.hold(waiting, &mut current, &mut ready, &mut missing, layer);
            if ready.is_empty() || layer == steps {
                return reach;
            }
            reach.act(model, waiting, &mut current, &mut ready, &mut missing, layer);
            layer += 1;
        }
    }

    /// The literals of this layer, with what follows from them at once; what then waits no more is `ready`.
    fn hold(
        &mut self,
        waiting: &Waiting,
        current: &mut Vec<Lit>,
        ready: &mut Vec<u32>,
        missing: &mut [u32],
        layer: u32,
    ) {
        let acting = waiting.makes.len();
        let mut at = 0;
        while at < current.len() {
            let lit = current[at];
            at += 1;
            if self.lits[lit.index()] != NEVER {
                continue;
            }
            self.lits[lit.index()] = layer;
            for &node in waiting.nodes.row(lit.index()) {
                missing[node as usize] -= 1;
                if missing[node as usize] > 0 {
                    continue;
                }
                match (node as usize).checked_sub(acting) {
                    Some(derivation) => current.push(waiting.heads[derivation]),
                    None => ready.push(node),
                }
            }
        }
        current.clear();
    }

    /// What is `ready` happens in this layer; `current` becomes what that makes true.
    fn act(
        &mut self,
        model: &Model,
        waiting: &Waiting,
        current: &mut Vec<Lit>,
        ready: &mut Vec<u32>,
        missing: &mut [u32],
        layer: u32,
    ) {
        let operators = self.operators.len();
        let mut at = 0;
        while at < ready.len() {
            let node = ready[at] as usize;
            at += 1;
            current.extend(waiting.makes.row(node).iter().filter(|l| self.lits[l.index()] == NEVER));
            if node >= operators {
                self.events[node - operators] = layer;
                continue;
            }
            self.operators[node] = layer;
            for event in model.events_of[node].clone() {
                let waits = &mut missing[operators + event as usize];
                *waits -= 1;
                if *waits == 0 {
                    ready.push(operators as u32 + event);
                }
            }
        }
        ready.clear();
    }

    /// The first layer that has the whole goal; [`NEVER`] if none does.
    pub fn goal(&self, goal: &[Lit]) -> u32 {
        goal.iter().map(|lit| self.lits[lit.index()]).max().unwrap_or(0)
    }

    /// The layers of a schedule of `steps` steps: what its goal may need and its start may give, with the
    /// operators that are `allowed`.
    pub fn layers(&self, model: &Model, goal: &[Lit], allowed: &[bool], steps: u32) -> Vec<Layer> {
        let mut layers = Vec::with_capacity(steps as usize + 1);
        let mut needed = Needed::new(model.literals_count());
        goal.iter().for_each(|&lit| needed.add(lit));
        self.close(model, &mut needed, &[], steps);
        layers.push(Layer { lits: needed.take(), operators: Vec::new(), events: Vec::new() });
        for step in (0..steps).rev() {
            let after: &Layer = &layers[layers.len() - 1];
            let (operators, events) = self.step(model, allowed, &after.lits, step);
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
    fn step(&self, model: &Model, allowed: &[bool], lits: &[Lit], step: u32) -> (Vec<u32>, Vec<u32>) {
        let (mut operators, mut events) = (Vec::new(), Vec::new());
        for lit in lits {
            let makers = model.makers[lit.index()].iter();
            for maker in makers.filter(|&&m| allowed[model.operator_of(m) as usize]) {
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
        if model.events.is_empty() {
            return;
        }
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
