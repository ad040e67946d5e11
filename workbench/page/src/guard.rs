//! Access control: a request has to address this server, come from its own page, and carry its token.
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use rand::Rng;

/// Letters of a token: 32 of 62 are 190 bits.
const TOKEN_LENGTH: usize = 32;

/// Scripts and data are loaded from this server only. Plotly sets styles, and creates pictures from blobs.
const POLICY: &str = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; \
     frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

/// A random token.
pub fn random_token() -> String {
    let letters = rand::rng().sample_iter(rand::distr::Alphanumeric);
    letters.take(TOKEN_LENGTH).map(char::from).collect()
}

/// Credentials of a request.
#[derive(Debug, Clone)]
pub struct Guard {
    token: String,
    hosts: [String; 2],
}

impl Guard {
    /// The guard of a server on a port.
    pub fn new(token: String, port: u16) -> Self {
        let hosts = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}"));
        Self { token, hosts }
    }

    /// The reason for a refusal; `None` if the request is accepted.
    fn refusal(&self, path: &str, headers: &HeaderMap) -> Option<&'static str> {
        let text = |name| headers.get(name).map(HeaderValue::as_bytes);
        let is_own = |host: &[u8]| self.hosts.iter().any(|own| own.as_bytes() == host);
        let from_here = |origin: &[u8]| origin.strip_prefix(b"http://").is_some_and(is_own);
        if !text(header::HOST).is_some_and(is_own) {
            Some(
                "the Host header is that of another server; open the address printed by hitch serve",
            )
        } else if !text(header::ORIGIN).is_none_or(from_here) {
            Some("the request comes from another page; open the address printed by hitch serve")
        } else if path.split('/').nth(1) != Some(self.token.as_str()) {
            Some(
                "the token in the address is wrong or missing; open the address printed by hitch serve",
            )
        } else {
            None
        }
    }
}

/// Passes a request on or answers 403; sets the content security policy of the answer.
pub async fn check(State(guard): State<Guard>, request: Request, next: Next) -> Response {
    let mut response = match guard.refusal(request.uri().path(), request.headers()) {
        Some(reason) => (StatusCode::FORBIDDEN, reason).into_response(),
        None => next.run(request).await,
    };
    let headers = response.headers_mut();
    for (name, value) in [
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    let cached = headers.entry(header::CACHE_CONTROL);
    cached.or_insert(HeaderValue::from_static("no-store"));
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(path: &str, host: Option<&str>, origin: Option<&str>) -> bool {
        let guard = Guard::new("secret".to_owned(), 8080);
        let mut headers = HeaderMap::new();
        for (name, value) in [(header::HOST, host), (header::ORIGIN, origin)] {
            if let Some(value) = value {
                headers.insert(name, HeaderValue::from_str(value).unwrap());
            }
        }
        guard.refusal(path, &headers).is_some()
    }

    #[test]
    fn only_the_own_page_gets_through() {
        let own = Some("127.0.0.1:8080");
        assert!(!refused("/secret/", own, None));
        assert!(!refused("/secret/", Some("localhost:8080"), None));
        assert!(!refused("/secret/api", own, Some("http://127.0.0.1:8080")));
        assert!(refused("/secret/", None, None));
        assert!(refused("/secret/", Some("evil.example:8080"), None));
        assert!(refused("/secret/", Some("127.0.0.1:8081"), None));
        assert!(refused("/secret/", own, Some("http://evil.example")));
        assert!(refused("/secret/", own, Some("null")));
        assert!(refused("/", own, None));
        assert!(refused("/secre/", own, None));
        assert!(refused("/secret2/", own, None));
    }

    #[test]
    fn tokens_differ() {
        let [one, other] = [random_token(), random_token()];
        assert_eq!(one.len(), TOKEN_LENGTH);
        assert_ne!(one, other);
    }
}
