//! Identities for the processes of a team, and the router's rules about who may say what.
//!
//! The certificate's common name is the node's name (`robot-0`); the router knows a session by it (mutual TLS) and
//! lets it publish the node's own topics, subscribe to what the node reads, and nothing else.

use std::fs::{DirBuilder, OpenOptions};
use std::io::Write;
use std::os::unix::fs::{DirBuilderExt, OpenOptionsExt};
use std::path::Path;

use lamma_bus::zenoh::keys::Keys;
use lamma_protocol::{Node, Topic};
use rcgen::{
    BasicConstraints, Certificate, CertificateParams, DnType, ExtendedKeyUsagePurpose, IsCa, Issuer, KeyPair,
    KeyUsagePurpose,
};
use serde_json::{Value, json};
use time::{Duration, OffsetDateTime};

use crate::error::Failure;

/// What is wanted.
pub struct Order {
    /// The size of the team.
    pub agents: u16,
    /// Names and addresses of the router.
    pub hosts: Vec<String>,
    /// How long the certificates hold.
    pub days: u16,
}

/// Writes the authority, an identity for each node and the router, and the rules, to `folder`.
pub fn write(folder: &Path, order: &Order) -> Result<(), Failure> {
    if folder.join("ca.pem").exists() {
        let path = folder.display();
        return Err(Failure::bad_input(format!("{path} has an authority already: choose another folder")));
    }
    let made = DirBuilder::new().recursive(true).mode(0o700).create(folder);
    made.map_err(|e| Failure::bad_input(format!("cannot make {}: {e}", folder.display())))?;
    let (authority, issuer, key) = authority(order.days).map_err(Failure::fault)?;
    save(folder, "ca.pem", 0o644, &authority.pem())?;
    save(folder, "ca-key.pem", 0o600, &key)?;
    let nodes = Topic::nodes(order.agents).into_iter().map(|n| (n.to_string(), Vec::new()));
    for (name, hosts) in nodes.chain([("router".to_owned(), order.hosts.clone())]) {
        let (certificate, key) = identity(&issuer, &name, hosts, order.days)
            .map_err(|e| Failure::bad_input(format!("no certificate for {name}: {e}; check --host")))?;
        save(folder, &format!("{name}.pem"), 0o644, &certificate.pem())?;
        save(folder, &format!("{name}-key.pem"), 0o600, &key.serialize_pem())?;
    }
    let rules = serde_json::to_string_pretty(&rules(order.agents)).map_err(Failure::fault)?;
    save(folder, "rules.json5", 0o644, &rules)
}

fn save(folder: &Path, name: &str, mode: u32, text: &str) -> Result<(), Failure> {
    let path = folder.join(name);
    let file = OpenOptions::new().write(true).create_new(true).mode(mode).open(&path);
    file.and_then(|mut f| f.write_all(text.as_bytes())).map_err(|e| Failure::io("write", &path, &e))
}

fn params(name: &str, hosts: Vec<String>, days: u16) -> Result<CertificateParams, rcgen::Error> {
    let mut params = CertificateParams::new(hosts)?;
    params.distinguished_name.push(DnType::CommonName, name);
    let now = OffsetDateTime::now_utc();
    // Clocks of robots are not always right.
    params.not_before = now - Duration::days(1);
    params.not_after = now + Duration::days(days.into());
    Ok(params)
}

fn authority(days: u16) -> Result<(Certificate, Issuer<'static, KeyPair>, String), rcgen::Error> {
    let mut params = params("lamma authority", Vec::new(), days)?;
    params.is_ca = IsCa::Ca(BasicConstraints::Constrained(0));
    params.key_usages = vec![KeyUsagePurpose::KeyCertSign, KeyUsagePurpose::CrlSign];
    let key = KeyPair::generate()?;
    let certificate = params.self_signed(&key)?;
    let text = key.serialize_pem();
    Ok((certificate, Issuer::new(params, key), text))
}

