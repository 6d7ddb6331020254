//! What a coordinator is there for, and the way from there to a plan.

use std::sync::Arc;

use lamma_pddl::ast::{Condition, Domain, Init};
use lamma_pddl::multi_agent::{Part, TeamTask, union};
use lamma_pddl::{Name, Source, parse_domain, parse_problem};
use lamma_protocol::AgentId;
use lamma_protocol::message::{EventKind, Share};

use crate::allocation::NoAllocation;
use crate::costs::{changes_numbers, compares_numbers, without_costs};
use crate::job::CoordinatorJob;
use crate::joint::{JointInput, JointPlan};
use crate::machine::Coordinator;
use crate::method::Steps;
use crate::phase::Phase;
use crate::result::OutcomeKind;
use crate::team::{Member, Team};
use crate::understand::{GoalGroup, GoalItem, ScoreGoal, Subgoal, Understanding};

/// What is kept back from the time limit to carry the plan out and to tell of it, in milliseconds.
const RESERVE_MS: u64 = 1_000;

/// What is wanted, and how the coordinator comes to a plan for it.
#[derive(Clone, Debug)]
pub enum Mission {
    /// Sub-tasks are allocated, planned by each robot on its own and combined: the paper's way. Without an
    /// understanding the language model is asked for one.
    Divide(Option<Understanding>),
    /// The whole team is planned for at once, in a task the coordinator knows.
    Joint(Understanding),
    /// The same, but the coordinator knows nothing except the names: the agents, who trust it, tell it their
    /// parts when they join.
    JointAsTold,
}

impl Mission {
    /// What is known to be wanted from the start.
    pub(crate) fn understanding(&self) -> Option<Understanding> {
        match self {
            Mission::Divide(given) => given.clone(),
            Mission::Joint(understanding) => Some(understanding.clone()),
            Mission::JointAsTold => None,
        }
    }
}

impl Understanding {
    /// A goal as one task of the whole team; each of its conjuncts counts as a fact of the goal.
    pub fn of_goal(goal: &Condition) -> Self {
        let mut conjuncts = Vec::new();
        let mut open = vec![goal];
        while let Some(condition) = open.pop() {
            match condition {
                Condition::And(parts) => open.extend(parts.iter().rev()),
                other => conjuncts.push(other.clone()),
            }
        }
        let group = |condition: Condition| GoalGroup {
            items: vec![GoalItem { text: condition.to_string(), condition: condition.clone() }],
            joint: condition,
        };
        let subgoal = Subgoal {
            id: "s1".into(),
            text: "the goal of the task".into(),
            goal: goal.clone(),
            after: Vec::new(),
            lasting: true,
            advice: Vec::new(),
        };
        Understanding {
            subgoals: vec![subgoal],
            goal: ScoreGoal { groups: conjuncts.into_iter().map(group).collect() },
            assumptions: Vec::new(),
            bans: Vec::new(),
        }
    }
}

/// One agent's part, from the text it shares.
fn part_of(name: &Name, share: &Share) -> Result<Part, String> {
    let domain = parse_domain(&Source::new(format!("domain of {name}"), share.domain.as_str()));
    let problem = parse_problem(&Source::new(format!("problem of {name}"), share.problem.as_str()));
    let domain = domain.map_err(|report| report.to_string())?.value;
    let problem = problem.map_err(|report| report.to_string())?.value;
    Ok(Part::new(name, &domain, &problem))
}

impl Coordinator {
    /// Everybody is here: what they have told of themselves makes the task, if it was not known before.
    pub(crate) fn meet_team(&mut self) -> Result<(), String> {
        if !matches!(self.config.mission, Mission::JointAsTold) || self.understanding.is_some() {
            return Ok(());
        }
        let mut parts = Vec::new();
        for agent in self.roster.alive().collect::<Vec<_>>() {
            let name = &self.config.team.members[agent.index()].name;
            let share = self.roster.report(agent).and_then(|report| report.share.as_ref());
            let share = share.ok_or_else(|| format!("{name} has told nothing of its task"))?;
            parts.push(part_of(name, share)?);
        }
        let task = union(&parts).map_err(|e| e.to_string())?;
        let names: Vec<Name> = self.config.team.members.iter().map(|member| member.name.clone()).collect();
        let team = Team::of_task(&task, &names);
        self.interpreter = team.interpreter().map_err(|e| e.to_string())?;
        self.config.team = Arc::new(team);
        self.understanding = Some(Understanding::of_goal(&task.goal));
        Ok(())
    }

