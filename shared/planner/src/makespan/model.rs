//! The team's task as the formulas see it: literals, what makes them true, and what might undo them.

use std::collections::BTreeMap;

use crate::csr::Csr;
use crate::task::{FactId, OperatorId, Task};

/// A literal: a fact, or that a fact of a variable with several values does not hold. (That a fact of a
/// two-valued variable does not hold is the other fact.)
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Lit(pub u32);

impl Lit {
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A conditional effect of an operator: what it makes true where its condition holds.
#[derive(Debug)]
pub(super) struct Event {
    pub operator: u32,
    /// Beyond the operator's precondition; not empty.
    pub condition: Vec<Lit>,
}

/// What makes a literal true.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Maker {
    Operator(u32),
    Event(u32),
}

/// How an operator might undo a literal.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Threat {
    pub operator: u32,
    /// Where any of these holds, it does not.
    pub harmless_if: Vec<Lit>,
}

/// The task in terms of literals.
#[derive(Debug)]
pub(super) struct Model {
    pub agents: usize,
    /// Whose each operator is.
    pub agent_of: Vec<u32>,
    pub preconditions: Csr<Lit>,
    pub events: Vec<Event>,
    /// The events of each operator are consecutive.
    pub events_of: Vec<std::ops::Range<u32>>,
    pub makers: Vec<Vec<Maker>>,
    pub threats: Vec<Vec<Threat>>,
    /// For derived facts: the conditions of which one must hold.
    pub derivations: BTreeMap<u32, Vec<Vec<Lit>>>,
    pub goal: Vec<Lit>,
    /// Which literals hold at the start.
    pub initially: Vec<bool>,
    /// The literals of each variable with more than two values, at most one of which holds, and of other such sets.
    pub groups: Vec<Vec<Lit>>,
    /// For each literal, others that never hold with it, beyond the values of its variable; each pair once. No rows if
    /// nothing is known.
    apart: Csr<Lit>,
    facts: usize,
    variable_of: Vec<u32>,
    /// Whether each fact is of a variable with more than two values.
    many: Vec<bool>,
    /// Facts that need no support, because they are not tracked: that a derived fact does not hold, and
    /// comparisons of numbers.
    free: Vec<bool>,
}

impl Model {
    pub fn new(task: &Task, agent_of: &[u32]) -> Self {
        let facts = task.facts.len();
        let mut model = Model {
            agents: agent_of.iter().max().map_or(0, |&a| a as usize + 1),
            agent_of: agent_of.to_vec(),
            preconditions: Csr::default(),
            events: Vec::new(),
            events_of: Vec::with_capacity(task.operators.len()),
            makers: vec![Vec::new(); 2 * facts],
            threats: vec![Vec::new(); 2 * facts],
            derivations: BTreeMap::new(),
            goal: Vec::new(),
            initially: vec![false; 2 * facts],
            groups: Vec::new(),
            apart: Csr::default(),
            facts,
            variable_of: task.facts.iter().map(|fact| fact.variable).collect(),
            many: task.facts.iter().map(|f| task.variables[f.variable as usize].size > 2).collect(),
            free: vec![false; facts],
        };
        for variable in &task.variables[task.primary_variables..] {
            model.free[variable.first.index()] = true;
        }
        for (fact, _) in &task.numeric.comparisons {
            model.free[fact.index()] = true;
        }
        for fact in (0..facts as u32).map(FactId) {
            let holds = task.holds(&task.init, fact);
            model.initially[fact.index()] = holds;
            model.initially[facts + fact.index()] = !holds;
        }
        for variable in task.variables[..task.primary_variables].iter().filter(|v| v.size > 2) {
            model.groups.push((0..variable.size).map(|value| Lit(variable.first.0 + value)).collect());
        }
        // Where actions have conditions of their own, these cost more than they help.
        if task.conditional.items().is_empty() {
            let variable = |fact: &FactId| task.facts[fact.index()].variable;
            let of_several =
                |group: &&[FactId]| group.windows(2).any(|two| variable(&two[0]) != variable(&two[1]));
            let groups = task.exclusive.rows().filter(of_several);
            model.groups.extend(groups.map(|group| group.iter().map(|fact| Lit(fact.0)).collect()));
        }
        for operator in (0..task.operators.len() as u32).map(OperatorId) {
            model.operator(task, operator);
        }
        for list in &mut model.makers {
            list.sort_unstable();
            list.dedup();
        }
        for list in &mut model.threats {
            list.sort_unstable();
            list.dedup();
        }
        for axiom in &task.axioms {
            let body = model.literals(task.axiom_bodies.row(axiom.body as usize));
            model.derivations.entry(axiom.head.0).or_default().push(body);
        }
        model.goal = model.literals(&task.goal);
        model
    }

    /// The number of literals there might be.
    pub fn literals_count(&self) -> usize {
        self.makers.len()
    }

    /// Whether axioms define the literal.
    pub fn is_derived(&self, lit: Lit) -> bool {
        self.derivations.contains_key(&lit.0)
    }

    /// The operator that a maker is or belongs to.
    pub fn operator_of(&self, maker: Maker) -> u32 {
        match maker {
            Maker::Operator(operator) => operator,
            Maker::Event(event) => self.events[event as usize].operator,
        }
    }

    /// Whether these are different values of one variable.
    pub fn excludes(&self, a: Lit, b: Lit) -> bool {
        let variable = |lit: Lit| self.variable_of.get(lit.index());
        a != b && variable(a).is_some() && variable(a) == variable(b)
    }

