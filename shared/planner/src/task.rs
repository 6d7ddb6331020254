//! The grounded task: finite-domain variables, operators and axioms; states packed into words.

use std::collections::BTreeMap;
use std::fmt;

use lamma_pddl::Name;
use lamma_pddl::ast::GroundAtom;

use crate::csr::Csr;
use crate::numeric::{Numeric, NumericEffect};
use crate::plan::{GroundAct, Literal, Plan};

/// A variable having a value. The facts of a variable have consecutive numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FactId(pub u32);

/// An operator: an action with its arguments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct OperatorId(pub u32);

impl From<FactId> for u64 {
    fn from(fact: FactId) -> u64 {
        u64::from(fact.0)
    }
}

impl FactId {
    /// As an index.
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl OperatorId {
    /// As an index.
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A variable and where its value stands in a packed state.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// Its first fact.
    pub first: FactId,
    /// The number of its values.
    pub size: u32,
    pub(crate) word: u32,
    pub(crate) shift: u32,
    /// The mask of the value before shifting.
    pub(crate) mask: u64,
}

impl Variable {
    /// The fact that holds in `state`.
    #[inline]
    pub fn fact(&self, state: &[u64]) -> FactId {
        FactId(self.first.0 + (state[self.word as usize] >> self.shift & self.mask) as u32)
    }
}

/// A fact with what is needed to test and to set it.
#[derive(Clone, Copy, Debug)]
pub struct Fact {
    /// The variable's number.
    pub variable: u32,
    pub(crate) word: u32,
    pub(crate) mask: u64,
    pub(crate) bits: u64,
    /// The atom (as in [`Names::atoms`]) and whether it holds; `None` where the fact says only that none of
    /// several atoms does.
    pub(crate) atom: Option<(u32, bool)>,
}

impl Fact {
    #[inline]
    pub(crate) fn holds(&self, state: &[u64]) -> bool {
        state[self.word as usize] & self.mask == self.bits
    }
    #[inline]
    pub(crate) fn set(&self, state: &mut [u64]) {
        let word = &mut state[self.word as usize];
        *word = *word & !self.mask | self.bits;
    }
}

/// An operator's name and cost.
#[derive(Clone, Copy, Debug)]
pub struct Operator {
    /// What it costs, as the problem's metric says; 1 where there are no action costs.
    pub cost: f64,
    /// The cost as search counts it.
    pub(crate) units: u32,
    pub(crate) schema: u32,
    pub(crate) args: u32,
}

/// An effect that happens where its condition held before.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ConditionalEffect {
    /// A row of [`Task::effect_conditions`].
    pub condition: u32,
    pub fact: FactId,
}

/// Sets some bits of one word.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Write {
    pub word: u32,
    pub clear: u64,
    pub set: u64,
}

/// `head` holds where all of the body do.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axiom {
    pub head: FactId,
    /// A row of [`Task::axiom_bodies`].
    pub body: u32,
}

/// The names behind the numbers.
#[derive(Debug, Default)]
pub(crate) struct Names {
    pub objects: Vec<Name>,
    pub predicates: Vec<Name>,
    pub schemas: Vec<(Name, usize)>,
    /// Predicate and arguments of each atom, or the text of a condition.
    pub atoms: Vec<AtomText>,
    pub args: Vec<u32>,
}

/// What an atom is called.
#[derive(Clone, Debug)]
pub(crate) enum AtomText {
    Atom { predicate: u32, args: std::ops::Range<u32> },
    Condition(String),
}

/// A state, packed: the values of all variables in a few words.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct State(pub Box<[u64]>);