fn identity(
    issuer: &Issuer<'_, KeyPair>,
    name: &str,
    hosts: Vec<String>,
    days: u16,
) -> Result<(Certificate, KeyPair), rcgen::Error> {
    let mut params = params(name, hosts, days)?;
    params.key_usages = vec![KeyUsagePurpose::DigitalSignature];
    params.extended_key_usages = vec![ExtendedKeyUsagePurpose::ClientAuth];
    if name == "router" {
        params.extended_key_usages.push(ExtendedKeyUsagePurpose::ServerAuth);
    }
    let key = KeyPair::generate()?;
    Ok((params.signed_by(&key, issuer)?, key))
}

/// Zenoh's `access_control` for a team: nothing is allowed but what follows from the topics.
fn rules(agents: u16) -> Value {
    let keys = Keys::of_any_run();
    let (mut rules, mut subjects, mut policies) = (Vec::new(), Vec::new(), Vec::new());
    for node in Topic::nodes(agents) {
        let name = node.to_string();
        let mut ids = Vec::new();
        let mut allow = |what: &str, messages: &[&str], flow: &str, key_exprs: Vec<String>| {
            let id = format!("{name} {what}");
            rules.push(json!({
                "id": id, "permission": "allow", "messages": messages, "flows": [flow], "key_exprs": key_exprs,
            }));
            ids.push(id);
        };
        allow("says", &["put"], "ingress", said_by(&keys, node, agents));
        allow("learns that it is heard", &["declare_subscriber"], "egress", heard_as(&keys, node, agents));
        allow("asks to hear", &["declare_subscriber"], "ingress", keys.read_by(node));
        allow("hears", &["put"], "egress", keys.read_by(node));
        allow("is there", &["liveliness_token"], "ingress", vec![keys.live_of(node)]);
        let watched = keys.live_readers_of(node);
        let watch = ["declare_liveliness_subscriber", "liveliness_query"];
        allow("asks who is there", &watch, "ingress", watched.clone());
        allow("hears who is there", &["liveliness_token"], "egress", watched);
        allow("asks whether it was heard", &["query"], "ingress", vec![keys.sync(node)]);
        allow("is told so", &["reply"], "egress", vec![keys.sync(node)]);
        subjects.push(json!({ "id": name, "cert_common_names": [name] }));
        policies.push(json!({ "id": name, "rules": ids, "subjects": [name] }));
    }
    json!({
        "enabled": true, "default_permission": "deny",
        "rules": rules, "subjects": subjects, "policies": policies,
    })
}

fn said_by(keys: &Keys, node: Node, agents: u16) -> Vec<String> {
    match node {
        // As few expressions as say it: the coordinator of a thousand robots has a thousand directives.
        Node::Coordinator => ["outcome", "grant", "agent/*/directive"].map(|t| keys.key(t)).into(),
        Node::Simulator => ["world/**", "agent/*/ack"].map(|t| keys.key(t)).into(),
        Node::Supervisor | Node::Robot(_) => {
            let own = Topic::all(agents).into_iter().filter(|t| t.publisher() == node);
            own.map(|t| keys.topic(t)).collect()
        }
    }
}

/// The subscriptions that others hear `node` by. Who says something sends nothing until it knows of one.
fn heard_as(keys: &Keys, node: Node, agents: u16) -> Vec<String> {
    match node {
        // Its reader reads those of all robots in one.
        Node::Robot(_) => ["agent/*/report", "agent/*/request"].map(|t| keys.key(t)).into(),
        Node::Supervisor | Node::Coordinator | Node::Simulator => said_by(keys, node, agents),
    }
}

#[cfg(test)]
mod tests {
    use lamma_bus::zenoh::{Endpoint, Identity, Join, Router};
    use lamma_bus::{Bus, Received};
    use lamma_protocol::message::{Act, Request};
    use lamma_protocol::{AgentId, Envelope, Epoch, Message, Revision, StepIndex, codec};
    use zenoh::Wait;

    use super::*;

    fn request(number: u64) -> Envelope {
        let (epoch, step) = (Epoch(1), StepIndex(0));
        let act = Act { action: "Wait".into(), args: vec![] };
        let message = Message::Request(Request { epoch, step, act, gates: vec![] });
        Envelope { revision: Revision { incarnation: 0, number }, message }
    }

