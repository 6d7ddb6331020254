//! The team as planning sees it: ⟨agents, domain, objects⟩, each agent with its own domain.

use std::collections::BTreeMap;
use std::sync::Arc;

use lamma_pddl::Name;
use lamma_pddl::ast::{Atom, Condition, Domain, Effect, GroundAtom, Init, Signature, Term, TypedName};
use lamma_planner::interpreter::{InterpretError, Interpreter};
use lamma_planner::partial_order::TeamStep;
use lamma_planner::travel::Travel;
use lamma_planner::{GroundAct, Plan};

/// A robot of the team.
#[derive(Clone, Debug)]
pub struct Member {
    /// The object that stands for it in the world.
    pub name: Name,
    /// Its own domain; the actions in it are its skills. Its first parameter is the one who acts.
    pub domain: Arc<Domain>,
}

impl Member {
    /// Whether it has the skill.
    pub fn can(&self, action: &Name) -> bool {
        self.domain.actions.iter().any(|a| a.name == *action)
    }
}

/// Facts that are not so, and what one would have to say if they stood between the team and its goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Relaxation {
    /// "Box_1 weighs 3 kg; the strongest of the team lifts 2.1 kg".
    pub reason: String,
    /// Static facts that would remove the obstacle.
    pub facts: Vec<GroundAtom>,
    /// Predicates of which no action may make a fact false any more: what would be used up lasts.
    pub kept: Vec<Name>,
}

/// The team and the world it acts in.
#[derive(Clone, Debug)]
pub struct Team {
    /// In roster order.
    pub members: Vec<Member>,
    /// The domain of all skills.
    pub domain: Arc<Domain>,
    /// All objects, members among them.
    pub objects: Vec<TypedName>,
    /// Obstacles that can be named when a goal is out of reach.
    pub relaxations: Vec<Relaxation>,
    /// The values of numeric functions at the start.
    pub numbers: Vec<Init>,
    /// Facts by which the world itself says that a member has a skill, per action; none where the members'
    /// domains alone say so.
    pub skill_facts: BTreeMap<Name, Vec<GroundAtom>>,
    /// How long going takes, where it takes its time.
    pub travel: Option<Arc<Travel>>,
}

fn skill_predicate(action: &Name) -> Name {
    Name::new(format!("has-skill-{action}"))
}

impl Team {
    /// The plain semantics of what the team can do.
    pub fn interpreter(&self) -> Result<Interpreter, InterpretError> {
        Ok(Interpreter::new(&self.domain, &self.objects)?.with_travel(self.travel.clone()))
    }

    /// The index of the member with that name.
    pub fn member(&self, name: &Name) -> Option<usize> {
        self.members.iter().position(|m| m.name == *name)
    }

    /// A plan of the team as steps, each with who does it: its first argument.
    pub fn steps(&self, interpreter: &Interpreter, plan: &Plan) -> Result<Vec<TeamStep>, String> {
        let step = |act: &GroundAct| {
            let agent = act.args.first().and_then(|name| self.member(name));
            let agent = agent.ok_or_else(|| format!("nobody of the team does {act}"))?;
            let action = interpreter.instantiate(act).map_err(|e| e.to_string())?;
            Ok(TeamStep { agent, action: Arc::new(action) })
        };
        plan.acts.iter().map(step).collect()
    }

    /// Whether the atom speaks of a member other than `me` (or of any, for `None`).
    pub fn mentions_other(&self, atom: &GroundAtom, me: Option<&Name>) -> bool {
        atom.args.iter().any(|arg| Some(arg) != me && self.member(arg).is_some())
    }

    /// The domain of the team as one actor: every action asks for its skill, so that each member does only
    /// what it can. The skills of `available` members come as facts beside it;
    /// actions that nobody has the skill for stay, and never apply.
    pub fn joint(&self, available: &[usize]) -> (Domain, Vec<GroundAtom>) {
        let mut domain = (*self.domain).clone();
        let mut facts = Vec::new();
        for action in &mut domain.actions {
            let predicate = skill_predicate(&action.name);
            let Some(actor) = action.params.first() else { continue };
            let skill = Atom { predicate: predicate.clone(), args: vec![Term::Variable(actor.name.clone())] };
            let precondition = std::mem::replace(&mut action.precondition, Condition::TRUE);
            action.precondition = Condition::And(vec![Condition::Atom(skill), precondition]);
            domain.predicates.push(Signature {
                name: predicate.clone(),
                params: vec![actor.clone()],
                private_to: None,
            });
            for &m in available {
                if self.members[m].can(&action.name) {
                    facts.push(GroundAtom::new(predicate.clone(), [self.members[m].name.clone()]));
                }
            }
        }
        (domain, facts)
    }

    /// The same team where no action makes facts of these predicates false.
    pub fn keeping(&self, kept: &[Name]) -> Team {
        let mut domain = (*self.domain).clone();
        if !kept.is_empty() {
            domain.actions.iter_mut().for_each(|action| keep(&mut action.effect, kept));
        }
        Team { domain: Arc::new(domain), ..self.clone() }
    }

    /// The skill facts that no available member has: what a stronger team would bring.
    pub fn missing_skills(&self, available: &[usize]) -> Vec<(Name, Vec<GroundAtom>)> {
        let has = |action: &Name| available.iter().any(|&m| self.members[m].can(action));
        self.domain
            .actions
            .iter()
            .filter(|a| !has(&a.name) && !a.params.is_empty())
            .map(|a| {
                let fact =
                    |&m: &usize| GroundAtom::new(skill_predicate(&a.name), [self.members[m].name.clone()]);
                let own = available.iter().map(fact);
                let told = self.skill_facts.get(&a.name).into_iter().flatten().cloned();
                (a.name.clone(), own.chain(told).collect())
            })
            .collect()
    }
}

fn keep(effect: &mut Effect, kept: &[Name]) {
    match effect {
        Effect::And(parts) => {
            parts.iter_mut().for_each(|part| keep(part, kept));
        }
        Effect::Forall(_, inner) | Effect::When(_, inner) => keep(inner, kept),
        Effect::Delete(atom) if kept.contains(&atom.predicate) => *effect = Effect::And(Vec::new()),
        Effect::Add(_) | Effect::Delete(_) | Effect::Assign(..) => {}
    }
}
