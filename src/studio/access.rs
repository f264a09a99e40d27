//! Who may ask: the page that this program opened, and nobody else.
//!
//! The server listens on this machine alone. A foreign page in the same browser could still send
//! requests to it, directly or under a name of its own that resolves to this machine; so the `Host`
//! must be an address or `localhost`, an `Origin` must be the page's own, and each request for data
//! needs the token of this start.

use super::refusal::Refusal;
use super::site::Site;
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::net::IpAddr;
use std::sync::Arc;

/// What the page may load and run: only what the program serves.
const PAGE_POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; \
    img-src 'self' data: blob:; connect-src 'self'; font-src 'self'; frame-src 'self'; \
    base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
/// A report has its script and style in itself. In a sandbox it has no part in the page's origin.
const REPORT_POLICY: &str = "sandbox allow-scripts allow-modals allow-downloads; default-src 'none'; \
    script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; \
    base-uri 'none'; form-action 'none'; frame-ancestors 'self'";

/// The parts of a `Host`: the name, and the port.
fn host_and_port(host: &str) -> (&str, u16) {
    match host.rsplit_once(':') {
        Some((name, port)) if !port.contains(']') => (name, port.parse().unwrap_or(0)),
        _ => (host, 80),
    }
}

/// Whether a name is an address that this server listens on, and no name that anybody can point to
/// it.
fn is_own_host(host: &str, site: &Site) -> bool {
    let (name, port) = host_and_port(host);
    let bound = site.address.ip();
    let name = name.trim_start_matches('[').trim_end_matches(']');
    let is_own_name = match name.parse::<IpAddr>() {
        Ok(ip) => ip == bound || ip.is_loopback() || bound.is_unspecified(),
        Err(_) => name.eq_ignore_ascii_case("localhost"),
    };
    is_own_name && port == site.address.port()
}

/// Whether two texts are equal, in a time that does not depend on where they differ.
fn are_equal(a: &str, b: &str) -> bool {
    let differences = a.bytes().zip(b.bytes()).map(|(a, b)| a ^ b);
    a.len() == b.len() && differences.fold(0, |all, one| all | one) == 0
}

/// The token that a request brings: in the cookie of the page, or as other programs send it.
fn token<'a>(headers: &'a HeaderMap, cookie_name: &str) -> Option<&'a str> {
    let text = |name| headers.get(name).and_then(|value| value.to_str().ok());
    let bearer = text(header::AUTHORIZATION).and_then(|value| value.strip_prefix("Bearer "));
    bearer.or_else(|| {
        let mut cookies = text(header::COOKIE)?.split(';').map(str::trim);
        cookies.find_map(|cookie| cookie.strip_prefix(cookie_name)?.strip_prefix('='))
    })
}

fn refuse(site: &Site, request: &Request) -> Option<Refusal> {
    let headers = request.headers();
    let text = |name| {
        headers
            .get(name)
            .and_then(|value: &HeaderValue| value.to_str().ok())
    };
    let Some(host) = text(header::HOST).filter(|host| is_own_host(host, site)) else {
        return Some(Refusal::forbidden(
            "this name is not an address of the studio; use the address that the terminal shows",
        ));
    };
    if let Some(origin) = headers.get(header::ORIGIN)
        && origin.as_bytes() != format!("http://{host}").as_bytes()
    {
        return Some(Refusal::forbidden("another page may not use the studio"));
    }
    let is_page = matches!(*request.method(), Method::GET | Method::HEAD)
        && !["/api/", "/files/"]
            .iter()
            .any(|start| request.uri().path().starts_with(start));
    let from = headers.get("sec-fetch-site").map(HeaderValue::as_bytes);
    if !is_page && from.is_some_and(|from| !matches!(from, b"same-origin" | b"none")) {
        return Some(Refusal::forbidden("another page may not use the studio"));
    }
    if is_page || token(headers, &site.cookie_name()).is_some_and(|t| are_equal(t, &site.token)) {
        return None;
    }
    Some(Refusal::forbidden(
        "this page belongs to an earlier start of the studio; open the address that the terminal shows",
    ))
}

/// Lets a request through if it may be, and says to the browser what the answer may do.
pub(super) async fn guard(State(site): State<Arc<Site>>, request: Request, next: Next) -> Response {
    let is_file = request.uri().path().starts_with("/files/");
    let mut response = match refuse(&site, &request) {
        Some(refusal) => refusal.into_response(),
        None => next.run(request).await,
    };
    let policy = if is_file { REPORT_POLICY } else { PAGE_POLICY };
    for (name, value) in [
        (header::CONTENT_SECURITY_POLICY, policy),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::CACHE_CONTROL, "no-store"),
    ] {
        response
            .headers_mut()
            .insert(name, HeaderValue::from_static(value));
    }
    for (name, value) in [
        ("cross-origin-opener-policy", "same-origin"),
        ("cross-origin-resource-policy", "same-origin"),
    ] {
        response
            .headers_mut()
            .insert(name, HeaderValue::from_static(value));
    }
    response
}

/// The first visit: the token of the address goes into a cookie, and out of the address.
pub(super) fn sign_in(site: &Site, query: &str) -> Result<Option<Response>, Refusal> {
    let mut values = query.split('&');
    let Some(given) = values.find_map(|value| value.strip_prefix("token=")) else {
        return Ok(None);
    };
    if !are_equal(given, &site.token) {
        return Err(Refusal::forbidden(
            "this address belongs to an earlier start of the studio; open the one that the terminal shows",
        ));
    }
    let cookie = format!(
        "{}={}; Path=/; HttpOnly; SameSite=Strict",
        site.cookie_name(),
        site.token
    );
    let to = [
        (header::LOCATION, "/"),
        (header::SET_COOKIE, cookie.as_str()),
    ];
    Ok(Some((StatusCode::SEE_OTHER, to).into_response()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_only_addresses_of_the_server_are_hosts() {
        let site = Site {
            address: "127.0.0.1:4747".parse().unwrap(),
            token: "token".to_owned(),
            folder: std::env::temp_dir(),
        };
        for own in [
            "127.0.0.1:4747",
            "localhost:4747",
            "[::1]:4747",
            "LOCALHOST:4747",
        ] {
            assert!(is_own_host(own, &site), "{own}");
        }
        for other in [
            "evil.example:4747",
            "127.0.0.1",
            "127.0.0.1:80",
            "localhost.evil.example:4747",
            "192.168.1.7:4747",
            "",
            ":4747",
        ] {
            assert!(!is_own_host(other, &site), "{other}");
        }
    }

    #[test]
    fn contract_the_token_is_read_from_its_cookie_alone() {
        let mut headers = HeaderMap::new();
        headers.insert(
            header::COOKIE,
            "a=1; bankshot_4747=abc; bankshot_47=x".parse().unwrap(),
        );
        assert_eq!(token(&headers, "bankshot_4747"), Some("abc"));
        assert_eq!(token(&headers, "bankshot_47"), Some("x"));
        assert_eq!(token(&headers, "bankshot_4"), None);
    }
}