    /// Must show: with a certificate of its own, a robot that publishes on another's topic is not heard.
    #[test]
    fn a_robot_is_heard_on_its_own_topics_alone() {
        let folder = std::env::temp_dir().join(format!("lamma-secure-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        let hosts = vec!["localhost".into(), "127.0.0.1".into()];
        write(&folder, &Order { agents: 2, hosts, days: 1 }).unwrap();
        let identity = |name: &str| Identity { folder: folder.clone(), name: name.into() };
        let rules = folder.join("rules.json5");
        let listen = ["tls/127.0.0.1:0".to_owned()];
        let router = Router::open(&listen, &[], Some(&identity("router")), Some(&rules)).unwrap();
        let join = Join {
            run: "run-1".parse().unwrap(),
            agents: 2,
            connect: router.endpoint(),
            identity: Some(identity("simulator")),
            patience: std::time::Duration::from_secs(5),
        };
        let mut simulator = Endpoint::open(&join, Node::Simulator).unwrap();
        let own = Join { identity: Some(identity("robot-1")), ..join.clone() };
        let mut robot = Endpoint::open(&own, Node::Robot(AgentId(1))).unwrap();

        // The wrong topic, by a program that does not ask: with robot-1's certificate, as robot-0.
        let mut config = zenoh::Config::default();
        for (key, value) in [
            ("mode", json!("client")),
            ("scouting/multicast/enabled", json!(false)),
            ("connect/endpoints", json!([join.connect])),
            ("transport/link/tls/root_ca_certificate", json!(folder.join("ca.pem"))),
            ("transport/link/tls/enable_mtls", json!(true)),
            ("transport/link/tls/connect_certificate", json!(folder.join("robot-1.pem"))),
            ("transport/link/tls/connect_private_key", json!(folder.join("robot-1-key.pem"))),
        ] {
            config.insert_json5(key, &value.to_string()).unwrap();
        }
        let liar = zenoh::open(config).wait().unwrap();
        let stamp = lamma_bus::zenoh::keys::Stamp { session: 1, number: 1 };
        let key = Keys::new(&join.run).topic(Topic::Request(AgentId(0)));
        let put = liar.put(key, codec::encode(&request(1)).unwrap()).attachment(&stamp.to_bytes()[..]);
        put.wait().unwrap();

        robot.publish(Topic::Request(AgentId(1)), &request(2)).unwrap();
        let end = std::time::Instant::now() + std::time::Duration::from_secs(20);
        let mut heard = Vec::new();
        // Some time after the honest one was heard, for the other to come if it does.
        let mut quiet = 0;
        while quiet < 5 {
            assert!(std::time::Instant::now() < end, "the robot's own topic is not heard");
            simulator.receive(&mut |received| {
                if let Received::Message(topic, _) = received {
                    heard.push(topic);
                }
            });
            quiet += usize::from(!heard.is_empty());
            robot.wait(Some(std::time::Duration::from_millis(20))).unwrap();
            simulator.wait(Some(std::time::Duration::from_millis(50))).unwrap();
        }
        assert_eq!(heard, [Topic::Request(AgentId(1))]);
        assert_eq!(simulator.stats().refused, 0);
        drop((robot, simulator, liar, router));
        std::fs::remove_dir_all(&folder).unwrap();
    }

    /// The rules' own text, read as Zenoh reads it, allows each node its own topics and no other's.
    #[test]
    fn a_node_may_say_its_own_topics_and_nothing_else() {
        let rules = rules(12);
        let keys = Keys::new(&"run-1".parse().unwrap());
        for node in Topic::nodes(12) {
            let id = format!("{node} says");
            let rule = rules["rules"].as_array().unwrap().iter().find(|r| r["id"] == id.as_str()).unwrap();
            let allowed: Vec<&str> =
                rule["key_exprs"].as_array().unwrap().iter().map(|k| k.as_str().unwrap()).collect();
            for topic in Topic::all(12) {
                let key = keys.topic(topic);
                let may = allowed.iter().any(|a| lamma_bus::zenoh::keys::includes(a, &key));
                assert_eq!(may, topic.publisher() == node, "{node} on {topic}");
            }
        }
    }
}
