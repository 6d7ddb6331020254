//! The plain semantics of PDDL: what a state is, when an action may be done, and what it does.
//!
//! This interprets the lifted syntax tree directly and shares nothing with grounding and search but that tree,
//! so that a mistake in either shows as a disagreement. The validator and the simulator trust only this.
//!
//! Semantics: PDDL 2.1 level 2 (Fox & Long 2003) and axioms (Thiébaux, Hoffmann & Nebel 2005). Of one action,
//! all conditions are about the state before it, and all deletes happen before all adds.

mod axioms;
mod condition;
mod error;
mod ground;
mod query;
mod scope;
mod state;

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use lamma_pddl::Name;
use lamma_pddl::ast::{Action, Condition, Domain, Init, NumericExpr, TypedName};

pub(crate) use condition::operate;
pub use condition::{GroundCondition, GroundExpr};
pub use error::{ActError, InterpretError, Unmet, Violation};
pub use ground::{GroundAction, GroundEffect, Outcome};
pub use state::{Change, WorldState};

use crate::plan::GroundAct;
use crate::travel::Travel;
use axioms::Axioms;
use ground::Grounder;
use state::View;

/// Pairs of an object and a type it is of.
const MAX_MEMBERS: usize = 16 << 20;

/// A domain and typed objects, with every name resolved once.
#[derive(Clone, Debug)]
pub struct Interpreter {
    actions: BTreeMap<Name, Action>,
    predicates: BTreeMap<Name, usize>,
    functions: BTreeMap<Name, usize>,
    /// The objects of each type, those of its subtypes included, in the order of declaration.
    types: BTreeMap<Name, Vec<Name>>,
    /// Each object with all types it is of.
    objects: BTreeMap<Name, Vec<Name>>,
    axioms: Axioms,
    travel: Option<Arc<Travel>>,
}

impl Interpreter {
    /// The domain's constants and the given objects. An object that is also a constant is of both types.
    pub fn new(domain: &Domain, objects: &[TypedName]) -> Result<Self, InterpretError> {
        let signatures = |list: &[lamma_pddl::ast::Signature]| {
            list.iter().map(|s| (s.name.clone(), s.params.len())).collect::<BTreeMap<_, _>>()
        };
        let declared: Vec<&TypedName> = domain.constants.iter().chain(objects).collect();
        let types = objects_by_type(&domain.types, &declared)?;
        let mut objects: BTreeMap<Name, Vec<Name>> = BTreeMap::new();
        for (name, members) in &types {
            members.iter().for_each(|m| objects.entry(m.clone()).or_default().push(name.clone()));
        }
        let mut interpreter = Interpreter {
            actions: domain.actions.iter().map(|action| (action.name.clone(), action.clone())).collect(),
            predicates: signatures(&domain.predicates),
            functions: signatures(&domain.functions),
            types,
            objects,
            axioms: Axioms::named(&domain.axioms),
            travel: None,
        };
        interpreter.check_domain(domain)?;
        interpreter.axioms = Axioms::new(&domain.axioms, &interpreter)?;
        Ok(interpreter)
    }

    /// The same where going takes as long as the way is.
    pub fn with_travel(mut self, travel: Option<Arc<Travel>>) -> Self {
        self.travel = travel;
        self
    }

    /// The initial state. Without a value, `(total-cost)` is 0.
    pub fn initial(&self, init: &[Init]) -> Result<WorldState, InterpretError> {
        let mut state = WorldState::default();
        let total_cost = Name::new("total-cost");
        if self.functions.get(&total_cost) == Some(&0) {
            let no_args: [Name; 0] = [];
            state.values.insert(lamma_pddl::ast::GroundAtom::new(total_cost, no_args), 0.0);
        }
        for item in init {
            match item {
                Init::Fact(atom) => {
                    self.check_ground(&self.predicates, "predicate", atom)?;
                    if self.axioms.derives(&atom.predicate) {
                        return Err(InterpretError::DerivedEffect { predicate: atom.predicate.clone() });
                    }
                    state.facts.insert(atom.clone());
                }
                Init::Value(function, value) => {
                    self.check_ground(&self.functions, "function", function)?;
                    state.values.insert(function.clone(), value.value());
                }
            }
        }
        Ok(state)
    }

    /// The objects of a type and its subtypes, in the order of declaration; none for an unknown type.
    pub fn objects_of(&self, type_name: &Name) -> impl Iterator<Item = &Name> {
        self.types.get(type_name).into_iter().flatten()
    }

    /// The ground action that `act` names.
    pub fn instantiate(&self, act: &GroundAct) -> Result<GroundAction, ActError> {
        let action = self.actions.get(&act.action).ok_or_else(|| self.unknown_action(act))?;
        if action.params.len() != act.args.len() {
            return Err(ActError::WrongArity {
                act: act.clone(),
                expected: action.params.len(),
                found: act.args.len(),
            });
        }
        for (param, arg) in action.params.iter().zip(&act.args) {
            self.check_argument(act, param, arg)?;
        }
        let bindings = action.params.iter().map(|p| p.name.clone()).zip(act.args.iter().cloned()).collect();
        Grounder::new(self, bindings)
            .action(action, act)
            .ok_or_else(|| ActError::TooLarge { act: act.clone() })
    }

    fn unknown_action(&self, act: &GroundAct) -> ActError {
        let nearest = lamma_pddl::suggest::nearest(act.action.as_str(), self.actions.keys()).cloned();
        ActError::UnknownAction { action: act.action.clone(), nearest }
    }

