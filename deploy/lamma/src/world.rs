//! Where a run's world comes from: a household scene, or PDDL files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use lamma_coordinator::result::RunResult;

use lamma_domains::goal::GoalEntry;
use lamma_domains::robots::Robot;
use lamma_domains::world::{ObjectSpec, Rules, WorldSetup, setup_with};
use lamma_pddl::ast::{Domain, Problem};
use lamma_pddl::multi_agent::{Part, TeamTask, Veil, unfactored, union};
use lamma_pddl::{Name, Source, check_domain, check_problem, parse_domain, parse_problem};
use serde::{Deserialize, Serialize};

use crate::commands::read_source;
use crate::error::Failure;
use crate::spec::Task;

/// What a run is about.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum WorldSource {
    /// A household task.
    Household(Household),
    /// One PDDL domain and problem for everybody.
    Pddl(PddlFiles),
    /// A domain and a problem for each agent.
    Factored(Factored),
}

/// A household task.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Household {
    /// The scene.
    pub scene: String,
    /// The team.
    pub team: Vec<Robot>,
    /// Replaces the scene's movable objects.
    pub objects: Option<Vec<ObjectSpec>>,
    /// Rules that differ from the usual.
    pub rules: Rules,
    /// What is wanted.
    pub task: Task,
    /// What the outcome is judged by, if not by what was understood.
    pub score: Option<Vec<GoalEntry>>,
}

/// The files of an unfactored task.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PddlFiles {
    /// The domain.
    pub domain: PathBuf,
    /// The problem.
    pub problem: PathBuf,
    /// Who acts, as the files say.
    pub agents: Vec<String>,
}

/// The files of a factored task.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Factored {
    /// One entry per agent.
    pub agents: Vec<AgentFiles>,
    /// What leaves an agent's process.
    pub privacy: Privacy,
}

/// What leaves the process of an agent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
pub enum Privacy {
    /// The coordinator is trusted: each agent tells it its whole part.
    Trusted,
    /// Private names stay inside: private facts, private objects and all actions go by numbers.
    Strict,
}

/// What one agent is given, and nobody else except the simulator, which is the world.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct AgentFiles {
    /// The agent, from the names of its files.
    pub name: String,
    /// Its domain.
    pub domain: PathBuf,
    /// Its problem.
    pub problem: PathBuf,
}

/// The world itself.
#[derive(Clone, Debug)]
pub enum World {
    /// A household.
    Household(Box<WorldSetup>),
    /// A PDDL task.
    Team(Box<TeamTask>),
}

impl WorldSource {
    /// The unfactored task in these files.
    pub fn pddl(domain: &Path, problem: &Path) -> Result<Self, Failure> {
        let task = read_unfactored(domain, problem)?;
        Ok(WorldSource::Pddl(PddlFiles {
            domain: absolute(domain)?,
            problem: absolute(problem)?,
            agents: task.agents.iter().map(|agent| agent.name.to_string()).collect(),
        }))
    }

    /// The factored task in this folder.
    pub fn factored(folder: &Path, privacy: Privacy) -> Result<Self, Failure> {
        Ok(WorldSource::Factored(Factored { agents: agent_files(folder)?, privacy }))
    }

    /// Gives what the agents did the names that they have in the agents' own files.
    pub fn unveil(&self, result: &mut RunResult) -> Result<(), Failure> {
        let WorldSource::Factored(Factored { agents, privacy: Privacy::Strict }) = self else {
            return Ok(());
        };
        let veil = |files: &AgentFiles| Ok((files.name.clone(), Veil::of(&files.part()?)));
        let veils = agents.iter().map(veil).collect::<Result<BTreeMap<_, _>, Failure>>()?;
        for act in &mut result.plan.actions {
            if let Some(veil) = veils.get(&act.robot) {
                act.action = veil.lifted(&act.action).to_string();
                act.args.iter_mut().for_each(|arg| *arg = veil.lifted(arg).to_string());
            }
        }
        Ok(())
    }

    /// The same task with nothing hidden.
    pub fn unveiled(&self) -> WorldSource {
        match self {
            WorldSource::Factored(files) => {
                WorldSource::Factored(Factored { agents: files.agents.clone(), privacy: Privacy::Trusted })
            }
            other => other.clone(),
        }
    }

    /// The names of the team, in roster order.
    pub fn names(&self) -> Vec<&str> {
        match self {
            WorldSource::Household(household) => household.team.iter().map(|r| r.name.as_str()).collect(),
            WorldSource::Pddl(files) => files.agents.iter().map(String::as_str).collect(),
            WorldSource::Factored(files) => files.agents.iter().map(|a| a.name.as_str()).collect(),
        }
    }

