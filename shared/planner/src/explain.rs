//! Why a fact can never become true, in words a person can act on: what nobody adds, what `:init` lacks.
//!
//! This looks at the lifted task only and follows one cause after the other, so it may find none where the true
//! one is a matter of many objects; what it does say holds.

use std::collections::BTreeSet;

use lamma_pddl::Name;
use lamma_pddl::ast::{
    AssignOp, Atom, Comparison, Condition, Domain, Effect, FunctionTerm, GroundAtom, Init, NumericExpr,
    Problem, Term, TypedName,
};

/// Causes are followed so far.
const MAX_DEPTH: usize = 6;

/// The cause of a fact's never becoming true, as a clause to stand behind the fact; `None` where no single one
/// is found.
pub fn explain_unreachable(domain: &Domain, problem: &Problem, fact: &GroundAtom) -> Option<String> {
    let wanted = Atom {
        predicate: fact.predicate.clone(),
        args: fact.args.iter().cloned().map(Term::Constant).collect(),
    };
    let explainer = Explainer { domain, problem };
    explainer.why_not(&wanted, &mut BTreeSet::new(), 0)
}

struct Explainer<'a> {
    domain: &'a Domain,
    problem: &'a Problem,
}

/// What makes a fact true: an action or a rule.
struct Maker<'a> {
    name: String,
    params: &'a [TypedName],
    needs: &'a Condition,
    /// The fact as the maker names it.
    head: Atom,
}

impl<'a> Explainer<'a> {
    /// Why no instance of the atom (its variables stand for any object) ever holds.
    fn why_not(&self, atom: &Atom, seen: &mut BTreeSet<Name>, depth: usize) -> Option<String> {
        if depth > MAX_DEPTH || self.stated(atom) || !seen.insert(atom.predicate.clone()) {
            return None;
        }
        let makers = self.makers(&atom.predicate);
        if makers.is_empty() {
            let known = self.domain.predicates.iter().any(|declared| declared.name == atom.predicate);
            let why = if known {
                "no action adds it and `:init` does not state it"
            } else {
                "the domain does not know it"
            };
            return Some(why.to_owned());
        }
        // One cause for each maker, or it is not the whole story.
        let mut causes = Vec::new();
        for maker in makers {
            let Some(bound) = unify(&maker.head, atom) else { continue };
            let cause = self.obstacle(&maker, &bound, seen, depth)?;
            causes.push(format!("`{}` needs {cause}", maker.name));
        }
        seen.remove(&atom.predicate);
        causes.dedup();
        match causes.len() {
            0 => Some("no action adds it for these objects".into()),
            1..=4 => Some(causes.join("; ")),
            _ => None,
        }
    }

    /// What the maker needs and never gets.
    fn obstacle(
        &self,
        maker: &Maker<'a>,
        bound: &[(Name, Term)],
        seen: &mut BTreeSet<Name>,
        depth: usize,
    ) -> Option<String> {
        for param in maker.params {
            if let Some((_, Term::Constant(object))) = bound.iter().find(|(name, _)| *name == param.name)
                && !self.is_of(object, &param.types)
            {
                let types: Vec<&str> = param.types.iter().map(Name::as_str).collect();
                return Some(format!("a {} for ?{}, and {object} is none", types.join(" or "), param.name));
            }
        }
        let Necessary { atoms, numbers, comparisons } = Necessary::of(maker.needs);
        for function in numbers {
            let term = substitute(&function.args, bound);
            if !self.has_value(&function.function, &term) {
                let shown = FunctionTerm { function: function.function.clone(), args: term };
                return Some(format!("{shown}, which has no value in `:init` and is never assigned one"));
            }
        }
        if let Some(stuck) = comparisons.into_iter().find_map(|compared| self.stuck(compared, bound)) {
            return Some(stuck);
        }
        for atom in atoms {
            let needed = Atom { predicate: atom.predicate.clone(), args: substitute(&atom.args, bound) };
            if let Some(why) = self.why_not(&needed, seen, depth + 1) {
                return Some(format!("{needed} ({why})"));
            }
        }
        None
    }

