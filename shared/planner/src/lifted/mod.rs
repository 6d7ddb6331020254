//! The lifted task with names resolved to numbers and conditions in the shape grounding works on: Datalog
//! rules (Helmert 2009, "Concise finite-domain representations for PDDL planning tasks", section 6), where
//! disjunctions and existential quantifiers have become derived predicates and universal quantifiers wait
//! to be expanded on ground level.

mod describe;
mod effects;
mod metric;
mod resolve;
mod rules;
mod symbols;

use lamma_pddl::Name;
use lamma_pddl::ast::{ArithmeticOp, AssignOp, Decimal};

pub(crate) use describe::{compared, formula as describe, sign};
pub(crate) use resolve::free_variables;
pub(crate) use rules::lift;
pub(crate) use symbols::{Range, Symbols};

use crate::numeric::Relation;

/// A variable (a slot of the rule's scope) or an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Term {
    /// The variable in this slot.
    Variable(u32),
    /// The object.
    Object(u32),
}

/// A predicate (or function) over terms.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct LiftedAtom {
    pub predicate: u32,
    pub args: Vec<Term>,
}

/// A condition in negation normal form. `And([])` is true, `Or([])` is false.
#[derive(Clone, Debug)]
pub(crate) enum Formula {
    Literal { atom: LiftedAtom, positive: bool },
    Equal { left: Term, right: Term, positive: bool },
    Compare(LiftedComparison),
    And(Vec<Formula>),
    Or(Vec<Formula>),
    Exists(Vec<u32>, Box<Formula>),
    Forall(Vec<u32>, Box<Formula>),
}

/// A numeric expression over the numeric functions.
#[derive(Clone, Debug)]
pub(crate) enum Expr {
    Number(f64),
    Value(LiftedAtom),
    Operation(ArithmeticOp, Vec<Expr>),
}

/// A comparison of numbers.
#[derive(Clone, Debug)]
pub(crate) struct LiftedComparison {
    pub relation: Relation,
    pub left: Expr,
    pub right: Expr,
}

/// What a predicate is to the task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// No action changes it: its facts are those of the initial state.
    Static,
    /// Actions change it.
    Fluent,
    /// Axioms, or conditions with a disjunction or an existential quantifier, define it.
    Derived,
    /// "This action was reached with these arguments": exists during grounding only.
    Applied,
}

/// The conjunctive body of a rule.
#[derive(Clone, Debug, Default)]
pub(crate) struct Body {
    /// The domain of every slot of the scope the rule comes from.
    pub variables: Vec<u32>,
    /// The slots that an instance of the rule binds, in the order in which an instance lists them.
    pub bound: Vec<u32>,
    /// What must hold.
    pub atoms: Vec<LiftedAtom>,
    /// What must not hold.
    pub absent: Vec<LiftedAtom>,
    /// Which terms are (`true`) or are not (`false`) the same object.
    pub equal: Vec<(Term, Term, bool)>,
    /// Universally quantified conditions.
    pub foralls: Vec<Formula>,
    /// Comparisons of numbers.
    pub comparisons: Vec<LiftedComparison>,
    /// Set if a part of the body can never hold.
    pub never: bool,
}

/// What an instance of a rule's body gives.
#[derive(Clone, Debug)]
pub(crate) enum Head {
    /// The action can be applied.
    Act { action: u32 },
    /// The action's quantified or conditional effect happens. The first atom of the body says that the action
    /// was reached ([`Applied`]). For a delete effect the deleted atom is the second: only what can be true need be
    /// deleted.
    Effect { action: u32, effect: u32 },
    /// The derived atom holds.
    Derived(LiftedAtom),
}

/// A rule.
#[derive(Clone, Debug)]
pub(crate) struct Rule {
    pub head: Head,
    pub body: Body,
}

/// What an effect does.
#[derive(Clone, Debug)]
pub(crate) enum Change {
    Add(LiftedAtom),
    Delete(LiftedAtom),
    /// A number changes.
    Numeric(AssignOp, LiftedAtom, Expr),
}

/// "The action was reached", as far as some of its effects ask: only with the parameters that they depend on. Going
/// somewhere makes a robot leave every other place, wherever it goes: sixty places need sixty instances of that
/// effect, not sixty for each of sixty goals.
#[derive(Clone, Debug)]
pub(crate) struct Applied {
    /// The predicate that stands for it.
    pub predicate: u32,
    /// The slots of its parameters, in ascending order.
    pub params: Vec<u32>,
}

impl Applied {
    /// Its arguments where the action's are `values`, written to `args`.
    pub fn args(&self, values: &[u32], args: &mut Vec<u32>) {
        args.clear();
        args.extend(self.params.iter().map(|&param| values[param as usize]));
    }
}

/// A conditional or quantified effect; its conditions are rules.
#[derive(Clone, Debug)]
pub(crate) struct ConditionalChange {
    pub change: Change,
    /// Which of the schema's [`Schema::applied`] its rules begin with.
    pub applied: usize,
}

/// An action schema without its conditions, which are rules.
#[derive(Clone, Debug)]
pub(crate) struct Schema {
    pub name: Name,
    /// Slots `0..params` of its rules' scopes are the parameters.
    pub params: usize,
    /// What its conditional effects begin with.
    pub applied: Vec<Applied>,
    /// Effects without conditions and quantifiers.
    pub effects: Vec<Change>,
    /// The others; each has one or more rules.
    pub conditional: Vec<ConditionalChange>,
    /// What the action costs; the sum of these.
    pub cost: Vec<Expr>,
}

impl Schema {
    /// Every effect, whether it is conditional, and its place among those that are or are not.
    pub fn changes(&self) -> impl Iterator<Item = (&Change, bool, u32)> {
        let plain = self.effects.iter().zip(0..).map(|(change, at)| (change, false, at));
        plain.chain(self.conditional.iter().zip(0..).map(|(effect, at)| (&effect.change, true, at)))
    }
}

/// The whole lifted task.
#[derive(Debug)]
pub(crate) struct Lifted {
    pub symbols: Symbols,
    pub schemas: Vec<Schema>,
    pub rules: Vec<Rule>,
    /// The goal as one body over no variables.
    pub goal: Body,
    /// The text of each of the goal's universally quantified parts.
    pub goal_foralls: Vec<String>,
    /// Initially true atoms: predicate and objects.
    pub init: Vec<(u32, Vec<u32>)>,
    /// Initial numbers: function and objects.
    pub values: Vec<(u32, Vec<u32>, f64)>,
    /// Whether actions cost what `Schema::cost` says instead of one each.
    pub has_costs: bool,
    /// What the search does otherwise than the task asks, for people.
    pub warnings: Vec<String>,
    /// What each condition that became a derived predicate says, for people.
    pub explained: Vec<(u32, String)>,
}

/// The value of a literal.
pub(crate) fn number(decimal: &Decimal) -> f64 {
    decimal.value()
}
