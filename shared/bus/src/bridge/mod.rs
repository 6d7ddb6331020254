//! Between hosts: what one host's shared memory holds and another's processes read, over one session.
//!
//! On each host a bridge stands in for the nodes that live elsewhere: it opens their endpoints on the host's own
//! bus, hears what they would hear, and says there what they said. Between two bridges travel [`Parcel`]s, each with
//! everything that has changed since the last one that arrived ([`Link`]): a barrier over the hundreds of robots of a
//! host costs one or two of them, not hundreds of messages.
//!
//! Robots speak with the coordinator, the simulator and the supervisor alone. So the host where these live is the
//! hub: it has a link to every other host, and the others have one to it.

mod host;
mod link;
mod parcel;

pub use host::{Away, Bridge};
pub use link::Link;
pub use parcel::{Parcel, ParcelError};
