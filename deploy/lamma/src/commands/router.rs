//! `lamma router`: what the processes of a run on several hosts meet at.

use crate::cli::RouterArgs;
use crate::error::Failure;

/// Relays until a signal ends it.
#[cfg(feature = "zenoh")]
pub fn router(args: &RouterArgs) -> Result<u8, Failure> {
    use crate::out::say;
    use crate::supervise::{Patience, Supervisor};
    use lamma_bus::zenoh::{Identity, Router};

    lamma_bus::process::raise_open_files_limit().map_err(Failure::fault)?;
    let identity = args.identity.clone().map(|folder| Identity { folder, name: "router".into() });
    let rules = match (&args.rules, &args.identity) {
        (Some(rules), _) => Some(rules.clone()),
        (None, Some(folder)) => Some(folder.join("rules.json5")),
        (None, None) => None,
    };
    let router = Router::open(&args.listen, &args.connect, identity.as_ref(), rules.as_deref());
    let router = router.map_err(Failure::bad_input)?;
    say(format_args!("the router can be joined at {}", router.endpoints().join(", ")));
    // It has no children; what it hears of is Ctrl-C and its like.
    let (supervisor, events) = Supervisor::start(None).map_err(Failure::fault)?;
    let _ = events.recv();
    supervisor.end(Patience::NONE);
    drop(router);
    Ok(crate::exit::SUCCESS)
}

/// As above.
#[cfg(not(feature = "zenoh"))]
pub fn router(_args: &RouterArgs) -> Result<u8, Failure> {
    Err(Failure::bad_input(crate::process::join::NOT_BUILT))
}