/// A grounded planning task.
#[derive(Debug, Default)]
pub struct Task {
    pub(crate) names: Names,
    /// The finite-domain variables; the derived ones come last.
    pub variables: Vec<Variable>,
    /// All facts, by number.
    pub facts: Vec<Fact>,
    /// All operators, by number.
    pub operators: Vec<Operator>,
    pub(crate) preconditions: Csr<FactId>,
    /// Unconditional effects.
    pub(crate) effects: Csr<FactId>,
    /// The same, merged into words.
    pub(crate) writes: Csr<Write>,
    /// Conditional effects; those that make an atom false come first, as PDDL orders them.
    pub(crate) conditional: Csr<ConditionalEffect>,
    pub(crate) effect_conditions: Csr<FactId>,
    /// Grouped into layers: evaluating layer by layer gives the values of all derived variables.
    pub(crate) axioms: Vec<Axiom>,
    pub(crate) axiom_bodies: Csr<FactId>,
    pub(crate) axiom_layers: Vec<std::ops::Range<usize>>,
    /// Where axioms are recursive: for each fact the axioms that ask for it.
    pub(crate) waiting_axioms: Option<Csr<u32>>,
    /// Bits of the derived variables by word, to clear before evaluating axioms.
    pub(crate) derived_masks: Vec<(usize, u64)>,
    /// The number of variables that axioms do not define.
    pub(crate) primary_variables: usize,
    /// Sets of facts of which at most one ever holds, of whatever variables.
    pub(crate) exclusive: Csr<FactId>,
    /// The initial state.
    pub init: Vec<u64>,
    /// The goal: facts that must hold together.
    pub goal: Vec<FactId>,
    /// Parts of the goal that can never hold, found while grounding. Not empty: no plan exists.
    pub impossible: Vec<String>,
    /// Whether operators have costs of their own.
    pub has_costs: bool,
    /// What the search does otherwise than the task asks, for people: a metric it does not minimise.
    pub warnings: Vec<String>,
    pub(crate) numeric: Numeric,
    pub(crate) words: usize,
}

impl Task {
    /// The number of words of a packed state.
    pub fn state_words(&self) -> usize {
        self.words
    }

    /// The initial state.
    pub fn initial_state(&self) -> State {
        State(self.init.clone().into_boxed_slice())
    }

    /// The facts that must hold for an operator to apply.
    #[inline]
    pub fn preconditions(&self, operator: OperatorId) -> &[FactId] {
        self.preconditions.row(operator.index())
    }

    /// The facts that an operator makes true whenever it is applied.
    #[inline]
    pub fn effects(&self, operator: OperatorId) -> &[FactId] {
        self.effects.row(operator.index())
    }

    /// The facts that an operator makes true under a condition: the condition and the fact.
    pub fn conditional_effects(&self, operator: OperatorId) -> impl Iterator<Item = (&[FactId], FactId)> {
        let effects = self.conditional.row(operator.index());
        effects.iter().map(|effect| (self.effect_conditions.row(effect.condition as usize), effect.fact))
    }

    /// Whether a fact holds in a state.
    #[inline]
    pub fn holds(&self, state: &[u64], fact: FactId) -> bool {
        self.facts[fact.index()].holds(state)
    }

    /// Whether an operator can be applied in a state.
    pub fn applicable(&self, state: &[u64], operator: OperatorId) -> bool {
        self.preconditions(operator).iter().all(|&fact| self.holds(state, fact))
            && self.has_results(state, operator)
    }

    /// Whether all that an operator does to numbers has a result: an operator that would divide by zero, or
    /// read a number without a value, does not apply.
    #[inline]
    pub(crate) fn has_results(&self, state: &[u64], operator: OperatorId) -> bool {
        if !self.numeric.fallible.get(operator.index()).is_some_and(|&fallible| fallible) {
            return true;
        }
        let mut numbers = self.numeric.of(state).to_vec();
        self.numeric_effects(state, operator, &mut numbers)
    }

    /// Applies what an operator does to numbers; false where something of that has no result.
    fn numeric_effects(&self, state: &[u64], operator: OperatorId, numbers: &mut [u64]) -> bool {
        let before = self.numeric.of(state);
        let happens = |effect: &&NumericEffect| {
            let condition = self.effect_conditions.row(effect.condition as usize);
            condition.iter().all(|&fact| self.holds(state, fact))
        };
        let mut defined = true;
        for effect in self.numeric.effects_of(operator.index()).iter().filter(happens) {
            let number = &mut numbers[effect.target as usize];
            let operand = effect.value.value(before);
            let result = NumericEffect::result(effect.op, f64::from_bits(*number), operand);
            defined &= !result.is_nan();
            *number = result.to_bits();
        }
        defined
    }

