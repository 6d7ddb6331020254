//! `lamma new`: what a team needs before its first run.

use crate::cli::NewArgs;
use crate::error::Failure;

/// Writes the folder of identities.
#[cfg(feature = "zenoh")]
pub fn new(args: &NewArgs) -> Result<u8, Failure> {
    use crate::out::say;

    let folder = args.secure.as_deref().ok_or_else(|| Failure::bad_input("say what: --secure DIR"))?;
    let order = crate::secure::Order { agents: args.agents, hosts: args.host.clone(), days: args.days };
    crate::secure::write(folder, &order)?;
    let at = folder.display();
    say(format_args!(
        "{} identities are in {at}: ca.pem, NAME.pem and NAME-key.pem, rules.json5",
        args.agents + 4
    ));
    say(format_args!("  lamma router --listen tls/0.0.0.0:7447 --identity {at}"));
    say(format_args!("  lamma robot --bus zenoh --connect tls/{}:7447 --identity {at} …", args.host[0]));
    say("give a robot's host only ca.pem and that robot's two files, and keep ca-key.pem off the network");
    Ok(crate::exit::SUCCESS)
}

/// As above.
#[cfg(not(feature = "zenoh"))]
pub fn new(_args: &NewArgs) -> Result<u8, Failure> {
    Err(Failure::bad_input(crate::process::join::NOT_BUILT))
}
