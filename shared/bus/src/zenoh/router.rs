//! What all sessions of a run meet at: a router, in this process.

use std::path::Path;

use zenoh::query::{Query, Queryable};
use zenoh::{Session, Wait};

use super::keys::Keys;
use super::{Identity, OpenError, config};
use crate::iceoryx::{Claim, Scope, sweep};

/// A router. It relays for as long as it lives.
pub struct Router {
    session: Session,
    /// Answers who asks whether it was heard.
    _answers: Queryable<()>,
    endpoints: Vec<String>,
    /// The folder of the socket, for one of its own.
    claim: Option<Claim>,
}

impl Router {
    /// A router for one run on this host: a socket in a folder that only this user can enter, so that nobody else
    /// can join and no port is taken. What a crash leaves of it, `lamma clean` finds.
    pub fn local() -> Result<Router, OpenError> {
        let claim = Claim::bare()?;
        let endpoint = format!("unixsock-stream/{}", claim.scope.root().join("z").display());
        let mut router = Router::open(&[endpoint], &[], None, None)?;
        router.claim = Some(claim);
        Ok(router)
    }

    /// A router that others reach at `listen`, and that joins the routers at `connect`; with `rules`, a file, for
    /// who may say what (Zenoh's `access_control`).
    pub fn open(
        listen: &[String],
        connect: &[String],
        identity: Option<&Identity>,
        rules: Option<&Path>,
    ) -> Result<Router, OpenError> {
        let config = config::router(listen, connect, identity, rules)?;
        let fail = |e: zenoh::Error| OpenError::Listen { at: listen.join(", "), reason: e.to_string() };
        let session = zenoh::open(config).wait().map_err(&fail)?;
        let answer = |query: Query| {
            // Who has gone meanwhile does not hear it.
            let _ = query.reply(query.key_expr(), "").wait();
        };
        let answers = session.declare_queryable(Keys::of_any_run().sync_of_any()).callback(answer).wait();
        let _answers = answers.map_err(fail)?;
        Ok(Router { session, _answers, endpoints: listen.to_vec(), claim: None })
    }

    /// Where to join it: as it was told, with the port the system gave where it was told port 0.
    pub fn endpoints(&self) -> Vec<String> {
        let locators = self.session.info().locators().wait();
        match locators.is_empty() {
            true => self.endpoints.clone(),
            false => locators.iter().map(ToString::to_string).collect(),
        }
    }

    /// Under what the files of [`Router::local`] are found.
    pub fn scope(&self) -> Option<&Scope> {
        self.claim.as_ref().map(|claim| &claim.scope)
    }

    /// Its own session, for what runs beside it.
    pub(super) fn session(&self) -> Session {
        self.session.clone()
    }

    /// The first place to join it.
    pub fn endpoint(&self) -> String {
        self.endpoints().into_iter().next().unwrap_or_default()
    }
}

impl Drop for Router {
    fn drop(&mut self) {
        if let Err(error) = self.session.close().wait() {
            tracing::debug!("the router ends without a word: {error}");
        }
        if let Some(claim) = &self.claim
            && let Err(error) = sweep(&claim.scope)
        {
            tracing::error!("{error}");
        }
    }
}