    /// Whether the task has numbers that change and are asked for.
    pub fn has_numbers(&self) -> bool {
        !self.numeric.initial.is_empty()
    }

    /// The words of a state that hold variables; numbers come after them.
    pub(crate) fn packed_words(&self) -> usize {
        self.numeric.base
    }

    /// Whether a state reaches the goal.
    #[inline]
    pub fn is_goal(&self, state: &[u64]) -> bool {
        self.goal.iter().all(|&fact| self.holds(state, fact))
    }

    /// Writes into `next` the state after `operator` in `state`.
    #[inline]
    pub fn apply(&self, state: &[u64], operator: OperatorId, next: &mut [u64]) {
        next.copy_from_slice(state);
        for write in self.writes.row(operator.index()) {
            let word = &mut next[write.word as usize];
            *word = *word & !write.clear | write.set;
        }
        for effect in self.conditional.row(operator.index()) {
            let condition = self.effect_conditions.row(effect.condition as usize);
            if condition.iter().all(|&fact| self.holds(state, fact)) {
                self.facts[effect.fact.index()].set(next);
            }
        }
        if self.has_numbers() {
            self.numeric_effects(state, operator, &mut next[self.numeric.base..]);
        }
        if !self.axioms.is_empty() || !self.numeric.comparisons.is_empty() {
            self.evaluate_axioms(next);
        }
    }

    /// Gives the derived variables their values (Thiébaux, Hoffmann & Nebel 2005, "In defense of PDDL
    /// axioms", section 2: layer by layer, each to its least fixpoint).
    pub(crate) fn evaluate_axioms(&self, state: &mut [u64]) {
        for &(word, mask) in &self.derived_masks {
            state[word] &= !mask;
        }
        for (fact, comparison) in &self.numeric.comparisons {
            if comparison.holds(&state[self.numeric.base..]) {
                self.facts[fact.index()].set(state);
            }
        }
        for layer in &self.axiom_layers {
            let mut new = Vec::new();
            for axiom in layer.clone() {
                if self.fire(axiom, state) && self.waiting_axioms.is_some() {
                    new.push(self.axioms[axiom].head);
                }
            }
            // Recursive axioms: only those that wait for something new can fire again.
            let Some(waiting) = &self.waiting_axioms else { continue };
            while let Some(fact) = new.pop() {
                for axiom in waiting.row(fact.index()).iter().map(|&axiom| axiom as usize) {
                    if layer.contains(&axiom) && self.fire(axiom, state) {
                        new.push(self.axioms[axiom].head);
                    }
                }
            }
        }
    }

    /// Makes an axiom's head true if its body holds; whether that is new.
    #[inline]
    fn fire(&self, axiom: usize, state: &mut [u64]) -> bool {
        let axiom = &self.axioms[axiom];
        let head = &self.facts[axiom.head.index()];
        let body = self.axiom_bodies.row(axiom.body as usize);
        let new = !head.holds(state) && body.iter().all(|&fact| self.holds(state, fact));
        if new {
            head.set(state);
        }
        new
    }

    /// The action an operator stands for, with the spelling of the declarations.
    pub fn act(&self, operator: OperatorId) -> GroundAct {
        let operator = &self.operators[operator.index()];
        let (name, params) = &self.names.schemas[operator.schema as usize];
        let args = &self.names.args[operator.args as usize..operator.args as usize + params];
        GroundAct {
            action: name.clone(),
            args: args.iter().map(|&object| self.names.objects[object as usize].clone()).collect(),
        }
    }

    /// The plan that applies `operators` in order.
    pub fn plan(&self, operators: &[OperatorId]) -> Plan {
        Plan {
            acts: operators.iter().map(|&operator| self.act(operator)).collect(),
            cost: operators.iter().map(|&operator| self.operators[operator.index()].cost).sum(),
        }
    }

    /// The state that operators lead to, one after the other, which all apply.
    pub(crate) fn after(&self, from: &[u64], operators: &[OperatorId]) -> Vec<u64> {
        let (mut state, mut next) = (from.to_vec(), from.to_vec());
        for &operator in operators {
            self.apply(&state, operator, &mut next);
            std::mem::swap(&mut state, &mut next);
        }
        state
    }

