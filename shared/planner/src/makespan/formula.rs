//! A schedule of so many steps as a propositional formula (Kautz & Selman, "Planning as satisfiability",
//! ECAI 1992; parallel steps as in Rintanen, Heljanko & Niemelä, "Planning as satisfiability: parallel plans
//! and algorithms for plan search", AIJ 170, 2006, section 3, "∀-step").
//!
//! In each step every agent does at most one action, and the actions of a step may happen in any order. A
//! variable "literal l before step t" means that l is sure to hold there whatever that order was: it needs a
//! maker or must have been so before, and nothing in the step may undo it. It need not be set where nobody
//! relies on it, so two actions that leave a fact undecided may share a step if nobody cares. This is what a
//! deordered plan ([`crate::partial_order`]) looks like when everybody acts as soon as possible: makers come
//! strictly before who relies on them, and whoever might undo a link lies outside it or has an excuse.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::layers::Layer;
use super::model::{Lit, Maker, Model, Threat};
use super::pieces::Makers;
use super::sat::{Bool, Clauses, Fuel};
use super::together::Together;

/// The formula, and where to read the schedule.
pub(super) struct Formula {
    pub clauses: Clauses,
    /// For each step, the operators and their variables.
    pub operators: Vec<Vec<(u32, Bool)>>,
}

/// The variables of a layer, by position in its lists.
struct Variables {
    lits: Vec<Bool>,
    operators: Vec<Bool>,
    events: Vec<Bool>,
}

/// The formula for schedules with these layers that lead to `goal`; `None` if it gets too large or takes too long.
pub(super) fn formula(
    model: &Model,
    together: &Together,
    layers: &[Layer],
    goal: &[Lit],
    fuel: &Fuel<'_>,
) -> Option<Formula> {
    let mut clauses = Clauses::new();
    let variables: Vec<Variables> = layers
        .iter()
        .map(|layer| Variables {
            lits: layer.lits.iter().map(|_| clauses.variable()).collect(),
            operators: layer.operators.iter().map(|_| clauses.variable()).collect(),
            events: layer.events.iter().map(|_| clauses.variable()).collect(),
        })
        .collect();
    for (layer, own) in layers.iter().zip(&variables) {
        derivations(&mut clauses, model, layer, own);
        exclusive_values(&mut clauses, model, layer, own);
    }
    // A plan whose windows are looked at may have come to its start by operators that no shortest schedule needs,
    // and to facts that are apart without them.
    if model.apart(&layers[0].lits).next().is_none() {
        for (layer, own) in layers.iter().zip(&variables) {
            model.apart(&layer.lits).for_each(|(a, b)| clauses.clause([!own.lits[a], !own.lits[b]]));
        }
    }
    // The first layer's literals are those that hold at the start.
    variables[0].lits.iter().for_each(|&lit| clauses.clause([lit]));
    let mut last_done: Vec<(usize, Option<Bool>)> = together.in_vain(goal).map(|set| (set, None)).collect();
    for step in 0..layers.len() - 1 {
        let mut builder = Step {
            clauses: &mut clauses,
            model,
            together,
            layer: &layers[step],
            own: &variables[step],
            threateners: BTreeMap::new(),
            one_of: BTreeMap::new(),
            threatening: BTreeMap::new(),
            relying: BTreeMap::new(),
            pieces: BTreeMap::new(),
        };
        let makers = builder.makers(&layers[step + 1]);
        builder.one_action_each(&makers);
        builder.requirements();
        builder.frame(&layers[step + 1], &variables[step + 1], &makers);
        for (set, last) in &mut last_done {
            *last = Some(builder.nothing_in_vain(*set, *last));
        }
        if clauses.size() > fuel.size || fuel.stopped() {
            return None;
        }
    }
    last_done.iter().filter_map(|(_, last)| *last).for_each(|last| clauses.clause([!last]));
    let last = layers.len() - 1;
    for goal in goal {
        let at = layers[last].lits.binary_search(goal).ok();
        clauses.clause(at.map(|at| variables[last].lits[at]));
    }
    let operators = layers.iter().zip(&variables);
    let operators =
        operators.map(|(l, v)| l.operators.iter().copied().zip(v.operators.iter().copied()).collect());
    Some(Formula { operators: operators.collect(), clauses })
}