    /// Whether `:init` has an instance of the atom.
    fn stated(&self, atom: &Atom) -> bool {
        self.problem.init.iter().any(|item| matches!(item, Init::Fact(fact) if matches_ground(atom, fact)))
    }

    fn makers(&self, predicate: &Name) -> Vec<Maker<'a>> {
        let mut makers = Vec::new();
        for action in &self.domain.actions {
            let mut open = vec![&action.effect];
            while let Some(effect) = open.pop() {
                match effect {
                    Effect::And(parts) => open.extend(parts),
                    Effect::Forall(_, inner) | Effect::When(_, inner) => open.push(inner),
                    Effect::Add(head) if head.predicate == *predicate => makers.push(Maker {
                        name: action.name.to_string(),
                        params: &action.params,
                        needs: &action.precondition,
                        head: head.clone(),
                    }),
                    Effect::Add(_) | Effect::Delete(_) | Effect::Assign(..) => {}
                }
            }
        }
        for axiom in self.domain.axioms.iter().filter(|axiom| axiom.head.name == *predicate) {
            let args = axiom.head.params.iter().map(|param| Term::Variable(param.name.clone())).collect();
            makers.push(Maker {
                name: format!(":derived {predicate}"),
                params: &axiom.head.params,
                needs: &axiom.body,
                head: Atom { predicate: predicate.clone(), args },
            });
        }
        makers
    }

    /// Whether the function has a value at some time, for some of the objects the terms leave open.
    fn has_value(&self, function: &Name, args: &[Term]) -> bool {
        let atom = Atom { predicate: function.clone(), args: args.to_vec() };
        let at_first = |item: &Init| matches!(item, Init::Value(of, _) if matches_ground(&atom, of));
        *function == "total-cost" || self.problem.init.iter().any(at_first) || self.is_assigned(function)
    }

    fn is_assigned(&self, function: &Name) -> bool {
        self.domain.actions.iter().any(|action| {
            let mut open = vec![&action.effect];
            while let Some(effect) = open.pop() {
                match effect {
                    Effect::And(parts) => open.extend(parts),
                    Effect::Forall(_, inner) | Effect::When(_, inner) => open.push(inner),
                    Effect::Assign(AssignOp::Assign, target, _) if target.function == *function => {
                        return true;
                    }
                    _ => {}
                }
            }
            false
        })
    }

    /// A comparison of one number with a constant that does not hold at first and that no action brings nearer.
    fn stuck(
        &self,
        compared: (Comparison, &NumericExpr, &NumericExpr),
        bound: &[(Name, Term)],
    ) -> Option<String> {
        let (op, of, constant) = match compared {
            (op, NumericExpr::Function(of), NumericExpr::Number(constant)) => (op, of, constant),
            (op, NumericExpr::Number(constant), NumericExpr::Function(of)) => (flipped(op), of, constant),
            _ => return None,
        };
        let atom = Atom { predicate: of.function.clone(), args: substitute(&of.args, bound) };
        let limit = constant.value();
        let (sign, holds): (_, fn(f64, f64) -> bool) = match op {
            Comparison::Less => ("<", |a, b| a < b),
            Comparison::LessEqual => ("<=", |a, b| a <= b),
            Comparison::Equal => ("=", |a, b| a == b),
            Comparison::GreaterEqual => (">=", |a, b| a >= b),
            Comparison::Greater => (">", |a, b| a > b),
        };
        let at_first = self.problem.init.iter().filter_map(|item| match item {
            Init::Value(of, value) if matches_ground(&atom, of) => Some(value.value()),
            _ => None,
        });
        let values: Vec<f64> = at_first.collect();
        if values.is_empty() || values.iter().any(|&value| holds(value, limit) || !value.is_finite()) {
            return None;
        }
        let rises = values.iter().any(|&value| value <= limit) && op != Comparison::Less;
        let falls = values.iter().any(|&value| value >= limit) && op != Comparison::Greater;
        if (rises && self.moves(&of.function, true)) || (falls && self.moves(&of.function, false)) {
            return None;
        }
        let shown = FunctionTerm { function: of.function.clone(), args: atom.args };
        let verb = if falls { "lowers" } else { "raises" };
        let now = match values[..] {
            [value] => format!("it is {value} at first and "),
            _ => String::new(),
        };
        Some(format!("({sign} {shown} {limit}) ({now}no action {verb} it)"))
    }

    /// Whether some action may raise (or lower) the function.
    fn moves(&self, function: &Name, up: bool) -> bool {
        self.domain.actions.iter().any(|action| {
            let mut open = vec![&action.effect];
            while let Some(effect) = open.pop() {
                match effect {
                    Effect::And(parts) => open.extend(parts),
                    Effect::Forall(_, inner) | Effect::When(_, inner) => open.push(inner),
                    Effect::Assign(op, target, by) if target.function == *function => {
                        let by = match by {
                            NumericExpr::Number(by) => Some(by.value()),
                            _ => None,
                        };
                        let may = match (op, by) {
                            (AssignOp::Increase, Some(by)) => (by > 0.0) == up && by != 0.0,
                            (AssignOp::Decrease, Some(by)) => (by < 0.0) == up && by != 0.0,
                            _ => true,
                        };
                        if may {
                            return true;
                        }
                    }
                    _ => {}
                }
            }
            false
        })
    }

    fn is_of(&self, object: &Name, types: &[Name]) -> bool {
        let declared =
            self.domain.constants.iter().chain(&self.problem.objects).filter(|o| o.name == *object);
        let mut open: Vec<&Name> = declared.flat_map(|o| &o.types).collect();
        let mut seen = BTreeSet::new();
        while let Some(name) = open.pop() {
            if types.contains(name) {
                return true;
            }
            if seen.insert(name) {
                open.extend(self.domain.types.iter().filter(|t| t.name == *name).flat_map(|t| &t.types));
            }
        }
        types.is_empty() || types.iter().any(|name| *name == "object")
    }
}

