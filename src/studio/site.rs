//! Where a studio listens, its token, and its folder.

use std::net::SocketAddr;
use std::path::PathBuf;

/// What every request is held against.
pub(super) struct Site {
    pub(super) address: SocketAddr,
    pub(super) token: String,
    pub(super) folder: PathBuf,
}

impl Site {
    /// The cookie with the token. Cookies belong to a host with all its ports, so the port is in
    /// the name.
    pub(super) fn cookie_name(&self) -> String {
        format!("bankshot_{}", self.address.port())
    }
}
