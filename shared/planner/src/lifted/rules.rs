//! From actions, axioms and the goal to rules.

use lamma_pddl::Name;
use lamma_pddl::ast::{Domain, Init, Problem};

use super::metric::Metric;
use super::resolve::{Scope, change_variables, formula, free_variables};
use super::{
    Applied, Body, Change, ConditionalChange, Formula, Head, Lifted, LiftedAtom, Role, Rule, Schema, Symbols,
    Term, describe, effects, metric,
};
use crate::ground::GroundError;

/// An action is split into at most this many variants by its disjunctions; beyond that, and under nested
/// quantifiers, a disjunction becomes a derived predicate.
const MAX_VARIANTS: usize = 4;

/// Resolves a task and writes it as rules.
pub(crate) fn lift(domain: &Domain, problem: &Problem) -> Result<Lifted, GroundError> {
    let symbols = Symbols::new(domain, problem)?;
    let mut lifter = Lifter { symbols, rules: Vec::new(), explained: Vec::new() };
    let (metric, warnings) = match metric::metric(&mut lifter.symbols, domain, problem)? {
        Ok(metric) => (metric, Vec::new()),
        Err(warning) => (None, vec![warning]),
    };
    let has_costs = metric.is_some();
    let metric = metric.unwrap_or_default();
    let mut schemas = Vec::with_capacity(domain.actions.len());
    for (index, action) in domain.actions.iter().enumerate() {
        schemas.push(lifter.action(index as u32, action, &metric)?);
    }
    for axiom in &domain.axioms {
        let mut scope = Scope::default();
        let slots = scope.open(&mut lifter.symbols, &axiom.head.params);
        let predicate = lifter.symbols.predicate(&axiom.head.name, slots.len())?;
        let body = formula(&mut lifter.symbols, &mut scope, &axiom.body, true, 0)?;
        let head = LiftedAtom { predicate, args: slots.iter().map(|&s| Term::Variable(s)).collect() };
        lifter.define(head, slots, body, &scope);
    }
    let mut scope = Scope::default();
    let goal = formula(&mut lifter.symbols, &mut scope, &problem.goal, true, 0)?;
    let mut goal_body = Body { variables: scope.ranges.clone(), ..Body::default() };
    lifter.conjoin(goal, &scope, &mut goal_body);
    let (mut init, mut values) = (Vec::new(), Vec::new());
    for fact in &problem.init {
        let (Init::Fact(atom) | Init::Value(atom, _)) = fact;
        let args = atom.args.iter().map(|a| lifter.symbols.object(a)).collect::<Result<Vec<_>, _>>()?;
        match fact {
            Init::Fact(_) => init.push((lifter.symbols.predicate(&atom.predicate, args.len())?, args)),
            Init::Value(_, value) => {
                values.push((lifter.symbols.function(&atom.predicate, args.len())?, args, value.value()));
            }
        }
    }
    let text = |part: &Formula| describe::formula(part, &lifter.symbols, &scope.names);
    let goal_foralls = goal_body.foralls.iter().map(text).collect();
    let Lifter { symbols, rules, explained } = lifter;
    Ok(Lifted {
        symbols,
        schemas,
        rules,
        goal: goal_body,
        goal_foralls,
        init,
        values,
        has_costs,
        warnings,
        explained,
    })
}

/// Builds the rules.
pub(super) struct Lifter {
    pub symbols: Symbols,
    pub rules: Vec<Rule>,
    explained: Vec<(u32, String)>,
}

impl Lifter {
    fn action(
        &mut self,
        index: u32,
        action: &lamma_pddl::ast::Action,
        metric: &Metric,
    ) -> Result<Schema, GroundError> {
        let mut scope = Scope::default();
        let params = scope.open(&mut self.symbols, &action.params);
        let precondition = formula(&mut self.symbols, &mut scope, &action.precondition, true, 0)?;
        let effects::Parts { plain, conditional, cost } = effects::split(self, &mut scope, action, metric)?;
        for body in self.bodies(precondition, &scope, params.clone(), false) {
            self.rules.push(Rule { head: Head::Act { action: index }, body });
        }
        let mut applied = Vec::new();
        let mut changes = Vec::with_capacity(conditional.len());
        for (effect, (quantified, condition, change)) in conditional.into_iter().enumerate() {
            let mut asked = free_variables(&condition);
            asked.extend(change_variables(&change));
            let asked: Vec<u32> = params.iter().copied().filter(|param| asked.contains(param)).collect();
            let at = self.applied(&mut applied, &action.name, asked);
            let Applied { predicate, params: asked } = &applied[at];
            let reached = LiftedAtom {
                predicate: *predicate,
                args: asked.iter().map(|&param| Term::Variable(param)).collect(),
            };
            let bound = asked.iter().chain(&quantified).copied().collect();
            for mut body in self.bodies(condition, &scope, bound, true) {
                if let Change::Delete(atom) = &change {
                    // "Deleted if it holds" is "deleted".
                    body.atoms.retain(|asked| asked != atom);
                    body.atoms.insert(0, atom.clone());
                }
                body.atoms.insert(0, reached.clone());
                self.rules.push(Rule { head: Head::Effect { action: index, effect: effect as u32 }, body });
            }
            changes.push(ConditionalChange { change, applied: at });
        }
        Ok(Schema {
            name: action.name.clone(),
            params: params.len(),
            applied,
            effects: plain,
            conditional: changes,
            cost,
        })
    }