    /// Notes literals that never hold together.
    pub fn put_apart(&mut self, pairs: &[(Lit, Lit)]) {
        self.apart = Csr::from_pairs(self.literals_count(), pairs.iter().map(|&(a, b)| (a.0, b)));
    }

    /// The pairs of these literals, by position, that never hold together, beyond the values of one variable; `lits` in order.
    pub fn apart<'a>(&'a self, lits: &'a [Lit]) -> impl Iterator<Item = (usize, usize)> + 'a {
        let known = lits.iter().enumerate().filter(|(_, lit)| lit.index() < self.apart.len());
        known.flat_map(move |(at, lit)| {
            let others = self.apart.row(lit.index()).iter();
            others.filter_map(move |other| Some((at, lits.binary_search(other).ok()?)))
        })
    }

    /// The fact that the literal is about.
    pub fn fact_of(&self, lit: Lit) -> u32 {
        if lit.index() < 2 * self.facts { lit.0 % self.facts as u32 } else { lit.0 }
    }

    /// The value that does not hold where this literal does, of a variable with several.
    pub fn denied(&self, lit: Lit) -> Option<Lit> {
        let negated = self.facts..2 * self.facts;
        negated.contains(&lit.index()).then(|| Lit(lit.0 - self.facts as u32))
    }

    /// Whether the literal is a value of a variable with more than two.
    pub fn is_one_of_many(&self, lit: Lit) -> bool {
        self.many.get(lit.index()).is_some_and(|&many| many)
    }

    /// Whether one of these may take the other's place as far as their variables go: a variable with more than two
    /// values has one at a time.
    pub fn alike(&self, lit: Lit, twin: Lit) -> bool {
        let variable = |lit: Lit| self.variable_of.get(self.fact_of(lit) as usize);
        !self.is_one_of_many(twin) || variable(lit) == variable(twin)
    }

    /// Whether the literal holds in a state.
    pub fn holds(&self, task: &Task, state: &[u64], lit: Lit) -> bool {
        match lit.index().checked_sub(self.facts) {
            None => task.holds(state, FactId(lit.0)),
            Some(fact) => !task.holds(state, FactId(fact as u32)),
        }
    }

    /// The facts as conditions; what needs no support is left out.
    pub fn literals(&self, facts: &[FactId]) -> Vec<Lit> {
        facts.iter().filter(|fact| !self.free[fact.index()]).map(|fact| Lit(fact.0)).collect()
    }

    /// That the literal does not hold.
    pub fn negation(&self, task: &Task, lit: Lit) -> Lit {
        let variable = &task.variables[task.facts[lit.index()].variable as usize];
        match variable.size {
            2 => Lit(2 * variable.first.0 + 1 - lit.0),
            _ => Lit(lit.0 + self.facts as u32),
        }
    }

    fn operator(&mut self, task: &Task, operator: OperatorId) {
        let before = self.literals(task.preconditions(operator));
        self.preconditions.push_row(before.iter().copied());
        let mut conditional: BTreeMap<Vec<FactId>, Vec<FactId>> = BTreeMap::new();
        for (condition, fact) in task.conditional_effects(operator) {
            conditional.entry(condition.to_vec()).or_default().push(fact);
        }
        for &fact in task.effects(operator) {
            self.effect(task, operator, &[], fact, Maker::Operator(operator.0));
        }
        let start = self.events.len() as u32;
        for (condition, facts) in conditional {
            let event = self.events.len() as u32;
            let lits = self.literals(&condition);
            for fact in facts {
                let maker = if lits.is_empty() { Maker::Operator(operator.0) } else { Maker::Event(event) };
                self.effect(task, operator, &condition, fact, maker);
            }
            if !lits.is_empty() {
                self.events.push(Event { operator: operator.0, condition: lits });
            }
        }
        self.events_of.push(start..self.events.len() as u32);
    }

    /// The variable of `fact` takes that value where `condition` holds: one literal becomes true, and its
    /// other values false.
    fn effect(
        &mut self,
        task: &Task,
        operator: OperatorId,
        condition: &[FactId],
        fact: FactId,
        maker: Maker,
    ) {
        let number = task.facts[fact.index()].variable;
        let variable = task.variables[number as usize];
        let same = |f: &&FactId| task.facts[f.index()].variable == number;
        let from = condition.iter().find(same).or_else(|| task.preconditions(operator).iter().find(same));
        self.makers[fact.index()].push(maker);
        let values = (variable.first.0..variable.first.0 + variable.size).map(FactId);
        for value in values.filter(|&value| value != fact && from.is_none_or(|&from| from == value)) {
            if variable.size > 2 {
                self.makers[self.facts + value.index()].push(maker);
            }
            let threat = self.threat(task, operator, condition, Some(value));
            self.threats[value.index()].extend(threat);
        }
        if variable.size > 2 {
            let threat = self.threat(task, operator, condition, None);
            self.threats[self.facts + fact.index()].extend(threat);
        }
    }

    /// The effect does no harm where part of its condition fails; that the value it would undo fails is no
    /// excuse. Effects that hang on derived facts are not held against anybody: what is left out here makes
    /// the bound weaker, never wrong.
    fn threat(
        &self,
        task: &Task,
        operator: OperatorId,
        condition: &[FactId],
        undone: Option<FactId>,
    ) -> Option<Threat> {
        let derived = |fact: &FactId| task.facts[fact.index()].variable as usize >= task.primary_variables;
        if condition.iter().any(derived) {
            return None;
        }
        let excuses = condition.iter().filter(|&&fact| Some(fact) != undone);
        let harmless_if = excuses.map(|fact| self.negation(task, Lit(fact.0))).collect();
        Some(Threat { operator: operator.0, harmless_if })
    }
}
