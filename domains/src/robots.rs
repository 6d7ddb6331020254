//! Robots: their skills, what they can lift, and their own PDDL domains.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use lamma_pddl::ast::Domain;
use lamma_pddl::parse::parse_domain;
use lamma_pddl::source::Source;
use serde::{Deserialize, Deserializer, Serialize};

use crate::goal::name_or_object;
use crate::{HouseError, nearest};

/// Every skill a robot can have. Each is an action of the union domain, with the robot as its first parameter.
pub const SKILLS: [&str; 18] = [
    "GoToObject",
    "PickupObject",
    "PutObject",
    "OpenObject",
    "CloseObject",
    "SwitchOn",
    "SwitchOff",
    "SliceObject",
    "BreakObject",
    "CleanObject",
    "DirtyObject",
    "FillObject",
    "EmptyObject",
    "UseUpObject",
    "DropHandObject",
    "ThrowObject",
    "PushObject",
    "PullObject",
];

/// Actions that come with a skill: who can pick things up can also do so together with other robots.
const TOGETHER: [(&str, &[&str]); 2] =
    [("PickupObject", &["SupportObject", "WithdrawHand", "PickupTogether"]), ("PutObject", &["PutTogether"])];

/// The most hands a robot can have.
pub const MAX_HANDS: u8 = 4;

/// A robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Robot {
    /// `robot1`
    pub name: String,
    /// Its skills.
    pub skills: Vec<String>,
    /// The heaviest thing it can lift, in kilograms.
    pub capacity_kg: f64,
    /// How many things it can hold.
    #[serde(default = "one_hand")]
    pub hands: u8,
}

fn one_hand() -> u8 {
    1
}

impl Robot {
    /// Whether it has the skill.
    pub fn has(&self, skill: &str) -> bool {
        self.skills.iter().any(|s| s == skill)
    }

    /// Checks a robot that somebody described.
    pub fn check(&self) -> Result<(), HouseError> {
        let bad = |what: String| Err(HouseError::BadRobot { robot: self.name.clone(), what });
        let mut letters = self.name.chars();
        let good = letters.next().is_some_and(|c| c.is_ascii_alphabetic())
            && letters.all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
        if !good {
            return bad("a name is a letter followed by letters, digits, `_` or `-`".to_string());
        }
        if !(self.capacity_kg >= 0.0 && self.capacity_kg.is_finite()) {
            return bad(format!("capacity_kg is {}; give kilograms, 0 or more", self.capacity_kg));
        }
        if !(1..=MAX_HANDS).contains(&self.hands) {
            return bad(format!("hands is {}; give 1 to {MAX_HANDS}", self.hands));
        }
        match self.skills.iter().find(|s| !SKILLS.contains(&s.as_str())) {
            None => Ok(()),
            Some(skill) => Err(HouseError::UnknownSkill {
                robot: self.name.clone(),
                skill: skill.clone(),
                hint: nearest::hint(skill, SKILLS),
                known: SKILLS.join(" "),
            }),
        }
    }
}

/// A member of a team as people write it: a robot of the catalogue by name, or one described.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Member {
    /// `"robot1"`
    Named(String),
    /// `{"name": "r2", "skills": ["GoToObject"], "capacity_kg": 0.9, "hands": 1}`
    Described(Robot),
}

impl<'de> Deserialize<'de> for Member {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        name_or_object(deserializer, "a robot's name or description", Member::Named, Member::Described)
    }
}

#[derive(Deserialize)]
struct CatalogueFile {
    robots: Vec<CatalogueEntry>,
}

#[derive(Deserialize)]
struct CatalogueEntry {
    name: String,
    skills: String,
    capacity_kg: f64,
}

/// The 28 robots of the catalogue, in order.
pub fn catalogue() -> &'static [Robot] {
    static ROBOTS: OnceLock<Vec<Robot>> = OnceLock::new();
    ROBOTS.get_or_init(|| {
        let file: CatalogueFile = serde_json::from_str(include_str!("../household/robots.json"))
            .expect("the embedded catalogue is checked by a test");
        let robot = |entry: CatalogueEntry| Robot {
            name: entry.name,
            skills: entry.skills.split_whitespace().map(String::from).collect(),
            capacity_kg: entry.capacity_kg,
            hands: 1,
        };
        file.robots.into_iter().map(robot).collect()
    })
}