    /// The place in `known` of "the action was reached" with these parameters.
    fn applied(&mut self, known: &mut Vec<Applied>, action: &Name, params: Vec<u32>) -> usize {
        known.iter().position(|applied| applied.params == params).unwrap_or_else(|| {
            let name = format!("@{action}{}", known.len());
            let predicate = self.symbols.fresh_predicate(name, params.len(), Role::Applied);
            known.push(Applied { predicate, params });
            known.len() - 1
        })
    }

    /// Makes `condition` define the derived atom `head`.
    fn define(&mut self, head: LiftedAtom, bound: Vec<u32>, condition: Formula, scope: &Scope) {
        let parts = match condition {
            Formula::Or(parts) => parts,
            single => vec![single],
        };
        for part in parts {
            for body in self.bodies(part, scope, bound.clone(), true) {
                self.rules.push(Rule { head: Head::Derived(head.clone()), body });
            }
        }
    }

    /// A derived atom over the free variables of `condition` that holds where it holds.
    fn derive(&mut self, condition: Formula, scope: &Scope) -> LiftedAtom {
        let free = free_variables(&condition);
        let text = describe::formula(&condition, &self.symbols, &scope.names);
        let name = format!("@condition{}", self.explained.len());
        let predicate = self.symbols.fresh_predicate(name, free.len(), Role::Derived);
        self.explained.push((predicate, text));
        let head = LiftedAtom { predicate, args: free.iter().map(|&slot| Term::Variable(slot)).collect() };
        self.define(head.clone(), free, condition, scope);
        head
    }

    /// The bodies whose disjunction is `condition`. `existential`: an instance may bind more variables than
    /// asked for, so that existential quantifiers become further variables of the rule.
    fn bodies(&mut self, condition: Formula, scope: &Scope, bound: Vec<u32>, existential: bool) -> Vec<Body> {
        let body = Body { variables: scope.ranges.clone(), bound, ..Body::default() };
        let mut finished = Vec::new();
        let mut open = vec![(body, vec![condition])];
        while let Some((mut body, parts)) = open.pop() {
            let mut complex = Vec::new();
            let mut agenda = parts;
            agenda.reverse();
            while let Some(part) = agenda.pop() {
                match part {
                    Formula::And(inner) => agenda.extend(inner.into_iter().rev()),
                    Formula::Or(_) | Formula::Exists(..) => complex.push(part),
                    simple => self.conjoin(simple, scope, &mut body),
                }
            }
            match complex.pop() {
                None => finished.push(body),
                Some(Formula::Exists(slots, inner)) if existential && complex.is_empty() => {
                    body.bound.extend(slots);
                    open.push((body, vec![*inner]));
                }
                Some(Formula::Or(choices)) if finished.len() + open.len() + choices.len() <= MAX_VARIANTS => {
                    for choice in choices {
                        let mut parts = complex.clone();
                        parts.push(choice);
                        open.push((body.clone(), parts));
                    }
                }
                Some(other) => {
                    let atom = self.derive(other, scope);
                    body.atoms.push(atom);
                    open.push((body, complex));
                }
            }
        }
        finished.retain(|body| !body.never);
        finished
    }

    /// Adds a condition to a body; disjunctions and existential quantifiers become derived atoms.
    fn conjoin(&mut self, condition: Formula, scope: &Scope, body: &mut Body) {
        match condition {
            Formula::And(parts) => parts.into_iter().for_each(|part| self.conjoin(part, scope, body)),
            Formula::Literal { atom, positive: true } => body.atoms.push(atom),
            Formula::Literal { atom, positive: false } => body.absent.push(atom),
            Formula::Equal { left, right, positive } => body.equal.push((left, right, positive)),
            Formula::Compare(comparison) => body.comparisons.push(comparison),
            Formula::Forall(..) => body.foralls.push(condition),
            Formula::Or(parts) if parts.is_empty() => body.never = true,
            Formula::Or(_) | Formula::Exists(..) => {
                let atom = self.derive(condition, scope);
                body.atoms.push(atom);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use lamma_pddl::{Source, parse_domain, parse_problem};

    #[test]
    fn an_effect_begins_with_the_parameters_it_depends_on() {
        let domain = "(define (domain d) (:requirements :adl) (:predicates (at ?r ?p) (lit ?p) (seen ?r ?p))
            (:action go :parameters (?r ?from ?to) :precondition (at ?r ?from)
              :effect (and (forall (?p) (when (at ?r ?p) (not (at ?r ?p)))) (at ?r ?to)
                           (when (lit ?to) (seen ?r ?to)) (forall (?p) (when (lit ?p) (seen ?r ?p))))))";
        let problem = "(define (problem p) (:domain d) (:objects a b) (:init (at a b)) (:goal (at a a)))";
        let domain = parse_domain(&Source::new("domain", domain)).expect("a domain").value;
        let problem = parse_problem(&Source::new("problem", problem)).expect("a problem").value;
        let lifted = super::lift(&domain, &problem).expect("a task");
        let schema = &lifted.schemas[0];
        let params: Vec<&[u32]> = schema.applied.iter().map(|applied| &applied.params[..]).collect();
        assert_eq!(params, [&[0][..], &[0, 2]]);
        let groups: Vec<usize> = schema.conditional.iter().map(|effect| effect.applied).collect();
        assert_eq!(groups, [0, 1, 0]);
    }
}