/// A derived literal needs one of its bodies.
fn derivations(clauses: &mut Clauses, model: &Model, layer: &Layer, own: &Variables) {
    for (lit, &variable) in layer.lits.iter().zip(&own.lits) {
        let Some(bodies) = model.derivations.get(&lit.0) else { continue };
        if bodies.iter().any(Vec::is_empty) {
            continue;
        }
        let mut one_of = vec![!variable];
        for body in bodies {
            let at: Option<Vec<Bool>> =
                body.iter().map(|l| layer.lits.binary_search(l).ok().map(|at| own.lits[at])).collect();
            match at.as_deref() {
                None => {}
                Some([only]) => one_of.push(*only),
                Some(all) => {
                    let holds = clauses.variable();
                    all.iter().for_each(|&l| clauses.clause([!holds, l]));
                    one_of.push(holds);
                }
            }
        }
        clauses.clause(one_of);
    }
}

/// Implied by the rest, but it lets the solver see at once that a thing is in one place only.
fn exclusive_values(clauses: &mut Clauses, model: &Model, layer: &Layer, own: &Variables) {
    for group in &model.groups {
        let values: Vec<Bool> = group
            .iter()
            .filter_map(|lit| layer.lits.binary_search(lit).ok().map(|at| own.lits[at]))
            .collect();
        clauses.at_most_one(&values);
    }
}

/// One step, from a layer to the next.
pub(super) struct Step<'a> {
    pub clauses: &'a mut Clauses,
    pub model: &'a Model,
    pub layer: &'a Layer,
    own: &'a Variables,
    /// Whose operators of this step might undo a literal.
    threateners: BTreeMap<Lit, Rc<[u32]>>,
    together: &'a Together,
    /// For a set of operators: one of it is done.
    one_of: BTreeMap<usize, Bool>,
    /// For a literal before the step and an agent: the agent does something that might undo it.
    threatening: BTreeMap<(Lit, u32), Bool>,
    /// For a literal before the step and an agent: the agent's action relies on it.
    relying: BTreeMap<(Lit, u32), Bool>,
    /// For several operators of an agent: it does one of them.
    pub pieces: BTreeMap<Vec<u32>, Bool>,
}