/// What a condition cannot do without.
#[derive(Default)]
struct Necessary<'c> {
    atoms: Vec<&'c Atom>,
    numbers: Vec<&'c FunctionTerm>,
    comparisons: Vec<(Comparison, &'c NumericExpr, &'c NumericExpr)>,
}

impl<'c> Necessary<'c> {
    fn of(condition: &'c Condition) -> Self {
        let mut found = Necessary::default();
        let mut open = vec![condition];
        while let Some(condition) = open.pop() {
            match condition {
                Condition::And(parts) => open.extend(parts.iter().rev()),
                Condition::Or(parts) if parts.len() == 1 => open.extend(parts),
                Condition::Exists(_, inner) => open.push(inner),
                Condition::Atom(atom) => found.atoms.push(atom),
                Condition::Compare(op, left, right) => {
                    found.comparisons.push((*op, left, right));
                    let mut numeric = vec![left, right];
                    while let Some(part) = numeric.pop() {
                        match part {
                            NumericExpr::Number(_) => {}
                            NumericExpr::Function(function) => found.numbers.push(function),
                            NumericExpr::Operation(_, parts) => numeric.extend(parts),
                        }
                    }
                }
                _ => {}
            }
        }
        found
    }
}

/// The comparison seen from the other side.
fn flipped(op: Comparison) -> Comparison {
    match op {
        Comparison::Less => Comparison::Greater,
        Comparison::LessEqual => Comparison::GreaterEqual,
        Comparison::Equal => Comparison::Equal,
        Comparison::GreaterEqual => Comparison::LessEqual,
        Comparison::Greater => Comparison::Less,
    }
}

/// What the maker's variables stand for when its head is the wanted atom; `None` if it never is.
fn unify(head: &Atom, wanted: &Atom) -> Option<Vec<(Name, Term)>> {
    let mut bound: Vec<(Name, Term)> = Vec::new();
    if head.args.len() != wanted.args.len() {
        return None;
    }
    for (own, other) in head.args.iter().zip(&wanted.args) {
        match (own, other) {
            (Term::Constant(a), Term::Constant(b)) if a != b => return None,
            (Term::Variable(name), Term::Constant(_)) => {
                match bound.iter().find(|(known, _)| known == name) {
                    Some((_, before)) if before != other => return None,
                    Some(_) => {}
                    None => bound.push((name.clone(), other.clone())),
                }
            }
            _ => {}
        }
    }
    Some(bound)
}

