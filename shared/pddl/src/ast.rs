//! The abstract syntax tree of PDDL domains and problems: what was written, resolved no further.
//!
//! Grounding, search, the plain interpreter, the printer and the checker share this and nothing else.

use crate::name::Name;

/// A name with the types it may have. No type means `object`; several mean `(either …)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TypedName {
    /// The variable (without its `?`), object, constant or type.
    pub name: Name,
    /// Its types, or for a type its supertypes.
    pub types: Vec<Name>,
    /// Set for names inside `(:private …)`: the agent they belong to, or an empty private block.
    pub private_to: Option<Private>,
}

impl TypedName {
    /// `name` of the type `of`.
    pub fn new(name: impl Into<Name>, of: impl Into<Name>) -> Self {
        TypedName { name: name.into(), types: vec![of.into()], private_to: None }
    }
}

/// Who a declaration in a `(:private …)` block belongs to (MA-PDDL, Kovács 2012; CoDMAP 2015).
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Private {
    /// A factored file: private to the one agent the file is for.
    Owner,
    /// An unfactored problem names the agent: `(:private truck1 …)`.
    Agent(Name),
    /// An unfactored domain names a variable and its type: `(:private ?agent - truck …)`.
    Variable(Box<TypedName>),
}

/// A constant or a variable.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Term {
    /// An object or a domain constant.
    Constant(Name),
    /// `?x`, without the question mark.
    Variable(Name),
}

/// A predicate over terms.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Atom {
    /// The predicate.
    pub predicate: Name,
    /// Its arguments.
    pub args: Vec<Term>,
}

/// A predicate over objects.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GroundAtom {
    /// The predicate.
    pub predicate: Name,
    /// Its arguments.
    pub args: Vec<Name>,
}

impl GroundAtom {
    /// `(predicate args…)`.
    pub fn new(predicate: impl Into<Name>, args: impl IntoIterator<Item = impl Into<Name>>) -> Self {
        GroundAtom { predicate: predicate.into(), args: args.into_iter().map(Into::into).collect() }
    }
}

/// A goal description: a condition on one state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Condition {
    /// All of them; empty means true.
    And(Vec<Condition>),
    /// Any of them; empty means false.
    Or(Vec<Condition>),
    /// Not this.
    Not(Box<Condition>),
    /// If the first then the second.
    Imply(Box<Condition>, Box<Condition>),
    /// For some values of the variables.
    Exists(Vec<TypedName>, Box<Condition>),
    /// For all values of the variables.
    Forall(Vec<TypedName>, Box<Condition>),
    /// The atom holds.
    Atom(Atom),
    /// `(= a b)` between objects.
    Equal(Term, Term),
    /// A comparison of numbers.
    Compare(Comparison, NumericExpr, NumericExpr),
}

impl Condition {
    /// The condition that always holds.
    pub const TRUE: Condition = Condition::And(Vec::new());
}

/// An effect. Of one action, all deletes happen before all adds (PDDL 2.1, Fox & Long 2003, section 6).
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Effect {
    /// All of them.
    And(Vec<Effect>),
    /// For all values of the variables.
    Forall(Vec<TypedName>, Box<Effect>),
    /// Only where the condition held before the action.
    When(Condition, Box<Effect>),
    /// The atom becomes true.
    Add(Atom),
    /// The atom becomes false.
    Delete(Atom),
    /// A number changes.
    Assign(AssignOp, FunctionTerm, NumericExpr),
}

/// How a number changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AssignOp {
    /// `(assign f e)`
    Assign,
    /// `(increase f e)`
    Increase,
    /// `(decrease f e)`
    Decrease,
    /// `(scale-up f e)`
    ScaleUp,
    /// `(scale-down f e)`
    ScaleDown,
}

/// How two numbers compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `=`
    Equal,
    /// `>=`
    GreaterEqual,
    /// `>`
    Greater,
}

/// A numeric function over terms, such as `(fuel ?truck)` or `(total-cost)`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct FunctionTerm {
    /// The function.
    pub function: Name,
    /// Its arguments.
    pub args: Vec<Term>,
}

/// A number, or how to work one out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NumericExpr {
    /// A literal, kept as it was written so that the tree can be compared and printed exactly.
    Number(Decimal),
    /// The value of a function.
    Function(FunctionTerm),
    /// Two or more terms; a single operand under `-` is negation.
    Operation(ArithmeticOp, Vec<NumericExpr>),
}

/// An arithmetic operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArithmeticOp {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
}

/// A decimal literal: its spelling, and equality by spelling.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Decimal(pub String);

impl Decimal {
    /// The nearest double; literals are checked when they are read, so this does not fail on parsed text.
    pub fn value(&self) -> f64 {
        self.0.parse().unwrap_or(f64::NAN)
    }
}

/// A predicate or numeric function and the types of its parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signature {
    /// The predicate or function.
    pub name: Name,
    /// Its parameters.
    pub params: Vec<TypedName>,
    /// Set inside `(:private …)`.
    pub private_to: Option<Private>,
}

/// An action schema.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Action {
    /// Its name.
    pub name: Name,
    /// `:agent ?a - type` (MA-PDDL): the parameter that acts. It is also the first of `params`.
    pub agent: Option<TypedName>,
    /// All parameters.
    pub params: Vec<TypedName>,
    /// When it may be done.
    pub precondition: Condition,
    /// What it does. Of a durative action: all its effects, at its end.
    pub effect: Effect,
    /// Set for durative actions.
    pub duration: Option<NumericExpr>,
}

/// `(:derived (p ?x) condition)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axiom {
    /// The derived predicate over its variables.
    pub head: Signature,
    /// When it holds.
    pub body: Condition,
}

/// A domain.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Domain {
    /// Its name.
    pub name: Name,
    /// Declared requirements, with their colon: `:strips`.
    pub requirements: Vec<Name>,
    /// Types with their supertypes. `object` need not be listed.
    pub types: Vec<TypedName>,
    /// Constants.
    pub constants: Vec<TypedName>,
    /// Predicates.
    pub predicates: Vec<Signature>,
    /// Numeric functions.
    pub functions: Vec<Signature>,
    /// Action schemas, in order.
    pub actions: Vec<Action>,
    /// Derived predicates.
    pub axioms: Vec<Axiom>,
}

/// A fact or number that holds at the start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Init {
    /// The atom is true.
    Fact(GroundAtom),
    /// `(= (f a b) 7)`.
    Value(GroundAtom, Decimal),
}

/// What to minimise or maximise.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Metric {
    /// True for `minimize`.
    pub minimize: bool,
    /// Of which expression.
    pub expression: NumericExpr,
}

/// A problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Its name.
    pub name: Name,
    /// The domain it says it is for.
    pub domain: Name,
    /// Objects beside the domain's constants.
    pub objects: Vec<TypedName>,
    /// What holds at the start.
    pub init: Vec<Init>,
    /// What shall hold at the end.
    pub goal: Condition,
    /// `(:metric …)`.
    pub metric: Option<Metric>,
}
