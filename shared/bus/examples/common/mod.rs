//! What the examples share: other processes, the bare transport beside ours, and figures.
#![allow(dead_code, reason = "each example uses its part")]
#![expect(clippy::unwrap_used, reason = "an example that fails says where")]

use std::collections::BTreeSet;
use std::io::{BufRead, BufReader, Lines};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use iceoryx2::port::listener::Listener;
use iceoryx2::port::notifier::Notifier;
use iceoryx2::prelude::*;
use lamma_bus::iceoryx::Scope;
use lamma_bus::process::tie_to_parent;

/// Other processes of the example: itself again, with other arguments.
pub struct Children(Vec<(Child, Lines<BufReader<ChildStdout>>)>);

impl Children {
    /// Starts one for each list of arguments, and waits until each has said `ready`.
    pub fn start(arguments: impl IntoIterator<Item = Vec<String>>) -> Children {
        let mut children = Children(Vec::new());
        for arguments in arguments {
            let mut command = Command::new(std::env::current_exe().unwrap());
            command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped());
            let mut child = tie_to_parent(&mut command).spawn().unwrap();
            let lines = BufReader::new(child.stdout.take().unwrap()).lines();
            children.0.push((child, lines));
        }
        assert!(children.lines().iter().all(|line| line == "ready"));
        children
    }

    /// The next line of each.
    pub fn lines(&mut self) -> Vec<String> {
        self.0.iter_mut().map(|(_, lines)| lines.next().unwrap().unwrap()).collect()
    }

    /// The processes.
    pub fn processes(&self) -> impl Iterator<Item = &Child> {
        self.0.iter().map(|(child, _)| child)
    }

    /// Lets them go, and waits for their end.
    pub fn end(mut self) {
        self.0.iter_mut().for_each(|(child, _)| drop(child.stdin.take()));
        self.0.iter_mut().for_each(|(child, _)| assert!(child.wait().unwrap().success()));
    }
}

/// In a child: until the parent lets it go. An early end would disturb the others' last rounds.
pub fn until_let_go() {
    std::io::stdin().lines().for_each(drop);
}

/// A bare node of the run's own names, without the clean-up by members that takes minutes with a thousand of them.
pub fn raw_node(scope: &Scope) -> Node<ipc::Service> {
    let mut config = Config::default();
    config.global.set_root_path(&Path::new(scope.root().to_str().unwrap().as_bytes()).unwrap());
    config.global.prefix = FileName::new(format!("lamma-{}_", scope.tag()).as_bytes()).unwrap();
    config.global.node.cleanup_dead_nodes_on_creation = false;
    config.global.node.cleanup_dead_nodes_on_destruction = false;
    config.global.service.cleanup_dead_nodes_on_open = false;
    NodeBuilder::new().config(&config).create::<ipc::Service>().unwrap()
}

/// Bare events of one process: what wakes it, and what it wakes.
pub struct RawEvents {
    bell: Listener<ipc::Service>,
    ring: Notifier<ipc::Service>,
}

impl RawEvents {
    /// `names`: of the service that it hears, and of the one that it rings; `peers` may do the same on each.
    pub fn new(node: &Node<ipc::Service>, names: [&str; 2], peers: usize) -> RawEvents {
        let room = peers + 8;
        let service = |name: &str| {
            let name = ServiceName::new(&format!("raw-event/{name}")).unwrap();
            let builder = node.service_builder(&name).event();
            let builder = builder.max_listeners(room).max_notifiers(room).max_nodes(room);
            builder.event_id_max_value(room).open_or_create().unwrap()
        };
        let bell = service(names[0]).listener_builder().create().unwrap();
        let ring = service(names[1]).notifier_builder().create().unwrap();
        RawEvents { bell, ring }
    }

    /// Rings with this number.
    pub fn ring(&self, number: usize) {
        self.ring.notify_with_custom_event_id(EventId::new(number)).unwrap();
    }

    /// Sleeps until `count` different numbers have rung.
    pub fn await_rings(&self, count: usize) {
        let mut rung = BTreeSet::new();
        while rung.len() < count {
            self.bell.blocking_wait(|event| _ = rung.insert(event.id.as_value())).unwrap();
        }
    }
}

/// Takes the time of one round.
pub fn time(times: &mut Vec<Duration>, round: impl FnOnce()) {
    let start = Instant::now();
    round();
    times.push(start.elapsed());
}

/// So many thousandths of the times are no greater than this, in microseconds.
pub fn quantile(times: &mut [Duration], permille: usize) -> f64 {
    times.sort_unstable();
    times[(times.len() - 1) * permille / 1000].as_secs_f64() * 1e6
}