/// Terms with what is bound put in; the rest stay variables.
fn substitute(args: &[Term], bound: &[(Name, Term)]) -> Vec<Term> {
    let value = |term: &Term| match term {
        Term::Variable(name) => {
            bound.iter().find(|(known, _)| known == name).map_or(term.clone(), |(_, t)| t.clone())
        }
        Term::Constant(_) => term.clone(),
    };
    args.iter().map(value).collect()
}

fn matches_ground(atom: &Atom, fact: &GroundAtom) -> bool {
    atom.predicate == fact.predicate
        && atom.args.len() == fact.args.len()
        && atom.args.iter().zip(&fact.args).all(|(term, object)| match term {
            Term::Constant(name) => name == object,
            Term::Variable(_) => true,
        })
}

#[cfg(test)]
mod tests {
    use lamma_pddl::{Source, parse_domain, parse_ground_atom, parse_problem};

    use super::*;

    fn why(domain: &str, problem: &str, fact: &str) -> Option<String> {
        let domain =
            parse_domain(&Source::new("d", format!("(define (domain d) {domain})"))).expect("a domain");
        let problem = parse_problem(&Source::new(
            "p",
            format!("(define (problem p) (:domain d) (:goal (and)) {problem})"),
        ))
        .expect("a problem");
        explain_unreachable(&domain.value, &problem.value, &parse_ground_atom(fact).expect("a fact"))
    }

    const DOMAIN: &str = "(:types cup stove) (:predicates (hot ?x) (heats ?y) (on ?y) (at ?x ?y) (lit))
        (:functions (gas ?y))
        (:action heat :parameters (?x - cup ?y - stove) :precondition (and (at ?x ?y) (on ?y)) :effect (hot ?x))
        (:action switch :parameters (?y - stove) :precondition (and (heats ?y) (> (gas ?y) 0)) :effect (on ?y))";
    const OBJECTS: &str = "(:objects c - cup s - stove)";

    #[test]
    fn the_cause_is_followed_to_where_it_lies() {
        let problem = |init: &str| format!("{OBJECTS} (:init {init})");
        assert_eq!(
            why(DOMAIN, &problem("(at c s) (= (gas s) 1)"), "(hot c)").as_deref(),
            Some(
                "`heat` needs (on ?y) (`switch` needs (heats ?y) (no action adds it and `:init` does not state it))"
            )
        );
        assert_eq!(
            why(DOMAIN, &problem("(at c s) (heats s)"), "(hot c)").as_deref(),
            Some(
                "`heat` needs (on ?y) (`switch` needs (gas ?y), which has no value in `:init` and is never assigned one)"
            )
        );
        assert_eq!(
            why(DOMAIN, &problem("(heats s) (= (gas s) 1)"), "(hot c)").as_deref(),
            Some("`heat` needs (at c ?y) (no action adds it and `:init` does not state it)")
        );
        assert_eq!(
            why(DOMAIN, &problem("(heats s)"), "(hot s)").as_deref(),
            Some("`heat` needs a cup for ?x, and s is none")
        );
        assert_eq!(
            why(DOMAIN, &problem("(at c s) (heats s) (= (gas s) 0)"), "(hot c)").as_deref(),
            Some(
                "`heat` needs (on ?y) (`switch` needs (> (gas ?y) 0) (it is 0 at first and no action raises it))"
            )
        );
        assert_eq!(why(DOMAIN, &problem("(at c s) (heats s) (= (gas s) 1)"), "(hot c)"), None, "it can be");
        assert_eq!(why(DOMAIN, &problem(""), "(wet c)").as_deref(), Some("the domain does not know it"));
    }
}