    /// What is wanted is known: to the plan, on the mission's way.
    pub(crate) fn plan_for_team(&mut self) {
        match self.config.mission {
            Mission::Divide(_) if self.config.method.steps == Steps::WrittenForAdvice => {
                self.write_as_advised();
            }
            Mission::Divide(_) => self.allocate(),
            Mission::Joint(_) | Mission::JointAsTold => self.plan_jointly(),
        }
    }

    fn plan_jointly(&mut self) {
        let (Some(understanding), Some(facts)) = (&self.understanding, self.view.state()) else { return };
        // A frame shows facts and no numbers.
        let begun = self.view.frame().is_some_and(|frame| frame.applied() > 0);
        if begun && changes_numbers(&self.config.team.domain) {
            let why = "a plan that changes numbers has failed, and what they are now is not known";
            return self.finish(OutcomeKind::GaveUp, Some(why.into()));
        }
        if compares_numbers(&understanding.final_goal()) {
            let why = "the goal compares numbers: plan it with `lamma plan`, a team cannot be planned for it";
            return self.finish(OutcomeKind::GaveUp, Some(why.into()));
        }
        let spent = self.now.0 / 1_000 + RESERVE_MS;
        let left = self.config.time_limit_ms.saturating_sub(spent).max(1);
        let input = JointInput {
            team: self.config.team.clone(),
            available: self.roster.available(),
            facts,
            goal: understanding.final_goal(),
            time_ms: left,
            makespan: self.config.makespan.clone(),
        };
        let job = self.spawn(CoordinatorJob::PlanJointly(Box::new(input)));
        self.enter(Phase::PlanningJointly(job));
    }

    pub(crate) fn planned_jointly(&mut self, plan: Result<Box<JointPlan>, NoAllocation>) {
        match plan {
            Ok(plan) => {
                let JointPlan { plan, allocation, end } = *plan;
                let bound = allocation.lower_bound;
                let acting = allocation.members_of(0);
                let names: Vec<String> = acting.iter().map(|&m| self.name_of(AgentId(m as u16))).collect();
                if !names.is_empty() {
                    self.event(EventKind::Note, format!("taking part: {}", names.join(", ")));
                }
                self.carry_out(plan, allocation, end, bound);
            }
            Err(NoAllocation::Infeasible(why)) => self.infeasible(&why),
            Err(NoAllocation::NotThisWay(why) | NoAllocation::GaveUp(why)) => {
                self.finish(OutcomeKind::GaveUp, Some(why));
            }
        }
    }
}

impl Team {
    /// A team of which only the names are known.
    pub fn of_names(names: impl IntoIterator<Item = Name>) -> Team {
        let nothing = Domain {
            name: Name::new("unknown"),
            requirements: Vec::new(),
            types: Vec::new(),
            constants: Vec::new(),
            predicates: Vec::new(),
            functions: Vec::new(),
            actions: Vec::new(),
            axioms: Vec::new(),
        };
        let domain = Arc::new(nothing);
        let member = |name| Member { name, domain: domain.clone() };
        Team {
            members: names.into_iter().map(member).collect(),
            domain: domain.clone(),
            objects: Vec::new(),
            relaxations: Vec::new(),
            numbers: Vec::new(),
            skill_facts: Default::default(),
            travel: None,
        }
    }

    /// The team of a task; the members are those of `names`, in that order, whether they have a part or not.
    pub fn of_task(task: &TeamTask, names: &[Name]) -> Team {
        let domain = without_costs(&task.domain, &task.goal);
        let member = |name: &Name| {
            let agent = task.agents.iter().find(|agent| agent.name == *name);
            let mut domain = domain.clone();
            domain.actions.retain(|action| agent.is_some_and(|a| a.actions.contains(&action.name)));
            Member { name: name.clone(), domain: Arc::new(domain) }
        };
        Team {
            members: names.iter().map(member).collect(),
            objects: task.objects.clone(),
            relaxations: Vec::new(),
            numbers: task.init.iter().filter(|i| matches!(i, Init::Value(..))).cloned().collect(),
            skill_facts: Default::default(),
            travel: None,
            domain: Arc::new(domain),
        }
    }
}