    fn check_argument(&self, act: &GroundAct, param: &TypedName, arg: &Name) -> Result<(), ActError> {
        let Some(types) = self.objects.get(arg) else {
            let nearest = lamma_pddl::suggest::nearest(arg.as_str(), self.objects.keys()).cloned();
            return Err(ActError::UnknownObject { act: act.clone(), object: arg.clone(), nearest });
        };
        if !param.types.is_empty() && !param.types.iter().any(|t| types.contains(t)) {
            let param = Box::new(param.clone());
            return Err(ActError::WrongType { act: act.clone(), object: arg.clone(), param });
        }
        Ok(())
    }

    /// A closed condition: quantifiers expanded, in negation normal form, `(= a b)` evaluated.
    pub fn ground_condition(&self, condition: &Condition) -> Result<GroundCondition, InterpretError> {
        self.check_condition(condition, &mut Vec::new())?;
        Grounder::new(self, Vec::new()).condition(condition, true).ok_or(InterpretError::TooLarge)
    }

    /// A number without variables.
    pub fn ground_expression(&self, expression: &NumericExpr) -> Result<GroundExpr, InterpretError> {
        self.check_expression(expression, &Vec::new())?;
        Ok(Grounder::new(self, Vec::new()).expression(expression))
    }

    /// Whether the condition holds, with what follows from the state by the axioms.
    pub fn holds(&self, state: &WorldState, condition: &GroundCondition) -> bool {
        condition.holds_in(&self.view(state))
    }

    /// Whether the action may be done.
    pub fn check(&self, state: &WorldState, action: &GroundAction) -> Result<(), Violation> {
        self.check_in(&self.view(state), action)
    }

    fn check_in(&self, view: &View<'_>, action: &GroundAction) -> Result<(), Violation> {
        let unmet = action.precondition.unmet(view);
        if unmet.is_empty() { Ok(()) } else { Err(Violation { act: action.act.clone(), unmet }) }
    }

    /// Does the action. On a violation the state stays as it was.
    pub fn apply(&self, state: &mut WorldState, action: &GroundAction) -> Result<Change, Violation> {
        let effects = {
            let view = self.view(state);
            self.check_in(&view, action)?;
            action.evaluate(&view)?
        };
        Ok(state.change(effects))
    }

    /// How long the action takes when it begins in this state; 1 where neither the domain nor a [`Travel`] says
    /// anything.
    pub fn duration(&self, state: &WorldState, action: &GroundAction) -> Result<f64, Violation> {
        let going = self.travel.as_ref().and_then(|travel| travel.duration(&state.facts, &action.act));
        if let Some(duration) = going {
            return Ok(duration);
        }
        let fault = |unmet| Violation { act: action.act.clone(), unmet: vec![unmet] };
        action.duration.value(&state.values).map_err(fault)
    }

    /// The parts of a condition that do not hold; none if it holds.
    pub fn missing(&self, state: &WorldState, goal: &GroundCondition) -> Vec<Unmet> {
        goal.unmet(&self.view(state))
    }

    /// Whether the domain has derived predicates.
    pub fn has_axioms(&self) -> bool {
        !self.axioms.is_empty()
    }

    fn view<'a>(&self, state: &'a WorldState) -> View<'a> {
        View { state, derived: self.axioms.consequences(self, state) }
    }

    /// The objects of any of the types; no type means all.
    fn of_types(&self, types: &[Name]) -> Cow<'_, [Name]> {
        let of_type = |name: &Name| self.types.get(name).map_or(&[][..], Vec::as_slice);
        match types {
            [] => Cow::Borrowed(of_type(&Name::new("object"))),
            [one] => Cow::Borrowed(of_type(one)),
            several => {
                let mut seen = BTreeSet::new();
                let all = several.iter().flat_map(of_type);
                Cow::Owned(all.filter(|object| seen.insert(*object)).cloned().collect())
            }
        }
    }
}

/// Which objects each type has, through its subtypes.
fn objects_by_type(
    types: &[TypedName],
    objects: &[&TypedName],
) -> Result<BTreeMap<Name, Vec<Name>>, InterpretError> {
    let root = Name::new("object");
    let mut supertypes: BTreeMap<&Name, Vec<&Name>> = BTreeMap::from([(&root, Vec::new())]);
    for declared in types {
        supertypes.entry(&declared.name).or_default().extend(&declared.types);
        // A supertype that is not declared itself is declared by this.
        for name in &declared.types {
            supertypes.entry(name).or_default();
        }
    }
    let mut by_type: BTreeMap<Name, Vec<Name>> =
        supertypes.keys().map(|name| ((*name).clone(), Vec::new())).collect();
    let mut members: BTreeSet<(&Name, &Name)> = BTreeSet::new();
    for object in objects {
        let mut open: Vec<&Name> = object.types.iter().collect();
        open.push(&root);
        while let Some(name) = open.pop() {
            let Some(above) = supertypes.get(name) else {
                return Err(InterpretError::UnknownType { name: name.clone() });
            };
            // Also what ends the walk in a circle of types.
            if members.insert((name, &object.name)) {
                if members.len() > MAX_MEMBERS {
                    return Err(InterpretError::TooLarge);
                }
                by_type.entry(name.clone()).or_default().push(object.name.clone());
                open.extend(above);
            }
        }
    }
    Ok(by_type)
}

#[cfg(test)]
mod tests;