    /// The world; the same for the same source, in every process that may see it whole.
    pub fn world(&self, seed: u64) -> Result<World, Failure> {
        match self {
            WorldSource::Household(h) => setup_with(&h.scene, &h.team, h.objects.as_deref(), seed, &h.rules)
                .map(|world| World::Household(Box::new(world)))
                .map_err(Failure::bad_input),
            WorldSource::Pddl(files) => {
                Ok(World::Team(Box::new(read_unfactored(&files.domain, &files.problem)?)))
            }
            WorldSource::Factored(files) => {
                let parts = files.agents.iter().map(|agent| agent.part_for(files.privacy)).collect::<Result<
                    Vec<_>,
                    _,
                >>(
                )?;
                union(&parts).map(|task| World::Team(Box::new(task))).map_err(Failure::bad_input)
            }
        }
    }
}

impl AgentFiles {
    /// The agent's own part, from its own files alone.
    pub fn part(&self) -> Result<Part, Failure> {
        let (domain, problem) = read_pair(&self.domain, &self.problem)?;
        Ok(Part::new(&Name::new(&self.name), &domain, &problem))
    }

    /// Domain and problem as they stand in the files.
    pub fn text(&self) -> Result<(String, String), Failure> {
        let text = |path: &Path| {
            let bytes = std::fs::read(path).map_err(|e| Failure::unreadable(path, &e))?;
            Ok(String::from_utf8_lossy(&bytes).into_owned())
        };
        Ok((text(&self.domain)?, text(&self.problem)?))
    }

    /// The part as the agent lets others see it.
    pub fn part_for(&self, privacy: Privacy) -> Result<Part, Failure> {
        let part = self.part()?;
        Ok(match privacy {
            Privacy::Trusted => part,
            Privacy::Strict => Veil::of(&part).over(&part),
        })
    }
}

fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    std::path::absolute(path).map_err(|e| Failure::unreadable(path, &e))
}

fn read_unfactored(domain: &Path, problem: &Path) -> Result<TeamTask, Failure> {
    let (parsed_domain, parsed_problem) = read_pair(domain, problem)?;
    unfactored(&parsed_domain, &parsed_problem)
        .map_err(|e| Failure::bad_input(format!("{}: {e}", domain.display())))
}

/// Reads and checks a domain and its problem.
fn read_pair(domain: &Path, problem: &Path) -> Result<(Domain, Problem), Failure> {
    let (domain_source, problem_source): (Source, Source) = (read_source(domain)?, read_source(problem)?);
    let domain = parse_domain(&domain_source).map_err(Failure::bad_input)?.value;
    let problem = parse_problem(&problem_source).map_err(Failure::bad_input)?.value;
    let reports = [check_domain(&domain, &domain_source), check_problem(&domain, &problem, &problem_source)];
    match reports.into_iter().find(|report| report.has_errors()) {
        Some(report) => Err(Failure::bad_input(report)),
        None => Ok((domain, problem)),
    }
}

/// The pairs of files in a folder, by agent name.
fn agent_files(folder: &Path) -> Result<Vec<AgentFiles>, Failure> {
    let listing = std::fs::read_dir(folder).map_err(|e| Failure::unreadable(folder, &e))?;
    let mut names: Vec<String> =
        listing.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
    names.sort();
    let of = |kind: &str| -> Vec<&str> {
        let agent = |name: &'_ String| -> Option<(usize, usize)> {
            let rest = name.strip_prefix(kind)?.strip_suffix(".pddl")?;
            (!rest.is_empty()).then_some((kind.len(), kind.len() + rest.len()))
        };
        names.iter().filter_map(|name| agent(name).map(|(from, to)| &name[from..to])).collect()
    };
    let (domains, problems) = (of("domain-"), of("problem-"));
    let missing = |kind: &str, agent: &str| {
        let file = folder.join(format!("{kind}-{agent}.pddl"));
        Failure::bad_input(format!(
            "the agent {agent} has no {kind}: {} is missing (each agent needs domain-{agent}.pddl and problem-{agent}.pddl)",
            file.display()
        ))
    };
    if let Some(agent) = domains.iter().find(|agent| !problems.contains(agent)) {
        return Err(missing("problem", agent));
    }
    if let Some(agent) = problems.iter().find(|agent| !domains.contains(agent)) {
        return Err(missing("domain", agent));
    }
    if domains.is_empty() {
        return Err(Failure::bad_input(format!(
            "{} has no agents: it needs a domain-AGENT.pddl and a problem-AGENT.pddl for each",
            folder.display()
        )));
    }
    let files = |agent: &&str| {
        Ok(AgentFiles {
            name: (*agent).to_string(),
            domain: absolute(&folder.join(format!("domain-{agent}.pddl")))?,
            problem: absolute(&folder.join(format!("problem-{agent}.pddl")))?,
        })
    };
    domains.iter().map(files).collect()
}