    /// Whether operators can be carried out one after the other from a state, and lead to the goal.
    pub(crate) fn leads_to(&self, from: &[u64], operators: &[OperatorId], goal: &[FactId]) -> bool {
        let (mut state, mut next) = (from.to_vec(), from.to_vec());
        for &operator in operators {
            if !self.applicable(&state, operator) {
                return false;
            }
            self.apply(&state, operator, &mut next);
            std::mem::swap(&mut state, &mut next);
        }
        goal.iter().all(|&fact| self.holds(&state, fact))
    }

    /// The operators that carry out a plan from the initial state; `None` if some step has none that applies.
    pub fn trace(&self, plan: &Plan) -> Option<Vec<OperatorId>> {
        let object = |name: &Name| self.names.objects.iter().position(|n| n == name).map(|at| at as u32);
        let mut keys: Vec<(&Name, Vec<u32>)> = Vec::with_capacity(plan.acts.len());
        for act in &plan.acts {
            keys.push((&act.action, act.args.iter().map(object).collect::<Option<_>>()?));
        }
        let mut called: BTreeMap<(&Name, &[u32]), Vec<OperatorId>> =
            keys.iter().map(|(name, args)| ((*name, args.as_slice()), Vec::new())).collect();
        for (index, operator) in self.operators.iter().enumerate() {
            let (name, params) = &self.names.schemas[operator.schema as usize];
            let args = &self.names.args[operator.args as usize..operator.args as usize + params];
            if let Some(same) = called.get_mut(&(name, args)) {
                same.push(OperatorId(index as u32));
            }
        }
        let (mut state, mut next) = (self.init.clone(), self.init.clone());
        let mut operators = Vec::with_capacity(keys.len());
        for (name, args) in &keys {
            let same = &called[&(*name, args.as_slice())];
            let operator = *same.iter().find(|&&operator| self.applicable(&state, operator))?;
            self.apply(&state, operator, &mut next);
            std::mem::swap(&mut state, &mut next);
            operators.push(operator);
        }
        Some(operators)
    }

    /// The atom a fact is about and whether it holds; `None` for facts no text names: a derived condition,
    /// or "none of several atoms holds".
    pub fn literal(&self, fact: FactId) -> Option<Literal> {
        let (atom, holds) = self.facts[fact.index()].atom?;
        match &self.names.atoms[atom as usize] {
            AtomText::Condition(_) => None,
            AtomText::Atom { predicate, args } => {
                let args = &self.names.args[args.start as usize..args.end as usize];
                let atom = GroundAtom {
                    predicate: self.names.predicates[*predicate as usize].clone(),
                    args: args.iter().map(|&object| self.names.objects[object as usize].clone()).collect(),
                };
                Some(Literal { atom, holds })
            }
        }
    }

    /// A fact as text.
    pub fn fact_text(&self, fact: FactId) -> String {
        if let Some(literal) = self.literal(fact) {
            let args: String = literal.atom.args.iter().map(|arg| format!(" {arg}")).collect();
            let text = format!("({}{args})", literal.atom.predicate);
            return if literal.holds { text } else { format!("(not {text})") };
        }
        match self.facts[fact.index()].atom {
            Some((atom, holds)) => match &self.names.atoms[atom as usize] {
                AtomText::Condition(text) if holds => text.clone(),
                AtomText::Condition(text) => format!("(not {text})"),
                AtomText::Atom { .. } => String::new(),
            },
            None => format!("none of the values of variable {}", self.facts[fact.index()].variable),
        }
    }

    /// The facts of all variables in a state.
    pub(crate) fn facts_of<'a>(&'a self, state: &'a [u64]) -> impl Iterator<Item = FactId> + 'a {
        self.variables.iter().map(|variable| variable.fact(state))
    }
}

impl fmt::Display for Task {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} variables, {} facts, {} operators, {} axioms, {} words a state",
            self.variables.len(),
            self.facts.len(),
            self.operators.len(),
            self.axioms.len(),
            self.words
        )
    }
}