/// The robot of the catalogue with that name.
pub fn find(name: &str) -> Result<&'static Robot, HouseError> {
    catalogue().iter().find(|r| r.name.eq_ignore_ascii_case(name)).ok_or_else(|| HouseError::UnknownRobot {
        name: name.to_string(),
        hint: nearest::hint(name, catalogue().iter().map(|r| r.name.as_str())),
    })
}

/// The robots of a team: known, described rightly, and no two of one name.
pub fn team(members: &[Member]) -> Result<Vec<Robot>, HouseError> {
    let robots: Vec<Robot> = members
        .iter()
        .map(|member| match member {
            Member::Named(name) => find(name).cloned(),
            Member::Described(robot) => robot.check().map(|()| robot.clone()),
        })
        .collect::<Result<_, _>>()?;
    if robots.is_empty() {
        return Err(HouseError::BadTeam("is empty; name at least one robot".to_string()));
    }
    let mut seen = BTreeSet::new();
    match robots.iter().find(|r| !seen.insert(r.name.to_ascii_lowercase())) {
        Some(twice) => Err(HouseError::BadTeam(format!("has two robots named `{}`", twice.name))),
        None => Ok(robots),
    }
}

/// The union domain: every action of every robot.
pub fn union_domain() -> &'static Domain {
    static DOMAIN: OnceLock<Domain> = OnceLock::new();
    DOMAIN.get_or_init(|| {
        let source = Source::new("household/domain.pddl", include_str!("../household/domain.pddl"));
        match parse_domain(&source) {
            Ok(parsed) => parsed.value,
            Err(report) => unreachable!("the embedded domain is checked by a test: {report}"),
        }
    })
}

/// The actions that skills give.
pub fn actions_of<'a>(skills: impl IntoIterator<Item = &'a str>) -> BTreeSet<&'a str> {
    let together = |skill: &str| TOGETHER.iter().find(|(s, _)| *s == skill).map_or(&[][..], |(_, a)| a);
    skills
        .into_iter()
        .flat_map(|skill| std::iter::once(skill).chain(together(skill).iter().copied()))
        .collect()
}

/// The domain of a robot with these skills: the union domain without the actions it has no skill for. Types,
/// constants and predicates stay, so that any goal can be stated.
pub fn project<'a>(union: &Domain, skills: impl IntoIterator<Item = &'a str>) -> Domain {
    let actions = actions_of(skills);
    let mut domain = union.clone();
    domain.actions.retain(|action| actions.contains(action.name.as_str()));
    domain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_catalogue_is_sound() {
        assert_eq!(catalogue().len(), 28);
        for (index, robot) in catalogue().iter().enumerate() {
            assert_eq!(robot.name, format!("robot{}", index + 1));
            robot.check().unwrap();
        }
        assert_eq!(find("robot24").unwrap().skills, ["GoToObject", "SwitchOn", "SwitchOff"]);
    }

    #[test]
    fn every_skill_is_an_action_whose_first_parameter_is_the_robot() {
        let union = union_domain();
        for skill in actions_of(SKILLS) {
            let action =
                union.actions.iter().find(|a| a.name == *skill).unwrap_or_else(|| panic!("no {skill}"));
            assert_eq!(action.params[0].types[0], "robot", "{skill}");
        }
        // Nobody's skill: what happens without the team.
        let all = actions_of(SKILLS);
        let others: Vec<&str> =
            union.actions.iter().map(|a| a.name.as_str()).filter(|a| !all.contains(a)).collect();
        assert_eq!(others, ["ObjectMoved", "DoorClosed", "RobotLost"]);
    }

    #[test]
    fn mistakes_are_named_with_the_nearest_right_word() {
        let error = find("robt7").unwrap_err().to_string();
        assert!(error.contains("did you mean `robot7`"), "{error}");
        let robot =
            Robot { name: "r".into(), skills: vec!["PickUpObjet".into()], capacity_kg: 1.0, hands: 1 };
        let error = robot.check().unwrap_err().to_string();
        assert!(error.contains("did you mean `PickupObject`"), "{error}");
        let twice = team(&[Member::Named("robot1".into()), Member::Named("robot1".into())]).unwrap_err();
        assert!(twice.to_string().contains("two robots named `robot1`"));
    }
}