impl Step<'_> {
    pub fn operator(&self, operator: u32) -> Option<Bool> {
        self.layer.operators.binary_search(&operator).ok().map(|at| self.own.operators[at])
    }

    fn event(&self, event: u32) -> Option<Bool> {
        self.layer.events.binary_search(&event).ok().map(|at| self.own.events[at])
    }

    fn requirements(&mut self) {
        for (&operator, &variable) in self.layer.operators.iter().zip(&self.own.operators) {
            let agent = self.model.agent_of[operator as usize];
            for &lit in self.model.preconditions.row(operator as usize) {
                if let Some(relies) = self.relies(lit, agent) {
                    self.clauses.clause([!variable, relies]);
                }
            }
        }
        for (&event, &variable) in self.layer.events.iter().zip(&self.own.events) {
            let event = &self.model.events[event as usize];
            let Some(operator) = self.operator(event.operator) else { continue };
            self.clauses.clause([!variable, operator]);
            let agent = self.model.agent_of[event.operator as usize];
            for &lit in &event.condition {
                if let Some(relies) = self.relies(lit, agent) {
                    self.clauses.clause([!variable, relies]);
                }
            }
        }
    }

    /// That the agent's action relies on the literal, which nobody else may then threaten in this step.
    /// `None` if the layer does not have the literal.
    pub fn relies(&mut self, lit: Lit, agent: u32) -> Option<Bool> {
        let at = self.layer.lits.binary_search(&lit).ok()?;
        let holds = self.own.lits[at];
        if let Some(&known) = self.relying.get(&(lit, agent)) {
            return Some(known);
        }
        let others: Vec<u32> = self.threatening_agents(lit).iter().copied().filter(|&a| a != agent).collect();
        if others.is_empty() {
            self.relying.insert((lit, agent), holds);
            return Some(holds);
        }
        let relies = self.clauses.variable();
        self.relying.insert((lit, agent), relies);
        self.clauses.clause([!relies, holds]);
        for other in others {
            let threatens = self.threatens(lit, other);
            self.clauses.clause([!relies, !threatens]);
        }
        Some(relies)
    }

    fn threatening_agents(&mut self, lit: Lit) -> Rc<[u32]> {
        if let Some(known) = self.threateners.get(&lit) {
            return Rc::clone(known);
        }
        let threats = self.model.threats[lit.index()].iter();
        let mut agents: Vec<u32> = threats
            .filter(|t| self.operator(t.operator).is_some())
            .map(|t| self.model.agent_of[t.operator as usize])
            .collect();
        agents.sort_unstable();
        agents.dedup();
        let agents: Rc<[u32]> = agents.into();
        self.threateners.insert(lit, Rc::clone(&agents));
        agents
    }

    /// That the agent does something that might undo the literal, for all it knows.
    fn threatens(&mut self, lit: Lit, agent: u32) -> Bool {
        if let Some(&known) = self.threatening.get(&(lit, agent)) {
            return known;
        }
        let threatens = self.clauses.variable();
        self.threatening.insert((lit, agent), threatens);
        let model = self.model;
        for threat in model.threats[lit.index()].iter() {
            if model.agent_of[threat.operator as usize] != agent {
                continue;
            }
            let Some(operator) = self.operator(threat.operator) else { continue };
            let mut clause = vec![!operator, threatens];
            clause.extend(threat.harmless_if.iter().filter_map(|&l| self.relies(l, agent)));
            self.clauses.clause(clause);
        }
        threatens
    }

    /// What holds after the step: what was made so, or was so and was not undone.
    fn frame(&mut self, after: &Layer, next: &Variables, makers: &Makers) {
        for ((&lit, &variable), makers) in after.lits.iter().zip(&next.lits).zip(makers) {
            if self.model.is_derived(lit) {
                continue;
            }
            let mut support = vec![!variable];
            support.extend(self.layer.lits.binary_search(&lit).ok().map(|at| self.own.lits[at]));
            for operators in makers {
                support.extend(self.piece(operators));
            }
            for maker in &self.model.makers[lit.index()] {
                if let Maker::Event(event) = *maker {
                    support.extend(self.event(event));
                }
            }
            self.clauses.clause(support);
            self.keep(lit, variable);
        }
    }

    /// Nothing in the step may undo the literal, unless the same action makes it good.
    fn keep(&mut self, lit: Lit, variable: Bool) {
        let model = self.model;
        if model.events.is_empty() {
            // Nothing makes good and nothing excuses: whoever threatens undoes.
            for &agent in self.threatening_agents(lit).iter() {
                let threatens = self.threatens(lit, agent);
                self.clauses.clause([!variable, !threatens]);
            }
            return;
        }
        let mut sets: Vec<usize> = Vec::new();
        for threat in model.threats[lit.index()].iter() {
            let Some(operator) = self.operator(threat.operator) else { continue };
            if threat.harmless_if.is_empty()
                && let Some(set) = self.together.settling(threat.operator, lit)
            {
                if !sets.contains(&set) {
                    sets.push(set);
                    self.keep_from(lit, variable, set);
                }
                continue;
            }
            let agent = model.agent_of[threat.operator as usize];
            let mut clause = vec![!variable, !operator];
            let events = model.events_of[threat.operator as usize].clone();
            let makers = &model.makers[lit.index()];
            let good = events.filter(|&e| makers.binary_search(&Maker::Event(e)).is_ok());
            clause.extend(good.filter_map(|e| self.event(e)));
            clause.extend(threat.harmless_if.iter().filter_map(|&l| self.relies(l, agent)));
            self.clauses.clause(clause);
        }
    }

    /// If one of the set is done, the literal holds afterwards only if that makes it so.
    fn keep_from(&mut self, lit: Lit, variable: Bool, set: usize) {
        let model = self.model;
        let mut clause = vec![!variable, !self.one_of(set)];
        for maker in &model.makers[lit.index()] {
            let operator = model.operator_of(*maker);
            if !self.together.is_of(operator, set) {
                continue;
            }
            let undoes = |t: &Threat| t.operator == operator && t.harmless_if.is_empty();
            clause.extend(match *maker {
                Maker::Operator(_) if model.threats[lit.index()].iter().any(undoes) => None,
                Maker::Operator(operator) => self.operator(operator),
                Maker::Event(event) => self.event(event),
            });
        }
        self.clauses.clause(clause);
    }

    /// That one of the set is done.
    fn one_of(&mut self, set: usize) -> Bool {
        if let Some(&known) = self.one_of.get(&set) {
            return known;
        }
        let one = self.clauses.variable();
        self.one_of.insert(set, one);
        for &operator in &self.together.sets[set] {
            if let Some(operator) = self.operator(operator) {
                self.clauses.clause([!operator, one]);
            }
        }
        one
    }

    /// Nothing is done in vain: `last` says that the last thing that the agent of a set did is of the set, before the
    /// step and, as returned, after it.
    fn nothing_in_vain(&mut self, set: usize, last: Option<Bool>) -> Bool {
        let one = self.one_of(set);
        let after = self.clauses.variable();
        self.clauses.clause([!one, after]);
        if let Some(last) = last {
            self.clauses.clause([!last, !one]);
            let agent = self.model.agent_of[self.together.sets[set][0] as usize];
            let operators = self.layer.operators.iter().zip(&self.own.operators);
            let others = operators.filter(|&(&operator, _)| {
                self.model.agent_of[operator as usize] == agent && !self.together.is_of(operator, set)
            });
            let clause: Vec<Bool> = [!last, after].into_iter().chain(others.map(|(_, &v)| v)).collect();
            self.clauses.clause(clause);
        }
        after
    }
}
