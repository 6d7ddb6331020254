//! The `lamma` command: launcher, supervisor, and every process of a team in one binary.

mod ablation;
mod batch;
mod cli;
mod commands;
mod compat;
mod error;
mod events;
mod exit;
mod guard;
mod host;
mod json;
mod launch;
mod meeting;
mod method;
mod out;
mod process;
mod process_host;
mod published;
mod references;
mod remote_host;
mod results;
mod scale;
#[cfg(feature = "zenoh")]
mod secure;
mod show;
mod spec;
mod suite;
mod supervise;
mod table;
mod watch;
mod world;

use std::process::ExitCode;

use clap::{CommandFactory, Parser};

use cli::{Cli, Command, Format};
use error::Failure;

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            let code = if error.use_stderr() { exit::BAD_INPUT } else { exit::SUCCESS };
            // Nothing is left to do if not even this can be printed.
            let _ = error.print();
            return ExitCode::from(code);
        }
    };
    if cli.command.logs() {
        log_to_stderr(cli.verbose);
    }
    let format = format_of(&cli.command);
    ExitCode::from(dispatch(cli.command).unwrap_or_else(|failure| report(&failure, format)))
}

fn dispatch(command: Command) -> Result<u8, Failure> {
    match command {
        Command::Run(args) => commands::run::run(&args, false),
        Command::Solve(args) => commands::run::run(&args, true),
        Command::Plan(args) => commands::plan::plan(&args),
        Command::Validate(args) => commands::validate::validate(&args),
        Command::Bench(args) => commands::bench::bench(&args),
        Command::Scale(args) => commands::scale::scale(&args),
        Command::Rally(args) => scale::member(&args),
        Command::Clean => commands::clean::clean(),
        Command::Explain { code } => commands::explain::explain(&code),
        Command::List { what } => Ok(commands::list::list(what)),
        Command::Completions { shell } => {
            clap_complete::generate(shell, &mut Cli::command(), "lamma", &mut std::io::stdout());
            Ok(exit::SUCCESS)
        }
        Command::Prepare(args) => commands::prepare::prepare(&args),
        Command::Host(args) => commands::host::host(&args),
        Command::Bridge(args) => process::bridge::bridge(&args),
        Command::New(args) => commands::new::new(&args),
        Command::Router(args) => commands::router::router(&args),
        Command::Robot(args) => process::child::robot(&args),
        Command::Coordinator(args) => process::child::coordinator(&args),
        Command::Simulator(args) => process::child::simulator(&args),
    }
}

fn format_of(command: &Command) -> Format {
    match command {
        Command::Run(args) | Command::Solve(args) => args.common.format,
        Command::Host(args) => args.format,
        Command::Coordinator(args) => args.format,
        Command::Bench(args) => args.common.format,
        Command::Scale(args) => args.format,
        Command::Plan(args) => args.format,
        Command::Validate(args) => args.format,
        _ => Format::Text,
    }
}

/// Tells what went wrong; where JSON was asked for, standard output still gets its one object.
fn report(failure: &Failure, format: Format) -> u8 {
    eprintln!("error: {failure}");
    if format == Format::Json {
        out::say(json::failure(failure));
    }
    failure.code
}

fn log_to_stderr(verbose: u8) {
    let default = match verbose {
        // Zenoh warns of every client behind a socket without a name, which are all.
        0 => "warn,zenoh_link_unixsock_stream=error",
        1 => "info",
        2 => "debug",
        _ => "trace",
    };
    let filter = tracing_subscriber::EnvFilter::try_from_env("LAMMA_LOG")
        .unwrap_or_else(|_| tracing_subscriber::EnvFilter::new(default));
    // Fails only if a logger is there already.
    let _ = tracing_subscriber::fmt().with_env_filter(filter).with_writer(std::io::stderr).try_init();
}
