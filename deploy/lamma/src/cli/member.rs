//! Arguments of single processes of a run, and of a run that is spread over several hosts.

use std::path::PathBuf;

use clap::Args;

use super::seconds;
use super::{BusArg, Format, RunArgs};

/// How a process finds its run.
#[derive(Debug, Args)]
pub struct ChildArgs {
    /// The folder of the run.
    #[arg(long)]
    pub run_dir: PathBuf,
    /// The transport between the processes: iceoryx2 on one host, zenoh between hosts.
    #[arg(long, value_enum, default_value = "iceoryx2")]
    pub bus: BusArg,
    /// The shared memory of the run, for iceoryx2.
    #[arg(long, required_if_eq("bus", "iceoryx2"))]
    pub scope: Option<lamma_bus::iceoryx::Scope>,
    /// Where to join, for zenoh.
    #[command(flatten)]
    pub network: NetworkArgs,
    /// Started by a launcher: ends with it.
    #[arg(long, hide = true)]
    pub launched: bool,
    /// Which member of the team, for robots.
    #[arg(long, default_value_t = 0)]
    pub agent: u16,
}

/// Where to join a run over a network.
#[derive(Clone, Debug, Args)]
pub struct NetworkArgs {
    /// The router, as Zenoh writes endpoints: tcp/HOST:PORT, tls/HOST:PORT, unixsock-stream/PATH.
    #[arg(long, value_name = "ENDPOINT", required_if_eq("bus", "zenoh"))]
    pub connect: Option<String>,
    /// The name of the run on the network [default: the id in the run's folder].
    #[arg(long, value_name = "ID")]
    pub run_id: Option<String>,
    /// The folder of certificates and keys that `lamma new --secure` has made, for tls.
    #[arg(long, value_name = "DIR")]
    pub identity: Option<PathBuf>,
    /// The name of the certificate in that folder [default: the process's own, such as robot-0].
    #[arg(long, value_name = "NAME", requires = "identity")]
    pub identity_name: Option<String>,
    /// How long to look for the router, in seconds.
    #[arg(long, default_value_t = 30.0, value_parser = seconds)]
    pub connect_limit: f64,
}

/// See [`Command::Coordinator`].
#[derive(Debug, Args)]
pub struct CoordinatorArgs {
    /// As every process.
    #[command(flatten)]
    pub child: ChildArgs,
    /// How to print the result, without a launcher.
    #[arg(long, value_enum, default_value = "text")]
    pub format: Format,
    /// Without a launcher: a robot that was there and has not been heard of for so many seconds is lost.
    #[arg(long, default_value_t = 15.0, value_parser = seconds)]
    pub lost_after: f64,
}

/// See [`Command::Prepare`].
#[derive(Debug, Args)]
pub struct PrepareArgs {
    /// As for a run.
    #[command(flatten)]
    pub run: RunArgs,
    /// Robots that live on another host, for `lamma host`: HOST=ROBOT+ROBOT; may be repeated.
    #[arg(long, value_name = "HOST=ROBOTS")]
    pub away: Vec<String>,
}

/// See [`Command::Host`].
#[derive(Debug, Args)]
pub struct HostArgs {
    /// Which host of the run: `hub`, or a name given to `lamma prepare --away`.
    pub name: String,
    /// The folder of the run.
    #[arg(long)]
    pub run_dir: PathBuf,
    /// For the hub: where the others join it, such as tcp/0.0.0.0:7447.
    #[arg(long, value_name = "ENDPOINT")]
    pub listen: Option<String>,
    /// For the others: where the hub is, such as tcp/HUB:7447.
    #[arg(long, value_name = "ENDPOINT", conflicts_with = "listen")]
    pub connect: Option<String>,
    /// How the hub prints the result.
    #[arg(long, value_enum, default_value = "text")]
    pub format: Format,
}

/// See [`Command::Bridge`].
#[derive(Debug, Args)]
pub struct BridgeArgs {
    /// The folder of the run.
    #[arg(long)]
    pub run_dir: PathBuf,
    /// This host's shared memory.
    #[arg(long)]
    pub scope: lamma_bus::iceoryx::Scope,
    /// This host's name.
    #[arg(long)]
    pub host: String,
    /// Where the others join.
    #[arg(long)]
    pub listen: Option<String>,
    /// Where to join.
    #[arg(long)]
    pub connect: Option<String>,
    /// Started by a launcher.
    #[arg(long, hide = true)]
    pub launched: bool,
}

/// See [`Command::New`].
#[derive(Debug, Args)]
pub struct NewArgs {
    /// Write an authority, one identity per process, and rules by which each may say only its own, to this folder.
    #[arg(long, value_name = "DIR", required = true)]
    pub secure: Option<PathBuf>,
    /// How many robots the team has.
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub agents: u16,
    /// Names and addresses by which the router is reached; several with commas.
    #[arg(long, value_name = "NAME", value_delimiter = ',', default_value = "localhost,127.0.0.1")]
    pub host: Vec<String>,
    /// For how many days the identities hold.
    #[arg(long, default_value_t = 365, value_parser = clap::value_parser!(u16).range(1..=3650))]
    pub days: u16,
}

/// See [`Command::Router`].
#[derive(Debug, Args)]
pub struct RouterArgs {
    /// Where others join it: tcp/0.0.0.0:7447, tls/0.0.0.0:7447, unixsock-stream/PATH; several with commas.
    #[arg(long, value_name = "ENDPOINT", value_delimiter = ',', required = true)]
    pub listen: Vec<String>,
    /// Other routers to join.
    #[arg(long, value_name = "ENDPOINT", value_delimiter = ',')]
    pub connect: Vec<String>,
    /// The folder of certificates and keys that `lamma new --secure` has made, for tls.
    #[arg(long, value_name = "DIR")]
    pub identity: Option<PathBuf>,
    /// Who may say what: a file as Zenoh's `access_control` [default: `rules.json5` of the identity's folder].
    #[arg(long, value_name = "FILE")]
    pub rules: Option<PathBuf>,
}
